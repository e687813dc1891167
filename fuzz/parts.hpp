#pragma once

#include <string_view>
#include <vector>

namespace maximin::fuzzing {

/// One input that stands for several files: what lies between lines of "----".
inline std::vector<std::string_view> parts(std::string_view input) {
  constexpr std::string_view line = "----\n";
  std::vector<std::string_view> found;
  while (true) {
    const auto end = input.find(line);
    found.push_back(input.substr(0, end));
    if (end == input.npos) return found;
    input.remove_prefix(end + line.size());
  }
}

}  // namespace maximin::fuzzing
