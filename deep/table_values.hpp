#pragma once

#include <maximin/deep/places.hpp>
#include <maximin/deep/q_network.hpp>
#include <maximin/theory/types.hpp>

namespace maximin::deep {

/// Action values out of a table, in the place of a network: what the exact layer computed, in the deep layer's agents.
/// Values are doubles, so that nothing is decided otherwise than by the table.
class TableValues final : public ActionValueModule {
 public:
  /// Row s of `q`, |S| x |A|, is for the place of state s. The places must outlive it. Throws InputError when there is
  /// not one row for each place.
  TableValues(const QTable<double>& q, const Places& places);

  /// [n, 2] -> [n, |A|]. Throws InputError on a row that is no place.
  torch::Tensor forward(const torch::Tensor& states) override;

 private:
  const Places* places_;
  torch::Tensor table_;
};

}  // namespace maximin::deep
