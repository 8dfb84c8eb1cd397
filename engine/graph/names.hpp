// The names that a formula may use, in a hash table: a file may have 10^5 of them.
#pragma once

#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

namespace pkm::graph {

class Names {
 public:
  Names() = default;
  Names(const std::vector<std::string>& names) {  // not explicit: a list of names are names
    for (const std::string& name : names) add(name);
  }

  /// Appends a name, which is not among them.
  void add(const std::string& name) {
    positions_.try_emplace(name, all_.size());
    all_.push_back(name);
  }
  /// Its position among all; std::nullopt: there is no such name.
  std::optional<std::size_t> find(const std::string& name) const {
    const auto found = positions_.find(name);
    return found == positions_.end() ? std::nullopt : std::optional(found->second);
  }
  const std::vector<std::string>& all() const { return all_; }

 private:
  std::vector<std::string> all_;
  std::unordered_map<std::string, std::size_t> positions_;
};

}  // namespace pkm::graph
