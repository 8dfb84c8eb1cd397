// Generates code for MATLAB and Octave: a package folder with one file per function, and a test script.
#include <cmath>

#include "engine/export/code/languages.hpp"
#include "engine/export/code/statements.hpp"

namespace pkm::code {
namespace in_matlab {

std::string number(double value, bool) {
  if (std::isnan(value)) return "NaN";
  if (std::isinf(value)) return value > 0 ? "Inf" : "(-Inf)";
  const std::string text = shortest_number(value);
  return value < 0 ? "(" + text + ")" : text;
}

std::string input(const InputPlace& place) {
  return std::string(1, place.array) + "(" + std::to_string(place.index + 1) + ")";
}

std::string call(const std::string& operation, const std::vector<std::string>& x) {
  if (operation == "negate") return "(-" + x[0] + ")";
  if (operation == "+" || operation == "-" || operation == "*" || operation == "/")
    return "(" + x[0] + " " + operation + " " + x[1] + ")";
  if (operation == ">") return call("<", {x[1], x[0]});
  if (operation == ">=") return call("<=", {x[1], x[0]});
  static const std::vector<std::pair<std::string, std::string>> kNames = {
      {"min", "minimum"},    {"max", "maximum"},      {"turn", "wrapped"}, {"?", "choose"},
      {"<", "is_less"},      {"<=", "is_less_equal"}, {"==", "is_equal"},  {"!=", "is_unequal"},
      {"&&", "both"},        {"||", "either"},        {"^", "real_power"}, {"sqrt", "real_sqrt"},
      {"asin", "real_asin"}, {"acos", "real_acos"},   {"log", "real_log"}, {"log10", "real_log10"}};
  std::string name = operation;
  for (const auto& [of, own] : kNames)
    if (operation == of) name = own;
  std::string text = name + "(";
  for (std::size_t i = 0; i < x.size(); ++i) text += (i > 0 ? ", " : "") + without_parentheses(x[i]);
  return text + ")";
}

const Syntax kSyntax = {number, input, call, [](const std::string& name, const std::string& expression) {
                          return name + " = " + expression + ";";
                        }};

/// Names and texts of local functions; each is added to the files that call it. In them, undefined values are NaN
/// instead of complex numbers.
const std::vector<std::pair<std::string, std::string>> kHelpers = {
    {"minimum", "y = a; if b < a || isnan(b), y = b; end"},
    {"maximum", "y = a; if b > a || isnan(b), y = b; end"},
    {"is_less", "y = truth(a < b, a, b);"},
    {"is_less_equal", "y = truth(a <= b, a, b);"},
    {"is_equal", "y = truth(a == b, a, b);"},
    {"is_unequal", "y = truth(a ~= b, a, b);"},
    {"both", "y = truth(a ~= 0 && b ~= 0, a, b);"},
    {"either", "y = truth(a ~= 0 || b ~= 0, a, b);"},
    {"real_power", "y = a^b; if ~isreal(y), y = NaN; end"},
    {"wrapped", "y = a - ceil(a / (2 * pi) - 0.5) * (2 * pi);"},
    {"real_sqrt", "y = NaN; if a >= 0, y = sqrt(a); end"},
    {"real_asin", "y = NaN; if abs(a) <= 1, y = asin(a); end"},
    {"real_acos", "y = NaN; if abs(a) <= 1, y = acos(a); end"},
    {"real_log", "y = NaN; if a >= 0, y = log(a); end"},
    {"real_log10", "y = NaN; if a >= 0, y = log10(a); end"}};

std::string helpers_for(const std::string& code) {
  std::string text;
  bool needs_truth = false;
  for (const auto& [name, body] : kHelpers) {
    if (code.find(name + "(") == std::string::npos) continue;
    const bool has_one = name == "wrapped" || (name.starts_with("real_") && name != "real_power");
    text += "\nfunction y = " + name + (has_one ? "(a)\n  " : "(a, b)\n  ") + body + "\nend\n";
    needs_truth = needs_truth || body.find("truth(") != std::string::npos;
  }
  if (code.find("choose(") != std::string::npos)
    text +=
        "\nfunction y = choose(condition, a, b)\n  y = NaN;\n  if condition ~= 0 && ~isnan(condition), y = a; elseif "
        "condition == 0, y = b; end\nend\n";
  if (needs_truth)
    text += "\nfunction y = truth(value, a, b)\n  y = NaN;\n  if ~isnan(a) && ~isnan(b), y = double(value); end\nend\n";
  return text;
}

std::string matrix(const std::string* values, const Output& output) {
  std::string text = "[";
  for (std::size_t i = 0; i < output.rows; ++i) {
    text += i > 0 ? "; " : "";
    for (std::size_t j = 0; j < output.columns; ++j) text += (j > 0 ? ", (" : "(") + *values++ + ")";
  }
  return text + "]";
}

std::string body(const Module& module, const Function& function) {
  return body_of(module, function, kSyntax, "  ", [](const Output& output, const std::string* values) {
    return "  " + output.name + " = " + matrix(values, output) + ";\n";
  });
}

std::string row(const std::vector<double>& values) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "" : " ") + without_parentheses(number(value, false));
  return text;
}

}  // namespace in_matlab

std::vector<File> matlab_files(const Module& module) {
  using namespace in_matlab;
  const std::string p = module.options.has_parameters ? "p, " : "", package = module.name;
  std::string arrays;
  const auto describe = [&](const std::string& array, const std::vector<NamedUnit>& elements) {
    if (!elements.empty()) arrays += "%   " + array + ": " + elements_text(elements) + "\n";
  };
  if (module.options.has_parameters) describe("p, the parameters", module.parameters);
  describe("x, the coordinates of a pose", module.coordinates);
  describe("q, the joints", module.joints);
  for (const std::string& sentence : module.left_out) arrays += "%   " + sentence + "\n";
  std::vector<File> files;
  const auto add = [&](const std::string& results, const std::string& name, const std::string& arguments,
                       const std::string& meaning, const std::string& code) {
    std::string upper = name;
    for (char& c : upper) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    files.push_back({"+" + package + "/" + name + ".m", "function " + results + " = " + name + "(" + p + arguments +
                                                            ")\n% " + upper + " " + meaning + "\n" + arrays + "% " +
                                                            module.title + "\n" + code + "end\n" + helpers_for(code)});
  };
  add("q", "inverse", "x", module.inverse.meaning + " Empty if the pose does not assemble.",
      body(module, module.inverse) + "  if ~all(isfinite(q)) || ~all(assembly >= 0), q = []; end\n");
  add("J", "jacobian", "x", module.jacobian.meaning, body(module, module.jacobian));
  std::string margins;
  for (const NamedUnit& margin : module.margins) margins += (margins.empty() ? "" : ", ") + margin.name;
  add("margins", "margins", "x", module.limits.meaning + "\n%   margins: " + margins, body(module, module.limits));
  if (module.values)
    add("values", "quantities", "x", module.values->meaning + "\n%   values: " + elements_text(module.quantities),
        body(module, *module.values));
  if (module.has_forward)
    add("x", "forward", "q, x", "Pose of joints q by Newton's method from the pose x. Empty if it does not converge.",
        "  x = x(:); last = Inf;\n"
        "  found = " +
            package + ".inverse(" + p +
            "x);\n"
            "  for step = 1:100\n"
            "    if isempty(found), break; end\n"
            "    change = " +
            package + ".jacobian(" + p +
            "x) \\ (q(:) - found);\n"
            "    size_of_change = max(abs(change)); scale = 1;\n"
            "    if ~(size_of_change < last) && last < 1e-8, return; end\n"
            "    last = size_of_change; found = [];\n"
            "    while isempty(found) && scale > 1e-6\n"
            "      following = x + scale * change;\n"
            "      found = " +
            package + ".inverse(" + p +
            "following); scale = scale / 2;\n"
            "    end\n"
            "    x = following;\n"
            "  end\n"
            "  x = [];\n");
  if (module.equations) {
    add("[J, Jdot_v, M, h, G, Jw]", "equations", "x, v", module.equations->meaning, body(module, *module.equations));
    if (module.has_forward)
      add("tau", "forces", "x, v, a, w",
          "Drive forces for accelerations a and a wrench w on the platform (Fx Fy Fz Mx My Mz).",
          "  [J, ~, M, h, G, Jw] = " + package + ".equations(" + p +
              "x, v);\n"
              "  tau = J' \\ (M * a(:) + h + G - Jw' * w(:));\n");
  }

  const std::string own = module.options.has_parameters ? "p, " : "";
  std::string test =
      "% Compares the functions of +" + package + " with values of pkmopt.\nfunction " + package + "_test()\n";
  if (module.options.has_parameters) test += "  p = [" + row(module.design) + "];\n";
  const auto table = [&](const std::string& name, std::vector<double> Sample::*member) {
    test += "  " + name + " = [\n";
    for (const Sample& sample : module.samples) test += "    " + row(sample.*member) + "\n";
    test += "  ];\n";
  };
  table("poses", &Sample::pose);
  table("joints", &Sample::joints);
  table("jacobians", &Sample::jacobian);
  table("margins", &Sample::margins);
  if (module.values) table("quantities", &Sample::quantities);
  const bool has_forces = module.equations && module.has_forward;
  if (module.has_forward) table("starts", &Sample::start);
  if (has_forces) {
    table("velocities", &Sample::velocity);
    table("accelerations", &Sample::acceleration);
    table("wrenches", &Sample::wrench);
    table("forces", &Sample::forces);
  }
  const std::string call = package + ".";
  test += "  largest = 0;\n  for k = 1:" + std::to_string(module.samples.size()) + "\n    x = poses(k, :);\n";
  const auto compare = [&](const std::string& computed, const std::string& expected) {
    test += "    largest = max(largest, difference(" + computed + ", " + expected + "));\n";
  };
  compare(call + "inverse(" + own + "x)", "joints(k, :)");
  compare("reshape(" + call + "jacobian(" + own + "x)', 1, [])", "jacobians(k, :)");
  compare(call + "margins(" + own + "x)", "margins(k, :)");
  if (module.values) compare(call + "quantities(" + own + "x)", "quantities(k, :)");
  if (has_forces)
    compare(call + "forces(" + own + "x, velocities(k, :), accelerations(k, :), wrenches(k, :))", "forces(k, :)");
  if (module.has_forward) compare(call + "forward(" + own + "joints(k, :), starts(k, :))", "x");
  test += "  end\n  fprintf('" + module.name + ": largest difference %.2g of " + std::to_string(module.samples.size()) +
          " poses\\n', largest);\n  if ~(largest <= 1e-10), error('the values differ'); end\nend\n\n" +
          "function d = difference(computed, expected)\n"
          "% Relative to values above 1; NaN has to agree with NaN.\n"
          "  if numel(computed) ~= numel(expected), d = Inf; return; end\n"
          "  computed = computed(:)'; d = abs(computed - expected) ./ max(1, abs(expected));\n"
          "  d(isnan(computed) & isnan(expected)) = 0;\n"
          "  d(isnan(d)) = Inf;\n"
          "  d = max([0 d]);\n"
          "end\n";
  files.push_back({package + "_test.m", test});
  return files;
}

}  // namespace pkm::code
