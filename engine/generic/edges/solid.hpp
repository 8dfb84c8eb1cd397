// Volume of a solid bounded by planes, spheres, cylinders and tori, from integrals along its edges (README.md).
#pragma once

#include <memory>
#include <vector>

#include "engine/generic/edges/enclosure.hpp"

namespace pkm::generic::edges {

/// A set of points, described by the members that its kind needs; lengths in m, angles in rad.
struct Body {
  enum class Kind {
    plane,     ///< half-space axis . p <= radius
    sphere,    ///< ball about `centre`, or its complement
    cylinder,  ///< cylinder about the line through `centre` along `axis`, or its complement
    slide,     ///< points reached by a rod whose other end is E = centre + q axis, q in [from, to]
    crank      ///< points reached by a rod whose other end is E = centre + crank (cos q zero + sin q axis x zero)
  };
  Kind kind = Kind::plane;
  Vector3 centre{};
  Vector3 axis{};             ///< unit vector of the axis, or of the normal of a plane
  Vector3 zero{};             ///< crank: unit vector normal to `axis`, the direction of the crank at q = 0
  double radius = 0;          ///< radius; plane: signed distance from the origin; slide, crank: length of the rod
  double crank = 0;           ///< crank only: length of the crank
  double from = 0, to = 0;    ///< slide, crank: range of q; that of a crank is less than one revolution
  double side = 1;            ///< sphere, cylinder: 1: the inside, -1: the outside
  bool is_first_root = true;  ///< slide, crank: true if q is the smaller of the two values that assemble (branch "-")
};

/// Bodies whose intersection is the solid, and an upper bound of the distance of its points from the origin [m].
struct Solid {
  std::vector<Body> bodies;
  double bound = 0;
};

struct EdgeVolume {
  double value = 0;  ///< volume [m^3]
  /// Estimate of the absolute error [m^3]: quadrature, undecided intervals, gaps and rounding errors.
  double error = 0;
  double gap = 0;            ///< maximum distance by which the directed edges of a face fail to close [m]
  bool is_supported = true;  ///< false: two faces are on the same surface
  /// true: the edges of each face are closed up to rounding errors, and no interval is undecided.
  bool is_closed = true;
  long boxes = 0, nodes = 0;  ///< number of examined intervals, and number of quadrature nodes
};

/// Scratch memory of volume(), of one thread.
class VolumeScratch {
 public:
  VolumeScratch();
  ~VolumeScratch();

 private:
  friend EdgeVolume volume(const Solid&, double, VolumeScratch&, std::vector<Body>*);
  std::unique_ptr<class Evaluator> evaluator_;
};

/// The volume to a relative tolerance. It is valid only if is_supported and is_closed are true.
/// @param gradient  if not null, receives the derivative of the volume by each member of each body that is a number,
///                  for variations that keep unit vectors at unit length and `zero` normal to `axis`
EdgeVolume volume(const Solid& solid, double tolerance, VolumeScratch& scratch, std::vector<Body>* gradient = nullptr);

}  // namespace pkm::generic::edges
