// Volume of a solid bounded by planes, spheres, cylinders and tori, from integrals along its edges (README.md).
#pragma once

#include <memory>
#include <vector>

#include "engine/generic/edges/enclosure.hpp"

namespace pkm::generic::edges {

/// A set of points. The members that describe it depend on its kind; lengths in m, angles in rad.
struct Body {
  enum class Kind {
    plane,     ///< half-space axis . p <= radius
    sphere,    ///< ball about `centre`, or its outside
    cylinder,  ///< about the line through `centre` along `axis`, or its outside
    slide,     ///< reached by a rod whose other end E = centre + q axis slides with q in [from, to]
    crank      ///< reached by a rod whose other end E = centre + crank (cos q zero + sin q axis x zero)
  };
  Kind kind = Kind::plane;
  Vector3 centre{};
  Vector3 axis{};             ///< unit vector
  Vector3 zero{};             ///< crank: unit vector normal to `axis`, the direction of the crank at q = 0
  double radius = 0;          ///< plane: distance from the origin; slide, crank: length of the rod
  double crank = 0;           ///< length of the crank
  double from = 0, to = 0;    ///< range of q, for a crank of less than one revolution
  double side = 1;            ///< sphere, cylinder: 1: the inside, -1: the outside
  bool is_first_root = true;  ///< slide, crank: q is the smaller of the two values that assemble (branch "-")
};

/// Bodies whose intersection is the solid, and a bound on the distance of its points from the origin [m].
struct Solid {
  std::vector<Body> bodies;
  double bound = 0;
};

struct EdgeVolume {
  double value = 0;           ///< [m^3]
  double error = 0;           ///< estimate of the absolute error: quadrature, undecided intervals, gaps, rounding
  double gap = 0;             ///< maximum distance by which the directed edges of a face fail to close [m]
  bool is_supported = true;   ///< false: two faces are on the same surface
  bool is_closed = true;      ///< the edges of each face are closed to rounding errors, and no interval is undecided
  long boxes = 0, nodes = 0;  ///< intervals examined and quadrature nodes
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

/// The volume to a relative tolerance. It is valid only if it is supported and closed.
/// @param gradient  if not null, receives the derivative of the volume by each member of each body that is a number,
///                  for variations that keep unit vectors at unit length and `zero` normal to `axis`
EdgeVolume volume(const Solid& solid, double tolerance, VolumeScratch& scratch, std::vector<Body>* gradient = nullptr);

}  // namespace pkm::generic::edges
