// Mechanism files with additions, values of quantities and random poses, for tests of the performance of mechanisms.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <sstream>

#include <Eigen/Dense>

#include "engine/config/study_additions.hpp"
#include "engine/math/eigen_solvers.hpp"
#include "tests/unit/contracts/mechanism_fixtures.hpp"

namespace pkm::test {

inline std::string replaced(std::string text, const std::string& old, const std::string& by) {
  std::size_t at = text.find(old);
  EXPECT_NE(at, std::string::npos) << old;
  for (; at != std::string::npos; at = text.find(old, at + by.size())) text.replace(at, old.size(), by);
  return text;
}
/// Omits the lines that begin with a word.
inline std::string without(const std::string& text, const std::string& word) {
  std::istringstream lines(text);
  std::string kept;
  for (std::string line; std::getline(lines, line);)
    if (!line.starts_with(word)) kept += line + "\n";
  return kept;
}

inline std::shared_ptr<const Mechanism> read(const std::string& text) { return read_mechanism_toml(text, "test.toml"); }

/// The mechanism with the tables that a study adds.
inline std::shared_ptr<const Mechanism> with_study(const std::string& text, const std::string& study) {
  const TomlValue tables = parse_toml(study, "study.toml", "a study");
  return read_mechanism_toml(text, "test.toml", {}, study_additions(tables, "study.toml"));
}

inline Pose<double> pose_at(const std::vector<double>& at) {
  Pose<double> pose(at.size());
  std::ranges::copy(at, pose.begin());
  return pose;
}

/// Value of a quantity in the report of a pose.
inline double value_in(const PoseReport& report, const MechanismInfo& info, const std::string& name) {
  const auto found = std::ranges::find(info.quantities, name, &QuantityInfo::name);
  if (found != info.quantities.end())
    return report.quantities.at(static_cast<std::size_t>(found - info.quantities.begin()));
  ADD_FAILURE() << "there is no " << name;
  return std::nan("");
}
/// Value of a quantity at a pose.
inline double value_at(const Mechanism& mechanism, const std::vector<double>& design, const std::vector<double>& at,
                       const std::string& name, const std::string& mode = "") {
  const MechanismInfo& info = mechanism.info();
  return value_in(mechanism.inspect(design, pose_at(at), mode.empty() ? info.modes.front() : mode, no_limits(info)),
                  info, name);
}

inline Eigen::MatrixXd eigen_of(const AxisMatrix<double>& A) {
  Eigen::MatrixXd result(A.rows(), A.cols());
  for (std::size_t i = 0; i < A.rows(); ++i)
    for (std::size_t j = 0; j < A.cols(); ++j)
      result(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j)) = A(i, j);
  return result;
}

/// The nonzero rows of the map from coordinate rates to velocities, or to angular velocities.
inline Eigen::MatrixXd rows_of_twist(const Eigen::MatrixXd& T, bool rotations) {
  const Eigen::MatrixXd part = rotations ? T.bottomRows(3) : T.topRows(3);
  Eigen::MatrixXd kept(0, T.cols());
  for (Eigen::Index i = 0; i < 3; ++i)
    if (part.row(i).norm() > 0) {
      kept.conservativeResize(kept.rows() + 1, Eigen::NoChange);
      kept.row(kept.rows() - 1) = part.row(i);
    }
  return kept;
}

/// Feasible poses about the reference pose.
inline std::vector<std::vector<double>> random_poses(const Mechanism& mechanism, const std::vector<double>& design,
                                                     std::mt19937& random) {
  const MechanismInfo& info = mechanism.info();
  const Pose<double> centre = reference_pose(mechanism);
  std::vector<std::vector<double>> poses;
  for (int trial = 0; trial < 200 && poses.size() < 10; ++trial) {
    std::vector<double> at;
    for (std::size_t i = 0; i < info.coordinates.size(); ++i)
      at.push_back(centre[i] + std::uniform_real_distribution<double>(-.05, .05)(random));
    if (mechanism.inspect(design, pose_at(at), info.modes.front(), no_limits(info)).feasible) poses.push_back(at);
  }
  return poses;
}

}  // namespace pkm::test
