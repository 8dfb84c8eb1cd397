// Building blocks of the schema: enumerations stored as text, optional groups, lists of records (one dataset per
// member) and matrices with named columns. Private to engine/storage; schema.hpp uses them to define the layout.
//
// The template parameter Archive is ImageWriter or ImageReader; every function works in both directions.
#pragma once

#include <algorithm>
#include <array>
#include <string>
#include <type_traits>
#include <vector>

#include "engine/storage/hdf5_image.hpp"
#include "engine/storage/study_contents.hpp"

namespace pkm::schema {

// The names under which enumerators are stored, in the order of the enumerators.
constexpr std::array<const char*, 2> enum_names(Direction) { return {"minimise", "maximise"}; }
constexpr std::array<const char*, 3> enum_names(StudyState) { return {"running", "interrupted", "finished"}; }
constexpr std::array<const char*, 3> enum_names(Detail) { return {"enough", "complete", "derivatives"}; }
constexpr std::array<const char*, 4> enum_names(Status) { return {"feasible", "infeasible", "rejected", "failed"}; }

/// @return the stored form of a value: the name of an enumerator, or the value itself
template <class T>
auto to_stored(const T& value) {
  if constexpr (std::is_enum_v<T>)
    return std::string(enum_names(value)[static_cast<std::size_t>(value)]);
  else
    return value;
}

/// Converts the stored form of a value (the name of an enumerator, or the value itself) to the value. Throws ImageError
/// for an unknown name.
template <class T, class Stored>
void from_stored(T& value, const Stored& stored, const std::string& where) {
  if constexpr (std::is_enum_v<T>) {
    const auto names = enum_names(value);
    const auto at = std::find(names.begin(), names.end(), stored);
    if (at == names.end()) throw ImageError(where + ": unknown value '" + stored + "'");
    value = static_cast<T>(at - names.begin());
  } else {
    value = stored;
  }
}

/// Writes or reads an enumeration, which is stored as a text attribute.
template <class Archive, class Enum>
void visit_enum(Archive& archive, const std::string& group, const std::string& name, Enum& value) {
  std::string text = to_stored(value);
  archive.attribute(group, name, text);
  if constexpr (Archive::kReads) from_stored(value, text, group + "@" + name);
}

/// @return true if the archive contains the items that were introduced with the given schema version
template <class Archive>
bool has_items_since(const Archive& archive, int schema) {
  if constexpr (Archive::kReads)
    return archive.schema() >= schema;
  else
    return true;
}

/// An optional item, which is present if its group exists. A reader creates it with default values.
/// @return true if the item is present and its members are to be visited
template <class Archive, class Optional>
bool visit_optional(Archive& archive, const std::string& group, Optional& item) {
  if constexpr (Archive::kReads) {
    if (!archive.has(group)) return false;
    item.emplace();
  }
  return item.has_value();
}

/// A member of a record type: the name of its dataset, the pointer to the member, its unit and its description.
template <class Record, class Member>
struct Field {
  const char* name;
  Member Record::*member;
  const char* unit;
  const char* description;
};
// Clang 14 cannot deduce the template arguments of an aggregate without this guide.
template <class Record, class Member>
Field(const char*, Member Record::*, const char*, const char*) -> Field<Record, Member>;

/// Writes or reads one member of all records, which is stored as one dataset.
/// @param first  true for the first member, whose dataset determines the number of records to be read
template <class Archive, class Items, class Record, class Member>
void visit_member(Archive& archive, const std::string& group, Items& items, bool first,
                  const Field<Record, Member>& field) {
  std::vector<decltype(to_stored(Member{}))> values;
  for (const Record& item : items) values.push_back(to_stored(item.*field.member));
  const Leaf leaf{group + "/" + field.name, field.description, {field.unit}};
  archive.array(leaf, values, {Archive::kReads && first ? kAnyRows : items.size()});
  if constexpr (Archive::kReads) {
    items.resize(values.size());
    for (std::size_t i = 0; i < values.size(); ++i) from_stored(items[i].*field.member, values[i], leaf.path);
  }
}

/// Writes or reads a list of records, which is stored as a group with one dataset per member. MATLAB and NumPy can read
/// this form directly.
template <class Archive, class Items, class... Fields>
void visit_records(Archive& archive, const std::string& group, const std::string& description, Items& items,
                   const Fields&... fields) {
  archive.group(group, description);
  bool first = true;
  ((visit_member(archive, group, items, first, fields), first = false), ...);
}

/// Writes or reads a dataset with one named column for each item (variable, objective, margin ..).
/// @param items   their names and units label the columns
/// @param values  one row after the other
/// @param extent  {number of rows}; {}: a single row, which is stored as a one-dimensional dataset
template <class Archive, class Items, class Values>
void visit_matrix(Archive& archive, const std::string& path, const char* description, const Items& items,
                  Values&& values, Extent extent = {}) {
  Leaf leaf{path, description, {}};
  for (const auto& item : items) {
    leaf.units.push_back(item.unit);
    leaf.columns.push_back(item.name);
  }
  extent.push_back(items.size());
  archive.array(leaf, values, extent);
}

/// Writes or reads an array of three values, such as the numbers of cells of a voxel map; the archives handle vectors
/// only.
template <class Archive, class Array>
void visit_array_of_three(Archive& archive, const Leaf& leaf, Array& values) {
  std::vector copy(std::begin(values), std::end(values));
  archive.array(leaf, copy, {3});
  if constexpr (Archive::kReads) std::copy(copy.begin(), copy.end(), values);
}

}  // namespace pkm::schema
