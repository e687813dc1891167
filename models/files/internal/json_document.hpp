#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <maximin/models/files/internal/number.hpp>
#include <maximin/models/files/internal/source.hpp>

namespace maximin::internal {

class JsonDocument;

/// One value of a JsonDocument. Cheap to copy; valid as long as the document.
class JsonValue {
 public:
  enum class Kind : std::uint8_t { null, boolean, number, string, array, object };

  /// Walks over the elements of an array or the members of an object, in file order.
  class Iterator {
   public:
    Iterator(const JsonDocument* document, std::uint32_t index) : document_(document), index_(index) {}
    JsonValue operator*() const { return JsonValue(document_, index_); }
    Iterator& operator++();
    bool operator!=(const Iterator& other) const { return index_ != other.index_; }

   private:
    const JsonDocument* document_;
    std::uint32_t index_;
  };

  JsonValue(const JsonDocument* document, std::uint32_t index) : document_(document), index_(index) {}

  Kind kind() const;
  /// The text of a number as it stands in the file, of a string unescaped, "true" or "false" of a boolean.
  std::string_view text() const;
  /// The name of an object's member.
  std::string_view key() const;
  /// Number of elements or members.
  std::size_t size() const;
  Iterator begin() const;
  Iterator end() const;

  /// The member of that name, if there.
  std::optional<JsonValue> find(std::string_view name) const;
  /// Position of this value in its document, for Source::fail.
  std::size_t at() const { return index_ + std::size_t{1}; }

  /// Throws InputError("FILE: $.path: MESSAGE").
  [[noreturn]] void fail(std::string_view message) const;

  /// The following fail unless the value is what the name says; `name` says what it means.
  JsonValue array(std::string_view name) const;
  JsonValue array(std::string_view name, std::size_t size) const;
  JsonValue object(std::string_view name) const;
  std::string_view string(std::string_view name) const;
  bool boolean(std::string_view name) const;
  /// An integer in [0, count).
  std::uint32_t index(std::string_view name, std::size_t count) const;
  /// A non-negative integer; anything beyond 2^64 - 1 is held there.
  std::uint64_t count(std::string_view name) const;
  /// A number, or a string that holds one, such as "1/3".
  template <class Scalar>
  Scalar number(std::string_view name) const;
  /// The member of that name; fails when it is missing, saying what is expected there.
  JsonValue member(std::string_view name, std::string_view expected) const;
  /// Fails at the first member whose name is not one of `known`, suggesting the nearest.
  void require_known_members(std::span<const std::string_view> known) const;

 private:
  const JsonDocument* document_;
  std::uint32_t index_;
};

/// A JSON text as a flat tree in file order. Numbers keep their text, so that no digit is lost before a scalar type is
/// chosen. Positions are values; places read "FILE: $.transitions[3][2]".
class JsonDocument : public Source {
 public:
  /// Throws InputError with file and line where the text is not JSON, has a repeated name in an object, or nests
  /// deeper than `max_depth`.
  JsonDocument(std::string_view text, std::string_view file);
  JsonDocument(const JsonDocument&) = delete;
  JsonDocument& operator=(const JsonDocument&) = delete;

  static constexpr std::size_t max_depth = 32;

  JsonValue root() const { return JsonValue(this, 0); }
  std::string place(std::size_t at) const override;
  std::string_view hint_on_sums() const override { return "; thirds can be written as fractions, \"1/3\""; }

 private:
  friend class JsonValue;
  friend class JsonValue::Iterator;
  class Builder;

  struct Node {
    JsonValue::Kind kind = JsonValue::Kind::null;
    std::uint32_t parent = 0;
    std::uint32_t end = 0;   // one past the last value inside
    std::uint32_t size = 0;  // direct children
    std::uint32_t key_length = 0;
    std::uint32_t text_length = 0;
    std::size_t key_begin = 0;
    std::size_t text_begin = 0;
  };

  std::string_view slice(std::size_t begin, std::uint32_t length) const {
    return std::string_view(texts_).substr(begin, length);
  }
  std::string path(std::uint32_t index) const;

  std::vector<Node> nodes_;
  std::string texts_;
};

template <class Scalar>
Scalar JsonValue::number(std::string_view name) const {
  if (kind() != Kind::number && kind() != Kind::string) {
    fail(fmt::format("{}: not a number, expected one such as 0.5 or \"1/3\"", name));
  }
  return read_number<Scalar>(*document_, at(), name, text());
}

/// `text` as a JSON string, with its quotes.
std::string json_string(std::string_view text);

}  // namespace maximin::internal
