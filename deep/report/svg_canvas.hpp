#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <maximin/gridworld/box_union.hpp>
#include <maximin/gridworld/gridworld.hpp>

/// What the pictures of this folder are written with.
namespace maximin::deep {

/// A length or coordinate of a picture, to 0.1.
std::string svg_number(double v);

/// "x y".
std::string svg_place(double x, double y);

/// A text element; the text is plain, the attributes are not.
std::string svg_text(double x, double y, std::string_view text, std::string_view css_class = "",
                     std::string_view attributes = "");

/// How wide a text of this size is at most, in the same unit.
double svg_width(std::string_view text, double font_size);

/// Where the Gridworld lies in a picture: 40 units a cell, y upwards.
struct MapFrame {
  double left = 0, top = 0;
  static constexpr double unit = 40;
  static constexpr double extent = unit * gridworld::side;

  double x(double world) const { return left + unit * world; }
  double y(double world) const { return top + extent - unit * world; }
  std::string place(Point p) const { return svg_place(x(p.x), y(p.y)); }
};

/// Floor, walls, gold and bomb.
std::string svg_map(const MapFrame& frame);

/// The part of a box that is in the world, as a rectangle of this class; empty where there is none.
std::string svg_box(const MapFrame& frame, const Box& box, std::string_view css_class);

/// The part of a union of boxes that is in the world, as one area with its outline; empty where there is none.
std::string svg_area(const MapFrame& frame, const std::vector<Box>& boxes);

/// An arrow from a place along a move, 0.9 long; a cross where the move was cancelled.
std::string svg_move(const MapFrame& frame, Point from, Action action, bool cancelled);

}  // namespace maximin::deep
