#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include <maximin/theory/perturbation.hpp>
#include <maximin/theory/types.hpp>

namespace maximin::apps {

/// JSON whose keys stay in the order in which they were set.
using Json = nlohmann::ordered_json;

/// The document, each key of the top level on a line of its own, ended by a line break. Doubles are written with as
/// many digits as reading them back exactly takes; what is not finite becomes null.
std::string json_text(const Json& document);

/// A list of numbers, one per state.
Json to_json(const Values<double>& values);

/// A list of rows, one per state.
Json to_json(const QTable<double>& table);

}  // namespace maximin::apps
