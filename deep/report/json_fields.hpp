#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

/// Reading JSON that anybody may have written: every access says where it was and what was expected.
namespace maximin::deep {

/// An object of a JSON document with the way to it. All throw InputError, "FILE: blocks[0].cells[3].eps: what is wrong,
/// expected ...", on one line.
class Fields {
 public:
  /// Keeps a reference to `json`. `where` is the file; `path` the way from its root, empty at the root.
  Fields(const nlohmann::ordered_json& json, std::string where, std::string path = "");

  bool has(std::string_view key) const;
  const nlohmann::ordered_json& any(std::string_view key) const;
  std::string text(std::string_view key) const;
  double number(std::string_view key) const;  ///< finite
  std::uint64_t whole(std::string_view key) const;
  bool flag(std::string_view key) const;
  std::vector<double> numbers(std::string_view key) const;  ///< finite
  Fields object(std::string_view key) const;
  std::vector<Fields> objects(std::string_view key) const;
  /// The list of lists of `length` finite numbers.
  std::vector<std::vector<double>> tuples(std::string_view key, std::size_t length) const;

  void expect_schema(std::string_view schema, std::uint64_t version) const;
  [[noreturn]] void refuse(std::string_view key, std::string_view what) const;

 private:
  const nlohmann::ordered_json* json_;
  std::string where_;
  std::string path_;
};

/// The document in a file. Throws InputError where it cannot be read, is no JSON, or is nested deeper than 64 levels.
nlohmann::ordered_json read_json_file(const std::filesystem::path& path, std::string_view expected);

/// The document as a person reads it: an object's members on lines of their own, lists of numbers on one line. Broken
/// UTF-8 is replaced. Ends with a line break.
std::string readable_json(const nlohmann::ordered_json& json);

}  // namespace maximin::deep
