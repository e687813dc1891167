#include <maximin/proofs_check/report/svg_plot.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>

#include <maximin/proofs_check/report/html_text.hpp>

namespace maximin::report {
namespace {

constexpr double font = 15;           // user units; the page's own text has about the same size
constexpr double letter = font * .6;  // a generous width of one letter

constexpr std::size_t series_count = 7;

/// A coordinate, to 0.1, in as few bytes as that takes.
std::string coord(double v) {
  const double rounded = std::round(v * 10) / 10;
  return fmt::format("{:g}", rounded == 0 ? 0.0 : rounded);
}

std::string place(double x, double y) {
  return coord(x) + ' ' + coord(y);
}

std::string_view css(Role role) {
  return role == Role::violated ? "bad" : role == Role::highlighted ? "good" : "plain";
}

/// Characters, not bytes: most labels are ASCII, some hold superscripts or Greek.
std::size_t letters(std::string_view text) {
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (static_cast<unsigned char>(c) & 0xC0) != 0x80; }));
}

std::string text_at(double x, double y, std::string_view text, std::string_view css_class = "",
                    std::string_view attributes = "") {
  return fmt::format("<text x=\"{}\" y=\"{}\"{}{}>{}</text>\n", coord(x), coord(y),
                     css_class.empty() ? "" : fmt::format(" class=\"{}\"", css_class),
                     attributes.empty() ? "" : fmt::format(" {}", attributes), escape(text));
}

std::string line_between(double x1, double y1, double x2, double y2, std::string_view css_class) {
  return fmt::format("<path class=\"{}\" d=\"M{}L{}\"/>\n", css_class, place(x1, y1), place(x2, y2));
}

std::string open_svg(const Frame& frame) {
  std::string svg =
      fmt::format("<svg class=\"plot\" viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\">\n", coord(frame.width),
                  coord(frame.height), escape(frame.description.empty() ? frame.title : frame.description));
  if (!frame.title.empty()) svg += text_at(4, font + 2, frame.title, "title");
  return svg;
}

double widest(const std::vector<Tick>& ticks) {
  std::size_t most = 0;
  for (const Tick& t : ticks) most = std::max(most, letters(t.label));
  return letter * static_cast<double>(most);
}

std::string hover(std::string_view text) {
  return text.empty() ? "" : fmt::format("<title>{}</title>", escape(text));
}

/// `attributes` make the element; it is closed around the hover text, if any.
std::string element(std::string_view name, std::string_view attributes, std::string_view hover_text) {
  if (hover_text.empty()) return fmt::format("<{} {}/>\n", name, attributes);
  return fmt::format("<{} {}>{}</{}>\n", name, attributes, hover(hover_text), name);
}

}  // namespace

Plot::Plot(const Frame& frame, Axis x, Axis y) : frame_(frame), x_(std::move(x)), y_(std::move(y)) {
  left_ = 12 + widest(y_.ticks()) + (frame_.y_label.empty() ? 0 : font + 6);
  right_ = frame_.width - std::max(10.0, letter * static_cast<double>(letters(x_.ticks().back().label)) / 2 + 2);
  top_ = (frame_.title.empty() ? 4 : font + 14) + font + 4;
  bottom_ = frame_.height - font - 10 - (frame_.x_label.empty() ? 0 : font + 6);
  draw_axes();
}

double Plot::px(double x) const {
  return left_ + (right_ - left_) * x_.at(x);
}

double Plot::py(double y) const {
  return bottom_ - (bottom_ - top_) * y_.at(y);
}

bool Plot::in_zero_band(double y) const {
  return y_.is_logarithmic() && !(y >= y_.low() * 0.999999);
}

void Plot::draw_axes() {
  for (const Tick& t : y_.ticks()) {
    body_ += line_between(left_, py(t.value), right_, py(t.value), "grid");
    body_ += text_at(left_ - 6, py(t.value) + font * 0.35, t.label, "end");
  }
  double free_from = -1e9;  // where the last label of the x-axis ends: one that does not fit is left out
  for (const Tick& t : x_.ticks()) {
    body_ += line_between(px(t.value), top_, px(t.value), bottom_, "grid");
    const double half = letter * static_cast<double>(letters(t.label)) / 2;
    if (px(t.value) - half < free_from) continue;
    body_ += text_at(px(t.value), bottom_ + font + 5, t.label, "mid");
    free_from = px(t.value) + half + 4;
  }
  body_ += fmt::format("<path class=\"axis\" d=\"M{}V{}H{}\"/>\n", place(left_, top_), coord(bottom_), coord(right_));
  const double x_mid = (left_ + right_) / 2, y_mid = (top_ + bottom_) / 2;
  if (!frame_.x_label.empty()) body_ += text_at(x_mid, frame_.height - 6, frame_.x_label, "mid label");
  if (!frame_.y_label.empty()) {
    const std::string turn = fmt::format("transform=\"rotate(-90 {})\"", place(font, y_mid));
    body_ += text_at(font, y_mid, frame_.y_label, "mid label", turn);
  }
}

void Plot::region_left_of(double x, std::string_view word) {
  if (x <= x_.low()) return;
  body_ += fmt::format("<rect class=\"region\" x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\"/>\n", coord(left_),
                       coord(top_), coord(px(x) - left_), coord(bottom_ - top_));
  words_ += text_at(px(x) - 6, top_ - 6, word, "note good end");
}

void Plot::vertical(double x, std::string_view word) {
  if (!x_.shows(x)) return;
  body_ += line_between(px(x), top_, px(x), bottom_, "rule");
  const bool fits = px(x) + letter * static_cast<double>(letters(word)) + 6 < right_;
  words_ += text_at(px(x) + (fits ? 6 : 0), top_ - 6, word, fits ? "note" : "note end");
}

void Plot::horizontal(double y, std::string_view word) {
  if (!y_.shows(y)) return;
  body_ += line_between(left_, py(y), right_, py(y), "rule");
  words_ += text_at(right_ - 4, py(y) - 5, word, "note end");
}

void Plot::diagonal(std::string_view words) {
  const double from = std::max(x_.low(), y_.low()), to = std::min(x_.high(), y_.high());
  if (!(from < to)) return;
  body_ += line_between(px(from), py(from), px(to), py(to), "diagonal");
  const double length = std::hypot(px(to) - px(from), py(to) - py(from));
  if (length < letter * static_cast<double>(letters(words)) + 12) return;
  const double angle = std::atan2(py(to) - py(from), px(to) - px(from)) * 180 / std::numbers::pi;
  const double x = (px(from) + px(to)) / 2, y = (py(from) + py(to)) / 2;
  const std::string turn = fmt::format("transform=\"rotate({} {})\"", coord(angle), place(x, y));
  words_ += text_at(x, y - 6, words, "mid note", turn);
}

void Plot::marks(const std::vector<Mark>& marks, Role role) {
  if (marks.empty()) return;
  body_ += fmt::format("<g class=\"marks {}\">\n", css(role));
  for (const Mark& m : marks) {
    const double x = px(m.x), y = py(m.y);
    if (role == Role::violated) {
      body_ += element("path", fmt::format("d=\"M{}l10 10m0-10l-10 10\"", place(x - 5, y - 5)), m.hover);
    } else if (in_zero_band(m.y)) {
      body_ += element("path", fmt::format("d=\"M{}v9\"", place(x, y - 4.5)), m.hover);
    } else {
      body_ += element("circle", fmt::format("cx=\"{}\" cy=\"{}\" r=\"3\"", coord(x), coord(y)), m.hover);
    }
  }
  body_ += "</g>\n";
}

void Plot::specks(const std::vector<Mark>& marks, Role role) {
  std::string discs, strokes;
  for (const Mark& m : marks) {
    const bool zero = in_zero_band(m.y);
    (zero ? strokes : discs) += fmt::format("M{}{}", place(px(m.x), py(m.y) - (zero ? 4.5 : 0)), zero ? "v9" : "h0");
  }
  if (!discs.empty()) body_ += fmt::format("<path class=\"specks {}\" d=\"{}\"/>\n", css(role), discs);
  if (!strokes.empty()) body_ += fmt::format("<path class=\"strokes {}\" d=\"{}\"/>\n", css(role), strokes);
}

void Plot::line(const std::vector<Mark>& points, std::size_t series) {
  std::string d;
  for (const Mark& p : points) d += (d.empty() ? "M" : "L") + place(px(p.x), py(p.y));
  if (!d.empty()) body_ += fmt::format("<path class=\"line s{}\" d=\"{}\"/>\n", series % series_count, d);
}

void Plot::band(const std::vector<Mark>& low, const std::vector<Mark>& high, std::size_t series) {
  std::string d;
  for (const Mark& p : high) d += (d.empty() ? "M" : "L") + place(px(p.x), py(p.y));
  for (auto p = low.rbegin(); p != low.rend(); ++p) d += "L" + place(px(p->x), py(p->y));
  if (!d.empty()) body_ += fmt::format("<path class=\"band s{}\" d=\"{}z\"/>\n", series % series_count, d);
}

void Plot::stairs(const std::vector<Mark>& points, std::size_t series) {
  std::string d;
  for (const Mark& p : points) {
    d += d.empty() ? "M" + place(px(p.x), py(p.y)) : "H" + coord(px(p.x)) + "V" + coord(py(p.y));
  }
  if (!d.empty()) body_ += fmt::format("<path class=\"line s{}\" d=\"{}\"/>\n", series % series_count, d);
}

std::string Plot::svg() const {
  return open_svg(frame_) + body_ + words_ + "</svg>\n";
}

std::string bar_chart(const Frame& frame, const std::vector<Bar>& bars, double full) {
  constexpr double row = 46;
  Frame sized = frame;
  const double top = frame.title.empty() ? 4 : font + 16;
  sized.height = top + row * static_cast<double>(bars.size());
  std::string svg = open_svg(sized);
  std::size_t longest = 0;
  for (const Bar& b : bars) longest = std::max(longest, letters(b.text));
  const double room = frame.width - 16 - letter * static_cast<double>(longest);
  double y = top;
  for (const Bar& b : bars) {
    const double share = full > 0 ? std::clamp(b.value / full, 0.0, 1.0) : 0;
    const double width = b.value > 0 ? std::max(1.5, share * room) : 0;
    svg += text_at(4, y + font, b.label);
    svg += fmt::format("<rect class=\"track\" x=\"4\" y=\"{0}\" width=\"{1}\" height=\"15\"/>\n", coord(y + 20),
                       coord(room));
    svg += fmt::format("<rect class=\"bar {}\" x=\"4\" y=\"{}\" width=\"{}\" height=\"15\"/>\n", css(b.role),
                       coord(y + 20), coord(width));
    svg += text_at(room + 12, y + 33, b.text, "strong");
    y += row;
  }
  return svg + "</svg>\n";
}

std::string interval_chart(const Frame& frame, const std::vector<Interval>& rows, const Axis& x, double rule,
                           std::string_view rule_word) {
  constexpr double row = 50;
  Frame sized = frame;
  const double top = (frame.title.empty() ? 0 : font + 16) + (std::isnan(rule) ? 0 : font + 6);
  const double bottom = top + row * static_cast<double>(rows.size()) + 4;
  sized.height = bottom + font + 10 + (frame.x_label.empty() ? 0 : font + 6);
  const double left = 24, right = frame.width - 40;
  const auto px = [&](double v) { return left + (right - left) * x.at(v); };
  std::string svg = open_svg(sized);
  for (const Tick& t : x.ticks()) {
    svg += line_between(px(t.value), top, px(t.value), bottom, "grid");
    svg += text_at(px(t.value), bottom + font + 5, t.label, "mid");
  }
  if (!std::isnan(rule) && x.shows(rule)) {
    svg += line_between(px(rule), top - 4, px(rule), bottom, "rule");
    const bool late = px(rule) > frame.width / 2;
    svg += text_at(px(rule) + (late ? 8 : -8), top - 8, rule_word, late ? "note end" : "note");
  }
  double y = top;
  for (const Interval& r : rows) {
    svg += text_at(4, y + font + 2, r.label + "   " + r.text, "halo");
    const double middle = y + 35;
    svg += fmt::format("<g class=\"interval {}\"><path d=\"M{}H{}\"/><circle cx=\"{}\" cy=\"{}\" r=\"6\"/>",
                       css(r.role), place(px(r.left), middle), coord(px(r.right)), coord(px(r.left)), coord(middle));
    svg += fmt::format("<path class=\"stop\" d=\"M{}v18\"/></g>\n", place(px(r.right), middle - 9));
    y += row;
  }
  if (!frame.x_label.empty()) svg += text_at(frame.width / 2, sized.height - 6, frame.x_label, "mid label");
  return svg + "</svg>\n";
}

std::string heat_map(const Frame& frame, const Bins& columns, const Bins& rows,
                     const std::vector<std::vector<Cell>>& cells) {
  std::size_t widest_row_label = 0;
  for (const std::string& l : rows.labels) widest_row_label = std::max(widest_row_label, letters(l));
  const double left = 14 + letter * static_cast<double>(widest_row_label) + font + 6, right = frame.width - 16;
  const double top = font + 22, bottom = frame.height - 2 * font - 16;
  const double w = (right - left) / static_cast<double>(columns.size());
  const double h = (bottom - top) / static_cast<double>(rows.size());
  std::string svg = open_svg(frame);
  for (std::size_t r = 0; r < rows.size(); ++r) {
    for (std::size_t c = 0; c < columns.size(); ++c) {
      const Cell& cell = cells[r][c];
      const double x = left + w * static_cast<double>(c), y = bottom - h * static_cast<double>(r + 1);
      const double share = cell.whole == 0 ? 0 : static_cast<double>(cell.part) / static_cast<double>(cell.whole);
      svg += fmt::format("<g class=\"cell{}{}\">", cell.whole == 0 ? " empty" : "", share > 0.6 ? " deep" : "");
      svg += fmt::format("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill-opacity=\"{:.2f}\">{}</rect>",
                         coord(x + 1), coord(y + 1), coord(w - 2), coord(h - 2), share,
                         hover(fmt::format("{} of {} trials", count(cell.part), count(cell.whole))));
      if (cell.whole > 0) {
        svg += text_at(x + w / 2, y + h / 2 + font * 0.35, fmt::format("{:.0f}", 100 * share), "mid");
      }
      svg += "</g>\n";
    }
  }
  const auto middle = [](const Bins& bins) { return bins.at_edges ? 0.0 : 0.5; };
  for (std::size_t c = 0; c < columns.labels.size(); ++c) {
    const double x = left + w * (static_cast<double>(c) + middle(columns));
    svg += text_at(x, bottom + font + 5, columns.labels[c], "mid");
  }
  for (std::size_t r = 0; r < rows.labels.size(); ++r) {
    const double y = bottom - h * (static_cast<double>(r) + middle(rows));
    svg += text_at(left - 6, y + font * 0.35, rows.labels[r], "end");
  }
  svg += text_at((left + right) / 2, frame.height - 6, frame.x_label, "mid label");
  const std::string turn = fmt::format("transform=\"rotate(-90 {})\"", place(font, (top + bottom) / 2));
  svg += text_at(font, (top + bottom) / 2, frame.y_label, "mid label", turn);
  return svg + "</svg>\n";
}

std::string line_legend(const std::vector<std::string>& names) {
  std::string html = "<ul class=\"legend\">\n";
  for (std::size_t i = 0; i < names.size(); ++i) {
    html += fmt::format(
        "<li><svg class=\"plot key\" viewBox=\"0 0 44 16\" aria-hidden=\"true\"><path class=\"line s{}\" d=\"M2 "
        "8H42\"/></svg>{}</li>\n",
        i % series_count, escape(names[i]));
  }
  return html + "</ul>\n";
}

std::vector<std::size_t> thinned(std::size_t n, std::size_t cap) {
  std::vector<std::size_t> kept;
  const std::size_t count = std::min(n, cap);
  for (std::size_t i = 0; i < count; ++i) kept.push_back(i * n / count);
  return kept;
}

}  // namespace maximin::report
