#include <maximin/tabular/pessimistic_q_iteration.hpp>

#include <algorithm>
#include <cstddef>
#include <unordered_map>

#include <fmt/format.h>

#include <maximin/theory/bounds.hpp>

namespace maximin {
namespace {

struct PairHash {
  std::size_t operator()(const PolicyPair& pair) const {
    std::size_t h = 1469598103934665603ull;
    const auto mix = [&](std::int32_t x) { h = (h ^ static_cast<std::uint32_t>(x)) * 1099511628211ull; };
    for (const Action a : pair.policy) mix(a);
    for (const State s : pair.attack) mix(s);
    return h;
  }
};

/// Watches a sequence of pair indices for periods 1 ... max_period: for each, how many rounds in a row it has held.
class PeriodWatch {
 public:
  explicit PeriodWatch(long max_period) : run_(static_cast<std::size_t>(max_period) + 1, 0) {}

  /// To be called after each new element of the sequence.
  void extend(const std::vector<int>& sequence) {
    const std::size_t n = sequence.size() - 1;
    for (std::size_t k = 1; k < run_.size(); ++k) {
      run_[k] = n >= k && sequence[n] == sequence[n - k] ? run_[k] + 1 : 0;
    }
  }

  /// The smallest period that has held long enough to have been seen twice over, or 0.
  long candidate() const {
    for (std::size_t k = 1; k < run_.size(); ++k) {
      if (run_[k] >= static_cast<long>(2 * k)) return static_cast<long>(k);
    }
    return 0;
  }

  /// For how many rounds in a row sequence[n] == sequence[n - k] has held.
  long run(long k) const { return run_[static_cast<std::size_t>(k)]; }

 private:
  std::vector<long> run_;
};

/// The last few iterates, addressed by n.
template <class Scalar>
class RecentIterates {
 public:
  explicit RecentIterates(long count) : ring_(static_cast<std::size_t>(count)) {}
  QTable<Scalar>& operator[](long n) { return ring_[static_cast<std::size_t>(n) % ring_.size()]; }

 private:
  std::vector<QTable<Scalar>> ring_;
};

template <class Scalar>
Scalar distance(const QTable<Scalar>& x, const QTable<Scalar>& y) {
  return (x - y).cwiseAbs().maxCoeff();
}

template <class Scalar>
QTable<Scalar> starting_point(const FiniteMdp<Scalar>& mdp, const std::optional<QTable<Scalar>>& initial) {
  if (!initial) return QTable<Scalar>::Constant(mdp.states(), mdp.actions(), Scalar(0));
  if (initial->rows() != mdp.states() || initial->cols() != mdp.actions()) {
    throw InputError(fmt::format("Q_0: {} x {}, expected one row per state and one column per action, {} x {}",
                                 initial->rows(), initial->cols(), mdp.states(), mdp.actions()));
  }
  return *initial;
}

/// How small |Q_{n+k} - Q_n| must be for period k.
template <class Scalar>
Scalar near(const FiniteMdp<Scalar>& mdp, const PessimisticQIterationOptions<Scalar>& options, long k) {
  const Scalar scale = mdp.rewards().cwiseAbs().maxCoeff() / (Scalar(1) - mdp.discount());
  const Scalar left = Scalar(1) - bounds::power(mdp.discount(), k);
  return std::max(Scalar(options.tolerance) * left, Scalar(4) * unit_roundoff<Scalar>()) * scale;
}

}  // namespace

template <class Scalar>
PessimisticQIteration<Scalar> pessimistic_q_iteration(const FiniteMdp<Scalar>& mdp,
                                                      const Perturbation<Scalar>& perturbation,
                                                      const PessimisticQIterationOptions<Scalar>& options,
                                                      const RoundObserver<Scalar>& observe) {
  if (perturbation.states() != mdp.states()) {
    throw InputError(
        fmt::format("perturbation: of {} states, expected the model's {}", perturbation.states(), mdp.states()));
  }
  PessimisticQIteration<Scalar> result;
  std::unordered_map<PolicyPair, int, PairHash> known;
  PessimisticStep<Scalar> step;
  PeriodWatch watch(options.max_period);
  RecentIterates<Scalar> recent(options.max_period + 2);

  recent[0] = starting_point(mdp, options.initial);
  if (options.keep_trajectory) result.trajectory.push_back(recent[0]);
  for (long n = 0; n < options.max_iterations; ++n) {
    pessimistic_update(mdp, perturbation, recent[n], step, recent[n + 1], options.tie);
    const auto [entry, is_new] = known.try_emplace({step.policy, step.attack}, static_cast<int>(known.size()));
    if (is_new) result.pairs.push_back(entry->first);
    result.pair_of.push_back(entry->second);
    if (observe) observe(n, recent[n], entry->second, entry->first);
    if (options.keep_trajectory) result.trajectory.push_back(recent[n + 1]);
    result.iterations = n + 1;

    watch.extend(result.pair_of);
    const long k = watch.candidate();
    if (k > 0 && distance(recent[n + 1], recent[n + 1 - k]) <= near(mdp, options, k)) {
      result.fate = k == 1 ? Fate::settled : Fate::cycles;
      result.period = k;
      result.periodic_from = n + 1 - k - watch.run(k);
      if (options.stop_when_periodic) break;
    } else {
      result.fate = Fate::undetermined;
    }
  }
  result.q = recent[result.iterations];
  return result;
}

template PessimisticQIteration<double> pessimistic_q_iteration(const FiniteMdp<double>&, const Perturbation<double>&,
                                                               const PessimisticQIterationOptions<double>&,
                                                               const RoundObserver<double>&);

}  // namespace maximin
