#include <maximin/proofs_check/trial_file.hpp>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <string>
#include <system_error>
#include <utility>

#include <fmt/format.h>
#include <sys/file.h>

#include <maximin/models/files/json_text.hpp>
#include <maximin/theory/error.hpp>

namespace maximin {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// The complete lines of a file, and where they end.
struct Lines {
  std::vector<std::string> text;
  std::uintmax_t bytes = 0;
};

Lines complete_lines(const fs::path& path) {
  std::ifstream in(path, std::ios::binary);
  if (!in) throw InputError(fmt::format("{}: cannot be read, expected the file of an interrupted run", path.string()));
  Lines lines;
  std::string line;
  while (std::getline(in, line) && !in.eof()) {  // a last line without its newline was cut short
    lines.bytes += line.size() + 1;
    lines.text.push_back(line);
  }
  return lines;
}

Json parse_line(const fs::path& path, std::size_t number, const std::string& line) {
  return parse_json(line, 16, fmt::format("{}:{}", path.string(), number), "a line written by --trials-out");
}

TrialRecord parse_record(const fs::path& path, std::size_t number, const std::string& line, long expected) {
  const Json json = parse_line(path, number, line);
  TrialRecord record;
  try {
    record = trial_record_from_json(json);
  } catch (const std::exception& e) {
    throw InputError(fmt::format("{}:{}: {}, expected a trial record", path.string(), number, e.what()));
  }
  if (record.trial != expected) {
    throw InputError(fmt::format("{}:{}: trial {}, expected trial {}", path.string(), number, record.trial, expected));
  }
  return record;
}

}  // namespace

TrialFile::TrialFile(fs::path path, const char* mode) : path_(std::move(path)), file_(std::fopen(path_.c_str(), mode)) {
  if (!file_) {
    const int reason = errno;
    const char* hint = reason == EEXIST ? "; complete it with --resume, or name another file" : "";
    throw InputError(
        fmt::format("{}: {}, expected a file that can be written{}", path_.string(), std::strerror(reason), hint));
  }
  if (flock(fileno(file_.get()), LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
    throw InputError(fmt::format("{}: another run is writing it, expected one run at a time", path_.string()));
  }
}

TrialFile TrialFile::create(const fs::path& path, const Json& header) {
  TrialFile file(path, "wx");
  file.write_line(header);
  return file;
}

TrialFile TrialFile::resume(const fs::path& path, const Json& header) {
  if (!fs::exists(path)) return create(path, header);
  if (!fs::is_regular_file(path)) {
    throw InputError(fmt::format("{}: not a plain file, expected the file of an interrupted run", path.string()));
  }
  TrialFile file(path, "r+");  // locked before it is read
  file.read(header);
  return file;
}

void TrialFile::read(const Json& header) {
  const Lines lines = complete_lines(path_);
  if (!lines.text.empty()) {
    const Json old_header = parse_line(path_, 1, lines.text.front());
    if (old_header != header) {
      throw InputError(fmt::format("{}:1: another campaign ({}), expected the same options as now", path_.string(),
                                   first_difference(old_header, header)));
    }
  }
  for (std::size_t i = 1; i < lines.text.size(); ++i) {
    finished_.push_back(parse_record(path_, i + 1, lines.text[i], static_cast<long>(i) - 1));
  }
  std::error_code failure;
  fs::resize_file(path_, lines.bytes, failure);
  if (failure) {
    throw InputError(fmt::format("{}: {}, expected a file that can be cut back to its last whole line", path_.string(),
                                 failure.message()));
  }
  std::fseek(file_.get(), 0, SEEK_END);
  if (lines.text.empty()) write_line(header);
}

void TrialFile::append(const TrialRecord& record) {
  write_line(to_json(record));
}

void TrialFile::write_line(const Json& line) {
  const std::string text = line.dump() + '\n';
  if (std::fwrite(text.data(), 1, text.size(), file_.get()) != text.size() || std::fflush(file_.get()) != 0) {
    throw InputError(fmt::format("{}: {}, expected room for the results; free some and use --resume", path_.string(),
                                 std::strerror(errno)));
  }
}

}  // namespace maximin
