#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <maximin/proofs_check/report/svg_axis.hpp>

/// Pictures as SVG inside an HTML page: no script, no network, colours from `plot_style` and `page_style`, so that they
/// follow the light or dark scheme of the reader. Lengths are in user units; the page stretches a picture to the width
/// it has. Coordinates are rounded to 0.1. All text given here is plain; it is escaped on the way out.
namespace maximin::report {

/// What a colour stands for. Every role also has a shape or a dash of its own, for those who see no colours.
enum class Role {
  plain,        ///< not the point of the picture: grey
  highlighted,  ///< what to look at: blue
  violated,     ///< red, and drawn as a cross
};

struct Frame {
  double width = 400;
  double height = 330;
  std::string title;        ///< one line above the picture; may be empty
  std::string description;  ///< for a reader who cannot see it
  std::string x_label;
  std::string y_label;
};

/// A place, and what is said when the pointer rests there.
struct Mark {
  double x = 0;
  double y = 0;
  std::string hover;
};

/// Axes and what is drawn between them, in the order of the calls.
class Plot {
 public:
  Plot(const Frame& frame, Axis x, Axis y);

  /// Tints everything left of x, with a word above it.
  void region_left_of(double x, std::string_view word);
  /// A line across the picture where x has this value, with a word above it.
  void vertical(double x, std::string_view word);
  /// A line across the picture where y has this value, with a word on it.
  void horizontal(double y, std::string_view word);
  /// The line y = x, where both axes show it, with words along it.
  void diagonal(std::string_view words);

  /// One mark each. On a logarithmic axis with a zero band a y without logarithm becomes a short upright stroke in the
  /// band; violated marks are crosses, all others discs.
  void marks(const std::vector<Mark>& marks, Role role);
  /// The same as a single path without hover text: an eighth of the bytes.
  void specks(const std::vector<Mark>& marks, Role role);
  /// Straight lines through the points. `series` picks colour and dash, from 0.
  void line(const std::vector<Mark>& points, std::size_t series);
  /// The area between two lines that have their x in common, in the colour of `series`. As long as each other.
  void band(const std::vector<Mark>& low, const std::vector<Mark>& high, std::size_t series);
  /// A rising staircase: from each point level to the next x, then upright.
  void stairs(const std::vector<Mark>& points, std::size_t series);

  std::string svg() const;

 private:
  double px(double x) const;
  double py(double y) const;
  bool in_zero_band(double y) const;
  void draw_axes();

  Frame frame_;
  Axis x_, y_;
  double left_, right_, top_, bottom_;  ///< edges of the plotting area
  std::string body_;
  std::string words_;  ///< drawn last, so that no point covers them
};

struct Bar {
  std::string label;
  double value = 0;
  std::string text;  ///< written at the end of the bar
  Role role = Role::highlighted;
};

/// Horizontal bars from 0, each under its label; `full` is the value of a bar as wide as the picture.
std::string bar_chart(const Frame& frame, const std::vector<Bar>& bars, double full);

/// One row of `interval_chart`: a span with a dot at its left number and a bar at its right number.
struct Interval {
  std::string label;
  double left = 0;
  double right = 0;
  std::string text;  ///< after the label
  Role role = Role::highlighted;
};

/// Rows of two numbers on one common axis, with a line at `rule` when it is not NaN.
std::string interval_chart(const Frame& frame, const std::vector<Interval>& rows, const Axis& x, double rule,
                           std::string_view rule_word);

/// A cell of a heat map: `part` of `whole`; nothing is drawn where whole is 0.
struct Cell {
  long part = 0;
  long whole = 0;
};

/// Labels at the edges of the columns or rows (one more than there are) or in the middle of each.
struct Bins {
  std::vector<std::string> labels;
  bool at_edges = true;

  std::size_t size() const { return at_edges ? labels.size() - 1 : labels.size(); }
};

/// Shares as shades, with the percentage written in each cell. cells[row][column], row 0 at the bottom.
std::string heat_map(const Frame& frame, const Bins& columns, const Bins& rows,
                     const std::vector<std::vector<Cell>>& cells);

/// A list of what the lines of `Plot::line` and `Plot::stairs` are, as HTML.
std::string line_legend(const std::vector<std::string>& names);

/// Every k-th of n things, so that at most `cap` are left: their indices, always with the first, evenly spread.
std::vector<std::size_t> thinned(std::size_t n, std::size_t cap);

}  // namespace maximin::report
