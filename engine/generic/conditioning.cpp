#include "engine/generic/conditioning.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/SVD>

#include "engine/core/error.hpp"
#include "engine/core/unit.hpp"
#include "engine/generic/eigen_matrix.hpp"
#include "engine/geometry/mixed_units.hpp"
#include "engine/workspace/pose_quantities.hpp"

namespace pkm::generic {
namespace {

/// Map from the twist of the platform to the coordinate rates: for three rotations about moving axes, from the angular
/// velocity to the angle rates. The axes of one or two rotations are orthonormal; the rates are then the components
/// themselves.
template <class S>
AxisMatrix<S> rates_by_twist(const Model& model, const Pose<S>& pose) {
  const std::size_t n = pose.size();
  AxisMatrix<S> rates = AxisMatrix<S>::identity(n);
  std::array<std::size_t, 3> rotations{};  // a mechanism has at most three rotations
  std::size_t count = 0;
  for (std::size_t i = 0; i < n; ++i)
    if (model.rotation_axes[i]) rotations[count++] = i;
  if (count < 3) return rates;
  using Fixed3 = Matrix<S, 3, 3>;
  Fixed3 R = Fixed3::identity(), axes;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t axis = *model.rotation_axes[rotations[k]], i = (axis + 1) % 3, j = (axis + 2) % 3;
    for (std::size_t row = 0; row < 3; ++row) axes(row, k) = R(row, axis);
    const auto [sine, cosine] = sincos(pose[rotations[k]]);
    Fixed3 rotation = Fixed3::identity();
    rotation(i, i) = rotation(j, j) = cosine;
    rotation(i, j) = -sine;
    rotation(j, i) = sine;
    R = R * rotation;
  }
  const Fixed3 inverse = solve(axes, Fixed3::identity());
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) rates(rotations[i], rotations[j]) = inverse(i, j);
  return rates;
}

/// Minimum divided by maximum singular value of A. The derivatives of a singular value are d sigma = u^T dA v.
template <class S>
S singular_ratio(const AxisMatrix<S>& A) {
  constexpr unsigned kVectors = Derivative<S> ? Eigen::ComputeThinU | Eigen::ComputeThinV : 0;
  const Eigen::JacobiSVD<EigenMatrix> decomposition(eigen(A), kVectors);
  const auto singular = [&](Eigen::Index k) {
    S value(decomposition.singularValues()(k));
    if constexpr (Derivative<S>)
      for (std::size_t i = 0; i < A.rows(); ++i)
        for (std::size_t j = 0; j < A.cols(); ++j)
          value.v = value.v + A(i, j).v * (decomposition.matrixU()(static_cast<Eigen::Index>(i), k) *
                                           decomposition.matrixV()(static_cast<Eigen::Index>(j), k));
    return value;
  };
  const S maximum = singular(0), minimum = singular(decomposition.singularValues().size() - 1);
  return A.rows() >= A.cols() && value_of(maximum) > 0 ? S(minimum / maximum) : S(0.0);
}

/// Index of the coordinate that corresponds to a column of the matrix returned by included_columns().
std::size_t included_coordinate(const Model& model, std::size_t column) {
  return model.conditioning_coordinates.empty() ? column : model.conditioning_coordinates[column];
}
template <class S>
AxisMatrix<S> included_columns(const Model& model, const AxisMatrix<S>& J) {
  if (model.conditioning_coordinates.empty()) return J;
  AxisMatrix<S> found(J.rows(), model.conditioning_coordinates.size());
  for (std::size_t i = 0; i < found.rows(); ++i)
    for (std::size_t j = 0; j < found.cols(); ++j) found(i, j) = J(i, model.conditioning_coordinates[j]);
  return found;
}

template <class S>
bool is_positive(const std::optional<S>& length) {
  return length && value_of(*length) > 0 && std::isfinite(value_of(*length));
}

template <class S>
void check(const MechanismInfo& info, const CharacteristicLengths<S>& lengths) {
  const auto check_one = [](const char* key, bool is_needed, const std::optional<S>& length) {
    if (is_needed && length && !is_positive(length))
      throw DesignError(std::string("the conditioning is undefined: ") + key + " is " +
                        with_unit(value_of(*length), "m") + "; expected a positive length");
  };
  check_one("characteristic_length", mixes_units(info.coordinates), lengths.length);
  check_one("characteristic_radius", mixes_units(info.joints), lengths.radius);
}

template <class S>
bool is_equal(const S& x, const S& y) {
  if constexpr (Derivative<S>)
    return x.a == y.a && std::ranges::equal(x.v.d, y.v.d);
  else
    return x == y;
}
template <class S>
bool is_equal(const AxisMatrix<S>& A, const AxisMatrix<S>& B) {
  for (std::size_t i = 0; i < A.size(); ++i)
    if (!is_equal(A[i], B[i])) return false;
  return true;
}
template <class S>
bool has_equal_rotations(const Model& model, const Pose<S>& one, const Pose<S>& other) {
  for (std::size_t i = 0; i < one.size(); ++i)
    if (model.rotation_axes[i] && !is_equal(one[i], other[i])) return false;
  return true;
}

}  // namespace

void check_lengths(const Evaluation& evaluation, std::span<const double> parameters) {
  check(evaluation.model.info, characteristic_lengths(evaluation, parameters));
}

template <class S>
std::optional<S> conditioning_of(const Model& model, const CharacteristicLengths<S>& lengths, const Pose<S>& pose,
                                 const AxisMatrix<S>& J) {
  const MechanismInfo& info = model.info;
  const bool mixed = mixes_units(info.coordinates), mixed_drives = mixes_units(info.joints);
  if ((mixed && !is_positive(lengths.length)) || (mixed_drives && !is_positive(lengths.radius))) return {};
  AxisMatrix<S> scaled = included_columns<S>(model, AxisMatrix<S>(J * rates_by_twist<S>(model, pose)));
  for (std::size_t j = 0; mixed && j < scaled.cols(); ++j)
    if (info.coordinates[included_coordinate(model, j)].turns())
      for (std::size_t i = 0; i < scaled.rows(); ++i) scaled(i, j) /= *lengths.length;
  for (std::size_t i = 0; mixed_drives && i < scaled.rows(); ++i)
    if (info.joints[i].turns())
      for (std::size_t j = 0; j < scaled.cols(); ++j) scaled(i, j) *= *lengths.radius;
  for (std::size_t i = 0; i < scaled.size(); ++i)
    if (!std::isfinite(value_of(scaled[i]))) return {};
  return singular_ratio<S>(scaled);
}

template <class S>
S SampleConditioning::at(const Pose<S>& pose, ConditioningScratch<S>& scratch) const {
  batch_.run<S>(pose, scratch.registers);
  const Inputs& of = e_.model.inputs;
  AxisMatrix<S> J(of.joints, of.coordinates);
  for (std::size_t i = 0; i < J.size(); ++i) J[i] = scratch.registers[batch_.outputs()[i]];
  auto& last = scratch.last;
  if (last && is_equal(J, last->J) && has_equal_rotations(e_.model, pose, last->pose)) return last->conditioning;
  std::optional<S> found = conditioning_of<S>(e_.model, scratch.lengths, pose, J);
  if (!found || !std::isfinite(value_of(*found))) {
    check(e_.model.info, scratch.lengths);
    found = S(kConditioning.value_if_undefined);  // if J is infinite, the pose is singular
  }
  last = {pose, J, *found};
  return *found;
}

template std::optional<double> conditioning_of(const Model&, const CharacteristicLengths<double>&, const Pose<double>&,
                                               const AxisMatrix<double>&);
template double SampleConditioning::at(const Pose<double>&, ConditioningScratch<double>&) const;
template Dual4 SampleConditioning::at(const Pose<Dual4>&, ConditioningScratch<Dual4>&) const;

}  // namespace pkm::generic
