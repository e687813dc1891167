#pragma once

#include <stdexcept>
#include <string>

namespace maximin {

/// Bad input: a model, a file or an argument that breaks a documented rule.
/// `what()` is one line that says where, what is wrong and what is expected. Programs exit with 2.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A budget (iterations, states, pairs) ran out before the answer was certified. Programs exit with 3.
/// Solvers throw it rather than return a number that has not converged.
class BudgetExhausted : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A claim was asked of a model that breaks an assumption of the claim. Programs exit with 4.
class AssumptionFails : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace maximin
