// Formulas: values against the same formula in C++ (bit by bit), derivatives against closed forms and differences, all
// error messages, thread safety.
#include "engine/expression/formula.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <locale>
#include <thread>

#include "engine/math/dual.hpp"
#include "engine/math/random.hpp"

namespace pkm::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

const std::vector<std::string> kNames = {"a", "b", "l_u", "t"};

double value(const std::string& text, const std::vector<double>& values = {2, 3, 5, 7}) {
  return Formula(text, kNames).value(std::span<const double>(values));
}

/// The value and its derivatives by a, b, l_u and t.
Dual4 with_derivatives(const std::string& text, const std::vector<double>& values) {
  std::vector<Dual4> duals;
  for (std::size_t i = 0; i < values.size(); ++i) duals.push_back(Dual4::variable(values[i], static_cast<int>(i)));
  return Formula(text, kNames).value(std::span<const Dual4>(duals));
}

TEST(Formula, ArithmeticHasThePrecedenceAndTheBitsOfCpp) {
  const double a = 0.1, b = 0.7, l_u = 1.3, t = 2.9;
  const auto of = [&](const std::string& text) { return value(text, {a, b, l_u, t}); };
  EXPECT_EQ(of("a + b - l_u - t"), a + b - l_u - t);
  EXPECT_EQ(of("a / b / l_u * t"), a / b / l_u * t);
  EXPECT_EQ(of("a + b * l_u"), a + b * l_u);
  EXPECT_EQ(of("(a + b) * l_u"), (a + b) * l_u);
  EXPECT_EQ(of("a / (pi * b * (l_u + t))"), a / (kPi * b * (l_u + t)));
  EXPECT_EQ(of("t - sqrt(l_u^2 + (b - a)^2)/2"), t - std::sqrt(l_u * l_u + (b - a) * (b - a)) / 2);
  EXPECT_EQ(of("2*a + 3*a"), 2 * a + 3 * a);
  EXPECT_EQ(of("-a^2"), -(a * a));
  EXPECT_EQ(of("(-a)^2"), a * a);
  EXPECT_EQ(of("2^3^2"), 512);
  EXPECT_EQ(of("2^-1"), 0.5);
  EXPECT_EQ(of("a - -b"), a + b);
  EXPECT_EQ(of("+a * -b"), a * -b);
  EXPECT_EQ(of("1e-3 + .5 + 2. + 1.5E2"), 1e-3 + .5 + 2. + 1.5e2);
  EXPECT_EQ(of(" a\n\t+ sin  (\r b ) "), a + portable::sin(b));
}

TEST(Formula, ComparisonsAndConditionals) {
  EXPECT_EQ(value("a < b"), 1);
  EXPECT_EQ(value("a <= 2 && b >= 3 && a != b"), 1);
  EXPECT_EQ(value("a > b || a == b"), 0);
  EXPECT_EQ(value("a < b ? l_u : t"), 5);
  EXPECT_EQ(value("a > b ? l_u : t"), 7);
  EXPECT_EQ(value("a > b ? 1 : b > l_u ? 2 : l_u > t ? 3 : 4"), 4);
  EXPECT_EQ(value("(a < b ? 10 : 20) + (a > b ? 1 : a < b ? 2 : 3)"), 12);
  EXPECT_EQ(value("max(a > b ? 100 : 1, a, b)"), 3);
  EXPECT_EQ(value("min(t, l_u, b, a) + max(a, b)"), 5);
  EXPECT_EQ(value("sign(-a) + sign(0) + 10 * sign(t) + abs(a - t)"), 14);
}

TEST(Formula, FunctionsAgreeWithTheMathLibrary) {
  const auto expect_near = [](double found, double expected) {
    EXPECT_NEAR(found, expected, 4e-16 * std::fmax(1e-300, std::fabs(expected)) * 2) << expected;
  };
  Stream random(3, 0, 0, Stream::Use::start);
  for (int i = 0; i < 1000; ++i) {
    const double x = 4 * random.u01() - 2, y = 4 * random.u01() - 2, u = 2 * random.u01() - 1, p = 5 * random.u01();
    const auto of = [&](const std::string& text) { return value(text, {x, y, u, p}); };
    EXPECT_NEAR(of("sin(a)"), std::sin(x), 3e-16);
    EXPECT_NEAR(of("cos(a)"), std::cos(x), 3e-16);
    EXPECT_NEAR(of("tan(a)") / std::tan(x), 1, 1e-15);
    EXPECT_NEAR(of("asin(l_u)") / std::asin(u), 1, 1e-15);
    EXPECT_NEAR(of("acos(l_u)") / std::acos(u), 1, 1e-15);
    expect_near(of("atan(a)"), std::atan(x));
    expect_near(of("atan2(a, b)"), std::atan2(x, y));
    expect_near(of("exp(a)"), std::exp(x));
    expect_near(of("log(t)"), std::log(p));
    EXPECT_NEAR(of("log10(t)"), std::log10(p), 1e-15);
    EXPECT_EQ(of("sqrt(t)"), std::sqrt(p));
    for (const double scale : {1e-9, 1e-3, 1.0, 10.0}) {
      EXPECT_NEAR(value("sinh(a)", {x * scale, 0, 0, 0}) / std::sinh(x * scale), 1, 1e-15);
      EXPECT_NEAR(value("cosh(a)", {x * scale, 0, 0, 0}) / std::cosh(x * scale), 1, 1e-15);
      EXPECT_NEAR(value("tanh(a)", {x * scale, 0, 0, 0}) / std::tanh(x * scale), 1, 1e-15);
    }
    EXPECT_NEAR(of("t^b") / std::pow(p, y), 1, 2e-15);
    EXPECT_NEAR(of("a^7") / std::pow(x, 7), 1, 2e-15);
    EXPECT_NEAR(of("a^-3") / std::pow(x, -3), 1, 2e-15);
    EXPECT_EQ(of("a^0"), 1);
  }
}

/// Study files store values of formulas, so they must have the same bits on every processor.
TEST(Formula, BitsAreTheSameOnEveryProcessor) {
  const std::vector<double> values = {0.1, 0.7, 1.3, 2.9};
  EXPECT_EQ(value("sin(a) * exp(b) + t^l_u", values), 0x1.0c4fc04246d82p+2);
  EXPECT_EQ(value("tanh(a) - log10(b) / atan(t) + l_u^5", values), 0x1.f804cb5abddbdp+1);
}

TEST(Formula, IsNaNWhereItIsUndefined) {
  const double infinity = std::numeric_limits<double>::infinity();
  for (const char* text :
       {"sqrt(-a)", "log(-a)", "acos(a)", "0/0", "(-a)^0.5", "(-a)^2000", "sin(1e6)", "sqrt(-a) < 1", "1 > sqrt(-a)",
        "sqrt(-a) && 1", "1 || sqrt(-a)", "min(a, sqrt(-a))", "max(sqrt(-a), a)", "min(a, sqrt(-a), 1)",
        "sqrt(-a) ? 1 : 2", "sqrt(-a) > 0 ? 1 : 2", "sign(0/0)", "abs(0/0)", "0^(0/0)"}) {
    EXPECT_TRUE(std::isnan(value(text))) << text;
    EXPECT_TRUE(std::isnan(with_derivatives(text, {2, 3, 5, 7}).a)) << text;
  }
  EXPECT_EQ(value("1/0"), infinity);
  EXPECT_EQ(value("0^-0.5"), infinity);
  EXPECT_EQ(value("0^0.5 + 0^a"), 0);
  EXPECT_EQ(value("exp(1000)"), infinity);
}

/// A formula and its partial derivatives at a point.
struct Derivatives {
  const char* text;
  std::vector<double> at;
  double by[4];
};

TEST(Formula, DerivativesEqualClosedForms) {
  const double a = 1.3, b = 0.6, l = 2.1, t = 0.4, e = std::exp(a * t), r = std::sqrt(a * a + b * b);
  const std::vector<double> at = {a, b, l, t};
  const Derivatives cases[] = {
      {"a + 2*b - l_u/4 - t", at, {1, 2, -0.25, -1}},
      {"a * b * l_u * t", at, {b * l * t, a * l * t, a * b * t, a * b * l}},
      {"a / (b + t)", at, {1 / (b + t), -a / ((b + t) * (b + t)), 0, -a / ((b + t) * (b + t))}},
      {"sqrt(a^2 + b^2)", at, {a / r, b / r, 0, 0}},
      {"l_u^3 - a^-2", at, {2 / (a * a * a), 0, 3 * l * l, 0}},
      {"l_u^a", at, {std::pow(l, a) * std::log(l), 0, a * std::pow(l, a - 1), 0}},
      {"l_u^b", {3, 2, l, t}, {0, l * l * std::log(l), 2 * l, 0}},  // a variable exponent with an integer value
      {"exp(a*t) * sin(b)", at, {t * e * std::sin(b), e * std::cos(b), 0, a * e * std::sin(b)}},
      {"cos(a) + tan(b)", at, {-std::sin(a), 1 / (std::cos(b) * std::cos(b)), 0, 0}},
      {"asin(b) + acos(t)", at, {0, 1 / std::sqrt(1 - b * b), 0, -1 / std::sqrt(1 - t * t)}},
      {"atan(a) + atan2(b, l_u)", at, {1 / (1 + a * a), l / (b * b + l * l), -b / (b * b + l * l), 0}},
      {"log(a) + log10(b)", at, {1 / a, 1 / (b * std::log(10.0)), 0, 0}},
      {"sinh(t) + cosh(a) + tanh(b)", at, {std::sinh(a), 1 / std::pow(std::cosh(b), 2), 0, std::cosh(t)}},
      {"sinh(a) + tanh(-l_u)", at, {std::cosh(a), 0, -1 / std::pow(std::cosh(l), 2), 0}},
      {"min(a, b) + max(l_u, t) + abs(b - a)", at, {1, 0, 1, 0}},
      {"a > b ? a*b : l_u", at, {b, a, 0, 0}},
      {"a < b ? a*b : l_u", at, {0, 0, 1, 0}},
      {"(a > b) * t + sign(a)", at, {0, 0, 0, 1}},
      {"a^2", {0, 0, 0, 0}, {0, 0, 0, 0}},
      {"a^3 - 2*a + sin(b)", {0, 0, 0, 0}, {-2, 1, 0, 0}},
      {"a * b", {1e150, 1e-150, 0, 0}, {1e-150, 1e150, 0, 0}},
      {"a^2 / b", {1e-8, 1e8, 0, 0}, {2e-16, -1e-32, 0, 0}},
  };
  for (const auto& [text, where, by] : cases) {
    const Dual4 found = with_derivatives(text, where);
    for (int i = 0; i < 4; ++i)
      EXPECT_NEAR(found.v[i], by[i], 4e-15 * std::fabs(by[i])) << text << " by " << kNames[static_cast<std::size_t>(i)];
  }
}

TEST(Formula, DerivativesEqualDifferencesAndValuesAreThoseOfDouble) {
  Stream random(4, 0, 0, Stream::Use::start);
  for (const char* text :
       {"a / (pi * b * (l_u + t))", "t - sqrt(l_u^2 + (b - a*cos(t))^2)/2", "exp(-a) * tanh(b) / log(2 + l_u)",
        "atan2(sin(a), cos(b)) * asin(t/2)^3", "a^b + l_u^-t", "max(a, b, l_u) * min(t, 1) - abs(a - b)",
        "cosh(a)^0.7 + sinh(b) * log10(t)", "a > 0.5 ? b^3 : tan(l_u)"}) {
    const Formula formula(text, kNames);
    for (int k = 0; k < 50; ++k) {
      std::vector<double> at(4);
      for (double& x : at) x = 0.1 + random.u01();
      const Dual4 found = with_derivatives(text, at);
      EXPECT_EQ(found.a, formula.value(std::span<const double>(at))) << text;
      for (std::size_t i = 0; i < 4; ++i) {
        const auto moved = [&](double by) {
          auto there = at;
          there[i] += by;
          return formula.value(std::span<const double>(there));
        };
        const double h = 1e-5, difference = (8 * (moved(h) - moved(-h)) - (moved(2 * h) - moved(-2 * h))) / (12 * h);
        EXPECT_NEAR(found.v[static_cast<int>(i)], difference, 1e-8 * (1 + std::fabs(difference)))
            << text << " by " << i;
      }
    }
  }
}

TEST(Formula, ConstantsHaveZeroDerivativesEvenAtSingularPoints) {
  const std::vector<Dual4> values = {Dual4(0.0), Dual4::variable(3, 1), Dual4(-1.0), Dual4(1.0)};
  const auto of = [&](const char* text) { return Formula(text, kNames).value(std::span<const Dual4>(values)); };
  EXPECT_EQ(of("sqrt(a) + b").v[1], 1);
  EXPECT_EQ(of("acos(t) * b").v[1], 0);
  EXPECT_EQ(of("a^0.5 + l_u^3 * b").v[1], -1);
  EXPECT_EQ(of("asin(l_u)").v[0], 0);
}

TEST(Formula, ListsTheVariablesThatItUses) {
  EXPECT_THAT(Formula("t + a * t + 1", kNames).used(), ElementsAre(0, 3));
  EXPECT_THAT(Formula("pi", kNames).used(), IsEmpty());
  const std::vector<double> values = {std::nan(""), 3, std::nan(""), std::nan("")};
  EXPECT_EQ(Formula("b", kNames).value(std::span<const double>(values)), 3) << "the other values are ignored";
}

std::string message_of(const std::string& text) {
  try {
    Formula(text, kNames);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

TEST(Formula, ErrorMessages) {
  const std::string functions =
      "expected one of sin, cos, tan, asin, acos, atan, atan2, sinh, cosh, tanh, exp, log, log10, sqrt, abs, sign, "
      "min, max, dot, cross, det, norm, unit, angle, rotation, transpose, point";
  const std::pair<std::string, std::string> cases[] = {
      {"", "is empty"},
      {" \n ", "is empty"},
      {"c + 1", "has the unknown name 'c' at character 1; expected one of a, b, l_u, t, pi; did you mean 'a'?"},
      {"2 * l_x", "has the unknown name 'l_x' at character 5; expected one of a, b, l_u, t, pi; did you mean 'l_u'?"},
      {"_pi", "has the unknown name '_pi' at character 1; expected one of a, b, l_u, t, pi; did you mean 'pi'?"},
      {"volume", "has the unknown name 'volume' at character 1; expected one of a, b, l_u, t, pi"},
      {"a + sine(b)", "calls the unknown function 'sine' at character 5; " + functions + "; did you mean 'sin'?"},
      {"rnd()", "calls the unknown function 'rnd' at character 1; " + functions},
      {"a (b)", "calls 'a' at character 1, which is not a function; multiply with '*'"},
      {"pi(b)", "calls 'pi' at character 1, which is not a function; multiply with '*'"},
      {"sin + 1", "has no arguments in parentheses after the function 'sin' at character 1"},
      {"sin()", "gives 0 arguments to 'sin' at character 1, which takes 1"},
      {"1 + atan2(a)", "gives 1 argument to 'atan2' at character 5, which takes 2"},
      {"sqrt(a, b, t)", "gives 3 arguments to 'sqrt' at character 1, which takes 1"},
      {"max( )", "gives 0 arguments to 'max' at character 1, which takes two or more"},
      {"max((a))", "gives 1 argument to 'max' at character 1, which takes two or more"},
      {"a, b", "has a ',' at character 2; a formula has one value"},
      {"(a, b)", "has a ',' at character 3 outside of a function's arguments"},
      {"max((a, b), 1)", "has a ',' at character 7 outside of a function's arguments"},
      {"max(a ? b, t : 2)", "has a ',' at character 10, where an operator is expected"},
      {"max(, a)", "has a ',' at character 5, where a number, a name or '(' is expected"},
      {"max(a, )", "has a ')' at character 8, where a number, a name or '(' is expected"},
      {"a = 3", "has a '=' at character 3; formulas have no assignment, compare with '=='"},
      {"a += 3", "has a '=' at character 4; formulas have no assignment, compare with '=='"},
      {"\"a\"", "has a '\"' at character 1, which is not allowed in formulas"},
      {"a $ b", "has a '$' at character 3, which is not allowed in formulas"},
      {"a \xc2\xb7 b", "has a '\xc2\xb7' at character 3, which is not allowed in formulas"},
      {"!a", "has a '!' at character 1, which is not allowed in formulas"},
      {"a & b", "has a '&' at character 3, which is not allowed in formulas"},
      {"a % b", "has a '%' at character 3, which is not allowed in formulas"},
      {"a \x01 b", "has a '\x01' at character 3, which is not allowed in formulas"},
      {".", "has a '.' at character 1, which is not allowed in formulas"},
      {"1e999", "has a number out of range: '1e999' at character 1"},
      {"2 a", "has a 'a' at character 3, where an operator is expected"},
      {"2a", "has a 'a' at character 2, where an operator is expected"},
      {"a 2", "has a '2' at character 3, where an operator is expected"},
      {"2 pi", "has a 'pi' at character 3, where an operator is expected"},
      {"1.2.3", "has a '.3' at character 4, where an operator is expected"},
      {"2. a", "has a 'a' at character 4, where an operator is expected"},
      {"a sin(b)", "has a 'sin' at character 3, where an operator is expected"},
      {"(a)(b)", "has a '(' at character 4, where an operator is expected"},
      {"a + * b", "has a '*' at character 5, where a number, a name or '(' is expected"},
      {"a**b", "has a '*' at character 3, where a number, a name or '(' is expected"},
      {"* a", "has a '*' at character 1, where a number, a name or '(' is expected"},
      {"--a", "has a '-' at character 2, where a number, a name or '(' is expected"},
      {"a - + - b", "has a '-' at character 7, where a number, a name or '(' is expected"},
      {"a +", "ends where a number, a name or '(' is expected"},
      {"(", "does not close the '(' at character 1"},
      {"2 * (a + sin(b)", "does not close the '(' at character 5"},
      {"a + b)", "has a ')' at character 6 without its '('"},
      {"()", "has a ')' at character 2, where a number, a name or '(' is expected"},
      {"a ? b", "has a '?' without its ':'"},
      {"a : b", "has a ':' at character 3 without its '?'"},
      {"a ? : b", "has a ':' at character 5, where a number, a name or '(' is expected"},
      {"0 < a < 1", "compares the result of a comparison; write a < b && b < c for a < b < c"},
      {"1 > (a <= b)", "compares the result of a comparison; write a < b && b < c for a < b < c"},
  };
  for (const auto& [text, message] : cases) {
    std::string shown = text;
    for (char& c : shown)
      if (c == '\n') c = ' ';
    EXPECT_EQ(message_of(text), "the formula \"" + shown + "\" " + message);
  }
  std::string sum = "a";
  for (int i = 0; i < 40; ++i) sum += "+a";
  EXPECT_EQ(message_of(sum + "+"),
            "the formula \"" + sum.substr(0, 57) + "...\" ends where a number, a name or '(' is expected");
  for (int i = 0; i < 10000; ++i) sum += "+a";
  EXPECT_EQ(message_of(sum), "the formula \"" + sum.substr(0, 57) + "...\" has more than 20000 characters");
}

TEST(Formula, RandomTextIsParsedOrRefused) {
  const std::vector<std::string> words = {"a",    "b",     "pi",     "1",      "2.5",  "+",   "-",  "*", "/",
                                          "^",    "(",     ")",      "(",      ")",    "(",   ")",  ",", "?",
                                          ":",    "<",     ">=",     "==",     "&&",   "||",  " ",  "=", "sin(",
                                          "max(", "min (", "atan2(", "exp(a)", "sqrt", "?1:", "+a", "*b"};
  Stream random(6, 0, 0, Stream::Use::start);
  int parsed = 0;
  for (int i = 0; i < 50'000; ++i) {
    std::string text;
    for (std::size_t n = 1 + random.below(10); n > 0; --n) text += words[random.below(words.size())];
    try {
      const Formula formula(text, kNames);
      const std::vector<double> values = {2, 3, 5, 7};
      const std::vector<Dual4> duals = {Dual4::variable(2, 0), Dual4::variable(3, 1), 5, 7};
      const double found = formula.value(std::span<const double>(values));
      const double with = formula.value(std::span<const Dual4>(duals)).a;
      EXPECT_TRUE(found == with || (std::isnan(found) && std::isnan(with))) << text;
      ++parsed;
    } catch (const std::invalid_argument&) {
    }
  }
  EXPECT_GT(parsed, 500);
}

TEST(Formula, DeepNestingIsParsed) {
  std::string text = "a";
  for (int i = 0; i < 3000; ++i) text = "(" + text + ")";
  EXPECT_EQ(value(text + "+1"), 3);
  std::string right = "a";
  for (int i = 0; i < 3000; ++i) right = "1+(" + right + ")";
  EXPECT_EQ(value(right), 3002);
}

TEST(Formula, InvalidVariableNamesAreALogicError) {
  for (const std::vector<std::string>& names :
       {std::vector<std::string>{"a", "a"}, {"pi"}, {"sin"}, {""}, {"2a"}, {"a-b"}, {"\xc3\xa4"}})
    EXPECT_THROW(Formula("1", names), std::logic_error) << names.back();
}

TEST(Formula, DoesNotDependOnTheLocale) {
  class Comma : public std::numpunct<char> {
    char do_decimal_point() const override { return ','; }
    char do_thousands_sep() const override { return '.'; }
    std::string do_grouping() const override { return "\3"; }
  };
  const std::locale before = std::locale::global(std::locale(std::locale::classic(), new Comma));
  EXPECT_EQ(value("max(1.5, 1e-3) + 1234"), 1235.5);
  EXPECT_EQ(message_of("1,5"), "the formula \"1,5\" has a ',' at character 2; a formula has one value");
  std::locale::global(before);
}

TEST(Formula, ThreadsCanShareAFormula) {
  const Formula first("sin(a) * exp(b) + t^l_u - (a > b ? a : b)", kNames), second("max(a, b, t) / l_u", kNames);
  const auto sum = [&](std::uint32_t individual) {
    Stream random(5, 0, individual, Stream::Use::start);
    std::vector<double> found;
    for (int i = 0; i < 2000; ++i) {
      std::vector<double> at(4);
      std::vector<Dual4> duals;
      for (double& x : at) {
        x = 0.1 + random.u01();
        duals.push_back(Dual4::variable(x, static_cast<int>(duals.size())));
      }
      found.push_back(first.value(std::span<const double>(at)));
      const Dual4 dual = second.value(std::span<const Dual4>(duals));
      found.insert(found.end(), {dual.a, dual.v[0], dual.v[2]});
      found.push_back(Formula("a + b", kNames).value(std::span<const double>(at)));  // parsing is thread-safe, too
    }
    return found;
  };
  std::vector<std::vector<double>> alone(8), together(8);
  for (std::uint32_t i = 0; i < 8; ++i) alone[i] = sum(i);
  std::vector<std::thread> threads;
  for (std::uint32_t i = 0; i < 8; ++i) threads.emplace_back([&, i] { together[i] = sum(i); });
  for (auto& thread : threads) thread.join();
  EXPECT_EQ(alone, together);
}

}  // namespace
}  // namespace pkm::testing
