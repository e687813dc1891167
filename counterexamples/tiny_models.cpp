#include <maximin/counterexamples/tiny_models.hpp>

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include <maximin/theory/error.hpp>

namespace maximin {
namespace {

/// What one action does in one state.
struct Deed {
  int reward;
  State first, second;  ///< where to: second == first, or a fair coin between the two

  int size(State from) const {
    const int arrows = (first != from ? 1 : 0) + (second != first && second != from ? 1 : 0);
    return (reward < 0 ? -reward : reward) + arrows;
  }
};

/// What one action does, by state.
struct ActionType {
  std::vector<Deed> deeds;
  int size = 0;
};

std::vector<Deed> all_deeds(State states) {
  std::vector<Deed> deeds;
  for (const int reward : {0, 1, -1, 2, -2}) {
    for (State first = 0; first < states; ++first) {
      for (State second = first; second < states; ++second) deeds.push_back({reward, first, second});
    }
  }
  return deeds;
}

/// All that an action may do, by size.
std::vector<ActionType> all_action_types(State states) {
  const std::vector<Deed> deeds = all_deeds(states);
  std::vector<ActionType> types{{}};
  for (State s = 0; s < states; ++s) {
    std::vector<ActionType> longer;
    for (const ActionType& type : types) {
      for (const Deed& deed : deeds) {
        ActionType next = type;
        next.deeds.push_back(deed);
        next.size += deed.size(s);
        longer.push_back(std::move(next));
      }
    }
    types = std::move(longer);
  }
  std::stable_sort(types.begin(), types.end(), [](const auto& x, const auto& y) { return x.size < y.size; });
  return types;
}

Model<Rational> model_of(State states, const std::vector<const ActionType*>& chosen) {
  const auto actions = static_cast<Action>(chosen.size());
  FiniteMdpBuilder<Rational> b(states, actions, Rational(1, 2));
  for (State s = 0; s < states; ++s) {
    for (Action a = 0; a < actions; ++a) {
      const Deed& deed = chosen[static_cast<std::size_t>(a)]->deeds[static_cast<std::size_t>(s)];
      b.reward(s, a, deed.reward);
      if (deed.first == deed.second) {
        b.transition(s, a, deed.first, 1);
      } else {
        b.transition(s, a, deed.first, Rational(1, 2)).transition(s, a, deed.second, Rational(1, 2));
      }
    }
  }
  Model<Rational> model{.mdp = std::move(b).build()};
  model.geometry.kind = Geometry<Rational>::Kind::discrete;
  model.geometry.eps = Rational(1);
  return model;
}

/// Every choice of so many types in ascending order whose sizes sum to `size`.
class Choices {
 public:
  Choices(State states, Action actions, const std::function<bool(const Model<Rational>&)>& visit)
      : states_(states), actions_(static_cast<std::size_t>(actions)), types_(all_action_types(states)), visit_(visit) {}

  long visit_all() {
    for (int size = 0; size <= types_.back().size * static_cast<int>(actions_); ++size) {
      if (extend(0, size)) break;
    }
    return visited_;
  }

 private:
  bool extend(std::size_t from, int size) {
    if (chosen_.size() == actions_) {
      if (size != 0) return false;
      ++visited_;
      return visit_(model_of(states_, chosen_));
    }
    for (std::size_t i = from; i < types_.size() && types_[i].size <= size; ++i) {
      chosen_.push_back(&types_[i]);
      const bool stop = extend(i + 1, size - types_[i].size);
      chosen_.pop_back();
      if (stop) return true;
    }
    return false;
  }

  State states_;
  std::size_t actions_;
  std::vector<ActionType> types_;
  const std::function<bool(const Model<Rational>&)>& visit_;
  std::vector<const ActionType*> chosen_;
  long visited_ = 0;
};

}  // namespace

long visit_tiny_models(State states, Action actions, const std::function<bool(const Model<Rational>&)>& visit) {
  if (states < 1 || states > 3 || actions < 1)
    throw InputError("tiny models: expected 1 to 3 states and at least 1 action");
  return Choices(states, actions, visit).visit_all();
}

Rational tiny_size(const FiniteMdp<Rational>& mdp) {
  Rational size(0);
  for (State s = 0; s < mdp.states(); ++s) {
    for (Action a = 0; a < mdp.actions(); ++a) {
      size += abs(mdp.reward(s, a));
      for (const auto& next : mdp.successors(s, a)) size += next.target == s ? 0 : 1;
    }
  }
  return size;
}

}  // namespace maximin
