#pragma once

#include <string_view>

#include <maximin/models/files/read_options.hpp>
#include <maximin/models/model.hpp>

namespace maximin {

/// Reads the Unified Markov Binary format, version 1: a tar archive, perhaps in gzip, of an index and arrays. MDPs,
/// DTMCs and the MDP part of POMDPs in discrete time with one player; probabilities double or double-interval; rewards
/// on states, choices and branches, `options.reward_model` picking one by alias or identifier. States with fewer
/// choices, and action names, are treated as for DRN (`read_drn`). The format has no discount. Throws InputError, which
/// names the entry of the archive, and the path in its index.
template <class Scalar>
Model<Scalar> read_umb(std::string_view bytes, std::string_view file_name, const ReadOptions& options = {});

}  // namespace maximin
