// Stiffness of the platform, and its lowest natural frequency.
#include <numbers>

#include "engine/generic/performance/performance.hpp"

namespace pkm::generic {
namespace {

/// The compliance matrix of the platform, in its coordinates, as numerator / denominator. At singular poses the
/// denominator is 0, so that the stiffness, denominator * numerator^-1, is 0 there instead of undefined.
struct Compliance {
  TermMatrix numerator;
  Term denominator;
};

Compliance compliance_of(const std::vector<LimbSpring>& springs) {
  const std::size_t n = springs.front().row.size();
  TermMatrix A(springs.front().compliance.graph(), springs.size(), n);
  for (std::size_t i = 0; i < springs.size(); ++i)
    for (std::size_t j = 0; j < n; ++j) A(i, j) = springs[i].row[j];
  if (springs.size() == n) {
    const expression::Inverse inverse = inverse_of(A);
    TermMatrix scaled = inverse.adjugate;
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j) scaled(i, j) = scaled(i, j) * springs[j].compliance;
    return {scaled * inverse.adjugate.transposed(), inverse.determinant * inverse.determinant};
  }
  TermMatrix scaled = A;
  for (std::size_t i = 0; i < springs.size(); ++i)
    for (std::size_t j = 0; j < n; ++j) scaled(i, j) = A(i, j) / springs[i].compliance;
  const expression::Inverse inverse = inverse_of(A.transposed() * scaled);
  return {inverse.adjugate, inverse.determinant};
}

}  // namespace

std::vector<NamedTerm> stiffness_quantities(const FirstOrderKinematics& kinematics,
                                            const std::vector<LimbSpring>& springs,
                                            const std::optional<TermMatrix>& M_X) {
  const Compliance C = compliance_of(springs);
  std::vector<NamedTerm> found;
  const auto add = [&](const TermMatrix& T, const std::string& name, const std::string& unit, const std::string& text) {
    if (T.rows() > 0)
      found.push_back({name, unit, text, C.denominator / eigenvalue_range(T * C.numerator * T.transposed())[1]});
  };
  add(kinematics.translation, "stiffness", "N/m", "minimum over all directions of force by deflection");
  add(kinematics.rotation, "rotational_stiffness", "N m/rad", "minimum over all directions of moment by rotation");
  if (M_X) {
    const TermMatrix L = cholesky_factor(*M_X);
    const Term omega = sqrt(C.denominator / greatest_eigenvalue(L.transposed() * C.numerator * L));
    found.push_back({"natural_frequency", "Hz", "lowest natural frequency", omega / (2 * std::numbers::pi)});
  }
  return found;
}

}  // namespace pkm::generic
