#pragma once

#include <fmt/format.h>

#include <maximin/theory/error.hpp>

namespace maximin::deep {

/// Holds options to their ranges: throws InputError, "WHERE: NAME is VALUE, expected RANGE", where one is outside.
class RangeCheck {
 public:
  explicit RangeCheck(const char* where) : where_(where) {}
  void operator()(bool holds, const char* name, double value, const char* range) const {
    if (!holds) throw InputError(fmt::format("{}: {} is {}, expected {}", where_, name, value, range));
  }

 private:
  const char* where_;
};

}  // namespace maximin::deep
