#pragma once

#include <ostream>
#include <string_view>

#include <maximin/models/files/read_options.hpp>
#include <maximin/models/model.hpp>

namespace maximin {

/// Reads the project's own format (docs/model-format.md): JSON with "format": "maximin-mdp", "version": 1.
/// Throws InputError, "FILE: $.path: what is wrong, what is expected".
template <class Scalar>
Model<Scalar> read_maximin_json(std::string_view text, std::string_view file_name, const ReadOptions& options = {});

/// Writes the project's own format. Reading it back gives an equal model, to the last bit: doubles are written with as
/// many digits as that takes (at most 17), exact scalars as fractions.
template <class Scalar>
void write_maximin_json(const Model<Scalar>& model, std::ostream& out);

namespace internal {
class JsonDocument;

/// The same, from JSON already parsed.
template <class Scalar>
Model<Scalar> read_maximin_json(const JsonDocument& document, const ReadOptions& options);
}  // namespace internal

}  // namespace maximin
