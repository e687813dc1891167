#pragma once

#include <exception>
#include <string>
#include <typeinfo>

#include <maximin/theory/error.hpp>

namespace maximin::deep {

/// The message of the InputError that `f` throws; what is wrong, in brackets, where it throws none, another exception,
/// or one whose message is no line.
template <class F>
std::string refusal(const F& f) {
  try {
    f();
  } catch (const InputError& e) {
    const std::string text = e.what();
    if (text.empty() || text.find_first_of("\r\n") != text.npos) return "[not one line] " + text;
    if (text.size() > 500) return "[too long] " + text.substr(0, 500);
    return text;
  } catch (const std::exception& e) {
    return std::string("[") + typeid(e).name() + "] " + e.what();
  }
  return "[nothing thrown]";
}

inline bool is_refusal(const std::string& text) {
  return !text.empty() && text[0] != '[';
}

}  // namespace maximin::deep
