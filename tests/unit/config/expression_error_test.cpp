// Expressions of the program's own catalogues that are wrong, with the message verbatim.
#include <gtest/gtest.h>

#include "tests/unit/config/real_studies.hpp"

namespace pkm::testing {
namespace {

std::string entry_complaint(const std::string& entry) {
  return real_complaint(
      "[mechanism]\ntype = \"4ppa-2par\"\n[variables]\na = { min = 0.2, max = 0.4 }\n[[stage]]\noptimiser = "
      "\"ga\"\n" +
      entry);
}

const std::string kKnown =
    "expected one of a, b, l_u, l_d, d, L0, R_u, R_d, d_u, d_d, d_0, R_p, R_s, "
    "lambda_u, lambda_d, lambda_s, lambda_p, m_c, kappa, kappa_p, m_p, c_p, alpha_min, beta_min, beta_max, h_min, "
    "sin_par_min, cos_theta_min, clearance_min, size, volume, conditioning_mean, conditioning_min, dci_mean, "
    "dci_worst, "
    "velocity_transmission_mean, velocity_transmission_std, velocity_transmission_min, velocity_transmission_max, "
    "force_transmission_mean, force_transmission_std, force_transmission_min, force_transmission_max, "
    "angular_velocity_transmission_mean, angular_velocity_transmission_std, angular_velocity_transmission_min, "
    "angular_velocity_transmission_max, "
    "moment_transmission_mean, moment_transmission_std, moment_transmission_min, moment_transmission_max, "
    "effective_mass_mean, effective_mass_std, effective_mass_min, effective_mass_max, "
    "effective_mass_ratio_mean, effective_mass_ratio_std, effective_mass_ratio_min, effective_mass_ratio_max, "
    "section_type_mean, section_type_std, section_type_min, section_type_max, alpha_1_mean, alpha_1_std, "
    "alpha_1_min, alpha_1_max, alpha_2_mean, alpha_2_std, alpha_2_min, alpha_2_max, beta_1_mean, beta_1_std, "
    "beta_1_min, beta_1_max, beta_2_mean, beta_2_std, beta_2_min, beta_2_max, z_c_1_mean, z_c_1_std, z_c_1_min, "
    "z_c_1_max, z_c_2_mean, z_c_2_std, z_c_2_min, z_c_2_max, pi";
const std::string kObjective = "[[objective]]\ntype = \"expression\"\n";  // lines 7, 8

TEST(ExpressionErrors, Objectives) {
  const std::pair<std::string, std::string> cases[] = {
      {"", "s.toml:7: objective[1].expression: found nothing; expected text"},
      {"expression = 3", "s.toml:9: objective[1].expression: found 3; expected text"},
      {"expresion = \"a\"",
       "s.toml:9: objective[1].expresion: found an unknown key; expected one of type, name, direction, region, robust, "
       "expression, "
       "unit, characteristic_length, sharpness; did you mean 'expression'?"},
      {"expression = \"\"", "s.toml:7: objective[1]: the formula \"\" is empty"},
      {"expression = \"volum / b\"",
       "s.toml:7: objective[1]: the formula \"volum / b\" has the unknown name 'volum' at "
       "character 1; " +
           kKnown + "; did you mean 'volume'?"},
      {"expression = \"workspace_ratio\"",
       "s.toml:7: objective[1]: the formula \"workspace_ratio\" has the unknown name 'workspace_ratio' at character "
       "1; " +
           kKnown},
      {"expression = \"volume / (b\"",
       "s.toml:7: objective[1]: the formula \"volume / (b\" does not close the '(' at character 10"},
      {"expression = \"a = 3\"",
       "s.toml:7: objective[1]: the formula \"a = 3\" has a '=' at character 3; formulas "
       "have no assignment, compare with '=='"},
      {"expression = \"a\"\nunit = \"mm\"",
       "s.toml:7: objective[1]: the unit \"mm\" is not a product of SI units; expected "
       "one such as \"m^2 rad\", or \"1\""},
      {"expression = \"a\"\nunit = \"EUR\"",
       "s.toml:7: objective[1]: the unit \"EUR\" is not a product of SI units; "
       "expected one such as \"m^2 rad\", or \"1\""},
      {"expression = \"volume\"\ncharacteristic_length = 1",
       "s.toml:7: objective[1]: characteristic_length has no effect: the expression does not use the conditioning"},
      {"expression = \"conditioning_mean\"\nsharpness = 100",
       "s.toml:7: objective[1]: sharpness has no effect: the expression uses no worst case such as conditioning_min"},
      {"expression = \"conditioning_min\"\nsharpness = 0",
       "s.toml:10: objective[1].sharpness: found 0; expected a number in [1, 1e+06]"},
      {"expression = \"conditioning_mean\"\ncharacteristic_length = 0.1\n[[output]]\ntype = \"conditioning\"",
       "s.toml:11: output[1]: conditioning is requested with two different characteristic lengths; use one length in "
       "all tables"},
      {"expression = \"a\"\nmin = 1",
       "s.toml:10: objective[1].min: found an unknown key; expected one of type, name, "
       "direction, region, robust, expression, unit, characteristic_length, sharpness"},
      {"expression = \"conditioning_min\"\nsharpness = 100", "accepted"},
      {"expression = \"a\"\nunit = \"N m/rad\"", "accepted"},
  };
  for (const auto& [text, message] : cases) EXPECT_EQ(entry_complaint(kObjective + text), message) << text;
}

TEST(ExpressionErrors, Constraints) {
  const std::string head =
      "[[objective]]\ntype = \"workspace-volume\"\n[[constraint]]\ntype = \"expression\"\n";  // 7 to 10
  const std::pair<std::string, std::string> cases[] = {
      {"", "s.toml:9: constraint[1].expression: found nothing; expected text"},
      {"expression = \"a\"\nmin = 1\nmax = 2",
       "s.toml:9: constraint[1]: found both min and max; give one of them, and write a second [[constraint]] for the "
       "other"},
      {"expression = \"a\"\nmin = \"100 mm\"",
       "s.toml:12: constraint[1].min: found \"100 mm\"; expected a number, or text "
       "such as \"5 %\""},
      {"expression = \"a\"\nunit = \"m\"\nmin = \"1 rad\"",
       "s.toml:13: constraint[1].min: found \"1 rad\"; expected a number in m, or text with a unit made of um, mm, cm, "
       "dm, m, km, in, inch, ft"},
      {"expression = \"a\"\nunit = \"mm\"\nmin = 1",
       "s.toml:9: constraint[1]: the unit \"mm\" is not a product of SI units; "
       "expected one such as \"m^2 rad\", or \"1\""},
      {"expression = \"a +\"",
       "s.toml:9: constraint[1]: the formula \"a +\" ends where a number, a name or '(' is "
       "expected"},
      {"expression = \"a\"\nmx = 3",
       "s.toml:12: constraint[1].mx: found an unknown key; expected one of type, name, robust, expression, unit, "
       "characteristic_length, sharpness, min, max; did you mean 'max'?"},
      {"expression = \"a\"\n[[constraint]]\ntype = \"expression\"\nexpression = \"b\"",
       "s.toml:12: constraint[2]: the name 'expression' is already used; give this one another name with name = "
       "\"...\""},
      {"expression = \"conditioning_min\"\ncharacteristic_length = 0.1\n[[output]]\ntype = \"conditioning\"",
       "s.toml:13: output[1]: conditioning is requested with two different characteristic lengths; use one length in "
       "all tables"},
  };
  for (const auto& [text, message] : cases) EXPECT_EQ(entry_complaint(head + text), message) << text;
}

}  // namespace
}  // namespace pkm::testing
