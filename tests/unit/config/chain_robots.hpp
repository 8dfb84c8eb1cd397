// Robots whose limbs are chains, as texts of mechanism files.
#pragma once

#include <string>

#include "tests/unit/config/mechanism_text.hpp"
#include "tests/unit/generic/files.hpp"

namespace pkm::test {

/// A planar robot with three copies of a limb.
inline std::string planar(const std::string& limb) {
  return "[mechanism]\nname = \"planar\"\n[parameters]\nR = { default = 0.35, min = 0.1, max = 1, unit = \"m\" }\n"
         "[platform]\ncoordinates = { x = \"along x\", y = \"along y\", phi = \"about z\" }\n"
         "characteristic_length = 0.1\nmass = 2\ninertia = [0, 0, 0.01]\n[survey]\n"
         "box = { x = [-0.1, 0.1], y = [-0.1, 0.1], phi = [-1, 1] }\n"
         "[[limb]]\nname = \"arm\"\ncopies = { number = 3, about = \"z\" }\ndrive = \"chain\"\n"
         "base = [\"R\", 0, 0]\nplatform = [0.08, 0, 0]\n" +
         limb;
}

inline const std::string kRRR =
    "chain = [\"R\", \"R\", \"R\"]\naxes = [[0, 0, 1], [0, 0, 1], [0, 0, 1]]\nzero = [1, 0, 0]\n"
    "links = [0.2, 0.24]\nbranch = \"+\"\ncrank_mass = 0.3\nrod_mass = 0.2\n";
inline const std::string kPRR =
    "chain = [\"P\", \"R\", \"R\"]\naxes = [[0, 1, 0], [0, 0, 1], [0, 0, 1]]\nlinks = [0.4]\nbranch = \"-\"\n"
    "slider_mass = 0.5\nrod_mass = 0.2\n";
inline const std::string kRPR =
    "chain = [\"R\", \"P\", \"R\"]\naxes = [[0, 0, 1], [0, 0, 1]]\nzero = [1, 0, 0]\n"
    "cylinder_mass = 0.3\ncylinder_centre = 0.1\npiston_mass = 0.2\npiston_centre = 0.1\n";

/// The 3-PRS of experiments, with a limb of other joints in the same planes.
inline std::string spatial(const std::string& limb) {
  std::string text = text_of_mechanism("chains/3-prs");
  const auto from = text.find("chain     ="), to = text.find("joint_platform");
  text = text.substr(0, from) + "base = [\"R\", 0, 0]\nplatform = [\"r\", 0, 0]\n" + limb + "\n# " +
         text.substr(to, text.find('\n', to) - to) + "\n";
  text = substituted(text, "\nbox = [^\n]*", "\nbox = { z = [-0.6, 0.6], alpha = [-0.5, 0.5], beta = [-0.5, 0.5] }");
  return substituted(text, "\n(q_min|q_max|tilt|swing) [^\n]*", "");
}

}  // namespace pkm::test
