// The options --urdf, --sdf and --mjcf: files of a design's multibody model for simulation programs.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "experiments/app/target.hpp"

namespace pkm {

/// Names of the files to be written; "" for a file that is not requested.
struct ModelFiles {
  std::string urdf, sdf, mjcf;

  bool any() const { return !urdf.empty() || !sdf.empty() || !mjcf.empty(); }
};
/// Declares --urdf, --sdf and --mjcf.
void add_model_options(CLI::App& command, ModelFiles& files);
/// File extensions of the three formats, with the variables that hold the file names, for the option -o.
std::vector<std::pair<std::string, std::string*>> extensions_of(ModelFiles& files);

/// Names and contents of the requested files, and of the YAML file that accompanies a URDF file. Throws ConfigError if
/// the mechanism has no multibody model.
/// @param title  text that states what the files contain
std::vector<std::pair<std::string, std::string>> model_texts(const ModelFiles& files, const Target& target,
                                                             const std::string& mode, const Pose<double>& pose,
                                                             const std::string& title);
/// Names of the model files that are requested, and of the YAML file that accompanies a URDF file.
std::vector<std::string> model_file_names(const ModelFiles& files);

}  // namespace pkm
