#pragma once

#include <cstdint>
#include <string>

#include <CLI/CLI.hpp>

#include <maximin/proofs_check/claims.hpp>
#include <maximin/theory/types.hpp>

/// Options that more than one command of verify_bound has: declared in the same words, and read in one place.
namespace maximin::verify_bound {

/// Each declares one option on the app or a command; its value must outlive the parsing.
CLI::Option* add_reading(CLI::App& app, std::string& value);
CLI::Option* add_tie(CLI::App& app, std::string& value);
CLI::Option* add_family(CLI::App& app, std::string& value, const std::string& description);
CLI::Option* add_seed(CLI::App& app, std::uint64_t& value, const std::string& description);
CLI::Option* add_threads(CLI::App& app, int& value, const std::string& description);

/// "paper" or "corrected".
Reading reading_named(const std::string& word);

/// "lowest" or "highest".
TieBreak tie_named(const std::string& word);

/// The number asked for; one per core where that is 0.
int threads_for(int asked);

}  // namespace maximin::verify_bound
