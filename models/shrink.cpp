#include <maximin/models/shrink.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <tuple>
#include <utility>

#include <fmt/format.h>

#include <maximin/models/model_draft.hpp>

namespace maximin {
namespace {

using GeometryKind = Geometry<double>::Kind;

/// What a number costs: a hundred for each character that it takes to write it, and among equals the smaller is
/// cheaper.
std::size_t cost(double x) {
  if (x == 0) return 0;
  return 100 * fmt::formatted_size("{}", x) + static_cast<std::size_t>(std::min(99.0, std::abs(x)));
}

template <class Matrix>
std::size_t cost_of_all(const Matrix& m) {
  std::size_t sum = 0;
  for (Eigen::Index i = 0; i < m.rows(); ++i) {
    for (Eigen::Index j = 0; j < m.cols(); ++j) sum += cost(m(i, j));
  }
  return sum;
}

/// What shrinking makes smaller, first component first. A stored transition counts for more than any number.
using Size = std::tuple<State, Action, std::size_t>;

Size size_of(const Model<double>& model) {
  const auto& mdp = model.mdp;
  std::size_t sum = 3000 * mdp.transition_count() + cost(mdp.discount()) + cost_of_all(mdp.rewards()) +
                    cost_of_all(model.geometry.points) + cost_of_all(model.geometry.distances) +
                    static_cast<std::size_t>(model.geometry.points.cols());
  for (State s = 0; s < mdp.states(); ++s) {
    for (Action a = 0; a < mdp.actions(); ++a) {
      for (const auto& next : mdp.successors(s, a)) sum += cost(next.probability);
    }
  }
  if (model.geometry.eps) sum += cost(*model.geometry.eps);
  sum += model.state_names.size() + model.action_names.size() + model.start.size() + model.notes.size();
  return {mdp.states(), mdp.actions(), sum};
}

/// `x` to `decimals` digits after the point, and the double nearest to that.
double rounded(double x, int decimals) {
  const double scale = decimals == 0 ? 1 : decimals == 1 ? 10 : 100;
  const double result = std::round(x * scale) / scale;
  return std::isfinite(result) ? result + 0.0 : x;
}

/// Offers one changed copy after another, until a visitor wants no more.
class Offers {
 public:
  Offers(const Model<double>& model, const ModelPredicate& visit)
      : draft_(model), size_(size_of(model)), visit_(visit) {}

  const ModelDraft& draft() const { return draft_; }

  /// Applies the change to a copy and offers the result if it is simpler and valid. Returns whether to stop.
  template <class Change>
  bool offer(Change change) {
    try {
      ModelDraft copy = draft_;
      change(copy);
      const Model<double> candidate = std::move(copy).build();
      return size_of(candidate) < size_ && visit_(candidate);
    } catch (const InputError&) {
      return false;  // e.g. a row whose probabilities were on the edge of the tolerance before they were added up
    }
  }

 private:
  ModelDraft draft_;
  Size size_;
  const ModelPredicate& visit_;
};

template <class Change>
void for_each_row(ModelDraft& draft, Change change) {
  for (auto& of_state : draft.rows) {
    for (auto& row : of_state) change(row);
  }
}

bool offer_fewer_states(Offers& offers) {
  constexpr std::size_t few = 12;  // states that may each take the place of a dropped one
  const auto n = static_cast<std::size_t>(offers.draft().states());
  const auto without = [&](std::size_t from, std::size_t to) {
    std::vector<bool> kept(n, true);
    for (std::size_t s = from; s < to; ++s) kept[s] = false;
    if (offers.offer([&](ModelDraft& d) { d.keep_states(kept, std::nullopt); })) return true;
    std::size_t tried = 0;
    for (std::size_t s = 0; s < n; ++s) {
      if (!kept[s] || (n > few && ++tried > 1)) continue;
      if (offers.offer([&](ModelDraft& d) { d.keep_states(kept, static_cast<State>(s)); })) return true;
    }
    return false;
  };
  for (std::size_t chunk = n / 2; chunk >= 1; chunk /= 2) {
    for (std::size_t end = n; end >= chunk; end -= chunk) {
      if (without(end - chunk, end)) return true;
    }
  }
  return false;
}

bool offer_fewer_actions(Offers& offers) {
  for (Action a = offers.draft().actions() - 1; a >= 0 && offers.draft().actions() > 1; --a) {
    if (offers.offer([&](ModelDraft& d) { d.drop_action(a); })) return true;
  }
  return false;
}

bool offer_fewer_words(Offers& offers) {
  return offers.offer([](ModelDraft& d) {
    d.whole.state_names.clear();
    d.whole.action_names.clear();
    d.whole.start.clear();
    d.whole.notes.clear();
  });
}

bool offer_simpler_rewards(Offers& offers) {
  const double largest = offers.draft().rewards.cwiseAbs().maxCoeff();
  if (offers.offer([](ModelDraft& d) { d.rewards.setZero(); })) return true;
  const double scales[] = {1, 1 / largest, 4 / largest, 20 / largest};
  for (const double scale : scales) {
    if (!std::isfinite(scale)) continue;
    const auto to_integers = [&](double r) { return rounded(scale * r, 0); };
    if (offers.offer([&](ModelDraft& d) { d.rewards = d.rewards.unaryExpr(to_integers).eval(); })) return true;
  }
  for (const int decimals : {1, 2}) {
    const auto to_decimals = [&](double r) { return rounded(r, decimals); };
    if (offers.offer([&](ModelDraft& d) { d.rewards = d.rewards.unaryExpr(to_decimals).eval(); })) return true;
  }
  return false;
}

bool offer_simpler_kernel(Offers& offers) {
  if (offers.offer([](ModelDraft& d) { for_each_row(d, [](auto& row) { row = deterministic_row(row); }); })) {
    return true;
  }
  for (const int parts : {2, 4, 8, 64}) {
    const auto round_row = [&](auto& row) { row = rounded_row(row, parts); };
    if (offers.offer([&](ModelDraft& d) { for_each_row(d, round_row); })) return true;
  }
  return false;
}

bool offer_simpler_points(Offers& offers) {
  const auto& geometry = offers.draft().whole.geometry;
  if (geometry.kind != GeometryKind::points) return false;
  for (Eigen::Index i = geometry.points.cols() - 1; i >= 0 && geometry.points.cols() > 1; --i) {
    if (offers.offer([&](ModelDraft& d) { d.drop_dimension(i); })) return true;
  }
  const auto change = [&](double unit, bool to_origin, int decimals) {
    return offers.offer([&](ModelDraft& d) {
      auto& g = d.whole.geometry;
      if (to_origin) g.points.rowwise() -= g.points.colwise().minCoeff().eval();
      g.points = (g.points / unit).unaryExpr([&](double x) { return rounded(x, decimals); }).eval();
      if (g.eps && unit != 1) *g.eps /= unit;
    });
  };
  const double eps = geometry.eps.value_or(1);
  for (const int decimals : {0, 1, 2}) {
    if (eps > 0 && eps != 1 && (change(eps, true, decimals) || change(eps / 4, true, decimals))) return true;
    if (change(1, true, decimals) || change(1, false, decimals)) return true;
  }
  return false;
}

bool offer_simpler_eps(Offers& offers) {
  const auto& geometry = offers.draft().whole.geometry;
  const auto& eps = geometry.eps;
  if (!eps || geometry.kind == GeometryKind::neighbourhoods) return false;
  for (const double simpler : {0.0, 1.0, std::floor(*eps), std::ceil(*eps), rounded(*eps, 1), rounded(*eps, 2)}) {
    if (offers.offer([&](ModelDraft& d) { d.whole.geometry.eps = simpler; })) return true;
  }
  return false;
}

bool offer_simpler_discount(Offers& offers) {
  const double gamma = offers.draft().discount;
  for (const double simpler : {0.0, 0.5, rounded(gamma, 1), std::floor(gamma * 10) / 10, rounded(gamma, 2)}) {
    if (offers.offer([&](ModelDraft& d) { d.discount = simpler; })) return true;
  }
  return false;
}

bool offer_one_simpler_row(Offers& offers) {
  const auto& rows = offers.draft().rows;
  for (std::size_t s = 0; s < rows.size(); ++s) {
    for (std::size_t a = 0; a < rows[s].size(); ++a) {
      if (rows[s][a].size() > 1) {
        for (const auto& next : rows[s][a]) {
          if (offers.offer([&](ModelDraft& d) { d.rows[s][a] = {{next.target, 1.0}}; })) return true;
        }
      }
      for (const int parts : {2, 4, 8, 64}) {
        if (offers.offer([&](ModelDraft& d) { d.rows[s][a] = rounded_row(d.rows[s][a], parts); })) return true;
      }
    }
  }
  return false;
}

bool offer_one_simpler_reward(Offers& offers) {
  for (State s = 0; s < offers.draft().states(); ++s) {
    for (Action a = 0; a < offers.draft().actions(); ++a) {
      const double r = offers.draft().rewards(s, a);
      for (const double simpler : {0.0, rounded(r, 0), std::trunc(r / 2), rounded(r, 1), rounded(r, 2)}) {
        if (offers.offer([&](ModelDraft& d) { d.rewards(s, a) = simpler; })) return true;
      }
    }
  }
  return false;
}

bool offer_one_simpler_coordinate(Offers& offers) {
  const auto& geometry = offers.draft().whole.geometry;
  if (geometry.kind != GeometryKind::points) return false;
  for (Eigen::Index s = 0; s < geometry.points.rows(); ++s) {
    for (Eigen::Index i = 0; i < geometry.points.cols(); ++i) {
      const double x = geometry.points(s, i);
      for (const double simpler : {0.0, rounded(x, 0), std::trunc(x / 2), rounded(x, 1), rounded(x, 2)}) {
        if (offers.offer([&](ModelDraft& d) { d.whole.geometry.points(s, i) = simpler; })) return true;
      }
    }
  }
  return false;
}

}  // namespace

bool visit_simpler_models(const Model<double>& model, const ModelPredicate& visit) {
  Offers offers(model, visit);
  return offer_fewer_states(offers) || offer_fewer_actions(offers) || offer_fewer_words(offers) ||
         offer_simpler_kernel(offers) || offer_simpler_rewards(offers) || offer_simpler_points(offers) ||
         offer_simpler_eps(offers) || offer_simpler_discount(offers) || offer_one_simpler_row(offers) ||
         offer_one_simpler_reward(offers) || offer_one_simpler_coordinate(offers);
}

std::vector<Model<double>> simpler_models(const Model<double>& model) {
  std::vector<Model<double>> all;
  visit_simpler_models(model, [&](const Model<double>& simpler) {
    all.push_back(simpler);
    return false;
  });
  return all;
}

Model<double> shrink(Model<double> model, const ModelPredicate& keeps, long max_tests) {
  long tests = 0;
  bool simpler_found = true;
  while (simpler_found && tests < max_tests) {
    simpler_found = false;
    Model<double> next = model;
    visit_simpler_models(model, [&](const Model<double>& candidate) {
      if (++tests > max_tests) return true;
      if (!keeps(candidate)) return false;
      next = candidate;
      return simpler_found = true;
    });
    model = std::move(next);
  }
  return model;
}

}  // namespace maximin
