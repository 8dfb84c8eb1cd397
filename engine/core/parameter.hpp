// Parameters of a mechanism, design variables of a study, and the design space that they span.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace pkm {

/// A parameter of a mechanism. The mechanism defines the order of its parameters.
struct Parameter {
  std::string name;     ///< name as in the mechanism file, with "_" before an index, for example "l_u"
  std::string unit;     ///< SI unit: "m", "rad", "kg", ... or "1"
  double nominal = 0;   ///< default value
  double lower = 0;     ///< minimum; the model is defined on [lower, upper]
  double upper = 0;     ///< maximum
  std::string meaning;  ///< one-line description of the parameter
};

/// A design variable of a study.
struct Variable {
  std::string name;
  std::string unit;
  double lower = 0;
  double upper = 0;
  double step = 0;  ///< if > 0, the allowed values are lower + k step, k = 0, 1, .., up to upper; 0: continuous
};

/// The search space of the optimisers: a box in the design variables, with a lattice for discrete variables.
class DesignSpace {
 public:
  DesignSpace() = default;
  explicit DesignSpace(std::vector<Variable> variables) : variables_(std::move(variables)) {}

  std::size_t dimension() const { return variables_.size(); }
  const std::vector<Variable>& variables() const { return variables_; }
  const Variable& operator[](std::size_t i) const { return variables_[i]; }

  /// Value of variable i, in its unit, at the normalised coordinate u in [0, 1]. If the variable has a step, the value
  /// is rounded to the nearest value that the step allows.
  double from_unit(std::size_t i, double u) const;
  /// Normalised coordinate, in [0, 1], of a value of variable i.
  double to_unit(std::size_t i, double value) const;
  /// The allowed value of variable i, within its bounds and on its steps, that is nearest to `value`.
  double nearest(std::size_t i, double value) const;

 private:
  std::vector<Variable> variables_;
};

}  // namespace pkm
