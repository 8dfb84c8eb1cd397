#include "engine/export/csv_table.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace pkm {
namespace {

TEST(CsvTable, QuotesSeparatorsQuotesAndLineBreaks) {
  CsvTable table({"plain", "with, comma", column_header("a", "m"), column_header("ratio", "1")});
  table.begin_row();
  table.add("say \"no\"");
  table.add(std::string("two\nlines"));
  table.add(0.1);
  table.add(std::int64_t{-7});
  EXPECT_EQ(table.text(), "plain,\"with, comma\",a [m],ratio\n\"say \"\"no\"\"\",\"two\nlines\",0.1,-7\n");
}

TEST(CsvTable, PrefixesTextThatASpreadsheetWouldExecute) {
  CsvTable table({"=1+1", "-7"});
  table.row(std::string("@SUM(A1)"), std::string("-cmd|' /C calc'!A0"));
  table.row(std::string("+1.5e3"), std::string("+x"));
  table.row(std::string("\t=1"), std::string("=a,\"b\""));
  table.row(-7.5, -3);
  EXPECT_EQ(table.text(), "'=1+1,-7\n'@SUM(A1),'-cmd|' /C calc'!A0\n+1.5e3,'+x\n'\t=1,\"'=a,\"\"b\"\"\"\n-7.5,-3\n");
}

TEST(CsvTable, NumbersAreWrittenWithFullPrecision) {
  for (const double value : {1.0 / 3, 5e-324, 1.7976931348623157e308, -2.5e-7}) {
    CsvTable table({"x"});
    table.begin_row();
    table.add(value);
    EXPECT_EQ(std::strtod(table.text().c_str() + 2, nullptr), value);
  }
}

TEST(CsvTable, WritesEmptyCellsForMissingValues) {
  CsvTable table({"a", "b", "c", "d", "e"});
  table.begin_row();
  table.add(std::nan(""));
  table.add_empty(2);
  table.add(std::numeric_limits<double>::infinity());
  table.add(-std::numeric_limits<double>::infinity());
  EXPECT_EQ(table.text(), "a,b,c,d,e\n,,,inf,-inf\n");
}

}  // namespace
}  // namespace pkm
