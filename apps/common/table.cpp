#include <maximin/apps/common/table.hpp>

#include <fmt/format.h>
#include <algorithm>
#include <cmath>

#include <maximin/apps/common/program.hpp>

namespace maximin::apps {

namespace {

/// Characters before the decimal point, or before the exponent or the end where there is no point.
std::size_t before_point(const std::string& cell) {
  return std::min(cell.find_first_of(".e"), cell.size());
}

/// Where a column starts and ends.
struct Layout {
  std::size_t before = 0;  ///< characters before the point, over all cells
  std::size_t after = 0;   ///< characters from the point on
  std::size_t width = 0;
};

std::string pad(const std::string& cell, Align align, const Layout& layout) {
  const auto spaces = [](std::size_t n) { return std::string(n, ' '); };
  const std::size_t own = width(cell);
  if (align == Align::left) return cell + spaces(layout.width - own);
  if (align == Align::right) return spaces(layout.width - own) + cell;
  const std::size_t left = layout.width - layout.before - layout.after + layout.before - before_point(cell);
  return spaces(left) + cell + spaces(layout.width - left - own);
}

}  // namespace

Table& Table::column(std::string title, Align align) {
  columns_.push_back({std::move(title), align});
  return *this;
}

Table& Table::row(std::vector<std::string> cells) {
  cells.resize(columns_.size());
  for (std::string& cell : cells) cell = printable(cell);
  rows_.push_back(std::move(cells));
  return *this;
}

std::string Table::text(std::size_t max_rows) const {
  const std::size_t shown = std::min(max_rows, rows_.size());
  std::vector<Layout> layouts(columns_.size());
  for (std::size_t c = 0; c < columns_.size(); ++c) {
    Layout& layout = layouts[c];
    for (std::size_t r = 0; r < shown; ++r) {
      const std::string& cell = rows_[r][c];
      const std::size_t before = before_point(cell);
      layout.before = std::max(layout.before, before);
      layout.after = std::max(layout.after, width(cell) - std::min(before, width(cell)));
      layout.width = std::max(layout.width, width(cell));
    }
    if (columns_[c].align == Align::point) layout.width = std::max(layout.width, layout.before + layout.after);
    layout.width = std::max(layout.width, width(columns_[c].title));
  }
  std::string out;
  const auto line = [&](auto cell_of) {
    std::string row;
    for (std::size_t c = 0; c < columns_.size(); ++c) row += (c == 0 ? "" : "  ") + cell_of(c);
    row.erase(row.find_last_not_of(' ') + 1);
    out += row + '\n';
  };
  line([&](std::size_t c) {
    const Align align = columns_[c].align == Align::left ? Align::left : Align::right;
    return pad(columns_[c].title, align, layouts[c]);
  });
  for (std::size_t r = 0; r < shown; ++r) {
    line([&](std::size_t c) { return pad(rows_[r][c], columns_[c].align, layouts[c]); });
  }
  if (shown < rows_.size()) out += fmt::format("... and {} more rows; --all shows them\n", rows_.size() - shown);
  return out;
}

std::string number(double x) {
  return fmt::format("{:.6g}", x == 0 ? 0.0 : x);
}

std::string number(double x, double error) {
  return number(std::abs(x) <= error ? 0 : x);
}

std::string error_number(double x) {
  if (!(x > 0) || !std::isfinite(x)) return number(x);
  const double unit = std::pow(10.0, std::floor(std::log10(x)) - 1);
  return fmt::format("{:.1e}", std::ceil(x / unit) * unit);
}

std::size_t width(const std::string& text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

}  // namespace maximin::apps
