#pragma once

#include <CLI/CLI.hpp>
#include <functional>
#include <stdexcept>
#include <string>
#include <string_view>

/// What every program of the project has in common, so that they share their habits: results on standard output alone,
/// messages on standard error, one line per error, and these exit codes.
namespace maximin::apps {

/// How a program ends.
struct ExitCode {
  static constexpr int success = 0;            ///< done; of a check: it holds
  static constexpr int violated = 1;           ///< a claim is violated
  static constexpr int bad_input = 2;          ///< bad usage or bad input
  static constexpr int undetermined = 3;       ///< a budget ran out
  static constexpr int assumption_fails = 4;   ///< an assumption of the claim fails on this model
  static constexpr int internal_error = 70;    ///< a fault of the program
  static constexpr int output_error = 74;      ///< standard output could not be written
  static constexpr int interrupted = 128 + 2;  ///< ended by SIGINT, with what was done so far
};

/// Standard output is closed, full or broken.
class OutputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Parses the command line, then runs `action` and returns its result, turned into an exit code:
///
///     --help, --version        printed on standard output; 0
///     bad usage                one line on standard error with the nearest option that exists; 2
///     InputError               one line on standard error; 2
///     BudgetExhausted          one line; 3
///     AssumptionFails          one line; 4
///     OutputError              one line; 74
///     any other exception      one line; 70
///
/// Every line starts with the app's name. Nothing throws out of here.
int run_program(CLI::App& app, int argc, const char* const* argv, const std::function<int()>& action);

/// Writes to standard output, after the remarks held back. Throws OutputError when it cannot be written.
void print(std::string_view text);

/// Writes one line "PROGRAM: TEXT" to standard error, with line breaks and control characters in the text made visible.
void complain(std::string_view program, std::string_view text);

/// Writes one line "note: TEXT" to standard error: something that the user should know and need not act on.
void note(std::string_view text);

/// A note held back until the first result is printed, or the program ends otherwise; dropped when the input is refused
/// after all, so that the one line about what is wrong stands alone.
void remark(std::string text);

/// The text with line breaks as spaces and other control characters as '?': what a file says must not drive a terminal.
std::string printable(std::string_view text);

}  // namespace maximin::apps
