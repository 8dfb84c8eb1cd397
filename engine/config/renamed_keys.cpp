#include "engine/config/renamed_keys.hpp"

#include <array>
#include <utility>

#include "engine/core/error.hpp"

namespace pkm {
namespace {

constexpr std::array<std::pair<std::string_view, std::string_view>, 2> kRenamedOptions = {
    {{"--certain", "--certified"}, {"--held", "--fixed"}}};

}  // namespace

std::span<const RenamedKey> renamed_keys() {
  static const std::array<RenamedKey, 3> keys = {{{TextKind::study, {"workspace", "certain"}, "certified"},
                                                  {TextKind::study, {"report"}, "output"},
                                                  {TextKind::mechanism, {"survey", "hold"}, "fixed"}}};
  return keys;
}

std::string present_name(std::string_view path) {
  for (const RenamedKey& key : renamed_keys())
    if (join(key.path, ".") == path) return key.name;
  return "";
}

std::string present_option(std::string_view option) {
  for (const auto& [old_name, name] : kRenamedOptions)
    if (option == old_name) return std::string(name);
  return "";
}

}  // namespace pkm
