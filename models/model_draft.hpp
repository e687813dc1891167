#pragma once

#include <optional>
#include <vector>

#include <maximin/models/model.hpp>

namespace maximin {

/// A model taken apart, to be changed and put together again.
struct ModelDraft {
  using Row = std::vector<Successor<double>>;

  Model<double> whole;  ///< what is not listed below: geometry, names, start; its mdp is out of date
  double discount = 0;
  QTable<double> rewards;              ///< |S| x |A|
  std::vector<std::vector<Row>> rows;  ///< [s][a], targets ascending

  explicit ModelDraft(const Model<double>& model);

  State states() const { return static_cast<State>(rewards.rows()); }
  Action actions() const { return static_cast<Action>(rewards.cols()); }

  /// Puts the model together. Throws InputError when it is not valid.
  Model<double> build() &&;

  /// Keeps the states marked true (at least one) with their names, geometry and share of the start distribution.
  /// Transitions to a dropped state lead to `instead`, a state that is kept, or, without it, back to the state they
  /// left.
  void keep_states(const std::vector<bool>& kept, std::optional<State> instead);

  /// Removes an action, of at least two.
  void drop_action(Action a);

  /// Removes a coordinate of the points, of at least two.
  void drop_dimension(Eigen::Index i);
};

/// The row with its probabilities rounded to multiples of 1/parts that sum to 1, by largest remainder.
ModelDraft::Row rounded_row(const ModelDraft::Row& row, int parts);

/// Probability 1 for the most likely successor, the lowest of several.
ModelDraft::Row deterministic_row(const ModelDraft::Row& row);

}  // namespace maximin
