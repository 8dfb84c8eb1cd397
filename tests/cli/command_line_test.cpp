// Command line errors with their messages and exit codes; --help, --version and `pkmopt list`.
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "constraints/all.hpp"
#include "engine/config/built_in_mechanisms.hpp"
#include "engine/optimisers/optimiser.hpp"
#include "objectives/all.hpp"
#include "tests/cli/run_program.hpp"
#include "tests/cli/study_folder.hpp"

namespace pkm::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::MatchesRegex;

struct InvalidCommand {
  std::vector<std::string> arguments;
  std::string sentence;
};

TEST(CliErrors, InvalidInputGivesExitCode2AndOneSentence) {
  const std::string commands =
      "one of run, resume, check, evaluate, sensitivity, pose, forward, dynamics, coupling, trajectory, simulate, "
      "workspace, connect, certify, tolerances, compare, show, report, export, generate, list, new, schema, upgrade, "
      "completion, manual";
  const std::string mechanism = "4ppa-2par";
  std::string mechanisms;
  for (const auto& entry : all_mechanisms()) mechanisms += (mechanisms.empty() ? "" : ", ") + entry.name();
  const InvalidCommand cases[] = {
      {{"evalute"},
       "found the unknown command 'evalute'; expected " + commands +
           " (see 'pkmopt --help'); did you mean 'evaluate'?"},
      {{"--hlp"},
       "found the unknown option '--hlp'; expected one of --help, --version, --json; did you mean '--help'?"},
      {{"evaluate"}, "found no design; expected a mechanism, a file in TOML or --from F.h5"},
      {{"pose", mechanism}, "--at: found nothing; expected the pose, or --poses with a table of poses"},
      {{"evaluate", mechanism, "--jsn"},
       "evaluate: found the unknown option '--jsn'; expected one of --help, --from, --baseline, --generation, "
       "--individual, --front, --stage, --set, --limit, --masses, --json, --cells, --samples, --certified, "
       "--designs, --csv, --force, "
       "--sensitivity, --tolerance, --threads, --workers, --instruction-set, --digits; did you mean '--json'?"},
      {{"list", "mechanisms", mechanism, "more"},
       "list: found the argument 'more'; expected no further argument (see 'pkmopt list --help')"},
      {{"list", "objectiv"},
       "list: found the unknown word 'objectiv'; expected one of mechanisms, objectives, constraints, optimisers, the "
       "name of an entry, or a mechanism file; did you mean 'objectives'?"},
      {{"list", "optimisers", "g"},
       "list optimisers: found the unknown name 'g'; expected one of ga, nsga2, sweep, nlopt, ipopt; did you mean "
       "'ga'?"},
      {{"evaluate", "4ppa-2pra"},
       "found '4ppa-2pra', which is neither a mechanism nor a file; expected one of the mechanisms " + mechanisms +
           ", or a file in TOML of a study or a mechanism; did you mean '4ppa-2par'?"},
      {{"check", "none.toml"},
       "none.toml: found no readable file (No such file or directory); expected a study or a mechanism in TOML"},
      {{"evaluate", "/tmp"}, "/tmp: found a folder; expected a study or a mechanism in TOML"},
      {{"evaluate", mechanism, "--set", "l_uu=0.5"},
       "--set: found the unknown name 'l_uu'; expected one of a, b, l_u, l_d, d, L0, R_u, R_d, d_u, d_d, d_0, R_p, "
       "R_s, lambda_u, lambda_d, lambda_s, lambda_p, m_c, kappa, kappa_p, m_p, c_p; did you mean "
       "'l_u'?"},
      {{"evaluate", mechanism, "--set", "a=2kg"},
       "--set: found a=2kg; expected a number in m, or text with a unit made of um, mm, cm, dm, m, km, in, inch, ft"},
      {{"evaluate", mechanism, "--set", "a=0"}, "--set: found a=0; expected a number in [0.001, 100] m"},
      {{"pose", mechanism, "--at", "x=0.4,y=1"},
       "--at: found no value for z, theta; expected values for x, y, z, theta"},
      {{"pose", mechanism, "--at", "x=0.4,y=1,z=-1,theta=0", "--mode", "lower,lowr"},
       "--mode: found the unknown mode 'lower,lowr'; expected one of lower,lower; lower,upper; upper,lower; "
       "upper,upper; did you mean 'lower,lower'?"},
      {{"forward", mechanism, "--joints", "q1=0,q2=1,q3=0,q3=1"}, "--joints: found q3 twice; expected each name once"},
  };
  for (const auto& invalid : cases) {
    const auto result = pkmopt(invalid.arguments);
    EXPECT_EQ(result.exit_code, 2) << invalid.sentence;
    EXPECT_EQ(result.err, "pkmopt: " + invalid.sentence + "\n");
    EXPECT_EQ(result.out, "");
  }
}

TEST(CliErrors, NoCommandGivesExitCode2AndTheFirstSteps) {
  const auto result = pkmopt({});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_EQ(result.out, "");
  EXPECT_THAT(
      result.err,
      HasSubstr("\n  pkmopt new study robot.toml -o study.toml     create a study: variables and objectives\n"));
  EXPECT_THAT(result.err, HasSubstr("'pkmopt --help' lists all commands"));
}

TEST(CliErrors, AnErrorInAStudyIsReportedWithFileLineAndKey) {
  const StudyFolder folder;
  folder.write("wrong.toml", "[mechanism]\ntype = \"4ppa-2par\"\n[variables]\na = { min = \"200 kg\", max = 1 }\n");
  for (const char* command : {"check", "evaluate"}) {
    const auto result = pkmopt({command, "wrong.toml"}, folder.path());
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_THAT(result.err, HasSubstr("pkmopt: wrong.toml:4: variables.a.min: found \"200 kg\"; expected "));
  }
}

TEST(CliErrors, IntegersMustBeDecimalAndInRange) {
  for (const std::string number : {"99999999999999999999", "010", "0x10", "-1", "1e3", "1.0", "", "abc"}) {
    const auto result = pkmopt({"run", "none.toml", "--seed", number});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_EQ(result.err, "pkmopt: --seed: found '" + number +
                              "'; expected a whole number from 0 to 9223372036854775807, in decimal without leading "
                              "zeros\n");
  }
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"run", "none.toml", "--threads", "4294967297"},
        {"resume", "none.h5", "--generations", "012"},
        {"export", "none.h5", "--front", "18446744073709551617"},
        {"trajectory", "4ppa-2par", "--samples", "4294967298"}}) {
    const auto result = pkmopt(arguments);
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_THAT(result.err, HasSubstr(": found '" + arguments.back() + "'; expected a whole number from "));
  }
}

TEST(CliErrors, OutputHasNoTerminalControlCharacters) {
  const StudyFolder folder;
  folder.write("esc.toml",
               "[study]\nname = \"a\\u001b[2Jb\\u009bc\\nd\"\n[mechanism]\ntype = \"4ppa-2par\"\n"
               "[variables]\na = { min = 0.1, max = 0.2 }\n[[objective]]\ntype = \"workspace-volume\"\n"
               "[[stage]]\noptimiser = \"sweep\"\n");
  const auto has_control = [](const std::string& text) {
    return text.find_first_of("\x1b\r\a\x9b") != std::string::npos;
  };
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"pose", "4ppa-2par", "--at", "x=.1", "--ve\x14\x1b[31m"},
        {"evaluate", "\x1b[31m"},
        {"\x1b[31m"},
        {"list", "\r\x9b"},
        {"check", "esc.toml"},
        {"check", "esc.toml", "--json"}}) {
    const auto result = pkmopt(arguments, folder.path());
    EXPECT_FALSE(has_control(result.out)) << result.out;
    EXPECT_FALSE(has_control(result.err)) << result.err;
    EXPECT_FALSE((result.out + result.err).empty());
  }
  EXPECT_EQ(pkmopt({"check", "esc.toml", "--json"}, folder.path()).json()["name"], "a\x1b[2Jb\u009bc\nd");
}

#ifndef PKM_SANITIZED  // sanitizers reserve terabytes of address space
TEST(CliErrors, FailsIfThreadsCannotBeStarted) {
  const auto result =
      run_program({"/bin/sh", "-c", "ulimit -v 600000; exec '" PKM_PROGRAM "' evaluate 4ppa-2par --threads 200"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, MatchesRegex("pkmopt: cannot start a team of 200 threads: [^\n]*\n"));
}
#endif

TEST(CliErrors, FailsIfStandardOutputCannotBeWritten) {
  const auto result = run_program({"/bin/sh", "-c", "'" PKM_PROGRAM "' list > /dev/full"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(result.err, "pkmopt: the results cannot be written to the standard output\n");
}

TEST(CliHelp, EveryCommandHasHelpWithAnExample) {
  const auto all = pkmopt({"--help"});
  EXPECT_EQ(all.exit_code, 0);
  for (const std::string command : {"run", "resume", "check", "evaluate", "sensitivity", "pose", "forward", "dynamics",
                                    "coupling", "trajectory", "simulate", "show", "list", "new"}) {
    EXPECT_THAT(all.out, HasSubstr("\n  " + command + " "));
    const auto help = pkmopt({command, "--help"});
    EXPECT_EQ(help.exit_code, 0);
    EXPECT_EQ(help.err, "");
    EXPECT_THAT(help.out, HasSubstr("Usage: pkmopt " + command + " "));
    EXPECT_THAT(help.out, HasSubstr("Example: pkmopt " + command + " "));
    EXPECT_TRUE(help.out.ends_with('\n'));
  }
}

TEST(CliHelp, PrintsVersionAndRevision) {
  const std::string full = std::string(PKM_PROGRAM) + " --version > /dev/full";
  if (std::filesystem::exists("/dev/full")) {
    EXPECT_EQ(run_program({"/bin/sh", "-c", full}).exit_code, 1);
  }
  const auto version = pkmopt({"--version"});
  EXPECT_EQ(version.exit_code, 0);
  EXPECT_THAT(version.out, MatchesRegex("pkmopt [0-9]+\\.[0-9]+\\.[0-9]+ \\(([0-9a-f]{12}(\\+changes)?|unknown)\\)\n"
                                        "instruction set: (baseline|avx2|avx512) of baseline, avx2, avx512\n"));
}

TEST(CliHelp, InstructionSetIsSelectedByName) {
  const std::vector<std::string> evaluate = {"evaluate", "4ppa-2par", "--instruction-set"};
  const auto with = [&](const std::string& set) {
    auto arguments = evaluate;
    arguments.push_back(set);
    return pkmopt(arguments);
  };
  EXPECT_EQ(with("baseline").exit_code, 0);
  EXPECT_EQ(with("baseline").out, pkmopt({"evaluate", "4ppa-2par"}).out);
  const auto wrong = with("avx");
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_THAT(wrong.err, HasSubstr("'avx'; expected one of baseline, avx2, avx512; did you mean 'avx2'?"));
}

template <class List>
void expect_listed(const std::string& kind, const List& names) {
  const std::string overview = pkmopt({"list"}).out, json = pkmopt({"list", kind, "--json"}).out;
  const auto entries = nlohmann::json::parse(json)[kind];
  ASSERT_EQ(entries.size(), names.size());
  for (std::size_t i = 0; i < names.size(); ++i) {
    EXPECT_EQ(entries[i]["name"], names[i]);
    EXPECT_THAT(overview, HasSubstr("\n  " + names[i] + " "));
    const auto text = pkmopt({"list", kind, names[i]});
    EXPECT_EQ(text.exit_code, 0) << text.err;
    EXPECT_THAT(text.out, HasSubstr(entries[i]["meaning"].template get<std::string>()));
    EXPECT_EQ(pkmopt({"list", kind, names[i], "--json"}).json(), entries[i]);
    const auto found = pkmopt({"list", names[i], "--json"}).json();  // by catalogue if several have this name
    EXPECT_EQ(found.contains(kind) ? found[kind] : found, entries[i]);
  }
}

TEST(CliList, ListsAllEntriesOfTheCatalogues) {
  std::vector<std::string> mechanisms, objectives, constraints, optimisers;
  for (const auto& entry : all_mechanisms()) mechanisms.push_back(entry.name());
  for (const auto& entry : all_objectives()) objectives.push_back(entry.name);
  for (const auto& entry : all_constraints()) constraints.push_back(entry.name);
  for (const auto& entry : all_optimisers()) optimisers.push_back(entry.name);
  expect_listed("mechanisms", mechanisms);
  expect_listed("objectives", objectives);
  expect_listed("constraints", constraints);
  expect_listed("optimisers", optimisers);
}

TEST(CliList, ShowsAllDetailsOfAnEntry) {
  const auto mechanism = pkmopt({"list", "mechanisms", "4ppa-2par", "--json"}).json();
  EXPECT_EQ(mechanism["parameters"][2], (nlohmann::json{{"name", "l_u"},
                                                        {"unit", "m"},
                                                        {"default", 0.6},
                                                        {"min", 0.001},
                                                        {"max", 100.0},
                                                        {"meaning", "bar length of the upper parallelograms"}}));
  EXPECT_EQ(mechanism["limits"][3]["derivation"], "d_0 + d_u/2");
  EXPECT_EQ(mechanism["default_mode"], "lower,lower");
  const auto conditioning = pkmopt({"list", "objectives", "conditioning", "--json"}).json();
  EXPECT_EQ(conditioning["options"][0]["choices"], (nlohmann::json{"mean", "min"}));
  EXPECT_EQ(conditioning["options"][0]["default"], "mean");
  EXPECT_EQ(conditioning["mechanisms"][0]["serves"], true);
  const auto interference = pkmopt({"list", "constraints", "interference", "--json"}).json();
  EXPECT_EQ(interference["level"], "pose");
  EXPECT_EQ(interference["limits"]["4ppa-2par"][0]["name"], "alpha_min");
  const auto ga = pkmopt({"list", "optimisers", "ga", "--json"}).json();
  EXPECT_EQ(ga["capabilities"]["max_objectives"], 1);
  const auto sweep = pkmopt({"list", "optimisers", "sweep"}).out;
  EXPECT_THAT(sweep, HasSubstr("  max_objectives  no limit\n"));
  EXPECT_THAT(sweep, HasSubstr("one-at-a-time; full-factorial"));
}

TEST(CliList, CatalogueMdIsUpToDate) {
  std::ostringstream file;
  file << std::ifstream(std::filesystem::path(PKM_EXPERIMENTS) / "../docs/reference/catalogue.md").rdbuf();
  EXPECT_EQ(pkmopt({"list", "--markdown"}).out, file.str()) << "pkmopt list --markdown > docs/reference/catalogue.md";
  EXPECT_EQ(pkmopt({"list", "objectives", "--markdown"}).exit_code, 2);
}

TEST(CliSchema, KeysMdIsUpToDate) {
  std::ostringstream file;
  file << std::ifstream(std::filesystem::path(PKM_EXPERIMENTS) / "../docs/reference/keys.md").rdbuf();
  EXPECT_EQ(pkmopt({"schema", "--markdown"}).out, file.str()) << "pkmopt schema --markdown > docs/reference/keys.md";
}

TEST(CliSchema, KindsAreTheStudyAndThreeOthers) {
  const auto study = pkmopt({"schema"});
  EXPECT_EQ(study.out, pkmopt({"schema", "study"}).out);
  EXPECT_EQ(study.json()["$schema"], "http://json-schema.org/draft-07/schema#");
  EXPECT_EQ(pkmopt({"schema", "mechanism"}).json()["title"], "Mechanism file of pkmopt");
  EXPECT_EQ(pkmopt({"schema", "motion"}).json()["title"], "Motion file of pkmopt");
  EXPECT_EQ(pkmopt({"schema", "motors"}).json()["title"], "Motor file of pkmopt");
  const auto wrong = pkmopt({"schema", "mechansim"});
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_THAT(wrong.err, HasSubstr("did you mean 'mechanism'?"));
}

}  // namespace
}  // namespace pkm::testing
