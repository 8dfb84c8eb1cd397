// The C interface as a program sees it: through pkmopt.h and the shared library alone.
#include <pkmopt.h>

#include <unistd.h>

#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace {

using Json = nlohmann::json;
using ::testing::HasSubstr;

#define ASSERT_OK(call) ASSERT_EQ(call, PKMOPT_OK) << pkmopt_error()
#define EXPECT_OK(call) EXPECT_EQ(call, PKMOPT_OK) << pkmopt_error()

struct Free {
  void operator()(pkmopt_mechanism* handle) const { pkmopt_mechanism_free(handle); }
  void operator()(pkmopt_design* handle) const { pkmopt_design_free(handle); }
  void operator()(pkmopt_study* handle) const { pkmopt_study_free(handle); }
  void operator()(pkmopt_results* handle) const { pkmopt_results_free(handle); }
  void operator()(pkmopt_optimiser* handle) const { pkmopt_optimiser_free(handle); }
};
using MechanismHandle = std::unique_ptr<pkmopt_mechanism, Free>;
using DesignHandle = std::unique_ptr<pkmopt_design, Free>;
using StudyHandle = std::unique_ptr<pkmopt_study, Free>;
using ResultsHandle = std::unique_ptr<pkmopt_results, Free>;
using OptimiserHandle = std::unique_ptr<pkmopt_optimiser, Free>;

/// Takes over a text that the library has allocated.
std::string taken(char* text) {
  const std::string copy = text;
  pkmopt_free(text);
  return copy;
}

MechanismHandle mechanism(const std::string& name) {
  pkmopt_mechanism* made = nullptr;
  EXPECT_OK(pkmopt_mechanism_by_name(name.c_str(), &made));
  return MechanismHandle(made);
}

MechanismHandle delta() {
  pkmopt_mechanism* made = nullptr;
  EXPECT_OK(pkmopt_mechanism_from_file(PKM_EXPERIMENTS "/mechanisms/rotary-delta.toml", nullptr, &made));
  return MechanismHandle(made);
}

DesignHandle design_of(const pkmopt_mechanism* mechanism, const std::vector<double>& parameters = {}) {
  pkmopt_design* made = nullptr;
  EXPECT_OK(pkmopt_design_create(mechanism, parameters.empty() ? nullptr : parameters.data(), nullptr, nullptr, &made));
  return DesignHandle(made);
}

const std::string kStudy = R"(
[mechanism]
type = "4ppa-2par"
[variables]
a = { min = 0.2, max = 0.5 }
b = { min = 0.5, max = 1.2 }
[[objective]]
type = "workspace-volume"
[[constraint]]
type = "expression"
name = "sum"
expression = "1.5 - a - b"
unit = "m"
[[stage]]
optimiser = "ga"
generations = 12
population = 20
)";

StudyHandle study_of(const std::string& toml) {
  pkmopt_study* made = nullptr;
  EXPECT_OK(pkmopt_study_from_text(toml.c_str(), "s.toml", nullptr, nullptr, nullptr, &made));
  return StudyHandle(made);
}

Json info_of(const pkmopt_study* study) {
  char* json = nullptr;
  EXPECT_OK(pkmopt_study_info(study, &json));
  return Json::parse(taken(json));
}

/// Designs spread over the variables of kStudy.
std::vector<double> designs(std::size_t count) {
  std::vector<double> all;
  for (std::size_t k = 0; k < count; ++k) {
    const auto t = static_cast<double>(k);
    all.insert(all.end(), {0.2 + 0.3 * std::fmod(0.618 * t, 1), 0.5 + 0.7 * std::fmod(0.755 * t, 1)});
  }
  return all;
}

bool is_same(const std::vector<double>& a, const std::vector<double>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0);
}

struct Values {
  std::vector<double> objectives, margins, outputs;
  std::vector<std::uint8_t> status;

  bool operator==(const Values& other) const {  // NaN are equal, too
    return is_same(objectives, other.objectives) && is_same(margins, other.margins) &&
           is_same(outputs, other.outputs) && status == other.status;
  }

  Values(std::size_t count, const Json& info)
      : objectives(count * info["objectives"].size()),
        margins(count * info["constraints"].size()),
        outputs(count * info["outputs"].size()),
        status(count) {}
};

/// A study file in a folder of this process, removed at the end.
struct File {
  explicit File(const std::string& name)
      : folder(std::filesystem::temp_directory_path() / ("pkmopt-c-" + std::to_string(getpid()))),
        path((folder / name).string()) {
    std::filesystem::create_directories(folder);
  }
  ~File() { std::filesystem::remove_all(folder); }
  std::filesystem::path folder;
  std::string path;
};

struct Table {
  std::vector<double> designs, objectives, margins;
  std::vector<std::uint8_t> status;
  bool operator==(const Table& other) const {  // NaN are equal, too
    return is_same(designs, other.designs) && is_same(objectives, other.objectives) &&
           is_same(margins, other.margins) && status == other.status;
  }
};

Table table_of(const std::string& path) {
  pkmopt_results* opened = nullptr;
  EXPECT_OK(pkmopt_results_open(path.c_str(), &opened));
  const ResultsHandle results(opened);
  char* json = nullptr;
  EXPECT_OK(pkmopt_results_info(results.get(), &json));
  const std::size_t rows = Json::parse(taken(json))["tables"][0]["rows"];
  Table table{std::vector<double>(2 * rows), std::vector<double>(rows), std::vector<double>(rows),
              std::vector<std::uint8_t>(rows)};
  EXPECT_OK(pkmopt_results_evaluations(results.get(), 0, table.designs.data(), table.objectives.data(),
                                       table.margins.data(), nullptr, table.status.data(), nullptr, nullptr));
  return table;
}

TEST(CInterface, HasTheVersionOfTheHeader) {
  const std::string version = std::to_string(PKMOPT_VERSION_MAJOR) + "." + std::to_string(PKMOPT_VERSION_MINOR) + "." +
                              std::to_string(PKMOPT_VERSION_PATCH);
  EXPECT_EQ(pkmopt_version(), version);
}

TEST(CInterface, ErrorsAreSentencesOfTheThread) {
  pkmopt_mechanism* none = nullptr;
  EXPECT_EQ(pkmopt_mechanism_by_name("4ppa-2pa", &none), PKMOPT_INVALID_INPUT);
  EXPECT_THAT(pkmopt_error(), HasSubstr("did you mean '4ppa-2par'?"));
  std::thread([] { EXPECT_STREQ(pkmopt_error(), ""); }).join();
  EXPECT_EQ(pkmopt_mechanism_by_name(nullptr, &none), PKMOPT_INVALID_INPUT);
  EXPECT_EQ(pkmopt_mechanism_from_text("[mechanism", "m.toml", nullptr, &none), PKMOPT_INVALID_INPUT);
  EXPECT_THAT(pkmopt_error(), HasSubstr("m.toml:1"));
  pkmopt_results* results = nullptr;
  EXPECT_EQ(pkmopt_results_open("/nonexistent/file.h5", &results), PKMOPT_FILE_ERROR);
  const MechanismHandle robot = delta();
  pkmopt_design* design = nullptr;
  const std::vector<double> negative(6, -1);
  EXPECT_EQ(pkmopt_design_create(robot.get(), negative.data(), nullptr, nullptr, &design), PKMOPT_DESIGN_ERROR);
  EXPECT_EQ(pkmopt_design_create(robot.get(), nullptr, "upside-down", nullptr, &design), PKMOPT_INVALID_INPUT);
  double value = 0;
  EXPECT_EQ(pkmopt_number("3 kg", "m", &value), PKMOPT_INVALID_INPUT);
  EXPECT_OK(pkmopt_number("300 mm", "m", &value));
  EXPECT_EQ(value, 0.3);
}

TEST(CInterface, ForwardInvertsInverseAndJacobiansAreItsDerivatives) {
  const MechanismHandle robot = delta();
  const DesignHandle design = design_of(robot.get());
  constexpr std::size_t kPoses = 200;
  std::vector<double> poses, shifted;
  for (std::size_t k = 0; k < kPoses; ++k) {
    const auto t = static_cast<double>(k);
    poses.insert(poses.end(), {0.1 * std::sin(t), 0.1 * std::cos(1.7 * t), -0.4 + 0.05 * std::sin(0.3 * t)});
  }
  std::vector<double> joints(3 * kPoses), J(9 * kPoses), below(3 * kPoses), above(3 * kPoses), found(3 * kPoses);
  std::vector<std::size_t> count(kPoses);
  ASSERT_OK(pkmopt_design_inverse(design.get(), kPoses, poses.data(), joints.data(), nullptr));
  ASSERT_OK(pkmopt_design_jacobians(design.get(), kPoses, poses.data(), J.data(), nullptr));
  ASSERT_OK(
      pkmopt_design_forward(design.get(), kPoses, joints.data(), poses.data(), 1, found.data(), count.data(), nullptr));
  for (std::size_t i = 0; i < poses.size(); ++i) EXPECT_NEAR(found[i], poses[i], 1e-9);
  constexpr double kStep = 1e-6;
  for (std::size_t coordinate = 0; coordinate < 3; ++coordinate) {
    for (const double sign : {-1.0, 1.0}) {
      shifted = poses;
      for (std::size_t k = 0; k < kPoses; ++k) shifted[3 * k + coordinate] += sign * kStep;
      ASSERT_OK(
          pkmopt_design_inverse(design.get(), kPoses, shifted.data(), (sign < 0 ? below : above).data(), nullptr));
    }
    for (std::size_t k = 0; k < 3 * kPoses; ++k)
      EXPECT_NEAR(J[3 * k + coordinate], (above[k] - below[k]) / (2 * kStep), 1e-7);
  }
}

TEST(CInterface, ForwardFindsTheNearestPoseEvenIfItIsUnusual) {
  const MechanismHandle robot = mechanism("4ppa-2par");
  const DesignHandle design = design_of(robot.get());
  const std::array<double, 4> pose = {0.42, 0.02, -0.31, 0.1};  // the joints of the platform are above the rails
  std::array<double, 4> joints{}, near{};
  std::array<double, 16 * 4> all{};
  std::size_t count = 0;
  ASSERT_OK(pkmopt_design_inverse(design.get(), 1, pose.data(), joints.data(), nullptr));
  ASSERT_OK(pkmopt_design_forward(design.get(), 1, joints.data(), pose.data(), 1, near.data(), &count, nullptr));
  EXPECT_EQ(count, 1U);
  for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR(near[i], pose[i], 1e-12);
  ASSERT_OK(pkmopt_design_forward(design.get(), 1, joints.data(), nullptr, 16, all.data(), &count, nullptr));
  ASSERT_GE(count, 1U);
  for (std::size_t k = 0; k < count; ++k) EXPECT_GT(std::abs(all[4 * k + 2] - pose[2]), 0.01);
}

TEST(CInterface, PosesThatDoNotAssembleAreNan) {
  const MechanismHandle robot = delta();
  const DesignHandle design = design_of(robot.get());
  const std::array<double, 6> poses = {0, 0, -0.4, 0, 0, -4};
  std::array<double, 6> joints{};
  ASSERT_OK(pkmopt_design_inverse(design.get(), 2, poses.data(), joints.data(), nullptr));
  for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(std::isnan(joints[i]), i >= 3);
  std::array<double, 2> values{};
  for (const char* name : {"lti", "conditioning"}) {
    ASSERT_OK(pkmopt_design_quantity(design.get(), name, 2, poses.data(), values.data(), nullptr));
    EXPECT_GT(values[0], 0);
    EXPECT_TRUE(std::isnan(values[1]));
  }
  EXPECT_EQ(pkmopt_design_quantity(design.get(), "ltj", 2, poses.data(), values.data(), nullptr), PKMOPT_INVALID_INPUT);
  EXPECT_THAT(pkmopt_error(), HasSubstr("did you mean 'lti'?"));
  EXPECT_EQ(pkmopt_design_quantity(design.get(), "accuracy", 2, poses.data(), values.data(), nullptr),
            PKMOPT_INVALID_INPUT);
  EXPECT_THAT(pkmopt_error(), HasSubstr("[accuracy]"));
}

TEST(CInterface, MarginsDecideWhichPosesAreFeasible) {
  const MechanismHandle robot = delta();
  const DesignHandle design = design_of(robot.get());
  char* json = nullptr;
  ASSERT_OK(pkmopt_design_margin_names(design.get(), &json));
  const std::size_t names = Json::parse(taken(json)).size();
  const std::array<double, 9> poses = {0, 0, -0.4, 0, 0, -4, 0.3, 0, -0.2};
  std::vector<double> margins(3 * names);
  ASSERT_OK(pkmopt_design_margins(design.get(), 3, poses.data(), margins.data(), nullptr));
  const auto is_feasible = [&](std::size_t pose) {
    for (std::size_t i = 0; i < names; ++i)
      if (!(margins[pose * names + i] >= 0)) return false;
    return true;
  };
  EXPECT_TRUE(is_feasible(0));
  EXPECT_FALSE(is_feasible(1));
  EXPECT_FALSE(is_feasible(2));
}

TEST(CInterface, ForcesAtRestHoldTheGravity) {
  const MechanismHandle robot = delta();
  const DesignHandle design = design_of(robot.get());
  const std::array<double, 3> pose = {0.05, 0.02, -0.4};
  std::array<double, 3> forces{}, gravity{}, coriolis{};
  std::array<double, 9> inertia{};
  ASSERT_OK(pkmopt_design_dynamics(design.get(), 1, pose.data(), nullptr, nullptr, nullptr, forces.data(),
                                   inertia.data(), coriolis.data(), gravity.data(), nullptr));
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(forces[i], gravity[i], 1e-12);
    EXPECT_NEAR(coriolis[i], 0, 1e-15);
    EXPECT_GT(inertia[4 * i], 0);
  }
}

TEST(CInterface, LinksJoinTheirNeighbours) {
  const MechanismHandle robot = delta();
  const DesignHandle design = design_of(robot.get());
  char* json = nullptr;
  ASSERT_OK(pkmopt_design_link_names(design.get(), &json));
  const Json names = Json::parse(taken(json));
  std::vector<double> capsules(7 * names.size());
  const std::array<double, 3> pose = {0.05, 0.02, -0.4};
  ASSERT_OK(pkmopt_design_links(design.get(), 1, pose.data(), capsules.data(), nullptr));
  EXPECT_EQ(names[0]["name"], "crank of arm1");
  EXPECT_EQ(names[1]["name"], "rod of arm1");
  for (std::size_t i = 0; i < 3; ++i) EXPECT_NEAR(capsules[3 + i], capsules[7 + i], 1e-12);  // the elbow
}

TEST(CInterface, TheVolumeHasTheDerivativesOfDifferences) {
  const StudyHandle study = study_of("[mechanism]\ntype = \"4ppa-2par\"\n");
  const Json info = info_of(study.get());
  EXPECT_EQ(info["volume_unit"], "m^2 rad");
  std::vector<double> parameters, gradient(info["parameters"].size());
  for (const Json& parameter : info["parameters"]) parameters.push_back(parameter["value"]);
  double volume = 0, error = 0;
  ASSERT_OK(pkmopt_study_volume(study.get(), parameters.data(), &volume, &error, gradient.data(), nullptr));
  EXPECT_GT(volume, 0);
  EXPECT_LT(error, 1e-7);
  for (const std::size_t i : {0U, 1U, 2U, 3U}) {
    std::array<double, 2> at{};
    for (const int side : {0, 1}) {
      std::vector<double> moved = parameters;
      moved[i] += side == 0 ? -1e-5 : 1e-5;
      ASSERT_OK(pkmopt_study_volume(study.get(), moved.data(), &at[static_cast<std::size_t>(side)], &error, nullptr,
                                    nullptr));
    }
    EXPECT_NEAR(gradient[i], (at[1] - at[0]) / 2e-5, 1e-5 * std::fabs(gradient[i]) + 1e-7);
  }
}

TEST(CInterface, FieldsAndSurfaceAreThoseOfTheWorkspace) {
  pkmopt_study* made = nullptr;
  std::ifstream file(PKM_EXPERIMENTS "/mechanisms/rotary-delta.toml");
  const std::string text(std::istreambuf_iterator<char>(file), {});
  ASSERT_OK(
      pkmopt_study_from_text("[mechanism]\nfile = \"delta.toml\"\n[workspace]\nmethod = \"voxels\"\n"
                             "cells = { x = 24, y = 25, z = 26 }\n",
                             "w.toml", text.c_str(), "delta.toml", nullptr, &made));
  const StudyHandle study(made);
  std::vector<double> parameters;
  const Json described = info_of(study.get());
  for (const Json& parameter : described["parameters"]) parameters.push_back(parameter["value"]);
  char* json = nullptr;
  double* values = nullptr;
  ASSERT_OK(pkmopt_study_fields(study.get(), parameters.data(), nullptr, &json, &values, nullptr));
  const Json info = Json::parse(taken(json));
  ASSERT_EQ(info["fields"][0]["name"], "feasible");
  double cells = 0, volume = 0, error = 0, cell = 1;
  for (std::size_t i = 0; i < std::size_t{24} * 25 * 26; ++i) cells += values[i];
  pkmopt_free(values);
  for (const Json& axis : info["axes"])
    cell *= (axis["upper"].get<double>() - axis["lower"].get<double>()) / axis["cells"].get<double>();
  ASSERT_OK(pkmopt_study_volume(study.get(), parameters.data(), &volume, &error, nullptr, nullptr));
  EXPECT_NEAR(cells * cell, volume, 1e-12);

  std::size_t vertices = 0, triangles = 0;
  double* at = nullptr;
  std::uint32_t* corners = nullptr;
  ASSERT_OK(pkmopt_study_surface(study.get(), parameters.data(), &vertices, &at, &triangles, &corners, nullptr));
  double enclosed = 0;  // by the divergence theorem
  for (std::size_t i = 0; i < triangles; ++i) {
    const double *a = at + 3 * corners[3 * i], *b = at + 3 * corners[3 * i + 1], *c = at + 3 * corners[3 * i + 2];
    enclosed +=
        (a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) + a[2] * (b[0] * c[1] - b[1] * c[0])) /
        6;
  }
  pkmopt_free(at);
  pkmopt_free(corners);
  EXPECT_NEAR(enclosed, volume, 0.05 * volume);
}

TEST(CInterface, DesignsHaveTheSameValuesAloneTogetherAndOnAnyThreads) {
  const StudyHandle study = study_of(kStudy);
  const Json info = info_of(study.get());
  constexpr std::size_t kCount = 100;
  const std::vector<double> X = designs(kCount);
  const auto evaluate = [&](std::size_t first, std::size_t count, const pkmopt_options* options, Values& values) {
    ASSERT_OK(pkmopt_study_evaluate(study.get(), count, X.data() + 2 * first, 1, values.objectives.data() + first,
                                    values.margins.data() + first, values.outputs.data(), values.status.data() + first,
                                    options));
  };
  Values together(kCount, info), alone(kCount, info), on_one(kCount, info), smooth(kCount, info);
  evaluate(0, kCount, nullptr, together);
  pkmopt_options one = {};
  one.threads = 1;
  evaluate(0, kCount, &one, on_one);
  for (std::size_t k = 0; k < kCount; ++k) evaluate(k, 1, nullptr, alone);
  EXPECT_EQ(together, on_one);
  EXPECT_EQ(together, alone);
  std::vector<double> derivatives(kCount * 2 * 3);
  ASSERT_OK(pkmopt_study_differentiate(study.get(), kCount, X.data(), smooth.objectives.data(), smooth.margins.data(),
                                       smooth.outputs.data(), smooth.status.data(), derivatives.data(), nullptr));
  EXPECT_EQ(smooth, together);
  for (std::size_t k = 0; k < kCount; ++k) EXPECT_EQ(derivatives[6 * k], together.objectives[k]);
}

TEST(CInterface, DesignsThatTheMechanismRefusesFail) {
  const StudyHandle study = study_of(kStudy);
  const Json info = info_of(study.get());
  const std::vector<double> X = {0.3, 0.9, -1, 0.9, 0.6, 0.8};  // the last one is outside of the variables' bounds only
  Values together(3, info), alone(3, info);
  const auto evaluate = [&](std::size_t first, std::size_t count, Values& values) {
    ASSERT_OK(pkmopt_study_evaluate(study.get(), count, X.data() + 2 * first, 1, values.objectives.data() + first,
                                    values.margins.data() + first, values.outputs.data(), values.status.data() + first,
                                    nullptr));
  };
  evaluate(0, 3, together);
  for (std::size_t k = 0; k < 3; ++k) evaluate(k, 1, alone);
  for (const Values& values : {together, alone}) {
    EXPECT_EQ(values.status, (std::vector<std::uint8_t>{PKMOPT_FEASIBLE, PKMOPT_FAILED, PKMOPT_FEASIBLE}));
    EXPECT_TRUE(std::isnan(values.objectives[1]) && std::isnan(values.margins[1]));
    EXPECT_EQ(values.objectives[2], together.objectives[2]);
  }
  char* sentence = nullptr;
  ASSERT_OK(pkmopt_study_why_failed(study.get(), X.data() + 2, &sentence, nullptr));
  EXPECT_THAT(taken(sentence), HasSubstr("a = -1 is outside the model's range"));
}

TEST(CInterface, RunsResumesAndExtends) {
  const StudyHandle study = study_of(kStudy);
  const File whole("whole.h5"), stopped("stopped.h5");
  char* json = nullptr;
  ASSERT_OK(pkmopt_study_run(study.get(), whole.path.c_str(), -1, nullptr, &json));
  EXPECT_EQ(Json::parse(taken(json))["evaluations"], 260);
  EXPECT_EQ(pkmopt_study_run(study.get(), whole.path.c_str(), -1, nullptr, &json), PKMOPT_FILE_ERROR);
  EXPECT_THAT(pkmopt_error(), HasSubstr("exists already"));

  pkmopt_run_options options = {};
  options.time_limit = -1;
  EXPECT_EQ(pkmopt_study_run(study.get(), stopped.path.c_str(), -1, &options, &json), PKMOPT_INVALID_INPUT);
  EXPECT_EQ(pkmopt_study_resume(whole.path.c_str(), -5, 0, nullptr, &json), PKMOPT_INVALID_INPUT);
  EXPECT_THAT(pkmopt_error(), HasSubstr("generations: found -5"));
  options.time_limit = 0;
  int generations = 0;
  options.user = &generations;
  options.progress = [](const pkmopt_progress* progress, void* user) {
    ++*static_cast<int*>(user);
    return progress->generation == 4 ? 1 : 0;
  };
  ASSERT_OK(pkmopt_study_run(study.get(), stopped.path.c_str(), -1, &options, &json));
  EXPECT_EQ(Json::parse(taken(json))["stopped"], "request");
  EXPECT_EQ(generations, 5);
  EXPECT_LT(table_of(stopped.path).status.size(), 260U);
  ASSERT_OK(pkmopt_study_resume(stopped.path.c_str(), 0, 0, nullptr, &json));
  pkmopt_free(json);
  EXPECT_EQ(table_of(stopped.path), table_of(whole.path));
  ASSERT_OK(pkmopt_study_resume(stopped.path.c_str(), 14, 0, nullptr, &json));
  pkmopt_free(json);
  EXPECT_EQ(table_of(stopped.path).status.size(), 300U);
}

TEST(CInterface, InterruptsEndCallsAndRuns) {
  const StudyHandle study = study_of(
      "[mechanism]\ntype = \"4ppa-2par\"\n[variables]\na = { min = 0.2, max = 0.5 }\nb = { min = 0.5, max = 1.2 }\n"
      "[workspace]\nmethod = \"voxels\"\ncells = { x = 100, z = 100, theta = 100 }\n"
      "[[objective]]\ntype = \"workspace-volume\"\n[[stage]]\noptimiser = \"ga\"\ngenerations = 100000\n");
  constexpr std::size_t kCount = 100000;
  const std::vector<double> X = designs(kCount);
  Values values(kCount, info_of(study.get()));
  pkmopt_options options = {};
  int calls = 0;
  options.user = &calls;
  options.interrupt = [](void* user) { return ++*static_cast<int*>(user) >= 2 ? 1 : 0; };
  EXPECT_EQ(pkmopt_study_evaluate(study.get(), kCount, X.data(), 1, values.objectives.data(), nullptr, nullptr,
                                  values.status.data(), &options),
            PKMOPT_STOPPED);
  EXPECT_EQ(calls, 2);
  const File file("interrupted.h5");
  calls = 0;
  pkmopt_run_options run = {};
  run.common = options;
  char* json = nullptr;
  ASSERT_OK(pkmopt_study_run(study.get(), file.path.c_str(), 7, &run, &json));
  EXPECT_EQ(Json::parse(taken(json))["stopped"], "request");
  EXPECT_GT(table_of(file.path).status.size(), 0U);
}

/// The evaluations of an optimiser that is told the values of a study.
Table told_by(const pkmopt_study* study, const std::string& options) {
  const std::array<double, 2> lower = {0.2, 0.5}, upper = {0.5, 1.2};
  const int maximise = 1;
  pkmopt_optimiser* made = nullptr;
  EXPECT_OK(
      pkmopt_optimiser_create(options.c_str(), 2, lower.data(), upper.data(), nullptr, 1, &maximise, 1, 1, &made));
  const OptimiserHandle optimiser(made);
  const Json info = info_of(study);
  for (;;) {
    std::size_t count = 0;
    const double* X = nullptr;
    int derivatives = 0;
    EXPECT_OK(pkmopt_optimiser_ask(optimiser.get(), &count, &X, &derivatives));
    if (count == 0) break;
    Values values(count, info);
    std::vector<double> all(count * 6), slopes;
    if (derivatives) {
      EXPECT_OK(pkmopt_study_differentiate(study, count, X, values.objectives.data(), values.margins.data(),
                                           values.outputs.data(), values.status.data(), all.data(), nullptr));
      for (std::size_t i = 0; i < all.size(); ++i)
        if (i % 3 != 0) slopes.push_back(all[i]);
    } else {
      EXPECT_OK(pkmopt_study_evaluate(study, count, X, 0, values.objectives.data(), values.margins.data(),
                                      values.outputs.data(), values.status.data(), nullptr));
    }
    EXPECT_OK(pkmopt_optimiser_tell(optimiser.get(), values.objectives.data(), values.margins.data(),
                                    derivatives ? slopes.data() : nullptr, values.status.data()));
  }
  std::size_t rows = 0;
  std::int64_t best = -1;
  EXPECT_OK(pkmopt_optimiser_evaluations(optimiser.get(), &rows, nullptr, nullptr, nullptr, nullptr, &best));
  EXPECT_GE(best, 0);
  Table table{std::vector<double>(2 * rows), std::vector<double>(rows), std::vector<double>(rows),
              std::vector<std::uint8_t>(rows)};
  EXPECT_OK(pkmopt_optimiser_evaluations(optimiser.get(), &rows, table.designs.data(), table.objectives.data(),
                                         table.margins.data(), table.status.data(), &best));
  return table;
}

TEST(CInterface, AskAndTellGiveTheDesignsOfARun) {
  for (const std::string stage :
       {"optimiser = \"ga\"\ngenerations = 12\npopulation = 20\n",
        "optimiser = \"nlopt\"\nalgorithm = \"slsqp\"\nstart = \"best\"\n", "optimiser = \"sweep\"\npoints = 7\n"}) {
    const StudyHandle study = study_of(kStudy.substr(0, kStudy.find("[[stage]]")) + "[[stage]]\n" + stage);
    const File file("run.h5");
    char* json = nullptr;
    ASSERT_OK(pkmopt_study_run(study.get(), file.path.c_str(), 1, nullptr, &json)) << stage;
    pkmopt_free(json);
    const Table run = table_of(file.path), told = told_by(study.get(), stage);
    EXPECT_EQ(run.designs, told.designs) << stage;
    EXPECT_EQ(run.status, told.status) << stage;
  }
}

TEST(CInterface, OptimisersRefuseWhatWasNotAskedAndMayBeFreedBeforeTheyEnd) {
  for (const bool has_asked : {false, true}) {
    const double lower = 0, upper = 1;
    pkmopt_optimiser* made = nullptr;
    ASSERT_OK(pkmopt_optimiser_create("optimiser = 'ga'", 1, &lower, &upper, nullptr, 1, nullptr, 0, 1, &made));
    const OptimiserHandle optimiser(made);
    const double value = 0;
    if (!has_asked) {
      EXPECT_EQ(pkmopt_optimiser_tell(made, &value, nullptr, nullptr, nullptr), PKMOPT_INVALID_INPUT);
      continue;
    }
    std::size_t count = 0;
    const double* X = nullptr;
    int derivatives = 0;
    ASSERT_OK(pkmopt_optimiser_ask(made, &count, &X, &derivatives));
    ASSERT_GT(count, 0U);
    const std::vector<double> values(count);
    std::vector<std::uint8_t> status(count);
    status.back() = PKMOPT_FAILED + 1;
    EXPECT_EQ(pkmopt_optimiser_tell(made, values.data(), nullptr, nullptr, status.data()), PKMOPT_INVALID_INPUT);
  }
}

TEST(CInterface, TwoThreadsWorkAtOnceOnOneHandle) {
  const StudyHandle study = study_of(kStudy);
  const Json info = info_of(study.get());
  constexpr std::size_t kCount = 400;
  const std::vector<double> X = designs(kCount);
  Values expected(kCount, info);
  ASSERT_OK(pkmopt_study_evaluate(study.get(), kCount, X.data(), 1, expected.objectives.data(), expected.margins.data(),
                                  nullptr, expected.status.data(), nullptr));
  std::vector<std::thread> threads;
  for (int i = 0; i < 2; ++i)
    threads.emplace_back([&, i] {
      Values values(kCount, info);
      for (int round = 0; round < 5; ++round) {
        const std::size_t step = i == 0 ? kCount : 1;
        for (std::size_t k = 0; k < kCount; k += step)
          EXPECT_OK(pkmopt_study_evaluate(study.get(), step, X.data() + 2 * k, 1, values.objectives.data() + k,
                                          values.margins.data() + k, values.outputs.data(), values.status.data() + k,
                                          nullptr));
        EXPECT_EQ(values, expected);
      }
    });
  for (std::thread& thread : threads) thread.join();
}

long resident_pages() {
  std::ifstream file("/proc/self/statm");
  long all = 0, resident = 0;
  file >> all >> resident;
  return resident;
}

TEST(CInterface, CallsLeaveNoMemoryBehind) {
  const StudyHandle study = study_of(kStudy);
  const MechanismHandle robot = mechanism("4ppa-2par");
  const DesignHandle design = design_of(robot.get());
  const std::vector<double> X = designs(1);
  Values values(1, info_of(study.get()));
  const std::array<double, 4> pose = {0.25, 0.85, -0.8, 0.5};
  std::array<double, 4> joints{};
  const auto call = [&](int times) {
    for (int i = 0; i < times; ++i) {
      ASSERT_OK(pkmopt_study_evaluate(study.get(), 1, X.data(), 1, values.objectives.data(), values.margins.data(),
                                      nullptr, values.status.data(), nullptr));
      ASSERT_OK(pkmopt_design_inverse(design.get(), 1, pose.data(), joints.data(), nullptr));
      if (i % 100 == 0) {
        char* json = nullptr;
        ASSERT_OK(pkmopt_study_info(study.get(), &json));
        pkmopt_free(json);
      }
    }
  };
  call(2000);
  const long before = resident_pages();
  call(100000);
  EXPECT_LE(resident_pages() - before, 64);  // 256 kB
}

}  // namespace
