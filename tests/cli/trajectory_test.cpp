// `pkmopt trajectory`, `pkmopt simulate`, and studies whose objectives follow a motion.
#include <fstream>
#include <regex>
#include <sstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "tests/cli/run_program.hpp"
#include "tests/cli/study_folder.hpp"

namespace pkm::testing {
namespace {

using nlohmann::json;
using ::testing::HasSubstr;
using ::testing::StartsWith;

const std::string kOscillation =
    "type = \"oscillation\"\nx = 0.2\ny = 0.17\nz = 0.22\nphi = 0\namplitude = 0.01\nperiod = 1\n";
const std::string kLeavesTheReach =
    "type = \"points\"\ntime = 1\npoints = [{ x = 0.2, y = 0.17, z = 0.22, phi = 0 }, { z = 0.6 }]\n";

std::vector<std::string> lines_of_file(const std::string& path) {
  std::ifstream file(path);
  std::vector<std::string> lines;
  for (std::string line; std::getline(file, line);) lines.push_back(line);
  return lines;
}

TEST(CliTrajectory, RedundantDrivesHaveForcesOfLeastNorm) {
  const std::string data = PKM_TEST_DATA "/redundant/", rrr = data + "4-rrr.toml", motion = data + "4-rrr-motion.toml";
  const auto found = pkmopt({"trajectory", rrr, "--motion", motion, "--wrench", "Fx=1"});
  EXPECT_EQ(found.exit_code, 0) << found.err;
  EXPECT_THAT(found.out, HasSubstr("peak speed [rad/s]"));
  EXPECT_THAT(found.out, HasSubstr("peak torque [N m]"));
  const json all = pkmopt({"trajectory", rrr, "--motion", motion, "--json"}).json();
  const json& samples = all["samples"];
  for (std::size_t k = 1; k + 1 < samples.size(); ++k)  // compare the speeds with differences of the joint positions
    for (const auto& [name, speed] : samples[k]["speeds"].items()) {
      const double step = double(samples[k + 1]["time"]) - double(samples[k - 1]["time"]);
      const double difference = double(samples[k + 1]["joints"][name]) - double(samples[k - 1]["joints"][name]);
      EXPECT_NEAR(speed, difference / step, 2e-4);
    }
  // virtual work, J^T tau = M_X Xddot, and no component along the internal forces
  const json pose =
      pkmopt({"dynamics", rrr, "--at", "x=0.03,y=0.02,phi=0.1", "--acceleration", "x=5,y=-2,phi=10", "--json"}).json();
  const std::vector<double> acceleration = {5, -2, 10};
  const std::vector<std::string> joints = {"arm1", "arm2", "arm3", "arm4"};
  for (std::size_t j = 0; j < 3; ++j) {
    double work = 0, inertia = 0;
    for (std::size_t i = 0; i < 4; ++i) work += double(pose["J"][i][j]) * double(pose["tau"][i]);
    for (std::size_t i = 0; i < 3; ++i) inertia += double(pose["MX"][j][i]) * acceleration[i];
    EXPECT_NEAR(work, inertia, 1e-12 * std::fabs(inertia));
  }
  double internal = 0, norm = 0;
  for (std::size_t i = 0; i < 4; ++i) {
    internal += double(pose["internal_forces"][i][0]) * double(pose["tau"][i]);
    norm += double(pose["tau"][i]) * double(pose["tau"][i]);
  }
  EXPECT_GT(norm, 0);
  EXPECT_NEAR(internal, 0, 1e-12);
  EXPECT_TRUE(pose["Mq"].is_null());
  EXPECT_TRUE(pose["dci"].is_null());
  for (const std::vector<std::string>& option : {std::vector<std::string>{"--reactions"}, {"--joint", "arm1.A"}}) {
    std::vector<std::string> command = {"trajectory", rrr, "--motion", motion};
    command.insert(command.end(), option.begin(), option.end());
    const auto refused = pkmopt(command);
    EXPECT_EQ(refused.exit_code, 2) << option[0];
    EXPECT_THAT(refused.err, HasSubstr(option[0])) << refused.err;
    EXPECT_THAT(refused.err, HasSubstr("4 joints for 3 coordinates")) << refused.err;
  }
}

TEST(CliTrajectory, CablesHaveTensionsWithinTheirLimits) {
  const StudyFolder folder;
  const std::string ipanema = PKM_EXPERIMENTS "/mechanisms/cables/ipanema.toml";
  folder.write("slow.toml",
               "type = \"points\"\ntime = 2\npoints = [{ x = -0.3, y = 0, z = 1, alpha = 0, beta = 0, gamma = 0 }, "
               "{ x = 0.3 }]\n");
  const auto found =
      pkmopt({"trajectory", ipanema, "--motion", "slow.toml", "--samples", "41", "--json"}, folder.path());
  EXPECT_EQ(found.exit_code, 0) << found.err;
  for (const json& sample : found.json()["samples"])
    for (const auto& [name, force] : sample["forces"].items()) {
      EXPECT_LE(double(force), 0) << name;
      EXPECT_GE(double(force), -720) << name;
    }
  // in 0.05 s the inertia forces are too large
  folder.write("fast.toml",
               "type = \"points\"\ntime = 0.05\npoints = [{ x = -0.3, y = 0, z = 1, alpha = 0, beta = 0, gamma = 0 }, "
               "{ x = 0.3 }]\n");
  const auto fast = pkmopt({"trajectory", ipanema, "--motion", "fast.toml", "--samples", "41"}, folder.path());
  EXPECT_EQ(fast.exit_code, 1);
  EXPECT_THAT(fast.err, HasSubstr("no tensions within their limits balance the load"));
  const auto pose = pkmopt({"dynamics", ipanema, "--at", "x=0,y=0,z=1,alpha=0,beta=0,gamma=0"});
  EXPECT_EQ(pose.exit_code, 0) << pose.err;
  EXPECT_THAT(pose.out, HasSubstr("tensions of the cables"));
  EXPECT_THAT(pose.out, HasSubstr("internal forces"));
}

TEST(CliTrajectory, RedundantDrivesFitJointErrorsByLeastSquares) {
  const std::string rrr = PKM_TEST_DATA "/redundant/4-rrr.toml";
  const json pose =
      pkmopt({"pose", rrr, "--at", "x=0.03,y=0.02,phi=0.1", "--joint-error", "0.0001", "--exact-error", "--json"})
          .json();
  const json& error = pose["tool_error"];
  EXPECT_GT(double(error["translation"]), 0);
  EXPECT_NEAR(double(error["worst_corner"]["translation"]), double(error["translation"]),
              1e-2 * double(error["translation"]));
}

TEST(CliTrajectory, RedundantDrivesFollowNoMotionThroughSingularPoses) {
  const StudyFolder folder;
  const std::string cables = PKM_TEST_DATA "/redundant/four-cables.toml";
  folder.write("m.toml", "type = \"formulas\"\nduration = 1\nx = \"0.1*t\"\ny = 0\nphi = \"0.1*(t - 0.5)\"\n");
  const auto found = pkmopt({"trajectory", cables, "--motion", "m.toml", "--samples", "11", "--json"}, folder.path());
  EXPECT_EQ(found.exit_code, 1);
  EXPECT_THAT(found.err, HasSubstr("the Jacobian is singular to working precision"));
  for (const json& sample : found.json()["samples"]) EXPECT_EQ(sample["feasible"], double(sample["time"]) != 0.5);
}

TEST(CliTrajectory, FastestMotionOfAStudyKeepsTheLimitsOfItsMotors) {
  const std::string study = PKM_EXPERIMENTS "/mechanisms/motors/fastest-delta.toml";
  for (const std::string law : {"optimal", "own"}) {
    const auto result = pkmopt({"trajectory", study, "--motion", "cycle", "--fastest", "--law", law, "--json"});
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const json found = result.json();
    EXPECT_EQ(found["fastest"]["moves"].size(), 6u);
    EXPECT_EQ(found["fastest"]["bounded_by"][0]["limit"], "continuous torque");
    const double error = found["fastest"]["discretisation_error"];
    EXPECT_GE(error, 0);
    EXPECT_LT(error, 2e-3);
    for (const auto& [joint, torque] : found["summary"]["peak_motor_torque"].items()) EXPECT_LE(torque, 1.91 + 1e-9);
    double rms = 0;
    for (const auto& [joint, torque] : found["summary"]["rms_motor_torque"].items())
      rms = std::max(rms, torque.get<double>());
    EXPECT_LE(rms, 0.64 * (1 + 1e-9));
    EXPECT_GE(rms, 0.64 * 0.97);
    EXPECT_EQ(found["duration"], found["samples"].back()["time"]);
  }
}

TEST(CliTrajectory, FastestMotionAcceptsLimitsOfTheCommandLine) {
  const std::string delta = PKM_EXPERIMENTS "/mechanisms/rotary-delta.toml";
  const StudyFolder folder;
  folder.write("m.toml", "type = \"points\"\ntime = 1\npoints = [{ x = -0.1, y = 0, z = -0.5 }, { x = 0.1 }]\n");
  const auto fastest = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"trajectory", delta, "--motion", "m.toml", "--fastest", "--json"});
    return pkmopt(more, folder.path());
  };
  EXPECT_NEAR(fastest({"--tool-acceleration", "20"}).json()["duration"], 2 * std::sqrt(0.2 / 20), 1e-9);
  EXPECT_NEAR(fastest({"--tool-acceleration", "20", "--tool-speed", "0.5"}).json()["duration"], 0.2 / 0.5 + 0.5 / 20,
              1e-4);
  const json both = fastest({"--peak-speed", "all=2", "--peak-acceleration", "all=50,arm2=20"}).json();
  for (const auto& [joint, speed] : both["summary"]["peak_speed"].items()) EXPECT_LE(speed, 2 + 1e-9) << joint;
  double peak = 0;
  for (const json& sample : both["samples"])
    peak = std::max(peak, std::fabs(sample["accelerations"]["arm2"].get<double>()));
  EXPECT_NEAR(peak, 20, 0.1);
  const json forces = fastest({"--peak-force", "all=3"}).json();
  for (const auto& [joint, force] : forces["summary"]["peak_force"].items()) EXPECT_LE(force, 3 + 1e-9) << joint;

  const auto complaint = [&](const std::vector<std::string>& more) { return fastest(more).err; };
  EXPECT_THAT(complaint({}), HasSubstr("no limit of acceleration, force or torque bounds the motion"));
  EXPECT_THAT(complaint({"--peak-speed", "arm7=2"}), HasSubstr("arm7"));
  EXPECT_THAT(complaint({"--tool-speed", "-1"}), HasSubstr("a number > 0 m/s"));
  EXPECT_THAT(complaint({"--tool-acceleration", "5", "--nodes", "7"}), HasSubstr("an even number"));
  EXPECT_THAT(complaint({"--motor", "200 W"}), HasSubstr("--motors"));
  const std::string motors = PKM_EXPERIMENTS "/mechanisms/motors/";
  const auto mounted = pkmopt({"trajectory", motors + "rotary-delta.toml", "--motion", "m.toml", "--fastest", "--json",
                               "--motors", motors + "motors.toml", "--motor", "100 W"},
                              folder.path());
  ASSERT_EQ(mounted.exit_code, 0) << mounted.err;
  double rms = 0;  // the continuous torque is 0.32 N m
  const json with_motor = mounted.json();
  for (const auto& [joint, torque] : with_motor["summary"]["rms_motor_torque"].items())
    rms = std::max(rms, torque.get<double>());
  EXPECT_LE(rms, 0.32 * (1 + 1e-9));
  EXPECT_GE(rms, 0.32 * 0.99);
  const json by_nodes = fastest({"--peak-acceleration", "all=50", "--nodes", "40"}).json(),
             by_more_nodes = fastest({"--peak-acceleration", "all=50", "--nodes", "4000"}).json();
  const double change = by_nodes["duration"].get<double>() - by_more_nodes["duration"].get<double>();
  EXPECT_LT(std::fabs(change), 4 * by_nodes["fastest"]["discretisation_error"].get<double>());
  EXPECT_LT(by_more_nodes["fastest"]["discretisation_error"], by_nodes["fastest"]["discretisation_error"]);
  const auto slow = pkmopt({"trajectory", delta, "--motion", "m.toml", "--tool-speed", "1"}, folder.path());
  EXPECT_THAT(slow.err, HasSubstr("--tool-speed: this option needs --fastest"));
}

TEST(CliTrajectory, TheSharesOfTheLimitsOfAFastestMotionAddUp) {
  const StudyFolder folder;
  folder.write("m.toml",
               "type = \"pick-and-place\"\nx = -0.15\ny = 0\nz = -0.5\nlift = 0.05\nreach = 0.3\n"
               "lift_time = 0.2\nreach_time = 0.4\n");
  const auto table = [&](const std::vector<std::string>& more) {
    std::vector<std::string> command = {"trajectory", PKM_EXPERIMENTS "/mechanisms/rotary-delta.toml", "--motion",
                                        "m.toml", "--fastest"};
    command.insert(command.end(), more.begin(), more.end());
    const std::string text = pkmopt(command, folder.path()).out;
    const auto begin = text.find("limits that bound the motion");
    return text.substr(begin, text.find("\n\n", begin) - begin);
  };
  const std::string optimal = table({"--peak-acceleration", "all=300", "--tool-speed", "2m/s"});
  double sum = 0;
  const std::regex share("([0-9.e+-]+) %");
  for (std::sregex_iterator at(optimal.begin(), optimal.end(), share); at != std::sregex_iterator(); ++at)
    sum += std::stod((*at)[1]);
  EXPECT_NEAR(sum, 100, 0.02) << optimal;
  EXPECT_THAT(optimal, HasSubstr("  tool speed"));
  const std::string own = table({"--peak-acceleration", "all=300", "--law", "own"});
  EXPECT_THAT(own, ::testing::StartsWith("limits that bound the motion, each at one instant of a move\n"));
  EXPECT_EQ(own.find('%'), std::string::npos) << own;
}

TEST(CliTrajectory, ReadsTheTableThatItWrites) {
  const StudyFolder folder;
  const std::string delta = PKM_EXPERIMENTS "/mechanisms/rotary-delta.toml";
  folder.write("m.toml",
               "type = \"pick-and-place\"\nx = -0.15\ny = 0\nz = -0.5\nlift = 0.05\nreach = 0.3\n"
               "lift_time = 0.2\nreach_time = 0.4\noverlap = 0.1\n");
  const json given =
      pkmopt({"trajectory", delta, "--motion", "m.toml", "--samples", "401", "--csv", "m.csv", "--json"}, folder.path())
          .json();
  const auto again = pkmopt({"trajectory", delta, "--motion", "m.csv", "--samples", "41", "--json"}, folder.path());
  ASSERT_EQ(again.exit_code, 0) << again.err;
  const json read = again.json();
  for (std::size_t k = 0; k <= 40; ++k)
    for (const std::string axis : {"x", "y", "z"}) {
      const json &expected = given["samples"][10 * k], &found = read["samples"][k];
      EXPECT_NEAR(found["pose"][axis], expected["pose"][axis], 1e-12);
      EXPECT_NEAR(found["velocity"][axis], expected["velocity"][axis], 1e-5);
      EXPECT_NEAR(found["acceleration"][axis], expected["acceleration"][axis], 0.05);
    }
  const auto complaint = [&](const std::string& rows) {
    folder.write("bad.csv", rows);
    return pkmopt({"trajectory", delta, "--motion", "bad.csv"}, folder.path()).err;
  };
  EXPECT_THAT(complaint("time,x,y\n0,0,0\n"), HasSubstr("no column z"));
  EXPECT_THAT(complaint("time,x,y,z\n0,0,0,-0.5\n"), HasSubstr("found 1 rows; expected at least 4"));
  EXPECT_THAT(complaint("time,x,y,z\n1,0,0,-0.5\n2,0,0,-0.5\n3,0,0,-0.5\n4,0,0,-0.5\n"),
              HasSubstr("bad.csv:2: time: found 1 s; expected 0 s in the first row"));
  EXPECT_THAT(complaint("time,x,y,z\n0,0,0,-0.5\n2,0,0,-0.5\n2,0,0,-0.5\n4,0,0,-0.5\n"),
              HasSubstr("bad.csv:4: time: found 2 s; expected more than that of the previous row, 2 s"));
}

TEST(CliTrajectory, OscillationAgreesWithGoldenData) {
  const StudyFolder folder;
  folder.write("m.toml", kOscillation);
  const json golden = json::parse(std::ifstream(PKM_TEST_DATA "/3crr-r-cru-and-quadrupteron.json"))["eq35"];
  for (const json& entry : golden) {
    const auto result =
        pkmopt({"trajectory", entry["mechanism"], "--motion", "m.toml", "--samples", "201", "--json"}, folder.path());
    ASSERT_EQ(result.exit_code, 0) << result.err;
    const json found = result.json();
    EXPECT_EQ(found["samples"].size(), 201u);
    EXPECT_TRUE(found["periodic"]);
    EXPECT_EQ(found["summary"]["infeasible"], 0);
    EXPECT_NEAR(found["summary"]["energy"].get<double>(), 0, 1e-12);
    for (const int joint : {0, 1, 2, 3}) {
      const double min = entry["tau_min"][joint], max = entry["tau_max"][joint];
      EXPECT_NEAR(found["summary"]["peak_force"]["rho" + std::to_string(joint + 1)].get<double>(), std::max(-min, max),
                  1e-9);
    }
  }
}

TEST(CliTrajectory, TablesHaveAColumnForEachQuantity) {
  const StudyFolder folder;
  folder.write("m.toml", kOscillation);
  const auto result = pkmopt({"trajectory", "3crr-r-cru", "--motion", "m.toml", "--samples", "11", "--csv", "f.csv",
                              "--wrench", "Fz=-10N", "Mz=0.1"},
                             folder.path());
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_THAT(result.out, HasSubstr("peak force [N]"));
  EXPECT_THAT(result.out, HasSubstr("energy per cycle"));
  const auto lines = lines_of_file(folder.path() + "/f.csv");
  ASSERT_EQ(lines.size(), 12u);
  EXPECT_EQ(lines[0],
            "time,x,y,z,phi,x_speed,y_speed,z_speed,phi_speed,x_acceleration,y_acceleration,z_acceleration,"
            "phi_acceleration,rho1,rho2,rho3,rho4,rho1_speed,rho2_speed,rho3_speed,rho4_speed,rho1_acceleration,"
            "rho2_acceleration,rho3_acceleration,rho4_acceleration,conditioning,feasible,reason,rho1_force,rho2_force,"
            "rho3_force,rho4_force,rho1_power,rho2_power,rho3_power,rho4_power,power,"
            "velocity_transmission,force_transmission,angular_velocity_transmission,moment_transmission,effective_mass,"
            "effective_mass_ratio,det_J,kappa_p,sin_theta_12,"
            "theta_11,theta_12,sin_theta_22,theta_21,theta_22,sin_theta_32,theta_31,theta_32,sin_theta_42,theta_41,"
            "theta_42");
  EXPECT_THAT(lines[1], StartsWith("0,0.2,0.18000000000000002,0.22,0,0.0628"));
  for (const auto& line : lines) EXPECT_EQ(std::count(line.begin(), line.end(), ','), 56);
}

TEST(CliTrajectory, TablesOverwriteNoExistingFileAndNoInput) {
  const StudyFolder folder;
  folder.write("m.toml", kOscillation);
  folder.write("f.csv", "mine");
  folder.write("study.toml", study_with(""));
  const auto refusal = [&](std::vector<std::string> command, const std::string& csv) {
    command.insert(command.end(), {"--csv", csv});
    return pkmopt(command, folder.path()).err;
  };
  const std::string exists = "pkmopt: f.csv exists already; overwrite it with --force\n";
  const std::vector<std::string> trajectory = {"trajectory", "3crr-r-cru", "--motion", "m.toml", "--samples", "3"};
  EXPECT_EQ(refusal(trajectory, "f.csv"), exists);
  EXPECT_EQ(refusal(trajectory, "m.toml"), "pkmopt: m.toml: is read by this command, so it is not overwritten\n");
  EXPECT_EQ(refusal({"coupling", "study.toml", "--force"}, "study.toml"),
            "pkmopt: study.toml: is read by this command, so it is not overwritten\n");
  EXPECT_EQ(refusal({"coupling", "3crr-r-cru"}, "f.csv"), exists);
  EXPECT_EQ(
      refusal({"simulate", "3crr-r-cru", "--at", "x=0.2,y=0.17,z=0.22,phi=0.3", "--duration", "1ms", "--step", "1ms"},
              "f.csv"),
      exists);
  EXPECT_EQ(lines_of_file(folder.path() + "/f.csv"), std::vector<std::string>{"mine"});
  std::vector<std::string> forced = trajectory;
  forced.insert(forced.end(), {"--csv", "f.csv", "--force"});
  EXPECT_EQ(pkmopt(forced, folder.path()).exit_code, 0);
  EXPECT_EQ(lines_of_file(folder.path() + "/f.csv").size(), 4u);
}

TEST(CliTrajectory, InfeasibleSamplesAreMarkedAndGiveExitCode1) {
  const StudyFolder folder;
  folder.write("m.toml", kLeavesTheReach);
  std::vector<std::string> command = {"trajectory", "3crr-r-cru", "--motion", "m.toml", "--samples", "11", "--json"};
  const auto refused = pkmopt(command, folder.path());
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_THAT(refused.err, HasSubstr("of 11 samples are infeasible, the first at t = 0."));
  command.push_back("--allow-infeasible");
  const auto accepted = pkmopt(command, folder.path());
  ASSERT_EQ(accepted.exit_code, 0) << accepted.err;
  EXPECT_EQ(accepted.out, refused.out);
  const json last = accepted.json()["samples"].back();
  EXPECT_FALSE(last["feasible"]);
  EXPECT_THAT(last["reason"].get<std::string>(), HasSubstr("limb1 cannot reach the pose"));
  EXPECT_TRUE(last["forces"].is_null());
  EXPECT_TRUE(last["quantities"]["theta_11"].is_null());
  EXPECT_TRUE(last["quantities"]["theta_31"].is_number()) << "limb 3 reaches";
  EXPECT_TRUE(accepted.json()["summary"]["peak_force"].is_null());
}

TEST(CliTrajectory, SingularSamplesHaveNoForces) {
  const StudyFolder folder;
  folder.write("m.toml",
               "type = \"points\"\ntime = 1\npoints = [{ x = 0.35, y = 0.8, z = -0.8, theta = 0 }, "
               "{ theta = \"90 deg\" }]\n");
  const auto printed =
      pkmopt({"trajectory", "4ppa-2par", "--motion", "m.toml", "--samples", "11", "--csv", "f.csv"}, folder.path());
  EXPECT_EQ(printed.exit_code, 1);
  EXPECT_THAT(printed.err,
              HasSubstr("1 of 11 samples are infeasible, the first at t = 1 s (sample 11): the Jacobian is "
                        "singular to working precision"));
  EXPECT_THAT(printed.out, HasSubstr("peak force [N]    -"));
  EXPECT_THAT(printed.out, HasSubstr("are unknown: forces are undefined at t = 1 s (sample 11)"));
  EXPECT_THAT(lines_of_file(folder.path() + "/f.csv").back(),
              ::testing::AllOf(HasSubstr(",0,the Jacobian is singular to working precision,,,,,,,,,,"),
                               HasSubstr(",4,")));  // the quantities exist
  const auto pose =
      pkmopt({"dynamics", "4ppa-2par", "--at", "x=0.35,y=0.8,z=-0.8,theta=90deg", "--json"}, folder.path());
  EXPECT_EQ(pose.exit_code, 1);
  EXPECT_THAT(pose.err, HasSubstr("the Jacobian of the pose is singular to working precision"));
  for (const char* key : {"tau", "power", "Mq", "dci", "gravity", "coriolis"}) EXPECT_TRUE(pose.json()[key].is_null());
  EXPECT_TRUE(pose.json()["J"].is_array());
}

TEST(CliTrajectory, LimitsOfTheStudyApply) {
  const StudyFolder folder;
  folder.write("s.toml",
               "[mechanism]\ntype = \"3crr-r-cru\"\n[workspace]\nlimits = { s_min = 0.99 }\n[variables]\n"
               "r = { min = 0.03, max = 0.05 }\n[[motion]]\nname = \"swing\"\n" +
                   kOscillation + "[[objective]]\ntype = \"workspace-volume\"\n[[stage]]\noptimiser = \"ga\"\n");
  const auto result = pkmopt({"trajectory", "s.toml", "--motion", "swing"}, folder.path());
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_THAT(result.err, HasSubstr(": s_min is violated"));
}

TEST(CliTrajectory, JointSpeedsAndAccelerationsEqualDifferences) {
  const StudyFolder folder;
  folder.write("m.toml",
               "type = \"points\"\nacceleration = 2\nangular_acceleration = 5\npoints = [\n"
               "{ x = 0.35, y = 0.8, z = -0.8, theta = 0 }, { x = 0.25, y = 0.85, theta = \"30 deg\" }]\n");
  const auto result =
      pkmopt({"trajectory", "4ppa-2par", "--motion", "m.toml", "--samples", "401", "--json"}, folder.path());
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json samples = result.json()["samples"];
  for (std::size_t k = 40; k + 1 < samples.size(); k += 40)
    for (const char* joint : {"q1", "q2", "q3", "q4"}) {
      const double h = samples[k + 1]["time"].get<double>() - samples[k - 1]["time"].get<double>();
      const auto difference = [&](const char* of) {
        return (samples[k + 1][of][joint].get<double>() - samples[k - 1][of][joint].get<double>()) / h;
      };
      EXPECT_NEAR(samples[k]["speeds"][joint].get<double>(), difference("joints"), 1e-4);
      EXPECT_NEAR(samples[k]["accelerations"][joint].get<double>(), difference("speeds"), 1e-3);
    }
}

TEST(CliTrajectory, InvalidInputIsRefused) {
  const StudyFolder folder;
  folder.write("m.toml", kOscillation + "perod = 1\n");
  folder.write("ok.toml", kOscillation);
  const std::vector<std::pair<std::vector<std::string>, std::string>> refusals = {
      {{"3crr-r-cru", "--motion", "m.toml"},
       "m.toml:8: perod: found an unknown key; expected one of type, x, y, z, phi, amplitude, period, cycles; did you "
       "mean 'period'?"},
      {{"4ppa-2par", "--motion", "ok.toml"},
       "ok.toml:5: phi: found an unknown key; expected one of type, x, y, z, theta, amplitude, period, cycles"},
      {{"3crr-r-cru", "--motion", "none.toml"},
       "none.toml: found no readable file (No such file or directory); expected a motion in TOML"},
      {{PKM_EXPERIMENTS "/mechanisms/motors/rotary-delta.toml", "--motion", "cycl"},
       "--motion: found 'cycl', which is neither a [[motion]] of the study nor a file; expected one of cycle, or a "
       "motion in TOML; did you mean 'cycle'?"},
      {{"3crr-r-cru", "--motion", "ok.toml", "--wrench", "Fw=1"},
       "--wrench: found the unknown name 'Fw'; expected one of Fx, Fy, Fz, Mx, My, Mz; did you mean 'Fx'?"},
      {{"3crr-r-cru", "--motion", "ok.toml", "--mode", "-,-,-"}, "--mode: found the unknown mode '-,-,-'"},
  };
  for (const auto& [arguments, sentence] : refusals) {
    std::vector<std::string> command = {"trajectory"};
    command.insert(command.end(), arguments.begin(), arguments.end());
    const auto result = pkmopt(command, folder.path());
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_THAT(result.err, StartsWith("pkmopt: " + sentence));
    EXPECT_EQ(result.out, "");
  }
}

TEST(CliSimulate, EnergyIsBalanced) {
  const StudyFolder folder;
  const auto result = pkmopt(
      {"simulate", "3crr-r-cru", "--at", "x=0.2,y=0.17,z=0.22,phi=0.3", "--velocity", "z=0.1,phi=1", "--forces",
       "rho1=0.5,rho3=8", "--wrench", "Fx=0.1", "--duration", "0.1 s", "--step", "1 ms", "--csv", "s.csv", "--json"},
      folder.path());
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json run = result.json();
  ASSERT_EQ(run["states"].size(), 101u);
  const json &first = run["states"].front(), &last = run["states"].back();
  const double work = last["work_of_drives"].get<double>() + last["work_of_weight"].get<double>() +
                      last["work_of_wrench"].get<double>();
  EXPECT_NEAR(last["kinetic_energy"].get<double>() - first["kinetic_energy"].get<double>(), work, 1e-10);
  EXPECT_GT(std::fabs(work), 1e-3);
  EXPECT_EQ(lines_of_file(folder.path() + "/s.csv").size(), 102u);
}

TEST(CliSimulate, EarlyEndIsExplained) {
  const auto falls =
      pkmopt({"simulate", "3crr-r-cru", "--at", "x=0.2,y=0.17,z=0.22,phi=0", "--duration", "2", "--step", "1ms"});
  EXPECT_EQ(falls.exit_code, 1);
  EXPECT_THAT(falls.out, HasSubstr("maximum imbalance"));
  EXPECT_THAT(falls.err, StartsWith("pkmopt: the simulation ended early: at t = 0."));
}

const std::string kMotionStudy =
    "[mechanism]\ntype = \"3crr-r-cru\"\n[variables]\nl_11 = { min = 0.15, max = 0.2 }\nm = { min = 0.05, max = 0.1 }\n"
    "[workspace]\nnodes = { x = 4, y = 4 }\n[[motion]]\nname = \"swing\"\n" +
    kOscillation;

TEST(CliMotionStudy, ObjectivesAndConstraintsAlongAMotion) {
  const StudyFolder folder;
  folder.write("s.toml", kMotionStudy +
                             "[[objective]]\ntype = \"peak-force\"\nmotion = \"swing\"\njoint = \"3\"\n"
                             "[[constraint]]\ntype = \"peak-power\"\nmotion = \"swing\"\nmax = \"1 W\"\n"
                             "wrench = { Fz = \"-2 N\" }\n"
                             "[[stage]]\noptimiser = \"nlopt\"\nalgorithm = \"slsqp\"\nevaluations = 30\n");
  const auto check = pkmopt({"check", "s.toml"}, folder.path());
  ASSERT_EQ(check.exit_code, 0) << check.err;
  EXPECT_THAT(check.out, HasSubstr("peak-force: minimise, in N"));
  const auto run = pkmopt({"run", "s.toml", "--quiet"}, folder.path());
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const auto shown = pkmopt({"evaluate", "s.toml", "--set", "m=0.05", "--json"}, folder.path());
  ASSERT_EQ(shown.exit_code, 0) << shown.err;
  const double lightest = shown.json()["objectives"]["peak-force"];
  EXPECT_GT(lightest, 7);
  EXPECT_LT(lightest, 8.23) << "as heavy as nominal";
}

TEST(CliMotionStudy, InvalidMotionsAreRefused) {
  const StudyFolder folder;
  const std::string stage = "[[stage]]\noptimiser = \"ga\"\n";
  const auto refusal = [&](const std::string& text) {
    folder.write("s.toml", text + stage);
    const auto result = pkmopt({"check", "s.toml"}, folder.path());
    EXPECT_EQ(result.exit_code, 2) << text;
    return result.err;
  };
  EXPECT_EQ(refusal(kMotionStudy + "[[objective]]\ntype = \"peak-force\"\nmotion = \"swim\"\n"),
            "pkmopt: s.toml:17: objective[1]: the study has no motion called 'swim'; it has swing; did you mean "
            "'swing'?\n");
  EXPECT_EQ(refusal(kMotionStudy + "[[objective]]\ntype = \"peak-force\"\nmotion = \"swing\"\njoint = \"5\"\n"),
            "pkmopt: s.toml:17: objective[1]: mechanism 3crr-r-cru has 4 joints; found joint 5\n");
  EXPECT_EQ(refusal(kMotionStudy + "[[objective]]\ntype = \"peak-force\"\nmotion = \"swing\"\nwrench = { Fq = 1 }\n"),
            "pkmopt: s.toml:20: objective[1].wrench.Fq: found an unknown name; expected one of Fx, Fy, Fz, Mx, My, Mz; "
            "did you mean 'Fx'?\n");
  EXPECT_EQ(refusal(kMotionStudy + "[[objective]]\ntype = \"peak-force\"\nmotion = \"swing\"\nmode = \"-,-,+,*\"\n"),
            "pkmopt: s.toml:17: objective[1]: mechanism 3crr-r-cru has no working mode '-,-,+,*'; did you mean "
            "'-,-,+,-'?\n");
}

TEST(CliMotionStudy, AnInfeasibleMotionIsExplained) {
  const StudyFolder folder;
  folder.write("s.toml", kMotionStudy +
                             "[[objective]]\ntype = \"peak-force\"\nmotion = \"swing\"\n[[stage]]\noptimiser = "
                             "\"ga\"\n");
  const auto result = pkmopt({"evaluate", "s.toml", "--set", "l_11=0.01"}, folder.path());
  EXPECT_EQ(result.exit_code, 0) << "infeasible, as by any constraint";
  EXPECT_THAT(result.out, HasSubstr("no: motion-swing violated; peak-force: the motion swing leaves the reach of the "
                                    "mechanism at t = 0 s (limb1 cannot reach the pose)"));
}

TEST(CliTrajectory, ChecksMotors) {
  const std::string folder = PKM_EXPERIMENTS "/mechanisms/motors/";
  const auto run = [&](const std::string& motors) {
    return pkmopt({"trajectory", folder + "rotary-delta.toml", "--motion", "cycle", "--motors", motors, "--json"});
  };
  const auto result = run(folder + "motors.toml");
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const json found = result.json();
  ASSERT_EQ(found["motors"].size(), 4u);
  EXPECT_FALSE(found["motors"][0]["does_it"]);
  for (const json& motor : found["motors"]) {
    double min = 1e9;
    for (const json& joint : motor["joints"]) min = std::min(min, joint["reserve"].get<double>());
    EXPECT_EQ(motor["reserve"], min);
    EXPECT_EQ(motor["does_it"], min >= 1);
    EXPECT_EQ(motor["follows_the_motion"], true);
  }
  for (std::size_t k = 1; k < 4; ++k) {
    EXPECT_GT(found["motors"][k]["reserve"], found["motors"][k - 1]["reserve"]);
    EXPECT_LT(found["motors"][k]["dci"], found["motors"][k - 1]["dci"]) << "rotors add to the diagonal alone";
  }
  EXPECT_GT(found["summary"]["peak_motor_torque"]["arm1"], found["summary"]["rms_motor_torque"]["arm1"]);
  EXPECT_NEAR(found["summary"]["peak_motor_speed"]["arm1"].get<double>(),
              10 * found["summary"]["peak_speed"]["arm1"].get<double>(), 1e-9);

  const StudyFolder own;
  own.write("m.toml", "[[motor]]\nname = \"M\"\ncontinuous_torque = 1\npeak_torque = 0\n");
  EXPECT_THAT(run(own.path() + "/m.toml").err,
              HasSubstr("m.toml:4: motor[1].peak_torque: found 0; expected a number > 0 N m"));
  own.write(
      "m.toml",
      "[[motor]]\nname = \"M\"\npeak_torque = \"900 N mm\"\ncontinuous_torque = 1\nspeed = 100\nrotor_inertia = 0\n");
  EXPECT_THAT(
      run(own.path() + "/m.toml").err,
      HasSubstr("m.toml:3: motor[1].peak_torque: found \"900 N mm\"; expected at least continuous_torque = 1 N m"));
  own.write("m.toml", kOscillation);
  const auto bare = pkmopt({"trajectory", "3crr-r-cru", "--motion", "m.toml", "--motors", "m.toml"}, own.path());
  EXPECT_EQ(bare.exit_code, 2);
  EXPECT_EQ(bare.err, "pkmopt: --motors: found no drive trains; expected a study with [[drive_train]]\n");
}

}  // namespace
}  // namespace pkm::testing
