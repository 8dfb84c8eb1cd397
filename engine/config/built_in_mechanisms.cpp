#include "engine/config/built_in_mechanisms.hpp"

#include <array>
#include <stdexcept>

#include "engine/accelerators/crr_cru/accelerators.hpp"
#include "engine/accelerators/four_ppa_two_par/accelerators.hpp"
#include "engine/accelerators/hybrid/accelerators.hpp"
#include "engine/config/built_in_files.hpp"
#include "engine/config/mechanism_draft.hpp"
#include "engine/config/mechanism_files.hpp"
#include "engine/generic/mechanism.hpp"

namespace pkm {
namespace {

/// Function that returns the accelerators for a built-in mechanism with the given mass model.
using MakeAccelerators = Accelerators (*)(const std::string& mass_model);

std::shared_ptr<const Mechanism> build(const std::string& name, MakeAccelerators accelerators,
                                       const std::string& mass_model, const StudyAdditions& study = nullptr) {
  generic::Model model = read_mechanism_model(mechanism_file_text(name), name + ".toml", {}, mass_model, study);
  model.with_masses = [=](const std::string& other) { return build(name, accelerators, other, study); };
  const std::string chosen = model.mass_model;
  return generic::make_mechanism(std::move(model), accelerators(chosen));
}

constexpr std::array<std::pair<const char*, MakeAccelerators>, 4> kMechanisms = {{
    {"4ppa-2par", [](const std::string&) { return four_ppa_two_par::accelerators(); }},
    {"3crr-r-cru", [](const std::string& masses) { return crr_cru::accelerators(crr_cru::Platform::jointed, masses); }},
    {"quadrupteron", [](const std::string& masses) { return crr_cru::accelerators(crr_cru::Platform::rigid, masses); }},
    {"2t1r-p-hybrid", [](const std::string&) { return hybrid::accelerators(); }},
}};

}  // namespace

const MechanismList& all_mechanisms() {
  static const MechanismList list = [] {
    MechanismList all;
    for (const auto& [name, accelerators] : kMechanisms)
      all.emplace_back(
          name, [name = std::string(name), accelerators = accelerators] { return build(name, accelerators, ""); });
    return all;
  }();
  return list;
}

std::shared_ptr<const Mechanism> built_in_mechanism(const std::string& name, const StudyAdditions& study) {
  for (const auto& [each, accelerators] : kMechanisms)
    if (each == name) return build(name, accelerators, "", study);
  throw std::invalid_argument("mechanism " + name +
                              " is written in C++; [[quantity]] and limits of quantities need a mechanism file");
}

std::shared_ptr<const Mechanism> built_in_mechanism(const std::string& name, const StudyAdditions& study,
                                                    const std::vector<LimbParameter>& own) {
  const auto file = own.empty() ? std::nullopt : find_built_in_file(name);
  return file ? read_mechanism_toml(file->text, file->file_name, own, study) : built_in_mechanism(name, study);
}

std::optional<SourceText> find_built_in_file(const std::string& name) {
  for (const auto& [each, text] : mechanism_files())
    if (each == name) return SourceText{text, name + ".toml"};
  return {};
}

const std::string& mechanism_file_text(const std::string& name) {
  for (const auto& [each, text] : mechanism_files())
    if (each == name) return text;
  throw std::invalid_argument("no mechanism of the catalogue is called '" + name + "'");
}

}  // namespace pkm
