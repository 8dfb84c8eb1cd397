#include "engine/accelerators/four_ppa_two_par/masses.hpp"

#include <cstdio>
#include <string>

#include "engine/core/error.hpp"

namespace pkm::four_ppa_two_par {
namespace {

void check(const char* link, const char* quantity, double value, const char* unit, const char* formula) {
  if (value > 0) return;
  char text[200];
  std::snprintf(text, sizeof text, "%s no positive %s: %s = %g %s", link, quantity, formula, value, unit);
  throw DesignError(text);
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

}  // namespace pkm::four_ppa_two_par
