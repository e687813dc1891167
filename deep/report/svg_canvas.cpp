#include <maximin/deep/report/svg_canvas.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include <fmt/format.h>

#include <maximin/proofs_check/report/html_text.hpp>

namespace maximin::deep {
namespace {

constexpr int side = gridworld::side;

/// A star of five points around a place.
std::string svg_star(double x, double y, double radius) {
  std::string points;
  for (int k = 0; k < 10; ++k) {
    const double r = k % 2 == 0 ? radius : 0.42 * radius;
    const double angle = 3.14159265358979 * k / 5;
    points += (k == 0 ? "" : " ") + svg_place(x + r * std::sin(angle), y - r * std::cos(angle));
  }
  return fmt::format("<polygon class=\"star\" points=\"{}\"/>\n", points);
}

/// A round bomb with its fuse.
std::string svg_bomb(double x, double y) {
  return fmt::format(
      "<circle class=\"bomb\" cx=\"{0}\" cy=\"{1}\" r=\"9.5\"/><path class=\"fuse\" d=\"M{2}q4 -8 9 -5\"/>"
      "<circle class=\"spark\" cx=\"{3}\" cy=\"{4}\" r=\"2.6\"/>\n",
      svg_number(x - 2), svg_number(y + 3), svg_place(x + 3, y - 5), svg_number(x + 13), svg_number(y - 10));
}

std::string svg_cell(const MapFrame& f, int i, int j, std::string_view css_class) {
  return fmt::format("<rect class=\"{}\" x=\"{}\" y=\"{}\" width=\"40\" height=\"40\"/>\n", css_class,
                     svg_number(f.x(i)), svg_number(f.y(j + 1)));
}

/// An edge of a box on a line, and on which side of the line the box lies.
struct Edge {
  double from, to;
  int inward;
};
using EdgesByLine = std::map<double, std::vector<Edge>>;

/// The parts of a line's edges that have the area on one side alone, joined where they touch.
std::vector<std::pair<double, double>> open_parts(const std::vector<Edge>& edges) {
  std::map<double, int> change;  // of the balance of sides, at a place on the line
  for (const Edge& e : edges) {
    change[e.from] += e.inward;
    change[e.to] -= e.inward;
  }
  std::vector<std::pair<double, double>> parts;
  int balance = 0;
  double from = 0;
  for (const auto& [at, by] : change) {
    if (balance != 0 && !parts.empty() && parts.back().second == from) {
      parts.back().second = at;
    } else if (balance != 0) {
      parts.emplace_back(from, at);
    }
    balance += by;
    from = at;
  }
  return parts;
}

/// The outline of disjoint boxes: edges that two of them share are inside.
std::string outline(const MapFrame& f, const std::vector<Box>& boxes) {
  EdgesByLine upright, level;
  for (const Box& b : boxes) {
    upright[b.x_low].push_back({b.y_low, b.y_high, 1});
    upright[b.x_high].push_back({b.y_low, b.y_high, -1});
    level[b.y_low].push_back({b.x_low, b.x_high, 1});
    level[b.y_high].push_back({b.x_low, b.x_high, -1});
  }
  std::string d;
  for (const auto& [x, edges] : upright) {
    for (const auto& [a, b] : open_parts(edges)) d += fmt::format("M{}V{}", f.place({x, a}), svg_number(f.y(b)));
  }
  for (const auto& [y, edges] : level) {
    for (const auto& [a, b] : open_parts(edges)) d += fmt::format("M{}H{}", f.place({a, y}), svg_number(f.x(b)));
  }
  return d;
}

}  // namespace

std::string svg_number(double v) {
  const double rounded = std::round(v * 10) / 10;
  return fmt::format("{:.6g}", rounded == 0 ? 0.0 : rounded);
}

std::string svg_place(double x, double y) {
  return svg_number(x) + ' ' + svg_number(y);
}

std::string svg_text(double x, double y, std::string_view text, std::string_view css_class,
                     std::string_view attributes) {
  return fmt::format("<text x=\"{}\" y=\"{}\"{}{}>{}</text>\n", svg_number(x), svg_number(y),
                     css_class.empty() ? "" : fmt::format(" class=\"{}\"", css_class),
                     attributes.empty() ? "" : fmt::format(" {}", attributes), report::escape(text));
}

double svg_width(std::string_view text, double font_size) {
  const auto letters =
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; });
  return 0.6 * font_size * static_cast<double>(letters);
}

std::string svg_map(const MapFrame& f) {
  std::string svg = fmt::format("<rect class=\"floor\" x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/>\n",
                                svg_number(f.left), svg_number(f.top), f.extent, f.extent);
  std::string walls, lines;
  for (int k = 1; k < side; ++k) {
    lines += fmt::format("M{}V{}M{}H{}", svg_place(f.x(k), f.top), svg_number(f.top + f.extent),
                         svg_place(f.left, f.y(k)), svg_number(f.left + f.extent));
  }
  for (int j = 0; j < side; ++j) {
    for (int i = 0; i < side; ++i) {
      if (gridworld::cell(i, j) == gridworld::Cell::wall) {
        walls += fmt::format("M{}h40v-40h-40z", svg_place(f.x(i), f.y(j)));
      } else if (gridworld::cell(i, j) == gridworld::Cell::gold) {
        svg += svg_cell(f, i, j, "gold") + svg_star(f.x(i + 0.5), f.y(j + 0.5), 14);
      } else if (gridworld::cell(i, j) == gridworld::Cell::bomb) {
        svg += svg_cell(f, i, j, "danger") + svg_bomb(f.x(i + 0.5), f.y(j + 0.5));
      }
    }
  }
  svg += fmt::format("<path class=\"lines\" d=\"{}\"/>\n<path class=\"wall\" d=\"{}\"/>\n", lines, walls);
  return svg + fmt::format("<rect class=\"edge\" x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/>\n", svg_number(f.left),
                           svg_number(f.top), f.extent, f.extent);
}

std::string svg_box(const MapFrame& f, const Box& box, std::string_view css_class) {
  const Box b = meet(box, {0, side, 0, side});
  if (b.empty()) return "";
  return fmt::format("<rect class=\"{}\" x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/>\n", css_class,
                     svg_number(f.x(b.x_low)), svg_number(f.y(b.y_high)),
                     svg_number(std::max(0.6, f.unit * (b.x_high - b.x_low))),
                     svg_number(std::max(0.6, f.unit * (b.y_high - b.y_low))));
}

std::string svg_area(const MapFrame& f, const std::vector<Box>& boxes) {
  const std::vector<Box> disjoint = BoxUnion(boxes).meet({0, side, 0, side}).boxes();
  if (disjoint.empty()) return "";
  std::string d;
  for (const Box& b : disjoint) {
    d += fmt::format("M{}H{}V{}H{}z", f.place({b.x_low, b.y_low}), svg_number(f.x(b.x_high)), svg_number(f.y(b.y_high)),
                     svg_number(f.x(b.x_low)));
  }
  return fmt::format("<path class=\"area\" d=\"{}\"/><path class=\"area-edge\" d=\"{}\"/>\n", d, outline(f, disjoint));
}

std::string svg_move(const MapFrame& f, Point from, Action action, bool cancelled) {
  const auto& move = gridworld::moves[static_cast<std::size_t>(action)];
  const double dx = 2 * move.dx, dy = -2 * move.dy;  // of length 1 in the picture's direction of y
  const double x = f.x(from.x), y = f.y(from.y), tip_x = x + 30 * dx, tip_y = y + 30 * dy;
  const auto back = [&](double along, double across) {
    return svg_place(tip_x - along * dx - across * dy, tip_y - along * dy + across * dx);
  };
  std::string svg = fmt::format("<path class=\"move{}\" d=\"M{}L{}", cancelled ? " cancelled" : "",
                                svg_place(x + 11 * dx, y + 11 * dy), svg_place(tip_x, tip_y));
  svg += cancelled ? fmt::format("M{}L{}", back(0, -7), back(0, 7))
                   : fmt::format("M{}L{}L{}", back(7, -6), svg_place(tip_x, tip_y), back(7, 6));
  return svg + "\"/>\n";
}

}  // namespace maximin::deep
