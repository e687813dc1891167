#pragma once

#include <filesystem>

#include <maximin/models/model.hpp>
#include <maximin/proofs_check/claims.hpp>

#include "options.hpp"

namespace maximin::verify_bound {

/// Writes the model to STEM.json, or where that holds another model to STEM-2.json and so on; returns the name.
std::string save_under_new_name(const std::filesystem::path& stem, const Model<double>& model);

/// Writes a model as a file of its own format.
void write_model(const std::filesystem::path& path, const Model<double>& model);

/// Shrinks a model that violates a claim while it still violates that claim, writes it to the folder of --violation-dir
/// as a file that --model replays, and tells where.
void save_violation(const Options& options, Model<double> model, long trial, ClaimId id);

}  // namespace maximin::verify_bound
