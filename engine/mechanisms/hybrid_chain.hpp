// Hybrid robot: the auxiliary R-U-P-U-R chain that turns the tool.
//
// The input shaft stands on the carriage along Z', the output shaft on the platform along Z''; between their universal
// joints F1 = (0, f, h1) and F3 = (x, f' cos b + h2 sin b, z + f' sin b - h2 cos b) runs a telescopic shaft along w.
// The two joints are bent by phi1 and phi2:
//
//   w = F3 - F1,   Q = w.Z' = |w| cos phi1,   P = w.Z'' = |w| cos phi2,   T = x sin b
//
// Source: hybrid-robot document, section 5; relation (27) of the paper is the special case T = 0.
#pragma once

#include "engine/mechanisms/hybrid.hpp"
#include "engine/model/capsule.hpp"

namespace pkm::hybrid {

template <class S>
struct Shaft {
  Point3<S> F1, F3;  ///< its universal joints, in O' [m]
  Point3<S> w;       ///< F3 - F1 [m]
  S length;          ///< |w| [m]
  S P, Q, T;         ///< [m]
  S cos_phi1, cos_phi2;
};

template <class S>
Shaft<S> shaft(const Geometry<S>& g, const Pose<S>& pose) {
  const auto [sin_b, cos_b] = sincos(pose.angle);
  const S &x = pose.x, &z = pose.z, zero(0.0);
  Shaft<S> s;
  s.F1 = {zero, g.f, g.h1};
  s.F3 = {x, g.fp * cos_b + g.h2 * sin_b, z + g.fp * sin_b - g.h2 * cos_b};
  s.w = difference(s.F3, s.F1);
  s.length = root_or_zero(dot(s.w, s.w));
  s.Q = s.w[2];
  s.P = (z - g.h1) * cos_b + g.f * sin_b - g.h2;
  s.T = x * sin_b;
  const bool point = !(value_of(s.length) > 0);  // F1 = F3: no axis, bent by a right angle
  s.cos_phi1 = point ? zero : S(s.Q / s.length);
  s.cos_phi2 = point ? zero : S(s.P / s.length);
  return s;
}

}  // namespace pkm::hybrid
