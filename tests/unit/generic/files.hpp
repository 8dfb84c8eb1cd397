// Mechanism files: those of experiments/mechanisms, and those of the catalogue, evaluated by the generic engine alone.
#pragma once

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "engine/config/built_in_mechanisms.hpp"
#include "engine/config/mechanism_file.hpp"
#include "engine/mechanism/mechanism.hpp"

namespace pkm::test {

inline const std::string kMechanismFolder = PKM_TEST_DATA "/../../experiments/mechanisms/";

/// "3-rpr", ..: names of the files, sorted.
inline const std::vector<std::string>& mechanism_files() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const auto& entry : std::filesystem::directory_iterator(kMechanismFolder))
      if (entry.path().extension() == ".toml") all.push_back(entry.path().stem().string());
    std::ranges::sort(all);
    return all;
  }();
  return names;
}

inline std::string text_of_file(const std::string& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

/// "cables/cogiro", ..: names of the mechanism files in the folders of experiments/mechanisms, sorted; without those of
/// studies.
inline const std::vector<std::string>& mechanism_files_in_folders() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const std::string folder : {"cables/", "chains/", "frames/"})
      for (const auto& entry : std::filesystem::directory_iterator(kMechanismFolder + folder))
        if (text_of_file(entry.path()).find("\n[platform]") != std::string::npos)
          all.push_back(folder + entry.path().stem().string());
    std::ranges::sort(all);
    return all;
  }();
  return names;
}

/// Of a file of experiments/mechanisms, or of the catalogue.
inline std::string text_of_mechanism(const std::string& name) {
  if (std::ranges::any_of(all_mechanisms(), [&](const MechanismEntry& entry) { return entry.name() == name; }))
    return mechanism_file_text(name);
  return text_of_file(kMechanismFolder + name + ".toml");
}

/// Read once.
inline const std::shared_ptr<const Mechanism>& described(const std::string& name) {
  static std::map<std::string, std::shared_ptr<const Mechanism>> read;
  auto& mechanism = read[name];
  if (!mechanism) mechanism = read_mechanism_toml(text_of_mechanism(name), name + ".toml");
  return mechanism;
}

/// The defaults, and what JSON gives in their place.
inline std::vector<double> design_with(const MechanismInfo& info, const nlohmann::json& given) {
  std::vector<double> design;
  for (const Parameter& p : info.parameters) design.push_back(given.value(p.name, p.nominal));
  return design;
}

inline LimitSpec limits_with(const MechanismInfo& info, const nlohmann::json& given) {
  LimitSpec limits = no_limits(info);
  for (std::size_t i = 0; i < info.limits.size(); ++i)
    if (given.contains(info.limits[i].name)) limits.given[i] = given[info.limits[i].name].get<double>();
  return limits;
}

}  // namespace pkm::test
