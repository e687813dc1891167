#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include <maximin/counterexamples/counterexample.hpp>

namespace maximin {

/// What became of a search for a small counterexample.
struct CounterexampleSearch {
  /// A shape of models, and how many of it were looked at.
  struct Shape {
    State states;
    Action actions;
    long examined = 0;
    bool all = false;  ///< none was left out: none of this shape, or none smaller than the one found, shows it
  };
  std::optional<Model<Rational>> model;
  std::vector<Shape> shapes;  ///< of an exhaustive search
  long examined = 0;
};

/// Asked now and then whether time is up.
using StopRequest = std::function<bool()>;

/// Looks at all tiny models (`visit_tiny_models`) of 1 x 1 ... 2 x 3 states and actions, smaller shapes first and the
/// smaller models of a shape first, and ends with the first that shows what is searched. Throws InputError where the
/// counterexample has no search.
CounterexampleSearch search_exhaustively(const Counterexample& counterexample, const StopRequest& stop);

/// Draws random small models until one shows what is searched and its check refutes the claim, and shrinks it as far as
/// that goes (`shrink`): the smallest that was found, not the smallest there is. Throws InputError where the
/// counterexample has no search.
CounterexampleSearch search_randomly(const Counterexample& counterexample, std::uint64_t seed, const StopRequest& stop);

}  // namespace maximin
