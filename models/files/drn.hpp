#pragma once

#include <ostream>
#include <string_view>

#include <maximin/models/files/read_options.hpp>
#include <maximin/models/model.hpp>

namespace maximin {

/// Reads Storm's DRN format: MDPs, DTMCs and the MDP part of POMDPs, with integer, decimal, rational or interval
/// values and placeholders; models with parameters are refused. State rewards add to every action of the state;
/// `options.reward_model` picks one of several reward models.
///
/// States may have different choices: the actions are the labels of all states together (an unlabelled choice takes
/// the first label that its state lacks), and an action that a state lacks acts there as its first choice, which leaves
/// V* as it is; a note says how many. The label "init" is where the model starts. The format has no discount.
/// Throws InputError, "FILE:LINE: what is wrong, what is expected".
template <class Scalar>
Model<Scalar> read_drn(std::string_view text, std::string_view file_name, const ReadOptions& options = {});

/// Writes the same, rewards on actions. State names, discount and geometry have no place there, nor a start that is
/// not uniform over its states; action names that DRN cannot hold are written as numbers.
template <class Scalar>
void write_drn(const Model<Scalar>& model, std::ostream& out);

}  // namespace maximin
