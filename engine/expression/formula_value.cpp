#include "engine/expression/formula_value.hpp"

#include <array>

namespace pkm::expression {
namespace {

using Arguments = std::span<const FormulaValue>;

const Term* scalar(const FormulaValue& value) { return std::get_if<Term>(&value); }
const Vector3* vector(const FormulaValue& value) { return std::get_if<Vector3>(&value); }
const Rotation* rotation(const FormulaValue& value) { return std::get_if<Rotation>(&value); }

Vector3 negative(const Vector3& v) { return {-v[0], -v[1], -v[2]}; }

std::optional<FormulaValue> sum(const FormulaValue& x, const FormulaValue& y, bool minus) {
  const Vector3 *const v = vector(x), *const w = vector(y);
  if (!v || !w) return {};
  return minus ? *v - *w : *v + *w;
}

std::optional<FormulaValue> product(const FormulaValue& x, const FormulaValue& y) {
  if (const Vector3* const v = vector(y)) {
    if (const Term* const factor = scalar(x)) return *v * *factor;
    if (const Rotation* const R = rotation(x)) return *R * *v;
  }
  if (const Vector3* const v = vector(x))
    if (const Term* const factor = scalar(y)) return *v * *factor;
  const Rotation *const A = rotation(x), *const B = rotation(y);
  if (A && B) return *A * *B;
  return {};
}

/// condition ? v : w for vectors, element by element
std::optional<FormulaValue> chosen(Arguments arguments) {
  const Term* const condition = scalar(arguments[0]);
  const Vector3 *const v = vector(arguments[1]), *const w = vector(arguments[2]);
  if (!condition || !v || !w) return {};
  Graph& graph = condition->graph();
  const auto element = [&](std::size_t i) {
    return Term(graph, graph.apply(choice(), std::array{condition->node(), (*v)[i].node(), (*w)[i].node()}));
  };
  return Vector3{element(0), element(1), element(2)};
}

const Vector3& v(const FormulaValue& value) { return std::get<Vector3>(value); }

}  // namespace

std::vector<Term> elements(const FormulaValue& value) {
  if (const Term* const term = scalar(value)) return {*term};
  std::vector<Term> all;
  const auto add = [&](const Vector3& v) { all.insert(all.end(), v.begin(), v.end()); };
  const Frame* const frame = std::get_if<Frame>(&value);
  if (const Vector3* const v = vector(value)) add(*v);
  if (frame) add(frame->origin);
  if (const Rotation* const R = frame ? &frame->rotation : rotation(value))
    for (const Vector3& row : *R) add(row);
  return all;
}

std::string kind_of(const FormulaValue& value) {
  constexpr std::array kKinds = {"a scalar", "a vector", "a rotation", "a frame"};
  return kKinds[value.index()];
}

const std::vector<VectorFunction>& vector_functions() {
  static const std::string vector = "a vector", scalar = "a scalar", rotation = "a rotation", frame = "a frame";
  const auto first = [](Arguments x) { return v(x[0]); };
  static const std::vector<VectorFunction> all = {
      {"dot", {vector, vector}, [](Arguments x) -> FormulaValue { return dot(v(x[0]), v(x[1])); }},
      {"cross", {vector, vector}, [](Arguments x) -> FormulaValue { return cross(v(x[0]), v(x[1])); }},
      {"det",
       {vector, vector, vector},
       [](Arguments x) -> FormulaValue { return dot(v(x[0]), cross(v(x[1]), v(x[2]))); }},
      {"norm", {vector}, [](Arguments x) -> FormulaValue { return length(v(x[0])); }, first},
      {"unit", {vector}, [](Arguments x) -> FormulaValue { return v(x[0]) / length(v(x[0])); }, first},
      {"angle",
       {vector, vector},
       [](Arguments x) -> FormulaValue { return atan2(length(cross(v(x[0]), v(x[1]))), dot(v(x[0]), v(x[1]))); },
       [](Arguments x) { return cross(v(x[0]), v(x[1])); }},
      {"rotation",
       {vector, scalar},
       [](Arguments x) -> FormulaValue { return rotation_about(v(x[0]) / length(v(x[0])), std::get<Term>(x[1])); },
       first},
      {"transpose", {rotation}, [](Arguments x) -> FormulaValue { return transpose(std::get<Rotation>(x[0])); }},
      {"point",
       {frame, vector},
       [](Arguments x) -> FormulaValue {
         const auto& [origin, R] = std::get<Frame>(x[0]);
         return origin + R * v(x[1]);
       }},
  };
  return all;
}

std::optional<FormulaValue> apply_to_vectors(const Operation& operation, std::span<const FormulaValue> arguments) {
  if (operation == choice()) return chosen(arguments);
  if (operation == negation()) {
    if (const Vector3* const x = vector(arguments[0])) return negative(*x);
    return {};
  }
  if (arguments.size() != 2) return {};
  if (operation.name == "+" || operation.name == "-") return sum(arguments[0], arguments[1], operation.name == "-");
  if (operation.name == "*") return product(arguments[0], arguments[1]);
  const Vector3* const x = vector(arguments[0]);
  const Term* const divisor = scalar(arguments[1]);
  if (operation.name == "/" && x && divisor) return *x / *divisor;
  return {};
}

std::optional<FormulaValue> part_of(const FormulaValue& value, const std::string& part) {
  if (const Vector3* const x = vector(value); x && part.size() == 1 && part[0] >= 'x' && part[0] <= 'z')
    return (*x)[static_cast<std::size_t>(part[0] - 'x')];
  if (const Frame* const frame = std::get_if<Frame>(&value)) {
    if (part == "origin") return frame->origin;
    if (part == "R") return frame->rotation;
  }
  return {};
}

}  // namespace pkm::expression
