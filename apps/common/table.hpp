#pragma once

#include <string>
#include <vector>

namespace maximin::apps {

/// A table for people: columns aligned, two spaces apart, titles on top.
///
///     Table table;
///     table.column("state", Align::left).column("V*", Align::point);
///     table.row({"start", number(1.5)});
///     print(table.text());
enum class Align {
  left,
  right,
  point,  ///< on the decimal point
};

class Table {
 public:
  Table& column(std::string title, Align align = Align::right);
  /// Adds a row with one cell per column; missing cells are empty.
  Table& row(std::vector<std::string> cells);

  /// The table, one line per row. Rows after the first `max_rows` are left out and counted in a last line that says
  /// how to see them.
  std::string text(std::size_t max_rows = static_cast<std::size_t>(-1)) const;

  std::size_t rows() const { return rows_.size(); }

 private:
  struct Column {
    std::string title;
    Align align;
  };
  std::vector<Column> columns_;
  std::vector<std::vector<std::string>> rows_;
};

/// A number for people: six significant digits; "inf", "-inf", "nan" as such, and never "-0".
std::string number(double x);

/// A number known to within `error`: as 0 where it may be 0, else as number(x).
std::string number(double x, double error);

/// A certified error for people: two significant digits, rounded up so that it stays true; 0 as "0".
std::string error_number(double x);

/// Width of UTF-8 text in characters.
std::size_t width(const std::string& text);

}  // namespace maximin::apps
