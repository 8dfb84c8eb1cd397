// Studies whose volumes have to be within certain bounds: what the end records, where a volume lies outside, and where
// the bounds are interrupted. The bounds are made up here; tests of mechanisms have the true ones.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <thread>

#include "constraints/all.hpp"
#include "engine/core/catalogue.hpp"
#include "engine/mechanisms/all.hpp"
#include "engine/report/design_table.hpp"
#include "engine/report/study_tables.hpp"
#include "engine/storage/study_file.hpp"
#include "engine/study/records.hpp"
#include "engine/study/run_study.hpp"
#include "engine/survey/survey_set.hpp"
#include "objectives/all.hpp"
#include "tests/unit/storage/first_difference.hpp"

namespace pkm::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

/// 4PPa-2PaR with bounds that a test chooses, as shares of the volume.
class Bounded final : public Mechanism, CertainBounds {
 public:
  const MechanismInfo& info() const override { return inner_->info(); }
  Refusal refuse(std::span<const double> p) const override { return inner_->refuse(p); }
  PoseReport inspect(std::span<const double> p, const Pose<double>& pose, const std::string& mode,
                     const LimitSpec& limits) const override {
    return inner_->inspect(p, pose, mode, limits);
  }
  std::optional<double> middle(std::span<const double> p, int coordinate) const override {
    return inner_->middle(p, coordinate);
  }
  void thresholds(std::span<const double> p, const LimitSpec& limits, std::span<double> values) const override {
    inner_->thresholds(p, limits, values);
  }
  void thresholds(std::span<const Dual4> p, const LimitSpec& limits, std::span<Dual4> values) const override {
    inner_->thresholds(p, limits, values);
  }
  const Voxels* voxels() const override { return inner_->voxels(); }
  const Columns* columns() const override { return inner_->columns(); }
  const Size* size() const override { return inner_->size(); }
  const CertainBounds* bounds() const override { return this; }

  double least = 0.99, greatest = 1.01;
  bool interrupts = false;
  mutable int asked = 0;

 private:
  void refuse_bounds(const SurveyPlan& plan) const override {
    if (how_held(plan, 1).kind == HeldCoordinate::Kind::integrated)
      throw std::invalid_argument("bounds are of one value of y");
  }
  VolumeBounds volume(std::span<const double> p, const SurveyPlan& plan, const std::string&,
                      const BoundsOptions& options) const override {
    ++asked;
    const auto surveyor = prepare_survey(*inner_, plan, {});
    Survey<double> survey;
    survey_once<double>(*surveyor, p, survey);
    if (interrupts) {  // and so long that they are not waited for
      std::raise(SIGINT);
      while (!options.stop()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    const bool stopped = options.stop && options.stop();
    return {.lower = stopped ? 0 : least * survey.volume, .upper = greatest * survey.volume, .stopped = stopped};
  }
  PosesCertificate box(std::span<const double>, const SurveyPlan&, const std::string&,
                       std::span<const std::array<double, 2>>, const BoundsOptions&) const override {
    return {};
  }
  PosesCertificate motion(std::span<const double>, const LimitSpec&, const std::string&, const Motion&,
                          const BoundsOptions&) const override {
    return {};
  }

  std::shared_ptr<const Mechanism> inner_ = find_named_mechanism();
  static std::shared_ptr<const Mechanism> find_named_mechanism() {
    for (const auto& mechanism : all_mechanisms())
      if (mechanism->info().name == "4ppa-2par") return mechanism;
    throw std::logic_error("no 4ppa-2par");
  }
};

class CertainStudy : public ::testing::Test {
 protected:
  void SetUp() override {
    std::string name = (std::filesystem::temp_directory_path() / "pkmopt-certain-XXXXXX").string();
    ASSERT_NE(mkdtemp(name.data()), nullptr);
    folder_ = name;
    std::signal(SIGINT, SIG_DFL);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  Catalogues catalogues() const { return {{mechanism_}, all_objectives(), all_constraints(), all_optimisers()}; }
  Study study(const std::string& workspace) const {
    return read_study_toml(
        "[mechanism]\ntype = \"4ppa-2par\"\n[variables]\na = { min = 0.15, max = 0.3 }\n[baseline]\na = 0.2\n"
        "[workspace]\n" +
            workspace +
            "\n[[objective]]\ntype = \"workspace-volume\"\n[[stage]]\noptimiser = "
            "\"ga\"\npopulation = 4\ngenerations = 2\n[final]\nround = 0.01\n[checkpoint]\nevery = 0\n",
        "s.toml", catalogues());
  }
  std::string file() const { return folder_ + "/s.h5"; }

  std::shared_ptr<Bounded> mechanism_ = std::make_shared<Bounded>();
  std::string folder_;
};

TEST_F(CertainStudy, RecordsBoundsOfTheDesignsThatItEndsWithAlone) {
  Progress silent;
  const StudyContents made = run_study(study("certain = 0.05"), file(), false, {}, silent).contents;
  EXPECT_EQ(mechanism_->asked, 3) << "best, rounded, baseline";
  const StudyContents kept = read_study(file());
  for (const auto* design : {&kept.final->best, &kept.final->rounded, &kept.final->baseline}) {
    ASSERT_TRUE((*design)->certain);
    EXPECT_EQ((*design)->status, Status::feasible);
    EXPECT_LT((*design)->certain->lower, (*design)->volume);
    EXPECT_GT((*design)->certain->upper, (*design)->volume);
  }
  EXPECT_EQ(kept.final->best->certain->lower, made.final->best->certain->lower);
  EXPECT_EQ(contradicted(kept), std::vector<std::string>());
  EXPECT_TRUE(kept.notes.empty());
  std::vector<std::string> lines;
  for (const DesignTable::Line& line : design_table(kept, {}).lines)
    if (line.kind == "certain") lines.push_back(line.name + ' ' + line.unit);
  EXPECT_THAT(lines, ElementsAre("volume m^2 rad", "volume, at least m^2 rad", "volume, at most m^2 rad"));

  mechanism_->asked = 0;
  run_study(study(""), file(), true, {}, silent);
  EXPECT_EQ(mechanism_->asked, 0);
  EXPECT_FALSE(read_study(file()).final->best->certain);
}

TEST_F(CertainStudy, AVolumeOutsideFailsItsDesign) {
  mechanism_->least = 1.02;
  mechanism_->greatest = 1.03;
  Progress silent;
  const StudyContents found = run_study(study("certain = true"), file(), false, {}, silent).contents;
  for (const auto* design : {&found.final->best, &found.final->rounded, &found.final->baseline}) {
    EXPECT_EQ((*design)->status, Status::failed);
    EXPECT_THAT((*design)->reason, HasSubstr("lies outside of its certain bounds"));
    EXPECT_THAT((*design)->reason, HasSubstr("columns have overlooked a part of this workspace"));
  }
  EXPECT_THAT(contradicted(read_study(file())),
              ElementsAre(StartsWith("the best design fails: the exact volume, "), StartsWith("the rounded design"),
                          StartsWith("the baseline")));
  mechanism_->least = 0.97;
  mechanism_->greatest = 0.98;
  const StudyContents more = run_study(study("certain = true"), file(), true, {}, silent).contents;
  EXPECT_THAT(more.final->best->reason, HasSubstr("columns have added a part"));
}

TEST_F(CertainStudy, SaysWhereTheGapIsWiderThanAskedFor) {
  Progress silent;
  const StudyContents found = run_study(study("certain = 1e-3"), file(), false, {}, silent).contents;
  ASSERT_EQ(found.notes.size(), 3u);
  EXPECT_THAT(found.notes[1], StartsWith("certain bounds of the best design have the gap 0.0"));
  EXPECT_THAT(found.notes[1], HasSubstr("asked for 0.001"));
}

TEST_F(CertainStudy, WhoseBoundsAreInterruptedIsResumedToTheSameEnd) {
  const Study s = study("certain = true");
  Progress silent;
  run_study(s, folder_ + "/straight.h5", false, {}, silent);
  mechanism_->interrupts = true;
  const RunOutcome stopped = run_study(s, file(), false, {}, silent);
  EXPECT_EQ(stopped.stopped, "SIGINT");
  EXPECT_EQ(read_study(file()).state, StudyState::interrupted);
  const StudyContents left = read_study(file());
  ASSERT_TRUE(left.final && left.final->best);  // what the search found is stored before its bounds
  EXPECT_FALSE(left.final->best->certain || left.final->baseline->certain);
  mechanism_->interrupts = false;
  HeldStudy held(file());
  EXPECT_EQ(resume_study(held, catalogues(), {}, {}, silent).stopped, "");
  EXPECT_EQ(first_difference(read_study(folder_ + "/straight.h5"), read_study(file())), "");
}

TEST_F(CertainStudy, IsRefusedWhereThereAreNoBounds) {
  const auto message_of = [&](const std::string& workspace) -> std::string {
    try {
      study(workspace);
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "accepted";
  };
  const std::string expected = "; expected true, false, or the gap of the bounds: a number between 0 and 2";
  EXPECT_EQ(message_of("certain = false"), "accepted");
  EXPECT_EQ(message_of("certain = 2"), "s.toml:8: workspace.certain: found 2" + expected);
  EXPECT_EQ(message_of("certain = 0"), "s.toml:8: workspace.certain: found 0" + expected);
  EXPECT_EQ(message_of("certain = \"yes\""), "s.toml:8: workspace.certain: found \"yes\"" + expected);
  EXPECT_EQ(message_of("certain = [0.1]"), "s.toml:8: workspace.certain: found [0.1]" + expected);
  EXPECT_THAT(message_of("method = \"voxels\"\ncertain = true"),
              HasSubstr("workspace.certain: this key belongs to method = \"columns\", but the study's method is"));
  EXPECT_THAT(message_of("certain = true\ny = \"integrated\""), HasSubstr("workspace: bounds are of one value of y"));
  EXPECT_THAT(message_of("certian = true"), HasSubstr("certain"));
  const Catalogues built_in = {all_mechanisms(), all_objectives(), all_constraints(), all_optimisers()};
  try {
    read_study_toml("[mechanism]\ntype = \"4ppa-2par\"\n[workspace]\ncertain = true\n", "s.toml", built_in);
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_STREQ(error.what(),
                 "s.toml:4: workspace.certain: certain bounds are of mechanisms from files, whose formulas can be "
                 "computed over intervals; 4ppa-2par is built in");
  }
}

}  // namespace
}  // namespace pkm::testing
