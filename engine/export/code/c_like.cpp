#include "engine/export/code/c_like.hpp"

#include <algorithm>
#include <cmath>

namespace pkm::code {
namespace c_like {

std::string number(double value, bool single_precision) {
  if (std::isnan(value)) return "NAN";
  if (std::isinf(value)) return value > 0 ? "INFINITY" : "(-INFINITY)";
  std::string text = shortest_number(value);
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  if (single_precision) text += 'f';
  return value < 0 ? "(" + text + ")" : text;
}

std::string input(const InputPlace& place) {
  return std::string(1, place.array) + "[" + std::to_string(place.index) + "]";
}

std::string call(const std::string& operation, const std::vector<std::string>& x) {
  if (operation == "negate") return "(-" + x[0] + ")";
  if (operation == "+" || operation == "-" || operation == "*" || operation == "/")
    return "(" + x[0] + " " + operation + " " + x[1] + ")";
  static const std::vector<std::pair<std::string, std::string>> kNames = {
      {"abs", "fabs"},     {"min", "minimum"},   {"max", "maximum"}, {"sign", "sign_of"},
      {"turn", "wrapped"}, {"?", "choose"},      {"<", "is_less"},   {"<=", "is_less_equal"},
      {"==", "is_equal"},  {"!=", "is_unequal"}, {"&&", "both"},     {"||", "either"},
      {"^", "pow"}};
  if (operation == ">") return call("<", {x[1], x[0]});
  if (operation == ">=") return call("<=", {x[1], x[0]});
  std::string name = operation;
  for (const auto& [of, own] : kNames)
    if (operation == of) name = own;
  std::string text = name + "(";
  for (std::size_t i = 0; i < x.size(); ++i) text += (i > 0 ? ", " : "") + without_parentheses(x[i]);
  return text + ")";
}

std::string define(const std::string& name, const std::string& expression) {
  return "const real " + name + " = " + expression + ";";
}

std::string numbers(const std::vector<double>& values, bool single_precision) {
  std::string text;
  for (const double value : values)
    text += (text.empty() ? "" : ", ") + without_parentheses(number(value, single_precision));
  return text;
}

}  // namespace c_like

const Syntax kSyntaxOfC = {c_like::number, c_like::input, c_like::call, c_like::define};

std::string helpers_of_c() {
  return R"(
/* Comparisons and choices give NaN if an argument is NaN. */
@inline real minimum(real a, real b) { return b < a || b != b ? b : a; }
@inline real maximum(real a, real b) { return b > a || b != b ? b : a; }
@inline real sign_of(real a) { return a > 0 ? 1 : a < 0 ? -1 : a; }
@inline real truth(int is, real a, real b) { return a == a && b == b ? (real)is : (real)NAN; }
@inline real is_less(real a, real b) { return truth(a < b, a, b); }
@inline real is_less_equal(real a, real b) { return truth(a <= b, a, b); }
@inline real is_equal(real a, real b) { return truth(a == b, a, b); }
@inline real is_unequal(real a, real b) { return truth(a != b, a, b); }
@inline real both(real a, real b) { return truth(a != 0 && b != 0, a, b); }
@inline real either(real a, real b) { return truth(a != 0 || b != 0, a, b); }
@inline real choose(real condition, real a, real b) { return condition != condition ? (real)NAN : condition != 0 ? a : b; }
/* An angle in (-pi, pi]. */
@inline real wrapped(real angle) {
  const real pi = (real)3.141592653589793238;
  return angle - ceil(angle / (2 * pi) - (real)0.5) * (2 * pi);
}

/* Solves A y = b by Gaussian elimination with partial pivoting; overwrites A and b. Returns 0 if A is singular. */
@inline int solve(int n, real* A, real* b) {
  for (int k = 0; k < n; ++k) {
    int pivot = k;
    for (int i = k + 1; i < n; ++i)
      if (fabs(A[i * n + k]) > fabs(A[pivot * n + k])) pivot = i;
    if (!(fabs(A[pivot * n + k]) > 0)) return 0;
    for (int j = 0; j < n && pivot != k; ++j) {
      const real other = A[k * n + j];
      A[k * n + j] = A[pivot * n + j];
      A[pivot * n + j] = other;
    }
    const real first = b[k];
    b[k] = b[pivot];
    b[pivot] = first;
    for (int i = k + 1; i < n; ++i) {
      const real factor = A[i * n + k] / A[k * n + k];
      for (int j = k; j < n; ++j) A[i * n + j] -= factor * A[k * n + j];
      b[i] -= factor * b[k];
    }
  }
  for (int i = n; i-- > 0;) {
    for (int j = i + 1; j < n; ++j) b[i] -= A[i * n + j] * b[j];
    b[i] /= A[i * n + i];
  }
  return 1;
}
)";
}

std::string body_of_c(const Module& module, const Function& function) {
  return body_of(module, function, kSyntaxOfC, "  ", [](const Output& output, const std::string* values) {
    std::string text;
    for (std::size_t i = 0; i < output.nodes.size(); ++i)
      text += "  " + output.name + "[" + std::to_string(i) + "] = " + values[i] + ";\n";
    return text;
  });
}

std::string assembly_condition(const Module& module) {
  std::string text;
  const auto add = [&](const std::string& condition) { text += (text.empty() ? "" : " && ") + condition; };
  for (std::size_t i = 0; i < module.inverse.outputs[0].rows; ++i) add("isfinite(q[" + std::to_string(i) + "])");
  for (std::size_t i = 0; i < module.inverse.outputs[1].rows; ++i) add("assembly[" + std::to_string(i) + "] >= 0");
  return text;
}

std::string forward_body_of_c(const Module& module, const std::string& locals, const std::string& inverse_of_x,
                              const std::string& inverse_of_next, const std::string& jacobian, const std::string& J,
                              const std::string& found) {
  const std::string n = std::to_string(module.coordinates.size());
  // Newton's method in the generated code: a step to a pose at which the inverse kinematics has no solution is halved.
  // Near a solution, steps become smaller until rounding errors dominate; then the iteration ends.
  return "  " + locals + R"(
  real last = INFINITY;
  if (!)" +
         inverse_of_x + R"() return 0;
  for (int step = 0; step < 100; ++step) {
    )" + jacobian +
         R"(;
    for (int i = 0; i < )" +
         n + R"(; ++i) found[i] = q[i] - found[i];
    if (!solve()" +
         n + ", " + J + ", " + found + R"()) return 0;
    real size = 0, scale = 1;
    for (int i = 0; i < )" +
         n + R"(; ++i) size = maximum(size, fabs(found[i]));
    if (!(size < last) && last < (real))" +
         (module.options.single_precision ? "1e-3" : "1e-8") + R"() return 1;
    last = size;
    for (int i = 0; i < )" +
         n + R"(; ++i) change[i] = found[i];
    do {
      for (int i = 0; i < )" +
         n + R"(; ++i) next[i] = x[i] + scale * change[i];
      scale /= 2;
    } while (!)" +
         inverse_of_next + R"( && scale > (real)1e-6);
    if (!(scale > (real)1e-6)) return 0;
    for (int i = 0; i < )" +
         n + R"(; ++i) x[i] = next[i];
  }
  return 0;
)";
}

std::string forces_body_of_c(const Module& module, const std::string& locals, const std::string& equations,
                             const std::string& transposed, const std::string& tau) {
  const std::string n = std::to_string(module.coordinates.size());
  return "  " + locals + "\n  " + equations + R"(;
  for (int i = 0; i < )" +
         n + R"(; ++i) {
    tau[i] = h[i] + G[i];
    for (int j = 0; j < )" +
         n + R"(; ++j) tau[i] += M[i * )" + n + R"( + j] * a[j];
    for (int j = 0; j < 6; ++j) tau[i] -= Jw[j * )" +
         n + R"( + i] * w[j];
    for (int j = 0; j < )" +
         n + "; ++j) transposed[i * " + n + " + j] = J[j * " + n + R"( + i];
  }
  return solve()" +
         n + ", " + transposed + ", " + tau + ");\n";
}

std::string arrays_comment(const Module& module, const std::string& mark) {
  std::string text;
  const auto add = [&](const std::string& array, const std::vector<NamedUnit>& elements) {
    if (!elements.empty()) text += mark + array + ": " + elements_text(elements) + "\n";
  };
  if (module.options.has_parameters) add("p, the parameters", module.parameters);
  add("x, the coordinates of a pose", module.coordinates);
  add("q, the joints", module.joints);
  add("margins", module.margins);
  add("values of quantities", module.quantities);
  for (const std::string& sentence : module.left_out) text += mark + sentence + "\n";
  return text;
}

std::string test_of_c(const Module& module, const TestSyntax& syntax) {
  const bool single = module.options.single_precision;
  const std::size_t n = module.coordinates.size(), m = module.joints.size(), samples = module.samples.size();
  const auto table = [&](const std::string& name, std::size_t width, std::vector<double> Sample::*member) {
    std::string text = "static const " + syntax.array(name + "[" + std::to_string(samples) + "]", width) + " = {\n";
    for (const Sample& sample : module.samples)
      text += "  " + syntax.row(c_like::numbers(sample.*member, single)) + ",\n";
    return text + "};\n";
  };
  const auto call = [&](const char* function, const std::string& arguments) {
    return syntax.prefix + function + "(" + (module.options.has_parameters ? "parameters, " : "") + arguments + ")";
  };
  const auto compare = [&](const std::string& computed, const std::string& expected, std::size_t count) {
    return "    compare(" + std::to_string(count) + ", " + syntax.pointer(computed) + ", " + syntax.pointer(expected) +
           ");\n";
  };
  const auto expect = [](const std::string& condition) {
    return "    if (!" + condition + ") largest = (real)1e30;\n";
  };

  std::string text = syntax.begin;
  if (module.options.has_parameters)
    text += "static const " + syntax.array("parameters", module.design.size()) + " = " +
            syntax.row(c_like::numbers(module.design, single)) + ";\n";
  text += table("poses", n, &Sample::pose) + table("joints", m, &Sample::joints) +
          table("jacobians", m * n, &Sample::jacobian) + table("margins", module.margins.size(), &Sample::margins);
  if (module.values) text += table("quantities", module.quantities.size(), &Sample::quantities);
  if (module.has_forward) text += table("starts", n, &Sample::start);
  if (has_forces(module))
    text += table("velocities", n, &Sample::velocity) + table("accelerations", n, &Sample::acceleration) +
            table("wrenches", 6, &Sample::wrench) + table("forces", m, &Sample::forces);
  text += R"(
static real largest = 0;

/* Notes the difference of computed and expected values, relative to values above 1; NaN has to agree with NaN. */
static void compare(int count, const real* computed, const real* expected) {
  for (int i = 0; i < count; ++i) {
    const real size = expected[i] < 0 ? -expected[i] : expected[i];
    real difference = (computed[i] - expected[i]) / (size > 1 ? size : 1);
    if (difference < 0) difference = -difference;
    if (expected[i] != expected[i]) difference = computed[i] != computed[i] ? (real)0 : (real)1e30;
    if (!(difference <= largest)) largest = difference == difference ? difference : (real)1e30;
  }
}

)" + syntax.main +
          " {\n  for (int k = 0; k < " + std::to_string(samples) + "; ++k) {\n";
  const auto declare = [&](const std::string& name, std::size_t size) {
    text += "    " + syntax.array(name, size) + ";\n";
  };
  declare("q", m);
  text += expect(call("inverse", "poses[k], q")) + compare("q", "joints[k]", m);
  declare("J", m * n);
  text += "    " + call("jacobian", "poses[k], J") + ";\n" + compare("J", "jacobians[k]", m * n);
  declare("found_margins", module.margins.size());
  text += "    " + call("margins", "poses[k], found_margins") + ";\n" +
          compare("found_margins", "margins[k]", module.margins.size());
  if (module.values) {
    declare("values", module.quantities.size());
    text += "    " + call("quantities", "poses[k], values") + ";\n" +
            compare("values", "quantities[k]", module.quantities.size());
  }
  if (has_forces(module)) {
    declare("tau", m);
    text += expect(call("forces", "poses[k], velocities[k], accelerations[k], wrenches[k], tau")) +
            compare("tau", "forces[k]", m);
  }
  if (module.has_forward) {
    declare("x", n);
    text += "    for (int i = 0; i < " + std::to_string(n) + "; ++i) x[i] = starts[k][i];\n" +
            expect(call("forward", "joints[k], x")) + compare("x", "poses[k]", n);
  }
  return text + "  }\n  printf(\"" + module.name + ": largest difference %.2g of " + std::to_string(samples) +
         " poses\\n\", (double)largest);\n  return largest <= " + (single ? "(real)1e-2" : "1e-10") + " ? 0 : 1;\n}\n";
}

}  // namespace pkm::code
