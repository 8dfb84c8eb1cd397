#include "engine/mechanisms/four_ppa_two_par/masses.hpp"

#include <cstdio>
#include <stdexcept>
#include <string>

namespace pkm::four_ppa_two_par {
namespace {

constexpr double kMostPerLength = 1e4, kMostMass = 1e4;
constexpr double kRod10 = 0.848, kRod20 = 3.393;  // solid aluminium of 10 mm and 20 mm radius [kg/m]

void check(const char* link, const char* quantity, double value, const char* unit, const char* formula) {
  if (value > 0) return;
  char text[200];
  std::snprintf(text, sizeof text, "%s no positive %s: %s = %g %s", link, quantity, formula, value, unit);
  throw std::domain_error(text);
}

}  // namespace

void check_positive(const Masses<double>& b) {
  check("the sliders have", "mass", b.slider, "kg", "lambda_s (2 d_0 + d_u)");
  check("the upper bars have", "mass", b.upper_bar, "kg", "lambda_u l_u");
  check("the lower bars have", "mass", b.lower_bar, "kg", "lambda_d l_d");
  check("the upper connectors have", "mass", b.upper_connector, "kg", "lambda_u d_u + lambda_d d_d + m_c");
  check("the lower connectors have", "mass", b.lower_connector, "kg", "lambda_d max(d, d_d) + m_c");
  check("the platform has", "mass", b.platform, "kg", "lambda_p a");
  check("the upper bars have", "inertia", b.I_upper, "kg m^2", "kappa lambda_u l_u^3 / 12");
  check("the lower bars have", "inertia", b.I_lower, "kg m^2", "kappa lambda_d l_d^3 / 12");
  check("the platform has", "inertia", b.I_platform, "kg m^2", "kappa_p lambda_p a^3 / 12");
}

std::vector<Parameter> mass_parameters() {
  return {
      {"lambda_u", "kg/m", kRod10, 0, kMostPerLength, "mass per length of the upper bars: lambda_u l_u each"},
      {"lambda_d", "kg/m", kRod10, 0, kMostPerLength, "mass per length of the lower bars: lambda_d l_d each"},
      {"lambda_s", "kg/m", kRod20, 0, kMostPerLength, "mass per length of the sliders: lambda_s (2 d_0 + d_u) each"},
      {"lambda_p", "kg/m", kRod20, 0, kMostPerLength, "mass per length of the platform: lambda_p a"},
      {"m_c", "kg", 0.1, 0, kMostMass,
       "mass of the joints in each connector; upper ones have lambda_u d_u + lambda_d d_d, lower ones lambda_d max(d, "
       "d_d) besides"},
      {"kappa", "1", 1, 1e-6, 3, "inertia of a bar is kappa m l^2 / 12: 1 is a uniform rod"},
      {"kappa_p", "1", 1, 1e-6, 100,
       "inertia of the platform about z is kappa_p lambda_p a^3 / 12: 1 is a uniform rod"},
      {"m_p", "kg", 0, 0, kMostMass, "payload, a point mass on the platform"},
      {"c_p", "m", 0, -100, 100, "distance of the payload from the platform's centre, towards P_2"},
  };
}

}  // namespace pkm::four_ppa_two_par
