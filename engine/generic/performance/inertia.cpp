// Effective mass and acceleration of the platform.
#include "engine/generic/performance/performance.hpp"

namespace pkm::generic {
namespace {

Term min(const Term& x, const Term& y) { return call(expression::operation("min"), x, y); }

/// Signed distance of the point `offset` from the nearer of the two faces with normal n of a zonotope { sum t_i w_i,
/// |t_i| <= 1 }; positive inside.
Term face_distance(const TermMatrix& W, const TermMatrix& offset, const std::vector<Term>& n) {
  const auto along = [&](const TermMatrix& A, std::size_t j) {
    Term sum = n[0] * A(0, j);
    for (std::size_t i = 1; i < A.rows(); ++i) sum = sum + n[i] * A(i, j);
    return abs(sum);
  };
  Term square = n[0] * n[0], support = along(W, 0) - along(offset, 0);
  for (std::size_t i = 1; i < n.size(); ++i) square = square + n[i] * n[i];
  for (std::size_t j = 1; j < W.columns(); ++j) support = support + along(W, j);
  // Two parallel vectors w_i and w_j do not span a face.
  expression::Graph& graph = W.graph();
  const expression::Node is_face = graph.apply(expression::operation(">"), std::array{square.node(), graph.number(0)});
  return {graph,
          graph.apply(expression::choice(), std::array{is_face, (support / sqrt(square)).node(), graph.number(1e300)})};
}

/// Normals, up to their signs, of all faces of a zonotope, which is a segment, a polygon or a solid.
std::vector<std::vector<Term>> face_normals(const TermMatrix& W) {
  std::vector<std::vector<Term>> normals;
  if (W.rows() == 1) return {{Term(W.graph(), 1.0)}};
  for (std::size_t i = 0; i < W.columns(); ++i) {
    if (W.rows() == 2) normals.push_back({-W(1, i), W(0, i)});
    for (std::size_t j = 0; W.rows() == 3 && j < i; ++j) {
      const limbs::Vector3 n = cross(limbs::Vector3{W(0, i), W(1, i), W(2, i)}, {W(0, j), W(1, j), W(2, j)});
      normals.push_back({n[0], n[1], n[2]});
    }
  }
  return normals;
}

}  // namespace

std::vector<NamedTerm> inertia_quantities(const FirstOrderKinematics& kinematics, const TermMatrix& M_X) {
  const TermMatrix& T = kinematics.translation;
  if (T.rows() == 0 || T.rows() > T.columns()) return {};
  const auto [adjugate, determinant] = inverse_of(M_X);
  const auto [least, greatest] = eigenvalue_range(T * adjugate * T.transposed());
  return {{"effective_mass", "kg", "maximum over all directions of the effective mass at the platform",
           determinant / least},
          {"effective_mass_ratio", "1", "minimum of the effective mass over all directions, divided by its maximum",
           least / greatest}};
}

std::optional<NamedTerm> acceleration_quantity(const FirstOrderKinematics& kinematics, const TermMatrix& M_X,
                                               const std::vector<Term>& G_X, const std::vector<Term>& peak) {
  const TermMatrix& T = kinematics.translation;
  if (T.rows() == 0) return {};
  const auto [adjugate, determinant] = inverse_of(M_X);
  const TermMatrix by_force = T * adjugate * (Term(M_X.graph(), 1.0) / determinant);
  TermMatrix forces = kinematics.J.transposed(), weight(M_X.graph(), G_X.size(), 1);
  for (std::size_t i = 0; i < forces.rows(); ++i) {
    weight(i, 0) = G_X[i];
    for (std::size_t j = 0; j < forces.columns(); ++j) forces(i, j) = forces(i, j) * peak[j];
  }
  const TermMatrix W = by_force * forces, offset = by_force * weight;
  const auto normals = face_normals(W);
  if (normals.empty()) return {};
  Term radius = face_distance(W, offset, normals[0]);
  for (std::size_t i = 1; i < normals.size(); ++i) radius = min(radius, face_distance(W, offset, normals[i]));
  return NamedTerm{"acceleration", "m/s^2", "acceleration of the platform that the drives reach in every direction",
                   radius};
}

}  // namespace pkm::generic
