// Mobility of the platform: limbs that leave it more degrees of freedom than it has coordinates.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/unit/config/chain_robots.hpp"

namespace pkm::mobility_test {
namespace {

using test::read_robot, test::substituted, test::spatial, test::why_undefined;
using ::testing::HasSubstr;
using Robot = std::shared_ptr<const Mechanism>;

// A Delta with a limb that has a single rod instead of a pair.
TEST(Mobility, OfADeltaWithABrokenLimbIsTooLarge) {
  const std::string delta = test::text_of_mechanism("rotary-delta");
  const auto from = delta.find("[[limb]]"), to = delta.find("\n\n", from);
  const std::string limb = delta.substr(from, to - from) + "\n";
  const std::string two = substituted(limb, "number = 3", "angles = [0, \"120 deg\"]"),
                    one = substituted(substituted(limb, "number = 3", "angles = [\"240 deg\"]"), "\"arm\"", "\"last\"");
  const std::string text = delta.substr(0, from) + two + substituted(one, "\npair [^\n]*", "") + delta.substr(to);
  const Robot robot = read_robot(text);
  EXPECT_THAT(describe_mechanism(*robot), HasSubstr("3 of 4 degrees of freedom at this pose"));
  EXPECT_EQ(why_undefined(*robot, "constraint_singular_value"),
            "the joints of the limbs transmit 2 constraint forces and couples, but 3 motions are not among the "
            "coordinates");
}

// Spherical joints at the platform let it rotate, even if the coordinates do not contain the rotations.
TEST(Mobility, OfAChainThatEndsInASphericalJointIncludesRotations) {
  std::string text =
      spatial("chain = [\"P\", \"R\", \"S\"]\naxes = [[0, 0, 1], [0, 1, 0]]\nlinks = [\"L\"]\nbranch = \"+\"\n");
  text = substituted(text, "coordinates = [^\n]*", "coordinates = { z = \"along z\" }");
  text = substituted(text, "\n\\[platform.follows\\]\n[^\n]*\n[^\n]*\n[^\n]*\n", "\n");
  text = substituted(text, "\nbox = [^\n]*", "\nbox = { z = [-0.6, 0.6] }");
  const Robot robot = read_robot(text);
  EXPECT_THAT(describe_mechanism(*robot), HasSubstr("do not prevent rotation about x, rotation about y"));
  EXPECT_EQ(why_undefined(*robot, "constraint_singular_value"),
            "the joints of the limbs transmit 3 constraint forces and couples, but 5 motions are not among the "
            "coordinates");
}

}  // namespace
}  // namespace pkm::mobility_test
