// Values of formulas: scalars, vectors, rotations and frames, and the operations that are defined for them.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "engine/expression/operation.hpp"
#include "engine/expression/vector3.hpp"

namespace pkm::expression {

/// A coordinate system: points p of the frame have the position origin + rotation p in the base's frame.
struct Frame {
  Vector3 origin;
  Rotation rotation;
};

/// A scalar, or a three-dimensional vector, rotation or frame. Operations on elements that are known to be 0 or 1 are
/// simplified by the operators of Term.
using FormulaValue = std::variant<Term, Vector3, Rotation, Frame>;

/// The elements of a value: 1 of a scalar, 3 of a vector, 9 of a rotation, 12 of a frame.
std::vector<Term> elements(const FormulaValue& value);

/// The kind of a value in words: "a scalar", "a vector", "a rotation" or "a frame".
std::string kind_of(const FormulaValue& value);

/// A function of vectors. Its name denotes the function only where an argument list follows, so that files may also use
/// this name for a variable.
struct VectorFunction {
  std::string name;
  std::vector<std::string> arguments;  ///< kinds of the arguments: "a vector"
  FormulaValue (*apply)(std::span<const FormulaValue> arguments);
  /// Returns the vector whose norm the function computes, a square root that exists for all arguments; null: the
  /// function computes no norm.
  Vector3 (*normed)(std::span<const FormulaValue> arguments) = nullptr;
};
const std::vector<VectorFunction>& vector_functions();

/// Applies +, -, *, / or the conditional operator to values of which at least one is no scalar; std::nullopt if the
/// operation is not defined for these kinds.
std::optional<FormulaValue> apply_to_vectors(const Operation& operation, std::span<const FormulaValue> arguments);

/// The component .x, .y or .z of a vector, and the parts .origin and .R of a frame; std::nullopt if the value has no
/// such part.
std::optional<FormulaValue> part_of(const FormulaValue& value, const std::string& part);

}  // namespace pkm::expression
