#include <maximin/deep/report/results_file.hpp>

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include <maximin/deep/report/json_fields.hpp>
#include <maximin/models/files/json_text.hpp>
#include <maximin/models/files/output_file.hpp>
#include <maximin/theory/error.hpp>

namespace maximin::deep {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

void expect_same_configuration(const Json& old_one, const Json& new_one, std::string_view where) {
  if (old_one == new_one) return;
  throw InputError(fmt::format("{}: another table ({}), expected the same configuration as now", where,
                               first_difference(old_one, new_one)));
}

ResultBlock& block_of(ResultTable& table, std::string_view name) {
  if (ResultBlock* found = table.find(name)) return *found;
  table.blocks.push_back({std::string(name), "", {}});
  return table.blocks.back();
}

ResultCell& cell_of(ResultBlock& block, const ResultCell& like) {
  if (ResultCell* found = block.find(like.agent, like.attack, like.eps)) return *found;
  block.cells.push_back(like);
  block.cells.back().runs.clear();
  return block.cells.back();
}

const SeedRun* run_of(const ResultCell& cell, std::uint64_t training_seed) {
  for (const SeedRun& r : cell.runs) {
    if (r.training_seed == training_seed) return &r;
  }
  return nullptr;
}

/// Makes the cell's measures means over its runs, of which the last `added` have these on average.
void take_measures(ResultCell& to, const std::vector<std::pair<std::string, double>>& measures, std::size_t added) {
  const double share = static_cast<double>(added) / static_cast<double>(to.runs.size());
  for (const auto& measure : measures) {
    const auto known =
        std::find_if(to.measures.begin(), to.measures.end(), [&](const auto& m) { return m.first == measure.first; });
    if (known == to.measures.end()) {
      to.measures.push_back(measure);
    } else {
      known->second += (measure.second - known->second) * share;
    }
  }
}

/// Runs stand in the order of their seeds.
void insert(ResultCell& to, const SeedRun& run) {
  const auto place = std::upper_bound(to.runs.begin(), to.runs.end(), run, [](const SeedRun& a, const SeedRun& b) {
    return a.training_seed < b.training_seed;
  });
  to.runs.insert(place, run);
}

/// Adds the runs of `from` that `to` does not have. Returns their wall time.
double take_runs(ResultCell& to, const ResultCell& from, std::string_view where) {
  double seconds = 0;
  std::size_t added = 0;
  for (const SeedRun& r : from.runs) {
    const SeedRun* known = run_of(to, r.training_seed);
    if (known && (known->returns != r.returns || known->evaluation_seed != r.evaluation_seed)) {
      throw InputError(fmt::format("{}: {} / {} eps {}: training seed {} has other returns, expected the same run",
                                   where, to.agent, to.attack, to.eps, r.training_seed));
    }
    if (known) continue;
    insert(to, r);
    ++added;
    seconds += r.wall_seconds;
  }
  if (to.note.empty()) to.note = from.note;
  if (added == from.runs.size()) {
    take_measures(to, from.measures, added);
  } else if (added > 0) {
    to.measures.clear();  // of some of the runs alone they are not known
  }
  return seconds;
}

}  // namespace

ResultTable read_results(const fs::path& path) {
  return results_from_json(read_json_file(path, "a table of results"), path.string());
}

void write_results(const fs::path& path, const ResultTable& table) {
  write_file(path, readable_json(to_json(table)), Overwrite::replace);
}

ResultFile::ResultFile(fs::path path, ResultTable table, FileLock lock)
    : path_(std::move(path)), table_(std::move(table)), lock_(std::move(lock)) {}

ResultFile ResultFile::open(const fs::path& path, ResultTable plan) {
  validate(plan);
  FileLock lock(path);
  if (fs::exists(path)) {
    const ResultTable old_table = read_results(path);
    const double seconds = plan.wall_seconds + old_table.wall_seconds;
    merge(plan, old_table, path.string());
    plan.wall_seconds = seconds;
  }
  write_results(path, plan);
  return ResultFile(path, std::move(plan), std::move(lock));
}

bool ResultFile::has(std::string_view block, const ResultCell& cell, std::uint64_t training_seed) const {
  const ResultBlock* b = table_.find(block);
  const ResultCell* c = b ? b->find(cell.agent, cell.attack, cell.eps) : nullptr;
  return c && run_of(*c, training_seed);
}

void ResultFile::put(std::string_view block, const ResultCell& cell, const SeedRun& run) {
  ResultTable next = table_;
  ResultCell& to = cell_of(block_of(next, block), cell);
  insert(to, run);
  if (!cell.note.empty()) to.note = cell.note;
  take_measures(to, cell.measures, 1);
  next.wall_seconds += run.wall_seconds;
  write_results(path_, next);  // validates; the old table stays where it throws
  table_ = std::move(next);
}

void merge(ResultTable& table, const ResultTable& other, std::string_view where) {
  expect_same_configuration(other.configuration, table.configuration, where);
  ResultTable merged = table;
  for (const ResultBlock& b : other.blocks) {
    ResultBlock& block = block_of(merged, b.name);
    for (const ResultCell& c : b.cells) merged.wall_seconds += take_runs(cell_of(block, c), c, where);
  }
  table = std::move(merged);
}

}  // namespace maximin::deep
