// Mechanisms whose workspaces have several components, of known sizes.
#pragma once

#include <memory>
#include <string>

#include "engine/config/mechanism_file.hpp"

namespace pkm::test {

/// Two telescopes with bases at (-d/2, 0) and (d/2, 0) that end in one point; their lengths are in [a, b].
inline std::shared_ptr<const Mechanism> two_telescopes(double a, double b, double d) {
  const auto leg = [](const std::string& name, const std::string& x) {
    return "[[limb]]\nname = \"" + name + "\"\ndrive = \"telescope\"\nacross = [0, 0, 1]\nbase = [\"" + x +
           "\", 0, 0]\nplatform = [0, 0, 0]\nrange = [\"a\", \"b\"]\n";
  };
  const auto parameter = [](const std::string& name, double value) {
    return name + " = { default = " + std::to_string(value) +
           ", min = 0.1, max = 9, unit = \"m\", meaning = \"length\" }\n";
  };
  return read_mechanism_toml(
      "[mechanism]\nname = \"telescopes\"\n[parameters]\n" + parameter("a", a) + parameter("b", b) + parameter("d", d) +
          "[platform]\ncoordinates = { x = \"along x\", y = \"along y\" }\n[survey]\nsweep = [\"x\", \"y\"]\n"
          "box = { x = [\"-b\", \"b\"], y = [\"-b\", \"b\"] }\n" +
          leg("left", "-d/2") + leg("right", "d/2"),
      "telescopes.toml");
}

/// A 3-RPR: base joints on a circle of radius 1 m, platform joints on one of 0.3 m, legs from 0.75 to 1.1 m.
/// @param sweep  "phi", or "x, y, phi" as a TOML list
inline std::string symmetric_3_rpr(const std::string& sweep) {
  std::string text =
      "[mechanism]\nname = \"symmetric-3-rpr\"\n[parameters]\n"
      "r = { default = \"0.3 m\", min = 0.1, max = 1, unit = \"m\", meaning = \"radius of the platform\" }\n"
      "[platform]\ncoordinates = { x = \"along x\", y = \"along y\", phi = \"about z\" }\n"
      "[survey]\nsweep = [" +
      sweep +
      "]\nfixed = { x = 0, y = 0 }\n"
      "box = { x = [-1.5, 1.5], y = [-1.5, 1.5], phi = [\"-pi\", \"pi\"] }\n";
  for (const std::string k : {"0", "1", "2"})
    text += "[[limb]]\nname = \"leg" + k + "\"\ndrive = \"telescope\"\nacross = [0, 0, 1]\nbase = [\"cos(" + k +
            "*2*pi/3)\", \"sin(" + k + "*2*pi/3)\", 0]\nplatform = [\"r*cos(" + k + "*2*pi/3)\", \"r*sin(" + k +
            "*2*pi/3)\", 0]\nrange = [0.75, 1.1]\n";
  return text;
}

}  // namespace pkm::test
