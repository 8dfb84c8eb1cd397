#include "tests/house/include_rules.hpp"

#include <algorithm>
#include <regex>
#include <sstream>

namespace pkm::house {
namespace {

using Words = std::vector<std::string>;

// Layers of engine/, lowest first. A folder may include itself and lower layers.
const Words kLayers = {"core",      "math",      "expression", "geometry",     "motion",  "dynamics",
                       "mechanism", "workspace", "generic",    "accelerators", "problem", "optimisers",
                       "storage",   "config",    "results",    "runner",       "export",  "report"};

// The folders in which the headers of a library may be included.
struct Library {
  std::string start;  // of the names of its headers
  Words folders;
};
const std::vector<Library> kLibraries = {
    {"hdf5.h", {"engine/storage"}},
    {"xxhash.h", {"engine/storage"}},
    {"Random123/", {"engine/math"}},
    {"toml++/", {"engine/config"}},
    {"nlopt.h", {"engine/optimisers"}},
    {"omp.h", {"engine/core"}},
    {"mpi.h", {"engine/core"}},
    {"Ip", {"engine/optimisers"}},
    {"nlohmann/", {"engine/config", "engine/report", "engine/runner", "experiments/app"}},
    {"CLI/", {"experiments/app"}},
    {"zlib.h", {"engine/export"}},
};
// Headers that may be included everywhere.
const Words kSystem = {"Eigen/", "sys/", "unistd.h", "fcntl.h", "poll.h", "sched.h", "signal.h", "spawn.h"};

// Includes that are forbidden although the layering would allow them, with the reason.
struct Ban {
  std::string from, to, reason;
};
const std::vector<Ban> kBans = {
    {"engine/storage", "engine/optimisers", "storage uses the data structures of engine/problem only"},
    {"engine/export", "engine/runner", "export must not depend on running studies"},
    {"engine/report", "engine/runner", "runner and report must not include each other"},
};

bool one_of(const std::string& word, const Words& words) { return std::ranges::find(words, word) != words.end(); }
bool starts_with_one_of(const std::string& word, const Words& starts) {
  return std::ranges::any_of(starts, [&](const std::string& start) { return word.starts_with(start); });
}

/// "engine/core" of "engine/core/error.hpp", "objectives" of "objectives/all.hpp".
std::string folder_of(const std::string& path) {
  const auto first = path.find('/');
  if (first == std::string::npos) return "";
  const bool deep = path.starts_with("engine/") || path.starts_with("experiments/");
  const auto second = deep ? path.find('/', first + 1) : std::string::npos;
  return path.substr(0, second == std::string::npos ? first : second);
}

/// Layer number of an engine folder; -1 for every other folder.
int layer(const std::string& folder) {
  if (!folder.starts_with("engine/")) return -1;
  const auto found = std::ranges::find(kLayers, folder.substr(7));
  return found == kLayers.end() ? -1 : static_cast<int>(found - kLayers.begin());
}

/// Subfolder of an engine folder that contains the file: "hybrid" for "engine/accelerators/hybrid/survey.hpp"; "" if
/// the file is not in a subfolder.
std::string subfolder_of(const std::string& path) {
  const std::string rest = path.substr(std::min(path.size(), folder_of(path).size() + 1));
  const auto end = rest.find('/');
  return path.starts_with("engine/") && end != std::string::npos ? rest.substr(0, end) : "";
}

/// Why a file may not include a header of this project; "" if it may.
std::string check_own_header(const std::string& path, const std::string& header) {
  const std::string from = folder_of(path), to = folder_of(header);
  if (to.empty() ||
      !starts_with_one_of(to, {"engine", "objectives", "constraints", "experiments", "tests", "benchmarks"}))
    return "header paths must be relative to the repository root";
  if (from == to || from == "experiments/app" || from == "tests" || from == "benchmarks") {
    const bool climbs = from == "experiments/app" && (to == "tests" || to == "benchmarks");
    const std::string here = subfolder_of(path), there = subfolder_of(header);
    if (!here.empty() && !there.empty() && here != there) return "subfolders of " + to + " must not include each other";
    return climbs ? "the program must not include " + to : "";
  }
  if (from == "experiments/checker")
    return to == "engine/expression" || to == "engine/math"
               ? ""
               : "the proof checker may use engine/expression and engine/math only";
  // The reader of mechanism files builds generic mechanisms; nothing else depends on how a mechanism is evaluated.
  const bool builds = (path.starts_with("engine/config/mechanism_") && to == "engine/generic") ||
                      path == "engine/config/built_in_mechanisms.cpp";
  if (!builds && (to == "engine/generic" || to == "engine/accelerators"))
    return "mechanisms are used through engine/mechanism only";
  if (from == "objectives" || from == "constraints")
    return layer(to) >= 0 && layer(to) <= layer("engine/problem")
               ? ""
               : from + " may include engine/core to engine/problem only";
  if (layer(from) < 0) return from + " is not a known folder";
  if (layer(to) < 0) return "engine may include engine only";
  for (const Ban& ban : kBans)
    if (ban.from == from && ban.to == to) return ban.reason;
  return layer(to) <= layer(from) ? "" : from + " is a lower layer than " + to;
}

/// Why a file may not include an external header; "" if it may.
std::string check_external_header(const std::string& path, const std::string& header) {
  const std::string folder = folder_of(path);
  if (folder == "tests" || folder == "benchmarks") return "";
  if (starts_with_one_of(header, kSystem)) return "";
  const auto library =
      std::ranges::find_if(kLibraries, [&](const Library& each) { return header.starts_with(each.start); });
  if (library == kLibraries.end())
    return header.find_first_of("/.") == std::string::npos ? "" : "is not listed in tests/house/include_rules.cpp";
  if (!one_of(folder, library->folders)) {
    std::string folders;
    for (const auto& each : library->folders) folders += (folders.empty() ? "" : " or ") + each;
    return "may be included in " + folders + " only";
  }
  // Headers that CMakeLists.txt does not install, such as those of the program, may include the library: users of the
  // installed package do not see them.
  const bool own = folder == "experiments/app" || path == "engine/report/json_text.hpp";
  return path.ends_with(".cpp") || own ? "" : "may be included in .cpp files only";
}

const std::regex kInclude(R"(^\s*#\s*include\s*(["<])([^">]+)[">].*$)");

}  // namespace

bool includes_first(const std::string& source, const std::string& header) {
  std::istringstream lines(source);
  std::string line;
  for (std::smatch match; std::getline(lines, line);)
    if (std::regex_match(line, match, kInclude)) return match[1] == "\"" && match[2] == header;
  return false;
}

std::vector<std::string> violations(const std::string& path, const std::string& text) {
  std::vector<std::string> sentences;
  std::istringstream lines(text);
  std::string line;
  for (std::smatch match; std::getline(lines, line);) {
    if (!std::regex_match(line, match, kInclude)) continue;
    const std::string header = match[2];
    const std::string reason = match[1] == "<" ? check_external_header(path, header) : check_own_header(path, header);
    if (!reason.empty()) sentences.push_back(path + " includes " + header + ": " + reason);
  }
  return sentences;
}

std::vector<std::string> unused_rules(const std::vector<Source>& sources) {
  std::vector<std::string> unused;
  const auto find_use = [&](const std::string& start, const std::string& folder) {
    const bool used = std::ranges::any_of(sources, [&](const Source& source) {
      return source.path.starts_with(folder) && source.text.find("#include <" + start) != std::string::npos;
    });
    if (!used) unused.push_back(start + (folder.empty() ? "" : " in " + folder));
  };
  for (const Library& library : kLibraries)
    for (const std::string& folder : library.folders) find_use(library.start, folder);
  for (const std::string& start : kSystem) find_use(start, "");
  return unused;
}

}  // namespace pkm::house
