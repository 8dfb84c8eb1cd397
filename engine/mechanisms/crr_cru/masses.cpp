#include "engine/mechanisms/crr_cru/masses.hpp"

namespace pkm::crr_cru {
namespace {

constexpr double kMostMass = 1e4, kMostInertia = 1e6, kLeast = 1e-12;

std::vector<Parameter> table_parameters() {
  const double mass[8] = {0.132, 0.200, 0.186, 0.183, 0.175, 0.145, 0.129, 0.195};
  const double inertia[8] = {2.66183e-4, 6.20835e-4, 7.50119e-4, 4.80121e-4,
                             6.31628e-4, 2.61420e-4, 2.40582e-4, 6.85402e-4};
  std::vector<Parameter> list;
  const auto rod = [](std::size_t k) { return std::to_string(k / 2 + 1) + std::to_string(k % 2 + 1); };
  for (std::size_t k = 0; k < 8; ++k)
    list.push_back({"m_" + rod(k), "kg", mass[k], kLeast, kMostMass, "mass of rod " + rod(k)});
  for (std::size_t k = 0; k < 8; ++k)
    list.push_back({"I_" + rod(k), "kg m^2", inertia[k], kLeast, kMostInertia,
                    "inertia of rod " + rod(k) + " about its centre and its limb's rail"});
  const std::string own = " about its own centre of mass", no_effect = " (of no effect: it turns about z alone)";
  list.insert(list.end(),
              {{"m", "kg", 0.081, kLeast, kMostMass, "mass of the moving platform"},
               {"I_xx", "kg m^2", 2.1551e-5, kLeast, kMostInertia, "inertia of the moving platform" + own + no_effect},
               {"I_yy", "kg m^2", 2.5092e-5, kLeast, kMostInertia, "inertia of the moving platform" + own + no_effect},
               {"I_zz", "kg m^2", 4.4108e-5, kLeast, kMostInertia, "inertia of the moving platform" + own},
               {"m_1", "kg", 0.106, kLeast, kMostMass, "mass of the middle platform (centre N)"},
               {"I_1xx", "kg m^2", 3.3760e-5, kLeast, kMostInertia, "inertia of the middle platform" + no_effect},
               {"I_1yy", "kg m^2", 2.6059e-5, kLeast, kMostInertia, "inertia of the middle platform" + no_effect},
               {"I_1zz", "kg m^2", 1.2493e-5, kLeast, kMostInertia,
                "inertia of the middle platform; counts where it turns with the moving one"},
               {"c", "m", 0.0335, -100, 100, "distance of the moving platform's centre of mass from D, towards C_4"}});
  return list;
}

std::vector<Parameter> geometry_parameters() {
  return {{"lambda", "kg/m", 0.956353, 0, 1e4, "mass of a rod per length: m_ik = lambda l_ik + m_0"},
          {"m_0", "kg", -0.0268514, -1e3, 1e3, "mass of a rod that does not depend on its length (fitted, may be < 0)"},
          {"kappa", "1", 0.796114, 1e-6, 3, "I_ik = kappa m_ik l_ik^2 / 12: 1 is a uniform rod"},
          {"density_1", "kg/m^2", 21.0881, kLeast, 1e6, "middle platform: m_1 = density_1 pi r^2"},
          {"kappa_1", "1", 0.0736616, 1e-6, 1, "middle platform: I_1zz = kappa_1 m_1 r^2"},
          {"density", "kg/m^2", 18.0441, kLeast, 1e6, "moving platform: m = density l^2"},
          {"kappa_D", "1", 0.121307, 1e-6, 1, "moving platform: I_zz = kappa_D m l^2"},
          {"share", "1", 0.5, -1, 2, "moving platform: its centre of mass is share l from D"}};
}

}  // namespace

std::vector<Parameter> mass_parameters(MassModel model) {
  std::vector<Parameter> list = model == MassModel::table ? table_parameters() : geometry_parameters();
  list.insert(list.end(), {{"m_s", "kg", 0, 0, kMostMass, "mass of each slide"},
                           {"m_p", "kg", 0, 0, kMostMass, "payload, a point mass on the moving platform"},
                           {"c_p", "m", 0, -100, 100, "distance of the payload from D, towards C_4"},
                           // radii of the links (links.hpp), last in every mass model
                           {"R_r", "m", 0.010, 0, 1, "radius of the rods as capsules"},
                           {"R_p", "m", 0.010, 0, 1, "radius of the platforms' arms as capsules"},
                           {"R_s", "m", 0.010, 0, 1, "radius of the rails with their slides as capsules"}});
  return list;
}

}  // namespace pkm::crr_cru
