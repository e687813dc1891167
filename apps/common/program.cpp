#include <maximin/apps/common/program.hpp>

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>
#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <exception>
#include <vector>

#include <maximin/models/nearest_name.hpp>
#include <maximin/theory/error.hpp>

namespace maximin::apps {

namespace {

/// Opens what the caller closed, in the wrong direction: a file opened later must not become standard output, and
/// writing to a closed one must still fail.
void reserve_standard_streams() {
  const std::array<int, 3> direction{O_WRONLY, O_RDONLY, O_RDONLY};
  for (int fd = 0; fd < 3; ++fd) {
    if (fcntl(fd, F_GETFD) != -1 || errno != EBADF) continue;
    if (open("/dev/null", direction[static_cast<std::size_t>(fd)]) != fd) return;
  }
}

std::vector<std::string>& remarks() {
  static std::vector<std::string> held_back;
  return held_back;
}

void say_remarks() {
  for (const std::string& text : std::exchange(remarks(), {})) note(text);
}

void flush_standard_output() {
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return;
  throw OutputError(fmt::format("standard output: {}, expected it to be writable", std::strerror(errno)));
}

/// The subcommand that the command line got to, or the app itself.
const CLI::App& selected(const CLI::App& app) {
  const CLI::App* at = &app;
  while (!at->get_subcommands().empty()) at = at->get_subcommands().back();
  return *at;
}

std::string full_name(const CLI::App& app) {
  std::string name = app.get_name();
  for (const CLI::App* at = &app; !at->get_subcommands().empty();) {
    at = at->get_subcommands().back();
    name += " " + at->get_name();
  }
  return name;
}

std::vector<std::string> option_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  return names;
}

std::vector<std::string> subcommand_names(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* sub : app.get_subcommands([](const CLI::App*) { return true; }))
    names.push_back(sub->get_name());
  return names;
}

std::string describe_unexpected(const CLI::App& app) {
  const CLI::App& at = selected(app);
  const std::vector<std::string> rest = app.remaining(true);
  const std::string first = rest.empty() ? std::string() : rest.front();
  const bool is_option = first.size() > 1 && first[0] == '-';
  const auto subcommands = subcommand_names(at);
  const bool is_command = !is_option && !subcommands.empty();
  std::string text = fmt::format("{}: {}", first,
                                 is_option    ? "no such option"
                                 : is_command ? "no such command"
                                              : "unexpected argument");
  const std::string near = nearest_name(first.substr(0, first.find('=')), is_option ? option_names(at) : subcommands);
  if (!near.empty()) text += fmt::format(", did you mean {}?", near);
  if (near.empty() && is_command) text += fmt::format(", expected one of {}", fmt::join(subcommands, ", "));
  return text;
}

std::string describe(const CLI::App& app, const CLI::ParseError& error) {
  // An unknown first word leaves "a subcommand is required" unsaid: what is wrong is the word.
  if (dynamic_cast<const CLI::ExtrasError*>(&error) != nullptr || !app.remaining(true).empty())
    return describe_unexpected(app);
  const auto commands = subcommand_names(selected(app));
  if (error.get_name() == "RequiredError" && !commands.empty())
    return fmt::format("no command given, expected one of {}", fmt::join(commands, ", "));
  std::string what = error.what();
  if (error.get_name() != "ArgumentMismatch") return what;
  if (what.find("missing") != std::string::npos) return what.substr(0, what.find(':')) + ": a value is missing";
  if (what.find("At Most 1 required") != std::string::npos)
    return what.substr(0, what.find(':')) + ": given more than once, expected once";
  if (what.find("flag override") != std::string::npos)
    return "--" + what.substr(0, what.find(' ')) + ": takes no value";
  return what;
}

/// An empty word is a slip, e.g. of an unset variable of a shell, and never a value.
void refuse_empty_values(const CLI::App& app) {
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& value : option->results()) {
      if (value.empty()) throw CLI::ValidationError(option->get_name(), "empty, expected a value");
    }
  }
}

int parse_and_run(CLI::App& app, int argc, const char* const* argv, const std::function<int()>& action) {
  try {
    app.parse(argc, argv);
    refuse_empty_values(selected(app));
  } catch (const CLI::Success& asked) {
    print(asked.get_name() == "CallForVersion" ? std::string(asked.what()) + "\n" : app.help());
    flush_standard_output();
    return ExitCode::success;
  } catch (const CLI::ParseError& error) {
    const std::string name = full_name(app);
    complain(name, fmt::format("{} (see {} --help)", describe(app, error), name));
    return ExitCode::bad_input;
  }
  const int code = action();
  say_remarks();
  flush_standard_output();
  return code;
}

}  // namespace

int run_program(CLI::App& app, int argc, const char* const* argv, const std::function<int()>& action) {
  reserve_standard_streams();
  try {
    return parse_and_run(app, argc, argv, action);
  } catch (const InputError& error) {
    complain(full_name(app), error.what());
    return ExitCode::bad_input;
  } catch (const BudgetExhausted& error) {
    say_remarks();
    complain(full_name(app), error.what());
    return ExitCode::undetermined;
  } catch (const AssumptionFails& error) {
    say_remarks();
    complain(full_name(app), error.what());
    return ExitCode::assumption_fails;
  } catch (const OutputError& error) {
    complain(full_name(app), error.what());
    return ExitCode::output_error;
  } catch (const std::bad_alloc&) {
    complain(full_name(app), "out of memory, expected a smaller model or a machine with more");
    return ExitCode::undetermined;
  } catch (const std::exception& error) {
    complain(full_name(app), fmt::format("internal error: {}", error.what()));
    return ExitCode::internal_error;
  }
}

void print(std::string_view text) {
  say_remarks();
  if (std::fwrite(text.data(), 1, text.size(), stdout) == text.size()) return;
  throw OutputError(fmt::format("standard output: {}, expected it to be writable", std::strerror(errno)));
}

void complain(std::string_view program, std::string_view text) {
  const std::string line = fmt::format("{}: {}\n", program, printable(text));
  std::fflush(stdout);
  std::fputs(line.c_str(), stderr);
}

void note(std::string_view text) {
  complain("note", text);
}

void remark(std::string text) {
  remarks().push_back(std::move(text));
}

std::string printable(std::string_view text) {
  std::string result;
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (code == '\n' || code == '\r' || code == '\t') {
      result += ' ';
    } else {
      result += code < 0x20 || code == 0x7f ? '?' : c;
    }
  }
  while (!result.empty() && result.back() == ' ') result.pop_back();
  return result;
}

}  // namespace maximin::apps
