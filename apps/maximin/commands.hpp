#pragma once

#include <CLI/CLI.hpp>
#include <functional>

/// The subcommands of `maximin`: each declares its options on a subcommand of the app and, once that was chosen and
/// parsed, puts what is to be done into `task`. A task returns the exit code.
namespace maximin::apps {

using Task = std::function<int()>;

void add_solve(CLI::App& app, Task& task);
void add_attack(CLI::App& app, Task& task);
void add_belief(CLI::App& app, Task& task);
void add_simulate(CLI::App& app, Task& task);
void add_learn(CLI::App& app, Task& task);
void add_convert(CLI::App& app, Task& task);
void add_info(CLI::App& app, Task& task);
void add_examples(CLI::App& app, Task& task);
void add_counterexample(CLI::App& app, Task& task);

}  // namespace maximin::apps
