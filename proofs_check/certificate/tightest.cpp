#include <maximin/proofs_check/certificate/tightest.hpp>

#include <algorithm>
#include <cstddef>

namespace maximin {

CertifiedClaim Tightest::verdict(ClaimId id, bool exact) const {
  CertifiedClaim claim;
  claim.id = id;
  if (undecided_) return claim;
  const bool refuted = exact && decisive_ && decisive_->slack() < 0;
  if (!refuted && (!tightest_ || tightest_->slack() < 0)) return claim;
  const Instance& at = refuted ? *decisive_ : *tightest_;
  claim.verdict = refuted ? Verdict::violated : Verdict::holds;
  claim.left = at.left;
  claim.right = at.right;
  claim.n = at.n;
  claim.states = at.states;
  claim.action = at.action;
  return claim;
}

void Tightest::join(const Tightest& other) {
  if (other.tightest_) keep(tightest_, *other.tightest_);
  if (other.decisive_) keep(decisive_, *other.decisive_);
  undecided_ = undecided_ || other.undecided_;
}

Instance largest_entry(const ScaledTable& x, long n, const Rational& right) {
  const Integer* first = x.numerators.data();
  const auto at = static_cast<State>(std::max_element(first, first + x.numerators.size()) - first);
  const auto actions = static_cast<Action>(x.numerators.cols());
  return {Rational(first[at], x.denominator), right, n, {at / actions}, at % actions};
}

Instance largest_difference(const ScaledTable& x, const ScaledTable& y, long n, const Rational& right) {
  return largest_entry(difference(x, y), n, right);
}

LipschitzCheck::LipschitzCheck(const FiniteMdp<Rational>& mdp, const ExactGeometry& geometry,
                               const QTable<Rational>& right) {
  std::vector<std::vector<Rational>> spreads;
  for (State s = 0; s < mdp.states(); ++s) {
    for (State t = s + 1; t < mdp.states(); ++t) {
      if (!geometry.finite(s, t)) continue;
      pairs_.push_back({s, t, 0, {}});
      right_denominator_ = lcm(right_denominator_, denominator(right(s, t)));
      auto& of_pair = spreads.emplace_back();
      for (Action a = 0; a < mdp.actions(); ++a) {
        of_pair.push_back(
            internal::row_difference<Rational>(mdp.successors(s, a), mdp.successors(t, a)).total_variation);
        spread_denominator_ = lcm(spread_denominator_, denominator(of_pair.back()));
      }
    }
  }
  for (std::size_t i = 0; i < pairs_.size(); ++i) {
    pairs_[i].right = over(right(pairs_[i].s, pairs_[i].t), right_denominator_);
    for (const Rational& x : spreads[i]) pairs_[i].spreads.push_back(over(x, spread_denominator_));
  }
}

Instance LipschitzCheck::tightest(const ScaledTable& q, const Rational& c, long n) const {
  // right/R - difference/D - c_n spread/(c_d S), all over R D c_d S.
  const Integer both = spread_denominator_ * denominator(c);
  const Integer right_weight = q.denominator * both, difference_weight = right_denominator_ * both;
  const Integer spread_weight = numerator(c) * right_denominator_ * q.denominator;
  std::optional<Integer> least;
  const Pair* at = nullptr;
  Action at_action = 0;
  for (const Pair& pair : pairs_) {
    const Integer right = pair.right * right_weight;
    for (Action a = 0; a < q.numerators.cols(); ++a) {
      const Integer difference = abs(Integer(q.numerators(pair.s, a) - q.numerators(pair.t, a)));
      Integer slack = right - difference * difference_weight;
      if (spread_weight != 0) slack -= pair.spreads[static_cast<std::size_t>(a)] * spread_weight;
      if (least && !(slack < *least)) continue;
      least = std::move(slack);
      at = &pair;
      at_action = a;
    }
  }
  if (at == nullptr) return {Rational(0), Rational(0)};
  const Rational added = c * Rational(at->spreads[static_cast<std::size_t>(at_action)], spread_denominator_);
  const Integer difference = abs(Integer(q.numerators(at->s, at_action) - q.numerators(at->t, at_action)));
  Instance instance{Rational(difference, q.denominator) + added,
                    Rational(at->right, right_denominator_),
                    n,
                    {at->s, at->t},
                    at_action};
  instance.decisive = added == 0;
  return instance;
}

}  // namespace maximin
