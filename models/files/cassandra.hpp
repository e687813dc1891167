#pragma once

#include <ostream>
#include <string_view>

#include <maximin/models/files/read_options.hpp>
#include <maximin/models/model.hpp>

namespace maximin {

/// Reads Cassandra's format, MDPs and the MDP part of POMDPs, by the grammar of pomdp-solve: names, indices and
/// wildcards; entries, rows and matrices; `uniform`, `identity`, `reset`; later lines override earlier ones; comments
/// anywhere. Rewards R(a, s, s', o) are averaged over s' and o. `values: cost` turns the sign. Rows that miss 1 by at
/// most 1e-5, as pomdp-solve allows, are scaled to sum to 1 and a note says how many and how far. Taken with a note:
/// a missing discount, and `rewards` or `costs` for `reward` and `cost`. Throws InputError, "FILE:LINE: what is wrong,
/// what is expected".
template <class Scalar>
Model<Scalar> read_cassandra(std::string_view text, std::string_view file_name, const ReadOptions& options = {});

/// Writes the same, as an MDP. Geometry has no place there; names that the grammar has no room for are left out.
template <class Scalar>
void write_cassandra(const Model<Scalar>& model, std::ostream& out);

}  // namespace maximin
