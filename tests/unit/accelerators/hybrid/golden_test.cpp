// Hybrid robot: every golden case of a pose, and the paper's motion.
#include "tests/unit/accelerators/hybrid/golden.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "engine/accelerators/hybrid/limits.hpp"
#include "engine/geometry/capsule.hpp"
#include "engine/geometry/conditioning.hpp"
#include "engine/mechanism/trajectory.hpp"
#include "engine/motion/motion_factories.hpp"

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

PoseReport inspect(const Json& entry, const Json& wm, int branch = 1, const LimitSpec& limits = no_thresholds()) {
  return mechanism().inspect(design_of(entry), pose_of(entry["X"]), mode_name(mode_of(wm), branch), limits);
}

TEST(HybridGolden, NominalDesignIsTheDefault) { EXPECT_EQ(nominal(), design_from(golden()["designs"][0])); }

TEST(HybridGolden, InverseInEveryMode) {
  ASSERT_GE(golden()["ik"].size(), 30u);
  for (const Json& entry : golden()["ik"]) {
    SCOPED_TRACE(entry.dump());
    ASSERT_EQ(entry["modes"].size(), 8u);
    const std::vector<double> p = design_of(entry);
    const double x = entry["X"][0];
    for (const Json& mode : entry["modes"]) {
      const PoseReport report = inspect(entry, mode["wm"]);
      EXPECT_EQ(report.assembles, entry["unreach"] == 0);
      ASSERT_TRUE(report.joints);
      const AxisVector<double>& q = *report.joints;
      const auto margins = by_name(report.margins);
      const std::array<double, 3> n = {x - p[kA] + p[kB1] - q[0], x + p[kA] - p[kB2] - q[2], x - p[kC] - q[3]};
      unsigned unreached = 0, serial = 0;
      for (std::size_t limb = 0; limb < 3; ++limb) {
        const double square = margins.at("n" + std::to_string(limb + 1) + " exists"), L = p[kL1 + limb];
        unreached |= (square < 0 ? 1u : 0u) << limb;
        serial |= (std::fabs(square) <= kNear * L * L ? 1u : 0u) << limb;
        if (!mode["n"][limb].is_null())
          expect_near(n[limb], mode["n"][limb], "n");
        else
          EXPECT_TRUE(std::isnan(q[kDriveOfLimb[limb]]));
      }
      EXPECT_EQ(unreached, entry["unreach"].get<unsigned>());
      EXPECT_EQ(serial, entry["serial"].get<unsigned>());
      for (std::size_t i = 0; i < 4; ++i)
        if (!mode["q"][i].is_null()) expect_near(q[i], mode["q"][i], "q");
      const Joints<double> j = inverse(geometry_of(p), pose_of(entry["X"]), mode_of(mode["wm"]));
      EXPECT_EQ(j.unreached, unreached);
      EXPECT_EQ(j.serial, serial);
      for (std::size_t i = 0; i < 4; ++i)
        if (!mode["q"][i].is_null()) expect_near(j.s[i], mode["q"][i], "q in closed form");
    }
  }
}

TEST(HybridGolden, ForwardInEveryAssemblyMode) {
  std::map<std::string, int> seen;
  for (const Json& entry : golden()["fk"]) {
    SCOPED_TRACE(entry.dump());
    const auto p = design_of(entry);
    const Json& q = entry["q"];
    const AxisVector<double> s = {q[0], q[1], q[2], q[3]};
    const Forward found = forward(geometry_of(p), s);
    EXPECT_EQ(found.status.word, entry["status"].get<std::string>());
    EXPECT_EQ(mechanism().forward()->status(p, s, {}).word, entry["status"].get<std::string>());
    EXPECT_EQ(mechanism().forward()->status(p, s, {}).reason.empty(), entry["status"] == "OK");
    ++seen[entry["status"]];
    ASSERT_EQ(found.modes.size(), entry["solutions"].size());
    ASSERT_EQ(mechanism().forward()->assemblies(p, s).size(), entry["solutions"].size());
    for (std::size_t k = 0; k < found.modes.size(); ++k) {
      const AssemblyMode& a = found.modes[k];
      const std::vector<std::string>& doubles = a.double_roots;
      const Json& expected = entry["solutions"][k];
      EXPECT_EQ(Json(signs_of(a.mode)), expected["am"]);
      EXPECT_EQ(std::ranges::count(doubles, "z") + 2 * std::ranges::count(doubles, "beta"),
                expected["flags"].get<int>());
      EXPECT_EQ(Json(signs_of(a.working_mode)), expected["wm"]);
      const double tolerance = expected["flags"] == 0 ? kNear : kDoubleRoot;
      expect_all_near(std::array{a.pose[0], a.pose[1], a.pose[2], a.pose[3]}, expected["X"], "X", tolerance);
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
    const AxisVector<double> V = vector_of(entry["V"]), A = vector_of(entry["A"]);
    const AxisVector<double> speeds = found->G * V, drives = accelerations(*found, V, A);
    expect_all_near(speeds, entry["qd"], "qd");
    expect_all_near(drives, entry["qdd"], "qdd");
    expect_all_near(back.G * speeds, entry["V_back"], "V");
    expect_all_near(accelerations(back, speeds, drives), entry["A_back"], "A", 10 * kNear);
    const PoseReport report = inspect(entry, entry["wm"]);
    expect_near(*report.det_G, entry["det_Jx"], "det Jx");
    expect_near(*report.det_Jq, entry["det_Jq"], "det Jq");
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j) expect_near((*report.J)(i, j), entry["G_inv"][i][j], "J");
  }
}

TEST(HybridGolden, AuxiliaryChain) {
  int turning = 0, phased = 0, placed = 0;
  for (const Json& entry : golden()["aux"]) {
    SCOPED_TRACE(entry.dump());
    const auto p = design_of(entry);
    const InputSample theta = {entry["theta"], entry["thd"], entry["thdd"]};
    const MotionSample at{.pose = vector_of(entry["X"]),
                          .velocity = vector_of(entry["V"]),
                          .acceleration = vector_of(entry["A"]),
                          .inputs = inputs_of(theta)};
    const auto values = quantities(p, at);
    const double length = values.at("shaft_length"), cos_phi1 = std::cos(values.at("phi1")),
                 cos_phi2 = std::cos(values.at("phi2"));
    expect_near(length, entry["len"], "length");
    expect_near(cos_phi1, entry["cos_phi1"], "phi1");
    expect_near(cos_phi2, entry["cos_phi2"], "phi2");
    expect_near(length * cos_phi1, entry["Q"], "Q");
    expect_near(length * cos_phi2, entry["P"], "P");
    for (const PlacedLink& link : mechanism().links()->place(p, at.pose, "+,-,-"))
      if (link.name == "telescopic shaft") {
        expect_all_near(difference(link.body.axis.to, link.body.axis.from), entry["w"], "w");
        ++placed;
      }
    EXPECT_EQ(std::isnan(values.at("gamma")), entry["gamma"].is_null());
    MotionSample other = at;
    other.inputs = inputs_of(theta, entry["zeta"]);
    const double gamma_at_zeta = quantities(p, other).at("gamma");
    EXPECT_EQ(std::isnan(gamma_at_zeta), entry["gamma_zeta"].is_null());
    if (entry["gamma"].is_null()) continue;
    ++turning;
    expect_near(values.at("gamma"), entry["gamma"], "gamma");
    expect_near(values.at("gamma_speed"), entry["gd"], "gamma'");
    expect_near(values.at("gamma_acceleration"), entry["gdd"], "gamma''");
    for (std::size_t k = 0; k < 3; ++k) {
      expect_near(values.at(std::string("omega_") + "xyz"[k]), entry["omega"][k], "omega");
      expect_near(values.at(std::string("alpha_") + "xyz"[k]), entry["alpha"][k], "alpha");
    }
    other.inputs = inputs_of(theta, 0, values.at("gamma"));
    expect_near(quantities(p, other).at("theta_for_gamma"), entry["theta_back"], "theta");
    // By x, y, z, beta and theta: at unit rates, gamma' is the gradient's component and gamma'' the Hessian's form.
    const auto along = [&](std::size_t i, std::size_t j) {
      std::array<double, 5> rates{};
      rates[i] = rates[j] = 1;
      return quantities(p, {.pose = at.pose,
                            .velocity = {rates[0], rates[1], rates[2], rates[3]},
                            .acceleration = AxisVector<double>(4),
                            .inputs = inputs_of({entry["theta"], rates[4], 0})});
    };
    AxisMatrix<double> hessian(5, 5);
    for (std::size_t i = 0; i < 5; ++i) {
      expect_near(along(i, i).at("gamma_speed"), entry["grad"][i], "gradient");
      hessian(i, i) = along(i, i).at("gamma_acceleration");
      for (std::size_t j = 0; j < i; ++j)  // of a sum of two axes: H_ii + H_jj + 2 H_ij
        hessian(i, j) = hessian(j, i) = (along(i, j).at("gamma_acceleration") - hessian(i, i) - hessian(j, j)) / 2;
    }
    expect_matrix_near(hessian, entry["hess"], "Hessian");
    if (entry["gamma_zeta"].is_null()) continue;
    ++phased;
    expect_near(gamma_at_zeta, entry["gamma_zeta"], "gamma at zeta");
  }
  EXPECT_GT(turning, 25);
  EXPECT_GT(phased, 20);
  EXPECT_GT(placed, 10);
}

/// The golden margins in terms of those of the report: reach relative to the square of the link's length, stroke as the
/// minimum of the two ends of a joint's range, the others alike.
double golden_margin(const std::map<std::string, double>& margins, const std::vector<double>& p,
                     const std::string& name) {
  const std::string number(1, name.back());
  if (name.starts_with("reach")) {
    const double L = p[kL1 + static_cast<std::size_t>(name.back() - '1')];
    return margins.at("n" + number + " exists") / (L * L);
  }
  if (name.starts_with("stroke"))
    return std::fmin(margins.at("s" + number + " min"), margins.at("s" + number + " max"));
  return margins.at(name);
}

TEST(HybridGolden, MarginsAndFeasibility) {
  LimitSpec limits = no_thresholds();
  limits.given[kClearanceMin] = 0;  // the golden feasibility counts links as capsules
  int feasible_ones = 0;
  for (const Json& entry : golden()["feasibility"]) {
    SCOPED_TRACE(entry.dump());
    const std::vector<double> p = design_of(entry);
    const PoseReport report = inspect(entry, entry["wm"], entry["sb"], limits);
    EXPECT_EQ(report.feasible, entry["feasible"].get<bool>());
    EXPECT_EQ(report.reason.empty(), report.feasible);
    feasible_ones += report.feasible;
    const auto margins = by_name(report.margins);
    std::optional<double> clearance;
    for (std::size_t i = 0; i < entry["margins"].size(); ++i) {
      const std::string name = golden()["margin_names"][i];
      const Json& expected = entry["margins"][i];
      if (expected.is_null()) {
        EXPECT_FALSE(report.assembles) << name;
      } else if (name.starts_with("cap_")) {
        clearance = std::fmin(clearance.value_or(expected), expected);
      } else {
        expect_near(golden_margin(margins, p, name), expected, name);
      }
    }
    EXPECT_EQ(clearance.has_value(), report.assembles);
    if (clearance) expect_near(margins.at("clearance_min"), *clearance, "clearance");
  }
  EXPECT_GT(feasible_ones, 5);
}

TEST(HybridGolden, QualityIndices) {
  for (const Json& entry : golden()["quality"]) {
    SCOPED_TRACE(entry.dump());
    const std::vector<double> p = design_of(entry);
    const SchoenfliesPose<double> pose = pose_of(entry["X"]);
    const Joints<double> j = inverse(geometry_of(p), pose, mode_of(entry["wm"]));
    const Rows3<double> J = homogeneous_jacobian(pose.z, j, entry["Lc"].get<double>());
    const ExtremeSingularValues s = extreme_singular_values(J);
    expect_all_near(std::array{std::sqrt(s.max_squared), std::sqrt(s.leading_product_squared / s.max_squared),
                               std::sqrt(s.min_squared())},
                    entry["sigma"], "sigma");
    expect_near(inverse_condition(J), entry["inv_cond"], "conditioning");
    expect_near(s.determinant, entry["det_inv"], "determinant");
    const PoseReport report = inspect(entry, entry["wm"]);
    const auto index = by_name(report.indices), angle = by_name(report.angles);
    for (std::size_t limb = 0; limb < 3; ++limb) {
      expect_near(index.at("t_" + std::to_string(limb + 1)), entry["t_in"][limb], "t_in");
      expect_near(angle.at("pressure_" + std::to_string(limb + 1)), entry["pressure_in"][limb], "pressure");
    }
    for (const char* name : {"t_xz", "t_beta", "t_con", "LTI"}) expect_near(index.at(name), entry[name], name);
    for (const char* name : {"aux_ratio_min", "aux_ratio_max"}) {
      EXPECT_EQ(std::isnan(index.at(name)), entry[name].is_null());
      if (!entry[name].is_null()) expect_near(index.at(name), entry[name], name);
    }
    if (entry["Lc"] == p[kE]) expect_near(report.conditioning.value(), entry["inv_cond"], "conditioning of the report");
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
  return with_inputs(
      motion_from_formulas(
          {formula("-0.010*t"), formula("0.010*t"), formula("0.25+0.002*sin(pi*t)"), formula("5*pi/180*sin(pi*t)")}, 5),
      {formula("120*pi/180*sin(2*t)"), formula("0"), formula("0")});
}

TEST(HybridGolden, TheSampleMotion) {
  const Json& table = golden()["motion"];
  const auto motion = sample_motion();
  const Trajectory found = compute_trajectory(mechanism(), nominal(), "+,-,-", no_thresholds(), *motion, table.size());
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
    const InputSample& theta = p.motion.inputs[0];
    const auto values = named_quantities(p.quantities);
    expect_all_near(std::array{theta.value, theta.rate, theta.acceleration}, {row["theta"], row["thd"], row["thdd"]},
                    "theta");
    expect_near(values.at("gamma"), row["gamma"], "gamma");
    expect_near(values.at("gamma_speed"), row["gd"], "gamma'");
    expect_near(values.at("gamma_acceleration"), row["gdd"], "gamma''");
    for (std::size_t i = 0; i < 3; ++i) {
      expect_near(values.at(std::string("omega_") + "xyz"[i]), row["omega"][i], "omega");
      expect_near(values.at(std::string("alpha_") + "xyz"[i]), row["alpha"][i], "alpha");
    }
  }
}

}  // namespace
}  // namespace pkm::testing::hybrid
