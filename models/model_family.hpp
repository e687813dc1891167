#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include <maximin/models/model.hpp>
#include <maximin/theory/metric.hpp>
#include <maximin/theory/random.hpp>
#include <maximin/theory/types.hpp>

namespace maximin {

/// Kinds of random models to run a campaign on, each made to bring about one thing.
enum class Family {
  informative,  ///< Theorem 1 says something: its bound as printed lies below gamma span(R)/(1-gamma), yet attacks
                ///< matter
  broad,        ///< anything: all sizes, norms, signs and constants, gamma up to 0.95; most bounds are vacuous
  sparse,       ///< broad, with two to four successors a row
  cycling,      ///< tiny integer models in which everything is confused: the policy pair often cycles
  costs,        ///< rewards <= 0 with max R = 0: Theorem 1 fails if R_max is read one-sidedly, as printed
  mixed,        ///< one of the above: the default campaign
};

/// Closed interval.
template <class T>
struct Range {
  T low, high;
};

/// What to change about a family. Absent means as the family has it.
struct FamilyOptions {
  std::optional<Range<State>> states = {};     ///< at least 2
  std::optional<Range<Action>> actions = {};   ///< at least 1
  std::optional<Range<double>> discount = {};  ///< within [0, 1)
  std::optional<Norm> norm = {};
  std::optional<int> dimension = {};  ///< of the points
  std::optional<State> successors =
      {};  ///< per row, 0 = dense; `cycling` and `costs` have one or two whatever this says
  /// Radius of the balls, >= 0. `broad` and `sparse` lie in the unit box, where eps is absolute; the other families
  /// are scaled to it, so that their balls stay what they are.
  std::optional<double> eps = {};
  std::optional<double> l_r = {};  ///< met exactly, as by random_lipschitz_mdp
  /// Met exactly. What is beyond reach on the drawn points is met by moving the points closer together. Without eps,
  /// `informative`, `cycling` and `costs` take it as the unit of distance and stay what they are.
  std::optional<double> l_p = {};
};

/// A model and the family that it came from (never `mixed`). The model has points, a norm and eps.
struct FamilyMember {
  Family family;
  Model<double> model;
};

/// Draws a model. A function of the arguments alone, on every machine; safe to call from several threads.
/// Throws InputError on options out of range.
FamilyMember draw_family_member(Family family, const FamilyOptions& options, Stream& rng);

/// All families, in the order of the enumeration.
std::span<const Family> all_families();
/// "informative", "broad", ...
std::string_view family_name(Family family);
/// The family of that name. Throws InputError that lists the names.
Family family_named(std::string_view name);

}  // namespace maximin
