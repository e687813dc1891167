#include <maximin/tabular/exact_solve.hpp>

#include <flint/fmpq.h>
#include <flint/fmpq_mat.h>
#include <flint/fmpz.h>
#include <flint/fmpz_mat.h>

#include <fmt/format.h>

#include <maximin/theory/error.hpp>

namespace maximin {
namespace {

/// FLINT's matrices, freed when they go out of scope.
struct IntegerMatrix {
  IntegerMatrix(slong rows, slong columns) { fmpz_mat_init(m, rows, columns); }
  ~IntegerMatrix() { fmpz_mat_clear(m); }
  IntegerMatrix(const IntegerMatrix&) = delete;
  IntegerMatrix& operator=(const IntegerMatrix&) = delete;

  void set(slong i, slong j, const Integer& x) { fmpz_set_mpz(fmpz_mat_entry(m, i, j), x.backend().data()); }

  fmpz_mat_t m;
};

struct RationalMatrix {
  RationalMatrix(slong rows, slong columns) { fmpq_mat_init(m, rows, columns); }
  ~RationalMatrix() { fmpq_mat_clear(m); }
  RationalMatrix(const RationalMatrix&) = delete;
  RationalMatrix& operator=(const RationalMatrix&) = delete;

  Rational get(slong i, slong j) const {
    Rational x;
    fmpq_get_mpq(x.backend().data(), fmpq_mat_entry(m, i, j));
    return x;
  }

  fmpq_mat_t m;
};

/// FLINT keeps memory of its own in each thread; it is given back when the thread that used it ends.
struct FlintOfThisThread {
  ~FlintOfThisThread() { flint_cleanup(); }
};

/// The least common denominator of a row of (I - gamma P) x = R.
Integer denominator_of(const ExactSystem& system, std::size_t i) {
  Integer common = denominator(system.rewards[i]);
  for (const auto& next : system.rows[i]) {
    common = lcm(common, denominator(Rational(system.discount * next.probability)));
  }
  return common;
}

}  // namespace

Values<Rational> solve_exactly(const ExactSystem& system) {
  const std::size_t n = system.rewards.size();
  if (n > max_exact_unknowns) {
    throw BudgetExhausted(fmt::format("exact solve: {} unknowns, expected at most {}", n, max_exact_unknowns));
  }
  thread_local const FlintOfThisThread given_back_at_exit;
  const auto size = static_cast<slong>(n);
  IntegerMatrix matrix(size, size), right(size, 1);
  for (std::size_t i = 0; i < n; ++i) {
    const auto row = static_cast<slong>(i);
    const Integer common = denominator_of(system, i);
    matrix.set(row, row, common);
    for (const auto& next : system.rows[i]) {
      const auto column = static_cast<slong>(next.target);
      const Rational scaled = common * system.discount * next.probability;
      Integer entry = -numerator(scaled);
      if (column == row) entry += common;
      matrix.set(row, column, entry);
    }
    right.set(row, 0, numerator(Rational(common * system.rewards[i])));
  }
  RationalMatrix solution(size, 1);
  if (!fmpq_mat_solve_fmpz_mat_dixon(solution.m, matrix.m, right.m)) {
    throw std::logic_error("exact solve: a singular system, which none with discount below 1 is");
  }
  Values<Rational> x(size);
  for (slong i = 0; i < size; ++i) x[i] = solution.get(i, 0);
  return x;
}

}  // namespace maximin
