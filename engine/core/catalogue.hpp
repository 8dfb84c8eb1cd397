// Look-up in a catalogue: any list whose elements have a `name`.
#pragma once

#include <string>
#include <vector>

namespace pkm {

/// The names, in the list's order.
template <class List>
std::vector<std::string> names_of(const List& list) {
  std::vector<std::string> names;
  for (const auto& element : list) names.push_back(element.name);
  return names;
}

/// The element called `name`, or null.
template <class List>
auto find_named(const List& list, const std::string& name) -> decltype(&list[0]) {
  for (const auto& element : list)
    if (element.name == name) return &element;
  return nullptr;
}

}  // namespace pkm
