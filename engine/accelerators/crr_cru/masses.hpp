// (3CRR/R)&CRU and Quadrupteron: masses and inertias, given as parameters or derived from the geometry.
//
// Source: the table of the paper (model.hpp), which interchanges the inertias of limbs 1 and 3; this is corrected here.
// The centre of mass of a rod is its midpoint, that of the moving platform is on the arm D-C_4 at the distance c from
// D, and that of the middle platform is N.
//
// Derived from the geometry (MassModel::geometry), with constants fitted to the paper's eight rods by least squares and
// to its platforms:
//   rods       m_ik = lambda l_ik + m_0,   I_ik = kappa m_ik l_ik^2 / 12
//   platforms  m_1 = density_1 pi r^2,   I_1zz = kappa_1 m_1 r^2   (middle)
//              m   = density l^2,        I_zz  = kappa_D m l^2,   c = share l   (moving)
#pragma once

#include <span>
#include <string>

#include "engine/accelerators/crr_cru/model.hpp"
#include "engine/core/error.hpp"

namespace pkm::crr_cru {

enum class MassModel { table, geometry };

/// Order of the parameters after the lengths: first the parameters that every mass model has, then those of the
/// selected mass model.
enum ExtraIndex { kSlideMass = kParameters, kPayload, kPayloadOffset, kRadii, kFirstOfModel = kRadii + 3 };
enum TableIndex {
  kRodMass = kFirstOfModel,    ///< first of the masses of the rods: m_11, m_12, m_21, .. m_42
  kRodInertia = kRodMass + 8,  ///< first of the moments of inertia of the rods: I_11, I_12, .. I_42
  kMass = kRodInertia + 8,     ///< mass m of the moving platform
  kInertia,                    ///< first of the moments of inertia of the moving platform: I_xx, I_yy, I_zz
  kMass1 = kInertia + 3,       ///< mass m_1 of the middle platform
  kInertia1,                   ///< first of the moments of inertia of the middle platform: I_1xx, I_1yy, I_1zz
  kCentre = kInertia1 + 3,     ///< distance c of the centre of mass of the moving platform from D
};
enum GeometryIndex {
  kLambda = kFirstOfModel,
  kM0,
  kKappa,
  kDensity1,
  kKappa1,
  kDensity,
  kKappaD,
  kShare,
};

template <class S>
struct Masses {
  std::array<S, 4> m_1, m_2;  ///< for each limb, mass of the rod at the slide and of the rod at the platform [kg]
  /// For each limb, moment of inertia of the rod at the slide and of the rod at the platform about an axis through the
  /// centre of the rod, normal to the plane of the limb [kg m^2].
  std::array<S, 4> I_1, I_2;
  /// Moving platform: mass [kg], moment of inertia about its centre [kg m^2], distance of the centre from D [m].
  S m, I_zz, c;
  S m_middle, I_middle;            ///< middle platform: mass m_1 [kg] and moment of inertia I_1zz [kg m^2]
  S slide;                         ///< mass of one slide [kg]
  S payload, c_payload;            ///< point mass on the line from D to C_4 [kg], and its distance from D [m]
  std::array<double, 4> rotors{};  ///< inertia of the drive train at each joint [kg], which is added to M_q only
};

/// Reads the masses from the parameters. Throws DesignError, with a sentence, if a mass or an inertia is not positive.
template <class S>
Masses<S> masses(MassModel model, std::span<const S> p) {
  Masses<S> b;
  const bool table = model == MassModel::table;
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t k = 0; k < 2; ++k) {
      const std::size_t rod = 2 * i + k;
      const S& l = p[kL11 + rod];
      S& m = (k == 0 ? b.m_1 : b.m_2)[i];
      S& I = (k == 0 ? b.I_1 : b.I_2)[i];
      m = table ? p[kRodMass + rod] : S(p[kLambda] * l + p[kM0]);
      I = table ? p[kRodInertia + rod] : S(p[kKappa] * m * l * l * (1.0 / 12));
      if (value_of(m) > 0 && value_of(I) > 0) continue;
      const std::string name = std::to_string(i + 1) + std::to_string(k + 1);
      throw DesignError("rod " + name + " has no positive mass and inertia (m_" + name + " = " +
                        std::to_string(value_of(m)) + " kg)");
    }
  const S r2 = p[kR] * p[kR], l2 = p[kL] * p[kL];
  b.m = table ? p[kMass] : S(p[kDensity] * l2);
  b.I_zz = table ? p[kInertia + 2] : S(p[kKappaD] * b.m * l2);
  b.c = table ? p[kCentre] : S(p[kShare] * p[kL]);
  b.m_middle = table ? p[kMass1] : S(p[kDensity1] * r2 * kPi);
  b.I_middle = table ? p[kInertia1 + 2] : S(p[kKappa1] * b.m_middle * r2);
  b.slide = p[kSlideMass];
  b.payload = p[kPayload];
  b.c_payload = p[kPayloadOffset];
  return b;
}

}  // namespace pkm::crr_cru
