#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <maximin/models/model.hpp>
#include <maximin/theory/rational.hpp>

namespace maximin {

/// A claim that is not true, with the model that refutes it and a check in rational numbers, without any tolerance.
struct Counterexample {
  /// A number and what it is.
  struct Quantity {
    std::string what;
    Rational value;
  };

  /// What a check found on a model: two numbers that the claim says are equal, or in the other order.
  struct Finding {
    Quantity promised;  ///< by the claim
    Quantity found;
    bool refuted = false;
    std::vector<std::string> evidence = {};  ///< what else was found on the way, a line each
  };

  std::string_view name;         ///< on command lines
  std::string_view title;        ///< a few words
  std::string_view claim;        ///< what is not true, in one sentence
  std::string_view explanation;  ///< a few lines for a lecture
  Model<Rational> (*model)();
  /// Exact, and for any model: most do not refute the claim. Throws InputError where the model is of the wrong size.
  Finding (*check)(const Model<Rational>& model);
  /// Whether a model shows what a search for the smallest one looks for; null where there is no search.
  bool (*searched)(const Model<Rational>& model) = nullptr;
};

}  // namespace maximin
