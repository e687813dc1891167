#include <maximin/models/model_family.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <maximin/models/pairwise_distances.hpp>
#include <maximin/models/random_lipschitz_mdp.hpp>
#include <maximin/models/rescale.hpp>
#include <maximin/theory/lipschitz.hpp>

namespace maximin {
namespace {

constexpr std::array<std::pair<Family, std::string_view>, 6> names{{{Family::informative, "informative"},
                                                                    {Family::broad, "broad"},
                                                                    {Family::sparse, "sparse"},
                                                                    {Family::cycling, "cycling"},
                                                                    {Family::costs, "costs"},
                                                                    {Family::mixed, "mixed"}}};

int draw(const std::optional<Range<int>>& asked, Range<int> usual, Stream& rng) {
  const auto [low, high] = asked.value_or(usual);
  return rng.integer(low, high);
}

double draw(const std::optional<Range<double>>& asked, Range<double> usual, Stream& rng) {
  const auto [low, high] = asked.value_or(usual);
  return rng.uniform(low, high);
}

template <class T>
T pick(std::initializer_list<T> choices, Stream& rng) {
  return choices.begin()[rng.below(static_cast<int>(choices.size()))];
}

Norm draw_norm(const FamilyOptions& o, Stream& rng) {
  const Norm drawn = pick({Norm::l1, Norm::l2, Norm::linf}, rng);
  return o.norm.value_or(drawn);
}

/// The side of a box whose diameter is 1.
double side_of_unit_diameter(Norm norm, int dimension) {
  if (norm == Norm::linf) return 1;
  return norm == Norm::l1 ? 1.0 / dimension : 1 / std::sqrt(dimension);
}

/// Sizes, sign, sparsity and norm, each from the usual ranges of the family unless asked otherwise.
LipschitzMdpOptions draw_sizes(const FamilyOptions& o, Range<State> states, Range<double> discount, Stream& rng) {
  LipschitzMdpOptions lipschitz;
  lipschitz.states = draw(o.states, states, rng);
  lipschitz.actions = draw(o.actions, {2, 5}, rng);
  lipschitz.discount = draw(o.discount, discount, rng);
  lipschitz.norm = draw_norm(o, rng);
  lipschitz.dimension = draw(std::optional<Range<int>>(), {1, 3}, rng);
  lipschitz.dimension = o.dimension.value_or(lipschitz.dimension);
  lipschitz.sign = pick({RewardSign::mixed, RewardSign::nonnegative, RewardSign::nonpositive}, rng);
  lipschitz.sharpness = rng.uniform();
  return lipschitz;
}

/// Moves the points closer together if no kernel on them reaches l_p. Returns their distances.
PairwiseDistances bring_within_reach(Metric<double>::Points& points, Norm norm, double l_p) {
  PairwiseDistances distances = pairwise_distances(Metric<double>::from_points(points, norm));
  if (l_p * distances.least <= 1) return distances;
  points /= l_p * distances.least;
  return pairwise_distances(Metric<double>::from_points(points, norm));
}

/// In units where eps = 1 and l_r = 1, Theorem 1 as printed is below the trivial bound iff
///
///     c (1 + l_p |S| R_max/(1-gamma)) < gamma span,   c = 2 gamma (1+gamma)/(1-gamma).
///
/// The model aims at c (...) = u gamma span with a random u < 1: a share v of it for rewards, which gives the span and
/// hence how wide the points must be spread, the rest for the kernel, which gives l_p. The points come in groups as
/// small as a ball, so that balls hold several states; the actions' rewards stay within about a ball's worth of one
/// another, and mostly where an action leads does not depend on it, so that the best action changes within a ball.
Model<double> draw_informative(const FamilyOptions& o, Stream& rng) {
  LipschitzMdpOptions lipschitz = draw_sizes(o, {5, 40}, {0.2, 0.8}, rng);
  const double gamma = lipschitz.discount;
  const double c = std::max(0.5, 2 * gamma * (1 + gamma) / (1 - gamma));
  const double u = rng.uniform(0.2, 0.95), v = rng.uniform(0.3, 1);
  const double span = std::max(2.0, c / (gamma * u * v));
  lipschitz.action_gap = rng.uniform(0.1, 1.5);
  lipschitz.same_common_row = rng.chance(0.75);
  lipschitz.successors = o.successors.value_or(pick({0, 0, 2, 3, 5}, rng));
  const double l_p = gamma * u * (1 - v) * (1 - gamma) / (c * lipschitz.states);

  const double group_side = side_of_unit_diameter(lipschitz.norm, lipschitz.dimension) * rng.uniform(0.7, 1.2);
  const double side = std::max(4.0, span * rng.uniform(1.5, 4));
  auto points = grouped_points(lipschitz.states, lipschitz.dimension, side, group_side, rng);
  const double unit = o.eps && *o.eps > 0 ? *o.eps : !o.eps && o.l_p && *o.l_p > 0 ? l_p / *o.l_p : 1;
  points *= unit;
  lipschitz.eps = o.eps.value_or(unit);
  lipschitz.l_p = o.l_p.value_or(l_p / unit);
  lipschitz.l_r = o.l_r.value_or(1 / unit);
  const PairwiseDistances distances = bring_within_reach(points, lipschitz.norm, lipschitz.l_p);
  lipschitz.reward_span = lipschitz.l_r * std::clamp(span * unit, distances.least, distances.diameter);
  lipschitz.action_gap *= lipschitz.l_r * unit;
  return random_lipschitz_mdp(std::move(points), lipschitz, rng);
}

/// Anything, in the unit box. The fourth power of a uniform number spreads l_p over orders of magnitude below what the
/// points allow.
Model<double> draw_broad(const FamilyOptions& o, bool sparse, Stream& rng) {
  LipschitzMdpOptions lipschitz = draw_sizes(o, sparse ? Range<State>{8, 40} : Range<State>{2, 30}, {0.05, 0.95}, rng);
  lipschitz.successors = o.successors.value_or(sparse ? rng.integer(2, 4) : 0);
  lipschitz.layout = pick({PointLayout::uniform, PointLayout::lattice, PointLayout::line}, rng);
  auto points = random_points(lipschitz.layout, lipschitz.states, lipschitz.dimension, 1, rng);
  const PairwiseDistances distances = bring_within_reach(points, lipschitz.norm, o.l_p.value_or(0));
  const double u = rng.uniform(), share = rng.uniform();
  lipschitz.l_p = o.l_p.value_or(share * share * share * share / distances.least);
  lipschitz.eps = o.eps.value_or(distances.least + u * u * (0.5 - std::min(0.5, distances.least)));
  lipschitz.l_r = o.l_r.value_or(pick({0.1, 1.0, 10.0}, rng));
  return random_lipschitz_mdp(std::move(points), lipschitz, rng);
}

Model<double> on_points(FiniteMdpBuilder<double>&& builder, Metric<double>::Points points, Norm norm, double eps) {
  Model<double> model{std::move(builder).build()};
  model.geometry.kind = Geometry<double>::Kind::points;
  model.geometry.points = std::move(points);
  model.geometry.norm = norm;
  model.geometry.eps = eps;
  return model;
}

/// Integer rewards, (almost) deterministic transitions, every state in every ball.
Model<double> draw_cycling(const FamilyOptions& o, Stream& rng) {
  const State n = draw(o.states, {2, 4}, rng);
  const Action actions = draw(o.actions, {2, 3}, rng);
  const double gamma = draw(o.discount, {0.6, 0.95}, rng);
  const double slip = rng.chance(0.5) ? 0 : rng.uniform(0, 0.1);
  const int largest_reward = rng.integer(2, 5);
  FiniteMdpBuilder<double> builder(n, actions, gamma);
  for (State s = 0; s < n; ++s) {
    for (Action a = 0; a < actions; ++a) {
      builder.reward(s, a, rng.integer(0, largest_reward));
      const State target = rng.below(n), other = rng.below(n);
      const double p = other == target ? 0 : slip;
      builder.transition(s, a, target, 1 - p).transition(s, a, other, p);
    }
  }
  const int dimension = o.dimension.value_or(1);
  const Norm norm = draw_norm(o, rng);
  auto points = random_points(PointLayout::line, n, dimension, n - 1, rng);
  return on_points(std::move(builder), std::move(points), norm, n - 1);
}

/// Two or three states in one ball, the others far out; each action keeps a near state near or sends it far out for
/// good; a state costs its distance from state 0. Near states call for different actions, and confusing them costs what
/// l_r and eps know nothing of: only R_max does.
Model<double> draw_costs(const FamilyOptions& o, Stream& rng) {
  const State n = draw(o.states, {3, 6}, rng);
  const Action actions = draw(o.actions, {2, 3}, rng);
  const double gamma = draw(o.discount, {0.2, 0.8}, rng);
  const State near = std::max(1, std::min(n - 1, rng.integer(2, 3)));
  const int dimension = o.dimension.value_or(rng.integer(1, 2));
  const Norm norm = draw_norm(o, rng);
  Metric<double>::Points points = Metric<double>::Points::Zero(n, dimension);
  for (State s = 0; s < n; ++s) points(s, 0) = s < near ? s : points(s - 1, 0) + rng.integer(4, 40);
  if (dimension > 1) {
    for (State s = near; s < n; ++s) points(s, 1) = rng.integer(0, 10);
  }
  const auto metric = Metric<double>::from_points(points, norm);
  FiniteMdpBuilder<double> builder(n, actions, gamma);
  for (State s = 0; s < n; ++s) {
    for (Action a = 0; a < actions; ++a) {
      builder.reward(s, a, -metric.distance(0, s));
      const bool stays = rng.chance(0.5);
      const State home = rng.below(near), away = near + rng.below(n - near);
      builder.transition(s, a, s >= near ? s : stays ? home : away, 1);
    }
  }
  return on_points(std::move(builder), std::move(points), norm, rng.integer(1, near));
}

/// Gives an integer model the eps and constants that were asked for.
Model<double> impose(Model<double> model, const FamilyOptions& o) {
  const auto constants = [&] {
    return model_constants(model.mdp, Metric<double>::from_points(model.geometry.points, model.geometry.norm));
  };
  if (o.eps && *o.eps > 0) model = scale_space(model, *o.eps / *model.geometry.eps);
  if (o.l_p) {
    const double l_p = constants().l_p.value;
    if (*o.l_p < l_p && (o.eps || *o.l_p == 0)) {
      model = contract_kernel(model, *o.l_p / l_p);
    } else {
      model = scale_space(model, l_p / *o.l_p);
    }
  }
  if (o.eps) model.geometry.eps = *o.eps;
  if (o.l_r) model = scale_rewards(model, *o.l_r / constants().l_r.value);
  return model;
}

/// Draws until neither rewards nor kernel are constant: only then can the constants be imposed.
template <class Draw>
Model<double> draw_and_impose(Draw draw_one, const FamilyOptions& o, Stream& rng) {
  for (;;) {
    Model<double> model = draw_one(o, rng);
    const auto c = model_constants(model.mdp, Metric<double>::from_points(model.geometry.points, model.geometry.norm));
    if (c.l_r.value > 0 && c.l_p.value > 0) return impose(std::move(model), o);
  }
}

Family choose_family(Stream& rng) {
  const double u = rng.uniform();
  if (u < 0.60) return Family::informative;
  if (u < 0.72) return Family::broad;
  if (u < 0.80) return Family::sparse;
  return u < 0.93 ? Family::cycling : Family::costs;
}

template <class T>
void check_range(const std::optional<Range<T>>& range, const char* name, T low, T high) {
  if (range && !(low <= range->low && range->low <= range->high && range->high <= high)) {
    throw InputError(
        fmt::format("{}: {} to {}, expected a range within {} to {}", name, range->low, range->high, low, high));
  }
}

void check_constant(const std::optional<double>& value, const char* name) {
  if (value && !(*value >= 0 && std::isfinite(*value))) {
    throw InputError(fmt::format("{}: {}, expected a finite number >= 0", name, *value));
  }
}

void check(const FamilyOptions& o) {
  check_range<State>(o.states, "states", 2, 2000);
  check_range<Action>(o.actions, "actions", 1, 1000);
  check_range<double>(o.discount, "discount", 0, std::nextafter(1.0, 0.0));
  if (o.dimension && (*o.dimension < 1 || *o.dimension > 16)) {
    throw InputError(fmt::format("dimension: {}, expected 1 to 16", *o.dimension));
  }
  if (o.successors && *o.successors != 0 && *o.successors < 2) {
    throw InputError(fmt::format("successors: {}, expected 0 (dense) or at least 2", *o.successors));
  }
  check_constant(o.eps, "eps");
  check_constant(o.l_r, "l_r");
  check_constant(o.l_p, "l_p");
}

}  // namespace

FamilyMember draw_family_member(Family family, const FamilyOptions& options, Stream& rng) {
  check(options);
  if (family == Family::mixed) family = choose_family(rng);
  const auto draw_model = [&] {
    switch (family) {
      case Family::informative:
        return draw_informative(options, rng);
      case Family::cycling:
        return draw_and_impose(draw_cycling, options, rng);
      case Family::costs:
        return draw_and_impose(draw_costs, options, rng);
      default:
        return draw_broad(options, family == Family::sparse, rng);
    }
  };
  FamilyMember member{family, draw_model()};
  member.model.name = fmt::format("random model, family {}", family_name(family));
  return member;
}

std::span<const Family> all_families() {
  static constexpr auto families = [] {
    std::array<Family, names.size()> list{};
    for (std::size_t i = 0; i < names.size(); ++i) list[i] = names[i].first;
    return list;
  }();
  return families;
}

std::string_view family_name(Family family) {
  const auto* entry = std::find_if(names.begin(), names.end(), [&](const auto& e) { return e.first == family; });
  return entry->second;
}

Family family_named(std::string_view name) {
  std::vector<std::string_view> known;
  for (const auto& [family, its_name] : names) {
    if (its_name == name) return family;
    known.push_back(its_name);
  }
  throw InputError(fmt::format("family: '{}' is unknown, expected one of {}", name, fmt::join(known, ", ")));
}

}  // namespace maximin
