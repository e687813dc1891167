#pragma once

#include "options.hpp"

namespace maximin::verify_bound {

/// A campaign on random models: runs or resumes it, writes what was asked for, prints the verdict. Returns the exit
/// code.
int run_campaign_command(const Options& options);

/// One trial of a campaign, in full. Returns the exit code.
int run_replay_command(const Options& options);

}  // namespace maximin::verify_bound
