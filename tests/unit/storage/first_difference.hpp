// Compares two studies bit by bit, except for items that may differ between two runs, and names the first path in the
// study file at which they differ.
#pragma once

#include <algorithm>
#include <bit>
#include <string_view>
#include <type_traits>
#include <variant>

#include "engine/core/options.hpp"
#include "engine/storage/schema.hpp"
#include "engine/storage/study_contents.hpp"

namespace pkm::test {

/// @return false for items that may differ between two runs: times, machine, program version, file names and notes
inline bool is_reproducible(std::string_view path) {
  static constexpr std::string_view kRunSpecific[] = {
      "/@toml_file", "/@reproducible", "/@program_version", "/@program_revision", "/@machine", "/@created", "/@updated",
      "/@seconds",   "/notes",         "/mechanism@file"};
  return !path.ends_with("/evaluations/seconds") && !path.ends_with("/generations/seconds") &&
         std::ranges::find(kRunSpecific, path) == std::end(kRunSpecific);
}

using Values = std::variant<std::vector<double>, std::vector<std::int64_t>, std::vector<std::uint64_t>,
                            std::vector<std::uint8_t>, std::vector<std::string>>;

/// An attribute or dataset.
struct Item {
  std::string path;
  std::vector<std::string> columns;
  std::size_t width;  ///< values per row
  Values values;
};

/// Archive (see schema.hpp) that collects all reproducible items, in the order of the schema.
class Collector {
 public:
  static constexpr bool kReads = false;

  void group(const std::string&, const std::string&) {}

  template <class T>
  void attribute(const std::string& group, const std::string& name, const T& value) {
    using Stored = std::conditional_t<std::is_same_v<T, bool>, std::uint8_t, T>;
    add({group + "@" + name, {}, 1, std::vector<Stored>{static_cast<Stored>(value)}});
  }

  template <class T>
  void array(const Leaf& leaf, const std::vector<T>& values, const Extent& extent) {
    std::size_t width = 1;
    for (std::size_t i = 1; i < extent.size(); ++i) width *= extent[i];
    // Datasets of floats contain times only.
    if constexpr (!std::is_same_v<T, float>) add({leaf.path, leaf.columns, width, values});
  }

  std::vector<Item> items;

 private:
  void add(Item item) {
    if (is_reproducible(item.path)) items.push_back(std::move(item));
  }
};

template <class T>
bool same_bits(const T& a, const T& b) {
  if constexpr (std::is_same_v<T, double>)
    return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
  else
    return a == b;
}

template <class T>
std::string value_text(const T& value) {
  if constexpr (std::is_same_v<T, double>)
    return shortest(value);
  else if constexpr (std::is_same_v<T, std::string>)
    return "'" + value + "'";
  else
    return std::to_string(value);
}

/// Path of an element: "/stages/1/evaluations/margin[0].rail-length".
inline std::string element_path(const Item& item, std::size_t index, std::size_t count) {
  if (count == 1) return item.path;
  std::string text = item.path + "[" + std::to_string(index / item.width) + "]";
  if (item.columns.size() == item.width) text += "." + item.columns[index % item.width];
  return text;
}

/// @return a sentence on the first difference; "" if there is none
template <class T>
std::string compare(const Item& item, const std::vector<T>& a, const std::vector<T>& b) {
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
    if (!same_bits(a[i], b[i]))
      return element_path(item, i, a.size()) + ": " + value_text(a[i]) + " against " + value_text(b[i]);
  if (a.size() != b.size())
    return item.path + ": " + std::to_string(a.size()) + " against " + std::to_string(b.size()) + " values";
  return "";
}

}  // namespace pkm::test

namespace pkm {

/// @return one line with the first difference: its path in the file and both values; "" if the studies are equal
inline std::string first_difference(const StudyContents& a, const StudyContents& b) {
  test::Collector from_a, from_b;
  schema::describe(from_a, a);
  schema::describe(from_b, b);
  for (std::size_t i = 0; i < std::min(from_a.items.size(), from_b.items.size()); ++i) {
    const test::Item &x = from_a.items[i], &y = from_b.items[i];
    if (x.path != y.path) return x.path + " against " + y.path;
    const std::string difference = std::visit(
        [&](const auto& values) {
          return test::compare(x, values, std::get<std::remove_cvref_t<decltype(values)>>(y.values));
        },
        x.values);
    if (!difference.empty()) return difference;
  }
  if (from_a.items.size() != from_b.items.size())
    return "only one has " + (from_a.items.size() > from_b.items.size() ? from_a.items[from_b.items.size()].path
                                                                        : from_b.items[from_a.items.size()].path);
  return "";
}

}  // namespace pkm
