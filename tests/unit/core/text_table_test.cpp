#include "engine/core/text_table.hpp"

#include <gtest/gtest.h>

namespace pkm {
namespace {

TEST(TextTable, DecimalPointsAreAligned) {
  EXPECT_EQ(aligned({{"", "best", "gain"}, {"a", "0.5", "+1.5 %"}, {"force", "12.25", ""}, {"c", "-3e-17", "-10 %"}}),
            "         best    gain\n"
            "  a       0.5     +1.5 %\n"
            "  force  12.25\n"
            "  c      -3e-17  -10 %\n");
}

TEST(TextTable, ColumnsWithWordsAreLeftAligned) {
  EXPECT_EQ(aligned({{"method", "columns"}, {"volume", "0.5 m"}, {"columns", "15"}}),
            "  method   columns\n"
            "  volume   0.5 m\n"
            "  columns  15\n");
}

TEST(TextTable, MissingNumbersDoNotMakeAColumnTextual) {
  EXPECT_EQ(aligned({{"a", "10 m"}, {"b", "-"}, {"c", "not computed"}, {"d", "2.5 m"}}),
            "  a  10 m\n"
            "  b  -\n"
            "  c  not computed\n"
            "  d   2.5 m\n");
}

TEST(TextTable, MultibyteCharactersHaveWidthOne) {
  EXPECT_EQ(aligned({{"Größe", "x"}, {"a", "y"}}), "  Größe  x\n  a      y\n");
}

TEST(TextTable, DecimalPointOfATextWithANumber) {
  EXPECT_EQ(decimal_point_index("12.5 mm"), 2U);
  EXPECT_EQ(decimal_point_index("-3e-17"), 2U);
  EXPECT_EQ(decimal_point_index("+7 of 9"), 2U);
  for (const char* words : {"", "-", "4ppa-2par", "inf", "nan", "1,2", "m 3"})
    EXPECT_EQ(decimal_point_index(words), std::nullopt) << words;
}

}  // namespace
}  // namespace pkm
