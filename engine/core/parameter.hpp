// What describes a mechanism's design: its parameters, and which of them a study varies.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

namespace pkm {

/// One parameter of a mechanism, in the order in which the mechanism expects them.
struct Parameter {
  std::string name;    ///< as in the mechanism's document, "_" before an index: "l_u"
  std::string unit;    ///< SI: "m", "rad", "kg", ... or "1"
  double nominal = 0;  ///< default
  double lower = 0;    ///< the model is defined on [lower, upper]
  double upper = 0;
  std::string meaning;  ///< one line
};

/// One design variable of a study.
struct Variable {
  std::string name;
  std::string unit;
  double lower = 0;
  double upper = 0;
  double step = 0;  ///< 0: continuous; otherwise the values are lower + k step, up to upper
};

/// The box (or lattice) that optimisers search.
class DesignSpace {
 public:
  DesignSpace() = default;
  explicit DesignSpace(std::vector<Variable> variables) : variables_(std::move(variables)) {}

  std::size_t dimension() const { return variables_.size(); }
  const std::vector<Variable>& variables() const { return variables_; }
  const Variable& operator[](std::size_t i) const { return variables_[i]; }

  /// Physical value of unit coordinate u in [0, 1] of variable i, on the lattice if the variable has a step.
  double from_unit(std::size_t i, double u) const;
  /// Unit coordinate in [0, 1] of a physical value.
  double to_unit(std::size_t i, double value) const;
  /// The value of variable i nearest to `value` that the space holds: inside the bounds, on the lattice.
  double nearest(std::size_t i, double value) const;

 private:
  std::vector<Variable> variables_;
};

}  // namespace pkm
