#pragma once

#include <string_view>

namespace maximin::report {

/// Style sheet of a report: colours for light, dark and paper, text large enough to project.
std::string_view page_style();

/// Style sheet of the pictures in it. Uses the colours that `page_style` names.
std::string_view plot_style();

}  // namespace maximin::report
