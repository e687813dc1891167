#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include <maximin/apps/maximin/commands.hpp>
#include <maximin/counterexamples/counterexample.hpp>

/// The commands of `maximin counterexample`, a file for each kind, and what they say in the same words.
namespace maximin::apps {

void add_counterexample_list(CLI::App& app, Task& task);
void add_counterexample_show(CLI::App& app, Task& task);
void add_counterexample_run(CLI::App& app, Task& task);
void add_counterexample_draw(CLI::App& app, Task& task);
void add_counterexample_search(CLI::App& app, Task& task);

/// Declares the positional NAME.
CLI::Option* declare_name(CLI::App& app, std::string& name);

/// The model as a table: what each action pays in each state and where it leads, and the balls. Numbers are exact.
std::string exact_model_text(const Model<Rational>& model);

/// The project's own JSON.
std::string own_json(const Model<Rational>& model);

/// Both numbers, whether the claim is refuted, and the evidence.
std::string finding_text(const Counterexample& counterexample, const Counterexample::Finding& finding);

}  // namespace maximin::apps
