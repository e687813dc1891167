#include <maximin/proofs_check/certificate/boxes.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <utility>

#include <maximin/proofs_check/certificate/certificate.hpp>
#include <maximin/tabular/exact_control.hpp>
#include <maximin/tabular/optimal_attack.hpp>
#include <maximin/theory/bellman.hpp>

namespace maximin {
namespace {

using boost::multiprecision::denominator;
using boost::multiprecision::numerator;

/// The largest integer at most x/y, for y > 0.
Integer floor_of(const Integer& x, const Integer& y) {
  Integer quotient = x / y;  // towards zero
  if (quotient * y > x) --quotient;
  return quotient;
}

Integer ceiling_of(const Integer& x, const Integer& y) {
  return -floor_of(-x, y);
}

/// min over t in B(s) of the least of `low`, and of the greatest of `high`, among the choices at t.
template <class Scalar>
std::pair<Scalar, Scalar> attacked(const TableBox<Scalar>& q, const Choices& choices, Perturbation<Rational>::Ball ball,
                                   State s) {
  const auto& first = choices[static_cast<std::size_t>(ball.front())];
  Scalar low = q.low(s, first.front());
  std::optional<Scalar> high;
  for (const State t : ball) {
    const auto& at_t = choices[static_cast<std::size_t>(t)];
    Scalar greatest = q.high(s, at_t.front());
    for (const Action a : at_t) {
      low = std::min(low, q.low(s, a));
      greatest = std::max(greatest, q.high(s, a));
    }
    if (!high || greatest < *high) high = std::move(greatest);
  }
  return {std::move(low), *std::move(high)};
}

/// All that an attacker can provoke in each true state: the union of the choices at t, t in B(s).
Choices provokable(const Perturbation<Rational>& balls, const Choices& choices) {
  return internal::provokable(
      balls, [&](State t) -> const std::vector<Action>& { return choices[static_cast<std::size_t>(t)]; });
}

/// max|R|/(1-gamma): no value is larger.
Rational largest_value(const FiniteMdp<Rational>& mdp) {
  Rational largest(0);
  for (Eigen::Index i = 0; i < mdp.rewards().size(); ++i) {
    largest = std::max(largest, Rational(abs(mdp.rewards().data()[i])));
  }
  return largest / (1 - mdp.discount());
}

}  // namespace

template <class Scalar>
std::vector<Action> candidates(const TableBox<Scalar>& q, std::span<const State> belief, TieBreak tie) {
  const auto worst = [&](const QTable<Scalar>& table, Action a) {
    Scalar least = table(belief.front(), a);
    for (const State m : belief.subspan(1)) least = std::min(least, table(m, a));
    return least;
  };
  std::vector<Scalar> low, high;
  for (Action a = 0; a < q.low.cols(); ++a) {
    low.push_back(worst(q.low, a));
    high.push_back(worst(q.high, a));
  }
  std::vector<Action> left;
  for (std::size_t b = 0; b < high.size(); ++b) {
    bool beaten = false;
    for (std::size_t a = 0; a < low.size() && !beaten; ++a) {
      const bool before = tie == TieBreak::lowest_index ? a < b : a > b;
      beaten = low[a] > high[b] || (before && low[a] == high[b]);
    }
    if (!beaten) left.push_back(static_cast<Action>(b));
  }
  return left;
}

template <class Scalar>
Choices candidates(const TableBox<Scalar>& q, const Perturbation<Rational>& balls, TieBreak tie) {
  Choices choices;
  for (State t = 0; t < balls.states(); ++t) choices.push_back(candidates(q, balls.ball(t), tie));
  return choices;
}

template std::vector<Action> candidates(const TableBox<Integer>&, std::span<const State>, TieBreak);
template Choices candidates(const TableBox<Integer>&, const Perturbation<Rational>&, TieBreak);

// ---- The grid ----

Grid::Grid(const FiniteMdp<Rational>& mdp) {
  constexpr long places = 60, most = 100'000;
  const Rational size = largest_value(mdp);
  const long exponent =
      size == 0 ? 0
                : static_cast<long>(boost::multiprecision::msb(boost::multiprecision::numerator(size))) -
                      static_cast<long>(boost::multiprecision::msb(boost::multiprecision::denominator(size)));
  bits_ = std::clamp(places - exponent, 0L, most);
  denominator_ = Integer(1) << static_cast<unsigned>(bits_);
}

Integer Grid::down(const Integer& numerator, const Integer& over) const {
  return floor_of(numerator * denominator_, over);
}

Integer Grid::up(const Integer& numerator, const Integer& over) const {
  return ceiling_of(numerator * denominator_, over);
}

Integer Grid::down(double x) const {
  const Rational exact(x);
  return down(boost::multiprecision::numerator(exact), boost::multiprecision::denominator(exact));
}

Integer Grid::up(double x) const {
  const Rational exact(x);
  return up(boost::multiprecision::numerator(exact), boost::multiprecision::denominator(exact));
}

// ---- Rounds ----

Boxes::Boxes(const FiniteMdp<Rational>& mdp, const Perturbation<Rational>& balls, const ScaledMdp& scaled,
             const CertifyOptions& options)
    : mdp_(mdp),
      balls_(balls),
      scaled_(scaled),
      options_(options),
      grid_(mdp),
      all_(static_cast<std::size_t>(mdp.states())) {
  try {
    rounded_ = internal::rounded(mdp);
  } catch (const InputError&) {  // then bounds are as wide as they need to be
  }
  for (auto& list : all_) {
    for (Action a = 0; a < mdp.actions(); ++a) list.push_back(a);
  }
}

RoundBox Boxes::first_round() const {
  RoundBox round;
  round.q.low = round.q.high = QTable<Integer>::Constant(mdp_.states(), mdp_.actions(), Integer(0));
  round.denominator = 1;
  look(round);
  return round;
}

RoundBox Boxes::round_after(const ValueBox& passed) const {
  ScaledTable low = scaled_.backup(passed.low), high = scaled_.backup(passed.high);
  RoundBox round;
  round.denominator = std::move(low.denominator);  // and of high: both depend on the grid's alone
  round.q = {std::move(low.numerators), std::move(high.numerators)};
  look(round);
  return round;
}

void Boxes::look(RoundBox& round) const {
  round.choices = candidates(round.q, balls_, options_.tie);
  round.passed.low.denominator = round.passed.high.denominator = grid_.denominator();
  for (State s = 0; s < mdp_.states(); ++s) {
    const auto [low, high] = attacked(round.q, round.choices, balls_.ball(s), s);
    round.passed.low.numerators.push_back(grid_.down(low, round.denominator));
    round.passed.high.numerators.push_back(grid_.up(high, round.denominator));
  }
  find_provoked(round);
}

void Boxes::find_provoked(RoundBox& round) const {
  round.provoked = provokable(balls_, round.choices);
  for (State s = 0; s < mdp_.states(); ++s) {
    const Integer most = round.passed.high.numerators[static_cast<std::size_t>(s)] * round.denominator;
    std::erase_if(round.provoked[static_cast<std::size_t>(s)],
                  [&](Action a) { return round.q.low(s, a) * grid_.denominator() > most; });
  }
}

// ---- Fixed points ----

ScaledValues Boxes::enclose(Player player, const Choices& choices, Side side) const {
  const bool below = side == Side::below;
  ScaledValues v;
  v.denominator = grid_.denominator();
  for (const double x : near_values(player, choices)) v.numerators.push_back(below ? grid_.down(x) : grid_.up(x));

  // V - c <= T(V - c) as soon as max (V - TV) <= (1-gamma) c; and the same upwards.
  const ScaledTable q = scaled_.backup(v);
  const Integer widen = q.denominator / v.denominator;
  Integer worst(0);
  for (State s = 0; s < mdp_.states(); ++s) {
    const auto& list = choices[static_cast<std::size_t>(s)];
    Integer best = q.numerators(s, list.front());
    for (const Action a : list) {
      best = player == Player::maximise ? std::max(best, q.numerators(s, a)) : std::min(best, q.numerators(s, a));
    }
    const Integer off = v.numerators[static_cast<std::size_t>(s)] * widen - best;
    worst = std::max(worst, below ? off : Integer(-off));
  }
  const Rational rest = 1 - mdp_.discount();
  const Integer shift = ceiling_of(worst * denominator(rest), widen * numerator(rest));
  for (Integer& x : v.numerators) x += below ? -shift : shift;
  return v;
}

std::vector<double> Boxes::near_values(Player player, const Choices& choices) const {
  try {
    if (rounded_) {
      const auto solution = internal::iterate_policies(ControlProblem<double>(*rounded_, player, choices), {});
      if (solution.v.allFinite()) return {solution.v.begin(), solution.v.end()};
    }
  } catch (const std::runtime_error&) {  // numbers that do not fit, or a solver that gave up: any start will do
  }
  return std::vector<double>(static_cast<std::size_t>(mdp_.states()), 0.0);
}

ScaledValues Boxes::enclose_robust(const Choices& choices) const {
  return enclose(Player::minimise, provokable(balls_, choices), Side::below);
}

PairBox Boxes::enclose_pair(const Choices& choices, const Choices& provoked) const {
  return {enclose_robust(choices), enclose(Player::maximise, provoked, Side::above)};
}

ValueBox Boxes::enclose_optimal() const {
  return {enclose(Player::maximise, all_, Side::below), enclose(Player::maximise, all_, Side::above)};
}

// ---- Invariant boxes ----

/// low <= x <= high in floating point, where nothing is proved.
struct Boxes::Rounded {
  Values<double> low, high;

  /// Takes in the other box. Returns how far this one grew.
  double join(const Rounded& other) {
    if (low.size() == 0) {
      *this = other;
      return (high - low).maxCoeff();
    }
    const double grown = std::max({0.0, (low - other.low).maxCoeff(), (other.high - high).maxCoeff()});
    low = low.cwiseMin(other.low);
    high = high.cwiseMax(other.high);
    return grown;
  }
};

/// What follows the box, wider by the margin.
Boxes::Rounded Boxes::widened_image(const Rounded& box, double margin) const {
  TableBox<double> q;
  backup(*rounded_, box.low, q.low);
  backup(*rounded_, box.high, q.high);
  const Choices choices = candidates(q, balls_, options_.tie);
  Rounded image{Values<double>(mdp_.states()), Values<double>(mdp_.states())};
  for (State s = 0; s < mdp_.states(); ++s) {
    const auto [low, high] = attacked(q, choices, balls_.ball(s), s);
    image.low[s] = low - margin;
    image.high[s] = high + margin;
  }
  return image;
}

std::optional<BoxLimit> Boxes::limit_after(const ValueBox& last, long period) const {
  if (!rounded_) return std::nullopt;
  const auto gamma = static_cast<double>(mdp_.discount()), size = static_cast<double>(largest_value(mdp_));
  if (!std::isfinite(size / (1 - gamma))) return std::nullopt;
  const double most_sweeps = std::min(1e6, 40 / (1 - gamma));  // e^-40 of what there was to come is left
  const double margin = size * std::max(1e-10 * (1 - gamma), 1e-13);
  std::vector<Rounded> phases(static_cast<std::size_t>(period));
  Rounded start{last.low.rational().cast<double>(), last.high.rational().cast<double>()};
  start.low.array() -= margin;
  start.high.array() += margin;
  phases.back() = std::move(start);
  // Images are joined until they add next to nothing; the margin then makes up for what is left, and for rounding.
  for (int sweep = 0; sweep < most_sweeps; ++sweep) {
    options_.poll();
    double grown = 0;
    for (std::size_t j = 0; j < phases.size(); ++j) {
      const Rounded& before = phases[j == 0 ? phases.size() - 1 : j - 1];
      grown = std::max(grown, phases[j].join(widened_image(before, margin)));
    }
    if (!std::isfinite(grown) || !std::isfinite(phases.back().low.sum() - phases.back().high.sum()))
      return std::nullopt;
    if (grown <= margin / 2) return verified(phases, last);
  }
  return std::nullopt;
}

/// The boxes on the grid, if they are found to be invariant in exact arithmetic.
std::optional<BoxLimit> Boxes::verified(const std::vector<Rounded>& phases, const ValueBox& last) const {
  const auto inside = [](const ValueBox& inner, const ValueBox& outer) {
    const auto& [low, high] = inner;
    return std::equal(outer.low.numerators.begin(), outer.low.numerators.end(), low.numerators.begin(),
                      [](const Integer& x, const Integer& y) { return x <= y; }) &&
           std::equal(high.numerators.begin(), high.numerators.end(), outer.high.numerators.begin(),
                      [](const Integer& x, const Integer& y) { return x <= y; });
  };
  std::vector<ValueBox> boxes;
  for (const Rounded& phase : phases) boxes.push_back(on_grid(phase));
  if (!inside(last, boxes.back())) return std::nullopt;
  BoxLimit limit;
  for (std::size_t j = 0; j < boxes.size(); ++j) {
    RoundBox& round = limit.phases.emplace_back(round_after(boxes[j == 0 ? boxes.size() - 1 : j - 1]));
    if (!inside(round.passed, boxes[j])) return std::nullopt;
    round.passed = boxes[j];
    find_provoked(round);
  }
  for (const RoundBox& round : limit.phases) limit.pairs.push_back(enclose_pair(round.choices, round.provoked));
  return limit;
}

ValueBox Boxes::on_grid(const Rounded& box) const {
  ValueBox values;
  values.low.denominator = values.high.denominator = grid_.denominator();
  for (State s = 0; s < mdp_.states(); ++s) {
    values.low.numerators.push_back(grid_.down(box.low[s]));
    values.high.numerators.push_back(grid_.up(box.high[s]));
  }
  return values;
}

ValueBox Boxes::on_grid(const ScaledValues& x) const {
  ValueBox values;
  values.low.denominator = values.high.denominator = grid_.denominator();
  for (const Integer& n : x.numerators) {
    values.low.numerators.push_back(grid_.down(n, x.denominator));
    values.high.numerators.push_back(grid_.up(n, x.denominator));
  }
  return values;
}

}  // namespace maximin
