// Look-up by name in a catalogue (any list whose elements have a member `name`), and text for error messages about it.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/error.hpp"

namespace pkm {

/// The names of all elements, in the order of the lists.
template <class... List>
std::vector<std::string> names_of(const List&... lists) {
  std::vector<std::string> names;
  const auto add = [&names](const auto& list) {
    for (const auto& element : list) names.push_back(element.name);
  };
  (add(lists), ...);
  return names;
}

/// Returns true if the list contains the value.
template <class List, class Value>
bool contains(const List& list, const Value& value) {
  return std::ranges::find(list, value) != list.end();
}

/// The element whose name is `name`; null if there is none.
template <class List>
auto find_named(const List& list, std::string_view name) -> decltype(&list[0]) {
  for (const auto& element : list)
    if (element.name == name) return &element;
  return nullptr;
}

/// The suggestion "; did you mean 'a'?" with the known name most similar to `name`; "" if none is similar enough.
inline std::string did_you_mean(std::string_view name, const std::vector<std::string>& known) {
  const std::string nearest = nearest_name(name, known);
  return nearest.empty() ? "" : "; did you mean '" + nearest + "'?";
}

/// Text such as "a, b, c" for messages: text_of(element) for each element of the list, separated by commas.
template <class List, class Text>
std::string join_texts(const List& list, Text text_of) {
  std::vector<std::string> words;
  for (const auto& element : list) words.push_back(text_of(element));
  return join(words);
}

}  // namespace pkm
