#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace maximin::internal {

/// Rows of numbers, mostly zero, that are written over and over: the last value set counts.
template <class Scalar>
class SparseRows {
 public:
  using Entry = std::pair<std::int32_t, Scalar>;

  SparseRows(std::size_t rows, std::size_t width) : width_(width), rows_(rows), lines_(rows) {}

  /// Remembers where a row was last written.
  void written_at(std::size_t row, std::size_t line) { lines_[row] = static_cast<std::uint32_t>(line); }
  /// The line where a row was last written, 0 for none.
  std::size_t line(std::size_t row) const { return lines_[row]; }

  /// Sets one number of a row.
  void set(std::size_t row, std::size_t column, const Scalar& value) {
    std::vector<Entry>& entries = rows_[row];
    entries.emplace_back(static_cast<std::int32_t>(column), value);
    ++stored_;
    if (entries.size() > 2 * width_ + 8) compact(row);
  }

  /// Sets all of a row to zero.
  void clear(std::size_t row) {
    stored_ -= rows_[row].size();
    rows_[row].clear();
  }

  /// The numbers of a row that are not zero, columns ascending.
  const std::vector<Entry>& row(std::size_t row) {
    compact(row);
    return rows_[row];
  }

  /// How many numbers are held, overwritten ones included.
  std::size_t stored() const { return stored_; }
  std::size_t width() const { return width_; }

 private:
  void compact(std::size_t row) {
    std::vector<Entry>& entries = rows_[row];
    const std::size_t before = entries.size();
    if (is_compact(entries)) return;
    std::stable_sort(entries.begin(), entries.end(), [](const Entry& x, const Entry& y) { return x.first < y.first; });
    std::size_t kept = 0;
    for (std::size_t i = 0; i < entries.size(); ++i) {
      const bool last_of_column = i + 1 == entries.size() || entries[i + 1].first != entries[i].first;
      if (!last_of_column || entries[i].second == Scalar(0)) continue;
      if (kept != i) entries[kept] = std::move(entries[i]);
      ++kept;
    }
    entries.resize(kept);
    stored_ -= before - kept;
  }

  static bool is_compact(const std::vector<Entry>& entries) {
    for (std::size_t i = 0; i < entries.size(); ++i) {
      if (entries[i].second == Scalar(0) || (i > 0 && entries[i].first <= entries[i - 1].first)) return false;
    }
    return true;
  }

  std::size_t width_;
  std::vector<std::vector<Entry>> rows_;
  std::vector<std::uint32_t> lines_;
  std::size_t stored_ = 0;
};

}  // namespace maximin::internal
