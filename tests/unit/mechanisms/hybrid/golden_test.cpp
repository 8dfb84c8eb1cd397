// Hybrid robot: every golden case of a pose, and the paper's motion.
#include "tests/unit/mechanisms/hybrid/golden.hpp"

#include <cmath>
#include <map>

#include <gtest/gtest.h>

#include "engine/mechanism/trajectory.hpp"
#include "engine/motion/motions.hpp"

namespace pkm::testing::hybrid {
namespace {

using Json = nlohmann::json;

constexpr double kDoubleRoot = 1e-6;  // its square is rounding

/// Relative to 1 or, where that is more, to the value.
void expect_near(double found, const Json& expected, const std::string& what, double tolerance = kNear) {
  const double value = expected.get<double>();
  EXPECT_NEAR(found, value, tolerance * (1 + std::fabs(value))) << what;
}

template <class List>
void expect_all_near(const List& found, const Json& expected, const std::string& what, double tolerance = kNear) {
  for (std::size_t i = 0; i < expected.size(); ++i) expect_near(found[i], expected[i], what, tolerance);
}

void expect_matrix_near(const AxisMatrix<double>& found, const Json& expected, const std::string& what,
                        double tolerance = kNear) {
  ASSERT_EQ(found.rows(), expected.size()) << what;
  for (std::size_t i = 0; i < found.rows(); ++i)
    for (std::size_t j = 0; j < found.cols(); ++j) expect_near(found(i, j), expected[i][j], what, tolerance);
}

std::map<std::string, double> as_map(const NamedValues& values) { return {values.begin(), values.end()}; }

PoseReport inspect(const Json& entry, const Json& wm, int branch = 1) {
  const LimitSpec none = no_limits(mechanism().info());
  return mechanism().inspect(design_of(entry), pose_of(entry["X"]), mode_name(mode_of(wm), branch), none);
}

TEST(HybridGolden, NominalDesignIsTheDefault) { EXPECT_EQ(nominal(), design_from(golden()["designs"][0])); }

TEST(HybridGolden, InverseInEveryMode) {
  ASSERT_GE(golden()["ik"].size(), 30u);
  for (const Json& entry : golden()["ik"]) {
    SCOPED_TRACE(entry.dump());
    ASSERT_EQ(entry["modes"].size(), 8u);
    for (const Json& mode : entry["modes"]) {
      const Joints<double> j = inverse(geometry_of(design_of(entry)), pose_of(entry["X"]), mode_of(mode["wm"]));
      EXPECT_EQ(j.unreached, entry["unreach"].get<unsigned>());
      EXPECT_EQ(j.serial, entry["serial"].get<unsigned>());
      const PoseReport report = inspect(entry, mode["wm"]);
      EXPECT_EQ(report.assembles, entry["unreach"] == 0);
      ASSERT_TRUE(report.joints);
      const std::array<double, 3> n = {j.n1, j.n2, j.n3};
      for (std::size_t i = 0; i < 4; ++i)
        if (!mode["q"][i].is_null()) expect_near((*report.joints)[i], mode["q"][i], "q");
      for (std::size_t limb = 0; limb < 3; ++limb)
        if (!mode["n"][limb].is_null())
          expect_near(n[limb], mode["n"][limb], "n");
        else
          EXPECT_TRUE(std::isnan((*report.joints)[limb == 0 ? 0 : limb + 1]));
    }
  }
}

TEST(HybridGolden, ForwardInEveryAssemblyMode) {
  const std::array<std::string, 5> words = {"OK", "NO_XZ", "DEGENERATE_XZ", "NO_BETA", "DEGENERATE_BETA"};
  std::map<std::string, int> seen;
  for (const Json& entry : golden()["fk"]) {
    SCOPED_TRACE(entry.dump());
    const auto p = design_of(entry);
    const Json& q = entry["q"];
    const AxisVector<double> s = {q[0], q[1], q[2], q[3]};
    const Forward found = forward(geometry_of(p), s);
    EXPECT_EQ(words[static_cast<std::size_t>(found.status)], entry["status"].get<std::string>());
    EXPECT_EQ(mechanism().forward()->status(p, s, {}).word, entry["status"].get<std::string>());
    EXPECT_EQ(mechanism().forward()->status(p, s, {}).reason.empty(), entry["status"] == "OK");
    ++seen[entry["status"]];
    ASSERT_EQ(found.assemblies.size(), entry["solutions"].size());
    ASSERT_EQ(mechanism().forward()->assemblies(p, s).size(), entry["solutions"].size());
    for (std::size_t k = 0; k < found.assemblies.size(); ++k) {
      const Assembly& a = found.assemblies[k];
      const Json& expected = entry["solutions"][k];
      EXPECT_EQ(Json({a.sign_z, a.sign_N2}), expected["am"]);
      EXPECT_EQ(a.double_z + 2 * a.double_beta, expected["flags"].get<int>());
      EXPECT_EQ(Json(a.mode), expected["wm"]);
      const double tolerance = expected["flags"] == 0 ? kNear : kDoubleRoot;
      expect_all_near(std::array{a.pose.x, a.pose.y, a.pose.z, a.pose.angle}, expected["X"], "X", tolerance);
    }
  }
  EXPECT_EQ(seen.size(), 5u);
}

TEST(HybridGolden, InfluenceCoefficientsBothWays) {
  for (const Json& entry : golden()["jac"]) {
    SCOPED_TRACE(entry.dump());
    const auto p = design_of(entry);
    const auto found = mechanism().velocities()->influence(p, pose_of(entry["X"]), mode_name(mode_of(entry["wm"])));
    ASSERT_TRUE(found);
    const pkm::Influence<double> back = reversed(*found);
    expect_matrix_near(found->G, entry["G_inv"], "G_inv");
    expect_matrix_near(back.G, entry["G_fwd"], "G_fwd");
    for (std::size_t i = 0; i < 4; ++i) {
      expect_matrix_near(found->H[i], entry["H_inv"][i], "H_inv");
      expect_matrix_near(back.H[i], entry["H_fwd"][i], "H_fwd", 10 * kNear);
    }
    const Vector<double, 4> V = vector_of(entry["V"]), A = vector_of(entry["A"]);
    const AxisVector<double> speeds = found->G * V, drives = accelerations<double, 0>(*found, V, A);
    expect_all_near(speeds, entry["qd"], "qd");
    expect_all_near(drives, entry["qdd"], "qdd");
    expect_all_near(back.G * speeds, entry["V_back"], "V");
    expect_all_near(accelerations<double, 0>(back, speeds, drives), entry["A_back"], "A", 10 * kNear);
    const PoseReport report = inspect(entry, entry["wm"]);
    expect_near(*report.det_G, entry["det_Jx"], "det Jx");
    expect_near(*report.det_Jq, entry["det_Jq"], "det Jq");
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j) expect_near((*report.J)(i, j), entry["G_inv"][i][j], "J");
  }
}

TEST(HybridGolden, AuxiliaryChain) {
  int phased = 0;
  for (const Json& entry : golden()["aux"]) {
    SCOPED_TRACE(entry.dump());
    const auto p = design_of(entry);
    const auto g = geometry_of(p);
    const SchoenfliesPose<double> pose = pose_of(entry["X"]);
    const Shaft<double> axis = shaft(g, pose);
    expect_all_near(axis.w, entry["w"], "w");
    expect_all_near(std::array{axis.P, axis.Q, axis.T}, {entry["P"], entry["Q"], entry["T"]}, "P, Q, T");
    expect_all_near(std::array{axis.length, axis.cos_phi1, axis.cos_phi2},
                    {entry["len"], entry["cos_phi1"], entry["cos_phi2"]}, "len, cos phi");
    MotionSample at;
    at.pose = vector_of(entry["X"]);
    at.velocity = vector_of(entry["V"]);
    at.acceleration = vector_of(entry["A"]);
    at.input = {entry["theta"], entry["thd"], entry["thdd"]};
    const ChainReport chain = mechanism().chain()->report(p, at, 0);
    EXPECT_EQ(chain.turns, !entry["gamma"].is_null());
    EXPECT_EQ(chain.reason.empty(), chain.turns);
    const auto angles = as_map(chain.angles);
    expect_near(std::cos(angles.at("phi1")), entry["cos_phi1"], "phi1");
    expect_near(std::cos(angles.at("phi2")), entry["cos_phi2"], "phi2");
    expect_near(angles.at("shaft_length"), entry["len"], "length");
    EXPECT_EQ(mechanism().chain()->report(p, at, entry["zeta"]).turns, !entry["gamma_zeta"].is_null());
    if (!chain.turns) continue;
    expect_near(chain.output.angle, entry["gamma"], "gamma");
    expect_near(chain.output.speed, entry["gd"], "gamma'");
    expect_near(chain.output.acceleration, entry["gdd"], "gamma''");
    expect_all_near(chain.influence.gradient, entry["grad"], "gradient");
    expect_matrix_near(chain.influence.hessian, entry["hess"], "Hessian");
    expect_all_near(chain.spin.velocity, entry["omega"], "omega");
    expect_all_near(chain.spin.acceleration, entry["alpha"], "alpha");
    expect_near(input_angle(g, forks(axis, pose.angle, 0), chain.output.angle), entry["theta_back"], "theta");
    if (entry["gamma_zeta"].is_null()) continue;
    ++phased;
    expect_near(mechanism().chain()->report(p, at, entry["zeta"]).output.angle, entry["gamma_zeta"], "gamma at zeta");
  }
  EXPECT_GT(phased, 20);
}

TEST(HybridGolden, MarginsAndFeasibility) {
  std::vector<std::string> names;
  for (const auto& name : golden()["margin_names"]) names.push_back(name);
  ASSERT_EQ(names.size(), kMargins);
  for (std::size_t i = 0; i < kMargins; ++i) EXPECT_EQ(kMarginNames[i].name, names[i]);
  int feasible_ones = 0;
  for (const Json& entry : golden()["feasibility"]) {
    SCOPED_TRACE(entry.dump());
    const PoseReport report = inspect(entry, entry["wm"], entry["sb"]);
    EXPECT_EQ(report.feasible, entry["feasible"].get<bool>());
    EXPECT_EQ(report.reason.empty(), report.feasible);
    feasible_ones += report.feasible;
    for (std::size_t i = 0; i < names.size(); ++i) {
      EXPECT_EQ(report.margins[i].first, names[i]);
      if (entry["margins"][i].is_null())
        EXPECT_TRUE(std::isnan(report.margins[i].second)) << names[i];
      else
        expect_near(report.margins[i].second, entry["margins"][i], names[i]);
    }
  }
  EXPECT_GT(feasible_ones, 5);
}

TEST(HybridGolden, QualityIndices) {
  for (const Json& entry : golden()["quality"]) {
    SCOPED_TRACE(entry.dump());
    std::vector<double> p = design_of(entry);
    const auto g = geometry_of(p);
    const SchoenfliesPose<double> pose = pose_of(entry["X"]);
    const Joints<double> j = inverse(g, pose, mode_of(entry["wm"]));
    const Rows3<double> J = homogeneous_jacobian(pose.z, j, entry["Lc"].get<double>());
    const ExtremeSingularValues s = extreme_singular_values(J);
    expect_all_near(std::array{std::sqrt(s.greatest_2), std::sqrt(s.pair_2 / s.greatest_2), std::sqrt(s.least_2())},
                    entry["sigma"], "sigma");
    expect_near(inverse_condition(J), entry["inv_cond"], "conditioning");
    expect_near(s.determinant, entry["det_inv"], "determinant");
    const PoseReport report = inspect(entry, entry["wm"]);
    const auto index = as_map(report.indices), angle = as_map(report.angles);
    for (std::size_t limb = 0; limb < 3; ++limb) {
      expect_near(index.at("t_" + std::to_string(limb + 1)), entry["t_in"][limb], "t_in");
      expect_near(angle.at("pressure_" + std::to_string(limb + 1)), entry["pressure_in"][limb], "pressure");
    }
    for (const char* name : {"t_xz", "t_beta", "t_con", "LTI"}) expect_near(index.at(name), entry[name], name);
    for (const char* name : {"aux_ratio_min", "aux_ratio_max"}) {
      EXPECT_EQ(index.contains(name), !entry[name].is_null());
      if (index.contains(name)) expect_near(index.at(name), entry[name], name);
    }
    if (entry["Lc"] == p[kE]) expect_near(*report.conditioning, entry["inv_cond"], "conditioning of the report");
  }
}

TEST(HybridGolden, SegmentDistances) {
  for (const Json& entry : golden()["segdist"]) {
    const auto point = [&](const char* key) { return Point3<double>{entry[key][0], entry[key][1], entry[key][2]}; };
    expect_near(segment_distance<double>({point("p0"), point("p1")}, {point("q0"), point("q1")}), entry["dist"],
                entry.dump());
  }
}

/// The paper's motion (its section 5), with theta where it prints gamma.
std::shared_ptr<const Motion> sample_motion() {
  const auto formula = [](const std::string& text) { return Formula(text, time_name()); };
  return with_input(
      formulas_of_time(
          {formula("-0.010*t"), formula("0.010*t"), formula("0.25+0.002*sin(pi*t)"), formula("5*pi/180*sin(pi*t)")}, 5),
      formula("120*pi/180*sin(2*t)"));
}

TEST(HybridGolden, TheSampleMotion) {
  const Json& table = golden()["motion"];
  const auto motion = sample_motion();
  const LimitSpec none = no_limits(mechanism().info());
  const Trajectory found = follow(mechanism(), nominal(), "+,-,-", none, *motion, table.size());
  EXPECT_EQ(found.summary.infeasible, 0u);
  EXPECT_FALSE(found.periodic);
  for (std::size_t k = 0; k < table.size(); ++k) {
    const Json& row = table[k];
    SCOPED_TRACE(row.dump());
    const TrajectoryPoint& p = found.points[k];
    expect_near(p.motion.time, row["t"], "t");
    expect_all_near(p.motion.pose, row["X"], "X");
    expect_all_near(p.motion.velocity, row["V"], "V");
    expect_all_near(p.motion.acceleration, row["A"], "A");
    expect_all_near(*p.joints, row["q"], "q");
    expect_all_near(*p.speeds, row["qd"], "qd");
    expect_all_near(*p.accelerations, row["qdd"], "qdd");
    const Turning &in = p.motion.input, &out = p.chain->output;
    expect_all_near(std::array{in.angle, in.speed, in.acceleration}, {row["theta"], row["thd"], row["thdd"]}, "theta");
    expect_all_near(std::array{out.angle, out.speed, out.acceleration}, {row["gamma"], row["gd"], row["gdd"]}, "gamma");
    expect_all_near(p.chain->spin.velocity, row["omega"], "omega");
    expect_all_near(p.chain->spin.acceleration, row["alpha"], "alpha");
  }
}

}  // namespace
}  // namespace pkm::testing::hybrid
