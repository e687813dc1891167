#pragma once

#include <ostream>
#include <string_view>

#include <maximin/models/files/read_options.hpp>
#include <maximin/models/model.hpp>

namespace maximin {

/// Reads comma-separated transitions, one per line:
///
///     idstatefrom,idaction,idstateto,probability,reward
///     0,0,1,0.5,2
///
/// Ids count from 0. The header may be absent, or name the five columns in another order. Rewards may differ by target
/// and are averaged to R(s,a). A state whose actions stop short of the others' repeats its first action, which leaves
/// V* as it is, and a note says so; a gap among its actions, or a state without any, is an error. The format has no
/// discount. Throws InputError, "FILE:LINE: what is wrong, what is expected".
template <class Scalar>
Model<Scalar> read_csv(std::string_view text, std::string_view file_name, const ReadOptions& options = {});

/// Writes the same, with a header. Names, discount, start and geometry have no place there.
template <class Scalar>
void write_csv(const Model<Scalar>& model, std::ostream& out);

}  // namespace maximin
