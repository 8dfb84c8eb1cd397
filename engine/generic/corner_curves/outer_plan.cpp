#include "engine/generic/corner_curves/outer_plan.hpp"

#include <algorithm>
#include <numeric>

namespace pkm::generic::corner_curves {
namespace {

using expression::Code;
using expression::Program;

/// Whether the function with this name is analytic wherever it is defined; used for operations that have no Code of
/// their own.
bool is_analytic(const std::string& name) {
  static const std::vector<std::string> names = {"sin", "cos", "exp", "sinh", "cosh", "tanh", "atan"};
  return std::ranges::find(names, name) != names.end();
}

/// If the result of a step of the program is not analytic at the roots of a certain function, returns this function,
/// otherwise std::nullopt.
/// @param is_supported  set to false if the result may not be analytic at other points, either
std::optional<OuterFunction> function_at_singularities(const Program::Step& step, bool& is_supported) {
  using Kind = OuterFunction::Kind;
  switch (step.code) {
    case Code::sqrt:
      return OuterFunction{.registers = {step.from[0]}, .has_root = true};
    case Code::abs:
      return OuterFunction{.registers = {step.from[0]}};
    case Code::divide:
      return OuterFunction{.registers = {step.from[1]}};
    case Code::min:
    case Code::max:
      return OuterFunction{.kind = Kind::difference, .registers = {step.from[0], step.from[1]}};
    case Code::solve:
      is_supported = false;
      return {};
    case Code::other:
      if (step.operation->name == "asin" || step.operation->name == "acos")
        return OuterFunction{.kind = Kind::one_minus_square, .registers = {step.from[0]}, .has_root = true};
      if (!is_analytic(step.operation->name)) is_supported = false;
      return {};
    default:
      return {};
  }
}

}  // namespace

double OuterFunction::value(const std::array<double, 3>& x) const {
  switch (kind) {
    case Kind::value:
      return x[0];
    case Kind::difference:
      return x[0] - x[1];
    case Kind::one_minus_square:
      return (1 - x[0]) * (1 + x[0]);
    case Kind::discriminant:
      break;
  }
  return x[1] * x[1] - 4 * x[0] * x[2];
}

std::array<double, 3> OuterFunction::derivatives(const std::array<double, 3>& x) const {
  switch (kind) {
    case Kind::value:
      return {1, 0, 0};
    case Kind::difference:
      return {1, -1, 0};
    case Kind::one_minus_square:
      return {-2 * x[0], 0, 0};
    case Kind::discriminant:
      break;
  }
  return {-4 * x[2], 2 * x[1], -4 * x[0]};
}

OuterPlan::OuterPlan(const SlicePlan& plan) {
  if (!plan.order.v || plan.order.outer.size() != 1) {
    why_not = "corner curves need two inner coordinates and one outer coordinate";
    return;
  }
  const Program& program = plan.program;
  std::vector<double> numbers(program.registers());
  program.start<double>(numbers);
  const auto is_number = [&](std::uint32_t at) { return program.stage_of()[at] < 0; };
  const auto is_zero = [&](std::uint32_t at) { return is_number(at) && numbers[at] == 0; };
  const auto varies = [&](std::uint32_t at) { return program.stage_of()[at] == 1; };

  bool is_supported = true;
  for (const Program::Step& step : program.stages()[1].steps) {
    const auto function = function_at_singularities(step, is_supported);
    if (!is_supported) {
      why_not = "a formula of the outer coordinate contains '" + step.operation->name + "'";
      return;
    }
    if (function && std::ranges::any_of(std::span(function->registers).first(function->arguments()), varies))
      functions.push_back(*function);
  }
  for (const std::uint32_t at : plan.independent[1]) functions.push_back({.registers = {at}, .is_required = true});
  for (const Surface& surface : plan.surfaces) {
    const auto& c = surface.coefficients;
    const auto zero = [&](std::initializer_list<std::size_t> which) {
      return std::ranges::all_of(which, [&](std::size_t i) { return is_zero(c[i]); });
    };
    const bool is_round = c[3] == c[5] || (is_number(c[3]) && is_number(c[5]) && numbers[c[3]] == numbers[c[5]]);
    const auto discriminant = [&](std::uint32_t b, std::uint32_t a) {
      functions.push_back({.kind = OuterFunction::Kind::discriminant, .registers = {c[0], b, a}, .has_root = true});
    };
    if (zero({1, 2, 3, 4, 5})) {
      shapes.push_back(Shape::constant);
      if (varies(c[0])) functions.push_back({.registers = {c[0]}});
    } else if (zero({3, 4, 5})) {
      shapes.push_back(Shape::line);
    } else if (is_round && zero({4})) {
      shapes.push_back(Shape::circle);
    } else if (zero({2, 4, 5})) {
      shapes.push_back(Shape::strip_along_v);
      discriminant(c[1], c[3]);
    } else if (zero({1, 3, 4})) {
      shapes.push_back(Shape::strip_along_z);
      discriminant(c[2], c[5]);
    } else {
      shapes.push_back(Shape::conic);
    }
  }
  std::vector<std::uint32_t> all(program.registers());
  std::iota(all.begin(), all.end(), 0);
  stage.emplace(program, 1, all);
}

}  // namespace pkm::generic::corner_curves
