// Unpacking: any bytes give an error or a text within the limit.
#include <maximin/models/files/internal/gzip.hpp>

#include "contract.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr std::size_t limit = std::size_t{1} << 16;
  const maximin::internal::TextSource source("model.gz");
  try {
    const std::string text = maximin::internal::gunzip(source, {reinterpret_cast<const char*>(data), size}, limit);
    if (text.size() > limit) maximin::fuzzing::broken("the limit holds", std::to_string(text.size()));
  } catch (const maximin::InputError&) {
  }
  return 0;
}
