#pragma once

#include <CLI/CLI.hpp>
#include <optional>
#include <string>

#include <maximin/models/make_perturbation.hpp>
#include <maximin/models/model.hpp>
#include <maximin/theory/perturbation.hpp>
#include <maximin/theory/rational.hpp>

namespace maximin::apps {

/// The model that a command line asks for: a file or a built-in example, and what the command line says over them.
struct ModelOptions {
  std::string file;          ///< empty: none
  std::string example;       ///< name of a built-in example; empty: none
  std::string discount;      ///< a number, e.g. 1/3, instead of the model's; empty: the model's own
  std::string reward_model;  ///< which one to read, if the file has several
  std::string intervals;     ///< "refuse", "nominal" or empty: refuse
  std::string metric;        ///< "points", "hops", "discrete" or empty: the model's own
  std::string norm;          ///< "l1", "l2", "linf" or empty: the model's own
  std::string eps;           ///< radius of the balls, a number, instead of the model's; empty: the model's own

  /// Whether a model was asked for at all.
  bool given() const { return !file.empty() || !example.empty(); }
};

/// Adds MODEL (or --model), --example, --discount, --reward-model, --intervals, --metric, --norm and --eps to the app,
/// with checks of their values. `options` must outlive the parsing.
void declare(CLI::App& app, ModelOptions& options);

/// Reads the model: file or example, with the discount asked for, and prints what the reader assumed as notes on
/// standard error. Throws InputError when neither or both are given, and as `load_model`.
Model<double> load(const ModelOptions& options);

/// The same in exact arithmetic: the numbers of a file as they stand there; those of an example, and those of the
/// command line, as they are written. Prints a note also where the metric is a default that nobody asked for.
Model<Rational> load_exactly(const ModelOptions& options);

/// What to call a model: its own name, if it is not empty, else that of the example or the file.
std::string title(const std::string& name, const ModelOptions& options);

/// What the command line says of the geometry.
GeometryOverrides<double> geometry_overrides(const ModelOptions& options);

/// The same in exact arithmetic, its numbers as they are written.
GeometryOverrides<Rational> exact_overrides(const ModelOptions& options);

/// The balls of the model, with the overrides of the command line. Prints a note on standard error where the metric is
/// a default that nobody asked for. Throws InputError as `maximin::make_perturbation`.
Perturbation<double> make_perturbation(const Model<double>& model, const ModelOptions& options);

/// The norm of that name: l1, l2 or linf.
Norm norm_named(const std::string& name);

/// The model with another discount. Throws InputError outside [0, 1).
template <class Scalar>
FiniteMdp<Scalar> with_discount(const FiniteMdp<Scalar>& mdp, const Scalar& discount);

}  // namespace maximin::apps
