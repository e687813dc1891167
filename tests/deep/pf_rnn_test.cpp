#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <maximin/deep/pf_rnn.hpp>
#include <maximin/deep/pf_rnn_belief.hpp>
#include <maximin/deep/pf_rnn_training.hpp>
#include <maximin/deep/prediction_errors.hpp>
#include <maximin/deep/tensor_file.hpp>
#include <maximin/deep/tensors.hpp>
#include <maximin/theory/error.hpp>

namespace maximin::deep {
namespace {

using Vector = std::vector<double>;

/// What to do wrong in the step worked out by hand: each must be noticed.
enum class Fault {
  none,
  gates_swapped,
  no_spread,
  weights_not_divided,
  mean_unweighted,
  no_normalisation,
  other_order
};

double sigmoid(double v) {
  return 1 / (1 + std::exp(-v));
}

/// One step of one lane by plain loops from the equations, with the module's numbers.
class ByHand {
 public:
  ByHand(const PfRnn& module, Fault fault) : options_(module.options()), fault_(fault) {
    for (const auto& item : module.named_parameters()) parameters_[item.key()] = item.value().to(torch::kDouble);
    for (const auto& item : module.named_buffers()) parameters_[item.key()] = item.value().to(torch::kDouble);
  }

  struct Particle {
    Vector h, c;
    double weight = 0;
    std::array<double, 2> place{};
  };
  struct Result {
    std::vector<Particle> read, resampled;
    std::array<double, 2> mean{};
  };

  Result step(std::vector<Particle> particles, const Vector& features, Point shown, const std::vector<Vector>& normal,
              const Vector& uniform) const {
    Vector input = affine("embed", features);
    for (double& v : input) v = std::max(v, 0.0);
    input = affine("embed_more", input);
    for (double& v : input) v = std::max(v, 0.0);
    double total = 0;
    for (std::size_t k = 0; k < particles.size(); ++k) {
      Particle& p = particles[k];
      options_.cell == PfCell::lstm ? lstm(p, input, normal[k], k) : gru(p, input, normal[k], k);
      p.weight *= std::exp(evidence(p, input));
      total += p.weight;
    }
    for (Particle& p : particles) p.weight /= total;
    Result result;
    result.resampled = resample(particles, uniform);
    const bool before = options_.read_before_resampling != (fault_ == Fault::other_order);
    result.read = before ? particles : result.resampled;
    for (Particle& p : result.read) {
      const Vector out = affine("read", p.h);
      const bool residual = options_.read_out == PfReadOut::residual;
      p.place = residual ? std::array<double, 2>{shown.x + options_.eps * out[0], shown.y + options_.eps * out[1]}
                         : std::array<double, 2>{5 + 5 * out[0], 5 + 5 * out[1]};
      const double weight = fault_ == Fault::mean_unweighted ? 1.0 / static_cast<double>(particles.size()) : p.weight;
      result.mean[0] += weight * p.place[0];
      result.mean[1] += weight * p.place[1];
    }
    return result;
  }

 private:
  Vector affine(const std::string& name, const Vector& x) const {
    const torch::Tensor& weight = parameters_.at(name + ".weight");
    const torch::Tensor& bias = parameters_.at(name + ".bias");
    Vector y;
    for (long i = 0; i < weight.size(0); ++i) {
      double sum = bias[i].item<double>();
      for (long j = 0; j < weight.size(1); ++j) sum += weight[i][j].item<double>() * x[static_cast<std::size_t>(j)];
      y.push_back(sum);
    }
    return y;
  }

  double evidence(const Particle& p, const Vector& input) const {
    if (options_.weighing == PfWeighing::linear) return affine("weigh", p.h)[0];
    const Vector direction = affine("weigh", input);
    double sum = 0;
    for (std::size_t i = 0; i < p.h.size(); ++i) sum += direction[i] * p.h[i];
    return sum;
  }

  /// Of particle k. Normalised over the batch, it has statistics of its own: outside training running ones.
  Vector candidate(Vector mean, const Vector& spread, const Vector& normal, std::size_t k) const {
    const auto of_batch = [&](const char* name) {
      return parameters_.at(std::string("candidate.batch.") + name)[static_cast<long>(k)].item<double>();
    };
    const auto n = static_cast<double>(mean.size());
    double centre = 0, variance = 0;
    for (std::size_t i = 0; i < mean.size(); ++i) {
      if (fault_ != Fault::no_spread) mean[i] += std::log1p(std::exp(spread[i])) * normal[i];
      centre += mean[i] / n;
    }
    for (const double v : mean) variance += (v - centre) * (v - centre) / n;
    double gain = 1, shift = 0;
    if (options_.normalisation == PfNormalisation::batch) {
      centre = of_batch("running_mean");
      variance = of_batch("running_var");
      gain = of_batch("weight");
      shift = of_batch("bias");
    }
    for (double& v : mean) {
      if (fault_ != Fault::no_normalisation) v = gain * (v - centre) / std::sqrt(variance + 1e-5) + shift;
      v = v > 0 ? v : 0.01 * v;
    }
    return mean;
  }

  void lstm(Particle& p, const Vector& input, const Vector& normal, std::size_t k) const {
    const std::size_t h = p.h.size();
    const Vector a = affine("from_hidden", p.h), b = affine("from_input", input);
    const auto sum = [&](std::size_t gate, std::size_t i) { return a[gate * h + i] + b[gate * h + i]; };
    Vector mean, spread;
    for (std::size_t i = 0; i < h; ++i) {
      mean.push_back(sum(3, i));
      spread.push_back(sum(4, i));
    }
    const Vector g = candidate(mean, spread, normal, k);
    const std::size_t forget = fault_ == Fault::gates_swapped ? 1 : 0;
    for (std::size_t i = 0; i < h; ++i) {
      p.c[i] = sigmoid(sum(forget, i)) * p.c[i] + sigmoid(sum(1 - forget, i)) * g[i];
      p.h[i] = sigmoid(sum(2, i)) * std::tanh(p.c[i]);
    }
  }

  void gru(Particle& p, const Vector& input, const Vector& normal, std::size_t k) const {
    const std::size_t h = p.h.size();
    const Vector a = affine("from_hidden", p.h), b = affine("from_input", input);
    const std::size_t update = fault_ == Fault::gates_swapped ? 1 : 0;
    Vector z, reset, mean, spread;
    for (std::size_t i = 0; i < h; ++i) {
      z.push_back(sigmoid(a[update * h + i] + b[update * h + i]));
      reset.push_back(sigmoid(a[(1 - update) * h + i] + b[(1 - update) * h + i]) * p.h[i]);
    }
    const Vector from_reset = affine("candidate_from_hidden", reset);
    for (std::size_t i = 0; i < h; ++i) {
      mean.push_back(from_reset[i] + b[2 * h + i]);
      spread.push_back(from_reset[h + i] + b[3 * h + i]);
    }
    const Vector n = candidate(mean, spread, normal, k);
    for (std::size_t i = 0; i < h; ++i) p.h[i] = (1 - z[i]) * n[i] + z[i] * p.h[i];
  }

  std::vector<Particle> resample(const std::vector<Particle>& from, const Vector& uniform) const {
    const auto k = static_cast<double>(from.size());
    std::vector<Particle> to;
    double total = 0;
    for (std::size_t i = 0; i < from.size(); ++i) {
      double left =
          options_.resampling == PfResampling::systematic ? (static_cast<double>(i) + uniform[0]) / k : uniform[i];
      std::size_t chosen = 0;
      const auto q = [&](std::size_t j) { return options_.alpha * from[j].weight + (1 - options_.alpha) / k; };
      while (chosen + 1 < from.size() && left >= q(chosen)) left -= q(chosen++);
      to.push_back(from[chosen]);
      if (fault_ != Fault::weights_not_divided) to.back().weight /= q(chosen);
      total += to.back().weight;
    }
    for (Particle& p : to) p.weight /= total;
    return to;
  }

  PfRnnOptions options_;
  Fault fault_;
  std::map<std::string, torch::Tensor> parameters_;
};

PfRnnOptions tiny(PfCell cell) {
  PfRnnOptions options;
  options.cell = cell;
  options.particles = 3;
  options.hidden = 4;
  options.embedding = 5;
  options.eps = 0.5;
  return options;
}

PfRnnPtr make(const PfRnnOptions& options, std::uint64_t seed = 3) {
  Stream rng(seed);
  return std::make_shared<PfRnn>(options, rng);
}

PfNoise draw_noise(const PfState& state, std::uint64_t seed) {
  at::Generator generator = at::make_generator<at::CPUGeneratorImpl>(seed);
  PfNoise noise;
  noise.normal = torch::empty(state.h.sizes(), state.h.options()).normal_(0, 1, generator);
  noise.uniform = torch::empty(state.log_weights.sizes(), state.h.options()).uniform_(0, 1, generator);
  return noise;
}

const std::array<PfSight, 2> history{PfSight{{2.5, 4.25}, {}, -1}, PfSight{{2.75, 4.5}, {2.5, 4.25}, 1}};

Vector row(const torch::Tensor& t) {
  Vector values;
  for (long i = 0; i < t.numel(); ++i) values.push_back(t.flatten()[i].item<double>());
  return values;
}

/// The largest difference between two steps of the module and the same by hand.
double difference(PfRnn& module, Fault fault) {
  const torch::NoGradGuard no_grad;
  const ByHand by_hand(module, fault);
  const auto k = static_cast<std::size_t>(module.options().particles);
  const auto h = static_cast<std::size_t>(module.options().hidden);
  PfState state = module.initial(1);
  std::vector<ByHand::Particle> particles(k, {Vector(h, 0.0), Vector(h, 0.0), 1 / static_cast<double>(k), {}});
  double worst = 0;
  const auto compare = [&](const torch::Tensor& t, double expected) {
    worst = std::max(worst, std::abs(t.item<double>() - expected));
  };
  for (std::size_t t = 0; t < history.size(); ++t) {
    const torch::Tensor features = module.encode({&history[t], 1});
    const PfNoise noise = draw_noise(state, 7 + t);
    std::vector<Vector> normal;
    for (long i = 0; i < module.options().particles; ++i) normal.push_back(row(noise.normal[0][i]));
    const PfStep step = module.step(state, features, to_tensor({&history[t].shown, 1}), noise);
    const auto expected = by_hand.step(particles, row(features), history[t].shown, normal, row(noise.uniform));
    for (std::size_t i = 0; i < k; ++i) {
      const auto n = static_cast<long>(i);
      compare(step.weights[0][n], expected.read[i].weight);
      for (int axis = 0; axis < 2; ++axis) {
        compare(step.places[0][n][axis], expected.read[i].place[static_cast<std::size_t>(axis)]);
        compare(step.mean[0][axis], expected.mean[static_cast<std::size_t>(axis)]);
      }
      compare(step.state.log_weights[0][n].exp(), expected.resampled[i].weight);
      for (std::size_t j = 0; j < h; ++j) {
        compare(step.state.h[0][n][static_cast<long>(j)], expected.resampled[i].h[j]);
        if (step.state.c.defined()) compare(step.state.c[0][n][static_cast<long>(j)], expected.resampled[i].c[j]);
      }
    }
    state = step.state;
    particles = expected.resampled;
  }
  return worst;
}

TEST(PfRnn, TwoStepsAreWhatTheEquationsSay) {
  for (const PfCell cell : {PfCell::lstm, PfCell::gru}) {
    for (const bool as_published : {false, true}) {
      PfRnnOptions options = as_published ? PfRnnOptions::published(0.5) : tiny(cell);
      options.cell = cell;
      options.particles = 3;
      options.hidden = 4;
      options.embedding = 5;
      const PfRnnPtr module = make(options);
      module->eval();
      {
        // Weights that differ, so that each part of a step can be seen.
        const torch::NoGradGuard no_grad;
        for (auto& item : module->named_parameters()) {
          if (item.key().starts_with("weigh.")) item.value().mul_(10);
        }
        double number = 0.4;
        for (const char* name : {"candidate.batch.running_mean", "candidate.batch.running_var",
                                 "candidate.batch.weight", "candidate.batch.bias"}) {
          for (auto& item : module->named_buffers()) {
            if (item.key() == name) item.value().add_(torch::arange(3) * (number += 0.1));
          }
          for (auto& item : module->named_parameters()) {
            if (item.key() == name) item.value().add_(torch::arange(3) * (number += 0.1));
          }
        }
      }
      EXPECT_LT(difference(*module, Fault::none), 1e-5);
      for (const Fault fault : {Fault::gates_swapped, Fault::no_spread, Fault::weights_not_divided,
                                Fault::mean_unweighted, Fault::no_normalisation, Fault::other_order}) {
        EXPECT_GT(difference(*module, fault), 1e-4) << "fault " << static_cast<int>(fault) << " goes unnoticed";
      }
    }
  }
}

/// The loss after two steps in double precision, everything that is drawn fixed.
torch::Tensor two_step_loss(PfRnn& module, const PfTrainingOptions& training) {
  PfState state = module.initial(1);
  const torch::Tensor truth = torch::tensor({{2.6, 4.4}}, torch::kDouble);
  torch::Tensor sum = torch::zeros({}, torch::kDouble);
  for (std::size_t t = 0; t < history.size(); ++t) {
    const PfStep step = module.step(state, module.encode({&history[t], 1}).to(torch::kDouble),
                                    to_tensor({&history[t].shown, 1}).to(torch::kDouble), draw_noise(state, 11 + t));
    sum = sum + pf_loss(step, truth, module.options().eps, training).sum();
    state = step.state;
  }
  return sum;
}

/// The largest difference between gradients and central differences, relative to the largest gradient.
double gradient_error(PfRnn& module, double factor) {
  PfTrainingOptions training;
  module.zero_grad();
  two_step_loss(module, training).backward();
  const torch::NoGradGuard no_grad;
  double worst = 0, largest = 0;
  for (torch::Tensor& parameter : module.parameters()) {
    double* values = parameter.data_ptr<double>();
    const long stride = std::max(parameter.numel() / 13, 1L);
    for (long i = 0; i < parameter.numel(); i += stride) {
      const double gradient = parameter.grad().defined() ? factor * parameter.grad().flatten()[i].item<double>() : 0,
                   was = values[i];
      constexpr double step = 1e-6;
      values[i] = was + step;
      const double above = two_step_loss(module, training).item<double>();
      values[i] = was - step;
      const double below = two_step_loss(module, training).item<double>();
      values[i] = was;
      worst = std::max(worst, std::abs(gradient - (above - below) / (2 * step)));
      largest = std::max(largest, std::abs(gradient));
    }
  }
  return worst / largest;
}

TEST(PfRnn, GradientsAreCentralDifferences) {
  for (const PfCell cell : {PfCell::lstm, PfCell::gru}) {
    for (const bool before : {true, false}) {
      PfRnnOptions options = tiny(cell);
      options.read_before_resampling = before;
      const PfRnnPtr module = make(options, 5);
      module->to(torch::kDouble);
      EXPECT_LT(gradient_error(*module, 1), 1e-6);
      EXPECT_GT(gradient_error(*module, 1.001), 1e-4);
    }
  }
  // Through soft resampling gradients reach the weights; through plain resampling, whose new weights are equal, none.
  for (const double alpha : {0.5, 1.0}) {
    PfRnnOptions options = tiny(PfCell::lstm);
    options.read_before_resampling = false;
    options.alpha = alpha;
    const PfRnnPtr module = make(options, 5);
    module->to(torch::kDouble);
    two_step_loss(*module, {}).backward();
    const double reached = module->named_parameters()["weigh.weight"].grad().abs().max().item<double>();
    if (alpha < 1) {
      EXPECT_GT(reached, 1e-6);
    } else {
      EXPECT_LT(reached, 1e-12);
    }
  }
}

TEST(PfRnn, AncestorsComeFromTheMixture) {
  const std::array<double, 4> weights{0.7, 0.2, 0.1, 0.0};
  const torch::Tensor log_weights = torch::tensor({{0.7, 0.2, 0.1, 1e-30}}).log();
  for (const PfResampling resampling : {PfResampling::systematic, PfResampling::multinomial}) {
    constexpr long repeats = 20'000;
    Stream rng(4);
    torch::Tensor uniform = torch::empty({repeats, 4});
    for (long i = 0; i < uniform.numel(); ++i) uniform.data_ptr<float>()[i] = static_cast<float>(rng.uniform());
    const Ancestors a = soft_resample(log_weights.repeat({repeats, 1}), 0.5, resampling, uniform);
    std::array<double, 4> share{};
    for (long i = 0; i < a.rows.numel(); ++i) {
      const long chosen = a.rows[i].item<long>() - 4 * (i / 4);
      ASSERT_TRUE(chosen >= 0 && chosen < 4);
      share[static_cast<std::size_t>(chosen)] += 1.0 / static_cast<double>(a.rows.numel());
    }
    double off_weights = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      EXPECT_NEAR(share[k], 0.5 * weights[k] + 0.125, 0.01);
      off_weights = std::max(off_weights, std::abs(share[k] - weights[k]));
    }
    EXPECT_GT(off_weights, 0.1);
    EXPECT_LT((a.log_weights.exp().sum(1) - 1).abs().max().item<double>(), 1e-5);
  }
}

TEST(PfRnn, LearnsMoreThanWhatIsShown) {
  PfRnnOptions shape;
  shape.eps = 0.5;
  shape.hidden = 32;
  shape.particles = 6;
  PfTrainingOptions training;
  training.updates = 150;
  training.batch = 32;
  training.window = 8;
  PredictionTrial trial;
  trial.eps = 0.5;
  trial.deception = Deception::flipping;
  trial.episodes = 16;
  trial.horizon = 40;
  for (const PfCell cell : {PfCell::lstm, PfCell::gru}) {
    shape.cell = cell;
    const PfRnnPtr module = make(shape);
    PfRnnBelief belief(module);
    const PredictionErrors before = evaluate_predictions(belief, trial);
    train_pf_rnn(module, training);
    const PredictionErrors after = evaluate_predictions(belief, trial);
    RecordProperty(cell == PfCell::lstm ? "lstm" : "gru", std::to_string(after.belief));
    EXPECT_LT(after.belief, 0.8 * after.shown);
    EXPECT_LT(after.belief, 0.95 * before.belief);
    EXPECT_LT(after.exact, after.belief);
    EXPECT_EQ(after.steps, before.steps);
    EXPECT_EQ(after.shown, before.shown);
  }
}

TEST(PfRnn, TrainingIsReproducibleAndRefusesNonsense) {
  PfTrainingOptions training;
  training.updates = 3;
  training.batch = 4;
  training.window = 3;
  training.dropout = 0.2;
  const auto trained = [&] {
    const PfRnnPtr module = make(tiny(PfCell::lstm));
    train_pf_rnn(module, training);
    return torch::cat({module->named_parameters()["read.weight"].flatten(),
                       module->named_parameters()["from_hidden.weight"].flatten()});
  };
  const torch::Tensor once = trained();
  EXPECT_TRUE(torch::equal(once, trained()));
  training.seed = 2;
  EXPECT_FALSE(torch::equal(once, trained()));

  training.batch = 0;
  EXPECT_THROW(trained(), InputError);
  // As published: normalised over the batch, 30 trajectories, the state before.
  PfRnnOptions published = PfRnnOptions::published(0.1);
  published.particles = 4;
  const PfRnnPtr module = make(published);
  PfTrainingOptions as_published = PfTrainingOptions::published();
  as_published.updates = 2;
  as_published.batch = 5;
  as_published.window = 3;
  long calls = 0;
  train_pf_rnn(module, as_published, [&](const PfTrainingProgress&) { return ++calls < 1; });
  EXPECT_EQ(calls, 1);
  // One particle, on the mean: both parts of the loss are the squared distance, each once, whatever the radius.
  const torch::Tensor truth = torch::tensor({{1.0, 2.0}}), place = torch::tensor({{1.3, 2.4}});
  PfStep step;
  step.mean = place;
  step.places = place.unsqueeze(1);
  EXPECT_NEAR(pf_loss(step, truth, 0.1, as_published).item<double>(), 2 * 0.25, 1e-5);
  as_published.particles = 3;
  EXPECT_THROW(train_pf_rnn(module, as_published), InputError);
  published.eps = 0;
  EXPECT_THROW(make(published), InputError);
}

/// A training of seven updates: all of it, or cut after some and continued from what was saved by another trainer.
TensorFile trained_filter(const PfRnnOptions& shape, const PfTrainingOptions& training, std::optional<long> cut = {},
                          const std::function<void(TensorFile&)>& tamper = {}) {
  PfTrainer first(make(shape), training);
  while (first.updates() < cut.value_or(training.updates)) first.update();
  TensorFile saved{"any", {}, {}};
  first.save(saved);
  if (!cut) return saved;
  for (auto& [name, tensor] : saved.tensors) tensor = tensor.detach().clone();
  if (tamper) tamper(saved);
  PfTrainer second(make(shape), training);
  second.load(saved);
  EXPECT_EQ(second.updates(), *cut);
  while (!second.done()) second.update();
  TensorFile end{"any", {}, {}};
  second.save(end);
  return end;
}

PfTrainingOptions seven_updates() {
  PfTrainingOptions training;
  training.updates = 7;
  training.batch = 5;
  training.window = 3;
  training.horizon = 8;  // so that trajectories end
  training.dropout = 0.2;
  return training;
}

/// All but the optimiser's bytes, which name its parameters by their addresses.
bool same_tensors(TensorFile a, TensorFile b) {
  a.tensors.erase("optimiser");
  b.tensors.erase("optimiser");
  return std::equal(
      a.tensors.begin(), a.tensors.end(), b.tensors.begin(), b.tensors.end(),
      [](const auto& x, const auto& y) { return x.first == y.first && torch::equal(x.second, y.second); });
}

TEST(PfTrainer, GoesOnBitForBitFromWhatItSaved) {
  PfRnnOptions published = PfRnnOptions::published(0.1);
  published.particles = 4;
  for (const PfRnnOptions& shape : {tiny(PfCell::lstm), tiny(PfCell::gru), published}) {
    PfTrainingOptions training = seven_updates();
    if (shape.normalisation == PfNormalisation::batch) training.particles = 0;
    const TensorFile whole = trained_filter(shape, training);
    for (const long cut : {0, 1, 4, 7}) EXPECT_TRUE(same_tensors(whole, trained_filter(shape, training, cut))) << cut;
    // Nothing of what is saved is saved in vain.
    const auto differs = [&](const std::function<void(TensorFile&)>& tamper) {
      return !same_tensors(whole, trained_filter(shape, training, 4, tamper));
    };
    EXPECT_TRUE(differs([](TensorFile& file) { file.tensors["h"].add_(0.1); }));
    EXPECT_TRUE(differs([](TensorFile& file) { file.tensors["log_weights"][0][0].sub_(1); }));
    EXPECT_TRUE(differs([](TensorFile& file) { file.tensors["module.read.weight"].add_(0.1); }));
    EXPECT_TRUE(differs([&](TensorFile& file) {
      const TensorFile fresh = trained_filter(shape, training, 0);
      file.tensors["random"] = fresh.at("random");
    }));
    EXPECT_TRUE(differs([&](TensorFile& file) {
      TensorFile fresh{"any", {}, {}};
      PfTrainer(make(shape), training).save(fresh);
      file.tensors["optimiser"] = fresh.at("optimiser");
    }));
    EXPECT_TRUE(differs([](TensorFile& file) { file.tensors["trajectories"][0][1].zero_(); }));
  }
}

TEST(PfTrainer, RefusesWhatAnotherTrainingSaved) {
  const auto refused = [](const std::function<void(TensorFile&)>& tamper) {
    EXPECT_THROW(trained_filter(tiny(PfCell::lstm), seven_updates(), 4, tamper), InputError);
  };
  refused([](TensorFile& file) { file.tensors["updates"].fill_(8); });
  refused([](TensorFile& file) { file.tensors["updates"].fill_(-1); });
  refused([](TensorFile& file) { file.tensors["trajectories"][2][0].fill_(-1); });
  refused([](TensorFile& file) { file.tensors["trajectories"][2][0].fill_(1'000'000); });
  refused([](TensorFile& file) { file.tensors["trajectories"][2][1].fill_(8); });
  refused([](TensorFile& file) { file.tensors.erase("h"); });
  refused([](TensorFile& file) { file.tensors["h"] = torch::zeros({1, 2, 3}); });
  refused([](TensorFile& file) { file.tensors["random"] = torch::zeros({7}, torch::kUInt8); });
  refused([](TensorFile& file) { file.tensors["optimiser"] = torch::zeros({7}, torch::kUInt8); });
}

TEST(PfRnn, KeepsAllItsNumbersInAFile) {
  for (PfRnnOptions options : {tiny(PfCell::gru), PfRnnOptions::published(0.25)}) {
    const PfRnnPtr module = make(options);
    if (options.normalisation == PfNormalisation::batch) {
      module->named_buffers()["candidate.batch.running_mean"].fill_(0.125);
    }
    TensorFile file{"any", {}, {}};
    put_module(file, "filter", *module);
    Stream others(99);
    const auto back = std::make_shared<PfRnn>(options, others);
    EXPECT_NE(checksum_of(*back), checksum_of(*module));
    get_module(file, "filter", *back);
    EXPECT_EQ(checksum_of(*back), checksum_of(*module));
    const auto buffers = back->named_buffers();
    for (const auto& item : module->named_buffers()) EXPECT_TRUE(torch::equal(item.value(), buffers[item.key()]));
    options.hidden += 1;
    Stream again(1);
    PfRnn wider(options, again);
    EXPECT_THROW(get_module(file, "filter", wider), InputError);
  }
}

}  // namespace
}  // namespace maximin::deep
