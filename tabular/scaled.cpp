#include <maximin/tabular/scaled.hpp>

#include <utility>

namespace maximin {
namespace {

using boost::multiprecision::denominator;
using boost::multiprecision::numerator;

/// sum += x * y, without a temporary.
void add_product(Integer& sum, const Integer& x, const Integer& y) {
  mpz_addmul(sum.backend().data(), x.backend().data(), y.backend().data());
}

}  // namespace

Integer over(const Rational& x, const Integer& common) {
  return numerator(x) * (common / denominator(x));
}

ScaledValues::ScaledValues(const Values<Rational>& v) {
  for (const Rational& x : v) denominator = lcm(denominator, boost::multiprecision::denominator(x));
  for (const Rational& x : v) numerators.push_back(over(x, denominator));
}

Values<Rational> ScaledValues::rational() const {
  Values<Rational> v(static_cast<Eigen::Index>(numerators.size()));
  for (State s = 0; s < v.size(); ++s) v[s] = (*this)[s];
  return v;
}

QTable<Rational> ScaledTable::rational() const {
  return numerators.unaryExpr([&](const Integer& x) { return Rational(x, denominator); });
}

ScaledValues taken(const ScaledTable& q, const Policy& action) {
  ScaledValues v;
  v.denominator = q.denominator;
  for (std::size_t s = 0; s < action.size(); ++s) {
    v.numerators.push_back(q.numerators(static_cast<Eigen::Index>(s), action[s]));
  }
  return v;
}

ScaledTable difference(const ScaledTable& x, const ScaledTable& y) {
  if (x.denominator == y.denominator) return {x.numerators - y.numerators, x.denominator};
  return {x.numerators * y.denominator - y.numerators * x.denominator, x.denominator * y.denominator};
}

Rational distance(const ScaledTable& x, const ScaledTable& y) {
  const ScaledTable apart = difference(x, y);
  return {apart.numerators.cwiseAbs().maxCoeff(), apart.denominator};
}

ScaledMdp::ScaledMdp(const FiniteMdp<Rational>& mdp) : states_(mdp.states()), actions_(mdp.actions()) {
  Integer probability_denominator(1);
  for (State s = 0; s < states_; ++s) {
    for (Action a = 0; a < actions_; ++a) {
      reward_denominator_ = lcm(reward_denominator_, denominator(mdp.reward(s, a)));
      for (const auto& next : mdp.successors(s, a)) {
        probability_denominator = lcm(probability_denominator, denominator(next.probability));
      }
    }
  }
  growth_ = probability_denominator * denominator(mdp.discount());
  const Integer gamma = numerator(mdp.discount());
  row_begin_.push_back(0);
  for (State s = 0; s < states_; ++s) {
    for (Action a = 0; a < actions_; ++a) {
      rewards_.push_back(over(mdp.reward(s, a), reward_denominator_));
      for (const auto& next : mdp.successors(s, a)) {
        entries_.push_back({next.target, gamma * over(next.probability, probability_denominator)});
      }
      row_begin_.push_back(entries_.size());
    }
  }
}

ScaledTable ScaledMdp::backup(const ScaledValues& v) const {
  const Integer common = lcm(v.denominator, reward_denominator_);
  const Integer widen = common / v.denominator;
  const Integer reward_weight = growth_ * (common / reward_denominator_);
  ScaledTable q{QTable<Integer>(states_, actions_), growth_ * common};
  std::size_t row = 0;
  for (State s = 0; s < states_; ++s) {
    for (Action a = 0; a < actions_; ++a, ++row) {
      Integer sum(0);
      for (std::size_t i = row_begin_[row]; i < row_begin_[row + 1]; ++i) {
        add_product(sum, entries_[i].weight, v.numerators[static_cast<std::size_t>(entries_[i].target)]);
      }
      if (widen != 1) sum *= widen;
      add_product(sum, rewards_[row], reward_weight);
      q.numerators(s, a) = std::move(sum);
    }
  }
  return q;
}

}  // namespace maximin
