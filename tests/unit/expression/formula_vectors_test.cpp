// Vectors, rotations and frames in formulas: values against closed forms, and all messages about kinds.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "engine/expression/formula_parser.hpp"
#include "engine/expression/program.hpp"

namespace pkm::expression {
namespace {

using ::testing::HasSubstr;

constexpr double kTurn = 0.3, kHeight = 0.9;  // values of the inputs q and h

/// The names q and h (scalars), B = [1, 2, 3], C = [-1, 0.5, 2], R = Rz(q), platform = (B, R) and arm1.C = B.
class FormulaVectors : public ::testing::Test {
 protected:
  FormulaVectors() {
    const Term q(graph_, graph_.input(0)), h(graph_, graph_.input(1));
    const Vector3 B{number(1), number(2), number(3)}, C{number(-1), number(0.5), number(2)};
    const Rotation R = rotation_about(2, sin(q), cos(q));
    add("q", q);
    add("h", h);
    add("B", B);
    add("C", C);
    add("R", R);
    add("platform", Frame{B, R});
    add("arm1", h);
    add("arm1.C", B);
  }

  Term number(double x) { return {graph_, x}; }
  void add(const std::string& name, const FormulaValue& value) {
    names_.add(name);
    values_.push_back(value);
  }
  FormulaValue parse(const std::string& text) {
    return parse_formula(graph_, text, names_, [this](std::size_t i) { return values_[i]; }).value;
  }
  /// The elements of the value of a formula for q = kTurn and h = kHeight.
  std::vector<double> of(const std::string& text) {
    std::vector<Node> nodes;
    for (const Term& element : elements(parse(text))) nodes.push_back(element.node());
    const Program program(graph_, nodes);
    std::vector<double> registers;
    program.run_all<double>(std::vector{kTurn, kHeight}, registers);
    std::vector<double> values;
    for (const auto output : program.outputs()) values.push_back(registers[output]);
    return values;
  }
  std::string error(const std::string& text) {
    try {
      parse(text);
    } catch (const std::invalid_argument& reason) {
      return reason.what();
    }
    return "";
  }
  static void expect_near(const std::vector<double>& found, const std::vector<double>& expected) {
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], expected[i], 1e-15);
  }

  Graph graph_;
  Names names_;
  std::vector<FormulaValue> values_;
};

TEST_F(FormulaVectors, HaveTheValuesOfVectorAlgebra) {
  const double c = std::cos(kTurn), s = std::sin(kTurn);
  expect_near(of("[h, 2, q]"), {kHeight, 2, kTurn});
  expect_near(of("B + C - 2*B*h/4"), {-0.5 * kHeight, 2.5 - kHeight, 5 - 1.5 * kHeight});
  expect_near(of("-B"), {-1, -2, -3});
  expect_near(of("dot(B, C)"), {6});
  expect_near(of("cross(B, C)"), {2.5, -5, 2.5});
  expect_near(of("det(B, C, [0, 0, 1])"), {2.5});
  expect_near(of("norm(B)^2"), {14});
  expect_near(of("unit([0, h, 0])"), {0, 1, 0});
  expect_near(of("angle([1, 0, 0], [1, 1, 0])"), {std::atan(1)});
  expect_near(of("angle([h, 0, 0], [-1, 0, 0])"), {4 * std::atan(1)});
  expect_near(of("R*[1, 0, 0]"), {c, s, 0});
  expect_near(of("transpose(R)*R*B"), {1, 2, 3});
  expect_near(of("point(platform, [h, 0, 1])"), {1 + c * kHeight, 2 + s * kHeight, 4});
  expect_near(of("platform.origin - arm1.C"), {0, 0, 0});
  expect_near(of("rotation([0, 0, 2], q)*B"), of("platform.R*B"));
  expect_near(of("h > 0 ? B : C"), {1, 2, 3});
  expect_near(of("h < 0 ? B : C"), {-1, 0.5, 2});
}

TEST_F(FormulaVectors, HaveParts) {
  expect_near(of("B.x - B.y*B.z"), {-5});
  expect_near(of("-B.z^2"), {-9});
  expect_near(of("cross(B, C).y + (B + C).z + [1, h, 3].y"), {kHeight});
  expect_near(of("arm1 + arm1.C.z"), {3 + kHeight});
  expect_near(of("(R*B).z"), {3});
}

TEST_F(FormulaVectors, RotateAboutAnyAxis) {
  // 120 degrees about the space diagonal exchange the axes
  expect_near(of("rotation([1, 1, 1], 2*pi/3)*[1, 0, 0]"), {0, 1, 0});
  expect_near(of("rotation([h, 0, 0], pi/2)*[0, 1, 0]"), {0, 0, 1});
}

TEST_F(FormulaVectors, NamesOfVectorFunctionsMayBeVariables) {
  add("angle", number(5));
  expect_near(of("angle + angle([1, 0, 0], [0, 1, 0])"), {5 + 2 * std::atan(1)});
  EXPECT_EQ(names_.find("norm"), std::nullopt);
}

TEST_F(FormulaVectors, KnowsWhichSquareRootsAlwaysExist) {
  const auto value_of = [this](std::size_t i) { return values_[i]; };
  const ParsedFormula parsed = parse_formula(graph_, "unit([q, h, 0]).x + sqrt(h)", names_, value_of);
  ASSERT_EQ(parsed.norms.size(), 1U);
  EXPECT_EQ(graph_[parsed.norms[0]].operation->name, "sqrt");
  EXPECT_EQ(parsed.norms[0], std::get<Term>(parse("norm([q, h, 0])")).node());
}

TEST_F(FormulaVectors, OfWrongKindsAreRefused) {
  EXPECT_THAT(error("q + B"), HasSubstr("has a '+' at character 3 between a scalar and a vector"));
  EXPECT_THAT(error("B*C"), HasSubstr("has a '*' at character 2 between a vector and a vector"));
  EXPECT_THAT(error("B*R"), HasSubstr("has a '*' at character 2 between a vector and a rotation"));
  EXPECT_THAT(error("q/B"), HasSubstr("has a '/' at character 2 between a scalar and a vector"));
  EXPECT_THAT(error("B^2"), HasSubstr("has a '^' at character 2 between a vector and a scalar"));
  EXPECT_THAT(error("B < C"), HasSubstr("has a '<' at character 3 between a vector and a vector"));
  EXPECT_THAT(error("-platform"), HasSubstr("has a '-' at character 1 before a frame"));
  EXPECT_THAT(error("q > 0 ? B : q"), HasSubstr("has a '?' at character 7 between a vector and a scalar"));
  EXPECT_THAT(error("sin(B)"), HasSubstr("gives a vector to 'sin' at character 1, which takes scalars"));
  EXPECT_THAT(error("max(q, B)"), HasSubstr("gives a vector to 'max' at character 1, which takes scalars"));
  EXPECT_THAT(error("dot(B, q)"), HasSubstr("gives a scalar to 'dot' at character 1, whose argument 2 is a vector"));
  EXPECT_THAT(error("point(B, B)"), HasSubstr("gives a vector to 'point' at character 1, whose argument 1 is a frame"));
  EXPECT_THAT(error("[B, 1, 2]"), HasSubstr("has a vector as element 1 of the vector '[' at character 1"));
  EXPECT_THAT(error("q.x"), HasSubstr("has a '.x' at character 2 after a scalar; a vector has .x, .y and .z"));
  EXPECT_THAT(error("platform.x"), HasSubstr("has a '.x' at character 9 after a frame"));
}

TEST_F(FormulaVectors, WithSyntaxErrorsAreRefused) {
  EXPECT_THAT(error("[1, 2]"), HasSubstr("has a vector of 2 elements, '[' at character 1; expected three: [x, y, z]"));
  EXPECT_THAT(error("[1, 2, 3"), HasSubstr("does not close the '[' at character 1"));
  EXPECT_THAT(error("[1, 2, (3]"), HasSubstr("closes the '(' at character 8 by a ']' at character 10"));
  EXPECT_THAT(error("1, 2]"), HasSubstr("has a ',' at character 2; a formula has one value"));
  EXPECT_THAT(error("1]"), HasSubstr("has a ']' at character 2 without its '['"));
  EXPECT_THAT(error("cross(B)"), HasSubstr("gives 1 argument to 'cross' at character 1, which takes 2"));
  EXPECT_THAT(error("arm1.D"), HasSubstr("has the unknown name 'arm1.D' at character 1; expected one of arm1.C"));
  EXPECT_THAT(error("crss(B, C)"), HasSubstr("did you mean 'cross'?"));
  EXPECT_THAT(error("B.w"), HasSubstr("has the unknown name 'B.w' at character 1"));
  EXPECT_THAT(error("B [1, 2, 3]"), HasSubstr("has a '[' at character 3, where an operator is expected"));
}

}  // namespace
}  // namespace pkm::expression
