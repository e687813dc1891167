#pragma once

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <nlohmann/json.hpp>

#include <maximin/models/files/json_text.hpp>
#include <maximin/models/nearest_name.hpp>
#include <maximin/theory/error.hpp>

/// Structs of options as JSON objects. A struct's fields are listed once, to be written and to be read, by
///
///     template <class Visitor> void visit_fields(Options& o, Visitor& visit) { visit("name", o.name); ... }
///
/// in namespace maximin::deep (`visit.rare` for a flag that is written only where it is set); what an enumeration's
/// values are called by `words_of(Enumeration)`, an array of texts.
namespace maximin::deep {

struct AnyVisitor {
  template <class T>
  void operator()(const char*, T&);
  void rare(const char*, bool&);
};

template <class T>
concept HasFields = requires(T& options, AnyVisitor& visit) {
  visit_fields(options, visit);
};

template <class T>
struct IsOptional : std::false_type {};
template <class T>
struct IsOptional<std::optional<T>> : std::true_type {};

class FieldWriter {
 public:
  template <class T>
  void operator()(const char* name, T& field) {
    json_[name] = json_of(field);
  }

  void rare(const char* name, bool& flag) {
    if (flag) (*this)(name, flag);
  }

  /// All fields of these options, in order.
  template <class T>
  static nlohmann::ordered_json json_of(T& field) {
    if constexpr (HasFields<T>) {
      FieldWriter inner;
      visit_fields(field, inner);
      return inner.json_;
    } else if constexpr (IsOptional<T>::value) {
      return field ? json_of(*field) : nlohmann::ordered_json();
    } else if constexpr (std::is_enum_v<T>) {
      return words_of(field).at(static_cast<std::size_t>(field));
    } else {
      return field;
    }
  }

 private:
  nlohmann::ordered_json json_ = nlohmann::ordered_json::object();
};

/// Takes over the fields that an object names and leaves the others as they are. Throws InputError, "WHERE: FIELD: what
/// is wrong, expected ...", on a field that there is none of or that is of another type. Ranges are for others to
/// check.
class FieldReader {
 public:
  template <class T>
  static void read(T& options, const nlohmann::ordered_json& json, const std::string& where) {
    if (!json.is_object()) throw InputError(where + ": no object, expected {\"NAME\": VALUE, ...}");
    FieldReader reader(json, where);
    visit_fields(options, reader);
    reader.refuse_unknown();
  }

  template <class T>
  void operator()(const char* name, T& field) {
    names_.emplace_back(name);
    const auto found = json_.find(name);
    if (found != json_.end()) take(field, *found, where_ + ": " + name);
  }
  void rare(const char* name, bool& flag) { (*this)(name, flag); }

 private:
  FieldReader(const nlohmann::ordered_json& json, std::string where) : json_(json), where_(std::move(where)) {}

  template <class T>
  static void take(T& field, const nlohmann::ordered_json& json, const std::string& here) {
    if constexpr (HasFields<T>) {
      read(field, json, here);
    } else if constexpr (IsOptional<T>::value) {
      if (json.is_null()) {
        field.reset();
      } else {
        take(field.emplace(), json, here);
      }
    } else if constexpr (std::is_enum_v<T>) {
      const auto words = words_of(field);
      const auto found = std::find(words.begin(), words.end(), json);
      if (found == words.end()) {
        throw InputError(fmt::format("{}: {}, expected {}", here, excerpt(json), fmt::join(words, ", ")));
      }
      field = static_cast<T>(found - words.begin());
    } else {
      if (!fits<T>(json)) throw InputError(fmt::format("{}: {}, expected {}", here, excerpt(json), kind_of<T>()));
      field = json.get<T>();
    }
  }

  template <class T>
  static const char* kind_of() {
    if constexpr (std::is_same_v<T, bool>) return "true or false";
    if constexpr (std::is_integral_v<T>) return "a whole number";
    if constexpr (std::is_floating_point_v<T>) return "a number";
    if constexpr (std::is_same_v<T, std::string>) return "a text";
    return "a list of whole numbers from 1 to 65536";
  }

  template <class T>
  static bool fits(const nlohmann::ordered_json& value) {
    if constexpr (std::is_same_v<T, bool>) return value.is_boolean();
    if constexpr (std::is_integral_v<T> && !std::is_same_v<T, bool>) {
      if (value.is_number_unsigned()) return std::in_range<T>(value.get<std::uint64_t>());
      return value.is_number_integer() && std::in_range<T>(value.get<std::int64_t>());
    }
    if constexpr (std::is_floating_point_v<T>) return value.is_number();
    if constexpr (std::is_same_v<T, std::string>) return value.is_string();
    return value.is_array() && std::all_of(value.begin(), value.end(), [](const auto& v) {
             return v.is_number_integer() && v.template get<long>() > 0 && v.template get<long>() <= 65536;
           });
  }

  void refuse_unknown() const {
    for (const auto& item : json_.items()) {
      if (std::find(names_.begin(), names_.end(), item.key()) != names_.end()) continue;
      throw InputError(fmt::format("{}: {}: no such field, expected {}", where_, excerpt(item.key()),
                                   nearest_or_all(item.key(), names_)));
    }
  }

  const nlohmann::ordered_json& json_;
  std::string where_;
  std::vector<std::string> names_;
};

}  // namespace maximin::deep
