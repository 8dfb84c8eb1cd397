// Look-up in a catalogue, any list whose elements have a `name`, and the words of messages about it.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/error.hpp"

namespace pkm {

/// The names, in the order of the lists.
template <class... List>
std::vector<std::string> names_of(const List&... lists) {
  std::vector<std::string> names;
  const auto add = [&names](const auto& list) {
    for (const auto& element : list) names.push_back(element.name);
  };
  (add(lists), ...);
  return names;
}

/// Whether the list holds the value.
template <class List, class Value>
bool contains(const List& list, const Value& value) {
  return std::ranges::find(list, value) != list.end();
}

/// The element called `name`, or null.
template <class List>
auto find_named(const List& list, std::string_view name) -> decltype(&list[0]) {
  for (const auto& element : list)
    if (element.name == name) return &element;
  return nullptr;
}

/// "; did you mean 'a'?" for the nearest known name, "" where there is none.
inline std::string did_you_mean(std::string_view name, const std::vector<std::string>& known) {
  const std::string nearest = nearest_name(name, known);
  return nearest.empty() ? "" : "; did you mean '" + nearest + "'?";
}

/// "a, b, c": the texts that `text_of` makes of the elements, for messages.
template <class List, class Text>
std::string join_of(const List& list, Text text_of) {
  std::vector<std::string> words;
  for (const auto& element : list) words.push_back(text_of(element));
  return join(words);
}

}  // namespace pkm
