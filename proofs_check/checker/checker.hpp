#pragma once

#include <cstddef>
#include <iosfwd>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

/// Verifies certificates (docs/certificate-format.md) by substitution alone, in exact arithmetic. It shares no code
/// with what writes them: the standard library, GMP and a JSON parser are all it stands on.
namespace maximin::checker {

/// Not a certificate: one line "$.path: what is false, expected what".
class Refused : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// What is looked at before anything is allocated or computed, so that no file takes the machine down.
struct Limits {
  std::size_t bytes = std::size_t{256} << 20;      ///< of the file
  std::size_t digits = 1'000'000;                  ///< of a number
  std::size_t states = 2'000;                      ///< of the model of an exact certificate
  std::size_t states_by_bounds = 20'000;           ///< of the model of a certificate by bounds
  std::size_t table_bits = std::size_t{1} << 30U;  ///< of a table over one denominator; Q_n grows with n
  double work = 3e10;                              ///< steps of all loops but those that go once over the file
};

/// One claim as it was verified.
struct ClaimVerdict {
  std::string claim;
  std::string verdict;  ///< "holds", "violated" or "undetermined"
  std::string left;     ///< the sides of the tightest instance, exact; empty where undetermined
  std::string right;
};

/// What a certificate that was verified proves.
struct Report {
  std::size_t states = 0;
  std::size_t actions = 0;
  std::size_t rounds = 0;  ///< N, the rounds that were replayed
  std::size_t period = 0;  ///< of the limit, or of its boxes; 0 where it was not decided
  bool bounds = false;     ///< a certificate by bounds, not an exact one
  bool boxes = false;      ///< the limit is enclosed, not an orbit
  std::vector<ClaimVerdict> claims;
  std::vector<std::string> left_out;  ///< claims that the certificate says nothing of

  /// What the claims come to: "violated" before "undetermined" before "holds".
  std::string_view worst() const;
};

/// Verifies one certificate. Throws Refused, and for no input anything else but std::bad_alloc.
Report check(std::string_view text, const Limits& limits = {});
Report check(std::istream& in, const Limits& limits = {});

}  // namespace maximin::checker
