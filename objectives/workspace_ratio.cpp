// Ratio of the workspace volume to the size of the mechanism (4PPa-2PaR: V_mech = pi b (l_u + l_d), table 8 of its
// paper).
#include "objectives/list.hpp"

namespace pkm {
namespace {

/// Unit of the ratio: "m^2 rad" over "m^2" is "rad"; other units are written as "volume/size".
std::string quotient(const std::string& volume, const std::string& size) {
  return volume.starts_with(size + " ") ? volume.substr(size.size() + 1) : volume + "/" + size;
}

}  // namespace

ObjectiveEntry workspace_ratio() {
  return {
      .name = "workspace-ratio",
      .meaning = "workspace volume divided by the size that the mechanism defines",
      .direction = Direction::maximise,
      .unit =
          [](const EntryContext& context) {
            return quotient(volume_unit(context.mechanism.info(), context.plan), context.mechanism.size()->unit());
          },
      .refusal =
          [](const Mechanism& mechanism) {
            return mechanism.size() ? Unsupported()
                                    : "objective workspace-ratio needs a size, and mechanism " + mechanism.info().name +
                                          " defines none";
          },
      .make =
          [](const EntryContext&) {
            return make_quantity([]<class S>(const DesignView<S>& design) {
              return S(design.workspace->volume / design.mechanism.size()->of(design.parameters));
            });
          },
      .range = nonnegative,
  };
}

}  // namespace pkm
