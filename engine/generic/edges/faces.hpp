// Faces of bodies: implicit functions of a body, membership, normals, and the differential forms whose integrals along
// the boundary of a face are moments of its area.
#pragma once

#include <array>
#include <cstdint>

#include "engine/generic/edges/solid.hpp"

namespace pkm::generic::edges {

/// The faces of a slide or crank: the half spheres about both ends of the path of E, and the fold, which is a cylinder
/// or a torus. The other bodies have one face, `first`.
enum class Part : std::uint8_t { first, second, fold };

enum class Surface : std::uint8_t { plane, sphere, cylinder, torus };

/// The affine function v . p + k.
struct Affine {
  Vector3 v{};
  double k = 0;
};

/// A body with the vectors and affine functions from which its implicit functions are computed.
struct PreparedBody : Body {
  explicit PreparedBody(const Body& body);
  Vector3 beside{};                       ///< crank: axis x zero
  std::array<Vector3, 2> end{};           ///< slide, crank: E at both ends of the range
  std::array<Vector3, 2> along{};         ///< slide, crank: unit vector along the path of E there
  Affine height;                          ///< (p - centre) . axis; plane: p . axis
  Affine distance;                        ///< |p - centre|^2 + crank^2 - radius^2, less |p|^2
  std::array<Affine, 2> from_end, ahead;  ///< |p - E|^2 - rod^2, less |p|^2; (p - E) . along
};

struct Face {
  const PreparedBody* body;
  std::size_t number;  ///< index of the body
  Part part = Part::first;
  Surface surface = Surface::plane;
  Vector3 centre{};          ///< plane: the foot point of the origin
  double side = 1;           ///< 1: the outward normal points away from the centre (plane: along the axis)
  Vector3 away_from_pole{};  ///< sphere: opposite of the point where its form has a pole
};

/// Appends the faces of a body that are not empty.
void add_faces(const PreparedBody& body, std::size_t number, std::vector<Face>& faces);

/// A point p of a curve.
struct CurvePoint {
  Enclosure3 p;
  Enclosure square;  ///< |p|^2: for many curves tighter than the sum of the squares
};

/// The implicit functions of a body. Planes, spheres and cylinders have one, positive inside. Slides and cranks, with
/// the distance function g(q) = |p - E(q)|^2 - rod^2, have: 0, 1: g at both ends of the range; 2, 3: (p - E) . E' there
/// (E' of unit length); 4: the discriminant of g = 0, positive where q exists; 5: positive where a double root of g is
/// on the near side of the axis of a crank (slide: 1).
inline constexpr std::size_t kFunctions = 6;
Enclosure function(const PreparedBody& body, std::size_t number, const CurvePoint& at);
/// Degree of the function as a power of a length, for its rounding error.
std::size_t degree(const Body& body, std::size_t function);

/// Combinations of the signs of the functions, one bit each: bit c is the combination in which function i is positive
/// if bit i of c is set.
using SignSets = std::uint64_t;
/// Element i: the combinations in which function i is positive.
inline constexpr std::array<SignSets, kFunctions> kPositive{0xaaaaaaaaaaaaaaaa, 0xcccccccccccccccc, 0xf0f0f0f0f0f0f0f0,
                                                            0xff00ff00ff00ff00, 0xffff0000ffff0000, 0xffffffff00000000};

/// Whether a point belongs to a body or, if it lies on the surface of one of its faces, to that face.
struct Rule {
  SignSets holds = 0;
  /// By function: the combinations in which membership depends on its sign.
  std::array<SignSets, kFunctions> depends{};
};
/// The rule of a body, or of one of its faces.
/// @param face  null: the body
const Rule& membership(const Body& body, const Part* face);

/// A vector along the outward normal at a point of the face.
Vector3 outward(const Face& face, const Vector3& p);

/// Moments of the area of a face, with the outward normal n.
struct Moments {
  Vector3 normal{};                ///< integral of n
  Vector3 rotation{};              ///< integral of (p - centre) x n
  std::array<double, 2> radius{};  ///< integral of the normal speed as a radius grows: the radius or rod, and the crank
  void add(const Moments& other, double factor);
};
/// The integrands of the moments along an edge, to be integrated in the direction that has the face on its left.
Moments forms(const Face& face, const Vector3& p, const Vector3& dp);
/// The contribution of a face to three times the volume.
double three_volumes(const Face& face, const Moments& moments);

}  // namespace pkm::generic::edges
