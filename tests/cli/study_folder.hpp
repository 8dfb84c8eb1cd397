// Temporary folder for the files of a test, removed by the destructor.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

namespace pkm::testing {

class StudyFolder {
 public:
  StudyFolder() : path_((std::filesystem::temp_directory_path() / "pkmopt-test-XXXXXX").string()) {
    if (!mkdtemp(path_.data())) throw std::runtime_error("no temporary folder");
  }
  ~StudyFolder() { std::filesystem::remove_all(path_); }
  StudyFolder(const StudyFolder&) = delete;
  StudyFolder& operator=(const StudyFolder&) = delete;

  const std::string& path() const { return path_; }
  /// Writes a file and returns its path.
  std::string write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ + "/" + name) << text;
    return path_ + "/" + name;
  }

 private:
  std::string path_;
};

/// Text of a study of 4PPa-2PaR. @param more  inserted after the mechanism and its variables
inline std::string study_with(const std::string& more) {
  return "[mechanism]\ntype = \"4ppa-2par\"\n[variables]\na = { min = 0.15, max = 0.3 }\nb = { min = 0.7, max = 1.5 "
         "}\n" +
         more + "\n[[objective]]\ntype = \"workspace-ratio\"\n[[stage]]\noptimiser = \"ga\"\n";
}

}  // namespace pkm::testing
