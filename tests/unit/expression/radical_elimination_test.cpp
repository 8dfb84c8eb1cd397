// Polynomial normal form: coefficients by hand, elimination of radicals without spurious solutions, and equivalence of
// the clauses with the original constraint at random points.
#include "engine/expression/polynomial_form.hpp"

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/expression/formula_parser.hpp"
#include "engine/expression/program.hpp"
#include "tests/unit/math/uniform.hpp"

namespace pkm::expression {
namespace {

using ::testing::ElementsAre;

constexpr Groups kSizes = 1, kUnknown = 2;

/// Values of the inputs a, b, c and z.
using Point = std::array<double, 4>;

/// Formulas in a, b, c, which do not depend on the coordinate z, and z.
struct ClauseGraph {
  Graph graph;
  std::vector<Node> inputs = {graph.input(0, kSizes), graph.input(1, kSizes), graph.input(2, kSizes),
                              graph.input(3, kUnknown)};

  Node read(const std::string& text) { return read_formula(graph, text, {{"a", "b", "c", "z"}}, inputs); }
  std::vector<double> values(const std::vector<Node>& nodes, const Point& point) const {
    const Program program(graph, nodes);
    std::vector<double> registers, values;
    program.run_all<double>(point, registers);
    for (const std::uint32_t output : program.outputs()) values.push_back(registers[output]);
    return values;
  }
  double value(Node node, const Point& point) const { return values({node}, point).front(); }
};

/// The clauses of a constraint.
class NormalForm {
 public:
  NormalForm(const std::string& constraint, std::size_t degree, bool squares)
      : f_(graph_.read(constraint)), clauses_(polynomial_clauses(graph_.graph, f_, kUnknown, degree, squares)) {}

  explicit operator bool() const { return clauses_.has_value(); }
  const std::vector<Clause>& clauses() const { return *clauses_; }
  double constraint(const Point& point) const { return graph_.value(f_, point); }
  std::vector<double> coefficients(const Polynomial& p, const Point& point) const {
    return graph_.values({p.c.begin(), p.c.end()}, point);
  }
  double value(const Polynomial& p, const Point& point) const {
    const std::vector<double> c = coefficients(p, point);
    double sum = 0;
    for (std::size_t i = c.size(); i-- > 0;) sum = sum * point[3] + c[i];
    return sum;
  }
  bool is_satisfied(const Point& point) const {
    return std::ranges::all_of(*clauses_, [&](const Clause& clause) {
      return std::ranges::any_of(clause, [&](const Polynomial& p) { return value(p, point) >= 0; });
    });
  }
  bool depends_on_z(const Polynomial& p) const {
    return std::ranges::any_of(p.c, [&](Node node) { return (graph_.graph[node].groups & kUnknown) != 0; });
  }

 private:
  ClauseGraph graph_;
  Node f_;
  std::optional<std::vector<Clause>> clauses_;
};

TEST(Polynomial, HasTheCoefficientsOfTheExpandedFormula) {
  ClauseGraph g;
  // (z^2 - 2 a z + a^2) (b z + 1) = a^2 + (a^2 b - 2 a) z + (1 - 2 a b) z^2 + b z^3
  const auto cubic = polynomial(g.graph, g.read("(z - a)^2*(b*z + 1)"), kUnknown);
  ASSERT_TRUE(cubic);
  EXPECT_THAT(g.values(*cubic, {2, 3, 0, 0}), ElementsAre(4, 8, -11, 3));
  const auto root_squared = polynomial(g.graph, g.read("sqrt(z + a)^2 - z"), kUnknown);
  ASSERT_TRUE(root_squared);
  EXPECT_THAT(g.values(*root_squared, {7, 0, 0, 0}), ElementsAre(7));
  const auto constant = polynomial(g.graph, g.read("sin(a)/b"), kUnknown);
  ASSERT_TRUE(constant);
  EXPECT_EQ(constant->size(), 1u);
}

TEST(Polynomial, IsRefusedForOtherFormulas) {
  for (const char* const text : {"z^5", "sqrt(z)", "sin(z)", "a/z", "abs(z)", "sqrt(z)*sqrt(z + 1)"}) {
    ClauseGraph g;
    EXPECT_FALSE(polynomial(g.graph, g.read(text), kUnknown)) << text;
  }
}

/// 60 doublings of z reach it along 2^60 paths, each node of which must be visited once.
TEST(Polynomial, VisitsSharedSubexpressionsOnce) {
  ClauseGraph g;
  Term sum(g.graph, g.inputs[3]);
  for (int i = 0; i < 60; ++i) sum = sum + sum;
  const auto found = polynomial(g.graph, sum.node(), kUnknown);
  ASSERT_TRUE(found);
  EXPECT_THAT(g.values(*found, {}), ElementsAre(0, std::ldexp(1, 60)));
}

TEST(PolynomialForm, MinimumBecomesAConjunctionAndMaximumADisjunction) {
  const NormalForm both("min(z - a, b - z)", 2, false), either("max(z - b, a - z)", 2, false),
      inside("a - abs(z - b)", 2, false);
  ASSERT_TRUE(both && either && inside);
  ASSERT_EQ(both.clauses().size(), 2u);
  EXPECT_THAT(both.coefficients(both.clauses()[0][0], {2, 5, 0, 0}), ElementsAre(-2, 1, 0, 0, 0));
  EXPECT_THAT(both.coefficients(both.clauses()[1][0], {2, 5, 0, 0}), ElementsAre(5, -1, 0, 0, 0));
  ASSERT_EQ(either.clauses().size(), 1u);
  EXPECT_EQ(either.clauses()[0].size(), 2u);
  ASSERT_EQ(inside.clauses().size(), 2u);  // a - (z - b) and a + (z - b)
  EXPECT_THAT(inside.coefficients(inside.clauses()[0][0], {2, 5, 0, 0}), ElementsAre(7, -1, 0, 0, 0));
  EXPECT_THAT(inside.coefficients(inside.clauses()[1][0], {2, 5, 0, 0}), ElementsAre(-3, 1, 0, 0, 0));
}

/// sqrt(z) = z - 2 has the solution z = 4 only. Squaring, z = (z - 2)^2, adds z = 1, where sqrt(z) = -(z - 2): on both
/// sides of it the clauses must have the same truth value.
TEST(PolynomialForm, SquaringAddsNoSpuriousSolutions) {
  const NormalForm above("sqrt(z) + 2 - z", 2, false), below("z - 2 - sqrt(z)", 2, false);
  ASSERT_TRUE(above && below);
  std::vector<Polynomial> squared;
  for (const NormalForm* form : {&above, &below})
    for (const Clause& clause : form->clauses())
      for (const Polynomial& p : clause)
        if (form->coefficients(p, {})[2] != 0) {
          EXPECT_NEAR(form->value(p, {0, 0, 0, 1}), 0, 1e-15);
          EXPECT_NEAR(form->value(p, {0, 0, 0, 4}), 0, 1e-15);
          squared.push_back(p);
        }
  EXPECT_EQ(squared.size(), 2u);
  for (const double z : {0.0, 0.5, 0.999, 1.001, 2.0, 3.999}) {
    EXPECT_TRUE(above.is_satisfied({0, 0, 0, z})) << z;
    EXPECT_FALSE(below.is_satisfied({0, 0, 0, z})) << z;
  }
  for (const double z : {4.001, 5.0, 1e6}) {
    EXPECT_FALSE(above.is_satisfied({0, 0, 0, z})) << z;
    EXPECT_TRUE(below.is_satisfied({0, 0, 0, z})) << z;
  }
}

/// sqrt(a - z^2) + sqrt(b) - c = 0, eliminated: a - z^2 = (c - sqrt(b))^2, which also holds where the first root equals
/// -(c - sqrt(b)). For c < sqrt(b) that is spurious: the constraint holds wherever it is defined.
TEST(PolynomialForm, SumOfTwoRootsVanishesOnItsOwnSheetOnly) {
  const NormalForm form("sqrt(a - z^2) + sqrt(b) - c", 2, false);
  ASSERT_TRUE(form);
  const double a = 4, b = 9, root = std::sqrt(3.0);  // |c - 3| = 1 gives z^2 = 4 - 1
  for (const double z : {0.0, 0.5, root - 1e-9}) EXPECT_TRUE(form.is_satisfied({a, b, 4, z})) << z;
  for (const double z : {root + 1e-9, 1.9, 2.0}) EXPECT_FALSE(form.is_satisfied({a, b, 4, z})) << z;
  for (const double z : {0.0, root - 1e-9, root + 1e-9, 2.0}) EXPECT_TRUE(form.is_satisfied({a, b, 2, z})) << z;
}

TEST(PolynomialForm, IsRefusedAboveTheDegreeAndForUnsupportedRoots) {
  EXPECT_FALSE(NormalForm("z^3 - a", 2, false));
  EXPECT_TRUE(NormalForm("z^3 - a", 4, false));
  EXPECT_FALSE(NormalForm("z^2 - sqrt(z + a)", 2, false));  // squared, it has degree four
  EXPECT_TRUE(NormalForm("z^2 - sqrt(z + a)", 4, false));
  EXPECT_FALSE(NormalForm("sqrt(z) + sqrt(z + 1) - a", 4, true));
  EXPECT_FALSE(NormalForm("a*sqrt(z) + z - b", 2, false));  // the sign of a is unknown
  EXPECT_TRUE(NormalForm("a*sqrt(z) + z - b", 2, true));
  EXPECT_FALSE(NormalForm("sin(z) - a", 4, true));
}

/// Where a constraint is defined and not within rounding of zero, it holds if and only if the clauses do.
TEST(PolynomialForm, ClausesAreEquivalentToTheConstraint) {
  struct Case {
    std::string constraint;
    std::size_t degree;
    bool squares;
  };
  const Case cases[] = {
      {"a - b*z + c*z^2", 2, false},
      {"min(z - a, max(b - z, z^2 - c))", 2, false},
      {"max(min(z - a, b - z), min(c - z, z + 1))", 2, false},
      {"a - abs(z - b)", 2, false},
      {"abs(z - b) - a", 2, false},
      {"a - abs(b*z - c)/(1 + c^2)", 2, false},
      {"z - a + sqrt(4 - z^2)", 2, false},
      {"z - a - sqrt(4 - z^2)", 2, false},
      {"z - a - sqrt(b^2)*sqrt(4 - z^2)", 2, false},
      {"z*(z - a) - 2*sqrt(4 - z^2)", 4, false},
      {"(a + sqrt(4 - z^2))*(b - sqrt(4 - z^2)) - c", 4, true},
      {"a*sqrt(4 - z^2) + z - b", 2, true},
      {"sqrt(a^2 - (z - b)^2) - c", 2, true},
      {"c - sqrt(4 - (z - b)^2)", 2, true},
      {"4 - (b + sqrt(4 - z^2))^2", 2, true},
      {"c + sqrt(6 - (sqrt(4 - z^2) - a)^2)", 2, true},
      {"c - sqrt(6 - (sqrt(4 - z^2) - a)^2)", 2, true},
      {"acos(z/2) - 2*a", 2, true},
      {"2*b - acos(z/2)", 2, true},
      {"z/sqrt(1 + z^2) - a/2", 2, true},
      {"c/2 - (z - b)/sqrt(4 - z^2)", 2, true},
      {"acos((z - b)/sqrt(5 - z*b)) - c", 2, true},
  };
  testing::Uniform random(1);
  for (const auto& [constraint, degree, squares] : cases) {
    const NormalForm form(constraint, degree, squares);
    ASSERT_TRUE(form) << constraint;
    for (const Clause& clause : form.clauses())
      for (const Polynomial& p : clause) EXPECT_FALSE(form.depends_on_z(p)) << constraint;
    int satisfied = 0, violated = 0;
    for (int i = 0; i < 2000; ++i) {
      Point point;
      for (double& x : point) x = random(-3, 3);
      const double g = form.constraint(point);
      if (!(std::fabs(g) > 1e-9)) continue;  // undefined, or zero within rounding
      ++(g > 0 ? satisfied : violated);
      ASSERT_EQ(form.is_satisfied(point), g > 0)
          << constraint << " at " << ::testing::PrintToString(point) << ": " << g;
    }
    EXPECT_GT(std::min(satisfied, violated), 50) << constraint;
  }
}

TEST(PolynomialForm, HasNoClausesForAnAngleThatIsNeverNegative) {
  const NormalForm form("acos(z/2)", 2, true);
  ASSERT_TRUE(form);
  EXPECT_TRUE(form.clauses().empty());
}

}  // namespace
}  // namespace pkm::expression
