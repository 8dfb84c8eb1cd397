// Data of the HTML page: packed arrays, escaped text, and panels that agree with the study file.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include <nlohmann/json.hpp>

#include "engine/mechanism/trajectory.hpp"
#include "engine/motion/motion_factories.hpp"
#include "engine/report/html_page.hpp"
#include "engine/report/json_text.hpp"
#include "engine/report/packed_array.hpp"
#include "engine/report/panels.hpp"
#include "engine/report/thinning.hpp"
#include "engine/results/comparison.hpp"
#include "tests/unit/config/real_studies.hpp"
#include "tests/unit/contracts/mechanism_fixtures.hpp"
#include "tests/unit/storage/sample_study.hpp"

namespace pkm {
namespace {

using nlohmann::json;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::IsSupersetOf;
using ::testing::Not;

std::string base64_of(const std::string& text) {
  return base64({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
}

std::shared_ptr<const Mechanism> test_mechanism(const std::string& name) {
  for (const auto& mechanism : all_mechanisms())
    if (mechanism->info().name == name) return mechanism;
  throw std::out_of_range(name);
}

/// The sample study, as if this program could not read its text.
PageStudy sample_page() { return {"sample.h5", test::sample_study(), {}, "why"}; }

TEST(PackedArray, Base64MatchesTheExamplesOfRfc4648) {
  EXPECT_EQ(base64_of(""), "");
  EXPECT_EQ(base64_of("f"), "Zg==");
  EXPECT_EQ(base64_of("fo"), "Zm8=");
  EXPECT_EQ(base64_of("foo"), "Zm9v");
  EXPECT_EQ(base64_of("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64_of("\xff\xfe"), "//4=");
}

TEST(PackedArray, IntegersHaveTwoBytesIfPossible) {
  EXPECT_EQ(packed_integers(std::vector<std::int64_t>{1, 65535}), "u16:AQD//w==");
  EXPECT_EQ(packed_integers(std::vector<std::int64_t>{1, 65536}), "u32:AQAAAAAAAQA=");
}

TEST(PackedArray, QuantisationPreservesMinimumMaximumAndNan) {
  const double none = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(packed_quantised(std::vector<double>{-1, 3, none, 1}),
            "q16:-1:3:" + base64_of({"\x00\x00\xfe\xff\xff\xff\xff\x7f", 8}));
  EXPECT_EQ(packed_quantised(std::vector<double>{none}), "q16:0:0:" + base64_of("\xff\xff"));
  EXPECT_EQ(packed_bits(std::vector<std::uint8_t>{1, 0, 0, 0, 0, 0, 0, 0, 1}), "bits:" + base64_of("\x01\x01"));
}

TEST(JsonText, CannotEndItsScriptElement) {
  const std::string malicious = "</script><!-- \xe2\x80\xa8 \xff";
  const std::string text = json_text(json(malicious));
  EXPECT_THAT(text, Not(HasSubstr("<")));
  EXPECT_TRUE(std::ranges::all_of(text, [](char c) { return static_cast<unsigned char>(c) < 128; }));
  EXPECT_EQ(json::parse(text), "</script><!-- \xe2\x80\xa8 \xef\xbf\xbd");
}

TEST(Thinning, IncludesFirstAndLast) {
  EXPECT_THAT(Thinning(0, 3).indices, IsEmpty());
  EXPECT_THAT(Thinning(1, 3).indices, ElementsAre(0));
  EXPECT_THAT(Thinning(3, 3).indices, ElementsAre(0, 1, 2));
  EXPECT_THAT(Thinning(6, 3).indices, ElementsAre(0, 3, 5));
  const Thinning many(1001, 101);
  EXPECT_EQ(many.stride, 10u);
  EXPECT_EQ(many.indices.size(), 101u);
  EXPECT_EQ(many.indices.back(), 1000u);
}

TEST(Comparison, GainIsRelativeToTheMagnitudeOfTheBaseline) {
  EXPECT_EQ(gain_over(-2, -1, Direction::maximise)->percent, 50);
  EXPECT_FALSE(gain_over(-2, -1, Direction::maximise)->worse);
  EXPECT_TRUE(gain_over(2, 3, Direction::minimise)->worse);
  EXPECT_FALSE(gain_over(2, 2, Direction::minimise)->worse);
  EXPECT_FALSE(gain_over(0, 1, Direction::maximise));
  EXPECT_FALSE(gain_over(1, std::nan(""), Direction::maximise));
  EXPECT_EQ(most_violated(std::vector<double>{0.1, -0.1, std::nan(""), -0.2}), 3u);
  EXPECT_EQ(most_violated(std::vector<double>{0.1, std::nan("")}), std::nullopt);
}

TEST(PageData, StudyWithoutFeasibleDesignHasADiagnosis) {
  PageStudy page = sample_page();
  EXPECT_TRUE(json::parse(json_text(summary_data(page)))["diagnosis"].is_null()) << "the study has not finished";
  StudyContents& contents = page.contents;
  contents.state = StudyState::finished;
  EXPECT_TRUE(json::parse(json_text(summary_data(page)))["diagnosis"].is_null()) << "a design is feasible";
  std::size_t designs = 0;
  for (StageRecord& stage : contents.stages) {
    std::ranges::fill(stage.table.status, Status::infeasible);
    std::ranges::fill(stage.table.margins, -0.5);
    designs += stage.table.size();
  }
  const json summary = json::parse(json_text(summary_data(page)));
  const json& diagnosis = summary["diagnosis"];
  EXPECT_EQ(diagnosis["finding"], "nothing feasible");
  EXPECT_EQ(diagnosis["sentence"],
            "none of " + std::to_string(designs) + " designs is feasible: " + std::to_string(designs) + " infeasible");
  EXPECT_EQ(diagnosis["reasons"][0]["kind"], "constraint");
  EXPECT_EQ(diagnosis["reasons"][0]["names"][0], contents.problem.margins[0].name);
  EXPECT_EQ(summary["table"]["columns"][0]["name"], "least infeasible");
}

TEST(PageData, SummaryAgreesWithTheStudyFile) {
  const PageStudy page = sample_page();
  const json summary = json::parse(json_text(summary_data(page)));
  const FinalRecord& final = *page.contents.final;
  EXPECT_EQ(summary["unreadable"], "why");
  EXPECT_EQ(summary["state"], "interrupted");
  EXPECT_EQ(summary["origin"]["seed"], "18364758544493064720");  // exceeds the precision of a JavaScript number
  const json& table = summary["table"];
  EXPECT_EQ(table["columns"][0]["name"], "best");
  EXPECT_EQ(table["columns"][1]["name"], "baseline");
  EXPECT_EQ(table["columns"][1]["reason"], "does not assemble");
  EXPECT_EQ(table["rows"][0]["values"], json({final.best->parameters[0], final.baseline->parameters[0]}));
  EXPECT_EQ(table["rows"][2]["name"], "workspace-ratio");
  EXPECT_EQ(table["rows"][2]["values"], json({final.best->objectives[0], final.baseline->objectives[0]}));
  EXPECT_DOUBLE_EQ(table["rows"][2]["gain"]["percent"], 100);
  EXPECT_EQ(table["rows"][3]["name"], "workspace-ratio, exact");
  EXPECT_EQ(table["rows"][3]["values"], json({final.best_exact->objectives[0], nullptr}));
  EXPECT_EQ(summary["stages"][0]["outcomes"],
            json({{"feasible", 3}, {"infeasible", 3}, {"rejected", 3}, {"failed", 3}}));
}

TEST(PageData, ConvergenceHasBestSoFarAndQuartiles) {
  StudyContents contents = test::sample_study();
  StageRecord& stage = contents.stages[0];
  contents.stages.resize(1);
  std::fill(stage.table.status.begin(), stage.table.status.end(), Status::feasible);
  for (std::size_t row = 0; row < stage.table.size(); ++row) stage.table.objectives[row] = static_cast<double>(row % 5);
  stage.table.status[4] = Status::infeasible;  // with the largest value
  const json found = json::parse(json_text(convergence_data(contents)))[0]["generations"];
  EXPECT_EQ(found["evaluations"], json({4, 8, 12}));
  const json& objective = found["objectives"][0];  // 0 1 2 3 | (4) 0 1 2 | 3 4 0 1
  EXPECT_EQ(objective["best"], json({3.0, 3.0, 4.0}));
  EXPECT_EQ(objective["median"], json({1.5, 1.0, 2.0}));
  EXPECT_EQ(objective["lower"], json({0.75, 0.5, 0.75}));
  EXPECT_EQ(objective["upper"], json({2.25, 1.5, 3.25}));
}

TEST(PageData, PanelsWithoutContentAreOmitted) {
  StudyContents contents = test::sample_study();
  contents.final.reset();
  contents.stages.clear();
  contents.best = {};
  const json page = json::parse(page_data({{"empty.h5", contents, {}, "why"}}, "pkmopt"));
  const json& study = page["studies"][0];
  for (const char* const panel :
       {"convergence", "populations", "front", "workspace", "mechanism", "coupling", "motions"})
    EXPECT_FALSE(study.contains(panel)) << panel;
  EXPECT_TRUE(study["summary"]["table"].is_null());
  EXPECT_EQ(study["summary"]["evaluations"], 0);
}

TEST(PageData, UnreadableStudyShowsTheMapOfItsFile) {
  const json page = json::parse(page_data({sample_page()}, "pkmopt 1"));
  EXPECT_EQ(page["program"], "pkmopt 1");
  const json& study = page["studies"][0];
  EXPECT_EQ(study["name"], "Größe, 4PPa-2PaR <b>");
  const json& design = study["workspace"]["designs"][0];
  EXPECT_EQ(design["feasible"], packed_bits(std::vector<std::uint8_t>{0, 1, 1, 0, 1, 0}));
  EXPECT_THAT(design["fields"], IsEmpty());
  EXPECT_FALSE(study.contains("mechanism"));
}

TEST(PageData, SingleDesignHasWorkspaceMechanismAndCoupling) {
  const auto mechanism = test_mechanism("3crr-r-cru");
  const std::vector<double> nominal = test::nominal(mechanism->info());
  const ShownDesigns views =
      evaluate_shown_designs(*mechanism, test::voxels(mechanism->info(), 6), "", {}, {"nominal", nominal});
  ASSERT_EQ(views.designs[0].problem, "");
  const auto [lower, upper] = views.designs[0].fixed_range[0];
  EXPECT_LT(lower, 0);  // feasible rotations in both directions
  EXPECT_GT(upper, 0);
  const json study = json::parse(page_data(views, "pkmopt"))["studies"][0];
  EXPECT_EQ(study["design"]["parameters"].size(), nominal.size());
  EXPECT_EQ(study["workspace"]["designs"][0]["volume"], views.designs[0].workspace->volume);
  const json& drawn = study["mechanism"]["designs"][0];
  EXPECT_EQ(drawn["coordinates"][3]["values"].size(), 7u);
  EXPECT_GT(drawn["links"].size(), 10u);
  EXPECT_LT(drawn["end_count"], 2 * drawn["links"].size());  // jointed links share an end
  EXPECT_EQ(study["coupling"]["designs"][0]["indices"].size(), 5u);
  const auto& parameters = mechanism->info().parameters;
  std::vector<std::string> dimensions;
  for (const json& d : drawn["dimensions"]) {
    dimensions.push_back(d["name"]);
    const auto known = std::ranges::find(parameters, dimensions.back(), &Parameter::name);
    EXPECT_EQ(d["value"], nominal[static_cast<std::size_t>(known - parameters.begin())]);
  }
  EXPECT_THAT(dimensions, IsSupersetOf({"l_11", "l_12", "l_31", "l_42", "l"}));  // some of them have equal values
  EXPECT_TRUE(study["workspace"]["designs"][0]["surface"].contains("triangles"));
  EXPECT_FALSE(study.contains("motions"));
}

TEST(PageData, MotionsIncludeQuantitiesOfTheMotion) {
  const auto mechanism = test_mechanism("2t1r-p-hybrid");
  const MechanismInfo& info = mechanism->info();
  const auto formula = [](const std::string& text) { return Formula(text, time_name()); };
  const auto motion = with_inputs(
      motion_from_formulas({formula("-0.01*t"), formula("0.01*t"), formula("0.25"), formula("0.1*sin(t)")}, 5),
      {formula("t"), formula("0"), formula("0")});
  const ShownDesigns views = evaluate_shown_designs(*mechanism, test::voxels(info, 6), info.modes.front(),
                                                    {{{"turns", motion}}}, {"nominal", test::nominal(info)});
  const json page = json::parse(json_text(motions_data(views))),
             &columns = page["motions"][0]["designs"][0]["quantities"];
  const auto is_of_motion = [](const QuantityInfo& quantity) { return quantity.of_motion; };
  ASSERT_EQ(page["quantities"].size(), static_cast<std::size_t>(std::ranges::count_if(info.quantities, is_of_motion)));
  ASSERT_EQ(columns.size(), page["quantities"].size());
  EXPECT_EQ(page["quantities"][0], json({{"name", "gamma"}, {"unit", "rad"}}));

  const Trajectory found = compute_trajectory(*mechanism, views.designs[0].parameters, views.mode, views.limits,
                                              *motion, page["motions"][0]["samples"]);
  const auto gamma = std::ranges::find(info.quantities, "gamma", &QuantityInfo::name) - info.quantities.begin();
  std::vector<double> output;
  for (const TrajectoryPoint& point : found.points) output.push_back(point.quantities[static_cast<std::size_t>(gamma)]);
  EXPECT_GT(output.back(), 4);
  EXPECT_EQ(columns[0], packed_floats(output));

  const auto without = test_mechanism("3crr-r-cru");
  const auto rest = motion_from_formulas({formula("0.15"), formula("0.2"), formula("0.21"), formula("0.1*sin(t)")}, 5);
  const json none = json::parse(json_text(
      motions_data(evaluate_shown_designs(*without, test::voxels(without->info(), 6), without->info().modes.front(),
                                          {{{"turns", rest}}}, {"nominal", test::nominal(without->info())}))));
  EXPECT_TRUE(none["quantities"].empty());
  EXPECT_TRUE(none["motions"][0]["designs"][0]["quantities"].empty());
}

TEST(PageData, OnlyTheFirstMotionsAreEmbedded) {
  const auto mechanism = test_mechanism("3crr-r-cru");
  const MechanismInfo& info = mechanism->info();
  const auto formula = [](const std::string& text) { return Formula(text, time_name()); };
  const auto rest = motion_from_formulas({formula("0.15"), formula("0.2"), formula("0.21"), formula("0.1*sin(t)")}, 5);
  const auto page_of = [&](std::size_t count) {
    std::vector<DesignMotion> motions;
    for (std::size_t i = 0; i < count; ++i) motions.push_back({{"motion " + std::to_string(i + 1), rest}});
    return page_data(evaluate_shown_designs(*mechanism, test::voxels(info, 6), info.modes.front(), motions,
                                            {"nominal", test::nominal(info)}),
                     "pkmopt");
  };
  const std::string few = page_of(3), many = page_of(100);
  const json of_few = json::parse(few)["studies"][0], of_many = json::parse(many)["studies"][0];
  EXPECT_EQ(of_few["motions"]["motions"].size(), 3u);
  EXPECT_EQ(of_few["motions"]["omitted"], 0);
  const std::size_t shown = of_many["motions"]["motions"].size();
  EXPECT_EQ(of_many["motions"]["omitted"], 100 - shown);
  EXPECT_EQ(of_many["motions"]["motions"][0]["name"], "motion 1");
  EXPECT_EQ(of_many["mechanism"]["designs"][0]["motions"].size(), shown);
  EXPECT_LT(many.size(), 3 * few.size());
}

TEST(PageData, GradientSupportAgreesWithTheStudyReader) {
  const auto study = [](const std::string& workspace, const std::string& variable) {
    return "[mechanism]\ntype = \"4ppa-2par\"\n[variables]\na = { min = 0.15, max = 0.3" + variable +
           " }\n[workspace]\n" + workspace +
           "\n[[objective]]\ntype = \"workspace-ratio\"\n[[stage]]\noptimiser = \"ga\"\n";
  };
  const std::string columns = "method = \"columns\"",
                    voxels = "method = \"voxels\"\ncells = { x = 6, z = 6, theta = 6 }";
  for (const std::string& text : {study(columns, ""), study(voxels, ""), study(columns, ", step = 0.01")}) {
    PageStudy page = sample_page();
    page.study = testing::read_real(text);
    const std::string message = testing::real_complaint(text + "[[stage]]\noptimiser = \"nlopt\"\nstart = \"best\"\n");
    const json unsupported = json::parse(json_text(problem_data(page)))["gradients_unsupported"];
    EXPECT_EQ(unsupported.is_null(), message == "accepted") << message;
    if (!unsupported.is_null()) {
      EXPECT_THAT(message, HasSubstr(unsupported.get<std::string>()));
    }
  }
  EXPECT_TRUE(problem_data(sample_page())["gradients_unsupported"].is_string()) << "the study is unreadable";
}

TEST(PageData, MotorQuantitiesRequireDriveTrains) {
  const std::string text = R"([mechanism]
type = "3crr-r-cru"
[variables]
l = { min = 0.3, max = 0.5 }
[[motion]]
name = "there"
type = "points"
points = [{ x = 0.15, y = 0.2, z = 0.2, phi = 0 }, { x = 0.2 }]
time = 0.5
[[objective]]
type = "workspace-volume"
[[stage]]
optimiser = "ga"
)";
  const auto summary_of = [&](const std::string& drives) {
    const Study study = testing::read_real(text + drives);
    const Mechanism& mechanism = *study.problem->parts().mechanism;
    const ShownDesigns views = evaluate_shown_designs(mechanism, test::voxels(mechanism.info(), 6), "", study.motions,
                                                      {"nominal", study.problem->parts().parameters});
    return json::parse(json_text(motions_data(views)))["motions"][0]["designs"][0]["summary"];
  };
  const json with = summary_of("[[drive_train]]\njoint = \"all\"\nlead = \"20 mm\"\n"), without = summary_of("");
  for (const char* key : {"peak_motor_torque", "rms_motor_torque", "peak_motor_speed"}) {
    EXPECT_EQ(with[key].size(), 4u) << key;
    EXPECT_FALSE(without.contains(key));
  }
  for (std::size_t i = 0; i < 4; ++i) EXPECT_GE(with["peak_motor_torque"][i], with["rms_motor_torque"][i]);
}

/// The rotary Delta with motors of experiments/mechanisms/motors/fastest-delta.toml.
json delta_page() {
  const Study study = load_study_toml(PKM_TEST_DATA "/../../experiments/mechanisms/motors/fastest-delta.toml",
                                      testing::all_catalogues());
  const ProblemParts& parts = study.problem->parts();
  const Mechanism& mechanism = *parts.mechanism;
  const ShownDesigns shown = evaluate_shown_designs(mechanism, test::voxels(mechanism.info(), 12), "", study.motions,
                                                    {"nominal", parts.parameters});
  return json::parse(page_data(shown, "pkmopt"))["studies"][0];
}

TEST(PageData, DeltaHasSizesJointRangesMassesBaseAndMotors) {
  const json study = delta_page(), workspace = study["workspace"]["designs"][0];
  ASSERT_EQ(workspace["sizes"].size(), 2u);
  EXPECT_EQ(workspace["sizes"][0]["shape"], "cylinder");
  EXPECT_EQ(workspace["sizes"][1]["shape"], "box");
  const double diameter = workspace["sizes"][0]["dimensions"][0]["value"];
  EXPECT_GT(diameter, 0.1);
  EXPECT_LT(diameter, 1.4);
  ASSERT_EQ(workspace["joints"].size(), 3u);
  constexpr double kDegree = std::numbers::pi / 180;  // the file gives -40 deg and 95 deg
  for (const json& joint : workspace["joints"]) {
    EXPECT_NEAR(joint["range"][0], -40 * kDegree, 1e-12);
    EXPECT_NEAR(joint["range"][1], 95 * kDegree, 1e-12);
  }
  const json& mechanism = study["mechanism"]["designs"][0];
  double mass = 0;
  for (const json& body : mechanism["masses"]) mass += body["mass"].get<double>();
  // platform 0.25 kg; three tubular cranks 30/26 mm of 200 mm, 2700 kg/m^3; three pairs of rods of 500 mm, 0.12 kg/m
  const double section = std::numbers::pi / 4 * (0.030 * 0.030 - 0.026 * 0.026);
  EXPECT_NEAR(mass, 0.25 + 3 * 2700 * section * 0.2 + 3 * 0.12 * 0.5, 1e-12);
  std::map<std::string, int> parts;
  for (const json& link : mechanism["links"]) ++parts[link["part"]];
  EXPECT_EQ(parts["motors"], 3);
  EXPECT_EQ(parts["frame"], 3);  // the base is a triangle
}

TEST(PageData, DrivesHaveAVerdictIfTheyHaveRatings) {
  const json drives = delta_page()["motions"]["motions"][0]["designs"][0]["drives"];
  EXPECT_EQ(drives["motor"], "200 W");
  EXPECT_GT(drives["reserve"], 1);
  EXPECT_THAT(drives["joint"].get<std::string>(), HasSubstr("arm"));
  // The smallest ratio of a rating to the summary of the same motion: ratings of the file.
  const json summary = delta_page()["motions"]["motions"][0]["designs"][0]["summary"];
  double reserve = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < 3; ++i) {
    reserve = std::fmin(reserve, 0.64 / summary["rms_motor_torque"][i].get<double>());
    reserve = std::fmin(reserve, 524 / summary["peak_motor_speed"][i].get<double>());
  }
  EXPECT_LE(drives["reserve"], reserve * (1 + 1e-12));
}

TEST(PageData, InvalidDesignIsReported) {
  const auto mechanism = test_mechanism("4ppa-2par");
  std::vector<double> parameters(mechanism->info().parameters.size(), 0.0);
  const ShownDesigns views =
      evaluate_shown_designs(*mechanism, test::columns(mechanism->info()), "", {}, {"nothing", parameters});
  const json workspace = json::parse(json_text(workspace_data(views)));
  EXPECT_THAT(workspace["designs"], IsEmpty());
  EXPECT_THAT(workspace["problems"][0].get<std::string>(), HasSubstr("“nothing” is not shown: "));
  EXPECT_TRUE(mechanism_data(views).is_null());
}

}  // namespace
}  // namespace pkm
