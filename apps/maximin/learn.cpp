#include <fmt/format.h>
#include <algorithm>
#include <atomic>
#include <memory>
#include <vector>

#include <maximin/apps/common/interrupt.hpp>
#include <maximin/apps/common/option_checks.hpp>
#include <maximin/apps/common/program.hpp>
#include <maximin/apps/common/progress.hpp>
#include <maximin/apps/common/table.hpp>
#include <maximin/apps/maximin/commands.hpp>
#include <maximin/apps/maximin/describe.hpp>
#include <maximin/tabular/optimal_attack.hpp>
#include <maximin/tabular/pessimistic_q_iteration.hpp>
#include <maximin/tabular/pessimistic_q_learning.hpp>
#include <maximin/tabular/policy_iteration.hpp>

namespace maximin::apps {

namespace {

struct LearnOptions {
  ModelOptions model;
  OutputOptions output;
  std::string uncertainty = "ball";
  long episodes = 1000;
  long horizon = 1000;
  double exploration = 0.1;
  double step_exponent = 0.7;
  double step_size = 0;  ///< constant; 0: by the exponent
  std::uint64_t seed = 1;
};

/// A point of the learning curve: the mean over the episodes since the one before.
struct CurvePoint {
  long episodes = 0;
  long steps = 0;
  double mean_return = 0;
  double distance = 0;  ///< max |Q - Q_n|, Q_n the last of pessimistic Q-iteration
};

/// The learning and what it is measured against.
struct Learned {
  PessimisticQLearning<double> learning;
  std::vector<CurvePoint> curve;
  CertifiedSolution<double> optimal;
  PessimisticQIteration<double> iteration;
  RobustEvaluation<double> attacked;  ///< the learned policy against the optimal attack
  bool interrupted = false;
};

PessimisticQLearningOptions learning_options(const LearnOptions& options) {
  PessimisticQLearningOptions learning;
  learning.uncertainty = options.uncertainty == "belief" ? Uncertainty::belief : Uncertainty::ball;
  learning.episodes = options.episodes;
  learning.horizon = options.horizon;
  learning.exploration = ExplorationSchedule::constant(options.exploration);
  learning.step_size = options.step_size > 0 ? StepSizeSchedule::constant(options.step_size)
                                             : StepSizeSchedule::polynomial(options.step_exponent);
  learning.seed = options.seed;
  return learning;
}

Learned learn_policy(const LearnOptions& options, const Problem& problem) {
  const auto& mdp = problem.model.mdp;
  Learned result;
  result.optimal = policy_iteration(mdp);
  result.iteration = pessimistic_q_iteration(mdp, problem.perturbation);
  const auto environment = problem.model.start.empty() ? TabularEnvironment<double>(mdp)
                                                       : TabularEnvironment<double>(mdp, problem.model.start);
  const std::atomic<bool>& stop = stop_on_interrupt();
  Progress progress("episodes", options.episodes);
  const long points = std::min(options.episodes, 10L);
  double sum = 0;
  long since = 0;
  const auto observe = [&](const LearningProgress<double>& at) {
    progress.advance();
    sum += at.discounted_return;
    ++since;
    const long done = at.episode + 1;
    if (done * points / options.episodes > (done - 1) * points / options.episodes || stop) {
      const double distance = (at.q - result.iteration.q).cwiseAbs().maxCoeff();
      result.curve.push_back({done, at.steps, sum / static_cast<double>(since), distance});
      sum = 0;
      since = 0;
    }
    return !stop.load();
  };
  result.learning =
      pessimistic_q_learning<double>(environment, problem.perturbation, learning_options(options), observe);
  result.attacked = evaluate_against_optimal_attack(mdp, problem.perturbation, result.learning.policy);
  result.interrupted = stop && result.learning.episodes < options.episodes;
  return result;
}

const char* fate_text(Fate fate) {
  return fate == Fate::settled ? "which settles" : fate == Fate::cycles ? "which cycles" : "whose fate is undetermined";
}

std::string learned_text(const LearnOptions& options, const Problem& problem, const Learned& learned) {
  const Model<double>& model = problem.model;
  std::string text = model_line(problem) + balls_line(problem);
  text += fmt::format("Pessimistic Q-learning over the {}: {} episodes, {} steps, seed {}; {}.\n\n",
                      options.uncertainty, learned.learning.episodes, learned.learning.steps, options.seed,
                      learned.learning.visits.minCoeff() > 0 ? "every (state, action) was tried"
                                                             : "some (state, action) was never tried");
  Table curve;
  curve.column("episodes").column("steps").column("mean return", Align::point).column("max |Q - Q_n|", Align::point);
  for (const CurvePoint& p : learned.curve) {
    curve.row({std::to_string(p.episodes), std::to_string(p.steps), number(p.mean_return), number(p.distance)});
  }
  text += curve.text();
  text += fmt::format(
      "Q_n is the last of pessimistic Q-iteration, {}. Returns are of the learner: attacked and exploring.\n\n",
      fate_text(learned.iteration.fate));
  Table table;
  table.column("state", Align::left).column("V*", Align::point).column("under optimal attack", Align::point);
  table.column("would do", Align::left).column("is shown", Align::left).column("does", Align::left);
  for (State s = 0; s < model.mdp.states(); ++s) {
    const auto i = static_cast<std::size_t>(s);
    table.row({model.state_name(s), number(learned.optimal.v[s], learned.optimal.error),
               number(learned.attacked.v[s], learned.attacked.error), model.action_name(learned.learning.policy[i]),
               model.state_name(learned.attacked.attack[i]), model.action_name(learned.attacked.composed[i])});
  }
  text += table.text(options.output.rows());
  return text + fmt::format("The learned policy keeps {} of V* = {} from the start, under the optimal attack.\n",
                            number(start_mean(model, learned.attacked.v)),
                            number(start_mean(model, learned.optimal.v)));
}

Json learned_json(const LearnOptions& options, const Problem& problem, const Learned& learned) {
  Json json;
  json["command"] = "learn";
  json["version"] = MAXIMIN_VERSION;
  json["model"] = model_json(problem.model);
  json["balls"] = balls_json(problem);
  json["uncertainty"] = options.uncertainty;
  json["seed"] = options.seed;
  json["episodes"] = learned.learning.episodes;
  json["steps"] = learned.learning.steps;
  json["interrupted"] = learned.interrupted;
  Json curve = Json::array();
  for (const CurvePoint& p : learned.curve) {
    Json point;
    point["episodes"] = p.episodes;
    point["steps"] = p.steps;
    point["mean_return"] = p.mean_return;
    point["distance_to_iteration"] = p.distance;
    curve.push_back(std::move(point));
  }
  json["curve"] = std::move(curve);
  json["q"] = to_json(learned.learning.q);
  json["policy"] = learned.learning.policy;
  json["attack"] = learned.learning.attack;
  json["v_star"] = to_json(learned.optimal.v);
  json["v_under_optimal_attack"] = to_json(learned.attacked.v);
  return json;
}

int learn(const LearnOptions& options) {
  const Problem problem = load_problem(options.model);
  const Learned learned = learn_policy(options, problem);
  print(options.output.json ? json_text(learned_json(options, problem, learned))
                            : learned_text(options, problem, learned));
  if (!learned.interrupted) return ExitCode::success;
  note("interrupted; the result is of the episodes done so far");
  return ExitCode::interrupted;
}

void declare(CLI::App& app, LearnOptions& options) {
  app.add_option("--uncertainty", options.uncertainty,
                 "what the learner is pessimistic over: the ball of what it sees\n(Algorithm 1), or its belief")
      ->check(one_of({"ball", "belief"}))
      ->type_name("WORD")
      ->capture_default_str();
  app.add_option("--episodes", options.episodes, "episodes to learn from")
      ->check(whole_number(1, 1'000'000'000))
      ->type_name("N")
      ->capture_default_str();
  app.add_option("--horizon", options.horizon, "steps after which an episode is cut")
      ->check(whole_number(1, 1'000'000'000))
      ->type_name("N")
      ->capture_default_str();
  app.add_option("--exploration", options.exploration, "chance of a random action")
      ->check(real_number({.low = 0, .high = 1}))
      ->type_name("P")
      ->capture_default_str();
  app.add_option("--step-exponent", options.step_exponent, "step size 1/(1+visits)^X")
      ->check(real_number({.low = 0, .high = 1, .above = true}))
      ->type_name("X")
      ->capture_default_str();
  app.add_option("--step-size", options.step_size, "constant step size, instead")
      ->check(real_number({.low = 0, .high = 1, .above = true}))
      ->type_name("X");
  app.add_option("--seed", options.seed, "seed; episode k is the same whatever the number of episodes")
      ->check(seed_number())
      ->type_name("N")
      ->capture_default_str();
}

}  // namespace

void add_learn(CLI::App& app, Task& task) {
  auto options = std::make_shared<LearnOptions>();
  auto* sub = app.add_subcommand("learn", "pessimistic Q-learning (Algorithm 1), beside pessimistic Q-iteration");
  declare(*sub, options->model);
  declare(*sub, *options);
  declare(*sub, options->output);
  sub->footer(
      "Ends cleanly on an interrupt, with what was learned so far (exit code 130).\n"
      "Examples:\n"
      "  maximin learn model.json --episodes 5000 --eps 1\n"
      "  maximin learn model.json --uncertainty belief --exploration 0.3 --json");
  sub->callback([options, &task] { task = [options] { return learn(*options); }; });
}

}  // namespace maximin::apps
