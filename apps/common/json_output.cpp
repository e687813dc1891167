#include <maximin/apps/common/json_output.hpp>

namespace maximin::apps {

std::string json_text(const Json& document) {
  // State names come from files; bytes that are not UTF-8 are replaced rather than refused.
  const auto text = [](const Json& j) { return j.dump(-1, ' ', false, Json::error_handler_t::replace); };
  if (!document.is_object() || document.empty()) return text(document) + "\n";
  std::string out = "{\n";
  for (auto it = document.begin(); it != document.end(); ++it) {
    out += (it == document.begin() ? "  " : ",\n  ") + text(Json(it.key())) + ": " + text(it.value());
  }
  return out + "\n}\n";
}

Json to_json(const Values<double>& values) {
  return std::vector<double>(values.data(), values.data() + values.size());
}

Json to_json(const QTable<double>& table) {
  Json rows = Json::array();
  for (Eigen::Index s = 0; s < table.rows(); ++s) {
    rows.push_back(std::vector<double>(table.row(s).data(), table.row(s).data() + table.cols()));
  }
  return rows;
}

}  // namespace maximin::apps
