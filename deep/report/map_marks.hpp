#pragma once

#include <string>

#include <maximin/deep/report/svg_canvas.hpp>
#include <maximin/deep/report/trace.hpp>

/// Single marks of a picture on the map, which still and moving pictures share.
namespace maximin::deep {

/// Boxes as areas, points as discs whose area shows their weight.
std::string belief_marks(const MapFrame& frame, const TraceBelief& belief);

/// What may be shown; nothing where eps is 0.
std::string ball_mark(const MapFrame& frame, Point truth, double eps);

/// Where the agent is.
std::string truth_mark(const MapFrame& frame, Point at);

/// What is shown, tied to where the agent is.
std::string shown_mark(const MapFrame& frame, Point truth, Point shown);

}  // namespace maximin::deep
