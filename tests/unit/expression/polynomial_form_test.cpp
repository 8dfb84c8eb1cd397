// Polynomial normal form: at random points, the clauses hold if and only if the constraint does.
#include "engine/expression/polynomial_form.hpp"

#include <gtest/gtest.h>

#include <random>
#include <string>

#include "engine/expression/formula_parser.hpp"
#include "engine/expression/program.hpp"

namespace pkm::expression {
namespace {

constexpr Groups kDesign = 1, kZ = 2;

struct Converted {
  Graph graph;
  Node constraint;
  std::optional<std::vector<Clause>> clauses;
};

/// @param text         constraint in the parameters a, b and the coordinate z
/// @param nonnegative  of a, b and z: whether they are >= 0
Converted converted(const std::string& text, bool squares = false, const std::vector<bool>& nonnegative = {}) {
  Converted made;
  const std::vector<Node> inputs = {made.graph.input(0, kDesign), made.graph.input(1, kDesign),
                                    made.graph.input(2, kZ)};
  made.constraint = read_formula(made.graph, text, std::vector<std::string>{"a", "b", "z"}, inputs);
  made.clauses = polynomial_clauses(made.graph, made.constraint, kZ, 2, squares, nonnegative);
  return made;
}

/// @param smallest_b  lower bound of the values of b
void expect_equivalent(const Converted& of, double smallest_b = -2) {
  ASSERT_TRUE(of.clauses);
  std::vector<Node> nodes = {of.constraint};
  for (const Clause& clause : *of.clauses)
    for (const Polynomial& p : clause) nodes.insert(nodes.end(), p.c.begin(), p.c.end());
  const Program program(of.graph, nodes);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-2, 2);
  std::vector<double> registers;
  int feasible = 0;
  constexpr int kPoints = 2000;
  for (int k = 0; k < kPoints; ++k) {
    const std::array<double, 3> at = {uniform(random), std::max(smallest_b, uniform(random)), uniform(random)};
    program.run_all<double>(at, registers);
    auto output = program.outputs().begin();
    const double value = registers[*output++];
    if (value != value || std::abs(value) < 1e-9) continue;
    bool holds = true;
    for (const Clause& clause : *of.clauses) {
      bool one_holds = false;
      for (std::size_t i = 0; i < clause.size(); ++i) {
        double sum = 0, power = 1;
        for (std::size_t j = 0; j < 5; ++j, power *= at[2]) sum += registers[*output++] * power;
        one_holds = one_holds || sum >= 0;
      }
      holds = holds && one_holds;
    }
    EXPECT_EQ(holds, value > 0) << "a = " << at[0] << ", b = " << at[1] << ", z = " << at[2];
    feasible += holds;
  }
  EXPECT_TRUE(feasible > kPoints / 50 && feasible < kPoints - kPoints / 50) << feasible;
}

TEST(PolynomialForm, IsEquivalentToTheConstraint) {
  for (const char* text :
       {"b - a*z", "1 - z^2 - a*b", "min(a + z, b - z^2)", "max(a + z, b - z^2)", "1 - abs(a + b*z)",
        "abs(a + b*z) - 1", "1 - sqrt(a^2 + z^2)", "sqrt(a^2 + z^2) - abs(b)", "a + z/abs(b) - sqrt(b^2 + z^2)"}) {
    SCOPED_TRACE(text);
    expect_equivalent(converted(text));
  }
}

TEST(PolynomialForm, TakesFactorsOutOfAbsoluteValues) {
  for (const char* text : {"a*(1 - abs(b + z))", "(abs(b + z) - 1)*a", "(b - abs(z))/a", "a*sqrt(1 + b^2) - a*abs(z)",
                           "abs(z - b)*a - z*a", "-(1 - abs(b + z))", "-3*(1 - abs(b + z))", "a*min(z, 1 - abs(b*z))",
                           "a*b*max(z - 1, b - abs(z))"}) {
    SCOPED_TRACE(text);
    expect_equivalent(converted(text));
  }
}

/// A root of unknown sign in an absolute value has one form, |a sqrt(Q)| = |a| sqrt(Q), and if b > 0 so has its
/// quotient.
TEST(PolynomialForm, MovesConstantsIntoMinimaAndAbsoluteValuesOfRoots) {
  for (const char* text : {"min(a + z, b - z^2) - a*b", "a - max(b*z, z - 1)", "max(a + z, b - z^2) - b",
                           "a - min(b*z, z - 1)", "abs(a*sqrt(4 - z^2)) - b", "1 - abs(a*sqrt(4 - z^2))"}) {
    SCOPED_TRACE(text);
    expect_equivalent(converted(text, true));
  }
  for (const char* text : {"abs(a*sqrt(4 - z^2))/b - 1", "1 - abs(-sqrt(4 - z^2))/b"}) {
    SCOPED_TRACE(text);
    const Converted made = converted(text, true, {false, true, false}), of_any_sign = converted(text, true);
    expect_equivalent(of_any_sign);
    expect_equivalent(made, 0.1);
    EXPECT_LT(made.clauses->size(), of_any_sign.clauses->size());
  }
}

TEST(PolynomialForm, AConstantFactorAddsNoAlternatives) {
  const auto made = converted("-2*(abs(b + z) - 1)");
  EXPECT_EQ(made.clauses->size(), 2u);
  for (const Clause& clause : *made.clauses) EXPECT_EQ(clause.size(), 1u);
}

TEST(PolynomialForm, DoesNotExistForTranscendentalConstraints) {
  for (const char* text : {"a - sin(z)", "a*(1 - sin(z))", "a - z^3"}) EXPECT_FALSE(converted(text).clauses) << text;
}

}  // namespace
}  // namespace pkm::expression
