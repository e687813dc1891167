#pragma once

#include <filesystem>

#include <maximin/models/files/read_options.hpp>
#include <maximin/models/model.hpp>

namespace maximin {

/// Reads a model file of any known format, told by its extension, else by its content:
///
///     .json                 own JSON, or a gymnasium toy-text table
///     .pomdp .mdp           Cassandra's format
///     .tra                  PRISM explicit, with the .srew, .trew, .lab and .sta files beside it
///     .drn .drn.gz          Storm's DRN
///     .csv                  idstatefrom,idaction,idstateto,probability,reward
///     .umb                  Unified Markov binary
///
/// What had to be assumed is in the model's notes. Throws InputError, one line, on anything that is not a valid model.
template <class Scalar>
Model<Scalar> load_model(const std::filesystem::path& path, const ReadOptions& options = {});

}  // namespace maximin
