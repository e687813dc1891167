#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include <maximin/proofs_check/checker/checker.hpp>

/// Either the checker refuses with one line that begins with a path, or every claim has a verdict. Anything else
/// (another exception, a crash, a hang, a leak) is a finding.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto expect = [](bool kept, const char* promise, std::string_view found) {
    if (kept) return;
    std::fprintf(stderr, "promise broken: %s\n%.*s\n", promise, static_cast<int>(found.size()), found.data());
    std::abort();
  };
  maximin::checker::Limits limits;
  limits.bytes = std::size_t{1} << 20U;
  limits.states = limits.states_by_bounds = 100;
  limits.work = 1e8;
  limits.table_bits = std::size_t{1} << 16U;
  try {
    const auto report = maximin::checker::check({reinterpret_cast<const char*>(data), size}, limits);
    for (const auto& claim : report.claims) {
      const bool known = claim.verdict == "holds" || claim.verdict == "violated";
      expect(known || claim.verdict == "undetermined", "every claim has a verdict", claim.verdict);
      expect(known != (claim.left.empty() || claim.right.empty()), "sides are those of a verdict", claim.claim);
    }
  } catch (const maximin::checker::Refused& refused) {
    const std::string_view line = refused.what();
    expect(line.substr(0, 1) == "$" && line.find('\n') == line.npos, "a refusal is a line with a path", line);
  }
  return 0;
}
