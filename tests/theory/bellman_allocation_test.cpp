// Nothing allocates inside a sweep once the outputs have their size. Every operator new of this program is counted, and
// so is every allocation of Eigen, which does not go through operator new: it asserts that it may allocate.

namespace maximin::counting {
inline bool on = false;
inline long allocations = 0;
}  // namespace maximin::counting

#define EIGEN_RUNTIME_NO_MALLOC
#define eigen_assert(condition) \
  if (!(condition)) ++::maximin::counting::allocations

#include <gtest/gtest.h>

#include <cstdlib>
#include <new>

#include <maximin/theory/bellman.hpp>

#include "small_models.hpp"

// Not inlined: the compiler would otherwise pair the malloc of one with the delete of the other.
[[gnu::noinline]] void* operator new(std::size_t size) {
  if (maximin::counting::on) ++maximin::counting::allocations;
  if (void* block = std::malloc(size > 0 ? size : 1)) return block;
  throw std::bad_alloc();
}
// What std::stable_sort asks for its buffer: left to the library, its block would go to the delete below, which is a
// mismatch under the address sanitizer.
[[gnu::noinline]] void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  if (maximin::counting::on) ++maximin::counting::allocations;
  return std::malloc(size > 0 ? size : 1);
}
[[gnu::noinline]] void operator delete(void* block) noexcept {
  std::free(block);
}
[[gnu::noinline]] void operator delete(void* block, std::size_t) noexcept {
  std::free(block);
}

namespace maximin {
namespace {

/// Allocations made by the call.
template <class Call>
long allocations_of(Call&& call) {
  counting::allocations = 0;
  counting::on = true;
  Eigen::internal::set_is_malloc_allowed(false);
  call();
  Eigen::internal::set_is_malloc_allowed(true);
  counting::on = false;
  return counting::allocations;
}

/// A larger model than fits anyone's small buffers.
FiniteMdp<double> ring(State n) {
  FiniteMdpBuilder<double> b(n, 3, 0.9);
  for (State s = 0; s < n; ++s) {
    for (Action a = 0; a < 3; ++a) {
      b.reward(s, a, (s * 7 + a * 3) % 11 - 5);
      b.transition(s, a, (s + a) % n, 0.5).transition(s, a, (s + a + 1) % n, 0.5);
    }
  }
  return std::move(b).build();
}

Perturbation<double> ring_balls(State n) {
  std::vector<double> x;
  for (State s = 0; s < n; ++s) x.push_back(s);
  return on_line(x, 2.0);
}

TEST(Allocations, AreCountedAtAll) {
  QTable<double> q;
  std::vector<double> list;
  EXPECT_GT(allocations_of([&] { q.resize(10, 10); }), 0) << "Eigen's";
  EXPECT_GT(allocations_of([&] { list.resize(100); }), 0) << "the library's";
  EXPECT_EQ(allocations_of([&] { q(0, 0) = list[0]; }), 0);
}

class Sweep : public testing::Test {
 protected:
  static constexpr State n = 50;
  const FiniteMdp<double> mdp_ = ring(n);
  const Perturbation<double> balls_ = ring_balls(n);
  QTable<double> q_ = mdp_.rewards(), out_;
  Values<double> v_;
  PessimisticStep<double> step_;

  /// Allocations of the second of two identical calls: the first gives the outputs their size.
  template <class Call>
  long once_sized(Call&& call) {
    EXPECT_GT(allocations_of(call), 0) << "the first call must give the outputs their size";
    return allocations_of(call);
  }
};

TEST_F(Sweep, OptimalityAllocatesNothing) {
  EXPECT_EQ(once_sized([&] { bellman_optimality(mdp_, q_, v_, out_); }), 0);
}

TEST_F(Sweep, FixedPairAllocatesNothing) {
  const Policy composed(n, 1);
  EXPECT_EQ(once_sized([&] { bellman_pair(mdp_, composed, q_, v_, out_); }), 0);
}

TEST_F(Sweep, RobustAllocatesNothing) {
  Policy policy(n, 0);
  policy[3] = 2;
  EXPECT_EQ(once_sized([&] { bellman_robust(mdp_, policy, balls_, q_, v_, out_); }), 0);
}

TEST_F(Sweep, PessimisticAllocatesNothing) {
  EXPECT_EQ(once_sized([&] { pessimistic_update(mdp_, balls_, q_, step_, out_); }), 0);
}

TEST_F(Sweep, ManyPessimisticRoundsAllocateNothing) {
  pessimistic_update(mdp_, balls_, q_, step_, out_);
  EXPECT_EQ(allocations_of([&] {
              for (int round = 0; round < 100; ++round) {
                pessimistic_update(mdp_, balls_, q_, step_, out_);
                q_.swap(out_);
              }
            }),
            0);
}

}  // namespace
}  // namespace maximin
