#pragma once

#include <string_view>

#include <maximin/models/files/read_options.hpp>
#include <maximin/models/model.hpp>

namespace maximin {

/// Reads a table of gymnasium's toy-text environments (`env.unwrapped.P`) written as JSON:
///
///     {"name": ..., "nS": 16, "nA": 4, "initial_distribution": [...],
///      "P": [[[[probability, next state, reward, terminated], ...], ...], ...]}
///
/// `P` may also be an object of objects keyed "0", "1", ..., as Python dumps the dictionary. Entries of a row with the
/// same target are added up; rewards are averaged to R(s,a). `terminated` means that nothing follows: such entries lead
/// to an added state, named "terminal", that absorbs at reward 0, so that the value of every original state is the one
/// that gymnasium's semantics give it, even where the row of the entry's own target goes on (Taxi, CliffWalking).
/// The format has no discount. Throws InputError, "FILE: $.path: what is wrong, what is expected".
template <class Scalar>
Model<Scalar> read_gymnasium_json(std::string_view text, std::string_view file_name, const ReadOptions& options = {});

namespace internal {
class JsonDocument;

/// The same, from JSON already parsed.
template <class Scalar>
Model<Scalar> read_gymnasium_json(const JsonDocument& document, const ReadOptions& options);
}  // namespace internal

}  // namespace maximin
