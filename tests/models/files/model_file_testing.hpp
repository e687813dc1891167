#pragma once

#include <string>
#include <utility>

#include <maximin/models/model.hpp>
#include <maximin/theory/error.hpp>
#include <maximin/theory/random.hpp>

/// What the tests of the model files share.
namespace maximin::testing {

/// The message of the InputError that `call` throws; "(no error)" when it throws none.
template <class Call>
std::string error_of(Call&& call) {
  try {
    std::forward<Call>(call)();
  } catch (const InputError& error) {
    return error.what();
  }
  return "(no error)";
}

/// Whether every part of the two models is the same, to the last bit.
inline bool same_geometry(const Geometry<double>& x, const Geometry<double>& y) {
  const auto same_table = [](const auto& a, const auto& b) {
    return a.rows() == b.rows() && a.cols() == b.cols() && (a.size() == 0 || a == b);
  };
  return x.kind == y.kind && same_table(x.points, y.points) && x.norm == y.norm &&
         same_table(x.distances, y.distances) && x.neighbourhoods == y.neighbourhoods && x.eps == y.eps;
}

inline bool same_model(const Model<double>& x, const Model<double>& y) {
  return x.mdp == y.mdp && same_geometry(x.geometry, y.geometry) && x.name == y.name &&
         x.state_names == y.state_names && x.action_names == y.action_names && x.start == y.start && x.notes == y.notes;
}

/// What of a model a random one shall have.
struct ModelParts {
  bool names = true;     ///< names of states and actions, at random
  bool plain = false;    ///< ... of letters, digits, '-' and '_' only
  bool start = true;     ///< a start distribution, at random
  bool geometry = true;  ///< points, distances, neighbourhoods, hops or discrete, at random
};

/// A random model of up to 6 states and 4 actions, with rewards of every magnitude a double has.
Model<double> random_model(Stream& rng, const ModelParts& parts = {});

}  // namespace maximin::testing
