#pragma once

#include <CLI/CLI.hpp>
#include <span>
#include <string>

#include <maximin/apps/common/json_output.hpp>
#include <maximin/apps/common/model_options.hpp>
#include <maximin/models/model.hpp>
#include <maximin/theory/perturbation.hpp>
#include <maximin/theory/types.hpp>

/// What several subcommands say in the same words.
namespace maximin::apps {

/// --json and --all.
struct OutputOptions {
  bool json = false;
  bool all = false;  ///< every row of a table, however many

  /// Rows of a table to show to a person.
  std::size_t rows() const { return all ? static_cast<std::size_t>(-1) : 40; }
};

void declare(CLI::App& app, OutputOptions& options);

/// A model and what perturbs it.
struct Problem {
  Model<double> model;
  std::string title;              ///< what to call it
  Geometry<double>::Kind metric;  ///< what the balls were made from
  Perturbation<double> perturbation;
};

/// "name: 16 states, 4 actions, 152 transitions, gamma 0.95", one line.
std::string model_line(const Model<double>& model, const std::string& title);
std::string model_line(const Problem& problem);
/// The same for programs.
Json model_json(const Model<double>& model);

/// Loads both. Throws InputError as `load` and `make_perturbation`.
Problem load_problem(const ModelOptions& options);

/// "Balls: points in R^2 under l2, eps 0.1, 2 to 5 states each", one line.
std::string balls_line(const Problem& problem);
/// The same for programs.
Json balls_json(const Problem& problem);

/// The mean of v over the start distribution of the model, uniform where it has none.
double start_mean(const Model<double>& model, const Values<double>& v);

/// "{a, b, c}", with at most `most` names and the rest counted.
std::string set_text(const Model<double>& model, std::span<const State> states, std::size_t most = 12);

/// The names of the actions, by state.
Json action_names(const Model<double>& model, const Policy& policy);

/// The state of that name or index. Throws InputError naming `option` when there is none, or when the text is the name
/// of one state and the index of another.
State find_state(const Model<double>& model, const std::string& text, const std::string& option);
/// The action of that name or index. Throws InputError as `find_state`.
Action find_action(const Model<double>& model, const std::string& text, const std::string& option);

}  // namespace maximin::apps
