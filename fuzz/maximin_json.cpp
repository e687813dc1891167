#include <maximin/models/files/maximin_json.hpp>

#include "contract.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  maximin::fuzzing::check_reader(
      [&] { return maximin::read_maximin_json<double>(text, "model.json", maximin::fuzzing::small_limits()); });
  return 0;
}
