#include <maximin/deep/table_values.hpp>

#include <algorithm>

#include <fmt/format.h>

#include <maximin/theory/error.hpp>

namespace maximin::deep {

TableValues::TableValues(const QTable<double>& q, const Places& places) : places_(&places) {
  if (q.rows() != places.states()) {
    throw InputError(fmt::format("table of {} rows, expected one per place, {}", q.rows(), places.states()));
  }
  torch::Tensor table = torch::empty({q.rows(), q.cols()}, torch::kDouble);
  std::copy_n(q.data(), q.size(), table.data_ptr<double>());
  table_ = register_parameter("table", table, false);
}

torch::Tensor TableValues::forward(const torch::Tensor& states) {
  const torch::Tensor places = states.to(torch::kCPU, torch::kFloat).contiguous();
  torch::Tensor rows = torch::empty({places.size(0)}, torch::kInt64);
  const float* at = places.data_ptr<float>();
  long* row = rows.data_ptr<long>();
  for (long i = 0; i < places.size(0); ++i) row[i] = places_->state_at(at[2 * i], at[2 * i + 1]);
  return table_.index_select(0, rows.to(table_.device()));
}

}  // namespace maximin::deep
