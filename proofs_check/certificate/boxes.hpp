#pragma once

#include <optional>
#include <span>
#include <vector>

#include <maximin/tabular/control.hpp>
#include <maximin/tabular/scaled.hpp>
#include <maximin/theory/perturbation.hpp>
#include <maximin/theory/policies.hpp>
#include <maximin/theory/rational.hpp>

/// Enclosing what is not known exactly: the sections "Boxes" and "Certificates by bounds" of
/// docs/certificate-format.md. Floating point proposes, sweeps in integers prove.
namespace maximin {

struct CertifyOptions;

/// Actions by observation, or by true state: none empty, each ascending.
using Choices = std::vector<std::vector<Action>>;

/// low <= Q <= high in every entry. |S| x |A|, over one denominator if Scalar is Integer.
template <class Scalar>
struct TableBox {
  QTable<Scalar> low, high;
};

/// The actions that a maximin agent may take when it believes the true state to be in `belief` and its action values
/// lie in the box: never one that another is sure to beat, nor to equal where that comes first.
template <class Scalar>
std::vector<Action> candidates(const TableBox<Scalar>& q, std::span<const State> belief, TieBreak tie);

/// C(t): the same for every ball.
template <class Scalar>
Choices candidates(const TableBox<Scalar>& q, const Perturbation<Rational>& balls, TieBreak tie);

/// Numbers with `bits` binary places: where bounds are rounded to, outwards, so that they stay short.
class Grid {
 public:
  /// Some 60 bits below the largest value that the model can have.
  explicit Grid(const FiniteMdp<Rational>& mdp);

  long bits() const { return bits_; }
  const Integer& denominator() const { return denominator_; }
  /// The nearest multiple of 2^-bits below or above, in such multiples.
  Integer down(const Integer& numerator, const Integer& over) const;
  Integer up(const Integer& numerator, const Integer& over) const;
  Integer down(double x) const;
  Integer up(double x) const;

 private:
  long bits_;
  Integer denominator_;
};

/// low <= x <= high by state, over the denominator of a grid.
struct ValueBox {
  ScaledValues low, high;
};

/// What is known of one round of pessimistic Q-iteration, or of one phase of its limit.
struct RoundBox {
  TableBox<Integer> q;  ///< around Q_n
  Integer denominator;  ///< of q
  Choices choices;      ///< C_n(t), by observation
  Choices provoked;     ///< A_n(s), by true state
  ValueBox passed;      ///< around x_n(s) = Q_n(s,c_n(s)), where Q_{n+1} = back(x_n)
};

/// Values between which lie those of any policy pair that chooses from a round's choices and provoked actions, against
/// the attack of the pair and against the optimal attacker.
struct PairBox {
  ScaledValues below, above;
};

/// What is known of all rounds n >= N, in phases (n-N) mod their number: boxes that Q_n does not leave.
struct BoxLimit {
  std::vector<RoundBox> phases;
  std::vector<PairBox> pairs;  ///< by phase
};

/// One model's enclosures.
class Boxes {
 public:
  using Player = ControlProblem<double>::Player;
  enum class Side { below, above };

  /// All references must outlive this.
  Boxes(const FiniteMdp<Rational>& mdp, const Perturbation<Rational>& balls, const ScaledMdp& scaled,
        const CertifyOptions& options);

  const Grid& grid() const { return grid_; }

  /// Round 0, Q_0 = 0.
  RoundBox first_round() const;
  /// The round that follows one whose x lies in `passed`.
  RoundBox round_after(const ValueBox& passed) const;

  /// Values V on the grid with V <= TV (below) or V >= TV (above), T the Bellman operator of a player who picks among
  /// choices[s] in true state s. They enclose its fixed point, as closely as floating point finds it.
  ScaledValues enclose(Player player, const Choices& choices, Side side) const;
  /// Values below those of any policy of these choices against its optimal attacker.
  ScaledValues enclose_robust(const Choices& choices) const;
  PairBox enclose_pair(const Choices& choices, const Choices& provoked) const;

  /// Bounds on V*.
  ValueBox enclose_optimal() const;

  /// The numbers of the grid next to x.
  ValueBox on_grid(const ScaledValues& x) const;

  /// The rounds n >= N in `period` phases, from what is known of x_{N-1}. Nothing where floating point finds no boxes,
  /// or finds them too slowly.
  std::optional<BoxLimit> limit_after(const ValueBox& last, long period) const;

 private:
  struct Rounded;  // boxes in floating point

  void look(RoundBox& round) const;
  void find_provoked(RoundBox& round) const;
  std::vector<double> near_values(Player player, const Choices& choices) const;
  ValueBox on_grid(const Rounded& box) const;
  std::optional<BoxLimit> verified(const std::vector<Rounded>& phases, const ValueBox& last) const;
  Rounded widened_image(const Rounded& box, double margin) const;

  const FiniteMdp<Rational>& mdp_;
  const Perturbation<Rational>& balls_;
  const ScaledMdp& scaled_;
  const CertifyOptions& options_;
  Grid grid_;
  std::optional<FiniteMdp<double>> rounded_;  // nothing where its numbers do not fit
  Choices all_;                               // actions, by state
};

}  // namespace maximin
