#pragma once

#include <string>

namespace maximin::apps {

/// The drawing of a Graphviz text as SVG, by the program `dot`, which is looked for in PATH. Throws InputError, one
/// line that says what to install, when it is not there, and when it fails.
std::string svg_of(const std::string& dot_text);

}  // namespace maximin::apps
