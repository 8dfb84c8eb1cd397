#include "engine/config/built_in_mechanisms.hpp"

#include <stdexcept>

#include "engine/accelerators/crr_cru/accelerators.hpp"
#include "engine/accelerators/four_ppa_two_par/accelerators.hpp"
#include "engine/accelerators/hybrid/accelerators.hpp"
#include "engine/config/mechanism_draft.hpp"
#include "engine/config/mechanism_files.hpp"
#include "engine/generic/mechanism.hpp"

namespace pkm {
namespace {

/// The accelerators of a mechanism with one of its mass models.
using MakeAccelerators = Accelerators (*)(const std::string& mass_model);

std::shared_ptr<const Mechanism> build(const std::string& name, MakeAccelerators accelerators,
                                       const std::string& mass_model) {
  generic::Model model = read_mechanism_model(mechanism_file_text(name), name + ".toml", {}, mass_model);
  model.with_masses = [=](const std::string& other) { return build(name, accelerators, other); };
  const std::string chosen = model.mass_model;
  return generic::make_mechanism(std::move(model), accelerators(chosen));
}

MechanismEntry entry(const std::string& name, MakeAccelerators accelerators) {
  return {name, [=] { return build(name, accelerators, ""); }};
}

}  // namespace

const MechanismList& all_mechanisms() {
  static const MechanismList list = {
      entry("4ppa-2par", [](const std::string&) { return four_ppa_two_par::accelerators(); }),
      entry("3crr-r-cru",
            [](const std::string& masses) { return crr_cru::accelerators(crr_cru::Platform::jointed, masses); }),
      entry("quadrupteron",
            [](const std::string& masses) { return crr_cru::accelerators(crr_cru::Platform::rigid, masses); }),
      entry("2t1r-p-hybrid", [](const std::string&) { return hybrid::accelerators(); }),
  };
  return list;
}

const std::string& mechanism_file_text(const std::string& name) {
  for (const auto& [each, text] : mechanism_files())
    if (each == name) return text;
  throw std::invalid_argument("no mechanism of the catalogue is called '" + name + "'");
}

}  // namespace pkm
