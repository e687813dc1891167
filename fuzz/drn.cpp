#include <maximin/models/files/drn.hpp>

#include "contract.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  maximin::ReadOptions options = maximin::fuzzing::small_limits();
  options.intervals = maximin::IntervalRows::nominal;
  maximin::fuzzing::check_reader([&] { return maximin::read_drn<double>(text, "model.drn", options); });
  return 0;
}
