#pragma once

#include <rapidcheck.h>

#include <ostream>

#include <maximin/models/files/maximin_json.hpp>
#include <maximin/models/model.hpp>
#include <maximin/models/shrink.hpp>
#include <maximin/models/small_random_model.hpp>

/// Random models with shrinking for property tests with RapidCheck. Link maximin::rapidcheck.
///
///     RC_GTEST_PROP(Values, AreBounded, (const maximin::Model<double>& model)) { ... }   // with points, norm, eps
///     RC_GTEST_PROP(Values, AreFinite, (const maximin::FiniteMdp<double>& mdp)) { ... }
///
/// A failing model is shrunk by the steps of `simpler_models` and shown as a model file, ready to be saved.
namespace maximin {

/// Shows the model as a model file.
inline void showValue(const Model<double>& model, std::ostream& out) {
  write_maximin_json(model, out);
}

/// Shows the MDP as a model file.
inline void showValue(const FiniteMdp<double>& mdp, std::ostream& out) {
  write_maximin_json(Model<double>{.mdp = mdp}, out);
}

/// Small models with a geometry, as by `small_random_model`. RapidCheck's size grows from 0 to 100 in a run.
inline rc::Gen<Model<double>> arbitrary_model() {
  return rc::Gen<Model<double>>([](const rc::Random& random, int size) {
    rc::Random source(random);
    Stream rng(source.next());
    return rc::shrinkable::shrinkRecur(small_random_model(size, rng), [](const Model<double>& model) {
      return rc::seq::fromContainer(simpler_models(model));
    });
  });
}

}  // namespace maximin

namespace rc {

template <>
struct Arbitrary<maximin::Model<double>> {
  static Gen<maximin::Model<double>> arbitrary() { return maximin::arbitrary_model(); }
};

template <>
struct Arbitrary<maximin::FiniteMdp<double>> {
  static Gen<maximin::FiniteMdp<double>> arbitrary() {
    return gen::map(maximin::arbitrary_model(), [](maximin::Model<double>&& model) { return std::move(model.mdp); });
  }
};

}  // namespace rc
