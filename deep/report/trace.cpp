#include <maximin/deep/report/trace.hpp>

#include <cmath>

#include <fmt/format.h>

#include <maximin/deep/report/json_fields.hpp>
#include <maximin/deep/report/results_file.hpp>
#include <maximin/models/files/output_file.hpp>
#include <maximin/theory/error.hpp>

namespace maximin::deep {
namespace {

using Json = nlohmann::ordered_json;
constexpr const char* trace_schema = "maximin-deep-trace";

Json point_json(Point p) {
  return Json::array({p.x, p.y});
}

bool in_world(Point p) {
  const auto inside = [](double v) { return v >= 0 && v <= gridworld::side; };  // false of NaN
  return inside(p.x) && inside(p.y);
}

/// Observations that noise made may lie outside of the world, but not far.
bool near_world(Point p) {
  const auto inside = [](double v) { return v >= -gridworld::side && v <= 2 * gridworld::side; };
  return inside(p.x) && inside(p.y);
}

std::string flaw_of(const TraceBelief& belief) {
  for (const Box& b : belief.boxes) {
    if (b.empty() || !near_world({b.x_low, b.y_low}) || !near_world({b.x_high, b.y_high})) {
      return fmt::format("box [{}, {}) x [{}, {}), expected one in the world", b.x_low, b.x_high, b.y_low, b.y_high);
    }
  }
  for (const Point& p : belief.points) {
    if (!near_world(p)) return fmt::format("particle ({}, {}), expected a place in or near the world", p.x, p.y);
  }
  if (!belief.weights.empty() && belief.weights.size() != belief.points.size()) {
    return fmt::format("{} weights, expected {}", belief.weights.size(), belief.points.size());
  }
  for (const double w : belief.weights) {
    if (!(std::isfinite(w) && w >= 0)) return fmt::format("weight {}, expected a finite number >= 0", w);
  }
  return "";
}

std::string flaw_of(const TraceStep& step) {
  if (!in_world(step.truth)) {
    return fmt::format("truth ({}, {}), expected a place in the world", step.truth.x, step.truth.y);
  }
  if (!near_world(step.shown)) {
    return fmt::format("shown ({}, {}), expected a place in or near the world", step.shown.x, step.shown.y);
  }
  if (step.action < 0 || step.action >= static_cast<Action>(gridworld::moves.size())) {
    return fmt::format("action {}, expected 0 to {}", step.action, gridworld::moves.size() - 1);
  }
  if (!std::isfinite(step.reward)) return fmt::format("reward {}, expected a finite number", step.reward);
  return flaw_of(step.belief);
}

Json step_json(const TraceStep& step) {
  Json json{{"truth", point_json(step.truth)},
            {"shown", point_json(step.shown)},
            {"action", step.action},
            {"reward", step.reward}};
  for (const Box& b : step.belief.boxes) json["boxes"].push_back(Json::array({b.x_low, b.x_high, b.y_low, b.y_high}));
  for (const Point& p : step.belief.points) json["particles"].push_back(point_json(p));
  if (!step.belief.weights.empty()) json["weights"] = step.belief.weights;
  return json;
}

Point point_from(const Fields& fields, std::string_view key) {
  const std::vector<double> xy = fields.numbers(key);
  if (xy.size() != 2) fields.refuse(key, fmt::format("{} numbers, expected 2", xy.size()));
  return {xy[0], xy[1]};
}

TraceStep step_from(const Fields& fields) {
  TraceStep step;
  step.truth = point_from(fields, "truth");
  step.shown = point_from(fields, "shown");
  const std::uint64_t action = fields.whole("action");
  if (action >= gridworld::moves.size()) fields.refuse("action", fmt::format("{}, expected 0 to 7", action));
  step.action = static_cast<Action>(action);
  step.reward = fields.number("reward");
  if (fields.has("boxes")) {
    for (const auto& b : fields.tuples("boxes", 4)) step.belief.boxes.push_back({b[0], b[1], b[2], b[3]});
  }
  if (fields.has("particles")) {
    for (const auto& p : fields.tuples("particles", 2)) step.belief.points.push_back({p[0], p[1]});
  }
  if (fields.has("weights")) step.belief.weights = fields.numbers("weights");
  return step;
}

}  // namespace

void EpisodeTrace::add(const StepRecord<Point, Point, Action>& record, TraceBelief belief) {
  steps.push_back({record.truth, record.shown, std::move(belief), record.action, record.reward});
  end = record.next;
  terminal = record.terminal;
}

double EpisodeTrace::total_reward() const {
  double sum = 0;
  for (const TraceStep& s : steps) sum += s.reward;
  return sum;
}

std::string EpisodeTrace::outcome() const {
  const gridworld::Cell cell = gridworld::cell(end);
  const char* what = !terminal                       ? "cut"
                     : cell == gridworld::Cell::gold ? "gold"
                     : cell == gridworld::Cell::bomb ? "bomb"
                                                     : "over";
  return fmt::format("{} after {} step{}, return {:g}", what, steps.size(), steps.size() == 1 ? "" : "s",
                     total_reward());
}

void validate(const EpisodeTrace& trace, std::string_view where) {
  if (!(std::isfinite(trace.eps) && trace.eps >= 0)) {
    throw InputError(fmt::format("{}: eps {}, expected a finite number >= 0", where, trace.eps));
  }
  for (std::size_t k = 0; k < trace.steps.size(); ++k) {
    const std::string flaw = flaw_of(trace.steps[k]);
    if (!flaw.empty()) throw InputError(fmt::format("{}: step {}: {}", where, k, flaw));
  }
  if (!in_world(trace.end)) {
    throw InputError(fmt::format("{}: end ({}, {}), expected a place in the world", where, trace.end.x, trace.end.y));
  }
}

Json to_json(const EpisodeTrace& trace) {
  validate(trace, "trace");
  Json json{{"schema", trace_schema},
            {"schema_version", 1},
            {"agent", trace.agent},
            {"attack", trace.attack},
            {"eps", trace.eps},
            {"training_seed", trace.training_seed},
            {"evaluation_seed", trace.evaluation_seed},
            {"episode", trace.episode},
            {"end", point_json(trace.end)},
            {"terminal", trace.terminal},
            {"steps", Json::array()}};
  for (const TraceStep& s : trace.steps) json["steps"].push_back(step_json(s));
  return json;
}

EpisodeTrace trace_from_json(const Json& json, std::string_view where) {
  const Fields fields(json, std::string(where));
  fields.expect_schema(trace_schema, 1);
  EpisodeTrace trace;
  trace.agent = fields.text("agent");
  trace.attack = fields.text("attack");
  trace.eps = fields.number("eps");
  trace.training_seed = fields.whole("training_seed");
  trace.evaluation_seed = fields.whole("evaluation_seed");
  trace.episode = static_cast<long>(fields.whole("episode"));
  trace.end = point_from(fields, "end");
  trace.terminal = fields.flag("terminal");
  for (const Fields& s : fields.objects("steps")) trace.steps.push_back(step_from(s));
  validate(trace, where);
  return trace;
}

void write_trace(const std::filesystem::path& path, const EpisodeTrace& trace) {
  write_file(path, readable_json(to_json(trace)), Overwrite::replace);
}

EpisodeTrace read_trace(const std::filesystem::path& path) {
  return trace_from_json(read_json_file(path, "the trace of an episode"), path.string());
}

}  // namespace maximin::deep
