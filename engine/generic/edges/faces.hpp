// Faces of bodies: implicit functions of a body, membership, normals, and the differential forms whose integrals along
// the boundary of a face are moments of its area.
#pragma once

#include <array>
#include <cstdint>

#include "engine/generic/edges/solid.hpp"

namespace pkm::generic::edges {

/// The parts of a body's boundary. A slide or crank has half spheres about the first and the last point of the path of
/// the rod's end E, and the fold, a cylinder or torus around this path. All other bodies have one part, `first`.
enum class Part : std::uint8_t { first, second, fold };

enum class Surface : std::uint8_t { plane, sphere, cylinder, torus };

/// The affine function v . p + k of a point p.
struct Affine {
  Vector3 v{};
  double k = 0;
};

/// A body with vectors and affine functions of a point p, from which its implicit functions (see function()) are
/// computed.
struct PreparedBody : Body {
  explicit PreparedBody(const Body& body);
  Vector3 beside{};                ///< crank only: the unit vector axis x zero
  std::array<Vector3, 2> end{};    ///< slide, crank: the rod's end E at q = from, and at q = to
  std::array<Vector3, 2> along{};  ///< slide, crank: unit vectors along the path of E at q = from, and at q = to
  Affine height;                   ///< (p - centre) . axis as a function of the point p; for a plane, p . axis
  Affine distance;  ///< |p - centre|^2 + crank^2 - radius^2 without its term |p|^2, as a function of the point p
  /// For the rod's end E at q = from, and at q = to: |p - E|^2 - rod^2 without its term |p|^2; and (p - E) . along.
  std::array<Affine, 2> from_end, ahead;
};

struct Face {
  const PreparedBody* body;
  std::size_t number;  ///< index of the face's body
  Part part = Part::first;
  Surface surface = Surface::plane;
  Vector3 centre{};  ///< centre of the surface; for a plane, its point that is closest to the origin
  /// 1: the outward normal points away from the centre (of a plane: along the axis); -1: the opposite direction.
  double side = 1;
  /// Sphere only: unit vector from the point at which its differential form (see forms()) is singular, to the centre.
  Vector3 away_from_pole{};
};

/// Appends those faces of a body that are not empty to `faces`. @param number  index of the body
void add_faces(const PreparedBody& body, std::size_t number, std::vector<Face>& faces);

/// Enclosure of a point p of a curve.
struct CurvePoint {
  Enclosure3 p;
  Enclosure square;  ///< |p|^2; for many curves a tighter enclosure than the sum of the squares
};

/// Number of implicit functions of a body; function() returns the value of the one with index `number` at a point p.
/// Planes, spheres and cylinders have one function, which is positive inside. Slides and cranks have six, with the
/// distance function g(q) = |p - E(q)|^2 - rod^2: 0 and 1: g at q = from and at q = to; 2 and 3: (p - E) . E' there,
/// where E' has unit length; 4: the discriminant of g = 0, positive where a root q exists; 5: positive where a double
/// root of g is on the near side of the axis of a crank (slide: 1).
inline constexpr std::size_t kFunctions = 6;
Enclosure function(const PreparedBody& body, std::size_t number, const CurvePoint& at);
/// The power of the unit of length in the unit of a body's function (see function()); the rounding error of the
/// function is estimated from this power.
std::size_t degree(const Body& body, std::size_t function);

/// Set of combinations of the signs of a body's functions (see function()). In combination c, function i is positive if
/// bit i of c is set; the set contains combination c if bit c of the set is 1.
using SignSets = std::uint64_t;
/// kPositive[i]: the set of all combinations in which function i is positive.
inline constexpr std::array<SignSets, kFunctions> kPositive{0xaaaaaaaaaaaaaaaa, 0xcccccccccccccccc, 0xf0f0f0f0f0f0f0f0,
                                                            0xff00ff00ff00ff00, 0xffff0000ffff0000, 0xffffffff00000000};

/// Decides by the signs of a body's functions whether a point belongs to the body or, if the point lies on the surface
/// of one of its faces, to that face: it does if `holds` contains the combination of signs.
struct Rule {
  SignSets holds = 0;
  /// depends[i]: the combinations of signs in which the answer would change if function i had the opposite sign.
  std::array<SignSets, kFunctions> depends{};
};
/// The rule of a body, or of one of its faces.
/// @param face  part of the body's boundary; null: the body itself
const Rule& membership(const Body& body, const Part* face);

/// A vector in the direction of the outward normal at a point of the face; its length is arbitrary.
Vector3 outward(const Face& face, const Vector3& p);

/// Integrals over the area of a face, or of part of it; n is the unit outward normal, p the point.
struct Moments {
  Vector3 normal{};    ///< integral of the unit normal n over the area
  Vector3 rotation{};  ///< integral of (p - centre) x n over the area
  /// Integrals of the speed with which the face moves along n as a radius grows with speed 1: [0] the radius or the
  /// rod, [1] the crank.
  std::array<double, 2> radius{};
  void add(const Moments& other, double factor);
};
/// The integrands of the moments of a face along an edge that bounds it. They are to be integrated in the direction in
/// which the face is on the left. @param dp  derivative of the point p with respect to the parameter of the edge
Moments forms(const Face& face, const Vector3& p, const Vector3& dp);
/// The contribution of a face to three times the volume of the solid.
double three_volumes(const Face& face, const Moments& moments);

}  // namespace pkm::generic::edges
