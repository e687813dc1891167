#include <maximin/deep/attacks/adaptive_director.hpp>

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include <maximin/deep/attacks/ball_places.hpp>
#include <maximin/theory/error.hpp>

namespace maximin::deep {
namespace {

constexpr long action_count = ContinuousGridworld::actions;
// Whether it has begun, its last action, where the belief's mean and hull lie, the last offset.
constexpr long mind_features = 1 + action_count + 2 + 4 + 2;

int checked(int grid) {
  if (grid < 2 || grid > 15) throw InputError(fmt::format("adaptive director: grid {}, expected 2 to 15", grid));
  return grid;
}

long candidates_of(int grid) {
  return static_cast<long>(checked(grid)) * grid;
}

}  // namespace

AdaptiveDirector::AdaptiveDirector(std::shared_ptr<ActionValueModule> judge, const ObservationBall& ball,
                                   const AdaptiveDirectorOptions& options)
    : Director(ball, options.director, mind_features + candidates_of(options.grid) * (action_count + 1),
               candidates_of(options.grid)),
      judge_(std::move(judge)),
      options_(options) {}

void AdaptiveDirector::resize(Lane lanes) {
  Director::resize(lanes);
  last_.assign(static_cast<std::size_t>(lanes), no_choice);
}

void AdaptiveDirector::forget(Lane lane) {
  Director::forget(lane);
  last_[static_cast<std::size_t>(lane)] = no_choice;
}

Point AdaptiveDirector::place(Point truth, int choice) const {
  return grid_place(ball(), truth, options_.grid, choice % options_.grid, choice / options_.grid);
}

/// What each place would provoke, lane by lane.
std::vector<Action> AdaptiveDirector::provoked(std::span<const Lane> lanes, std::span<const Point> truths,
                                               const GridAgent& agent) const {
  std::vector<Lane> asked;
  std::vector<Point> places;
  for (std::size_t k = 0; k < lanes.size(); ++k) {
    for (int c = 0; c < choices(); ++c) places.push_back(place(truths[k], c));
    asked.resize(places.size(), lanes[k]);
  }
  std::vector<Action> answers(places.size());
  agent.would_do(asked, places, answers);
  return answers;
}

/// How bad the judge finds what is provoked, 0 for its best action to 1 for its worst, [n, choices].
torch::Tensor AdaptiveDirector::harm(std::span<const Point> truths, const std::vector<Action>& provoked) const {
  const auto n = static_cast<long>(truths.size());
  if (!judge_) return torch::zeros({n, choices()});
  const torch::Tensor q = values_at(*judge_, truths);
  const torch::Tensor best = q.amax(1, true), worst = q.amin(1, true);
  const torch::Tensor there = q.gather(1, torch::tensor(provoked, torch::kLong).view({n, choices()}));
  return (best - there) / (best - worst).clamp_min(1e-6);
}

/// What is in the agent's mind, seen from the truth in units of the ball.
float* AdaptiveDirector::write_mind(Lane lane, Point truth, const GridAgent& agent, float* out) const {
  const Mind mind = agent.mind(lane);
  const double unit = 1 / std::max(ball().eps(), 1e-3);
  const auto put = [&](double v) { *out++ = static_cast<float>(v); };
  const auto put_near = [&](double v) { put(mind.awake ? std::clamp(v * unit, -4.0, 4.0) : 0); };
  put(mind.awake);
  for (Action a = 0; a < action_count; ++a) put(mind.awake && a == mind.last_action);
  put_near(mind.mean.x - truth.x);
  put_near(mind.mean.y - truth.y);
  put_near(mind.hull.x_low - truth.x);
  put_near(mind.hull.x_high - truth.x);
  put_near(mind.hull.y_low - truth.y);
  put_near(mind.hull.y_high - truth.y);
  const int last = last_[static_cast<std::size_t>(lane)];
  const double centre = (options_.grid - 1) / 2.0;
  put(last == no_choice ? 0 : (last % options_.grid - centre) / centre);
  put(last == no_choice ? 0 : (last / options_.grid - centre) / centre);
  return out;
}

Situations AdaptiveDirector::look(std::span<const Lane> lanes, std::span<const Point> truths,
                                  const GridAgent& agent) const {
  torch::NoGradGuard no_grad;
  const std::vector<Action> answers = provoked(lanes, truths, agent);
  const torch::Tensor harms = harm(truths, answers);
  const float* harm_at = harms.data_ptr<float>();
  torch::Tensor features = blank_features(lanes.size());
  float* out = features.data_ptr<float>();
  auto answer = answers.begin();
  for (std::size_t k = 0; k < lanes.size(); ++k) {
    out = write_place(lanes[k], truths[k], out);
    out = write_mind(lanes[k], truths[k], agent, out);
    for (int c = 0; c < choices(); ++c) {
      out[*answer++] = 1;
      out += action_count;
      *out++ = *harm_at++;
    }
  }
  return {features, harms * options_.prior};
}

void AdaptiveDirector::realise(std::span<const Lane> lanes, std::span<const Point> truths, std::span<const int> choices,
                               std::span<Stream>, std::span<Point> shown) {
  for (std::size_t k = 0; k < lanes.size(); ++k) {
    shown[k] = place(truths[k], choices[k]);
    last_[static_cast<std::size_t>(lanes[k])] = choices[k];
  }
}

nlohmann::ordered_json AdaptiveDirector::about() const {
  nlohmann::ordered_json out = Director::about();
  out["attack"] = "adaptive-director";
  out["grid"] = options_.grid;
  out["prior"] = judge_ ? options_.prior : 0;
  return out;
}

}  // namespace maximin::deep
