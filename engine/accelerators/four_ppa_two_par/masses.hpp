// 4PPa-2PaR: masses and inertias as functions of the geometry. Table: README.md, Masses.
#pragma once

#include <span>

#include "engine/accelerators/four_ppa_two_par/model.hpp"

namespace pkm::four_ppa_two_par {

/// Indices of the parameters that follow the lengths in a design.
enum MassIndex {
  kLambdaU = kParameters,
  kLambdaD,
  kLambdaS,
  kLambdaP,
  kJoints,  ///< mass m_c of the joints
  kKappa,
  kKappaP,
  kPayload,        ///< mass m_p of the payload
  kPayloadOffset,  ///< offset c_p of the payload
  kAllParameters
};

template <class S>
struct Masses {
  S slider, upper_bar, lower_bar, upper_connector, lower_connector, platform, payload;  ///< mass of each link [kg]
  S I_upper, I_lower;  ///< moment of inertia of a bar about an axis through its centre, normal to the bar [kg m^2]
  S I_platform;        ///< moment of inertia of the platform about its centre, for rotation about z [kg m^2]
  S c_payload;         ///< offset of the payload [m]
  std::array<double, 4> rotors{};  ///< inertia of drive trains at the sliders [kg], added to M_q only
};

/// Throws DesignError, with a sentence, if a mass or an inertia of a link is not positive.
void check_positive(const Masses<double>& b);

/// The masses and inertias of a design, checked by check_positive().
/// @param p  all parameters
template <class S>
Masses<S> masses(std::span<const S> p) {
  const Geometry<S> g = geometry(p);
  Masses<S> b;
  b.slider = p[kLambdaS] * (g.d_0 * 2.0 + g.d_u);
  b.upper_bar = p[kLambdaU] * g.l_u;
  b.lower_bar = p[kLambdaD] * g.l_d;
  b.upper_connector = p[kLambdaU] * g.d_u + p[kLambdaD] * g.d_d + p[kJoints];
  b.lower_connector = p[kLambdaD] * max(g.d, g.d_d) + p[kJoints];
  b.platform = p[kLambdaP] * g.a;
  b.payload = p[kPayload];
  b.I_upper = p[kKappa] * b.upper_bar * g.l_u * g.l_u * (1.0 / 12);
  b.I_lower = p[kKappa] * b.lower_bar * g.l_d * g.l_d * (1.0 / 12);
  b.I_platform = p[kKappaP] * b.platform * g.a * g.a * (1.0 / 12);
  b.c_payload = p[kPayloadOffset];
  const auto v = [](const S& x) { return value_of(x); };
  check_positive({v(b.slider), v(b.upper_bar), v(b.lower_bar), v(b.upper_connector), v(b.lower_connector),
                  v(b.platform), v(b.payload), v(b.I_upper), v(b.I_lower), v(b.I_platform), v(b.c_payload)});
  return b;
}

}  // namespace pkm::four_ppa_two_par
