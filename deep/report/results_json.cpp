#include <cmath>
#include <limits>

#include <fmt/format.h>

#include <maximin/deep/report/json_fields.hpp>
#include <maximin/deep/report/results_file.hpp>
#include <maximin/theory/error.hpp>

namespace maximin::deep {
namespace {

using Json = nlohmann::ordered_json;
constexpr const char* results_schema = "maximin-deep-results";

const char* design_name(EpisodeDesign design) {
  return design == EpisodeDesign::nested ? "nested" : design == EpisodeDesign::crossed ? "crossed" : "mixed";
}

Json interval_json(const std::optional<ConfidenceInterval>& interval) {
  if (!interval) return nullptr;
  return {{"half_width", interval->half_width}, {"degrees_of_freedom", interval->degrees}};
}

/// For other programs: all of it follows from the returns.
Json summary_json(const Estimate& e) {
  return {{"mean", e.mean},
          {"seeds", e.seed_means.size()},
          {"episodes", e.episodes},
          {"seed_means", e.seed_means},
          {"episodes_are", design_name(e.design)},
          {"interval_95_across_seeds", interval_json(e.across_seeds)},
          {"interval_95_these_agents", interval_json(e.these_agents)}};
}

Json run_json(const SeedRun& run) {
  return {{"training_seed", run.training_seed},
          {"evaluation_seed", run.evaluation_seed},
          {"wall_seconds", run.wall_seconds},
          {"returns", run.returns}};
}

Json cell_json(const ResultCell& cell) {
  Json json{{"agent", cell.agent}, {"attack", cell.attack}, {"eps", cell.eps}};
  if (!cell.runs.empty()) json["summary"] = summary_json(estimate(cell.runs));
  if (cell.paper) {
    json["paper"]["mean"] = cell.paper->mean;
    if (cell.paper->deviation) json["paper"]["deviation"] = *cell.paper->deviation;
  }
  if (cell.target) {
    json["target"] = {{cell.target->sense == Target::Sense::at_least ? "at_least" : "at_most", cell.target->value}};
  }
  if (!cell.note.empty()) json["note"] = cell.note;
  for (const auto& [name, value] : cell.measures) json["measures"].push_back({{"name", name}, {"value", value}});
  json["runs"] = Json::array();
  for (const SeedRun& run : cell.runs) json["runs"].push_back(run_json(run));
  return json;
}

SeedRun run_from(const Fields& fields) {
  SeedRun run;
  run.training_seed = fields.whole("training_seed");
  run.evaluation_seed = fields.whole("evaluation_seed");
  run.wall_seconds = fields.number("wall_seconds");
  run.returns = fields.numbers("returns");
  return run;
}

std::optional<Target> target_from(const Fields& cell) {
  if (!cell.has("target")) return std::nullopt;
  const Fields target = cell.object("target");
  if (target.has("at_least")) return Target{Target::Sense::at_least, target.number("at_least")};
  return Target{Target::Sense::at_most, target.number("at_most")};
}

void check_summary(const Fields& fields, const ResultCell& cell) {
  if (cell.runs.empty()) {
    if (fields.has("summary")) fields.refuse("summary", "there without a run, expected runs");
    return;
  }
  const double mean = estimate(cell.runs).mean;
  const double stated = fields.object("summary").number("mean");
  if (!(std::abs(stated - mean) <= 1e-9 * (1 + std::abs(mean)))) {
    fields.refuse("summary.mean", fmt::format("{}, expected {}, the mean of the returns beside it", stated, mean));
  }
}

ResultCell cell_from(const Fields& fields) {
  ResultCell cell;
  cell.agent = fields.text("agent");
  cell.attack = fields.text("attack");
  cell.eps = fields.number("eps");
  if (fields.has("paper")) {
    const Fields paper = fields.object("paper");
    cell.paper = PaperFigure{paper.number("mean"), std::nullopt};
    if (paper.has("deviation")) cell.paper->deviation = paper.number("deviation");
  }
  cell.target = target_from(fields);
  if (fields.has("note")) cell.note = fields.text("note");
  if (fields.has("measures")) {
    for (const Fields& m : fields.objects("measures")) cell.measures.emplace_back(m.text("name"), m.number("value"));
  }
  for (const Fields& run : fields.objects("runs")) {
    cell.runs.push_back(run_from(run));
    if (cell.runs.back().returns.empty()) run.refuse("returns", "empty, expected at least one number");
  }
  check_summary(fields, cell);
  return cell;
}

}  // namespace

Json to_json(const ResultTable& table) {
  validate(table);
  Json json{{"schema", results_schema},           {"schema_version", 1},      {"title", table.title},
            {"version", table.version},           {"command", table.command}, {"configuration", table.configuration},
            {"wall_seconds", table.wall_seconds}, {"blocks", Json::array()}};
  for (const ResultBlock& b : table.blocks) {
    Json block{{"name", b.name}, {"note", b.note}, {"cells", Json::array()}};
    for (const ResultCell& c : b.cells) block["cells"].push_back(cell_json(c));
    json["blocks"].push_back(std::move(block));
  }
  return json;
}

ResultTable results_from_json(const Json& json, std::string_view where) {
  const Fields fields(json, std::string(where));
  fields.expect_schema(results_schema, 1);
  ResultTable table;
  table.title = fields.text("title");
  table.version = fields.text("version");
  table.command = fields.text("command");
  table.configuration = fields.any("configuration");
  table.wall_seconds = fields.number("wall_seconds");
  for (const Fields& b : fields.objects("blocks")) {
    ResultBlock block{b.text("name"), b.text("note"), {}};
    for (const Fields& c : b.objects("cells")) block.cells.push_back(cell_from(c));
    table.blocks.push_back(std::move(block));
  }
  try {
    validate(table);
  } catch (const InputError& e) {
    throw InputError(fmt::format("{}: {}", where, e.what()));
  }
  return table;
}

}  // namespace maximin::deep
