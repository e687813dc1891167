#include <maximin/counterexamples/gallery.hpp>

#include <algorithm>
#include <array>

#include <fmt/format.h>

#include <maximin/theory/error.hpp>

namespace maximin {

std::span<const Counterexample> counterexamples() {
  static const std::array<Counterexample, 8> gallery{
      contraction(),   settling(),       one_sided_rewards(), stationary_optimum(),
      myopic_attack(), sharper_belief(), bp_dqn_target(),     maximin_deadlock(),
  };
  return gallery;
}

const Counterexample& find_counterexample(std::string_view name) {
  const auto all = counterexamples();
  const auto entry = std::find_if(all.begin(), all.end(), [&](const Counterexample& c) { return c.name == name; });
  if (entry != all.end()) return *entry;
  std::string names;
  for (const Counterexample& c : all) names += fmt::format("{}{}", names.empty() ? "" : ", ", c.name);
  throw InputError(fmt::format("counterexample: '{}' is unknown, expected one of {}", name, names));
}

}  // namespace maximin
