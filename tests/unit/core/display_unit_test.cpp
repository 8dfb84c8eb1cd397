#include "engine/core/display_unit.hpp"

#include <gtest/gtest.h>

namespace pkm {
namespace {

TEST(DisplayUnit, SuitsTheMagnitude) {
  EXPECT_EQ(display_unit("m").name, "mm");
  EXPECT_EQ(display_unit("m", 0).name, "mm");
  EXPECT_EQ(display_unit("m", -20).name, "m");
  EXPECT_EQ(display_unit("m", 5e-6).name, "um");
  EXPECT_EQ(display_unit("m", 1e-17).name, "mm") << "a rounding error";
  EXPECT_EQ(display_unit("m^3", 0.2).name, "m^3");
  EXPECT_EQ(display_unit("m^3", 2e-4).name, "cm^3");
  EXPECT_EQ(display_unit("Pa", 2e8).name, "MPa");
  EXPECT_EQ(display_unit("kg m^2", 1e-6).name, "kg m^2") << "other units stay";
  EXPECT_DOUBLE_EQ(display_unit("m^2", 1e-5).size, 1e-6);
}

TEST(DisplayUnit, ShowsGivenValuesWithoutTheRoundingErrorOfTheConversion) {
  EXPECT_EQ(display_text(0.07, "m"), "70 mm");
  EXPECT_EQ(display_text(1.5707963267948966, "rad"), "90 deg");
  EXPECT_EQ(display_text(1.00013, "m"), "1000.13 mm");
  EXPECT_EQ(display_text(0.25, "1"), "0.25");
  EXPECT_EQ(display_text(2, "kg"), "2 kg");
  EXPECT_EQ(display_range(-0.5235987755982988, 0.5235987755982988, "rad"), "-30 .. 30 deg");
}

}  // namespace
}  // namespace pkm
