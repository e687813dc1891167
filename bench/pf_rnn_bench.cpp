// Trains a PF-RNN, says how well it predicts against the exact filter, and what a step costs.
//
//     pf_rnn_bench EPS [name=value...]      e.g. pf_rnn_bench 0.5 cell=gru updates=2000 file=belief.pf
#include <chrono>
#include <cstdio>
#include <ctime>
#include <map>
#include <string>
#include <vector>

#include <maximin/deep/pf_rnn_belief.hpp>
#include <maximin/deep/pf_rnn_training.hpp>
#include <maximin/deep/prediction_errors.hpp>
#include <maximin/deep/runtime.hpp>
#include <maximin/deep/tensor_file.hpp>

namespace {

using namespace maximin;
using namespace maximin::deep;

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

std::map<std::string, std::string> settings(int argc, char** argv) {
  std::map<std::string, std::string> all;
  for (int i = 2; i < argc; ++i) {
    const std::string word = argv[i];
    all[word.substr(0, word.find('='))] = word.substr(word.find('=') + 1);
  }
  return all;
}

template <class Number>
void set(const std::map<std::string, std::string>& all, const char* name, Number& value) {
  if (const auto found = all.find(name); found != all.end()) value = static_cast<Number>(std::stod(found->second));
}

void report_predictions(const PfRnnPtr& module, const PfBeliefOptions& options, double eps) {
  PfRnnBelief belief(module, options);
  std::printf("%-11s %8s %8s %8s %8s %7s %7s %9s %9s %6s\n", "deception", "belief", "exact", "shown", "nearest",
              "holds", "inside", "area", "exact", "empty");
  for (int kind = 0; kind < deceptions; ++kind) {
    PredictionTrial trial;
    trial.eps = eps;
    trial.deception = static_cast<Deception>(kind);
    const PredictionErrors e = evaluate_predictions(belief, trial);
    std::printf("%-11s %8.4f %8.4f %8.4f %8.4f %7.3f %7.3f %9.5f %9.5f %6ld\n",
                words_of(trial.deception).at(static_cast<std::size_t>(kind)), e.belief, e.exact, e.shown, e.nearest,
                e.holds, e.inside, e.size, e.exact_size, e.empty);
  }
}

void report_speed(const PfRnnPtr& module, Lane width) {
  PfRnnBelief belief(module);
  belief.resize(width);
  std::vector<Lane> lanes;
  for (Lane lane = 0; lane < width; ++lane) lanes.push_back(lane);
  const std::vector<Action> actions(lanes.size(), 2);
  const std::vector<Point> shown(lanes.size(), Point{4.5, 4.5});
  const int repeats = width == 1 ? 2000 : 100;
  // Processor time: others may be using the machine.
  const std::clock_t start = std::clock();
  for (int i = 0; i < repeats; ++i) belief.update(lanes, actions, shown);
  const double used = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  std::printf("%d lanes: %.3f ms a step\n", width, 1e3 * used / repeats);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2) {
    std::fprintf(stderr, "usage: pf_rnn_bench EPS [name=value...]\n");
    return 2;
  }
  prepare_runtime();
  const auto given = settings(argc, argv);
  const bool published = given.contains("published");
  const double eps = std::stod(argv[1]);
  PfRnnOptions shape = published ? PfRnnOptions::published(eps) : PfRnnOptions{};
  shape.eps = eps;
  if (given.contains("cell") && given.at("cell") == "gru") shape.cell = PfCell::gru;
  set(given, "k", shape.particles);
  set(given, "hidden", shape.hidden);
  set(given, "embedding", shape.embedding);
  set(given, "normalisation", shape.normalisation);
  set(given, "weighing", shape.weighing);
  set(given, "resampling", shape.resampling);
  set(given, "before", shape.read_before_resampling);
  set(given, "cells", shape.cells);
  set(given, "innovation", shape.innovation);
  set(given, "one_hot", shape.one_hot_actions);
  set(given, "read_out", shape.read_out);
  PfTrainingOptions training = published ? PfTrainingOptions::published() : PfTrainingOptions{};
  set(given, "updates", training.updates);
  set(given, "batch", training.batch);
  set(given, "window", training.window);
  set(given, "particles", training.particles);
  set(given, "rate", training.learning_rate);
  set(given, "dropout", training.dropout);
  set(given, "kernel", training.kernel);
  set(given, "elbo", training.elbo_weight);
  set(given, "mean", training.mean_weight);
  set(given, "trajectories", training.trajectories);
  set(given, "deception", training.deception);
  set(given, "target", training.target);
  set(given, "seed", training.seed);
  PfBeliefOptions options;
  set(given, "correct", options.correct);
  set(given, "margin", options.hull_margin);

  Stream rng(training.seed);
  PfRnnPtr module = std::make_shared<PfRnn>(shape, rng);
  if (given.contains("load")) {
    get_module(read_tensor_file(given.at("load"), "pf-rnn"), "filter", *module);
  } else {
    const auto start = std::chrono::steady_clock::now();
    double loss = 0, error = 0, shown_error = 0;
    const long every = std::max(training.updates / 10, 1L);
    train_pf_rnn(module, training, [&](const PfTrainingProgress& now) {
      loss += now.loss;
      error += now.mean_error;
      shown_error += now.shown_error;
      if (now.update % every == 0) {
        const auto n = static_cast<double>(every);
        std::printf("%6ld updates %6.1f s (%.1f s of processor time): loss %.4f, error %.4f, shown %.4f\n", now.update,
                    seconds_since(start), static_cast<double>(std::clock()) / CLOCKS_PER_SEC, loss / n, error / n,
                    shown_error / n);
        std::fflush(stdout);
        loss = error = shown_error = 0;
      }
      return true;
    });
  }
  if (given.contains("file")) {
    TensorFile file{"pf-rnn", {}, {}};
    put_module(file, "filter", *module);
    write_tensor_file(given.at("file"), file);
  }
  report_predictions(module, options, shape.eps);
  report_speed(module, 1);
  report_speed(module, 64);
}
