#include "experiments/app/stiffness.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/Dense>

#include "engine/config/assignments.hpp"
#include "engine/dynamics/pose_dynamics.hpp"
#include "engine/generic/eigen_matrix.hpp"
#include "engine/math/eigen_solvers.hpp"
#include "experiments/app/axes.hpp"
#include "experiments/app/motion_inputs.hpp"

namespace pkm {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using generic::axis_matrix, generic::eigen;

const std::vector<std::string> kComponents = {"x", "y", "z", "about x", "about y", "about z"};

/// Eigenvalues of a symmetric matrix, in ascending order.
VectorXd eigenvalues(const MatrixXd& A) { return Eigen::SelfAdjointEigenSolver<MatrixXd>(A).eigenvalues(); }

/// Compliance matrix C of the platform. Its basis vectors are the columns of S: the wrenches that the mechanism can
/// balance.
struct Elastic {
  MatrixXd S, C;

  /// Compliance for pure forces (first = 0) or pure moments (first = 3), restricted to those that can be balanced.
  MatrixXd pure(Index first) const {
    if (S.cols() == 0) return {};
    const MatrixXd others = S.middleRows(3 - first, 3);
    const Eigen::JacobiSVD<MatrixXd> decomposition(others, Eigen::ComputeFullV);
    Index rank = 0;
    while (rank < decomposition.singularValues().size() && decomposition.singularValues()[rank] > 1e-9) ++rank;
    const MatrixXd N = decomposition.matrixV().rightCols(S.cols() - rank);
    return N.transpose() * C * N;
  }
};

/// Minimum stiffness for pure forces or moments, i.e. the reciprocal of the maximum compliance.
std::string least_stiffness(const MatrixXd& C, const char* unit, const char* key, Json& json) {
  json[key] = nullptr;
  if (C.rows() == 0) return "no direction is supported";
  const double greatest = eigenvalues(C)[C.rows() - 1];
  if (!(greatest > 1e-300)) return "rigid";
  json[key] = 1 / greatest;
  return number(1 / greatest, unit);
}

/// Returns true if no direction is rigid, i.e. if C is not singular. C is scaled, so that the result does not depend on
/// units.
bool is_invertible(const MatrixXd& C) {
  if (C.diagonal().minCoeff() <= 0) return false;
  const VectorXd scale = C.diagonal().cwiseSqrt().cwiseInverse();
  return eigenvalues(scale.asDiagonal() * C * scale.asDiagonal())[0] > 1e-12;
}

/// Natural frequencies [Hz] of small vibrations in the pose coordinates, in ascending order; empty if the mechanism has
/// no masses or cannot balance every generalised force.
std::vector<double> natural_frequencies(const Target& target, const std::string& mode, const Pose<double>& pose,
                                        const Elastic& elastic, const MatrixXd& T) {
  const Dynamics* const dynamics = target.mechanism->dynamics();
  if (!dynamics) return {};
  const MotionState<double> at_rest{pose, AxisVector<double>(pose.size())};
  PoseDynamics<double> found;
  dynamics->equations(std::span<const double>(target.parameters), mode, {&at_rest, 1}, {&found, 1});
  // Compute the wrenches that correspond to unit generalised forces; the mechanism must be able to balance all of them.
  const MatrixXd wrenches = T.completeOrthogonalDecomposition().pseudoInverse().transpose(),
                 carried = elastic.S.transpose() * wrenches;
  if ((elastic.S * carried - wrenches).norm() > 1e-9 * wrenches.norm()) return {};
  const Eigen::LLT<MatrixXd> inertia(eigen(found.M_X));
  if (inertia.info() != Eigen::Success) return {};
  // The eigenvalues of L^T C_x L are 1 / omega^2, because free vibrations satisfy C_x M x'' + x = 0.
  const MatrixXd L = inertia.matrixL(), C_x = carried.transpose() * elastic.C * carried;
  const VectorXd squares = eigenvalues(L.transpose() * C_x * L);
  constexpr double kRigid = 1e-13;  // eigenvalues that are smaller, relative to the largest one, are rounding errors
  std::vector<double> frequencies;
  for (const double square : squares)
    if (square > kRigid * squares[squares.size() - 1])
      frequencies.push_back(1 / (2 * std::numbers::pi * std::sqrt(square)));
  std::ranges::sort(frequencies);
  return frequencies;
}

/// Displacements of the platform under a wrench at its origin.
void report_deflection(const MatrixXd& C, const std::vector<std::string>& wrench, Json& json, Printout& out) {
  const Wrench<double> w = parse_wrench(wrench);
  VectorXd load(6);
  for (Index i = 0; i < 6; ++i) load[i] = w[static_cast<std::size_t>(i)];
  const VectorXd displacement = C * load;
  std::vector<Row> moved;
  for (Index i = 0; i < 6; ++i) {
    const std::string& name = kComponents[static_cast<std::size_t>(i)];
    json["deflection"].push_back(displacement[i]);
    moved.push_back({name, number(displacement[i], i < 3 ? "m" : "rad")});
  }
  out.add_table("deflection under the wrench", moved);
}

}  // namespace

void report_stiffness(const Target& target, const std::string& mode, const Pose<double>& pose, const PoseReport& report,
                      const std::vector<std::string>& wrench, Printout& out) {
  const Mechanism& mechanism = *target.mechanism;
  const Elasticity* const elasticity = mechanism.elasticity();
  if (!elasticity)
    throw ConfigError({"", 0, "--stiffness"},
                      "mechanism " + target.info().name + " has no elasticity: " + mechanism.why_no_elasticity());
  if (!report.assembles) return;
  const PlatformCompliance found = elasticity->compliance(target.parameters, pose, mode);
  const Elastic elastic{eigen(found.supported), eigen(found.compliance)};
  Json& json = out.json["stiffness"];
  json = {{"components", kComponents},
          {"carried_wrenches", found.supported.cols()},
          {"compliance", nullptr},
          {"matrix", nullptr}};
  if (found.is_complete()) {
    json["compliance"] = matrix_json(found.compliance);
    if (is_invertible(elastic.C)) json["matrix"] = matrix_json(axis_matrix(elastic.C.inverse()));
    out.text += matrix_text("compliance: displacement [m, rad] along and about x, y, z by force [N] and moment [N m]",
                            found.compliance);
  } else {
    out.text += "\nstiffness: the joints carry only " + std::to_string(found.supported.cols()) +
                " of 6 independent wrenches at this pose; the platform is free, or the pose is singular\n";
  }
  std::vector<Row> rows = {{"translation", least_stiffness(elastic.pure(0), "N/m", "translation", json),
                            "minimum over all directions of force by displacement"},
                           {"rotation", least_stiffness(elastic.pure(3), "N m/rad", "rotation", json),
                            "minimum over all directions of moment by rotation"}};
  const std::vector<double> frequencies = natural_frequencies(target, mode, pose, elastic, eigen(*report.T));
  json["natural_frequencies"] = frequencies;
  for (std::size_t i = 0; i < frequencies.size(); ++i)
    rows.push_back({"frequency " + std::to_string(i + 1), number(frequencies[i], "Hz"),
                    i == 0 ? "natural frequencies of the coordinates" : ""});
  out.add_table("stiffness", rows);
  if (wrench.empty()) return;
  if (!found.is_complete())
    throw ConfigError({"", 0, "--wrench"}, "the mechanism does not carry every wrench at this pose");
  report_deflection(elastic.C, wrench, json, out);
}

}  // namespace pkm
