#pragma once

#include <memory>
#include <optional>
#include <vector>

#include <maximin/deep/losses/perturbation_ramp.hpp>
#include <maximin/deep/losses/td_error.hpp>
#include <maximin/theory/random.hpp>

namespace maximin::deep {

/// (1 - share) Q + share Q_w: the action values of a worst-case aware agent. Both networks are registered here, so that
/// whoever acts by them finds their device; they are saved and trained where they belong.
class WorstCaseAwareValues final : public ActionValueModule {
 public:
  WorstCaseAwareValues(QNetworkPtr q, QNetworkPtr worst, double share)
      : q_(register_module("q", std::move(q))), worst_(register_module("worst", std::move(worst))), share_(share) {}
  torch::Tensor forward(const torch::Tensor& states) override {
    return (1 - share_) * q_->forward(states) + share_ * worst_->forward(states);
  }

 private:
  QNetworkPtr q_, worst_;
  double share_;
};

/// What keeps the network smooth in the ball.
enum class WocarRobustTerm {
  /// Huber errors of the bad end of each range over the ball: of lower(taken) from the target y, of upper(a) from
  /// Q(s,a)
  /// for the other actions. Released; Radial-DQN's first approach.
  bad_ends,
  both_ends,  ///< the same with the worse of the two ends of each range: the released code's other setting
  /// The hinge of SA-DQN times the state's importance w(s) = max_a Q_w(s,a) - min_a Q_w(s,a), divided by the batch's
  /// mean
  /// importance so that no scale enters. The paper's state importance, in the form that suits action values.
  important_hinge,
  none,
};

struct WocarLossOptions {
  TdOptions td{};
  PerturbationRamp ramp{};
  double worst_share = 0.05;  ///< xi of the acting values (1 - xi) Q + xi Q_w, .01 to .05 in the paper
  double kappa = 0.8;         ///< share of the temporal difference against the robust term, at the full radius
  bool ramp_kappa = true;     ///< the share falls from 1 to kappa as the radius grows, as released
  WocarRobustTerm robust_term = WocarRobustTerm::bad_ends;
  double hinge_margin = 1;  ///< c of `important_hinge`, in units of Q

  BoundMethod reach_bounds = BoundMethod::ibp;   ///< of which actions the attacker can bring about
  BoundMethod robust_bounds = BoundMethod::ibp;  ///< of the robust term
  /// The radius that the worst-case critic believes in at all times; unset: the ramp's. Released: 0.001.
  std::optional<double> critic_eps{};
  /// Reachable actions are those of the acting values; else of Q alone, as released, though the agent acts by both.
  bool reach_of_acting_values = true;
  /// No target of the critic is below it, in units of Q: a minimum over actions that were hardly tried, of what a
  /// network makes of them, otherwise feeds on itself, and runs off below every return that there is. Unset: as
  /// published.
  std::optional<double> critic_floor{};
  /// The critic's target takes the actions reachable at the state before instead of at the next one: a slip of the
  /// released code, here for comparison.
  bool reach_at_state = false;
  /// The critic's target is of a target network; else of the critic itself, as released.
  bool critic_target_network = true;

  /// Throws InputError, naming the option, when one is out of range.
  void check() const;
};

/// WocaR-DQN (Liang et al. 2022): two action-value networks side by side. Q learns what the agent gains unattacked when
/// it acts by (1 - xi) Q + xi Q_w; the worst-case critic Q_w learns what it gains when an attacker of radius eps
/// chooses among the actions it can bring about,
///
///     y_w = R + gamma (1 - terminal) min_{a reachable in B(s')} Q_w'(s', a).
///
/// The loss is kappa TD + (1 - kappa) robust term + TD of the critic. The critic shares no weight with Q, so that with
/// an optimiser like Adam its weight against the rest is of no account but for clipping, which is of the joint
/// gradient.
class WocarLoss final : public Loss {
 public:
  /// The critic begins with weights of its own from `rng`. Throws InputError, naming the option, when one is out of
  /// range.
  WocarLoss(const WocarLossOptions& options, const QNetworkShape& shape, Stream& rng);
  LossValue operator()(const Batch& batch, QNetwork& online, QNetwork& target, const Progress& progress) override;

  /// The critic and its target network, which needs no gradients.
  std::vector<std::shared_ptr<torch::nn::Module>> modules() override { return {critic_, critic_target_}; }
  void copy_targets() override { critic_target_->copy_from(*critic_); }
  std::shared_ptr<ActionValueModule> acting(QNetworkPtr online) override {
    return std::make_shared<WorstCaseAwareValues>(std::move(online), critic_, options_.worst_share);
  }

  /// Lets the critic and its target network start from what another network has learned.
  void start_from(const QNetwork& q);
  QNetwork& critic() { return *critic_; }
  QNetwork& critic_target() { return *critic_target_; }

  /// Actions that an attacker may bring about at these states, [b, actions], bool: those that the action which is
  /// greedy at the state does not provably beat in all of the ball. None that can be brought about is missing.
  torch::Tensor reachable(const torch::Tensor& states, QNetwork& online, const Progress& progress) const;
  /// y, [b], without gradient: the acting values choose the next action.
  torch::Tensor target_values(const Batch& batch, QNetwork& online, QNetwork& target) const;
  /// y_w, [b], without gradient.
  torch::Tensor critic_target_values(const Batch& batch, QNetwork& online, const Progress& progress) const;
  /// The robust term, [b], given Q(s, .) ([b, actions]) and y ([b]).
  torch::Tensor robust_term(const Batch& batch, QNetwork& online, const torch::Tensor& values, const torch::Tensor& y,
                            const Progress& progress) const;

 private:
  torch::Tensor mix(const torch::Tensor& q, const torch::Tensor& worst) const {
    return (1 - options_.worst_share) * q + options_.worst_share * worst;
  }

  WocarLossOptions options_;
  QNetworkPtr critic_, critic_target_;
};

}  // namespace maximin::deep
