#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>
#include <vector>

#include <nlohmann/json.hpp>

#include <maximin/proofs_check/trial_record.hpp>

namespace maximin {

/// Results of a campaign as JSON Lines: a header with the configuration, then one record per trial, in order. Every
/// record is handed to the system before the next trial counts as done, so that a killed run loses no finished one; a
/// line cut short by the kill is dropped when the run resumes.
class TrialFile {
 public:
  /// Starts a new file. Throws InputError when it exists already: results are never overwritten.
  static TrialFile create(const std::filesystem::path& path, const nlohmann::ordered_json& header);

  /// Opens the file of an interrupted run and reads what it holds; starts a new one when there is none.
  /// Throws InputError when its header differs from `header`, a record is damaged or out of order, or another run has
  /// it open.
  static TrialFile resume(const std::filesystem::path& path, const nlohmann::ordered_json& header);

  /// What the file held when it was resumed, in order from trial 0.
  const std::vector<TrialRecord>& finished() const { return finished_; }

  /// Writes one record. Throws InputError when the system refuses (disk full).
  void append(const TrialRecord& record);

 private:
  struct Close {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };

  TrialFile(std::filesystem::path path, const char* mode);
  void read(const nlohmann::ordered_json& header);
  void write_line(const nlohmann::ordered_json& line);

  std::filesystem::path path_;
  std::unique_ptr<std::FILE, Close> file_;
  std::vector<TrialRecord> finished_;
};

}  // namespace maximin
