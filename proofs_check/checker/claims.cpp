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
               const Table& q_star, const std::vector<Pair>& pairs, std::size_t rounds)
    : checks_(checks), m_(model), c_(constants), q_star_(q_star), pairs_(pairs), rounds_(rounds) {
  g_ = m_.discount;
  rest_ = 1 - g_;
  const Rational states = static_cast<unsigned long>(m_.states);
  const Rational largest_reward = std::max(abs(c_.r_min), abs(c_.r_max));
  const Rational r_max = paper ? std::max(Rational(0), c_.r_max) : largest_reward;
  const Rational of_print = states * r_max / rest_, of_rep = g_ * states * largest_reward / rest_;
  const Rational l_print = c_.l_r + of_print * c_.l_p, l_rep = c_.l_r + of_rep * c_.l_p;
  right_print_ = lipschitz_sides(of_print);
  right_rep_ = lipschitz_sides(of_rep);
  const Rational l_sound = c_.l_r + states * c_.l_p * largest_reward / rest_;
  const Rational l_tv = c_.l_r + g_ * c_.k * (c_.r_max - c_.r_min) / rest_;
  const auto delta = [&](const Rational& l) { return Rational(2 * m_.eps * g_ * l); };
  delta_print_ = delta(l_print);
  delta_sound_ = delta(l_sound);
  delta_rep_ = delta(l_rep);
  delta_tv_ = delta(l_tv);
  const auto [least, most] = std::minmax_element(q_star_.top.begin(), q_star_.top.end());
  const Table ends{{*least, *most}, q_star_.bottom};
  start_ = std::max(Rational(0), ends[1]) + std::max(Rational(0), Rational(-ends[0]));
  for (const Pair& pair : pairs_) {
    gaps_.push_back(difference(q_star_, pair.back_of_robust));
    images_.push_back(back(m_, taken(m_, q_star_, pair.composed)));
  }
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

/// r(s,t) + factor p(s,t): factor l_p + l_r times the distance, and not too large where d- is not the distance.
Table Claims::lipschitz_sides(const Rational& factor) const {
  std::vector<Rational> sides(m_.states * m_.states);
  for (std::size_t s = 0; s < m_.states; ++s) {
    for (std::size_t t = s + 1; t < m_.states; ++t) {
      Table rewards{{0}, m_.rewards.bottom}, moves{{0}, m_.whole};  // the largest difference of each
      for (std::size_t a = 0; a < m_.actions; ++a) {
        const Integer reward = abs(Integer(m_.rewards.top[m_.at(s, a)] - m_.rewards.top[m_.at(t, a)]));
        rewards.top[0] = std::max(rewards.top[0], reward);
        for (const Integer& x : row_differences(m_, s, t, a)) moves.top[0] = std::max(moves.top[0], x);
      }
      const Rational near = m_.near_at(s, t);
      const Rational r = std::max(Rational(c_.l_r * near), rewards[0]), p = std::max(Rational(c_.l_p * near), moves[0]);
      sides[s * m_.states + t] = r + factor * p;
    }
  }
  auto table = over_one_denominator(sides, m_.most_bits);
  if (!table) refuse("$.claims", "right sides that take too much memory, expected smaller denominators");
  return *std::move(table);
}

/// [g(g^n (d0+u0) + D (1-g^n)/(1-g)) + D]/(1-g)
Rational Claims::finite_n(const Rational& delta, std::size_t n) const {
  const Rational decay = power(g_, n);
  return (g_ * (decay * start_ + delta * (1 - decay) / rest_) + delta) / rest_;
}

Rational Claims::limit_of_finite_n(const Rational& delta) const {
  return (g_ * delta / rest_ + delta) / rest_;
}

void Claims::of_round(const Round& round) {
  const std::size_t n = round.n;
  if (ClaimCheck* check = find(lemma_1); check && round.first) {
    check->see_pairs(n, pairs_[round.pair].back_of_fixed, 0, right_print_);
    check->see_pairs(n, pairs_[round.pair].back_of_robust, 0, right_print_);
  }
  if (ClaimCheck* check = find(lemma_1_iterates)) check->see_pairs(n, round.q, 0, right_rep_);
  if (ClaimCheck* check = find(lemma_2)) {
    check->see_each(n, absolute(difference(back(m_, best_values(m_, round.q)), round.next)), 0, delta_print_);
  }
  if (ClaimCheck* check = find(lemma_3)) {
    check->see({n}, largest_absolute(difference(round.next, images_[round.pair])),
               g_ * largest_absolute(difference(round.q, q_star_)));
  }
  if (ClaimCheck* check = find(c)) check->see_each(n, gaps_[round.pair], 0, finite_n(delta_rep_, n));
  if (ClaimCheck* check = find(d)) check->see_each(n, gaps_[round.pair], 0, finite_n(delta_tv_, n));
}

void Claims::of_limit(const Limit* limit, const Table& last) {
  if (limit == nullptr) {
    expect_undetermined({lemma_1, lemma_1_iterates, lemma_2, theorem_1, a, b, c, d}, "the limit is null");
    return;
  }
  if (ClaimCheck* check = find(lemma_1_iterates)) check->see_pairs(rounds_, last, 0, right_rep_);
  for (std::size_t j = 0; j < limit->phases.size(); ++j) of_phase(j, *limit);
}

void Claims::of_phase(std::size_t j, const Limit& limit) {
  const std::size_t n = rounds_ + j;
  const Phase& phase = limit.phases[j];
  const Phase& following = limit.phases[(j + 1) % limit.phases.size()];
  const bool low_proves = phase.attained;
  if (!phase.back_of_fixed || !low_proves) expect_undetermined({lemma_1}, "a phase's values are only bounded");
  if (ClaimCheck* check = find(lemma_1)) {
    check->see_pairs(n, phase.back_of_low, 0, right_print_);
    check->see_pairs(n, *phase.back_of_fixed, 0, right_print_);
  }
  const Rational slack = g_ * limit.delta;
  if (ClaimCheck* check = find(lemma_1_iterates)) check->see_pairs(n, phase.q, slack, right_rep_);
  if (ClaimCheck* check = find(lemma_2)) {
    const Table loss = absolute(difference(back(m_, best_values(m_, phase.q)), following.q));
    check->see_each(n, loss, 2 * slack, delta_print_, slack == 0);
  }
  const Rational one_sided = 1 / (rest_ * rest_), two_sided = (1 + g_) * one_sided;
  if (ClaimCheck* check = find(theorem_1)) {
    const bool known = phase.back_of_fixed.has_value();
    const Table gap = difference(q_star_, known ? *phase.back_of_fixed : phase.back_of_low);
    check->see_each(n, gap, 0, two_sided * delta_print_, known);
  }
  const Table gap = difference(q_star_, phase.back_of_low);
  if (ClaimCheck* check = find(a)) check->see_each(n, gap, 0, two_sided * delta_sound_, low_proves);
  if (ClaimCheck* check = find(b)) check->see_each(n, gap, 0, one_sided * delta_sound_, low_proves);
  const auto see_finite_n = [&](ClaimCheck& check, const Rational& delta) {  // F is monotone in n
    check.see_each(n, gap, 0, std::min(finite_n(delta, n), limit_of_finite_n(delta)), low_proves);
  };
  if (ClaimCheck* check = find(c)) see_finite_n(*check, delta_rep_);
  if (ClaimCheck* check = find(d)) see_finite_n(*check, delta_tv_);
}

void Claims::of_test_time(const Table& back_of_robust) {
  if (ClaimCheck* check = find(e)) {
    check->see_each(Place::none, difference(q_star_, back_of_robust), 0, 2 * m_.eps * g_ * c_.l_star / rest_);
  }
}

void Claims::of_belief_game(const BeliefGame* game) {
  if (game == nullptr) {
    expect_undetermined({f}, "the belief game is null");
    return;
  }
  if (ClaimCheck* check = find(f)) {
    const Table loss = difference(best_values(m_, q_star_), game->worst);
    for (std::size_t s = 0; s < m_.states; ++s) {
      check->see({Place::none, s}, loss[s], game->reach * c_.l_star / rest_, game->exact);
    }
  }
}

}  // namespace maximin::checker
