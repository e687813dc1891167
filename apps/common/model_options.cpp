#include <maximin/apps/common/model_options.hpp>

#include <fmt/format.h>
#include <algorithm>
#include <filesystem>

#include <maximin/apps/common/option_checks.hpp>
#include <maximin/apps/common/program.hpp>
#include <maximin/models/builtin_models.hpp>
#include <maximin/models/files/model_file.hpp>
#include <maximin/models/nearest_name.hpp>
#include <maximin/models/rationalise.hpp>

namespace maximin::apps {

namespace {

using Kind = Geometry<double>::Kind;

const char* const model_group = "Model";
const char* const geometry_group = "Geometry (what the attacker may show)";

CLI::Option* add_words(CLI::App& app, const std::string& name, std::string& value,
                       const std::vector<std::string>& words, const std::string& description) {
  return app.add_option(name, value, description)->check(one_of(words))->type_name("WORD");
}

void declare_reading(CLI::App& app, ModelOptions& options) {
  app.add_option("--discount", options.discount, "gamma, instead of the model's")
      ->check(number_or_fraction({.low = 0, .high = 1, .below = true}))
      ->type_name("GAMMA")
      ->group(model_group);
  app.add_option("--reward-model", options.reward_model, "which reward model to read, if the file has several")
      ->type_name("NAME")
      ->group(model_group);
  add_words(app, "--intervals", options.intervals, {"refuse", "nominal"},
            "interval probabilities: refuse them (the default), or\ntake nominal ones from inside")
      ->group(model_group);
}

void declare_geometry(CLI::App& app, ModelOptions& options) {
  add_words(app, "--metric", options.metric, {"points", "hops", "discrete"},
            "how far apart states are: points (the model's own), hops\nin the transition graph, or discrete (always 1)")
      ->group(geometry_group);
  add_words(app, "--norm", options.norm, {"l1", "l2", "linf"}, "norm of the points: l1, l2 or linf")
      ->group(geometry_group);
  app.add_option("--eps", options.eps, "radius of the balls, in units of the metric, e.g. 0.1 or 1/3")
      ->check(number_or_fraction({.low = 0}))
      ->type_name("EPS")
      ->group(geometry_group);
}

/// The words on lines of the help, after a first line that has begun already.
std::string wrapped(const std::vector<std::string>& words) {
  std::string text;
  std::size_t column = 30;
  for (const std::string& word : words) {
    if (!text.empty()) text += ',';
    const bool fits = column + word.size() + 1 <= 60;
    if (!text.empty()) text += fits ? ' ' : '\n';
    column = fits ? column + word.size() + 2 : word.size() + 2;
    text += word;
  }
  return text;
}

template <class Scalar>
Model<Scalar> load_file(const ModelOptions& options) {
  ReadOptions reading;
  if (!options.discount.empty()) reading.discount = nearest_number(options.discount);
  reading.reward_model = options.reward_model;
  if (options.intervals == "nominal") reading.intervals = IntervalRows::nominal;
  return load_model<Scalar>(options.file, reading);
}

Model<double> load_example(const ModelOptions& options) {
  if (!options.reward_model.empty())
    throw InputError("--reward-model: " + options.reward_model +
                     ", but a built-in example has one alone, expected none");
  const auto names = builtin_model_names();
  if (std::find(names.begin(), names.end(), options.example) == names.end()) {
    const std::string near = nearest_name(options.example, names);
    throw InputError(fmt::format("--example: {} is unknown, expected one of {}{}", options.example,
                                 fmt::join(names, ", "), near.empty() ? "" : fmt::format("; did you mean {}?", near)));
  }
  Model<double> model = builtin_model(options.example);
  if (!options.discount.empty()) model.mdp = with_discount(model.mdp, nearest_number(options.discount));
  return model;
}

}  // namespace

void declare(CLI::App& app, ModelOptions& options) {
  app.add_option("MODEL,--model", options.file,
                 "model file: own JSON, gymnasium JSON, Cassandra\n.POMDP or .MDP, PRISM .tra, Storm .drn, .csv, .umb")
      ->type_name("FILE")
      ->group(model_group);
  app.add_option("--example", options.example,
                 fmt::format("a built-in model instead: {}", wrapped(builtin_model_names())))
      ->type_name("NAME")
      ->group(model_group);
  declare_reading(app, options);
  declare_geometry(app, options);
}

namespace {

void refuse_none_and_both(const ModelOptions& options) {
  if (!options.given()) throw InputError("no model given, expected a model file or --example NAME");
  if (!options.file.empty() && !options.example.empty())
    throw InputError("--example: given beside a model file, expected one of the two");
}

template <class Scalar>
Model<Scalar> with_remarks(Model<Scalar> model) {
  for (const std::string& line : model.notes) remark(line);
  return model;
}

template <class Scalar>
void remark_on_default_metric(const Model<Scalar>& model, const ModelOptions& options) {
  if (model.geometry.kind != Geometry<Scalar>::Kind::none || !options.metric.empty()) return;
  remark(
      fmt::format("the model says nothing of distances: hops in the transition graph are taken{}; --metric and --eps "
                  "choose otherwise",
                  options.eps.empty() ? ", and eps = 1" : ""));
}

}  // namespace

Model<double> load(const ModelOptions& options) {
  refuse_none_and_both(options);
  return with_remarks(options.example.empty() ? load_file<double>(options) : load_example(options));
}

Model<Rational> load_exactly(const ModelOptions& options) {
  refuse_none_and_both(options);
  auto model =
      with_remarks(options.example.empty() ? load_file<Rational>(options) : rationalise(load_example(options)));
  if (!options.discount.empty()) model.mdp = with_discount(model.mdp, exact_number(options.discount));
  remark_on_default_metric(model, options);
  return model;
}

std::string title(const std::string& name, const ModelOptions& options) {
  if (!name.empty()) return name;
  if (!options.example.empty()) return options.example;
  return std::filesystem::path(options.file).filename().string();
}

GeometryOverrides<double> geometry_overrides(const ModelOptions& options) {
  GeometryOverrides<double> overrides;
  if (options.metric == "points") overrides.kind = Kind::points;
  if (options.metric == "hops") overrides.kind = Kind::hops;
  if (options.metric == "discrete") overrides.kind = Kind::discrete;
  if (!options.norm.empty()) overrides.norm = norm_named(options.norm);
  if (!options.eps.empty()) overrides.eps = nearest_number(options.eps);
  return overrides;
}

GeometryOverrides<Rational> exact_overrides(const ModelOptions& options) {
  const GeometryOverrides<double> asked = geometry_overrides(options);
  GeometryOverrides<Rational> overrides;
  if (asked.kind) overrides.kind = static_cast<Geometry<Rational>::Kind>(*asked.kind);
  overrides.norm = asked.norm;
  if (!options.eps.empty()) overrides.eps = exact_number(options.eps);
  return overrides;
}

Perturbation<double> make_perturbation(const Model<double>& model, const ModelOptions& options) {
  remark_on_default_metric(model, options);
  return maximin::make_perturbation(model, geometry_overrides(options));
}

Norm norm_named(const std::string& name) {
  if (name == "l1") return Norm::l1;
  if (name == "l2") return Norm::l2;
  if (name == "linf") return Norm::linf;
  throw InputError("norm: " + name + ", expected l1, l2 or linf");
}

template <class Scalar>
FiniteMdp<Scalar> with_discount(const FiniteMdp<Scalar>& mdp, const Scalar& discount) {
  FiniteMdpBuilder<Scalar> builder(mdp.states(), mdp.actions(), discount);
  for (State s = 0; s < mdp.states(); ++s) {
    for (Action a = 0; a < mdp.actions(); ++a) {
      builder.reward(s, a, mdp.reward(s, a));
      for (const auto& next : mdp.successors(s, a)) builder.transition(s, a, next.target, next.probability);
    }
  }
  return std::move(builder).build();
}

template FiniteMdp<double> with_discount(const FiniteMdp<double>&, const double&);
template FiniteMdp<Rational> with_discount(const FiniteMdp<Rational>&, const Rational&);

}  // namespace maximin::apps
