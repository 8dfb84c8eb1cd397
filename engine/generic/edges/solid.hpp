// Volume of a solid bounded by planes, spheres, cylinders and tori, from integrals along its edges (README.md).
#pragma once

#include <memory>
#include <vector>

#include "engine/generic/edges/enclosure.hpp"

namespace pkm::generic::edges {

/// A set of points. Its kind determines which of the members describe it; lengths in m, angles in rad.
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
  Vector3 axis{};  ///< unit vector along the axis; plane: unit normal
  Vector3 zero{};  ///< crank: unit vector normal to `axis`, the direction of the crank at q = 0
  /// Radius of the surface; plane: signed distance from the origin; slide, crank: length of the rod.
  double radius = 0;
  double crank = 0;         ///< crank only: length of the crank
  double from = 0, to = 0;  ///< slide, crank: range of q; that of a crank is less than one revolution
  double side = 1;          ///< sphere, cylinder: 1: the body is the inside of the surface; -1: the outside
  /// Slide, crank: true: of the two q at which the rod reaches the point, take the smaller one (branch "-").
  bool is_first_root = true;
};

/// Bodies whose intersection is the solid, and an upper bound of the distance of its points from the origin [m].
struct Solid {
  std::vector<Body> bodies;
  double bound = 0;
};

struct EdgeVolume {
  double value = 0;  ///< volume [m^3]
  /// Estimate of the absolute error of the volume [m^3]: quadrature, undecided intervals, gaps and rounding errors.
  double error = 0;
  /// Largest component, over all faces, of the sum of the vectors along the edges of a face; 0 if they are closed [m].
  double gap = 0;
  bool is_supported = true;  ///< false: the method cannot compute the volume, because two faces are on the same surface
  /// true: the edges of each face are closed, and no interval is undecided, up to the square root of the rounding
  /// errors, which touching surfaces cause. Gaps and undecided intervals are part of the error.
  bool is_closed = true;
  long boxes = 0, nodes = 0;  ///< number of intervals that were examined, and number of quadrature nodes
};

/// Scratch memory of volume(); each thread needs its own.
class VolumeScratch {
 public:
  VolumeScratch();
  ~VolumeScratch();

 private:
  friend EdgeVolume volume(const Solid&, double, VolumeScratch&, std::vector<Body>*);
  std::unique_ptr<class Evaluator> evaluator_;
};

/// The volume of a solid. It is valid only if is_supported and is_closed are true.
/// @param tolerance  relative error of the volume that is accepted
/// @param gradient  if not null, receives for each body, in its members that are numbers, the derivatives of the volume
///                  with respect to these members; valid for changes that keep unit vectors at unit length and `zero`
///                  normal to `axis`
EdgeVolume volume(const Solid& solid, double tolerance, VolumeScratch& scratch, std::vector<Body>* gradient = nullptr);

}  // namespace pkm::generic::edges
