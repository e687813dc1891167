#pragma once

#include <cstddef>
#include <regex>
#include <string>
#include <string_view>
#include <vector>

namespace maximin {

/// What is wrong with a page as XML, or "". Knows what reports are written in: elements, attributes in double quotes,
/// text, the five predefined entities and numeric ones, one doctype.
class Wellformed {
 public:
  static std::string flaw(std::string_view page) { return Wellformed(page).read(); }

 private:
  explicit Wellformed(std::string_view page) : rest_(page) {}

  std::string read() {
    if (rest_.starts_with("<!DOCTYPE html>")) rest_.remove_prefix(15);
    while (!rest_.empty()) {
      const std::string flaw = rest_.front() == '<' ? tag() : text(rest_.substr(0, rest_.find('<')));
      if (!flaw.empty()) return flaw + " before: " + std::string(rest_.substr(0, 60));
    }
    return open_.empty() ? "" : "never closed: " + open_.back();
  }

  std::string text(std::string_view t) {
    static const std::regex entity("^&(amp|lt|gt|quot|#[0-9]+);");
    for (std::size_t i = t.find('&'); i != t.npos; i = t.find('&', i + 1)) {
      if (!std::regex_search(t.begin() + static_cast<std::ptrdiff_t>(i), t.end(), entity)) return "bare &";
    }
    for (const char c : t) {
      if (static_cast<unsigned char>(c) < 0x20 && c != '\n' && c != '\t') return "control character";
    }
    rest_.remove_prefix(t.size());
    return "";
  }

  std::string tag() {
    static const std::regex form(R"rx(^<(/?)([a-z][a-z0-9]*)((?:\s+[A-Za-z-]+="[^"<]*")*)\s*(/?)>)rx");
    std::match_results<std::string_view::const_iterator> m;
    const std::string_view head = rest_.substr(0, rest_.find('>') == rest_.npos ? rest_.size() : rest_.find('>') + 1);
    if (!std::regex_search(head.begin(), head.end(), m, form)) return "no tag";
    const std::string name = m[2].str();
    if (m[1].length() > 0) {
      if (open_.empty() || open_.back() != name) return "closes what is not open: " + name;
      open_.pop_back();
    } else if (m[4].length() == 0) {
      open_.push_back(name);
    }
    rest_.remove_prefix(static_cast<std::size_t>(m.length()));
    return "";
  }

  std::string_view rest_;
  std::vector<std::string> open_;
};

inline std::size_t occurrences(std::string_view text, std::string_view what) {
  std::size_t n = 0;
  for (std::size_t i = text.find(what); i != text.npos; i = text.find(what, i + what.size())) ++n;
  return n;
}

/// All that stands between `from` and the next `to`, over the whole text.
inline std::string inside(std::string_view text, std::string_view from, std::string_view to) {
  std::string all;
  for (std::size_t i = text.find(from); i != text.npos; i = text.find(from, i + 1)) {
    all += text.substr(i, text.find(to, i) - i);
  }
  return all;
}

}  // namespace maximin
