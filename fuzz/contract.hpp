#pragma once

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <sstream>
#include <string>
#include <string_view>

#include <maximin/models/files/maximin_json.hpp>
#include <maximin/models/files/read_options.hpp>
#include <maximin/theory/error.hpp>

/// What every reader promises for every input, and the fuzzers hold it to.
namespace maximin::fuzzing {

/// Limits low enough that no input within them takes long.
inline ReadOptions small_limits() {
  ReadOptions options;
  options.limits.bytes = std::size_t{1} << 20;
  options.limits.pairs = 2'000;
  options.limits.transitions = 20'000;
  options.limits.expansions = 100'000;
  return options;
}

[[noreturn]] inline void broken(const char* promise, const std::string& detail) {
  std::fprintf(stderr, "promise broken: %s\n%s\n", promise, detail.c_str());
  std::abort();
}

inline std::string written(const Model<double>& model) {
  std::ostringstream out;
  write_maximin_json(model, out);
  return out.str();
}

/// Either the reader throws InputError with a message of one line, or it gives a model that comes back unchanged from
/// own JSON. Anything else (another exception, a crash, a hang, a leak) is a finding.
template <class Read>
void check_reader(Read read) {
  std::string first;
  try {
    first = written(read());
  } catch (const InputError& error) {
    const std::string_view message = error.what();
    if (message.empty() || message.find('\n') != message.npos) broken("messages are one line", error.what());
    return;
  }
  std::string second;
  try {
    second = written(read_maximin_json<double>(first, "model.json", small_limits()));
  } catch (const InputError& error) {
    broken("what was read can be written and read again", error.what() + ("\n" + first));
  }
  if (first != second) broken("own JSON keeps a model", first + "\n" + second);
}

}  // namespace maximin::fuzzing
