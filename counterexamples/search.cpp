#include <maximin/counterexamples/search.hpp>

#include <string>
#include <utility>

#include <fmt/format.h>

#include <maximin/counterexamples/tiny_models.hpp>
#include <maximin/models/rationalise.hpp>
#include <maximin/models/shrink.hpp>
#include <maximin/models/small_random_model.hpp>
#include <maximin/theory/error.hpp>

namespace maximin {
namespace {

void require_search(const Counterexample& counterexample) {
  if (counterexample.searched != nullptr) return;
  throw InputError(
      fmt::format("search: {} has none, expected stationary-optimum or sharper-belief", counterexample.name));
}

/// Whether a drawn model shows it; one that cannot be decided does not.
bool shows(const Counterexample& counterexample, const Model<double>& model) {
  try {
    const Model<Rational> exact = rationalise(model);
    return counterexample.searched(exact) && counterexample.check(exact).refuted;
  } catch (const InputError&) {
    return false;
  } catch (const BudgetExhausted&) {
    return false;
  }
}

/// Small enough for |A|^|S| policies, and for exact values.
bool is_small(const Model<double>& model) {
  return model.mdp.states() <= 4 && model.mdp.actions() <= 3;
}

}  // namespace

CounterexampleSearch search_exhaustively(const Counterexample& counterexample, const StopRequest& stop) {
  require_search(counterexample);
  CounterexampleSearch result;
  for (const auto& [states, actions] : {std::pair(1, 1), {1, 2}, {1, 3}, {2, 1}, {2, 2}, {2, 3}}) {
    bool stopped = false;
    const long examined = visit_tiny_models(states, actions, [&](const Model<Rational>& model) {
      stopped = stop();
      if (stopped) return true;
      if (counterexample.searched(model)) result.model = model;
      return result.model.has_value();
    });
    result.shapes.push_back({states, actions, examined, !stopped});
    result.examined += examined;
    if (stopped || result.model) break;
  }
  return result;
}

CounterexampleSearch search_randomly(const Counterexample& counterexample, std::uint64_t seed,
                                     const StopRequest& stop) {
  require_search(counterexample);
  CounterexampleSearch result;
  for (std::uint64_t trial = 0; !stop(); ++trial) {
    Stream rng(seed, trial);
    const Model<double> model = small_random_model(20 + rng.below(20), rng);
    if (!is_small(model)) continue;
    ++result.examined;
    if (!shows(counterexample, model)) continue;
    // Out of time, nothing simpler is accepted any more and shrinking ends.
    const auto keeps = [&](const Model<double>& simpler) { return !stop() && shows(counterexample, simpler); };
    result.model = rationalise(shrink(model, keeps));
    return result;
  }
  return result;
}

}  // namespace maximin
