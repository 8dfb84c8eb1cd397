// Generates code in Python 3 that needs no other packages: a module and a test.
#include <cmath>

#include "engine/export/code/languages.hpp"
#include "engine/export/code/statements.hpp"

namespace pkm::code {
namespace in_python {

std::string number(double value, bool) {
  if (std::isnan(value)) return "_nan";
  if (std::isinf(value)) return value > 0 ? "_inf" : "(-_inf)";
  std::string text = shortest_number(value);
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return value < 0 ? "(" + text + ")" : text;
}

std::string input(const InputPlace& place) {
  return std::string(1, place.array) + "[" + std::to_string(place.index) + "]";
}

std::string call(const std::string& operation, const std::vector<std::string>& x) {
  if (operation == "negate") return "(-" + x[0] + ")";
  if (operation == "+" || operation == "-" || operation == "*") return "(" + x[0] + " " + operation + " " + x[1] + ")";
  if (operation == ">") return call("<", {x[1], x[0]});
  if (operation == ">=") return call("<=", {x[1], x[0]});
  static const std::vector<std::pair<std::string, std::string>> kNames = {
      {"/", "_divided"}, {"min", "_minimum"}, {"max", "_maximum"},   {"sign", "_sign"}, {"turn", "_wrapped"},
      {"?", "_choose"},  {"<", "_less"},      {"<=", "_less_equal"}, {"==", "_equal"},  {"!=", "_unequal"},
      {"&&", "_both"},   {"||", "_either"},   {"^", "_power"},       {"sqrt", "_sqrt"}, {"asin", "_asin"},
      {"acos", "_acos"}, {"log", "_log"},     {"log10", "_log10"},   {"exp", "_exp"},   {"abs", "abs"}};
  std::string name = "_math." + operation;
  for (const auto& [of, own] : kNames)
    if (operation == of) name = own;
  std::string text = name + "(";
  for (std::size_t i = 0; i < x.size(); ++i) text += (i > 0 ? ", " : "") + without_parentheses(x[i]);
  return text + ")";
}

const Syntax kSyntax = {number, input, call, [](const std::string& name, const std::string& expression) {
                          return name + " = " + expression;
                        }};

const char* const kHelpers = R"(
import math as _math

_nan, _inf = _math.nan, _math.inf


# Undefined values are NaN instead of exceptions, and comparisons and choices give NaN if an argument is NaN.
def _divided(a, b):
    if b != 0:
        return a / b
    return _nan if a == 0 or a != a or b != b else _math.copysign(_inf, a) * _math.copysign(1.0, b)


def _sqrt(a):
    return _math.sqrt(a) if a >= 0 else _nan


def _asin(a):
    return _math.asin(a) if -1 <= a <= 1 else _nan


def _acos(a):
    return _math.acos(a) if -1 <= a <= 1 else _nan


def _log(a):
    return _math.log(a) if a > 0 else -_inf if a == 0 else _nan


def _log10(a):
    return _math.log10(a) if a > 0 else -_inf if a == 0 else _nan


def _exp(a):
    return _math.exp(a) if a < 709 else _inf if a == a else _nan


def _power(a, b):
    try:
        return _math.pow(a, b)
    except (ValueError, OverflowError):
        return _nan


def _minimum(a, b):
    return b if b < a or b != b else a


def _maximum(a, b):
    return b if b > a or b != b else a


def _sign(a):
    return 1.0 if a > 0 else -1.0 if a < 0 else a


def _truth(value, a, b):
    return float(value) if a == a and b == b else _nan


def _less(a, b):
    return _truth(a < b, a, b)


def _less_equal(a, b):
    return _truth(a <= b, a, b)


def _equal(a, b):
    return _truth(a == b, a, b)


def _unequal(a, b):
    return _truth(a != b, a, b)


def _both(a, b):
    return _truth(a != 0 and b != 0, a, b)


def _either(a, b):
    return _truth(a != 0 or b != 0, a, b)


def _choose(condition, a, b):
    return _nan if condition != condition else a if condition != 0 else b


def _wrapped(angle):
    """The angle in (-pi, pi]."""
    return angle - _math.ceil(angle / (2 * _math.pi) - 0.5) * (2 * _math.pi)


def _solve(A, b):
    """The solution of A y = b by Gaussian elimination with partial pivoting; None if A is singular."""
    A, b, n = [list(row) for row in A], list(b), len(b)
    for k in range(n):
        pivot = max(range(k, n), key=lambda i: abs(A[i][k]))
        if not abs(A[pivot][k]) > 0:
            return None
        A[k], A[pivot], b[k], b[pivot] = A[pivot], A[k], b[pivot], b[k]
        for i in range(k + 1, n):
            factor = A[i][k] / A[k][k]
            for j in range(k, n):
                A[i][j] -= factor * A[k][j]
            b[i] -= factor * b[k]
    for i in reversed(range(n)):
        b[i] = (b[i] - sum(A[i][j] * b[j] for j in range(i + 1, n))) / A[i][i]
    return b
)";

/// An array as a Python list: "[a, b]", or for a matrix "[[a, b], [c, d]]".
std::string list_of(const std::string* values, const Output& output) {
  std::string text = "[";
  for (std::size_t i = 0; i < output.rows; ++i) {
    text += i > 0 ? ", " : "";
    if (output.columns > 1) text += "[";
    for (std::size_t j = 0; j < output.columns; ++j) text += (j > 0 ? ", " : "") + *values++;
    if (output.columns > 1) text += "]";
  }
  return text + "]";
}

/// Body of a Python function: definitions of constants, and one assignment for each output.
std::string body(const Module& module, const Function& function) {
  return body_of(module, function, kSyntax, "    ", [](const Output& output, const std::string* values) {
    return "    " + output.name + " = " + list_of(values, output) + "\n";
  });
}

std::string names(const std::vector<NamedUnit>& all) {
  std::string text;
  for (const NamedUnit& each : all) text += (text.empty() ? "\"" : ", \"") + each.name + "\"";
  return "[" + text + "]";
}

std::string row(const std::vector<double>& values) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "" : ", ") + without_parentheses(number(value, false));
  return "[" + text + "]";
}

}  // namespace in_python

std::vector<File> python_files(const Module& module) {
  using namespace in_python;
  const std::string p = module.options.has_parameters ? "p, " : "";
  std::string text = "\"\"\"" + module.title + "\n\nThe arrays of the functions are lists:\n";
  const auto describe = [&](const std::string& array, const std::vector<NamedUnit>& elements) {
    if (!elements.empty()) text += "  " + array + ": " + elements_text(elements) + "\n";
  };
  if (module.options.has_parameters) describe("p, the parameters", module.parameters);
  describe("x, the coordinates of a pose", module.coordinates);
  describe("q, the joints", module.joints);
  for (const std::string& sentence : module.left_out) text += sentence + "\n";
  text += "\"\"\"\n" + std::string(kHelpers) + "\n\n";
  text += "COORDINATES = " + names(module.coordinates) + "\nJOINTS = " + names(module.joints) +
          "\nMARGINS = " + names(module.margins) + "\nQUANTITIES = " + names(module.quantities) + "\n";
  if (module.options.has_parameters)
    text += "PARAMETERS = " + names(module.parameters) + "\nDESIGN = " + row(module.design) + "\n";
  const auto add = [&](const std::string& name, const std::string& arguments, const std::string& meaning,
                       const std::string& statements) {
    text += "\n\ndef " + name + "(" + p + arguments + "):\n    \"\"\"" + meaning + "\"\"\"\n" + statements;
  };
  add("inverse", "x", module.inverse.meaning + " None if the pose does not assemble.",
      body(module, module.inverse) +
          "    return q if all(map(_math.isfinite, q)) and all(value >= 0 for value in assembly) else None\n");
  add("jacobian", "x", module.jacobian.meaning, body(module, module.jacobian) + "    return J\n");
  add("margins", "x", module.limits.meaning, body(module, module.limits) + "    return margins\n");
  if (module.values)
    add("quantities", "x", module.values->meaning, body(module, *module.values) + "    return values\n");
  if (module.has_forward)
    add("forward", "q, x", "Pose of joints q by Newton's method from the pose x. None if it does not converge.",
        "    x, last = list(x), _inf\n"
        "    found = inverse(" +
            p +
            "x)\n"
            "    for _ in range(100):\n"
            "        step = None if found is None else _solve(jacobian(" +
            p +
            "x), [a - b for a, b in zip(q, found)])\n"
            "        if step is None:\n"
            "            return None\n"
            "        size, scale = max(map(abs, step)), 1.0\n"
            "        if not size < last and last < 1e-8:\n"
            "            return x  # rounding errors keep the steps from becoming smaller\n"
            "        last, found = size, None\n"
            "        while found is None and scale > 1e-6:  # steps that leave the poses that assemble are halved\n"
            "            following = [a + scale * b for a, b in zip(x, step)]\n"
            "            found, scale = inverse(" +
            p +
            "following), scale / 2\n"
            "        x = following\n"
            "    return None\n");
  if (module.equations) {
    add("equations", "x, v", module.equations->meaning + " Returns J, Jdot_v, M, h, G, Jw.",
        body(module, *module.equations) + "    return J, Jdot_v, M, h, G, Jw\n");
    if (module.has_forward)
      add("forces", "x, v, a, w",
          "Drive forces for accelerations a and a wrench w on the platform (Fx Fy Fz Mx My Mz). None if the pose is\n"
          "    singular.",
          "    J, _, M, h, G, Jw = equations(" + p +
              "x, v)\n"
              "    n = len(x)\n"
              "    load = [\n"
              "        h[i] + G[i] + sum(M[i][j] * a[j] for j in range(n)) - sum(Jw[j][i] * w[j] for j in range(6))\n"
              "        for i in range(n)\n"
              "    ]\n"
              "    return _solve([[J[j][i] for j in range(n)] for i in range(n)], load)\n");
  }

  const std::string own = module.options.has_parameters ? "robot.DESIGN, " : "";
  std::string test = "\"\"\"Compares " + module.name + ".py with values of pkmopt: python3 " + module.name +
                     "_test.py\"\"\"\n\nimport sys\n\nimport " + module.name + " as robot\n\nSAMPLES = [\n";
  for (const Sample& sample : module.samples) {
    test += "    (";
    for (const auto* const values :
         {&sample.pose, &sample.velocity, &sample.acceleration, &sample.wrench, &sample.start, &sample.joints,
          &sample.jacobian, &sample.margins, &sample.quantities, &sample.forces})
      test += row(*values) + ", ";
    test += "),\n";
  }
  std::string helpers = R"(]
largest = 0.0


def flat(values):
    """The numbers of nested lists."""
    return [values] if isinstance(values, float) else [x for each in values for x in flat(each)]


def compare(computed, expected):
    """Notes the difference of computed and expected values, relative to values above 1; NaN has to agree with NaN."""
    global largest
    computed = [float("inf")] * len(expected) if computed is None else flat(computed)
    for a, b in zip(computed, expected):
        if b != b:
            difference = 0.0 if a != a else float("inf")
        else:
            difference = abs(a - b) / max(1.0, abs(b))
        if not difference <= largest:
            largest = difference if difference == difference else float("inf")


for x, v, a, w, start, joints, jacobians, margins, quantities, forces in SAMPLES:
    compare(robot.inverse(@x), joints)
    compare(robot.jacobian(@x), jacobians)
    compare(robot.margins(@x), margins)
)";
  if (module.values) helpers += "    compare(robot.quantities(@x), quantities)\n";
  if (module.equations && module.has_forward) helpers += "    compare(robot.forces(@x, v, a, w), forces)\n";
  if (module.has_forward) helpers += "    compare(robot.forward(@joints, start), x)\n";
  for (std::size_t at = helpers.find('@'); at != std::string::npos; at = helpers.find('@')) helpers.replace(at, 1, own);
  test += helpers + "print(\"" + module.name + ": largest difference %.2g of " + std::to_string(module.samples.size()) +
          " poses\" % largest)\nsys.exit(0 if largest <= 1e-10 else 1)\n";
  return {{module.name + ".py", text}, {module.name + "_test.py", test}};
}

}  // namespace pkm::code
