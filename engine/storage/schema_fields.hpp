// The kinds of items that a study file consists of beyond plain arrays: words for enumerations, optional groups, lists
// of records. Private to engine/storage; schema.hpp says which item lies where.
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <type_traits>
#include <vector>

#include "engine/storage/hdf5_image.hpp"
#include "engine/storage/study_contents.hpp"

namespace pkm::schema {

// The words of enumerations.
constexpr std::array<const char*, 2> words_of(Direction) { return {"minimise", "maximise"}; }
constexpr std::array<const char*, 3> words_of(StudyState) { return {"running", "interrupted", "finished"}; }
constexpr std::array<const char*, 3> words_of(Detail) { return {"enough", "complete", "derivatives"}; }
constexpr std::array<const char*, 4> words_of(Status) { return {"feasible", "infeasible", "rejected", "failed"}; }

/// What is kept of a value: itself, or an enumeration's word.
template <class T>
auto kept(const T& value) {
  if constexpr (std::is_enum_v<T>)
    return std::string(words_of(value)[static_cast<std::size_t>(value)]);
  else
    return value;
}

/// The value of which this was kept.
template <class T, class Kept>
void take(T& value, const Kept& from, const std::string& where) {
  if constexpr (std::is_enum_v<T>) {
    const auto words = words_of(value);
    const auto at = std::find(words.begin(), words.end(), from);
    if (at == words.end()) throw ImageError(where + ": the unknown word '" + from + "'");
    value = static_cast<T>(at - words.begin());
  } else {
    value = from;
  }
}

/// An enumeration, kept as a word.
template <class Archive, class Enum>
void choice(Archive& archive, const std::string& group, const std::string& name, Enum& value) {
  std::string word = kept(value);
  archive.attribute(group, name, word);
  if constexpr (Archive::kReads) take(value, word, group + "@" + name);
}

/// The file has what came with a version of the schema.
template <class Archive>
bool since(const Archive& archive, int schema) {
  if constexpr (Archive::kReads)
    return archive.schema() >= schema;
  else
    return true;
}

/// Something that a study may not have: its group is there, or it is not.
template <class Archive, class Optional>
bool present(Archive& archive, const std::string& group, Optional& item) {
  if constexpr (Archive::kReads) {
    if (!archive.has(group)) return false;
    item.emplace();
  }
  return item.has_value();
}

/// One member of a list of records, kept as one dataset.
template <class Record, class Member>
struct Field {
  const char* name;
  Member Record::*member;
  const char* unit;
  const char* description;
};
// Clang 14 does not deduce the arguments of an aggregate by itself.
template <class Record, class Member>
Field(const char*, Member Record::*, const char*, const char*) -> Field<Record, Member>;

template <class Archive, class Items, class Record, class Member>
void column(Archive& archive, const std::string& group, Items& items, bool first, const Field<Record, Member>& field) {
  std::vector<decltype(kept(Member{}))> values;
  for (const Record& item : items) values.push_back(kept(item.*field.member));
  const Leaf leaf{group + "/" + field.name, field.description, {field.unit}};
  archive.array(leaf, values, {Archive::kReads && first ? kAnyRows : items.size()});
  if constexpr (Archive::kReads) {
    items.resize(values.size());
    for (std::size_t i = 0; i < values.size(); ++i) take(items[i].*field.member, values[i], leaf.path);
  }
}

/// A list of records, one dataset per member: what MATLAB and numpy read without effort.
template <class Archive, class Items, class... Fields>
void records(Archive& archive, const std::string& group, const std::string& description, Items& items,
             const Fields&... fields) {
  archive.group(group, description);
  bool first = true;
  ((column(archive, group, items, first, fields), first = false), ...);
}

/// Values of things that have names and units: a column each.
/// @param extent  of what lies before the columns: a number of rows, or nothing
template <class Archive, class Items, class Values>
void columns(Archive& archive, const std::string& path, const char* description, const Items& items, Values&& values,
             Extent extent = {}) {
  Leaf leaf{path, description, {}};
  for (const auto& item : items) {
    leaf.units.push_back(item.unit);
    leaf.columns.push_back(item.name);
  }
  extent.push_back(items.size());
  archive.array(leaf, values, extent);
}

/// VoxelMap keeps plain arrays of three; the archives know vectors.
template <class Archive, class Plain>
void triple(Archive& archive, const Leaf& leaf, Plain& values) {
  std::vector copy(std::begin(values), std::end(values));
  archive.array(leaf, copy, {3});
  if constexpr (Archive::kReads) std::copy(copy.begin(), copy.end(), values);
}

}  // namespace pkm::schema
