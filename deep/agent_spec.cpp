#include <maximin/deep/agent_spec.hpp>

#include <algorithm>
#include <utility>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <maximin/deep/aggregate.hpp>
#include <maximin/models/nearest_name.hpp>
#include <maximin/theory/error.hpp>

namespace maximin::deep {
namespace {

// One list of fields, visited to write and to read. An enumeration is a word.
template <class Visitor>
void visit_fields(ReplayOptions& o, Visitor& visit) {
  visit("capacity", o.capacity);
  visit("prioritised", o.prioritised);
  visit("alpha", o.alpha);
  visit("beta_start", o.beta_start);
}

template <class Visitor>
void visit_fields(QNetworkShape& o, Visitor& visit) {
  visit("inputs", o.inputs);
  visit("hidden", o.hidden);
  visit("actions", o.actions);
  visit("input_centre", o.input_centre);
  visit("input_scale", o.input_scale);
  visit("waves", o.waves);
}

template <class Visitor>
void visit_fields(TrainOptions& o, Visitor& visit) {
  visit("seed", o.seed);
  visit("frames", o.frames);
  visit("lanes", o.lanes);
  visit("horizon", o.horizon);
  visit("truncation_is_terminal", o.truncation_is_terminal);
  visit("frames_per_update", o.frames_per_update);
  visit("batch", o.batch);
  visit("learning_rate", o.learning_rate);
  visit("final_learning_rate", o.final_learning_rate);
  visit("adam_eps", o.adam_eps);
  visit("gradient_clip", o.gradient_clip);
  visit("warm_up", o.warm_up);
  visit("averaged_share", o.averaged_share);
  visit("explore_start", o.explore_start);
  visit("explore_end", o.explore_end);
  visit("explore_frames", o.explore_frames);
  visit("target_every", o.target_every);
  visit("reward_scale", o.reward_scale);
  visit("stretch_frames", o.stretch_frames);
  bool stale = o.bootstrap == BootstrapBelief::current;
  visit("bootstrap_current_belief", stale);
  o.bootstrap = stale ? BootstrapBelief::current : BootstrapBelief::next;
  visit("learn_from_belief", o.learn_from_belief);
  visit("replay", o.replay);
}

template <class Visitor>
void visit_fields(AgentSpec& o, Visitor& visit) {
  visit("kind", o.kind);
  visit("eps", o.eps);
  visit("network", o.network);
  visit("loss", o.loss);
  visit("belief", o.belief);
  visit("belief_trajectories", o.belief_trajectories);
  visit("belief_states", o.belief_states);
  visit("training_belief_states", o.training_belief_states);
  visit("aggregator", o.aggregator);
  visit("double_q", o.double_q);
  visit("target_order", o.target_order);
  visit("discount", o.discount);
  visit("train_attack", o.train_attack);
  visit("start_from", o.start_from);
  visit("random_actions", o.random_actions);
  visit("training", o.training);
}

template <class T>
concept HasFields = std::is_same_v<T, AgentSpec> || std::is_same_v<T, TrainOptions> ||
    std::is_same_v<T, QNetworkShape> || std::is_same_v<T, ReplayOptions>;

struct Writer {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  template <class T>
  void operator()(const char* name, T& field) {
    if constexpr (HasFields<T>) {
      Writer inner;
      visit_fields(field, inner);
      json[name] = inner.json;
    } else {
      json[name] = field;
    }
  }
};

template <class T>
const char* kind_of() {
  if constexpr (std::is_same_v<T, bool>) return "true or false";
  if constexpr (std::is_integral_v<T>) return "a whole number";
  if constexpr (std::is_floating_point_v<T>) return "a number";
  if constexpr (std::is_same_v<T, std::string>) return "a text";
  return "a list of whole numbers from 1 to 65536";
}

/// The value as it stands there, short enough for a line.
std::string excerpt_of(const nlohmann::ordered_json& value) {
  using Json = nlohmann::ordered_json;
  const std::string text = value.dump(-1, ' ', true, Json::error_handler_t::replace);
  return text.size() <= 40 ? text : text.substr(0, 37) + "...";
}

class Reader {
 public:
  Reader(const nlohmann::ordered_json& json, std::string where) : json_(json), where_(std::move(where)) {
    if (!json.is_object()) throw InputError(where_ + ": no object, expected {\"NAME\": VALUE, ...}");
  }

  template <class T>
  void operator()(const char* name, T& field) {
    names_.emplace_back(name);
    const auto found = json_.find(name);
    if (found == json_.end()) return;
    const std::string here = where_ + ": " + name;
    if constexpr (HasFields<T>) {
      Reader inner(*found, here);
      visit_fields(field, inner);
      inner.refuse_unknown();
    } else {
      if (!fits<T>(*found)) {
        throw InputError(fmt::format("{}: {}, expected {}", here, excerpt_of(*found), kind_of<T>()));
      }
      field = found->template get<T>();
    }
  }

  void refuse_unknown() const {
    for (const auto& item : json_.items()) {
      if (std::find(names_.begin(), names_.end(), item.key()) != names_.end()) continue;
      throw InputError(fmt::format("{}: {}: no such field, expected {}", where_, excerpt_of(item.key()),
                                   nearest_or_all(item.key(), names_)));
    }
  }

 private:
  template <class T>
  static bool fits(const nlohmann::ordered_json& value) {
    if constexpr (std::is_same_v<T, bool>) return value.is_boolean();
    if constexpr (std::is_integral_v<T> && !std::is_same_v<T, bool>) {
      if (value.is_number_unsigned()) return std::in_range<T>(value.get<std::uint64_t>());
      return value.is_number_integer() && std::in_range<T>(value.get<std::int64_t>());
    }
    if constexpr (std::is_floating_point_v<T>) return value.is_number();
    if constexpr (std::is_same_v<T, std::string>) return value.is_string();
    return value.is_array() && std::all_of(value.begin(), value.end(), [](const auto& v) {
             return v.is_number_integer() && v.template get<long>() > 0 && v.template get<long>() <= 65536;
           });
  }

  const nlohmann::ordered_json& json_;
  std::string where_;
  std::vector<std::string> names_;
};

void require_word(const std::string& word, const std::vector<std::string>& words, const std::string& where) {
  if (std::find(words.begin(), words.end(), word) != words.end()) return;
  throw InputError(fmt::format("{}: {}, expected {}", where, excerpt_of(word), fmt::join(words, ", ")));
}

/// The name becomes the name of a file.
void require_file_name(const std::string& name, const std::string& where) {
  const auto allowed = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
           std::string_view("-_.:+").find(c) != std::string_view::npos;
  };
  if (!name.empty() && name.size() <= 64 && name[0] != '.' && std::all_of(name.begin(), name.end(), allowed)) return;
  throw InputError(fmt::format("{}: {}, expected at most 64 letters, digits and -_.:+", where, excerpt_of(name)));
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
  require_word(s.target_order, {"max-of-aggregate", "aggregate-of-max"}, where + ": target_order");
  require_word(s.train_attack, {"none", "random", "pgd", "min-best", "mixed"}, where + ": train_attack");
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

nlohmann::ordered_json to_json(const AgentSpec& spec) {
  AgentSpec copy = spec;
  Writer writer;
  visit_fields(copy, writer);
  return writer.json;
}

void merge_json(AgentSpec& spec, const nlohmann::ordered_json& json, const std::string& where) {
  Reader reader(json, where);
  visit_fields(spec, reader);
  reader.refuse_unknown();
  check(spec, where);
}

}  // namespace maximin::deep
