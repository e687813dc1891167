#pragma once

#include <span>
#include <string_view>

#include <maximin/counterexamples/counterexample.hpp>

namespace maximin {

/// The counterexamples, in the order in which a lecture would show them.
std::span<const Counterexample> counterexamples();

/// The one of that name. Throws InputError that lists the names.
const Counterexample& find_counterexample(std::string_view name);

// Each in a file of its name.
Counterexample contraction();
Counterexample settling();
Counterexample one_sided_rewards();
Counterexample stationary_optimum();
Counterexample myopic_attack();
Counterexample sharper_belief();
Counterexample bp_dqn_target();
Counterexample maximin_deadlock();

}  // namespace maximin
