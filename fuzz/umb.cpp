// The input is either an archive, or its entries: parts between lines of "----", each a line with the path and then the
// content. Entries are packed here, so that a change of one does not founder on a checksum.
#include <maximin/models/files/umb.hpp>

#include <utility>
#include <vector>

#include "contract.hpp"
#include "parts.hpp"
#include "tar_writing.hpp"

namespace {

std::string packed(std::string_view input) {
  std::vector<std::pair<std::string, std::string>> files;
  for (const std::string_view part : maximin::fuzzing::parts(input)) {
    const auto line = part.find('\n');
    if (line == part.npos || line > 99) continue;
    std::string_view content = part.substr(line + 1);
    if (!content.empty() && content.back() == '\n') content.remove_suffix(1);
    files.emplace_back(part.substr(0, line), content);
  }
  return maximin::testing::tar(files);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view input(reinterpret_cast<const char*>(data), size);
  const std::string bytes = input.starts_with("index.json\n") ? packed(input) : std::string(input);
  maximin::ReadOptions options = maximin::fuzzing::small_limits();
  options.intervals = maximin::IntervalRows::nominal;
  maximin::fuzzing::check_reader([&] { return maximin::read_umb<double>(bytes, "model.umb", options); });
  return 0;
}
