#pragma once

#include <CLI/CLI.hpp>
#include <functional>

/// The subcommands of `maximin_deep`: each declares its options on a subcommand of the app and, once that was chosen
/// and parsed, puts what is to be done into `task`. A task returns the exit code.
namespace maximin::apps {

using Task = std::function<int()>;

void add_train(CLI::App& app, Task& task);
void add_evaluate(CLI::App& app, Task& task);
void add_table(CLI::App& app, Task& task);
void add_watch(CLI::App& app, Task& task);

}  // namespace maximin::apps
