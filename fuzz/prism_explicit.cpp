// The input is a .tra file and, after lines of "----", a .srew, a .trew, a .lab and a .sta file; empty ones are absent.
#include <maximin/models/files/prism_explicit.hpp>

#include "contract.hpp"
#include "parts.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto parts = maximin::fuzzing::parts({reinterpret_cast<const char*>(data), size});
  const auto companion = [&](std::size_t i, const char* name) -> std::optional<maximin::NamedText> {
    if (i >= parts.size() || parts[i].empty()) return std::nullopt;
    return maximin::NamedText{std::string(parts[i]), name};
  };
  const maximin::PrismCompanions companions{companion(1, "model.srew"), companion(2, "model.trew"),
                                            companion(3, "model.lab"), companion(4, "model.sta")};
  maximin::ReadOptions options = maximin::fuzzing::small_limits();
  options.intervals = maximin::IntervalRows::nominal;
  maximin::fuzzing::check_reader(
      [&] { return maximin::read_prism_explicit<double>(parts[0], "model.tra", options, companions); });
  return 0;
}
