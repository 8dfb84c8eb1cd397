// Proofs of volume bounds: the independent checker accepts them, and refuses proofs of more than is true.
#include "engine/workspace/bounds/proof.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/math/scalar.hpp"
#include "experiments/checker/check.hpp"
#include "tests/unit/workspace/bounds/formulas.hpp"

namespace pkm::bounds {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

/// A proof of bounds of the volume where constraints hold.
std::string proof_of(const std::string& axes, const std::vector<std::string>& constraints, const Ranges& ranges,
                     double gap, VolumeBounds* bounds = nullptr) {
  Formulas formulas(axes);
  const Constraints all = formulas.conditions(constraints);
  ProofTree tree;
  const VolumeBounds found = volume_bounds(all, ranges, {.gap = gap}, &tree);
  if (bounds) *bounds = found;
  return proof_text({.graph = formulas.graph,
                     .constraints = all,
                     .axes = formulas.names,
                     .positions = formulas.positions,
                     .ranges = ranges,
                     .inputs = formulas.inputs(),
                     .input_names = formulas.names,
                     .title = "a test"},
                    found, tree);
}
std::string quarter_disc(double gap) { return proof_of("xy", {"1 - x^2 - y^2"}, {{{0, 1}, {0, 1}}}, gap); }

/// "", or why the checker refuses a proof.
std::string refusal(const std::string& proof) {
  try {
    EXPECT_THAT(checker::Check(proof).run(), StartsWith("accepted: "));
    return "";
  } catch (const checker::InvalidProof& reason) {
    return reason.what();
  }
}
/// Replaces what stands at one place of a text.
std::string with(std::string text, const std::string& old, const std::string& replacement) {
  const std::size_t at = text.find(old);
  EXPECT_NE(at, std::string::npos) << old << " in\n" << text;
  return text.replace(at, old.size(), replacement);
}

/// The worked example of engine/workspace/bounds/README.md, with the radius as a number.
TEST(Proof, IsTheOneThatIsWorkedOut) {
  EXPECT_THAT(quarter_disc(0.5), HasSubstr("axis x 0 1\naxis y 0 1\nlet n1 = ((1 - (x * x)) - (y * y))\n"
                                           "condition n1 1 - x^2 - y^2\nboxes\n"
                                           "s464913359 1073741824 nn/0\n"));
}

TEST(Proof, IsAccepted) {
  for (const double gap : {0.5, 0.1, 1e-2}) EXPECT_EQ(refusal(quarter_disc(gap)), "") << gap;
  const Ranges cube = {{{-1, 1}, {-1, 1}, {-1, 1}}};
  VolumeBounds ball;
  EXPECT_EQ(refusal(proof_of("xyz", {"0.25 - x^2 - y^2 - z^2", "z + 0.1 - abs(x)"}, cube, 0.1, &ball)), "");
  EXPECT_LT(ball.upper, kPi / 6);
  EXPECT_EQ(refusal(proof_of("z", {"cos(2*z) - 0.5", "sqrt(z + 0.25)"}, {{{-1, 1}}}, 1e-3)), "");
  EXPECT_EQ(refusal(proof_of("xz", {"-1 - x^2"}, {{{-1, 1}, {-1, 1}}}, 1e-3)), "") << "an empty set";
}

/// The checker's rules of differentiation are its own; where they enclose derivatives less tightly than pkmopt's, it
/// refuses proofs that are right.
TEST(Proof, IsAcceptedForAllFunctions) {
  for (const char* const constraint : {"z + 0.1 - abs(x)",    "z - abs(x + y)",          "abs(z) - abs(x)",
                                       "min(x, y) - z",       "max(x^3, y) - z/2",       "(x > y ? x : y) - z",
                                       "(x + 1)^2.7 - z",     "(z + 1)^0.5 - x",         "2^x - z - 1",
                                       "(2 + x)^(y*z) - 1.3", "exp(x) - z - y",          "log(x + 1.5) - z",
                                       "log10(x + 2) - z",    "sin(x)*cos(z) - tan(y)",  "asin(x) + y - z",
                                       "acos(x) - z",         "atan(x*z)*cosh(y) - 0.2", "atan2(x, 2 + z) - z*y",
                                       "sinh(z) - x",         "tanh(x*z) - z + y/2",     "sqrt(1 - x^2) - z",
                                       "x/(2 + y) - z"})
    EXPECT_EQ(refusal(proof_of("xyz", {constraint}, {{{-1, 1}, {-1, 1}, {-1, 1}}}, 0.2)), "") << constraint;
}

TEST(Proof, OfMoreThanItsStepsProveIsRefused) {
  const std::string proof = quarter_disc(1e-2);
  const std::size_t from = proof.find("volume "), to = proof.find('\n', from);
  const std::string claim = proof.substr(from, to - from);
  EXPECT_THAT(refusal(with(proof, claim, "volume 0.785 0.786")), HasSubstr("the lower bound is not proven"));
  EXPECT_THAT(refusal(with(proof, claim, "volume 0.7 0.7853")), HasSubstr("the upper bound is not proven"));
  EXPECT_EQ(refusal(with(proof, claim, "volume 0.7 0.9")), "") << "less than its steps prove";
}

TEST(Proof, OfAnotherStatementIsRefused) {
  const std::string proof = quarter_disc(1e-2);
  EXPECT_NE(refusal(with(proof, "(1 - (x", "(1.01 - (x")), "") << "a greater disc";
  EXPECT_NE(refusal(with(proof, "(1 - (x", "(0.99 - (x")), "") << "a smaller disc";
  EXPECT_NE(refusal(with(proof, "axis y 0 1", "axis y 0 1.1")), "");
  EXPECT_NE(refusal(with(proof, "- (y * y)", "- (y * 0.9)")), "");
}

TEST(Proof, WithAWrongStepIsRefused) {
  const std::string proof = quarter_disc(0.5);
  EXPECT_THAT(refusal(with(proof, "nn/0", "nx0 /0")), HasSubstr("not proven to fail"));
  EXPECT_THAT(refusal(with(proof, "nn/0", "nh0 /0")), HasSubstr("not proven to hold"));
  EXPECT_THAT(refusal(with(proof, "t0 737440994", "t0 837440994")), HasSubstr("may lie outside"));
  EXPECT_THAT(refusal(with(proof, "\nend", "")), HasSubstr("ends too early"));
}

TEST(Proof, IsNotWrittenWithNumbersThatAreNotFinite) {
  EXPECT_THROW(proof_of("xz", {"1e200*1e200 + x - z"}, {{{-1, 1}, {-1, 1}}}, 1e-3), std::runtime_error);
}

}  // namespace
}  // namespace pkm::bounds
