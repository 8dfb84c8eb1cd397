// Faces of bodies: implicit functions of a body, membership, normals, and the differential forms whose integrals along
// the boundary of a face are moments of its area.
#pragma once

#include <array>
#include <cstdint>

#include "engine/generic/edges/solid.hpp"

namespace pkm::generic::edges {

/// The faces of a body. A slide or crank has the half spheres about the first and the last point of the path of E, and
/// the fold, which is a cylinder or a torus. All other bodies have one face, `first`.
enum class Part : std::uint8_t { first, second, fold };

enum class Surface : std::uint8_t { plane, sphere, cylinder, torus };

/// The affine function v . p + k of a point p.
struct Affine {
  Vector3 v{};
  double k = 0;
};

/// A body with the vectors and affine functions from which its implicit functions are computed.
struct PreparedBody : Body {
  explicit PreparedBody(const Body& body);
  Vector3 beside{};                ///< crank only: the unit vector axis x zero
  std::array<Vector3, 2> end{};    ///< slide, crank: the point E at q = from, and at q = to
  std::array<Vector3, 2> along{};  ///< slide, crank: unit vectors along the path of E at these two points
  Affine height;                   ///< (p - centre) . axis; for a plane, p . axis
  Affine distance;                 ///< |p - centre|^2 + crank^2 - radius^2 without its term |p|^2
  /// At each of the two points E: |p - E|^2 - rod^2 without its term |p|^2, and (p - E) . along.
  std::array<Affine, 2> from_end, ahead;
};

struct Face {
  const PreparedBody* body;
  std::size_t number;  ///< index of the body to which the face belongs
  Part part = Part::first;
  Surface surface = Surface::plane;
  Vector3 centre{};  ///< centre of the surface; for a plane, its point that is closest to the origin
  /// 1: the outward normal points away from the centre (of a plane: along the axis); -1: the opposite direction.
  double side = 1;
  Vector3 away_from_pole{};  ///< sphere only: direction from the pole of its differential form to the centre
};

/// Appends the faces of a body that are not empty. @param number  index of the body
void add_faces(const PreparedBody& body, std::size_t number, std::vector<Face>& faces);

/// A point p of a curve.
struct CurvePoint {
  Enclosure3 p;
  Enclosure square;  ///< |p|^2; for many curves a tighter enclosure than the sum of the squares
};

/// The implicit functions of a body. Planes, spheres and cylinders have one, positive inside. Slides and cranks, with
/// the distance function g(q) = |p - E(q)|^2 - rod^2, have: 0, 1: g at both ends of the range; 2, 3: (p - E) . E' there
/// (E' of unit length); 4: the discriminant of g = 0, positive where q exists; 5: positive where a double root of g is
/// on the near side of the axis of a crank (slide: 1).
inline constexpr std::size_t kFunctions = 6;
Enclosure function(const PreparedBody& body, std::size_t number, const CurvePoint& at);
/// Exponent of the unit of length in the unit of a function, from which its rounding error is estimated.
std::size_t degree(const Body& body, std::size_t function);

/// Set of combinations of the signs of a body's functions. Combination c, in which function i is positive if bit i of c
/// is set, is in the set if bit c is set.
using SignSets = std::uint64_t;
/// kPositive[i]: the set of combinations in which function i is positive.
inline constexpr std::array<SignSets, kFunctions> kPositive{0xaaaaaaaaaaaaaaaa, 0xcccccccccccccccc, 0xf0f0f0f0f0f0f0f0,
                                                            0xff00ff00ff00ff00, 0xffff0000ffff0000, 0xffffffff00000000};

/// Decides whether a point belongs to a body, or, if the point lies on the surface of one of its faces, to that face.
/// `holds` is the set of combinations of signs in which it does.
struct Rule {
  SignSets holds = 0;
  /// For each function, the combinations in which membership depends on the sign of this function.
  std::array<SignSets, kFunctions> depends{};
};
/// The rule of a body, or of one of its faces.
/// @param face  part of the body's boundary; null: the body itself
const Rule& membership(const Body& body, const Part* face);

/// A vector in the direction of the outward normal at a point of the face; its length is arbitrary.
Vector3 outward(const Face& face, const Vector3& p);

/// Integrals over the area of a face with the unit outward normal n.
struct Moments {
  Vector3 normal{};    ///< integral of n
  Vector3 rotation{};  ///< integral of (p - centre) x n
  /// Integrals of the normal speed of the face as a radius grows: [0] the radius or the rod, [1] the crank.
  std::array<double, 2> radius{};
  void add(const Moments& other, double factor);
};
/// The integrands of the moments along an edge, to be integrated in the direction that has the face on its left.
Moments forms(const Face& face, const Vector3& p, const Vector3& dp);
/// The contribution of a face to three times the volume of the solid.
double three_volumes(const Face& face, const Moments& moments);

}  // namespace pkm::generic::edges
