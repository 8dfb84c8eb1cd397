// Tests of studies with certified bounds of the volume: what is recorded, what happens if a volume lies outside its
// bounds, and interruption while bounds are computed. The bounds are invented here; the real ones are tested with the
// mechanisms.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>
#include <thread>

#include "constraints/all.hpp"
#include "engine/config/built_in_mechanisms.hpp"
#include "engine/core/catalogue.hpp"
#include "engine/export/study_tables.hpp"
#include "engine/results/design_table.hpp"
#include "engine/runner/records.hpp"
#include "engine/runner/run_study.hpp"
#include "engine/storage/study_file.hpp"
#include "engine/workspace/prepare_workspace.hpp"
#include "objectives/all.hpp"
#include "tests/unit/storage/first_difference.hpp"

namespace pkm::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::StartsWith;

/// The mechanism 4PPa-2PaR with bounds of the volume that a test chooses, relative to the computed volume.
class Bounded final : public Mechanism, RigorousBounds {
 public:
  const MechanismInfo& info() const override { return inner_->info(); }
  Unsupported refuse(std::span<const double> p) const override { return inner_->refuse(p); }
  PoseReport inspect(std::span<const double> p, const Pose<double>& pose, const std::string& mode,
                     const LimitSpec& limits) const override {
    return inner_->inspect(p, pose, mode, limits);
  }
  std::optional<double> default_value(std::span<const double> p, int coordinate) const override {
    return inner_->default_value(p, coordinate);
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
  const RigorousBounds* bounds() const override { return has_bounds ? this : nullptr; }

  double lower = 0.99, upper = 1.01;  ///< bounds, relative to the volume
  bool has_bounds = true;             ///< otherwise like a mechanism in C++ without them
  bool interrupts = false;            ///< raise SIGINT while bounds are computed
  mutable int calls = 0;              ///< number of bounds computed

 private:
  void require_bounds(const WorkspacePlan& plan) const override {
    if (how_fixed(plan, 1).kind == FixedCoordinate::Kind::integrated)
      throw std::invalid_argument("bounds are of one value of y");
  }
  VolumeBounds volume(std::span<const double> p, const WorkspacePlan& plan, const std::string&,
                      const BoundsOptions& options) const override {
    ++calls;
    const auto evaluator = prepare_workspace(*inner_, plan, {});
    WorkspaceResult<double> survey;
    evaluate_once<double>(*evaluator, p, survey);
    if (interrupts) {  // and take longer than the grace period
      std::raise(SIGINT);
      while (!options.stop()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    const bool stopped = options.stop && options.stop();
    return {.lower = stopped ? 0 : lower * survey.volume, .upper = upper * survey.volume, .stopped = stopped};
  }
  PoseCertificate solid(std::span<const double>, const WorkspacePlan&, const std::string&, const PoseSolid&,
                        const BoundsOptions&) const override {
    return {};
  }
  PoseCertificate motion(std::span<const double>, const LimitSpec&, const std::string&, const Motion&,
                         const BoundsOptions&) const override {
    return {};
  }
  Separation separate(std::span<const double>, const WorkspacePlan&, const std::string&, const Pose<double>&,
                      const Pose<double>&, const BoundsOptions&) const override {
    return {};
  }

  std::shared_ptr<const Mechanism> inner_ = find_named_mechanism();
  static std::shared_ptr<const Mechanism> find_named_mechanism() {
    for (const auto& mechanism : all_mechanisms())
      if (mechanism->info().name == "4ppa-2par") return mechanism;
    throw std::logic_error("no 4ppa-2par");
  }
};

class CertifiedStudy : public ::testing::Test {
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

TEST_F(CertifiedStudy, RecordsBoundsOfTheFinalDesignsOnly) {
  Progress silent;
  const StudyContents made = run_study(study("certified = 0.05"), file(), false, {}, silent).contents;
  EXPECT_EQ(mechanism_->calls, 3) << "best, rounded, baseline";
  const StudyContents stored = read_study(file());
  for (const auto* design : {&stored.final->best, &stored.final->rounded, &stored.final->baseline}) {
    ASSERT_TRUE((*design)->certified);
    EXPECT_EQ((*design)->status, Status::feasible);
    EXPECT_LT((*design)->certified->lower, (*design)->volume);
    EXPECT_GT((*design)->certified->upper, (*design)->volume);
  }
  EXPECT_EQ(stored.final->best->certified->lower, made.final->best->certified->lower);
  EXPECT_EQ(contradicted(stored), std::vector<std::string>());
  EXPECT_TRUE(stored.notes.empty());
  std::vector<std::string> lines;
  for (const DesignTable::Line& line : design_table(stored, {}).lines)
    if (line.kind == "certified") lines.push_back(line.name + ' ' + line.unit);
  EXPECT_THAT(lines, ElementsAre("volume m^2 rad", "volume, at least m^2 rad", "volume, at most m^2 rad"));

  mechanism_->calls = 0;
  run_study(study(""), file(), true, {}, silent);
  EXPECT_EQ(mechanism_->calls, 0);
  EXPECT_FALSE(read_study(file()).final->best->certified);
}

TEST_F(CertifiedStudy, AVolumeOutsideItsBoundsIsAFailure) {
  mechanism_->lower = 1.02;
  mechanism_->upper = 1.03;
  Progress silent;
  const StudyContents found = run_study(study("certified = true"), file(), false, {}, silent).contents;
  for (const auto* design : {&found.final->best, &found.final->rounded, &found.final->baseline}) {
    EXPECT_EQ((*design)->status, Status::failed);
    EXPECT_THAT((*design)->reason, HasSubstr("lies outside its certified bounds"));
    EXPECT_THAT((*design)->reason, HasSubstr("a part of the workspace was missed"));
  }
  EXPECT_THAT(contradicted(read_study(file())),
              ElementsAre(StartsWith("the best design fails: the volume by columns, "),
                          StartsWith("the rounded design"), StartsWith("the baseline")));
  mechanism_->lower = 0.97;
  mechanism_->upper = 0.98;
  const StudyContents again = run_study(study("certified = true"), file(), true, {}, silent).contents;
  EXPECT_THAT(again.final->best->reason, HasSubstr("infeasible poses were included"));
}

TEST_F(CertifiedStudy, NotesAGapLargerThanRequested) {
  Progress silent;
  const StudyContents found = run_study(study("certified = 1e-3"), file(), false, {}, silent).contents;
  ASSERT_EQ(found.notes.size(), 3u);
  EXPECT_THAT(found.notes[1], StartsWith("certified bounds of the best design have the gap 0.0"));
  EXPECT_THAT(found.notes[1], HasSubstr("requested 0.001"));
}

TEST_F(CertifiedStudy, EqualsTheUninterruptedStudyAfterAnInterruptionOfTheBounds) {
  const Study s = study("certified = true");
  Progress silent;
  run_study(s, folder_ + "/reference.h5", false, {}, silent);
  mechanism_->interrupts = true;
  const RunOutcome stopped = run_study(s, file(), false, {}, silent);
  EXPECT_EQ(stopped.stopped, "SIGINT");
  EXPECT_EQ(read_study(file()).state, StudyState::interrupted);
  const StudyContents interrupted = read_study(file());
  ASSERT_TRUE(interrupted.final && interrupted.final->best);  // results are stored before the bounds are computed
  EXPECT_FALSE(interrupted.final->best->certified || interrupted.final->baseline->certified);
  mechanism_->interrupts = false;
  LockedStudy locked(file());
  EXPECT_EQ(resume_study(locked, catalogues(), {}, {}, silent).stopped, "");
  EXPECT_EQ(first_difference(read_study(folder_ + "/reference.h5"), read_study(file())), "");
}

TEST_F(CertifiedStudy, IsRejectedIfThereAreNoBounds) {
  const auto message_of = [&](const std::string& workspace) -> std::string {
    try {
      study(workspace);
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "accepted";
  };
  const std::string expected = "; expected true, false, or the relative gap of the bounds, a number between 0 and 2";
  EXPECT_EQ(message_of("certified = false"), "accepted");
  EXPECT_EQ(message_of("certified = 2"), "s.toml:8: workspace.certified: found 2" + expected);
  EXPECT_EQ(message_of("certified = 0"), "s.toml:8: workspace.certified: found 0" + expected);
  EXPECT_EQ(message_of("certified = \"yes\""), "s.toml:8: workspace.certified: found \"yes\"" + expected);
  EXPECT_EQ(message_of("certified = [0.1]"), "s.toml:8: workspace.certified: found [0.1]" + expected);
  EXPECT_THAT(message_of("method = \"voxels\"\ncertified = true"),
              HasSubstr("workspace.certified: this key requires method = \"columns\", but the study's method is"));
  EXPECT_THAT(message_of("certified = true\ny = \"integrated\""), HasSubstr("workspace: bounds are of one value of y"));
  EXPECT_THAT(message_of("certifed = true"), HasSubstr("certified"));
  mechanism_->has_bounds = false;
  EXPECT_EQ(message_of("certified = true"),
            "s.toml:8: workspace.certified: certified bounds evaluate the formulas of a mechanism file in interval "
            "arithmetic, but mechanism 4ppa-2par is written in C++");
}

}  // namespace
}  // namespace pkm::testing
