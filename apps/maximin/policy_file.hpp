#pragma once

#include <string>
#include <vector>

#include <maximin/models/model.hpp>
#include <maximin/theory/types.hpp>

namespace maximin::apps {

/// The policy that a typed list says: actions separated by commas, spaces or line breaks, brackets and quotes left out,
/// each an action's name or index. `where` is what messages call it. Throws InputError when it does not fit the model,
/// or a word is the name of one action and the index of another.
Policy policy_of_list(const std::string& list, const Model<double>& model, const std::string& where);

/// The policy in a file: such a list, or JSON: an array of actions, or an object with one as its "policy", where whole
/// numbers are indices and strings are names. Throws InputError when the file cannot be read or does not fit the model.
Policy read_policy_file(const std::string& path, const Model<double>& model);

}  // namespace maximin::apps
