#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <maximin/theory/error.hpp>
#include <maximin/theory/metric.hpp>
#include <maximin/theory/types.hpp>

namespace maximin {

/// What an attacker may do to an observation: B(s) = { t in S : |x_s - x_t| <= eps } for every state (paper,
/// section 2.2), closed, symmetric and containing s. Built once, as neighbour lists, and shared by every algorithm.
///
/// Symmetry makes one list serve both sides: B(s) is what the attacker may show when s is true, and what the agent must
/// believe possible when it is shown s.
template <class Scalar>
class Perturbation {
 public:
  using Ball = std::span<const State>;

  /// The most members that all balls together may have (1 GiB of neighbour lists).
  static constexpr std::size_t max_members = std::size_t{1} << 28;
  /// The most pairs of states whose distance is looked at: beyond 100,000 states a metric must be the discrete one.
  static constexpr std::size_t max_pairs = 10'000'000'000;

  /// The closed balls of radius eps >= 0. Throws InputError when eps is negative or not finite, and when the balls have
  /// more than `max_members` members or the states more than `max_pairs` pairs, before memory or hours are spent.
  ///
  /// For an inexact scalar a state counts as inside when its distance exceeds eps by rounding only (a relative 1e-12),
  /// so that points 0.1 apart on a grid are neighbours at eps = 0.1. `radius()` tells the largest distance inside a
  /// ball, and bounds are computed with it: they stay true.
  Perturbation(Metric<Scalar> metric, Scalar eps) : Perturbation(std::move(metric), eps, Empty{}) {
    Scalar limit = eps_;
    if constexpr (!is_exact_v<Scalar>) limit = eps_ * Scalar(1 + 1e-12);
    if (metric_.is_discrete()) {
      fill_discrete(limit);
    } else {
      fill([&](State s, State t) {
        const Scalar d = metric_.distance(s, t);
        if (!(d <= limit) && s != t) return false;
        if (d > radius_) radius_ = d;
        return true;
      });
    }
  }

  /// The same balls, where the caller decides whether t is in B(s): for distances that the scalar cannot express, such
  /// as roots. `inside` must be symmetric and hold for s = t.
  template <class Inside>
  static Perturbation decided_by(Metric<Scalar> metric, Scalar eps, Inside inside) {
    Perturbation balls(std::move(metric), eps, Empty{});
    balls.fill(inside);
    return balls;
  }

  /// Balls given outright: lists[s] holds the states of B(s) in any order. The metric is then the number of balls to
  /// cross (hops in the neighbourhood graph, infinite where no path leads) and eps is 1, which gives back exactly these
  /// balls. Throws InputError on an empty ball, a state out of range or listed twice, a ball without its centre, or
  /// lists that are not symmetric.
  static Perturbation from_neighbourhoods(const std::vector<std::vector<State>>& lists) {
    check(lists);
    return Perturbation(Metric<Scalar>::from_shortest_paths(hops(lists)), Scalar(1));
  }

  /// The largest model whose balls may be given outright: their metric is stored as a |S| x |S| matrix.
  static constexpr State max_listed_states = 10'000;

  State states() const { return static_cast<State>(begin_.size() - 1); }

  /// B(s), ascending.
  Ball ball(State s) const {
    const auto i = static_cast<std::size_t>(s);
    return Ball(neighbours_).subspan(begin_[i], begin_[i + 1] - begin_[i]);
  }

  /// Whether t is in B(s).
  bool contains(State s, State t) const {
    const Ball b = ball(s);
    return std::binary_search(b.begin(), b.end(), t);
  }

  const Metric<Scalar>& metric() const { return metric_; }
  /// eps as asked for.
  const Scalar& eps() const { return eps_; }
  /// The largest distance from a centre to a member of its ball, or eps if that is larger: what bounds must use as eps.
  const Scalar& radius() const { return radius_; }

  /// Number of states in the largest ball.
  State largest_ball() const {
    std::size_t largest = 0;
    for (std::size_t s = 0; s + 1 < begin_.size(); ++s) largest = std::max(largest, begin_[s + 1] - begin_[s]);
    return static_cast<State>(largest);
  }

 private:
  struct Empty {};
  Perturbation(Metric<Scalar> metric, Scalar eps, Empty) : metric_(std::move(metric)), eps_(eps), radius_(eps) {
    if (!(eps >= Scalar(0)) || !(eps - eps == Scalar(0)))
      throw InputError("eps: negative or not finite, expected eps >= 0");
    begin_.push_back(0);
  }

  template <class Inside>
  void fill(Inside inside) {
    const auto n = static_cast<std::size_t>(metric_.states());
    if (n > max_pairs / n) {
      throw InputError("metric: " + std::to_string(n) + " states have more than " + std::to_string(max_pairs) +
                       " pairs, expected a smaller model or the discrete metric");
    }
    for (State s = 0; s < metric_.states(); ++s) {
      for (State t = 0; t < metric_.states(); ++t) {
        if (inside(s, t)) neighbours_.push_back(t);
      }
      require_members(neighbours_.size());
      begin_.push_back(neighbours_.size());
    }
  }

  /// Distances are 0 and 1: a ball is its centre or everything.
  void fill_discrete(const Scalar& limit) {
    const auto n = static_cast<std::size_t>(metric_.states());
    const bool everything = limit >= Scalar(1);
    if (everything) require_members(n * n);
    if (everything && n > 1 && Scalar(1) > radius_) radius_ = Scalar(1);
    for (State s = 0; s < metric_.states(); ++s) {
      for (State t = everything ? 0 : s; t < (everything ? metric_.states() : s + 1); ++t) neighbours_.push_back(t);
      begin_.push_back(neighbours_.size());
    }
  }

  void require_members(std::size_t members) const {
    if (members <= max_members) return;
    throw InputError("eps: the balls of " + std::to_string(metric_.states()) + " states have more than " +
                     std::to_string(max_members) + " members, expected a smaller eps or model");
  }

  static std::string at(std::size_t s) { return "neighbourhoods[" + std::to_string(s) + "]"; }

  static void check(const std::vector<std::vector<State>>& lists) {
    if (lists.empty()) throw InputError("neighbourhoods: empty, expected one list per state");
    if (lists.size() > max_listed_states) {
      throw InputError("neighbourhoods: " + std::to_string(lists.size()) + " lists, expected at most " +
                       std::to_string(max_listed_states) + "; give points and a norm instead");
    }
    const auto n = static_cast<State>(lists.size());
    const auto has = [&](State s, State t) {
      const auto& list = lists[static_cast<std::size_t>(s)];
      return std::find(list.begin(), list.end(), t) != list.end();
    };
    for (std::size_t s = 0; s < lists.size(); ++s) {
      if (lists[s].empty()) throw InputError(at(s) + ": empty ball, expected at least the state itself");
      for (const State t : lists[s]) {
        if (t < 0 || t >= n) {
          throw InputError(at(s) + ": state " + std::to_string(t) + " does not exist, expected 0 to " +
                           std::to_string(n - 1));
        }
        if (std::count(lists[s].begin(), lists[s].end(), t) > 1) {
          throw InputError(at(s) + ": state " + std::to_string(t) + " listed twice, expected each state once");
        }
        if (!has(t, static_cast<State>(s))) {
          throw InputError(at(s) + ": lists state " + std::to_string(t) +
                           ", which does not list it back, expected symmetric balls");
        }
      }
      if (!has(static_cast<State>(s), static_cast<State>(s))) {
        throw InputError(at(s) + ": lacks state " + std::to_string(s) +
                         " itself, expected a ball to contain its centre");
      }
    }
  }

  /// Breadth-first distances in the graph of the lists; infinity (or |S|, beyond any path, for an exact scalar) where
  /// no path leads.
  static QTable<Scalar> hops(const std::vector<std::vector<State>>& lists) {
    const auto n = static_cast<Eigen::Index>(lists.size());
    const Scalar unreachable =
        std::numeric_limits<Scalar>::has_infinity ? Scalar(std::numeric_limits<Scalar>::infinity()) : Scalar(n);
    QTable<Scalar> d = QTable<Scalar>::Constant(n, n, unreachable);
    std::vector<State> queue;
    for (State s = 0; s < n; ++s) {
      queue.assign(1, s);
      d(s, s) = Scalar(0);
      for (std::size_t head = 0; head < queue.size(); ++head) {
        const State from = queue[head];
        for (const State to : lists[static_cast<std::size_t>(from)]) {
          if (to == s || d(s, to) < unreachable) continue;
          d(s, to) = d(s, from) + Scalar(1);
          queue.push_back(to);
        }
      }
    }
    return d;
  }

  Metric<Scalar> metric_;
  Scalar eps_;
  Scalar radius_;
  std::vector<std::size_t> begin_;  // |S| + 1 offsets into neighbours_
  std::vector<State> neighbours_;
};

}  // namespace maximin
