// Generates code in C++17: a header and a test program.
#include "engine/export/code/c_like.hpp"
#include "engine/export/code/languages.hpp"

namespace pkm::code {
namespace in_cpp {

/// Declaration of an array. If the name contains a size, such as "poses[20]", it declares an array of arrays.
std::string array(const std::string& name, std::size_t size) {
  return "std::array<real, " + std::to_string(size) + "> " + name;
}

}  // namespace in_cpp

std::vector<File> cpp_files(const Module& module) {
  using namespace in_cpp;
  const std::size_t n = module.coordinates.size(), m = module.joints.size();
  const bool has_parameters = module.options.has_parameters;
  const std::string p = has_parameters ? "const " + array("& p", module.parameters.size()) + ", " : "",
                    given = has_parameters ? "p, " : "", own = "::" + module.name + "::";
  const std::string helpers = with_replacements(helpers_of_c(), "@inline", "inline");
  std::string text =
      "// " + module.title + "\n//\n" + arrays_comment(module, "// ") +
      "// Matrices are stored row by row.\n#pragma once\n\n#include <array>\n#include <cmath>\n\nnamespace " +
      module.name + " {\n\nusing real = " + (module.options.single_precision ? "float" : "double") +
      ";\n\nnamespace detail {\n\n" +
      "using std::acos, std::asin, std::atan, std::atan2, std::ceil, std::cos, std::cosh, std::exp, std::fabs,\n"
      "    std::isfinite, std::log, std::log10, std::pow, std::sin, std::sinh, std::sqrt, std::tan, std::tanh;\n" +
      helpers + "\n}  // namespace detail\n";
  const auto add = [&](const std::string& comment, const std::string& type, const std::string& name,
                       const std::string& arguments, const std::string& body) {
    text += "\n/// " + comment + "\ninline " + type + " " + name + "(" + p + arguments +
            ") {\n  using namespace detail;\n" + body + "}\n";
  };
  const std::string x = "const " + array("& x", n), v = "const " + array("& v", n);
  const auto out = [](const std::string& name, std::size_t size) { return array("& " + name, size); };
  add(module.inverse.meaning + " @return false if the pose does not assemble", "bool", "inverse",
      x + ", " + out("q", m),
      (module.inverse.outputs[1].rows > 0 ? "  " + array("assembly", module.inverse.outputs[1].rows) + "{};\n" : "") +
          body_of_c(module, module.inverse) + "  return " + assembly_condition(module) + ";\n");
  add(module.jacobian.meaning, "void", "jacobian", x + ", " + out("J", m * n), body_of_c(module, module.jacobian));
  add(module.limits.meaning, "void", "margins", x + ", " + out("margins", module.margins.size()),
      body_of_c(module, module.limits));
  if (module.values)
    add(module.values->meaning, "void", "quantities", x + ", " + out("values", module.quantities.size()),
        body_of_c(module, *module.values));
  if (module.has_forward)
    add("Pose of joints q by Newton's method, which starts at x and overwrites it. @return false if it does not "
        "converge",
        "bool", "forward", "const " + array("& q", m) + ", " + out("x", n),
        forward_body_of_c(module, array("found", m) + "{}, change{}, next{};\n  " + array("J", m * n) + "{};",
                          own + "inverse(" + given + "x, found)", own + "inverse(" + given + "next, found)",
                          own + "jacobian(" + given + "x, J)", "J.data()", "found.data()"));
  if (module.equations)
    add(module.equations->meaning, "void", "equations",
        x + ", " + v + ",\n    " + out("J", m * n) + ", " + out("Jdot_v", m) + ", " + out("M", n * n) + ",\n    " +
            out("h", n) + ", " + out("G", n) + ", " + out("Jw", 6 * n),
        body_of_c(module, *module.equations));
  if (has_forces(module))
    add("Drive forces tau for accelerations a and a wrench w on the platform (Fx Fy Fz Mx My Mz). @return false if "
        "the\n"
        "/// pose is singular",
        "bool", "forces",
        x + ", " + v + ",\n    const " + array("& a", n) + ", const " + array("& w", 6) + ",\n    " + out("tau", m),
        forces_body_of_c(module,
                         array("J", m * n) + "{}, transposed{};\n  " + array("M", n * n) + "{};\n  " +
                             array("Jdot_v", m) + "{}, h{}, G{};\n  " + array("Jw", 6 * n) + "{};",
                         own + "equations(" + given + "x, v, J, Jdot_v, M, h, G, Jw)", "transposed.data()",
                         "tau.data()"));
  text += "\n}  // namespace " + module.name + "\n";

  const TestSyntax test{"// " + module.title + "\n//   c++ -std=c++17 -O2 " + module.name +
                            "_test.cpp && ./a.out\n#include \"" + module.name +
                            ".hpp\"\n\n#include <cstdio>\n\nusing " + module.name + "::real;\nusing std::printf;\n\n",
                        module.name + "::",
                        "int main()",
                        array,
                        [](const std::string& numbers) { return "{{" + numbers + "}}"; },
                        [](const std::string& name) { return name + ".data()"; }};
  return {{module.name + ".hpp", text}, {module.name + "_test.cpp", test_of_c(module, test)}};
}

}  // namespace pkm::code
