#include <maximin/deep/report/training_log.hpp>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <set>
#include <system_error>

#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <maximin/theory/error.hpp>

namespace maximin::deep {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> split(std::string_view line) {
  std::vector<std::string> fields;
  for (;;) {
    const std::size_t comma = line.find(',');
    fields.emplace_back(line.substr(0, comma));
    if (comma == line.npos) return fields;
    line.remove_prefix(comma + 1);
  }
}

std::string joined(const std::vector<std::string>& names) {
  std::string line;
  for (const std::string& n : names) line += (line.empty() ? "" : ",") + n;
  return line;
}

/// What is wrong with the names of the columns; empty: nothing.
std::string flaw_of_columns(const std::vector<std::string>& columns) {
  if (columns.empty() || columns.front() != "frames") return "the first column is not frames";
  std::set<std::string> seen;
  for (const std::string& c : columns) {
    if (c.empty() || c.find_first_of(",\"\r\n") != c.npos) return fmt::format("column '{}'", c);
    if (!seen.insert(c).second) return fmt::format("column {} twice", c);
  }
  return "";
}

std::optional<double> value_of(const std::string& text, const std::string& where, const std::string& column) {
  if (text.empty()) return std::nullopt;
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) {
    throw InputError(fmt::format("{}: {} is '{}', expected a finite number or nothing", where, column, text));
  }
  return value;
}

/// A log and, for each row, the byte at which it ends.
struct LogOnDisk {
  TrainingLog log;
  std::uintmax_t header_end = 0;
  std::vector<std::uintmax_t> row_end;
};

void read_row(LogOnDisk& disk, const std::string& line, const std::string& where) {
  const std::vector<std::string> fields = split(line);
  if (fields.size() != disk.log.columns.size()) {
    throw InputError(fmt::format("{}: {} fields, expected {}", where, fields.size(), disk.log.columns.size()));
  }
  std::vector<std::optional<double>> row;
  for (std::size_t i = 0; i < fields.size(); ++i) row.push_back(value_of(fields[i], where, disk.log.columns[i]));
  if (!row.front()) throw InputError(where + ": no frames, expected a number");
  if (!disk.log.rows.empty() && *row.front() <= *disk.log.rows.back().front()) {
    throw InputError(where + ": frames do not rise, expected more than in the row before");
  }
  disk.log.rows.push_back(std::move(row));
}

LogOnDisk read_log(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in || fs::is_directory(path)) {
    throw InputError(fmt::format("{}: cannot be read, expected a training log", path.string()));
  }
  LogOnDisk disk;
  std::string line;
  std::uintmax_t end = 0;
  for (long number = 1; std::getline(in, line) && !in.eof(); ++number) {  // a last line without its end was cut short
    end += line.size() + 1;
    const std::string where = fmt::format("{}:{}", path.string(), number);
    if (number > 1) {
      read_row(disk, line, where);
      disk.row_end.push_back(end);
      continue;
    }
    disk.log.columns = split(line);
    disk.header_end = end;
    const std::string flaw = flaw_of_columns(disk.log.columns);
    if (!flaw.empty()) throw InputError(fmt::format("{}: {}, expected the columns of a training log", where, flaw));
  }
  return disk;
}

}  // namespace

std::optional<std::size_t> TrainingLog::column(std::string_view name) const {
  const auto it = std::find(columns.begin(), columns.end(), name);
  if (it == columns.end()) return std::nullopt;
  return static_cast<std::size_t>(it - columns.begin());
}

TrainingLog read_training_log(const fs::path& path) {
  TrainingLog log = read_log(path).log;
  if (log.columns.empty()) throw InputError(fmt::format("{}: empty, expected a training log", path.string()));
  return log;
}

TrainingLogWriter::TrainingLogWriter(const fs::path& path, std::vector<std::string> columns, double frames)
    : path_(path), columns_(std::move(columns)) {
  const std::string flaw = flaw_of_columns(columns_);
  if (!flaw.empty()) {
    throw InputError(fmt::format("training log: {}, expected frames first and names without comma and quote", flaw));
  }
  file_.reset(std::fopen(path.c_str(), "ab"));
  if (!file_) write("");
  if (::flock(::fileno(file_.get()), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    throw InputError(fmt::format("{}: another run is writing it, expected one run at a time", path_.string()));
  }
  const LogOnDisk disk = read_log(path);
  if (!disk.log.columns.empty() && disk.log.columns != columns_) {
    throw InputError(
        fmt::format("{}:1: columns {}, expected {}", path_.string(), joined(disk.log.columns), joined(columns_)));
  }
  std::uintmax_t end = disk.header_end;
  for (std::size_t i = 0; i < disk.log.rows.size() && *disk.log.rows[i].front() <= frames; ++i) {
    end = disk.row_end[i];
    last_frames_ = *disk.log.rows[i].front();
  }
  std::error_code failure;
  fs::resize_file(path, end, failure);
  if (failure) {
    throw InputError(fmt::format("{}: {}, expected a file that can be written", path_.string(), failure.message()));
  }
  if (end == 0) write(joined(columns_) + '\n');
}

void TrainingLogWriter::append(const std::vector<std::optional<double>>& row) {
  if (row.size() != columns_.size()) {
    throw InputError(fmt::format("{}: {} values, expected {}", path_.string(), row.size(), columns_.size()));
  }
  if (!row.front() || !(*row.front() > last_frames_)) {
    throw InputError(
        fmt::format("{}: frames {}, expected more than {}", path_.string(), row.front().value_or(-1), last_frames_));
  }
  std::string line;
  for (std::size_t i = 0; i < row.size(); ++i) {
    if (row[i] && !std::isfinite(*row[i])) {
      throw InputError(fmt::format("{}: {} is {} after {} frames, expected a finite number", path_.string(),
                                   columns_[i], *row[i], *row.front()));
    }
    line += (i == 0 ? "" : ",") + (row[i] ? fmt::format("{}", *row[i]) : "");
  }
  write(line + '\n');
  last_frames_ = *row.front();
}

void TrainingLogWriter::write(std::string_view text) {
  if (file_ && std::fwrite(text.data(), 1, text.size(), file_.get()) == text.size() && std::fflush(file_.get()) == 0) {
    return;
  }
  throw InputError(fmt::format("{}: {}, expected a file that can be written", path_.string(), std::strerror(errno)));
}

}  // namespace maximin::deep
