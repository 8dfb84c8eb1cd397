// A platform that only rotates, whose orientation workspace has a closed form.
#pragma once

#include <string>

namespace pkm::test {

/// Text of a mechanism file. The tilt of the platform, the angle between its z axis and that of the base, is at most
/// the parameter `tilt`, by default 60 deg.
/// @param axes  axes of the three successive rotations, such as "zyz"
inline std::string text_of_tilting(const std::string& axes) {
  std::string text = R"toml(
[mechanism]
name = "tilting"
[parameters]
tilt = { default = "60 deg", min = 0, max = "180 deg" }
[platform]
coordinates = { a = "about 1", b = "about 2", c = "about 3" }
[[limb]]
name = "motors"
drive = "formula"
joints = { p = "a", q = "b", r = "c" }
unit = "rad"
[[margin]]
name = "tilt"
formula = "(platform.R*[0, 0, 1]).z - cos(tilt)"
unit = "1"
)toml";
  for (std::size_t k = 0; k < 3; ++k) {
    const std::string number = "about " + std::to_string(k + 1);
    text.replace(text.find(number), number.size(), "about " + axes.substr(k, 1));
  }
  return text;
}

}  // namespace pkm::test
