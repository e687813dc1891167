#pragma once

#include <cstddef>
#include <initializer_list>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "checker.hpp"
#include "exact.hpp"

namespace maximin::checker {

[[noreturn]] void refuse(const std::string& path, const std::string& what_and_expected);

/// "path[i]"
std::string item(const std::string& path, std::size_t i);

/// Refuses what differs; of indices the first that does, `of_what` saying whose the expected ones are.
void expect_equal(const std::string& path, const Rational& found, const Rational& expected);
void expect_equal(const std::string& path, const std::vector<std::size_t>& found,
                  const std::vector<std::size_t>& expected, const std::string& of_what);

/// Parses JSON without repeated names and without numbers other than integers, nested as deep as a certificate is.
nlohmann::json parse_json(std::string_view text, const Limits& limits);

/// A place in a certificate: its JSON, and its path for the message when it is not what was expected.
class Node {
 public:
  Node(const nlohmann::json& json, std::string path, const Limits& limits)
      : json_(json), path_(std::move(path)), limits_(limits) {}

  const std::string& path() const { return path_; }
  const Limits& limits() const { return limits_; }
  bool is_null() const { return json_.is_null(); }
  bool has(const char* name) const { return json_.is_object() && json_.contains(name); }

  /// Refuses what is not an object with just these members.
  void expect_members(const std::vector<const char*>& names) const;
  Node member(const char* name) const { return {json_.at(name), path_ + "." + name, limits_}; }

  /// The items of an array; of one of that length.
  std::vector<Node> items() const;
  std::vector<Node> items(std::size_t length) const;

  std::size_t integer(std::size_t low, std::size_t high) const;
  std::size_t index(std::size_t end) const { return integer(0, end - 1); }
  std::vector<std::size_t> indices(std::size_t length, std::size_t end) const;
  bool boolean() const;
  Rational number() const;
  Table table(std::size_t length) const;                       ///< of that many numbers
  Table table_of(const std::vector<Rational>& numbers) const;  ///< of those that were read here

  /// The text that it is, as its position among those it may be.
  std::size_t one_of(std::initializer_list<const char*> texts) const;

 private:
  const nlohmann::json& json_;
  std::string path_;
  const Limits& limits_;
};

}  // namespace maximin::checker
