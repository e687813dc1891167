#include <maximin/deep/agent_spec.hpp>

#include <algorithm>
#include <string_view>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <maximin/deep/agent_fields.hpp>
#include <maximin/deep/aggregate.hpp>
#include <maximin/models/files/json_text.hpp>
#include <maximin/theory/error.hpp>

namespace maximin::deep {
namespace {

void require_word(const std::string& word, const std::vector<std::string>& words, const std::string& where) {
  if (std::find(words.begin(), words.end(), word) != words.end()) return;
  throw InputError(fmt::format("{}: {}, expected {}", where, excerpt(word), fmt::join(words, ", ")));
}

/// The name becomes the name of a file.
void require_file_name(const std::string& name, const std::string& where) {
  const auto allowed = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
           std::string_view("-_.:+").find(c) != std::string_view::npos;
  };
  if (!name.empty() && name.size() <= 64 && name[0] != '.' && std::all_of(name.begin(), name.end(), allowed)) return;
  throw InputError(fmt::format("{}: {}, expected at most 64 letters, digits and -_.:+", where, excerpt(name)));
}

double weights_of(const QNetworkShape& shape) {
  double sum = 0, width = static_cast<double>(shape.inputs * (1 + 2 * shape.waves));
  const auto add = [&](long outputs) {
    sum += (width + 1) * static_cast<double>(outputs);
    width = static_cast<double>(outputs);
  };
  for (const long h : shape.hidden) add(h);
  add(shape.actions);
  return sum;
}

void check(const AgentSpec& s, const std::string& where) {
  require_file_name(s.kind, where + ": kind");
  if (!s.start_from.empty()) require_word(s.start_from, agent_kinds(), where + ": start_from");
  require_word(s.loss, {"td", "sa", "wocar", "radial", "car"}, where + ": loss");
  require_word(s.belief, belief_names(), where + ": belief");
  require_word(s.train_attack, {"none", "random", "pgd", "pgd-released", "min-best", "mixed"},
               where + ": train_attack");
  const auto within = [&](const char* name, double value, double low, double high) {
    if (value >= low && value <= high) return;
    throw InputError(fmt::format("{}: {}: {}, expected {} to {}", where, name, value, low, high));
  };
  within("eps", s.eps, 0, 5);
  within("belief_trajectories", static_cast<double>(s.belief_trajectories), 0, 1e9);
  within("belief_states", static_cast<double>(s.belief_states), 1, 4096);
  within("training_belief_states", static_cast<double>(s.training_belief_states), 1, 4096);
  within("discount", s.discount, 0, 1);
  within("random_actions", s.random_actions, 0, 1);
  within("inputs", static_cast<double>(s.network.inputs), 2, 2);
  within("actions", static_cast<double>(s.network.actions), 8, 8);
  within("waves", static_cast<double>(s.network.waves), 0, 16);
  within("input_centre", s.network.input_centre, -1e6, 1e6);
  within("input_scale", s.network.input_scale, -1e6, 1e6);
  within("layers", static_cast<double>(s.network.hidden.size()), 0, 16);
  within("weights", weights_of(s.network), 1, 1e7);
  try {
    aggregator_named(s.aggregator);
    s.training.check();
    if (s.loss == "sa") options_of_loss(s, s.sa).check();
    if (s.loss == "radial") options_of_loss(s, s.radial).check();
    if (s.loss == "car") options_of_loss(s, s.car).check();
    if (s.loss == "wocar") options_of_loss(s, s.wocar).check();
    if (s.has_particle_filter()) {
      shape_of_filter(s).check();
      training_of_filter(s).check(shape_of_filter(s));
      s.particle_filter_belief.check();
    }
  } catch (const InputError& e) {
    throw InputError(fmt::format("{}: {}", where, e.what()));
  }
}

}  // namespace

const std::vector<std::string>& belief_names() {
  static const std::vector<std::string> names{"observed",  "ball",       "exact",        "pf-lstm",    "pf-gru",
                                              "ball-mean", "exact-mean", "pf-lstm-mean", "pf-gru-mean"};
  return names;
}

std::string AgentSpec::name() const {
  if (!knows_eps()) return fmt::format("{}-seed{}", kind, training.seed);
  return fmt::format("{}-eps{}-seed{}", kind, eps, training.seed);
}

PfRnnOptions shape_of_filter(const AgentSpec& spec) {
  PfRnnOptions o = spec.particle_filter;
  o.cell = spec.belief.starts_with("pf-gru") ? PfCell::gru : PfCell::lstm;
  o.eps = spec.eps;
  return o;
}

PfTrainingOptions training_of_filter(const AgentSpec& spec) {
  PfTrainingOptions o = spec.particle_filter_training;
  o.seed = spec.training.seed;
  o.trajectories = spec.belief_trajectories;
  return o;
}

nlohmann::ordered_json to_json(const AgentSpec& spec) {
  AgentSpec copy = spec;
  return FieldWriter::json_of(copy);
}

void merge_json(AgentSpec& spec, const nlohmann::ordered_json& json, const std::string& where) {
  FieldReader::read(spec, json, where);
  check(spec, where);
}

}  // namespace maximin::deep
