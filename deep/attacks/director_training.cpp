#include <maximin/deep/attacks/director_training.hpp>

#include <limits>
#include <optional>

#include <fmt/format.h>

#include <maximin/deep/attacks/simple_attacks.hpp>
#include <maximin/deep/range_check.hpp>
#include <maximin/theory/error.hpp>
#include <maximin/theory/rollout_in_step.hpp>

namespace maximin::deep {
namespace {

// Streams of one training: lane l in stretch n draws from number n * 2^20 + l, the shuffles of all stretches from
// 2^63, and the evaluation, of another seed, shares none.
constexpr std::uint64_t shuffle_stream = std::uint64_t{1} << 63U;
constexpr std::uint64_t evaluation_seed_bit = std::uint64_t{1} << 63U;

/// The lanes in play, and what was met there since the last round of learning.
class Play {
 public:
  Play(Director& director, GridAgent& agent, const ContinuousGridworld& world, const DirectorTraining& options,
       long stretch)
      : director_(director), bounded_(director, director.ball()), agent_(agent), world_(world), options_(options) {
    const auto n = static_cast<std::size_t>(options.lanes);
    agent.resize(options.lanes);
    director.resize(options.lanes);
    truths_.resize(n);
    episodes_.resize(n);
    for (Lane lane = 0; lane < options.lanes; ++lane) {
      lanes_.push_back(lane);
      streams_.emplace_back(options.seed,
                            static_cast<std::uint64_t>(stretch) << 20U | static_cast<std::uint64_t>(lane));
      begin(lane);
    }
  }

  Experience experience() {
    torch::NoGradGuard no_grad;
    const long t = options_.ticks, n = options_.lanes;
    rewards_ = torch::zeros({t, n});
    over_ = torch::zeros({t, n});
    std::vector<Director::Decision> met;
    std::vector<torch::Tensor> values;
    for (long tick = 0; tick < t; ++tick) {
      step(tick);
      met.push_back(director_.decision());
      values.push_back(met.back().value);
    }
    values.push_back(director_.network()->value(director_.look(lanes_, truths_, agent_).features));
    const torch::Tensor value = torch::stack(values);
    const torch::Tensor advantage =
        generalised_advantage(rewards_, value, over_, options_.ppo.discount, options_.ppo.trace_decay);
    const auto all = [&](auto&& part) {
      std::vector<torch::Tensor> parts;
      for (const auto& decision : met) parts.push_back(part(decision));
      return torch::cat(parts);
    };
    return {{all([](auto& d) { return d.situations.features; }), all([](auto& d) { return d.situations.prior; })},
            all([](auto& d) { return d.choices; }),
            all([](auto& d) { return d.log_probability; }),
            advantage.flatten(),
            (advantage + value.narrow(0, 0, t)).flatten()};
  }

  /// The agent's mean return in the episodes that are over.
  double mean_return() const {
    return ended_ > 0 ? sum_ / static_cast<double>(ended_) : std::numeric_limits<double>::quiet_NaN();
  }

 private:
  void begin(Lane lane) {
    const auto l = static_cast<std::size_t>(lane);
    truths_[l] = world_.reset(streams_[l]);
    episodes_[l] = {};
    agent_.forget(lane);
    director_.forget(lane);
  }

  // The horizon is a true end: the director knows how much time is left.
  void step(long tick) {
    std::vector<Point> shown(lanes_.size());
    std::vector<Action> actions(lanes_.size());
    bounded_.perturb(lanes_, truths_, agent_, streams_, shown);
    agent_.act(lanes_, shown, streams_, actions);
    float* reward = rewards_[tick].data_ptr<float>();
    float* over = over_[tick].data_ptr<float>();
    for (std::size_t l = 0; l < lanes_.size(); ++l) {
      const Outcome<Point> outcome = world_.step(truths_[l], actions[l]);
      truths_[l] = outcome.next;
      reward[l] = static_cast<float>(-options_.pay * outcome.reward);
      episodes_[l].total_reward += outcome.reward;
      if (++episodes_[l].steps < options_.horizon && !outcome.terminal) continue;
      over[l] = 1;
      sum_ += episodes_[l].total_reward;
      ++ended_;
      begin(lanes_[l]);
    }
  }

  Director& director_;
  WithinBallInStep bounded_;
  GridAgent& agent_;
  const ContinuousGridworld& world_;
  const DirectorTraining& options_;
  std::vector<Lane> lanes_;
  std::vector<Stream> streams_;
  std::vector<Point> truths_;
  std::vector<Episode> episodes_;
  torch::Tensor rewards_, over_;
  double sum_ = 0;
  long ended_ = 0;
};

double evaluate(Director& director, GridAgent& agent, ContinuousGridworld world, const DirectorTraining& options,
                Director::Play play) {
  const Director::Play before = director.play();
  director.set_play(play);
  EpisodesInStep episodes;
  episodes.horizon = options.horizon;
  episodes.episodes = options.evaluation_episodes;
  episodes.seed = options.seed ^ evaluation_seed_bit;
  episodes.lanes = options.lanes;
  WithinBallInStep bounded(director, director.ball());
  double sum = 0;
  for (const Episode& e : rollout_in_step(world, agent, bounded, episodes)) sum += e.total_reward;
  director.set_play(before);
  return sum / static_cast<double>(options.evaluation_episodes);
}

/// The best director so far.
class Champion {
 public:
  explicit Champion(double pay) : pay_(pay) {}
  void consider(Director& director, double agent_return, Director::Play play) {
    if (file_ && !(pay_ * agent_return < pay_ * agent_return_)) return;
    const Director::Play before = director.play();
    director.set_play(play);
    file_ = director.save();
    for (auto& [name, tensor] : file_->tensors) tensor = tensor.detach().clone();
    director.set_play(before);
    agent_return_ = agent_return;
  }
  void reinstate(Director& director) const { director.load(*file_); }

 private:
  double pay_, agent_return_ = 0;
  std::optional<TensorFile> file_;
};

}  // namespace

void DirectorTraining::check() const {
  const RangeCheck require("director training");
  require(frames >= 0, "frames", double(frames), "0 or more");
  require(lanes >= 1 && lanes <= 4096, "lanes", lanes, "1 to 4096");
  require(ticks >= 1, "ticks", double(ticks), "at least 1");
  require(horizon >= 1, "horizon", double(horizon), "at least 1");
  require(pay != 0, "pay", pay, "any number but 0");
  require(stretch_frames >= 1, "stretch_frames", double(stretch_frames), "at least 1");
  require(evaluation_episodes >= 1, "evaluation_episodes", double(evaluation_episodes), "at least 1");
  ppo.check();
}

std::vector<DirectorPoint> train_director(Director& director, GridAgent& agent, const ContinuousGridworld& world,
                                          const DirectorTraining& options, const DirectorCallback& callback) {
  options.check();
  Ppo ppo(director.network(), options.ppo);
  Stream shuffles(options.seed, shuffle_stream);
  Champion champion(options.pay);
  std::vector<DirectorPoint> points;
  DirectorPoint point;
  point.training_return = std::numeric_limits<double>::quiet_NaN();
  for (long stretch = 0;; ++stretch) {
    point.sampled_return = evaluate(director, agent, world, options, Director::Play::sampled);
    point.greedy_return = evaluate(director, agent, world, options, Director::Play::greedy);
    champion.consider(director, point.sampled_return, Director::Play::sampled);
    champion.consider(director, point.greedy_return, Director::Play::greedy);
    points.push_back(point);
    if ((callback && !callback(point)) || point.frames >= options.frames) break;
    director.set_play(Director::Play::sampled);
    Play play(director, agent, world, options, stretch);
    const long until = std::min(options.frames, point.frames + options.stretch_frames);
    while (point.frames < until) {
      const Experience experience = play.experience();
      ppo.learn(experience, static_cast<double>(point.frames) / static_cast<double>(options.frames), shuffles);
      point.frames += options.ticks * options.lanes;
    }
    point.training_return = play.mean_return();
  }
  champion.reinstate(director);
  return points;
}

}  // namespace maximin::deep
