#pragma once

#include <string>
#include <string_view>
#include <vector>

#include <maximin/deep/report/trace.hpp>

/// Pictures of episodes on the map, as SVG for a page: true path, what was shown, what was held possible. Colours of
/// their own for light, dark and paper; every kind of mark has a shape of its own besides.
namespace maximin::deep {

/// Style sheet of the pictures: to be given once in a page, and in every SVG file of its own.
std::string_view map_style();

struct PathPictureOptions {
  std::vector<long> belief_at;  ///< steps whose belief is drawn; those without are skipped
  bool shown = true;            ///< the shown positions, tied to the true ones
  std::string title;            ///< above the picture; empty: attack and eps
};

/// Evenly spread steps, `count` at most, from 0, among those that have a belief.
std::vector<long> moments(const EpisodeTrace& trace, int count);

/// The whole episode in one picture.
std::string path_picture(const EpisodeTrace& trace, const PathPictureOptions& options);

/// One moment: path so far, where the agent is, what may be shown, what is shown, what is held possible, what it does.
std::string moment_picture(const EpisodeTrace& trace, long step);

/// What the marks are, as HTML.
std::string map_legend();

/// A picture as a file of its own: the SVG element with its name space and the style inside.
std::string standalone_svg(std::string_view svg);

}  // namespace maximin::deep
