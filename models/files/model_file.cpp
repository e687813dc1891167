#include <maximin/models/files/model_file.hpp>

#include <algorithm>
#include <cctype>
#include <string>

#include <maximin/models/files/cassandra.hpp>
#include <maximin/models/files/csv.hpp>
#include <maximin/models/files/drn.hpp>
#include <maximin/models/files/gymnasium_json.hpp>
#include <maximin/models/files/input_file.hpp>
#include <maximin/models/files/internal/gzip.hpp>
#include <maximin/models/files/internal/json_document.hpp>
#include <maximin/models/files/internal/text_lines.hpp>
#include <maximin/models/files/maximin_json.hpp>
#include <maximin/models/files/prism_explicit.hpp>
#include <maximin/models/files/umb.hpp>
#include <maximin/theory/rational.hpp>

namespace maximin {

namespace {

using namespace internal;

enum class Format { json, cassandra, prism, drn, csv, umb, unknown };

std::string lower_extension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  std::transform(extension.begin(), extension.end(), extension.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return extension;
}

Format format_of_extension(const std::string& extension) {
  if (extension == ".json") return Format::json;
  if (extension == ".pomdp" || extension == ".mdp") return Format::cassandra;
  if (extension == ".tra") return Format::prism;
  if (extension == ".drn") return Format::drn;
  if (extension == ".csv") return Format::csv;
  if (extension == ".umb") return Format::umb;
  return Format::unknown;
}

/// Told by the first line that says something.
Format format_of_content(const Source& source, std::string_view bytes) {
  constexpr std::size_t tar_magic = 257;
  if (bytes.size() > tar_magic && bytes.substr(tar_magic).starts_with("ustar")) return Format::umb;
  TextLines lines(source, bytes);
  while (lines.next_filled()) {
    const std::string_view line = trimmed(lines.line());
    if (line.front() == '{') return Format::json;
    if (line.front() == '@' || line.starts_with("//")) return Format::drn;
    if (line.front() == '#') continue;
    for (const std::string_view word : {"discount", "values", "states", "actions", "observations", "start"}) {
      if (line.starts_with(word)) return Format::cassandra;
    }
    if (std::count(line.begin(), line.end(), ',') == 4) return Format::csv;
    if (line == "mdp" || line == "dtmc" || parse_count(lines.words().front())) return Format::prism;
    break;
  }
  return Format::unknown;
}

template <class Scalar>
Model<Scalar> read_json(std::string_view text, const std::string& file, const ReadOptions& options) {
  const JsonDocument document(text, file);
  const JsonValue root = document.root().object("a model");
  if (root.find("format")) return internal::read_maximin_json<Scalar>(document, options);
  if (root.find("P")) return internal::read_gymnasium_json<Scalar>(document, options);
  root.fail("neither 'format' nor 'P', expected \"format\": \"maximin-mdp\" or a gymnasium table with 'P'");
}

}  // namespace

template <class Scalar>
Model<Scalar> load_model(const std::filesystem::path& path, const ReadOptions& options) {
  const std::string file = path.string();
  const TextSource source(file);
  std::string bytes = file_bytes(path, options.limits.bytes, "a readable model file");
  Format format = format_of_extension(lower_extension(path));
  if (is_gzip(bytes)) {
    bytes = gunzip(source, bytes, options.limits.bytes);
    if (format == Format::unknown) format = format_of_extension(lower_extension(path.stem()));
  }
  if (bytes.starts_with("\xfd"
                        "7zXZ"))
    source.fail(0, "packed by xz, expected it unpacked or packed by gzip");
  if (format == Format::unknown) format = format_of_content(source, bytes);
  switch (format) {
    case Format::json:
      return read_json<Scalar>(bytes, file, options);
    case Format::cassandra:
      return read_cassandra<Scalar>(bytes, file, options);
    case Format::prism:
      return read_prism_explicit_at<Scalar>(bytes, path, options);
    case Format::drn:
      return read_drn<Scalar>(bytes, file, options);
    case Format::csv:
      return read_csv<Scalar>(bytes, file, options);
    case Format::umb:
      return read_umb<Scalar>(bytes, file, options);
    case Format::unknown:
      break;
  }
  source.fail(0, "not a known model format, expected .json, .pomdp, .mdp, .tra, .drn, .csv or .umb");
}

template Model<double> load_model(const std::filesystem::path&, const ReadOptions&);
template Model<Rational> load_model(const std::filesystem::path&, const ReadOptions&);

}  // namespace maximin
