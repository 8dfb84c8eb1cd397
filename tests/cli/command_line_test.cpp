// The grammar of the command line: what is refused, in which words and with which exit code; help, version, list.
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "constraints/all.hpp"
#include "engine/mechanisms/all.hpp"
#include "engine/optimisers/optimiser.hpp"
#include "objectives/all.hpp"
#include "tests/cli/run_program.hpp"
#include "tests/cli/study_folder.hpp"

namespace pkm::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::MatchesRegex;

struct Refusal {
  std::vector<std::string> arguments;
  std::string sentence;
};

TEST(CliErrors, BadInputIsExitCodeTwoAndOneSentence) {
  const std::string commands =
      "one of run, resume, check, evaluate, pose, forward, dynamics, coupling, trajectory, simulate, "
      "workspace, show, report, export, list";
  const std::string mechanism = "4ppa-2par";
  std::string mechanisms;
  for (const auto& entry : all_mechanisms()) mechanisms += (mechanisms.empty() ? "" : ", ") + entry->info().name;
  const Refusal refusals[] = {
      {{}, "found no command; expected " + commands + " (see 'pkmopt --help')"},
      {{"evalute"},
       "found the unknown command 'evalute'; expected " + commands +
           " (see 'pkmopt --help'); did you mean 'evaluate'?"},
      {{"--hlp"}, "found the unknown option '--hlp'; expected one of --help, --version; did you mean '--help'?"},
      {{"evaluate"}, "found no design; expected a mechanism, a study in TOML or --from F.h5"},
      {{"pose", mechanism}, "pose: --at is required (see 'pkmopt pose --help')"},
      {{"evaluate", mechanism, "--jsn"},
       "evaluate: found the unknown option '--jsn'; expected one of --help, --from, --baseline, --generation, "
       "--individual, --front, --stage, --set, --masses, --json, --threads, --instruction-set; did you mean '--json'?"},
      {{"list", "mechanisms", mechanism, "more"},
       "list: found the argument 'more'; expected no further argument (see 'pkmopt list --help')"},
      {{"list", "objectiv"},
       "list: found the unknown word 'objectiv'; expected one of mechanisms, objectives, constraints, optimisers, or "
       "the name of an entry; did you mean 'objectives'?"},
      {{"list", "optimisers", "g"},
       "list optimisers: found the unknown name 'g'; expected one of ga, nsga2, sweep, nlopt, ipopt; did you mean "
       "'ga'?"},
      {{"evaluate", "4ppa-2pra"},
       "found '4ppa-2pra', which is neither a mechanism nor a file; expected a study in TOML, or one of the "
       "mechanisms " +
           mechanisms + "; did you mean '4ppa-2par'?"},
      {{"check", "none.toml"},
       "none.toml: found no readable file (No such file or directory); expected a study file in TOML"},
      {{"evaluate", "/tmp"}, "/tmp: found a folder; expected a study file in TOML"},
      {{"evaluate", mechanism, "--set", "l_uu=0.5"},
       "--set: found the unknown name 'l_uu'; expected one of a, b, l_u, l_d, d, L0, R_u, R_d, d_u, d_d, d_0, R_p, "
       "R_s, lambda_u, lambda_d, lambda_s, lambda_p, m_c, kappa, kappa_p, m_p, c_p; did you mean "
       "'l_u'?"},
      {{"evaluate", mechanism, "--set", "a=2kg"},
       "--set: found a=2kg; expected a number in m, or text with a unit made of um, mm, cm, dm, m, km, in"},
      {{"evaluate", mechanism, "--set", "a=0"}, "--set: found a=0; expected a number in [0.001, 100] m"},
      {{"pose", mechanism, "--at", "x=0.4,y=1"},
       "--at: found no value for z, theta; expected values for x, y, z, theta"},
      {{"pose", mechanism, "--at", "x=0.4,y=1,z=-1,theta=0", "--mode", "lower,lowr"},
       "--mode: found the unknown mode 'lower,lowr'; expected one of lower,lower; lower,upper; upper,lower; "
       "upper,upper; did you mean 'lower,lower'?"},
      {{"forward", mechanism, "--joints", "q1=0,q2=1,q3=0,q3=1"}, "--joints: found q3 twice; expected each name once"},
  };
  for (const auto& refusal : refusals) {
    const auto result = pkmopt(refusal.arguments);
    EXPECT_EQ(result.exit_code, 2) << refusal.sentence;
    EXPECT_EQ(result.err, "pkmopt: " + refusal.sentence + "\n");
    EXPECT_EQ(result.out, "");
  }
}

TEST(CliErrors, AWrongStudyIsNamedWithFileLineAndKey) {
  const StudyFolder folder;
  folder.write("wrong.toml", "[mechanism]\ntype = \"4ppa-2par\"\n[variables]\na = { min = \"200 kg\", max = 1 }\n");
  for (const char* command : {"check", "evaluate"}) {
    const auto result = pkmopt({command, "wrong.toml"}, folder.path());
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_THAT(result.err, HasSubstr("pkmopt: wrong.toml:4: variables.a.min: found \"200 kg\"; expected "));
  }
}

TEST(CliErrors, ResultsThatCannotBeWrittenAreAFailure) {
  const auto result = run_program({"/bin/sh", "-c", "'" PKM_PROGRAM "' list > /dev/full"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_EQ(result.err, "pkmopt: the results cannot be written to the standard output\n");
}

TEST(CliHelp, EveryCommandHasHelpWithAnExample) {
  const auto all = pkmopt({"--help"});
  EXPECT_EQ(all.exit_code, 0);
  for (const std::string command : {"run", "resume", "check", "evaluate", "pose", "forward", "dynamics", "coupling",
                                    "trajectory", "simulate", "show", "list"}) {
    EXPECT_THAT(all.out, HasSubstr("\n  " + command + " "));
    const auto help = pkmopt({command, "--help"});
    EXPECT_EQ(help.exit_code, 0);
    EXPECT_EQ(help.err, "");
    EXPECT_THAT(help.out, HasSubstr("Usage: pkmopt " + command + " "));
    EXPECT_THAT(help.out, HasSubstr("Example: pkmopt " + command + " "));
    EXPECT_TRUE(help.out.ends_with('\n'));
  }
}

TEST(CliHelp, VersionAndRevision) {
  const auto version = pkmopt({"--version"});
  EXPECT_EQ(version.exit_code, 0);
  EXPECT_THAT(version.out, MatchesRegex("pkmopt [0-9]+\\.[0-9]+\\.[0-9]+ \\(([0-9a-f]{12}(\\+changes)?|unknown)\\)\n"
                                        "instruction set: (baseline|avx2|avx512) of baseline, avx2, avx512\n"));
}

TEST(CliHelp, AnInstructionSetIsChosenByName) {
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
    const auto found = pkmopt({"list", names[i], "--json"}).json();  // by catalogue where several know the word
    EXPECT_EQ(found.contains(kind) ? found[kind] : found, entries[i]);
  }
}

TEST(CliList, NamesEverythingInTheCatalogues) {
  std::vector<std::string> mechanisms, objectives, constraints, optimisers;
  for (const auto& entry : all_mechanisms()) mechanisms.push_back(entry->info().name);
  for (const auto& entry : all_objectives()) objectives.push_back(entry.name);
  for (const auto& entry : all_constraints()) constraints.push_back(entry.name);
  for (const auto& entry : all_optimisers()) optimisers.push_back(entry.name);
  expect_listed("mechanisms", mechanisms);
  expect_listed("objectives", objectives);
  expect_listed("constraints", constraints);
  expect_listed("optimisers", optimisers);
}

TEST(CliList, TellsEverythingOfAnEntry) {
  const auto mechanism = pkmopt({"list", "mechanisms", "4ppa-2par", "--json"}).json();
  EXPECT_EQ(mechanism["parameters"][2], (nlohmann::json{{"name", "l_u"},
                                                        {"unit", "m"},
                                                        {"default", 0.6},
                                                        {"min", 0.001},
                                                        {"max", 100.0},
                                                        {"meaning", "bar length of the upper parallelograms"}}));
  EXPECT_EQ(mechanism["limits"][3]["derivation"], "d_0 + d_u / 2, eq 19");
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

TEST(CliList, CatalogueInTheExperimentsIsWhatIsThere) {
  std::ostringstream file;
  file << std::ifstream(std::filesystem::path(PKM_EXPERIMENTS) / "catalogue.md").rdbuf();
  EXPECT_EQ(pkmopt({"list", "--markdown"}).out, file.str()) << "pkmopt list --markdown > experiments/catalogue.md";
  EXPECT_EQ(pkmopt({"list", "objectives", "--markdown"}).exit_code, 2);
}

}  // namespace
}  // namespace pkm::testing
