// Tables are read by their descriptions: keys and values that a description lacks are refused, and a reader that reads
// something else than what the description has is an error of the program.
#include "engine/config/config_value.hpp"

#include <gmock/gmock.h>

#include "engine/config/mechanism_keys.hpp"
#include "engine/config/study_keys.hpp"
#include "engine/core/catalogue.hpp"

namespace pkm {
namespace {

const TableSpec kInnerTable = {.meaning = "inner", .keys = {{.name = "q", .kind = OptionKind::flag, .initial = false}}};
const TableSpec kSampleTable = {
    .header = "[table]",
    .meaning = "a table",
    .keys = {{.name = "length", .unit = "m", .initial = 0.5, .upper = 2, .meaning = "its length", .positive = true},
             {.name = "count",
              .kind = OptionKind::integer,
              .required = true,
              .lower = 1,
              .upper = 9,
              .meaning = "how many"},
             {.name = "shape", .kind = OptionKind::word, .choices = {"box", "ball"}},
             {.name = "inner", .kind = OptionKind::table, .table = &kInnerTable},
             {.name = "axes", .kind = OptionKind::list, .count = 2, .parts = {{.unit = "rad"}}},
             {.name = "gap",
              .kind = OptionKind::any_of,
              .parts = {{.kind = OptionKind::flag}, {.kind = OptionKind::formula, .unit = "m"}}}},
    .choice = "shape",
    .variants = {{"box", "a box", {{.name = "size", .unit = "m"}}},
                 {"ball", "a ball", {{.name = "radius", .unit = "m"}}}},
    .named = {{.unit = kUnitOfEntry}}};

/// Reads a document as kSampleTable. @param names  of coordinates
template <class Read>
std::string reading_message(const std::string& text, Read read, const std::vector<std::string>& names = {"x"}) {
  const TomlValue document = parse_toml(text, "f.toml");
  try {
    read(ConfigValue(document, "f.toml", "").described_by(kSampleTable, named_keys(kSampleTable, names)));
  } catch (const ConfigError& error) {
    return error.what();
  } catch (const std::logic_error& error) {
    return std::string("logic_error: ") + error.what();
  }
  return "accepted";
}
const auto read_nothing = [](const ConfigValue&) {};
const std::string kBoxText = "shape = \"box\"\n";

TEST(ConfigValue, RefusesKeysThatADescriptionLacks) {
  EXPECT_EQ(reading_message(kBoxText + "size = 1\nx = 1\n", read_nothing), "accepted");
  EXPECT_EQ(reading_message(kBoxText + "radius = 1", read_nothing),
            "f.toml:2: radius: found an unknown key; expected one of length, count, shape, inner, axes, gap, x, size");
  EXPECT_THAT(reading_message(kBoxText + "lenght = 1", read_nothing), ::testing::HasSubstr("did you mean 'length'?"));
  EXPECT_THAT(reading_message(kBoxText + "y = 1", read_nothing), ::testing::HasSubstr("found an unknown key"));
  EXPECT_THAT(reading_message(kBoxText + "x = 1", read_nothing, {}), ::testing::HasSubstr("found an unknown key"));
  EXPECT_EQ(reading_message("shape = \"bal\"", read_nothing),
            "f.toml:1: shape: found \"bal\"; expected one of box, ball; did you mean 'ball'?");
  EXPECT_EQ(reading_message("size = 1", read_nothing), "f.toml:1: shape: found nothing; expected one of box, ball");
}

TEST(ConfigValue, ReadsTypeRangeAndDefaultFromTheDescription) {
  const auto length = [](const ConfigValue& table) { EXPECT_EQ(table.number_at("length"), 0.5); };
  EXPECT_EQ(reading_message(kBoxText, length), "accepted");
  EXPECT_EQ(reading_message(kBoxText + "length = \"500 mm\"", length), "accepted");
  EXPECT_EQ(reading_message(kBoxText + "length = 0", length),
            "f.toml:2: length: found 0; expected a number > 0 m and <= 2 m");
  EXPECT_THAT(reading_message(kBoxText + "length = 3", length),
              ::testing::HasSubstr("found 3; expected a number <= 2 m"));
  const auto count = [](const ConfigValue& table) { table.at("count").integer(); };
  EXPECT_EQ(reading_message(kBoxText, count),
            "f.toml:1: count: found nothing; expected an integer in [1, 9] (how many)");
  EXPECT_EQ(reading_message(kBoxText + "count = 10", count),
            "f.toml:2: count: found 10; expected an integer in [1, 9]");
  const auto inner = [](const ConfigValue& table) { EXPECT_FALSE(table.find_table("inner")->flag_at("q")); };
  EXPECT_EQ(reading_message(kBoxText + "inner = {}", inner), "accepted");
  EXPECT_EQ(reading_message(kBoxText + "inner = { p = 1 }", inner),
            "f.toml:2: inner.p: found an unknown key; expected one of q; did you mean 'q'?");
  EXPECT_EQ(reading_message(kBoxText + "inner = 1", inner), "f.toml:2: inner: found 1; expected a table { q = .. }");
}

TEST(ConfigValue, ReadersThatDifferFromTheDescriptionAreErrorsOfTheProgram) {
  const std::string text = kBoxText + "length = 1\nsize = 1\ngap = \"x\"\naxes = [1, 2]\ninner = { q = true }";
  const auto complaint = [&](auto read) { return reading_message(text, read); };
  EXPECT_EQ(complaint([](const ConfigValue& table) { table.find("width"); }),
            "logic_error: : the key width is not in the description of the table");
  EXPECT_EQ(complaint([](const ConfigValue& table) { table.find("radius"); }), "accepted")
      << "a key of another variant";
  EXPECT_EQ(complaint([](const ConfigValue& table) { table.find_number("length", "rad"); }),
            "logic_error: length is described as number [m] and read as number [rad]");
  EXPECT_THAT(complaint([](const ConfigValue& table) { table.at("size").flag(); }),
              ::testing::StartsWith("logic_error"));
  EXPECT_THAT(complaint([](const ConfigValue& table) { table.at("size").elements("a list"); }),
              ::testing::HasSubstr("expected a list"));
  EXPECT_THAT(complaint([](const ConfigValue& table) { table.at("axes").elements()[0].number("m"); }),
              ::testing::StartsWith("logic_error"));
  EXPECT_EQ(complaint([](const ConfigValue& table) { table.at("gap").expect_formula("m"); }), "accepted");
  EXPECT_THAT(complaint([](const ConfigValue& table) { table.at("gap").expect_formula("kg"); }),
              ::testing::StartsWith("logic_error"));
  EXPECT_THAT(complaint([](const ConfigValue& table) { table.find_table("inner")->find("length"); }),
              ::testing::StartsWith("logic_error"));
}

/// Expects that a description is complete: every key has a name, a meaning and a value that is described.
void expect_complete(const TableSpec& table, const std::string& path) {
  const auto check = [&](const auto& self, const OptionSpec& key, const std::string& where) -> void {
    if (key.kind == OptionKind::list) {
      ASSERT_EQ(key.parts.size(), 1U) << where;
    }
    if (key.kind == OptionKind::any_of) {
      EXPECT_GE(key.parts.size(), 2U) << where;
    }
    if (key.kind == OptionKind::table) {
      ASSERT_TRUE(key.table) << where;
      expect_complete(*key.table, where);
    }
    if (key.initial) {
      EXPECT_FALSE(key.required) << where;
    }
    for (const OptionSpec& part : key.parts) self(self, part, where);
  };
  EXPECT_NE(table.meaning, "") << path;
  std::vector<OptionSpec> keys = table.keys;
  for (const TableVariant& variant : table.variants) keys.insert(keys.end(), variant.keys.begin(), variant.keys.end());
  for (const OptionSpec& key : keys) {
    EXPECT_NE(key.name, "") << path;
    EXPECT_NE(key.meaning, "") << path << '.' << key.name;
    check(check, key, path + "." + key.name);
  }
  for (const OptionSpec& named : table.named) check(check, named, path + ".NAME");
}

TEST(Keys, AreDescribedCompletely) {
  for (const TableSpec* const table : {&study_keys(), &mechanism_keys(), &motion_file_keys(), &motor_file_keys(),
                                       &bounded_objective_keys(), &pose_constraint_keys(), &limb_parameter_keys()})
    expect_complete(*table, table->meaning);
}

}  // namespace
}  // namespace pkm
