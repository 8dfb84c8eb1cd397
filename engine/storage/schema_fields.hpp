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

inline constexpr std::array<const char*, 2> kDirectionWords{"minimise", "maximise"};
inline constexpr std::array<const char*, 3> kStateWords{"running", "interrupted", "finished"};
inline constexpr std::array<const char*, 3> kDetailWords{"enough", "complete", "derivatives"};
inline constexpr std::array<const char*, 4> kStatusWords{"feasible", "infeasible", "rejected", "failed"};

template <class Enum, std::size_t n>
Enum from_word(const std::string& word, const std::array<const char*, n>& words, const std::string& where) {
  const auto at = std::find(words.begin(), words.end(), word);
  if (at == words.end()) throw ImageError(where + ": the unknown word '" + word + "'");
  return static_cast<Enum>(at - words.begin());
}

/// An enumeration, kept as a word.
template <class Archive, class Enum, std::size_t n>
void choice(Archive& archive, const std::string& group, const std::string& name, Enum& value,
            const std::array<const char*, n>& words) {
  if constexpr (Archive::kReads) {
    std::string word;
    archive.attribute(group, name, word);
    value = from_word<Enum>(word, words, group + "@" + name);
  } else {
    archive.attribute(group, name, std::string(words[static_cast<std::size_t>(value)]));
  }
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
  constexpr bool is_direction = std::is_same_v<Member, Direction>;
  using Stored = std::conditional_t<is_direction, std::string, Member>;
  std::vector<Stored> values;
  if constexpr (!Archive::kReads) {
    for (const Record& item : items) {
      if constexpr (is_direction)
        values.push_back(kDirectionWords[static_cast<std::size_t>(item.*field.member)]);
      else
        values.push_back(item.*field.member);
    }
  }
  const Leaf leaf{group + "/" + field.name, field.description, {field.unit}, {}};
  archive.array(leaf, values, {Archive::kReads && first ? kAnyRows : items.size()});
  if constexpr (Archive::kReads) {
    if (first) items.resize(values.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
      if constexpr (is_direction)
        items[i].*field.member = from_word<Direction>(values[i], kDirectionWords, leaf.path);
      else
        items[i].*field.member = values[i];
    }
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

template <class Items>
std::vector<std::string> names(const Items& items) {
  std::vector<std::string> result;
  for (const auto& item : items) result.push_back(item.name);
  return result;
}

template <class Items>
std::vector<std::string> units(const Items& items) {
  std::vector<std::string> result;
  for (const auto& item : items) result.push_back(item.unit);
  return result;
}

/// VoxelMap keeps plain arrays of three; the archives know vectors.
template <class Archive, class Number, class Plain>
void triple(Archive& archive, const Leaf& leaf, Plain& values) {
  std::vector<Number> copy(values, values + 3);
  archive.array(leaf, copy, {3});
  if constexpr (Archive::kReads) std::copy(copy.begin(), copy.end(), values);
}

}  // namespace pkm::schema
