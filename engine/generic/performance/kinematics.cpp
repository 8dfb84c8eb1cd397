// Transmission of velocities and forces, and accuracy.
#include <algorithm>

#include "engine/expression/derivative.hpp"
#include "engine/generic/equations.hpp"
#include "engine/generic/performance/performance.hpp"

namespace pkm::generic {
namespace {

/// A copy of the matrix without the rows whose elements are all 0.
TermMatrix without_zero_rows(const TermMatrix& A) {
  std::vector<std::size_t> kept;
  for (std::size_t i = 0; i < A.rows(); ++i)
    for (std::size_t j = 0; j < A.columns(); ++j)
      if (!A(i, j).is(0)) {
        kept.push_back(i);
        break;
      }
  if (kept.empty()) return {A.graph(), 0, A.columns()};
  TermMatrix result(A.graph(), kept.size(), A.columns());
  for (std::size_t i = 0; i < kept.size(); ++i)
    for (std::size_t j = 0; j < A.columns(); ++j) result(i, j) = A(kept[i], j);
  return result;
}

std::size_t nonzero_columns(const TermMatrix& A) {
  std::size_t count = 0;
  for (std::size_t j = 0; j < A.columns(); ++j) {
    bool is_zero = true;
    for (std::size_t i = 0; i < A.rows(); ++i) is_zero = is_zero && A(i, j).is(0);
    count += is_zero ? 0 : 1;
  }
  return count;
}

Term max(const Term& x, const Term& y) { return call(expression::operation("max"), x, y); }

/// Maximum length of +-a_1 +- a_2 ... over all signs, where a_i are the columns. The sign of a_1 is fixed, because v
/// and -v have the same length.
Term longest_sum(const TermMatrix& columns) {
  std::vector<TermMatrix> sums = {columns.column(0)};
  for (std::size_t j = 1; j < columns.columns(); ++j) {
    const TermMatrix column = columns.column(j);
    std::vector<TermMatrix> next;
    for (const TermMatrix& sum : sums) {
      next.push_back(sum + column);
      next.push_back(sum + column * Term(columns.graph(), -1.0));
    }
    sums = std::move(next);
  }
  Term longest = squared_norm(sums[0]);
  for (std::size_t i = 1; i < sums.size(); ++i) longest = max(longest, squared_norm(sums[i]));
  return sqrt(longest);
}

}  // namespace

FirstOrderKinematics first_order_kinematics(Model& model) {
  const std::size_t n = model.inputs.coordinates;
  TermMatrix J(model.graph, model.joints.size(), n), translation(model.graph, 3, n), rotation(model.graph, 3, n);
  const std::vector<Node> elements = model.equations ? model.equations->J : jacobian_of(model);
  for (std::size_t i = 0; i < elements.size(); ++i) J(i / n, i % n) = model.term(elements[i]);
  std::vector<std::size_t> rotations;
  for (std::size_t j = 0; j < n; ++j) {
    if (model.rotation_axes[j]) rotations.push_back(j);
    for (std::size_t i = 0; i < 3; ++i) {
      translation(i, j) = model.term(expression::derivative(model.graph, model.origin[i], model.coordinate(j)));
      rotation(i, j) = model.term(model.rotation_directions[j][i]);
    }
  }
  const auto turns = [](const DependentCoordinate& each) { return each.kind.starts_with("about"); };
  if (std::ranges::any_of(model.dependent, turns)) {
    rotation = without_zero_rows(rotation);
  } else if (rotations.size() < 3) {
    rotation = TermMatrix(model.graph, rotations.size(), n);
    for (std::size_t i = 0; i < rotations.size(); ++i) rotation(i, rotations[i]) = Term(model.graph, 1.0);
  }
  std::optional<expression::Inverse> inverse;
  if (J.rows() == n) inverse = inverse_of(J);
  if (J.rows() > n) {
    const auto [adjugate, determinant] = inverse_of(J.transposed() * J);
    inverse = {adjugate * J.transposed(), determinant};
  }
  return {J, without_zero_rows(translation), rotation, inverse};
}

std::vector<NamedTerm> velocity_quantities(const Model& model, const FirstOrderKinematics& kinematics) {
  const Term determinant = abs(kinematics.inverse->determinant);
  const bool turns = model.info.joints.front().turns();
  std::vector<NamedTerm> found;
  const auto add = [&](const TermMatrix& T, const std::string& velocity, const std::string& force,
                       const std::string& velocity_text, const std::string& force_text, bool is_rotation) {
    if (T.rows() == 0 || T.rows() > T.columns()) return;
    // If T has fewer nonzero columns than rows, no motion of the coordinates produces some of the angular velocities.
    if (is_rotation && T.rows() > nonzero_columns(T)) return;
    const TermMatrix V = T * kinematics.inverse->adjugate;
    const auto [least, greatest] = eigenvalue_range(V * V.transposed());
    const std::string unit = is_rotation == turns ? "1" : is_rotation ? "rad/m" : "m/rad";
    const std::string inverse_unit = is_rotation == turns ? "1" : is_rotation ? "m/rad" : "rad/m";
    found.push_back({velocity, unit, velocity_text + " in the slowest direction for joint speeds of norm 1",
                     sqrt(least) / determinant});
    found.push_back({force, inverse_unit, force_text + " in the weakest direction for joint forces of norm 1",
                     determinant / sqrt(greatest)});
  };
  add(kinematics.translation, "velocity_transmission", "force_transmission", "speed", "force", false);
  add(kinematics.rotation, "angular_velocity_transmission", "moment_transmission", "angular speed", "moment", true);
  return found;
}

std::vector<NamedTerm> accuracy_quantities(const FirstOrderKinematics& kinematics, const JointErrors& errors) {
  const Term determinant = abs(kinematics.inverse->determinant);
  std::vector<NamedTerm> found;
  const auto add = [&](const TermMatrix& T, const std::string& name, const std::string& unit, const std::string& text) {
    if (T.rows() == 0) return;
    TermMatrix worst = T * kinematics.inverse->adjugate, spread = worst;
    for (std::size_t i = 0; i < worst.rows(); ++i)
      for (std::size_t j = 0; j < worst.columns(); ++j) {
        worst(i, j) = worst(i, j) * errors.bound[j];
        spread(i, j) = spread(i, j) * spread(i, j) * errors.squared_spread[j];
      }
    Term variance(T.graph(), 0.0);
    for (std::size_t i = 0; i < spread.rows(); ++i)
      for (std::size_t j = 0; j < spread.columns(); ++j) variance = variance + spread(i, j);
    found.push_back({name, unit, "maximum first-order " + text, longest_sum(worst) / determinant});
    found.push_back({name + "_rms", unit, "root mean square of the first-order " + text, sqrt(variance) / determinant});
  };
  add(kinematics.translation, "accuracy", "m", "position error of the platform");
  add(kinematics.rotation, "accuracy_angle", "rad", "orientation error of the platform");
  return found;
}

}  // namespace pkm::generic
