#include "experiments/app/model_files.hpp"

#include <filesystem>
#include <stdexcept>

#include "engine/export/multibody_files.hpp"
#include "engine/generic/multibody_model.hpp"

namespace pkm {
namespace {

/// Name of the YAML file with the loop closures that accompanies a URDF file: links.yaml for links.urdf.
std::string yaml_beside(const std::string& urdf) { return std::filesystem::path(urdf).replace_extension(".yaml"); }

}  // namespace

void add_model_options(CLI::App& command, ModelFiles& files) {
  add_option(command, "--urdf FILE", files.urdf,
             "Write a model for simulation as URDF (ROS), with its loop closures in a YAML file beside it");
  add_option(command, "--sdf FILE", files.sdf, "Write a model for simulation as SDF (Gazebo)");
  add_option(command, "--mjcf FILE", files.mjcf, "Write a model for simulation as MJCF (MuJoCo, .xml)");
}

std::vector<std::pair<std::string, std::string*>> extensions_of(ModelFiles& files) {
  return {{".sdf", &files.sdf}, {".urdf", &files.urdf}, {".xml", &files.mjcf}};
}

std::vector<std::string> model_file_names(const ModelFiles& files) {
  std::vector<std::string> names;
  if (!files.urdf.empty()) names = {files.urdf, yaml_beside(files.urdf)};
  for (const std::string& file : {files.sdf, files.mjcf})
    if (!file.empty()) names.push_back(file);
  return names;
}

std::vector<std::pair<std::string, std::string>> model_texts(const ModelFiles& files, const Target& target,
                                                             const std::string& mode, const Pose<double>& pose,
                                                             const std::string& title) {
  MultibodyModel model;
  try {
    model = generic::multibody_model(*target.mechanism, target.parameters, pose, mode);
  } catch (const DesignError&) {
    throw;
  } catch (const std::invalid_argument& reason) {
    const char* const option = !files.mjcf.empty() ? "--mjcf" : !files.sdf.empty() ? "--sdf" : "--urdf";
    throw ConfigError({"", 0, option},
                      "mechanism " + target.info().name + " has no model for simulation: " + reason.what());
  }
  std::vector<std::pair<std::string, std::string>> texts;
  if (!files.urdf.empty()) {
    texts.emplace_back(files.urdf, urdf_text(model, title));
    const std::string name = std::filesystem::path(files.urdf).filename();
    texts.emplace_back(yaml_beside(files.urdf), loop_closures_yaml(model, name, title));
  }
  if (!files.sdf.empty()) texts.emplace_back(files.sdf, sdf_text(model, title));
  if (!files.mjcf.empty()) texts.emplace_back(files.mjcf, mjcf_text(model, title));
  return texts;
}

}  // namespace pkm
