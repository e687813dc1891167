#include <maximin/proofs_check/certificate/tightest.hpp>

namespace maximin {

CertifiedClaim Tightest::verdict(ClaimId id, bool exact) const {
  CertifiedClaim claim;
  claim.id = id;
  const bool refuted = exact && decisive_ && decisive_->slack() < 0;
  if (!refuted && (undecided_ || !tightest_ || tightest_->slack() < 0)) return claim;
  const Instance& at = refuted ? *decisive_ : *tightest_;
  claim.verdict = refuted ? Verdict::violated : Verdict::holds;
  claim.left = at.left;
  claim.right = at.right;
  claim.n = at.n;
  claim.states = at.states;
  claim.action = at.action;
  return claim;
}

Instance largest_difference(const ScaledTable& x, const ScaledTable& y, long n, const Rational& right) {
  std::optional<Integer> largest;
  State at_state = 0;
  Action at_action = 0;
  for (State s = 0; s < x.numerators.rows(); ++s) {
    for (Action a = 0; a < x.numerators.cols(); ++a) {
      Integer difference = x.numerators(s, a) * y.denominator - y.numerators(s, a) * x.denominator;
      if (largest && !(difference > *largest)) continue;
      largest = std::move(difference);
      at_state = s;
      at_action = a;
    }
  }
  return {Rational(*largest, x.denominator * y.denominator), right, n, {at_state}, at_action};
}

LipschitzCheck::LipschitzCheck(const ExactGeometry& geometry, const Rational& l) {
  const auto n = static_cast<State>(geometry.lower.rows());
  std::vector<Rational> rights;
  for (State s = 0; s < n; ++s) {
    for (State t = s + 1; t < n; ++t) {
      if (!geometry.finite(s, t)) continue;
      pairs_.push_back({s, t, 0});
      rights.push_back(l * geometry.lower(s, t));
      denominator_ = lcm(denominator_, denominator(rights.back()));
    }
  }
  for (std::size_t i = 0; i < rights.size(); ++i) {
    pairs_[i].right = numerator(rights[i]) * (denominator_ / denominator(rights[i]));
  }
}

Instance LipschitzCheck::tightest(const ScaledTable& q, const Rational& extra, long n) const {
  std::optional<Integer> least;
  const Pair* at = nullptr;
  Action at_action = 0;
  Integer at_difference;
  for (const Pair& pair : pairs_) {
    const Integer right = pair.right * q.denominator;
    for (Action a = 0; a < q.numerators.cols(); ++a) {
      Integer difference = abs(Integer(q.numerators(pair.s, a) - q.numerators(pair.t, a)));
      Integer slack = right - difference * denominator_;
      if (least && !(slack < *least)) continue;
      least = std::move(slack);
      at = &pair;
      at_action = a;
      at_difference = std::move(difference);
    }
  }
  if (at == nullptr) return {Rational(0), Rational(0)};
  return {
      Rational(at_difference, q.denominator) + extra, Rational(at->right, denominator_), n, {at->s, at->t}, at_action};
}

}  // namespace maximin
