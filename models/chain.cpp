#include <maximin/models/chain.hpp>

#include <algorithm>
#include <cstddef>
#include <utility>

#include <fmt/format.h>

#include <maximin/theory/error.hpp>

namespace maximin {

Model<double> chain(State states, double discount, double slip) {
  if (states < 1 || states > 1'000'000) {
    throw InputError(fmt::format("states: {}, expected 1 to 1000000", states));
  }
  if (!(slip >= 0 && slip <= 1)) throw InputError(fmt::format("slip: {}, expected 0 to 1", slip));
  enum : Action { forward, back, actions };
  FiniteMdpBuilder<double> builder(states, actions, discount);
  for (State s = 0; s < states; ++s) {
    const bool last = s == states - 1;
    const State ahead = last ? s : s + 1;
    const double pay_ahead = last ? 10 : 0, pay_back = 2;
    for (const Action a : {forward, back}) {
      const double p_ahead = a == forward ? 1 - slip : slip;
      builder.reward(s, a, p_ahead * pay_ahead + (1 - p_ahead) * pay_back);
      if (ahead == 0) {
        builder.transition(s, a, 0, 1);
      } else {
        builder.transition(s, a, ahead, p_ahead).transition(s, a, 0, 1 - p_ahead);
      }
    }
  }
  Model<double> model{.mdp = std::move(builder).build()};
  model.name = fmt::format("chain of {} states", states);
  model.action_names = {"forward", "back"};
  model.start.assign(static_cast<std::size_t>(states), 0);
  model.start[0] = 1;
  model.geometry.kind = Geometry<double>::Kind::points;
  model.geometry.points.resize(states, 1);
  for (State s = 0; s < states; ++s) model.geometry.points(s, 0) = s;
  model.geometry.norm = Norm::l1;
  model.geometry.eps = 1;
  return model;
}

}  // namespace maximin
