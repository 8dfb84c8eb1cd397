// Generates code in C99: a header, a source file and a test program.
#include "engine/export/code/c_like.hpp"
#include "engine/export/code/languages.hpp"

namespace pkm::code {
namespace in_c {

std::string array(const std::string& name, std::size_t size) {
  return "real " + name + "[" + std::to_string(std::max<std::size_t>(1, size)) + "]";
}

std::string assembly_array(const Module& module) {
  const std::size_t rows = module.inverse.outputs[1].rows;
  return rows > 0 ? "  " + array("assembly", rows) + ";\n" : "";
}

/// Declarations of all generated functions, without semicolons; each member is named after its function.
struct Declarations {
  std::string inverse, jacobian, margins, quantities, equations, forces, forward;

  explicit Declarations(const Module& module) {
    const std::size_t n = module.coordinates.size(), m = module.joints.size();
    const std::string p = module.options.has_parameters ? "const " + array("p", module.parameters.size()) + ", " : "";
    const auto named = [&](const std::string& type, const std::string& name, const std::string& arguments) {
      return type + " " + module.name + "_" + name + "(" + p + arguments + ")";
    };
    const std::string x = "const " + array("x", n), v = "const " + array("v", n);
    inverse = named("int", "inverse", x + ", " + array("q", m));
    jacobian = named("void", "jacobian", x + ", " + array("J", m * n));
    margins = named("void", "margins", x + ", " + array("margins", module.margins.size()));
    quantities = named("void", "quantities", x + ", " + array("values", module.quantities.size()));
    forward = named("int", "forward", "const " + array("q", m) + ", " + array("x", n));
    equations = named("void", "equations",
                      x + ", " + v + ",\n    " + array("J", m * n) + ", " + array("Jdot_v", m) + ", " +
                          array("M", n * n) + ", " + array("h", n) + ", " + array("G", n) + ", " + array("Jw", 6 * n));
    forces =
        named("int", "forces",
              x + ", " + v + ",\n    const " + array("a", n) + ", const " + array("w", 6) + ", " + array("tau", m));
  }
};

std::string header(const Module& module, const Declarations& d) {
  std::string guard = module.name + "_h";
  for (char& c : guard) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  std::string text = "/* " + module.title + "\n *\n" + arrays_comment(module, " * ") +
                     " * Matrices are stored row by row. */\n#ifndef " + guard + "\n#define " + guard +
                     "\n\n#ifdef __cplusplus\nextern \"C\" {\n#endif\n\ntypedef " +
                     (module.options.single_precision ? "float" : "double") + " real;\n\n";
  const auto add = [&](const std::string& comment, const std::string& declaration) {
    text += "/* " + comment + " */\n" + declaration + ";\n";
  };
  add(module.inverse.meaning + " Returns 0 if the pose does not assemble.", d.inverse);
  add(module.jacobian.meaning, d.jacobian);
  add(module.limits.meaning, d.margins);
  if (module.values) add(module.values->meaning, d.quantities);
  if (module.has_forward)
    add("Pose of joints q by Newton's method, which starts at x and overwrites it. Returns 0 if it does not converge.",
        d.forward);
  if (module.equations) add(module.equations->meaning, d.equations);
  if (has_forces(module))
    add("Drive forces tau for accelerations a and a wrench w on the platform (Fx Fy Fz Mx My Mz). Returns 0 if the\n"
        " * pose is singular.",
        d.forces);
  return text + "\n#ifdef __cplusplus\n}\n#endif\n\n#endif\n";
}

std::string source(const Module& module, const Declarations& d) {
  const std::string n = std::to_string(module.coordinates.size()), m = std::to_string(module.joints.size());
  const std::string p = module.options.has_parameters ? "p, " : "", own = module.name + "_";
  const std::string helpers = with_replacements(helpers_of_c(), "@inline", "static inline");
  std::string text =
      "/* " + module.title + " */\n#include \"" + module.name + ".h\"\n\n#include <tgmath.h>\n" + helpers;
  text += "\n" + d.inverse + " {\n" + assembly_array(module) + body_of_c(module, module.inverse) + "  return " +
          assembly_condition(module) + ";\n}\n";
  text += "\n" + d.jacobian + " {\n" + body_of_c(module, module.jacobian) + "}\n";
  text += "\n" + d.margins + " {\n" + body_of_c(module, module.limits) + "}\n";
  if (module.values) text += "\n" + d.quantities + " {\n" + body_of_c(module, *module.values) + "}\n";
  if (module.has_forward)
    text += "\n" + d.forward + " {\n" +
            forward_body_of_c(module,
                              "real found[" + m + "], J[" + m + " * " + n + "], change[" + n + "], next[" + n + "];",
                              own + "inverse(" + p + "x, found)", own + "inverse(" + p + "next, found)",
                              own + "jacobian(" + p + "x, J)", "J", "found") +
            "}\n";
  if (module.equations) text += "\n" + d.equations + " {\n" + body_of_c(module, *module.equations) + "}\n";
  if (has_forces(module))
    text += "\n" + d.forces + " {\n" +
            forces_body_of_c(module,
                             "real J[" + m + " * " + n + "], Jdot_v[" + m + "], M[" + n + " * " + n + "], h[" + n +
                                 "], G[" + n + "], Jw[6 * " + n + "], transposed[" + m + " * " + n + "];",
                             own + "equations(" + p + "x, v, J, Jdot_v, M, h, G, Jw)", "transposed", "tau") +
            "}\n";
  return text;
}

}  // namespace in_c

std::vector<File> c_files(const Module& module) {
  using namespace in_c;
  const Declarations declarations(module);
  const TestSyntax test{"/* " + module.title + "\n *   cc -O2 " + module.name + ".c " + module.name +
                            "_test.c -lm && ./a.out */\n#include \"" + module.name +
                            ".h\"\n\n#include <stdio.h>\n\n#include <math.h>\n\n",
                        module.name + "_",
                        "int main(void)",
                        array,
                        [](const std::string& numbers) { return "{" + (numbers.empty() ? "0" : numbers) + "}"; },
                        [](const std::string& name) { return name; }};
  return {{module.name + ".h", header(module, declarations)},
          {module.name + ".c", source(module, declarations)},
          {module.name + "_test.c", test_of_c(module, test)}};
}

}  // namespace pkm::code
