#pragma once

#include "model.hpp"

namespace maximin::checker {

/// What is known of a table Q: it lies between two, which are over one denominator.
struct Enclosure {
  Table low, high;
};

/// back(V) and back(W) of values V <= W. Where V <= W is not known yet, candidates() may be empty.
Enclosure enclose(const Model& model, const Table& low, const Table& high);

/// The actions that may be argmax_a min_{m in belief} Q(m,a), ascending: one, where Q is known.
Indices candidates(const Model& model, const Enclosure& q, const Indices& belief, bool highest);

/// What an agent may do whose Q is only enclosed, and an attacker who makes the least of it.
struct Choices {
  std::vector<Indices> candidates;  ///< C(t), by observation
  std::vector<Indices> possible;    ///< the union of C(t), t in B(s), by true state
  Table low, high;                  ///< min over t in B(s) of the least Lo, and of the greatest Hi, in C(t), as values
};
Choices choices(const Model& model, const Enclosure& q, bool highest);

/// The actions that such an attacker may provoke: A(s), those in possible[s] with Lo(s,a) <= most(s).
std::vector<Indices> provoked(const Model& model, const Enclosure& q, const Choices& choices, const Table& most);

enum class Side { below, above };

/// Refuses values, read at that path, that are not below (above) back of them for all actions of sets[s]. Returns it.
Table expect_side(const Model& model, const Table& values, const std::string& path, Side side,
                  const std::vector<Indices>& sets);

/// Refuses values that are not below (above) others, state by state.
void expect_side(const Table& values, const std::string& path, Side side, const Table& others);

}  // namespace maximin::checker
