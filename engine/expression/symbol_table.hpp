// Symbol table of formulas: the variables that a formula may use, in a hash table, because a mechanism file may define
// 10^5 of them.
#pragma once

#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

namespace pkm::expression {

class Names {
 public:
  Names() = default;
  Names(const std::vector<std::string>& names) {  // not explicit: callers pass plain lists
    for (const std::string& name : names) add(name);
  }

  /// Whether error messages about an unknown name list this name among the known ones.
  enum class Listing { always, never };
  /// Appends a name that is not in the table yet.
  void add(const std::string& name, Listing listing = Listing::always) {
    indices_.try_emplace(name, indices_.size());
    if (listing == Listing::always) listed_.push_back(name);
  }
  /// Position of a name in the order in which the names were added; std::nullopt if it is not in the table.
  std::optional<std::size_t> find(const std::string& name) const {
    const auto found = indices_.find(name);
    return found == indices_.end() ? std::nullopt : std::optional(found->second);
  }
  const std::vector<std::string>& listed() const { return listed_; }

 private:
  std::vector<std::string> listed_;
  std::unordered_map<std::string, std::size_t> indices_;
};

}  // namespace pkm::expression
