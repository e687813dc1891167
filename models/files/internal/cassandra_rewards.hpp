#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <unordered_map>
#include <utility>
#include <vector>

namespace maximin::internal {

/// The `R:` lines of a Cassandra file: R(a, s, s', o), where later lines override earlier ones and any of the four may
/// be a wildcard.
///
/// At most one rule is kept for each (a, s, s', o), wildcards included, so that looking a reward up takes a time that
/// does not grow with the number of lines.
template <class Scalar>
class CassandraRewards {
  /// The rules of one (a, s, s'), wildcards included: the latest for every observation, and the later ones for single
  /// observations.
  struct Bucket {
    std::int64_t of_all = -1;
    std::map<std::size_t, std::uint32_t> of_one;
  };

 public:
  static constexpr std::int64_t all = -1;

  /// What the values of a line range over.
  enum class Shape { one, by_observation, by_target_and_observation, by_target, by_state_and_target };

  struct Rule {
    std::int64_t action, state, target, observation;  ///< an index, or `all`
    Shape shape;
    std::size_t begin;  ///< first value
    std::size_t line;

    bool depends_on_observation() const {
      return observation != all || shape == Shape::by_observation || shape == Shape::by_target_and_observation;
    }
  };

  /// The rules that may apply to one (a, s, s'), later ones winning.
  class Match {
   public:
    /// Whether the reward depends on the observation.
    bool depends_on_observation() const { return line() != 0; }

    /// R(a, s, s', o).
    Scalar value(std::size_t observation) const {
      std::int64_t latest = -1;
      for (std::size_t i = 0; i < count_; ++i) {
        const auto one = buckets_[i]->of_one.find(observation);
        latest = std::max(latest, one == buckets_[i]->of_one.end() ? buckets_[i]->of_all : std::int64_t{one->second});
      }
      return latest < 0 ? Scalar(0)
                        : rewards_->value_of(static_cast<std::size_t>(latest), state_, target_, observation);
    }

    /// The line of a rule that depends on the observation; 0 when none does.
    std::size_t line() const {
      for (std::size_t i = 0; i < count_; ++i) {
        const Bucket& bucket = *buckets_[i];
        if (bucket.of_all >= 0) {
          const Rule& rule = rewards_->rules_[static_cast<std::size_t>(bucket.of_all)];
          if (rule.depends_on_observation()) return rule.line;
        }
        if (!bucket.of_one.empty()) return rewards_->rules_[bucket.of_one.begin()->second].line;
      }
      return 0;
    }

   private:
    friend class CassandraRewards;
    const CassandraRewards* rewards_ = nullptr;
    std::array<const Bucket*, 8> buckets_{};
    std::size_t count_ = 0;
    std::size_t state_ = 0, target_ = 0;
  };

  CassandraRewards(std::size_t states, std::size_t observations) : states_(states), observations_(observations) {}

  /// Where the values of the next rule begin.
  std::size_t next_value() const { return values_.size(); }
  void add_value(Scalar value) { values_.push_back(std::move(value)); }

  /// Adds a rule whose values have been added.
  void add_rule(const Rule& rule) {
    Bucket& bucket = buckets_[key(rule.action, rule.state, rule.target)];
    const auto index = static_cast<std::uint32_t>(rules_.size());
    if (rule.observation == all) {
      bucket.of_one.clear();  // hides every earlier rule for the same (a, s, s')
      bucket.of_all = index;
    } else {
      bucket.of_one.insert_or_assign(static_cast<std::size_t>(rule.observation), index);
    }
    rules_.push_back(rule);
  }

  std::size_t rules() const { return rules_.size(); }

  /// The rules for one (a, s, s').
  Match match(std::size_t action, std::size_t state, std::size_t target) const {
    Match found;
    found.rewards_ = this;
    found.state_ = state;
    found.target_ = target;
    for (unsigned wild = 0; wild < 8; ++wild) {
      const auto pick = [&](unsigned bit, std::size_t i) { return wild & bit ? all : static_cast<std::int64_t>(i); };
      const auto bucket = buckets_.find(key(pick(1, action), pick(2, state), pick(4, target)));
      if (bucket != buckets_.end()) found.buckets_[found.count_++] = &bucket->second;
    }
    return found;
  }

 private:
  std::uint64_t key(std::int64_t action, std::int64_t state, std::int64_t target) const {
    const std::uint64_t n = states_ + 1;
    return (static_cast<std::uint64_t>(action + 1) * n + static_cast<std::uint64_t>(state + 1)) * n +
           static_cast<std::uint64_t>(target + 1);
  }

  Scalar value_of(std::size_t index, std::size_t s, std::size_t target, std::size_t o) const {
    const Rule& rule = rules_[index];
    switch (rule.shape) {
      case Shape::by_observation:
        return values_[rule.begin + o];
      case Shape::by_target_and_observation:
        return values_[rule.begin + target * observations_ + o];
      case Shape::by_target:
        return values_[rule.begin + target];
      case Shape::by_state_and_target:
        return values_[rule.begin + s * states_ + target];
      case Shape::one:
        break;
    }
    return values_[rule.begin];
  }

  std::size_t states_, observations_;
  std::vector<Rule> rules_;
  std::vector<Scalar> values_;
  std::unordered_map<std::uint64_t, Bucket> buckets_;
};

}  // namespace maximin::internal
