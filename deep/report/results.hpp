#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include <maximin/deep/report/estimate.hpp>

/// The defence-by-attack table: what it holds. No LibTorch in this folder.
namespace maximin::deep {

/// What the paper prints for a cell: mean and standard deviation over episodes of a single training seed.
struct PaperFigure {
  double mean = 0;
  std::optional<double> deviation;

  friend bool operator==(const PaperFigure&, const PaperFigure&) = default;
};

/// What a cell should come to.
struct Target {
  enum class Sense { at_least, at_most } sense = Sense::at_least;
  double value = 0;

  friend bool operator==(const Target&, const Target&) = default;
};

/// What became of a target. The mean decides; the interval says whether other seeds might decide otherwise.
enum class TargetVerdict {
  none,            ///< no target, or not run yet
  met,             ///< by the whole interval
  met_on_average,  ///< by the mean; the interval reaches beyond the target, or there is none across seeds
  missed_nearly,   ///< missed by the mean, within the interval: still a miss
  missed,          ///< by the whole interval, or by the mean where there is no interval across seeds
};

/// One defence under one attack.
struct ResultCell {
  std::string agent;
  std::string attack;
  double eps = 0;             ///< radius of the attack's ball; 0 where there is none
  std::vector<SeedRun> runs;  ///< one per training seed; empty: planned, not run yet
  std::optional<PaperFigure> paper;
  std::optional<Target> target;
  std::string note;
  std::vector<std::pair<std::string, double>> measures;  ///< further numbers, named, e.g. "truth in belief"

  friend bool operator==(const ResultCell&, const ResultCell&) = default;
};

TargetVerdict verdict(const ResultCell& cell);

/// One part of the table: "the paper's attacks", "adaptive attacks", "ablation", "noisy environment".
struct ResultBlock {
  std::string name;
  std::string note;
  std::vector<ResultCell> cells;
  bool derived = false;  ///< its runs are those of other cells, and not to be counted twice; in no file

  /// A column: an attack and its radius.
  struct Column {
    std::string attack;
    double eps = 0;
    friend bool operator==(const Column&, const Column&) = default;
  };
  /// Rows and columns in the order in which cells first name them.
  std::vector<std::string> agents() const;
  std::vector<Column> columns() const;
  const ResultCell* find(std::string_view agent, std::string_view attack, double eps) const;
  ResultCell* find(std::string_view agent, std::string_view attack, double eps);

  friend bool operator==(const ResultBlock&, const ResultBlock&) = default;
};

struct ResultTable {
  std::string title;
  std::string version;                                                      ///< of the program
  std::string command;                                                      ///< the command line that makes the table
  nlohmann::ordered_json configuration = nlohmann::ordered_json::object();  ///< all that the numbers depend on
  double wall_seconds = 0;                                                  ///< of all sessions together
  std::vector<ResultBlock> blocks;

  const ResultBlock* find(std::string_view block) const;
  ResultBlock* find(std::string_view block);

  friend bool operator==(const ResultTable&, const ResultTable&) = default;
};

/// Throws InputError "table: BLOCK / AGENT / ATTACK eps E: what, expected what" where a name is empty or occurs twice,
/// a number is not finite, eps is negative, or a training seed occurs twice in a cell.
void validate(const ResultTable& table);

/// "PGD, ε = 0.1", or the attack alone where eps is 0.
std::string column_title(const ResultBlock::Column& column);

}  // namespace maximin::deep
