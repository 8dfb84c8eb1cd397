#include "engine/mechanisms/hybrid/model.hpp"

namespace pkm::hybrid {

std::vector<Parameter> parameters() {
  constexpr double kShort = 1e-3, kLong = 100;     // [m]
  constexpr double kFlat = 1e-3, kUpright = 1.57;  // [rad], inside (0, pi/2)
  const auto radius = [](const char* name, double nominal, const std::string& link) {
    return Parameter{name, "m", nominal, 0, 1, "radius of " + link + " as a capsule"};
  };
  std::vector<Parameter> list = {
      {"a", "m", 0.100, 0, kLong, "half the distance of the platform's joints A', B'"},
      {"b1", "m", 0.15025, -kLong, kLong, "carriage A is at x' = -b1 where s1 = 0"},
      {"b2", "m", 0.15025, -kLong, kLong, "carriage B is at x' = b2 where s3 = 0"},
      {"c", "m", 0.10308, -kLong, kLong, "carriage C is at x' = c where s4 = 0"},
      {"d", "m", 0.200, 0, kLong, "distance of the rail of C from that of A and B"},
      {"e", "m", 0.150, kShort, kLong, "distance of the platform's joint C' from the line A'B'"},
      {"L1", "m", 0.255, kShort, kLong, "length of link A"},
      {"L2", "m", 0.255, kShort, kLong, "length of link B"},
      {"L3", "m", 0.275, kShort, kLong, "length of link C"},
      {"f", "m", 0.100, kShort, kLong, "the input shaft of the auxiliary chain stands at y' = f (printed ee)"},
      {"fp", "m", 0.080, kShort, kLong, "its output shaft at y'' = f' on the platform (printed ee')"},
      {"h1", "m", 0, -kLong, kLong, "height of its first universal joint above the base"},
      {"h2", "m", 0, -kLong, kLong, "depth of its second one below the platform"},
      {"theta0", "rad", 0, -kPi, kPi, "phase of the fork arms, from Y' and Y''"},
  };
  const char* const carriage[4] = {"A (s1)", "E (s2)", "B (s3)", "C (s4)"};
  const double stroke[4] = {0.150, 0.200, 0.150, 0.150};
  for (const bool least : {true, false})
    for (std::size_t i = 0; i < 4; ++i)
      list.push_back({(least ? "s_min_" : "s_max_") + std::to_string(i + 1), "m", least ? -stroke[i] : stroke[i],
                      -kLong, kLong,
                      std::string(least ? "least" : "greatest") + " position of carriage " + carriage[i]});
  list.insert(list.end(),
              {{"z_clear", "m", 0.100, 0, kLong, "least height of O'' and C' above the base"},
               {"beta_min", "rad", -0.6, -kUpright, kUpright, "least beta"},
               {"beta_max", "rad", 0.6, -kUpright, kUpright, "greatest beta"},
               {"tau_s", "1", 0.10, 1e-6, 1, "least |n_i| / L_i: distance from serial singularities"},
               {"tau_p", "1", 0.15, 0, 1,
                "least sine of the angle of links A and B, least N2 / (e L3): parallel singularities"},
               {"tau_c", "1", 0.05, 1e-6, 1, "least |sin(lambda)|: distance from the constraint singularity"},
               {"psiA_max", "rad", 1.25, kFlat, kUpright, "greatest inclination of links A and B from Z'"},
               {"psiC_max", "rad", 1.00, kFlat, kUpright, "greatest inner angle of the universal joints of limb C"},
               {"lam_max", "rad", 0.90, kFlat, kUpright, "greatest outer angle of the universal joint at C''"},
               {"mu_max", "rad", 0.90, kFlat, kUpright, "greatest outer angle of the universal joint at C'"},
               {"gap", "m", 0.080, -kLong, kLong, "least distance of carriage B from carriage A"},
               {"phi_max", "rad", 0.70, kFlat, kUpright, "greatest bend of the auxiliary chain's universal joints"},
               {"lw_min", "m", 0.160, 0, kLong, "least length of its telescopic shaft"},
               {"lw_max", "m", 0.300, kShort, kLong, "greatest length of its telescopic shaft"},
               radius("rA", 0.012, "link A"),
               radius("rB", 0.012, "link B"),
               radius("rC", 0.012, "link C"),
               radius("rF", 0.010, "the telescopic shaft"),
               radius("rP", 0.012, "the platform's edge A'B'")});
  return list;
}

}  // namespace pkm::hybrid
