#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include <maximin/deep/report/results.hpp>
#include <maximin/models/files/file_lock.hpp>

namespace maximin::deep {

/// The table as JSON: schema "maximin-deep-results" version 1, described in deep/report/README.md. Every number is
/// written so that reading gives it back exactly; means and intervals are there too, for other programs to read.
/// Throws InputError as `validate`.
nlohmann::ordered_json to_json(const ResultTable& table);

/// Reads what `to_json` wrote. `where` is put before what is wrong, usually the file's name. A mean that does not
/// follow from the returns beside it is an error: somebody edited one of the two. Throws InputError, one line.
ResultTable results_from_json(const nlohmann::ordered_json& json, std::string_view where);

/// Reads a file. Throws InputError "FILE: what is wrong, expected ...".
ResultTable read_results(const std::filesystem::path& path);

/// Writes a file as a whole or not at all: a reader, or a run killed in the middle, sees the old table or the new one.
/// Throws InputError when the system refuses.
void write_results(const std::filesystem::path& path, const ResultTable& table);

/// A table that is made cell by cell and survives interruption: after each run the file holds all that is done.
///
///     ResultFile file = ResultFile::open("table.json", plan);
///     for (each block, cell and training seed)
///       if (!file.has(block, cell, seed)) file.put(block, cell, run);
class ResultFile {
 public:
  /// `plan` is the table with every cell and no runs, or with runs that are known already. Where the file exists, its
  /// runs are taken over; cells that it alone has are kept. Throws InputError when it is no such file, when its
  /// configuration differs from the plan's, or when another run is writing it.
  static ResultFile open(const std::filesystem::path& path, ResultTable plan);

  const ResultTable& table() const { return table_; }
  bool has(std::string_view block, const ResultCell& cell, std::uint64_t training_seed) const;

  /// Adds a run to a cell, which is made if the plan has none (in a block that is made if there is none), and writes
  /// the file. `cell` names agent, attack and eps; its measures are those of the run, the table's the means over runs;
  /// its note replaces the old where it is not empty. The run's wall_seconds are added to the table's. Throws
  /// InputError when the seed is there already or a number is not finite.
  void put(std::string_view block, const ResultCell& cell, const SeedRun& run);

 private:
  ResultFile(std::filesystem::path path, ResultTable table, FileLock lock);

  std::filesystem::path path_;
  ResultTable table_;
  FileLock lock_;
};

/// Takes over into `table` every run of `other` that it does not have; made for tables whose seeds ran on several
/// machines. Of a cell where they have some runs in common, and others not, measures are no longer known. Throws
/// InputError when the configurations differ, or the same run has other returns.
void merge(ResultTable& table, const ResultTable& other, std::string_view where);

}  // namespace maximin::deep
