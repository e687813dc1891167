#pragma once

#include <string>

#include <maximin/deep/report/trace.hpp>

namespace maximin::deep {

struct AnimationOptions {
  double seconds_per_step = 0.45;  ///< positive
  double hold_seconds = 2.5;       ///< the end stands still so long before the episode begins again
  bool belief = true;
};

/// The episode as an SVG file that moves by itself, again and again: true position with its path, what may be shown and
/// what is shown, what is held possible, time, move and return, and a legend. No script; opens in any browser, and as
/// an image of a page; light and dark. A viewer that cannot animate shows the first moment. Throws InputError as
/// `validate`, and where the trace has no step.
std::string animated_svg(const EpisodeTrace& trace, const AnimationOptions& options = {});

}  // namespace maximin::deep
