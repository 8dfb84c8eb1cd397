#include "engine/core/text_table.hpp"

#include <gtest/gtest.h>

namespace pkm {
namespace {

TEST(TextTable, NumbersHaveTheirPointsBelowOneAnother) {
  EXPECT_EQ(aligned({{"", "best", "gain"}, {"a", "0.5", "+1.5 %"}, {"force", "12.25", ""}, {"c", "-3e-17", "-10 %"}}),
            "         best    gain\n"
            "  a       0.5     +1.5 %\n"
            "  force  12.25\n"
            "  c      -3e-17  -10 %\n");
}

TEST(TextTable, ColumnsWithWordsBeginAtTheLeft) {
  EXPECT_EQ(aligned({{"method", "columns"}, {"volume", "0.5 m"}, {"columns", "15"}}),
            "  method   columns\n"
            "  volume   0.5 m\n"
            "  columns  15\n");
}

TEST(TextTable, NumbersThatAreNotKnownLeaveAColumnOne) {
  EXPECT_EQ(aligned({{"a", "10 m"}, {"b", "-"}, {"c", "not computed"}, {"d", "2.5 m"}}),
            "  a  10 m\n"
            "  b  -\n"
            "  c  not computed\n"
            "  d   2.5 m\n");
}

TEST(TextTable, CharactersOfSeveralBytesTakeOnePlace) {
  EXPECT_EQ(aligned({{"Größe", "x"}, {"a", "y"}}), "  Größe  x\n  a      y\n");
}

TEST(TextTable, NumberOfAText) {
  EXPECT_EQ(point_of_number("12.5 mm"), 2U);
  EXPECT_EQ(point_of_number("-3e-17"), 2U);
  EXPECT_EQ(point_of_number("+7 of 9"), 2U);
  for (const char* words : {"", "-", "4ppa-2par", "inf", "nan", "1,2", "m 3"})
    EXPECT_EQ(point_of_number(words), std::nullopt) << words;
}

}  // namespace
}  // namespace pkm
