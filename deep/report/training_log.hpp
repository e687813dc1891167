#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace maximin::deep {

/// How a training went, as a table of numbers: the first column is "frames", rising; a value that there is none of (no
/// episode ended yet, no update was made yet) is absent. Columns that the page draws, where they are there: "return"
/// (mean return of the episodes since the last row), "loss", "exploration"; any other is kept and not drawn.
struct TrainingLog {
  std::vector<std::string> columns;
  std::vector<std::vector<std::optional<double>>> rows;

  /// Which column it is; none where there is no such one.
  std::optional<std::size_t> column(std::string_view name) const;
};

/// Reads a CSV file as TrainingLogWriter writes it. A last line cut short by a kill is left out. Throws InputError
/// "FILE:LINE: what is wrong, expected ...".
TrainingLog read_training_log(const std::filesystem::path& path);

/// Writes a training log as CSV, a row at a time, each handed to the system at once: a killed training loses no row.
class TrainingLogWriter {
 public:
  /// Starts a new file, or, where there is one, goes on after its last row with at most `frames` frames: what a run
  /// wrote after its last checkpoint is dropped, for the run that resumes from the checkpoint writes it again. 0 keeps
  /// none. The names must be unique, without comma, quote and line break, the first "frames". Throws InputError when
  /// the file has other columns, or cannot be written.
  TrainingLogWriter(const std::filesystem::path& path, std::vector<std::string> columns, double frames = 0);

  /// One value per column. Throws InputError when a value is not finite, frames do not rise, or the disk is full.
  void append(const std::vector<std::optional<double>>& row);

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };

  void write(std::string_view text);

  std::filesystem::path path_;
  std::vector<std::string> columns_;
  double last_frames_ = -1;
  std::unique_ptr<std::FILE, Close> file_;
};

/// One line of the pictures of training. Curves of the same agent are its training seeds: they are drawn as one mean
/// with a band from the lowest to the highest.
struct TrainingCurve {
  std::string agent;
  std::uint64_t training_seed = 0;
  TrainingLog log;
};

}  // namespace maximin::deep
