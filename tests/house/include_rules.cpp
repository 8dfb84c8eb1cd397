#include "tests/house/include_rules.hpp"

#include <algorithm>
#include <regex>
#include <sstream>

namespace pkm::house {
namespace {

using Words = std::vector<std::string>;

// A folder of engine/ may include itself and those before it.
const Words kOrder = {"core",  "math",       "graph",   "model",      "motion",  "dynamics", "mechanism", "survey",
                      "limbs", "mechanisms", "problem", "optimisers", "storage", "setup",    "study",     "report"};

// Where the headers of a library may be included.
struct Library {
  std::string start;  // of its headers' names
  Words folders;
};
const std::vector<Library> kLibraries = {
    {"hdf5.h", {"engine/storage"}},
    {"xxhash.h", {"engine/storage"}},
    {"Random123/", {"engine/math"}},
    {"toml++/", {"engine/setup"}},
    {"nlopt.h", {"engine/optimisers"}},
    {"omp.h", {"engine/core"}},
    {"mpi.h", {"engine/core"}},
    {"Ip", {"engine/optimisers"}},
    {"nlohmann/", {"engine/report", "experiments/app"}},
    {"CLI/", {"experiments/app"}},
    {"zlib.h", {"experiments/app"}},
};
// May be included everywhere.
const Words kSystem = {"Eigen/", "sys/", "unistd.h", "fcntl.h", "sched.h", "signal.h", "spawn.h"};

// Not although the order would allow it, and why.
struct Ban {
  std::string from, to, reason;
};
const std::vector<Ban> kBans = {
    {"engine/storage", "engine/optimisers", "what is stored is data of engine/problem"},
    {"engine/report", "engine/study", "study and report do not include each other"},
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

/// Place of an engine folder in the order; -1 for every other folder.
int place(const std::string& folder) {
  if (!folder.starts_with("engine/")) return -1;
  const auto found = std::ranges::find(kOrder, folder.substr(7));
  return found == kOrder.end() ? -1 : static_cast<int>(found - kOrder.begin());
}

/// "hybrid" of "engine/mechanisms/hybrid/survey.hpp"; "" where a folder of the engine has no rooms, or not for it.
std::string room_of(const std::string& path) {
  const std::string rest = path.substr(std::min(path.size(), folder_of(path).size() + 1));
  const auto end = rest.find('/');
  return path.starts_with("engine/") && end != std::string::npos ? rest.substr(0, end) : "";
}

/// "" or why a file may not include a header of ours.
std::string refuse_own(const std::string& path, const std::string& header) {
  const std::string from = folder_of(path), to = folder_of(header);
  if (to.empty() ||
      !starts_with_one_of(to, {"engine", "objectives", "constraints", "experiments", "tests", "benchmarks"}))
    return "headers are named from the repository's root";
  if (from == to || from == "experiments/app" || from == "tests" || from == "benchmarks") {
    const bool climbs = from == "experiments/app" && (to == "tests" || to == "benchmarks");
    const std::string here = room_of(path), there = room_of(header);
    if (!here.empty() && !there.empty() && here != there) return "the rooms of " + to + " do not include each other";
    return climbs ? "nothing includes " + to : "";
  }
  if (from == "experiments/checker")
    return to == "engine/graph" || to == "engine/math" ? "" : "it shares the reader of formulas and the intervals only";
  // The reader of descriptions makes the mechanisms that they describe, and knows no other.
  const bool made = path.starts_with("engine/setup/mechanism_") && room_of(header) == "described";
  if (to == "engine/mechanisms") return made ? "" : "a mechanism is known by engine/mechanism alone";
  if (from == "objectives" || from == "constraints")
    return place(to) >= 0 && place(to) <= place("engine/problem")
               ? ""
               : from + " may include engine/core to engine/problem only";
  if (place(from) < 0) return from + " is no folder of the house";
  if (place(to) < 0) return "engine includes nothing but engine";
  for (const Ban& ban : kBans)
    if (ban.from == from && ban.to == to) return ban.reason;
  return place(to) <= place(from) ? "" : from + " comes before " + to;
}

/// "" or why the file may not include an outside header.
std::string refuse_outside(const std::string& path, const std::string& header) {
  const std::string folder = folder_of(path);
  if (folder == "tests" || folder == "benchmarks") return "";
  if (starts_with_one_of(header, kSystem)) return "";
  const auto library =
      std::ranges::find_if(kLibraries, [&](const Library& each) { return header.starts_with(each.start); });
  if (library == kLibraries.end())
    return header.find_first_of("/.") == std::string::npos ? "" : "is in no list of tests/house/include_rules.cpp";
  if (!one_of(folder, library->folders)) {
    std::string folders;
    for (const auto& each : library->folders) folders += (folders.empty() ? "" : " or ") + each;
    return "belongs to " + folders;
  }
  // The program's headers are its own affair, as those are that CMakeLists.txt does not install: no user includes them.
  const bool own = folder == "experiments/app" || path == "engine/report/json_text.hpp";
  return path.ends_with(".cpp") || own ? "" : "may appear in .cpp files only";
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

std::vector<std::string> broken_rules(const std::string& path, const std::string& text) {
  std::vector<std::string> broken;
  std::istringstream lines(text);
  std::string line;
  for (std::smatch match; std::getline(lines, line);) {
    if (!std::regex_match(line, match, kInclude)) continue;
    const std::string header = match[2];
    const std::string reason = match[1] == "<" ? refuse_outside(path, header) : refuse_own(path, header);
    if (!reason.empty()) broken.push_back(path + " includes " + header + ": " + reason);
  }
  return broken;
}

std::vector<std::string> dead_rules(const std::vector<Source>& sources) {
  std::vector<std::string> dead;
  const auto look_for = [&](const std::string& start, const std::string& folder) {
    const bool used = std::ranges::any_of(sources, [&](const Source& source) {
      return source.path.starts_with(folder) && source.text.find("#include <" + start) != std::string::npos;
    });
    if (!used) dead.push_back(start + (folder.empty() ? "" : " in " + folder));
  };
  for (const Library& library : kLibraries)
    for (const std::string& folder : library.folders) look_for(library.start, folder);
  for (const std::string& start : kSystem) look_for(start, "");
  return dead;
}

}  // namespace pkm::house
