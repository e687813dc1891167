#include <maximin/proofs_check/report/page.hpp>

#include <fmt/format.h>

#include <maximin/proofs_check/report/html_text.hpp>
#include <maximin/proofs_check/report/page_style.hpp>

namespace maximin::report {

std::string page(std::string_view title, std::string_view body, std::string_view further_style) {
  return fmt::format(R"(<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8"/>
<meta name="viewport" content="width=device-width, initial-scale=1"/>
<meta name="color-scheme" content="light dark"/>
<title>{}</title>
<style>{}{}{}</style>
</head>
<body>
<main>
{}</main>
</body>
</html>
)",
                     escape(title), page_style(), plot_style(), further_style, body);
}

std::string verdict_box(std::string_view kind, const std::vector<std::string>& sentences) {
  std::string html = fmt::format("<div class=\"verdict{}{}\">\n", kind.empty() ? "" : " ", kind);
  for (const std::string& s : sentences) {
    if (!s.empty()) html += "<p>" + s + "</p>\n";
  }
  return html + "</div>\n";
}

std::string tiles(const std::vector<Tile>& tiles) {
  std::string html = "<div class=\"tiles\">\n";
  for (const Tile& t : tiles) {
    html += fmt::format("<div class=\"tile{}\"><b>{}</b><span>{}</span></div>\n", t.bad ? " bad" : "", escape(t.number),
                        escape(t.text));
  }
  return html + "</div>\n";
}

std::string facts(const std::vector<std::pair<std::string, std::string>>& rows) {
  std::string html = "<div class=\"scroll\"><table class=\"facts\"><tbody>\n";
  for (const auto& [name, value] : rows) {
    html += fmt::format("<tr><td>{}</td><td>{}</td></tr>\n", escape(name), escape(value));
  }
  return html + "</tbody></table></div>\n";
}

std::string configuration_section(const nlohmann::ordered_json& configuration) {
  using Json = nlohmann::ordered_json;
  return fmt::format(
      "<h2>Configuration</h2>\n<p>All that the results depend on; the number of threads is not part of it.</p>\n"
      "<pre>{}</pre>\n",
      escape(configuration.dump(2, ' ', false, Json::error_handler_t::replace)));
}

std::string notation() {
  return "<p class=\"sub notation\">In the statements g is the discount γ, Delta = 2 eps g (l_r + l_p |S| R_max/(1-g)) "
         "the loss "
         "of "
         "one pessimistic backup, eps the largest distance inside a ball, pi_n the agent's maximin policy, omega_n the "
         "attacker's answer to it, L* the Lipschitz constant of Q*, and rho the distance of the belief's members from "
         "the true state. |.| is the largest absolute entry.</p>\n";
}

std::string reading_of(const nlohmann::ordered_json& configuration) {
  const bool object = configuration.is_object();
  const bool paper = object && configuration.value("reading", nlohmann::ordered_json()) == "paper";
  return paper ? "R_max read as the paper prints it, max(0, max R)" : "R_max read as max |R|, which the proof needs";
}

bool is_exact(const nlohmann::ordered_json& configuration) {
  if (!configuration.is_object()) return false;
  const auto arith = configuration.value("arith", nlohmann::ordered_json());
  return arith == "exact" || arith == "certified";
}

std::string doubt_of(const nlohmann::ordered_json& configuration) {
  const bool pedantic = configuration.is_object() && configuration.value("pedantic", false);
  return pedantic && !is_exact(configuration)
             ? "Undetermined: no violation, but what held held within rounding, not certified."
             : "";
}

}  // namespace maximin::report
