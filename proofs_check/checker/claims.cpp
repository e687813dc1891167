#include "claims.hpp"

#include <algorithm>

namespace maximin::checker {
namespace {

using enum ClaimId;

Rational power(const Rational& x, std::size_t n) {
  Rational result;
  mpz_pow_ui(result.get_num_mpz_t(), x.get_num_mpz_t(), n);
  mpz_pow_ui(result.get_den_mpz_t(), x.get_den_mpz_t(), n);
  return result;
}

Rational largest_absolute(const Table& x) {
  const Table sizes = absolute(x);
  return sizes[largest(sizes)];
}

}  // namespace

Claims::Claims(std::vector<ClaimCheck>& checks, const Model& model, const Constants& constants, bool paper,
               const Optimal& optimal, std::size_t rounds)
    : checks_(checks), m_(model), c_(constants), optimal_(optimal), rounds_(rounds) {
  g_ = m_.discount;
  rest_ = 1 - g_;
  const Rational states = static_cast<unsigned long>(m_.states);
  const Rational largest_reward = std::max(abs(c_.r_min), abs(c_.r_max));
  const Rational r_max = paper ? std::max(Rational(0), c_.r_max) : largest_reward;
  const Rational of_print = states * r_max / rest_, of_rep = g_ * states * largest_reward / rest_;
  const Rational l_print = c_.l_r + of_print * c_.l_p, l_rep = c_.l_r + of_rep * c_.l_p;
  if (ClaimCheck* check = find(lemma_1)) lemma_1_.emplace(*check, m_, c_.l_r, c_.l_p, of_print);
  if (ClaimCheck* check = find(lemma_1_iterates)) iterates_.emplace(*check, m_, c_.l_r, c_.l_p, of_rep);
  const Rational l_sound = c_.l_r + states * c_.l_p * largest_reward / rest_;
  const Rational l_tv = c_.l_r + g_ * c_.k * (c_.r_max - c_.r_min) / rest_;
  const auto delta = [&](const Rational& l) { return Rational(2 * m_.eps * g_ * l); };
  delta_print_ = delta(l_print);
  delta_sound_ = delta(l_sound);
  delta_rep_ = delta(l_rep);
  delta_tv_ = delta(l_tv);
  // d0 and u0, or numbers below them.
  const Table &low = optimal_.q.low, &high = optimal_.q.high;
  const Table ends{
      {*std::max_element(low.top.begin(), low.top.end()), *std::min_element(high.top.begin(), high.top.end())},
      low.bottom};
  start_ = std::max(Rational(0), ends[0]) + std::max(Rational(0), Rational(-ends[1]));
}

ClaimCheck* Claims::find(ClaimId id) {
  const auto found = std::find_if(checks_.begin(), checks_.end(), [id](const auto& check) { return check.id() == id; });
  return found == checks_.end() || found->undetermined() ? nullptr : &*found;
}

std::vector<ClaimCheck*> Claims::find(std::initializer_list<ClaimId> ids) {
  std::vector<ClaimCheck*> found;
  for (const ClaimId id : ids) {
    if (ClaimCheck* check = find(id)) found.push_back(check);
  }
  return found;
}

void Claims::expect_undetermined(std::initializer_list<ClaimId> ids, const char* why) {
  for (const ClaimCheck* check : find(ids)) {
    refuse(check->path() + ".verdict", check->verdict().verdict + ", expected undetermined: " + why);
  }
}

/// The values of a table at states whose balls have several members, where the agent can be misled; 0 elsewhere.
Table Claims::where_misled(const Table& values) const {
  Table result = values;
  for (std::size_t s = 0; s < m_.states; ++s) {
    if (m_.balls[s].size() == 1) result.top[s] = 0;
  }
  return result;
}

/// F(n, D) = [g(g^n (d0+u0) + D (1-g^n)/(1-g)) + D]/(1-g). It is monotone in n: of the rounds of a phase, the first or
/// the limit has the least.
void Claims::see_finite_n(std::size_t n, const Table& gap, bool proves) {
  const Rational decay = power(g_, n);
  for (const auto& [id, delta] : {std::pair{c, delta_rep_}, {d, delta_tv_}}) {
    const Rational now = (g_ * (decay * start_ + delta * (1 - decay) / rest_) + delta) / rest_;
    const Rational at_last = (g_ * delta / rest_ + delta) / rest_;
    if (ClaimCheck* check = find(id)) check->see_each(n, gap, n < rounds_ ? now : std::min(now, at_last), proves);
  }
}

void Claims::see_theorem_1(std::size_t n, const Table& gap, bool proves) {
  if (ClaimCheck* check = find(theorem_1)) check->see_each(n, gap, (1 + g_) / (rest_ * rest_) * delta_print_, proves);
}

/// A, B, C and D in a phase.
void Claims::see_limit(std::size_t n, const Table& gap, bool proves) {
  const Rational one_sided = 1 / (rest_ * rest_), two_sided = (1 + g_) * one_sided;
  if (ClaimCheck* check = find(a)) check->see_each(n, gap, two_sided * delta_sound_, proves);
  if (ClaimCheck* check = find(b)) check->see_each(n, gap, one_sided * delta_sound_, proves);
  see_finite_n(n, gap, proves);
}

void Claims::of_pairs(const std::vector<Pair>& pairs) {
  pairs_ = &pairs;
  for (const Pair& pair : pairs) {
    gaps_.push_back(difference(optimal_.q.high, pair.back_of_robust));
    images_.push_back(back(m_, taken(m_, optimal_.q.high, pair.composed)));
  }
}

void Claims::of_round(const Round& round) {
  const std::size_t n = round.n;
  if (lemma_1_ && round.first) {
    lemma_1_->see(n, (*pairs_)[round.pair].back_of_fixed, 0, true);
    lemma_1_->see(n, (*pairs_)[round.pair].back_of_robust, 0, true);
  }
  if (iterates_) iterates_->see(n, round.q, 0, true);
  if (ClaimCheck* check = find(lemma_2)) {
    check->see_each(n, absolute(difference(back(m_, best_values(m_, round.q)), round.next)), delta_print_);
  }
  if (ClaimCheck* check = find(lemma_3)) {
    check->see({n}, largest_absolute(difference(round.next, images_[round.pair])),
               g_ * largest_absolute(difference(round.q, optimal_.q.high)));
  }
  see_finite_n(n, gaps_[round.pair], true);
}

void Claims::of_no_limit() {
  expect_undetermined({lemma_1, lemma_1_iterates, lemma_2, theorem_1, a, b, c, d}, "the limit is null");
}

void Claims::of_limit(const Limit& limit, const Table& q_n) {
  if (iterates_) iterates_->see(rounds_, q_n, 0, true);
  for (std::size_t j = 0; j < limit.phases.size(); ++j) of_phase(j, limit);
}

void Claims::of_phase(std::size_t j, const Limit& limit) {
  const std::size_t n = rounds_ + j;
  const Phase& phase = limit.phases[j];
  const Phase& following = limit.phases[(j + 1) % limit.phases.size()];
  if (!phase.back_of_fixed || !phase.attained) expect_undetermined({lemma_1}, "a phase's values are only bounded");
  if (lemma_1_) {
    lemma_1_->see(n, phase.back_of_low, 0, true);
    lemma_1_->see(n, *phase.back_of_fixed, 0, true);
  }
  if (iterates_) iterates_->see(n, phase.q, g_ * limit.delta, true);
  if (ClaimCheck* check = find(lemma_2)) {
    const Table loss = absolute(difference(back(m_, best_values(m_, phase.q)), following.q));
    const Rational twice = 2 * limit.delta;
    const Table off{std::vector<Integer>(m_.states, twice.get_num()), twice.get_den()};
    const Table added = back_without_rewards(m_, where_misled(off));
    check->see_each(n, total(loss, added), delta_print_, true, &added);
  }
  const bool known = phase.back_of_fixed.has_value();
  see_theorem_1(n, difference(optimal_.q.high, known ? *phase.back_of_fixed : phase.back_of_low), known);
  see_limit(n, difference(optimal_.q.high, phase.back_of_low), phase.attained);
}

/// No instance proves a violation: all left sides are bounds.
void Claims::of_box(const Box& box) {
  const bool phase = box.n >= rounds_;
  // spread(V,W), of what lies between two values.
  const auto see_spread = [&](LipschitzCheck& check, const Bracket& bracket) {
    Table middle = total(bracket.back.low, bracket.back.high);
    middle.bottom *= 2;
    check.see(box.n, middle, g_ * bracket.half, false);
  };
  if (lemma_1_ && box.first) see_spread(*lemma_1_, box.policies);
  if (iterates_ && box.n > 0) see_spread(*iterates_, box.iterate);
  if (ClaimCheck* check = find(lemma_2)) {
    const Table loss = difference(best_values(m_, box.iterate.back.high), box.low);
    check->see_each(box.n, back_without_rewards(m_, where_misled(loss)), delta_print_, false);
  }
  const Table gap = difference(optimal_.q.high, box.policies.back.low);
  if (!phase) return see_finite_n(box.n, gap, false);
  see_theorem_1(box.n, gap, false);
  see_limit(box.n, gap, false);
}

void Claims::of_test_time(const Table& back_of_values) {
  if (ClaimCheck* check = find(e)) {
    check->see_each(Place::none, difference(optimal_.q.high, back_of_values), 2 * m_.eps * g_ * c_.l_star / rest_);
  }
}

void Claims::of_belief_game(const BeliefGame* game) {
  if (game == nullptr) {
    expect_undetermined({f}, "the belief game is null");
    return;
  }
  if (ClaimCheck* check = find(f)) {
    const Table loss = difference(optimal_.high, game->worst);
    for (std::size_t s = 0; s < m_.states; ++s) {
      check->see({Place::none, s}, loss[s], game->reach * c_.l_star / rest_, game->exact);
    }
  }
}

void Claims::verify() {
  if (lemma_1_) lemma_1_->look();
  if (iterates_) iterates_->look();
  for (const ClaimCheck& check : checks_) {
    if (!check.undetermined()) check.verify();
  }
}

}  // namespace maximin::checker
