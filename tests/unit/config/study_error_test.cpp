// Documents, tables, parameters and files that are wrong.

#include <chrono>
#include <fstream>

#include "tests/unit/config/wrong_studies.hpp"

namespace pkm {
namespace {

using testing::expect_messages;
using testing::kMachine;
using testing::kStage;
using testing::kVolume;
using testing::message_of;

TEST(StudyErrors, Document) {
  expect_messages(
      "",
      {
          {"", "s.toml: found an empty file; expected a study in TOML, with [mechanism] at least"},
          {"# nothing\n", "s.toml: found an empty file; expected a study in TOML, with [mechanism] at least"},
          {"a = 1\na = 2\n",
           "s.toml:2: found text that is not TOML (Error while parsing key-value pair: cannot redefine existing "
           "integer 'a'); expected a study in TOML"},
          {"[study]\nname = \"x\nseed = 1\n",
           "s.toml:2: found text that is not TOML (Error while parsing string: unescaped control characters other "
           "than TAB (U+0009) are explicitly prohibited); expected a study in TOML"},
          {"[study]\nname = \"\xff\"\n",
           "s.toml:2: found text that is not TOML (Encountered invalid utf-8 sequence); expected a study in TOML"},
          {"[study\n",
           "s.toml:1: found text that is not TOML (Error while parsing table header: expected ']', saw '\\n'); "
           "expected a study in TOML"},
          {"[mechansim]\ntype = \"slider\"\n",
           "s.toml:1: mechansim: found an unknown table; expected one of study, mechanism, parameters, variables, "
           "baseline, "
           "workspace, region, motion, objective, constraint, output, reference, drive_train, motor, obstacle, "
           "quantity, "
           "accuracy, tolerance, "
           "stage, "
           "checkpoint, "
           "final, override; did you mean 'mechanism'?"},
          {"[study]\nname = \"x\"\n",
           "s.toml:1: mechanism: found nothing; expected a table [mechanism] with type = one of slider, or file = the "
           "name of a mechanism's file"},
      });
}

/// "one.one.one"
std::string parts(std::size_t count, const std::string& one) {
  std::string text = one;
  for (std::size_t k = 1; k < count; ++k) text += "." + one;
  return text;
}

TEST(StudyErrors, TablesNestedTooDeeply) {
  const std::string deep = "found tables nested too deeply; expected keys of at most 16 parts, in at most 32 brackets";
  for (const std::string one : {"a", "\"a\"", "'a.b'", " a "})
    for (const std::size_t count : {std::size_t{17}, std::size_t{50000}}) {
      const std::string key = parts(count, one);
      EXPECT_EQ(message_of("[" + key + "]\n"), "s.toml:1: " + deep) << one;
      EXPECT_EQ(message_of("x = 1\n" + key + " = 1\n"), "s.toml:2: " + deep) << one;
      EXPECT_EQ(message_of("x = [\n'\\', \"\\\"\", {" + key + " = 1}]\n"), "s.toml:2: " + deep) << one;
    }
  EXPECT_EQ(message_of("x = " + std::string(33, '[')), "s.toml:1: " + deep);
  EXPECT_EQ(message_of("x = \"\"\"\n\\\"\"\"\"\"\"\n\n[" + parts(17, "a") + "]\n"), "s.toml:4: " + deep);
  // Dots and brackets within text and comments are none.
  const std::string dots(100, '.'), brackets(100, '[');
  for (const std::string quote : {"\"", "'", "\"\"\"", "\'\'\'"})
    EXPECT_EQ(message_of("study = " + quote + dots + brackets + quote + " # " + dots + brackets + "\n").substr(0, 24),
              "s.toml:1: study: found " + quote.substr(0, 1));
  EXPECT_EQ(message_of("[" + parts(16, "a") + "]\n").substr(0, 35), "s.toml:1: a: found an unknown table");
}

TEST(StudyErrors, LongLinesTakeNoTime) {
  const std::string point = "{x=1, y=\"ü\"}, ";  // of 14 characters
  std::string points = "[";
  for (int k = 0; k < 20000; ++k) points += point;
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_EQ(message_of("study = " + points + "]\n"),
            "s.toml:1: study: found [" + point + point + point + point + "{x=...; expected a table [study]");
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(5));  // one of 4000 points took 7 s
}

TEST(StudyErrors, MessagesAreShortWhateverTheKeys) {
  const std::string much(1 << 20, 'k');
  for (const std::string& text : {much + " = 1\n" + much + " = 2\n", "[" + much + "]\n", "[study]\n" + much + " = 1\n",
                                  "[study]\nseed = \"" + much + "\"\n"}) {
    const std::string message = message_of(text);
    EXPECT_NE(message, "accepted");
    EXPECT_LT(message.size(), 2000u);
  }
}

TEST(StudyErrors, StudyCheckpointFinal) {
  expect_messages(
      "", {
              {"study = 3", "s.toml:1: study: found 3; expected a table [study]"},
              {"[study]\nnmae = \"x\"",
               "s.toml:2: study.nmae: found an unknown key; expected one of name, seed, output; did you mean 'name'?"},
              {"[study]\nname = 3", "s.toml:2: study.name: found 3; expected text"},
              {"[study]\nseed = 1.0", "s.toml:2: study.seed: found 1.0; expected an integer >= 0"},
              {"[study]\nseed = -1", "s.toml:2: study.seed: found -1; expected an integer >= 0"},
              {"[study]\noutput = \"\"", "s.toml:2: study.output: found \"\"; expected a file name"},
          });
  expect_messages(
      kVolume + kStage,
      {
          {"[checkpoint]\nevery = -1", "s.toml:11: checkpoint.every: found -1; expected a number >= 0 s"},
          {"[checkpoint]\nevery = \"2 m\"",
           "s.toml:11: checkpoint.every: found \"2 m\"; expected a number in s, or text with a unit made of us, ms, s, "
           "min, h"},
          {"[checkpoint]\nevry = 2",
           "s.toml:11: checkpoint.evry: found an unknown key; expected one of every; did you mean 'every'?"},
          {"[final]\nround = 0", "s.toml:11: final.round: found 0; expected a step > 0"},
      });
}

TEST(StudyErrors, MechanismAndParameters) {
  expect_messages(
      "",
      {
          {"[mechanism]\nparameters = {}",
           "s.toml:1: mechanism: found neither type nor file; expected type = one of slider, or file = the name of a "
           "mechanism's file"},
          {"[mechanism]\ntype = \"slider\"\nfile = \"m.toml\"",
           "s.toml:3: mechanism.file: the mechanism is also given by mechanism.type (line 2); it is either built in "
           "or described by a file"},
          // The text is all that this reader reads: it opens no file.
          {"[mechanism]\nfile = \"m.toml\"",
           "s.toml:2: mechanism.file: the contents of the mechanism file are not available here"},
          {"[mechanism]\nname = \"a\"",
           "s.toml: found a mechanism file; expected a study, which refers to this file by [mechanism] "
           "file = \"..\""},
          {"[platform]\ncoordinates = {}",
           "s.toml: found a mechanism file; expected a study, which refers to this file by [mechanism] "
           "file = \"..\""},
          {"[mechanism]\ntype = \"slidr\"",
           "s.toml:2: mechanism.type: found \"slidr\"; expected one of slider; did you mean 'slider'?"},
          {"[[mechanism]]\ntype = \"slider\"", "s.toml:1: mechanism: found an array; expected a table [mechanism]"},
          {"[mechanism]\ntype = 4", "s.toml:2: mechanism.type: found 4; expected one of slider"},
          {"[mechanism]\ntype = \"slider\"\nparams = {}",
           "s.toml:3: mechanism.params: found an unknown key; expected one of type, file, masses, parameters"},
      });
  expect_messages(
      kMachine,
      {
          {"parameters = { tlit = 1 }",
           "s.toml:3: mechanism.parameters.tlit: found an unknown parameter; expected one of a, b, tilt, mass; did you "
           "mean 'tilt'?"},
          {"parameters = { tilt = \"2 m\" }",
           "s.toml:3: mechanism.parameters.tilt: found \"2 m\"; expected a number in rad, or text with a unit made of "
           "mrad, rad, deg, °"},
          {"parameters = { tilt = \"90 deg\" }",
           "s.toml:3: mechanism.parameters.tilt: found \"90 deg\"; expected a number in [-1, 1] rad"},
          {"parameters = { a = true }",
           "s.toml:3: mechanism.parameters.a: found true; expected a number in m, or text with a unit made of um, mm, "
           "cm, dm, m, km, in, inch, ft"},
          {"parameters = { a = inf }",
           "s.toml:3: mechanism.parameters.a: found inf; expected a number in m, or text with a unit made of um, mm, "
           "cm, dm, m, km, in, inch, ft"},
          {"parameters = { a = 1979-05-27 }",
           "s.toml:3: mechanism.parameters.a: found 1979-05-27; expected a number in m, or text with a unit made of "
           "um, "
           "mm, cm, dm, m, km, in, inch, ft"},
          {"parameters = { a = [1,\n 2] }",
           "s.toml:3: mechanism.parameters.a: found an array; expected a number in m, or text with a unit made of um, "
           "mm, cm, dm, m, km, in, inch, ft"},
          {"parameters = [1]", "s.toml:3: mechanism.parameters: found [1]; expected a table { parameter = .. }"},
          {"parameters = { a = 0 }", "s.toml:1: mechanism: the half width a must be > 0"},
      });
}

TEST(StudyErrors, VariablesAndBaseline) {
  expect_messages(
      kMachine + "parameters = { b = 1 }\n",
      {
          {"[variables]\nc = { min = 0, max = 1 }",
           "s.toml:5: variables.c: found an unknown parameter; expected one of a, b, tilt, mass; did you mean 'a'?"},
          {"[variables]\na = 0.5",
           "s.toml:5: variables.a: found 0.5; expected a table { min = .., max = .., step = .., tie = .. }"},
          {"[variables]\na = { min = 0.1 }", "s.toml:5: variables.a.max: found nothing; expected a number in [0, 2] m"},
          {"[variables]\na = { mni = 0.1, max = 1 }",
           "s.toml:5: variables.a.mni: found an unknown key; expected one of min, max, step, tie"},
          {"[variables]\na = { min = 0.5, max = \"500 mm\" }",
           "s.toml:5: variables.a.max: found \"500 mm\"; expected a number above min = 0.5 m"},
          {"[variables]\na = { min = -0.1, max = 1 }",
           "s.toml:5: variables.a.min: found -0.1; expected a number in [0, 2] m"},
          {"[variables]\na = { min = 0.1, max = 2.5 }",
           "s.toml:5: variables.a.max: found 2.5; expected a number in [0, 2] m"},
          {"[variables]\na = { min = 0.1, max = 0.5, step = 0 }",
           "s.toml:5: variables.a.step: found 0; expected a step > 0 and at most max - min = 0.4 m"},
          {"[variables]\na = { min = 0.1, max = 0.5, step = \"1 m\" }",
           "s.toml:5: variables.a.step: found \"1 m\"; expected a step > 0 and at most max - min = 0.4 m"},
          {"[variables]\nb = { min = 0.5, max = 1 }",
           "s.toml:5: variables.b: the parameter is also fixed in mechanism.parameters (line 3); it can either vary or "
           "be fixed"},
          {"[baseline]\nq = 1",
           "s.toml:5: baseline.q: found an unknown parameter; expected one of a, b, tilt, mass; did you mean 'a'?"},
          {"[baseline]\na = 3", "s.toml:5: baseline.a: found 3; expected a number in [0, 2] m"},
          {"[baseline]\na = 0", "s.toml:4: baseline: the half width a must be > 0"},
      });
}

TEST(StudyErrors, ValuesAreQuotedAsWrittenAndShortened) {
  EXPECT_EQ(message_of("[study]\nname = { a = \"\xc3\xa4\", b = 2 } # x"),
            "s.toml:2: study.name: found { a = \"\xc3\xa4\", b = 2 }; expected text");
  EXPECT_EQ(message_of("[study]\nseed = \"" + std::string(100, 'x') + "\""),
            "s.toml:2: study.seed: found \"" + std::string(59, 'x') + "...; expected an integer >= 0");
  EXPECT_EQ(message_of("[study]\r\nseed = 1e-8\r\n"), "s.toml:2: study.seed: found 1e-8; expected an integer >= 0");
}

TEST(StudyErrors, Files) {
  const auto message = [](const std::string& path) -> std::string {
    try {
      load_study_toml(path, testing::fake_catalogues());
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "accepted";
  };
  const std::string folder = ::testing::TempDir();
  EXPECT_EQ(message(folder + "/none.toml"),
            folder + "/none.toml: found no readable file (No such file or directory); expected a study in TOML");
  EXPECT_EQ(message(folder), folder + ": found a folder; expected a study in TOML");
  const std::string large = folder + "/large.toml";
  std::ofstream(large) << std::string((16U << 20U) + 1, '#');
  EXPECT_EQ(message(large), large + ": found more than 16 MiB; expected a study in TOML");
}

}  // namespace
}  // namespace pkm
