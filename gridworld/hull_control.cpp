#include <maximin/gridworld/hull_control.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include <maximin/theory/error.hpp>

namespace maximin {
namespace {

using gridworld::Cell;

/// A rectangle of squares.
struct Hull {
  int x_low, x_high, y_low, y_high;
  bool empty() const { return x_low >= x_high || y_low >= y_high; }
  long squares() const { return static_cast<long>(x_high - x_low) * (y_high - y_low); }
  bool holds(const Hull& h) const {
    return x_low <= h.x_low && h.x_high <= x_high && y_low <= h.y_low && h.y_high <= y_high;
  }
  friend bool operator==(const Hull&, const Hull&) = default;
};

/// By how many squares a displacement carries a square: to those from `least` to `most`.
struct Carry {
  int least, most;
};

/// The squares that the world is cut into. A coordinate or a displacement times their number in a unit is exact in
/// double precision, as a multiple of the quantum times a whole number below 2^9 is.
class Squares {
 public:
  Squares(double eps, int per_move) : per_cell_(2 * per_move) {
    // A closed interval as long as n squares touches n + 1 of them, if its ends are edges.
    window_ = static_cast<int>(std::ceil(2 * eps * per_cell_)) + 1;
    const int n = per_axis();
    kinds_.resize(static_cast<std::size_t>(n) * static_cast<std::size_t>(n));
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) kinds_[slot(i, j)] = gridworld::cell(i / per_cell_, j / per_cell_);
    }
  }

  int per_axis() const { return gridworld::side * per_cell_; }
  /// The most squares, in a row, that an observation leaves possible.
  int window() const { return window_; }
  int of(double coordinate) const { return static_cast<int>(std::floor(coordinate * per_cell_)); }

  Cell kind(int i, int j) const {
    if (i < 0 || j < 0 || i >= per_axis() || j >= per_axis()) return Cell::wall;
    return kinds_[slot(i, j)];
  }

  Carry carry(double displacement) const {
    const double squares = displacement * per_cell_;
    const int least = static_cast<int>(std::floor(squares));
    return {least, static_cast<int>(std::ceil(squares))};
  }

  /// The smallest rectangle around the open squares of another; empty if there are none.
  Hull open_part(const Hull& h) const {
    Hull part{h.x_high, h.x_low, h.y_high, h.y_low};
    for (int j = h.y_low; j < h.y_high; ++j) {
      for (int i = h.x_low; i < h.x_high; ++i) {
        if (kind(i, j) != Cell::free) continue;
        part = {std::min(part.x_low, i), std::max(part.x_high, i + 1), std::min(part.y_low, j),
                std::max(part.y_high, j + 1)};
      }
    }
    return part;
  }

 private:
  std::size_t slot(int i, int j) const {
    return static_cast<std::size_t>(j) * static_cast<std::size_t>(per_axis()) + static_cast<std::size_t>(i);
  }

  int per_cell_, window_;
  std::vector<Cell> kinds_;
};

/// Where the places of a hull may be after an action: squares as bits, a word for each row, from (x, y) on.
struct Arrivals {
  int x = 0, y = 0;
  std::vector<std::uint64_t> rows;
  bool gold = false, bomb = false;

  void add(int i, int j) { rows[static_cast<std::size_t>(j - y)] |= std::uint64_t{1} << (i - x); }

  /// The hull of those in columns and rows counted from (x, y); empty if there are none.
  Hull hull_within(int x_low, int x_high, int y_low, int y_high) const {
    const std::uint64_t upto = x_high >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << x_high) - 1;
    const std::uint64_t mask = upto & ~((std::uint64_t{1} << x_low) - 1);
    std::uint64_t any = 0;
    int first = y_high, last = y_high - 1;
    for (int j = y_low; j < y_high; ++j) {
      const std::uint64_t row = rows[static_cast<std::size_t>(j)] & mask;
      if (row == 0) continue;
      if (any == 0) first = j;
      any |= row;
      last = j;
    }
    if (any == 0) return {0, 0, 0, 0};
    return {x + std::countr_zero(any), x + 64 - std::countl_zero(any), y + first, y + last + 1};
  }
};

void move_square(const Squares& squares, int i, int j, Carry x, Carry y, Arrivals& arrivals) {
  for (int to_j = j + y.least; to_j <= j + y.most; ++to_j) {
    for (int to_i = i + x.least; to_i <= i + x.most; ++to_i) {
      switch (squares.kind(to_i, to_j)) {
        case Cell::gold:
          arrivals.gold = true;
          break;
        case Cell::bomb:
          arrivals.bomb = true;
          break;
        case Cell::wall:
          arrivals.add(i, j);
          break;
        case Cell::free:
          arrivals.add(to_i, to_j);
          break;
      }
    }
  }
}

void move_hull(const Squares& squares, const Hull& hull, const gridworld::Move& move, Arrivals& arrivals) {
  const Carry x = squares.carry(move.dx), y = squares.carry(move.dy);
  arrivals.gold = arrivals.bomb = false;
  arrivals.x = hull.x_low + std::min(0, x.least);
  arrivals.y = hull.y_low + std::min(0, y.least);
  arrivals.rows.assign(static_cast<std::size_t>(hull.y_high + std::max(0, y.most) - arrivals.y), 0);
  for (int j = hull.y_low; j < hull.y_high; ++j) {
    for (int i = hull.x_low; i < hull.x_high; ++i) {
      if (squares.kind(i, j) == Cell::free) move_square(squares, i, j, x, y, arrivals);
    }
  }
}

/// The largest hulls that an observation may leave of the arrivals.
void observe(const Squares& squares, const Arrivals& arrivals, std::vector<Hull>& out) {
  out.clear();
  const Hull all = arrivals.hull_within(0, 64, 0, static_cast<int>(arrivals.rows.size()));
  if (all.empty()) return;
  const int w = squares.window();
  const int x_end = all.x_high - arrivals.x, y_end = all.y_high - arrivals.y;
  const int x_first = all.x_low - arrivals.x, y_first = all.y_low - arrivals.y;
  for (int j = y_first; j == y_first || j + w <= y_end; ++j) {
    for (int i = x_first; i == x_first || i + w <= x_end; ++i) {
      const Hull met = squares.open_part(arrivals.hull_within(i, std::min(i + w, x_end), j, std::min(j + w, y_end)));
      if (!met.empty()) out.push_back(met);
    }
  }
  std::sort(out.begin(), out.end(), [](const Hull& a, const Hull& b) { return a.squares() > b.squares(); });
  std::size_t kept = 0;
  for (const Hull& h : out) {
    const auto end = out.begin() + static_cast<std::ptrdiff_t>(kept);
    if (std::none_of(out.begin(), end, [&](const Hull& larger) { return larger.holds(h); })) out[kept++] = h;
  }
  out.resize(kept);
}

/// Refuses what would take too long or too much.
const GridworldOptions& checked(const ObservationBall& ball, int cells_per_move, const GridworldOptions& world) {
  if (world.start_anywhere) {
    throw InputError("hull control: a world that starts anywhere, expected one that starts in open places");
  }
  if (cells_per_move < 1) {
    throw InputError("cells_per_move: " + std::to_string(cells_per_move) + ", expected at least 1");
  }
  const double window = 4 * ball.eps() * cells_per_move + 2, across = 2.0 * gridworld::side * cells_per_move;
  if (window + cells_per_move + 1 > 64 || across * across * window * window > 0x1p27) {
    throw InputError("cells_per_move: " + std::to_string(cells_per_move) + ", expected fewer for so large an eps");
  }
  return world;
}

}  // namespace

/// All hulls that are no wider than an observation's squares, and what is sure on each.
class HullControl::Table {
 public:
  Table(const ObservationBall& ball, int cells_per_move, const GridworldOptions& world)
      : ball_(ball), world_(checked(ball, cells_per_move, world)), squares_(ball.eps(), cells_per_move) {
    number_hulls();
    find_answers();
    solve();
  }

  const ObservationBall& ball() const { return ball_; }
  long hulls() const { return static_cast<long>(hulls_.size()); }

  /// The open part of the squares around a belief.
  Hull around(const BoxUnion& belief) const {
    const Box box = belief.hull();
    const auto end = [&](double high) { return squares_.of(high - gridworld::quantum) + 1; };
    return squares_.open_part({squares_.of(box.x_low), end(box.x_high), squares_.of(box.y_low), end(box.y_high)});
  }

  bool covers(const Hull& hull) const {
    const int w = squares_.window();
    return !hull.empty() && hull.x_high - hull.x_low <= w && hull.y_high - hull.y_low <= w;
  }

  Choice of(const Hull& hull) const {
    if (!covers(hull)) throw std::invalid_argument("hull control: a belief with no open place, or wider than a ball");
    const auto m = static_cast<std::size_t>(numbers_[slot(hull)]);
    return {values_[m], actions_[m]};
  }

  double sure_from(Point start) const {
    const int w = squares_.window(), n = squares_.per_axis();
    const int x = squares_.of(start.x), y = squares_.of(start.y);
    if (squares_.kind(x, y) != Cell::free) throw std::invalid_argument("hull control: a start that is not open");
    double least = std::numeric_limits<double>::infinity();
    for (int j = y - w + 1; j <= y; ++j) {
      for (int i = x - w + 1; i <= x; ++i) {
        const Hull seen{std::max(i, 0), std::min(i + w, n), std::max(j, 0), std::min(j + w, n)};
        least = std::min(least, of(squares_.open_part(seen)).value);
      }
    }
    return least;
  }

 private:
  static constexpr int gold = -1, bomb = -2;  // among the numbers of hulls

  std::size_t slot(const Hull& h) const {
    const auto n = static_cast<std::size_t>(squares_.per_axis()), w = static_cast<std::size_t>(squares_.window());
    const auto corner = static_cast<std::size_t>(h.y_low) * n + static_cast<std::size_t>(h.x_low);
    return (corner * w + static_cast<std::size_t>(h.y_high - h.y_low - 1)) * w +
           static_cast<std::size_t>(h.x_high - h.x_low - 1);
  }

  void number_hulls() {
    const int n = squares_.per_axis(), w = squares_.window();
    numbers_.assign(slot({n - 1, n - 1 + w, n - 1, n - 1 + w}) + 1, -1);
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) {
        for (int high = j + 1; high <= std::min(j + w, n); ++high) {
          for (int right = i + 1; right <= std::min(i + w, n); ++right) {
            const Hull h{i, right, j, high};
            if (squares_.open_part(h) != h) continue;
            numbers_[slot(h)] = static_cast<int>(hulls_.size());
            hulls_.push_back(h);
          }
        }
      }
    }
  }

  void find_answers() {
    Arrivals arrivals;
    std::vector<Hull> next;
    begin_.push_back(0);
    for (const Hull& hull : hulls_) {
      for (const auto& move : gridworld::moves) {
        move_hull(squares_, hull, move, arrivals);
        if (arrivals.gold) answers_.push_back(gold);
        if (arrivals.bomb) answers_.push_back(bomb);
        observe(squares_, arrivals, next);
        for (const Hull& h : next) answers_.push_back(numbers_[slot(h)]);
        begin_.push_back(answers_.size());
      }
    }
  }

  double worst_answer(std::size_t row, const std::vector<double>& later) const {
    double worst = std::numeric_limits<double>::infinity();
    for (std::size_t k = begin_[row]; k < begin_[row + 1]; ++k) {
      const int m = answers_[k];
      const double value = m == gold   ? world_.gold
                           : m == bomb ? world_.bomb
                                       : world_.step + later[static_cast<std::size_t>(m)];
      worst = std::min(worst, value);
    }
    return worst;
  }

  /// Backwards from the last step. Once values no longer change, the actions are those for any number of steps.
  void solve() {
    values_.assign(hulls_.size(), 0);
    actions_.assign(hulls_.size(), 0);
    std::vector<double> later;
    for (long t = 0; t < ContinuousGridworld::horizon && later != values_; ++t) {
      later = values_;
      for (std::size_t m = 0; m < hulls_.size(); ++m) {
        values_[m] = -std::numeric_limits<double>::infinity();
        for (std::size_t a = 0; a < gridworld::moves.size(); ++a) {
          const double value = worst_answer(m * gridworld::moves.size() + a, later);
          if (value <= values_[m]) continue;
          values_[m] = value;
          actions_[m] = static_cast<Action>(a);
        }
      }
    }
    answers_ = {};
    begin_ = {};
  }

  ObservationBall ball_;
  GridworldOptions world_;
  Squares squares_;
  std::vector<int> numbers_;  // by slot; -1 where a rectangle is no hull
  std::vector<Hull> hulls_;
  std::vector<std::size_t> begin_;  // offsets into answers_, by hull and action
  std::vector<int> answers_;        // numbers of hulls, gold or bomb
  std::vector<double> values_;
  std::vector<Action> actions_;
};

HullControl::HullControl(const ObservationBall& ball, int cells_per_move, const GridworldOptions& world)
    : table_(std::make_unique<const Table>(ball, cells_per_move, world)) {}
HullControl::~HullControl() = default;
HullControl::HullControl(HullControl&&) noexcept = default;
HullControl& HullControl::operator=(HullControl&&) noexcept = default;

bool HullControl::covers(const BoxUnion& belief) const {
  return !belief.empty() && table_->covers(table_->around(belief));
}

HullControl::Choice HullControl::choice(const BoxUnion& belief) const {
  if (belief.empty()) throw std::invalid_argument("hull control: an empty belief");
  return table_->of(table_->around(belief));
}

HullControl::Choice HullControl::first(Point shown) const {
  return choice(BoxBelief(ball()).reset(shown));
}

double HullControl::sure_from(Point start) const {
  return table_->sure_from(start);
}

long HullControl::hulls() const {
  return table_->hulls();
}

const ObservationBall& HullControl::ball() const {
  return table_->ball();
}

BoxUnion HullAgent::would_believe(Point shown) const {
  BoxUnion out;
  if (started_) {
    belief_.would_update(last_, shown, out);
    return out;
  }
  BoxBelief fresh(control_->ball());
  return fresh.reset(shown);
}

}  // namespace maximin
