// Mechanisms of the C interface: built-in ones, and those that are read from a file or from text.
#include <algorithm>
#include <sstream>

#include "bindings/c/handles.hpp"
#include "engine/config/built_in_mechanisms.hpp"
#include "engine/config/text_file.hpp"
#include "engine/core/catalogue.hpp"
#include "experiments/app/catalogue.hpp"

namespace pkm::c {
namespace {

std::shared_ptr<const Mechanism> mechanism_of_text(const std::string& toml, const std::string& file_name,
                                                   const char* limb_parameters) {
  std::vector<LimbParameter> own;
  std::istringstream names(text_or_empty(limb_parameters));
  for (std::string name; std::getline(names, name, ',');) {
    const auto parameter = limb_parameter(name, {"", 0, "limb_parameters"});
    if (!parameter) throw ConfigError({"", 0, "limb_parameters"}, "'" + name + "'", "LIMB.PARAMETER, such as arm2.l_b");
    own.push_back(*parameter);
  }
  return read_mechanism_toml(toml, file_name, own);
}

std::vector<std::string> built_in_names() {
  std::vector<std::string> names;
  for (const MechanismEntry& entry : catalogues().mechanisms) names.push_back(entry.name());
  return names;
}

pkmopt_mechanism* handle(std::shared_ptr<const Mechanism> mechanism, std::string text) {
  return new pkmopt_mechanism{std::move(mechanism), std::move(text)};
}

}  // namespace
}  // namespace pkm::c

using namespace pkm::c;

pkmopt_status pkmopt_mechanism_names(char** json) {
  return guarded([&] { *json = allocated(Json(built_in_names())); });
}

pkmopt_status pkmopt_mechanism_by_name(const char* name, pkmopt_mechanism** mechanism) {
  return guarded([&] {
    const std::string wanted = required_text(name, "name");
    const std::vector<std::string> names = built_in_names();
    const auto found = std::ranges::find(names, wanted);
    if (found == names.end())
      throw pkm::ConfigError({"", 0, "mechanism"}, "'" + wanted + "'", "one of " + pkm::join(names),
                             pkm::nearest_name(wanted, names));
    *mechanism = handle(catalogues().mechanisms[static_cast<std::size_t>(found - names.begin())].get(),
                        pkm::mechanism_file_text(wanted));
  });
}

pkmopt_status pkmopt_mechanism_from_file(const char* path, const char* limb_parameters, pkmopt_mechanism** mechanism) {
  return guarded([&] {
    const std::string file = required_text(path, "path");
    const std::string text = pkm::read_text_file(file, "a mechanism in TOML");
    *mechanism = handle(mechanism_of_text(text, file, limb_parameters), text);
  });
}

pkmopt_status pkmopt_mechanism_from_text(const char* toml, const char* file_name, const char* limb_parameters,
                                         pkmopt_mechanism** mechanism) {
  return guarded([&] {
    const std::string text = required_text(toml, "toml");
    const std::string name = file_name ? file_name : "mechanism.toml";
    *mechanism = handle(mechanism_of_text(text, name, limb_parameters), text);
  });
}

pkmopt_status pkmopt_mechanism_with_masses(const pkmopt_mechanism* mechanism, const char* model,
                                           pkmopt_mechanism** other) {
  return guarded([&] {
    const std::string wanted = required_text(model, "model");
    const pkm::Dynamics* const dynamics = mechanism->mechanism->dynamics();
    if (!dynamics)
      throw pkm::ConfigError({"", 0, "masses"}, "mechanism " + mechanism->mechanism->info().name + " has no masses");
    auto found = dynamics->with_masses(wanted);
    if (!found)
      throw pkm::ConfigError({"", 0, "masses"}, "'" + wanted + "'", "one of " + pkm::join(dynamics->mass_models()),
                             pkm::nearest_name(wanted, dynamics->mass_models()));
    *other = handle(std::move(found), mechanism->text);
  });
}

pkmopt_status pkmopt_mechanism_info(const pkmopt_mechanism* mechanism, char** json) {
  return guarded([&] {
    Json info = pkm::mechanism_json(*mechanism->mechanism, catalogues());
    const auto units = [](const auto& axes) {
      Json list = Json::array();
      for (const pkm::AxisInfo& axis : axes) list.push_back(axis.unit);
      return list;
    };
    info["coordinate_units"] = units(mechanism->mechanism->info().coordinates);
    info["joint_units"] = units(mechanism->mechanism->info().joints);
    *json = allocated(info);
  });
}

pkmopt_status pkmopt_mechanism_text(const pkmopt_mechanism* mechanism, char** toml) {
  return guarded([&] { *toml = allocated(mechanism->text); });
}

void pkmopt_mechanism_free(pkmopt_mechanism* mechanism) { delete mechanism; }
