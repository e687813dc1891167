#include <maximin/deep/report/results.hpp>

#include <algorithm>
#include <cmath>
#include <set>
#include <tuple>

#include <fmt/format.h>

#include <maximin/theory/error.hpp>

namespace maximin::deep {
namespace {

[[noreturn]] void refuse_cell(const std::string& block, const ResultCell& c, const std::string& what) {
  throw InputError(fmt::format("table: {} / {} / {} eps {}: {}", block, c.agent, c.attack, c.eps, what));
}

void validate_runs(const std::string& block, const ResultCell& c) {
  std::set<std::uint64_t> seeds;
  for (const SeedRun& r : c.runs) {
    const auto refuse = [&](const std::string& what) {
      refuse_cell(block, c, fmt::format("training seed {}: {}", r.training_seed, what));
    };
    if (!seeds.insert(r.training_seed).second) refuse("there twice, expected one run for each seed");
    if (r.returns.empty()) refuse("no episodes, expected at least one");
    if (!(std::isfinite(r.wall_seconds) && r.wall_seconds >= 0)) refuse("wall seconds, expected a number >= 0");
    for (std::size_t k = 0; k < r.returns.size(); ++k) {
      if (!(std::abs(r.returns[k]) <= 1e100)) {
        refuse(fmt::format("return of episode {} is {}, expected a number of at most 1e100 in size", k, r.returns[k]));
      }
    }
  }
}

void validate_cell(const std::string& block, const ResultCell& c) {
  if (c.agent.empty() || c.attack.empty()) refuse_cell(block, c, "a name is empty, expected an agent and an attack");
  if (!(std::isfinite(c.eps) && c.eps >= 0)) refuse_cell(block, c, "eps, expected a finite number >= 0");
  if (c.paper && !(std::isfinite(c.paper->mean) && std::isfinite(c.paper->deviation.value_or(0)) &&
                   c.paper->deviation.value_or(0) >= 0)) {
    refuse_cell(block, c, "the paper's figure, expected a finite mean and a deviation >= 0");
  }
  if (c.target && !std::isfinite(c.target->value)) refuse_cell(block, c, "target, expected a finite number");
  for (const auto& [name, value] : c.measures) {
    if (!std::isfinite(value)) refuse_cell(block, c, fmt::format("{} is {}, expected a finite number", name, value));
  }
  validate_runs(block, c);
}

template <class Cells>
auto* find_cell(Cells& cells, std::string_view agent, std::string_view attack, double eps) {
  const auto it = std::find_if(cells.begin(), cells.end(), [&](const ResultCell& c) {
    return c.agent == agent && c.attack == attack && c.eps == eps;
  });
  return it == cells.end() ? nullptr : &*it;
}

template <class Blocks>
auto* find_block(Blocks& blocks, std::string_view name) {
  const auto it = std::find_if(blocks.begin(), blocks.end(), [&](const ResultBlock& b) { return b.name == name; });
  return it == blocks.end() ? nullptr : &*it;
}

}  // namespace

TargetVerdict verdict(const ResultCell& cell) {
  if (!cell.target || cell.runs.empty()) return TargetVerdict::none;
  const Estimate e = estimate(cell.runs);
  const double sign = cell.target->sense == Target::Sense::at_least ? 1 : -1;
  const double above = sign * (e.mean - cell.target->value);  // how far on the right side
  if (!e.across_seeds) return above >= 0 ? TargetVerdict::met_on_average : TargetVerdict::missed;
  const bool beyond_doubt = std::abs(above) >= e.across_seeds->half_width;
  if (above >= 0) return beyond_doubt ? TargetVerdict::met : TargetVerdict::met_on_average;
  return beyond_doubt ? TargetVerdict::missed : TargetVerdict::missed_nearly;
}

std::vector<std::string> ResultBlock::agents() const {
  std::vector<std::string> names;
  for (const ResultCell& c : cells) {
    if (std::find(names.begin(), names.end(), c.agent) == names.end()) names.push_back(c.agent);
  }
  return names;
}

std::vector<ResultBlock::Column> ResultBlock::columns() const {
  std::vector<Column> all;
  for (const ResultCell& c : cells) {
    const Column column{c.attack, c.eps};
    if (std::find(all.begin(), all.end(), column) == all.end()) all.push_back(column);
  }
  return all;
}

const ResultCell* ResultBlock::find(std::string_view agent, std::string_view attack, double eps) const {
  return find_cell(cells, agent, attack, eps);
}

ResultCell* ResultBlock::find(std::string_view agent, std::string_view attack, double eps) {
  return find_cell(cells, agent, attack, eps);
}

const ResultBlock* ResultTable::find(std::string_view block) const {
  return find_block(blocks, block);
}

ResultBlock* ResultTable::find(std::string_view block) {
  return find_block(blocks, block);
}

void validate(const ResultTable& table) {
  if (!(std::isfinite(table.wall_seconds) && table.wall_seconds >= 0)) {
    throw InputError("table: wall seconds, expected a number >= 0");
  }
  std::set<std::string> names;
  for (const ResultBlock& b : table.blocks) {
    if (b.name.empty() || !names.insert(b.name).second) {
      throw InputError(fmt::format("table: block '{}', expected names that are not empty and occur once", b.name));
    }
    std::set<std::tuple<std::string, std::string, double>> keys;
    for (const ResultCell& c : b.cells) {
      validate_cell(b.name, c);
      if (!keys.insert({c.agent, c.attack, c.eps}).second) refuse_cell(b.name, c, "there twice, expected once");
    }
  }
}

std::string column_title(const ResultBlock::Column& column) {
  return column.eps == 0 ? column.attack : fmt::format("{}, ε = {:g}", column.attack, column.eps);
}

}  // namespace maximin::deep
