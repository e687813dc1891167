#pragma once

#include <string>

#include <fmt/format.h>

#include <maximin/models/model.hpp>
#include <maximin/theory/rational.hpp>
#include <maximin/theory/types.hpp>

/// Exact numbers and policies as text, for the evidence of a check.
namespace maximin {

/// "209/20", "-3".
inline std::string exact_text(const Rational& x) {
  return x.str();
}

/// "near: 8, far: 1".
inline std::string exact_text(const Model<Rational>& model, const Values<Rational>& v) {
  std::string text;
  for (State s = 0; s < v.size(); ++s) {
    text += fmt::format("{}{}: {}", s == 0 ? "" : ", ", model.state_name(s), exact_text(v[s]));
  }
  return text;
}

/// "near: go, far: wait".
inline std::string policy_text(const Model<Rational>& model, const Policy& policy) {
  std::string text;
  for (State s = 0; s < model.mdp.states(); ++s) {
    text += fmt::format("{}{}: {}", s == 0 ? "" : ", ", model.state_name(s),
                        model.action_name(policy[static_cast<std::size_t>(s)]));
  }
  return text;
}

}  // namespace maximin
