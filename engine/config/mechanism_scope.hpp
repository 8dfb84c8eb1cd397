// Symbol table of the formulas of a mechanism file, and the formulas as nodes of its expression graph.
#pragma once

#include <algorithm>
#include <functional>
#include <map>
#include <span>
#include <string>
#include <unordered_set>
#include <vector>

#include "engine/config/config_value.hpp"
#include "engine/expression/formula_value.hpp"
#include "engine/expression/symbol_table.hpp"
#include "engine/generic/model.hpp"

namespace pkm {

class MechanismScope {
 public:
  explicit MechanismScope(generic::Model& model) : model_(model) {}

  using Value = expression::FormulaValue;

  /// Adds a name that formulas may use. Refuses a name that is invalid in formulas or already in use.
  void add(const ConfigValue& at, const std::string& name, const Value& value);
  void add(const ConfigValue& at, const std::string& name, expression::Node node) { add(at, name, model_.term(node)); }
  /// Adds a name whose value is computed when a formula uses it first, so that the formulas that define it may use
  /// names that are added later. resolve() computes the values that are still missing.
  void add_deferred(const ConfigValue& at, const std::string& name, std::function<Value()> value);
  /// Adds a name with a predefined value, which is computed at its first use. If a mechanism file defines the same
  /// name, the definition of the file replaces the predefined value.
  void add_predefined(const std::string& name, std::function<Value()> value);
  /// The value of a name. @param user  the formula in the file that uses the name; refused if the name depends on
  /// itself
  const Value& value(const std::string& name, const ConfigValue& user) { return value_of(*names_.find(name), user); }
  void resolve(const ConfigValue& root);
  /// Adds the name of a point or joint of a limb, "arm1.C".
  void add_member(const std::string& name, const Value& value);
  /// Assigns another value to a name, for example a threshold in place of a parameter.
  void replace(const std::string& name, const Value& value);
  void replace(const std::string& name, expression::Node node) { replace(name, model_.term(node)); }
  /// The values of all names. Passing them to restore() resets these names, and keeps names that were added later.
  const std::vector<Value>& meanings() const { return values_; }
  void restore(const std::vector<Value>& meanings) { std::ranges::copy(meanings, values_.begin()); }
  bool knows(const std::string& name) const;
  /// Sets whether formulas may depend on rates and on [inputs]. Only formulas of quantities may.
  void allow_motion(bool allowed) { motion_allowed_ = allowed; }

  /// Reads a number, text with a unit of the dimension of `unit`, or a formula of the names defined so far. If the
  /// formula can be undefined, add_domains() adds the condition that it is defined, under the name `what`.
  limbs::Term formula(const ConfigValue& value, const std::string& unit, const std::string& what);
  /// Reads a number, text with a unit, or a formula, whose value may also be a vector, a rotation or a frame.
  Value formula_of_any_kind(const ConfigValue& value, const std::string& unit, const std::string& what);
  /// Reads a number, text with a unit, or a formula that depends on parameters only.
  limbs::Term of_design(const ConfigValue& value, const std::string& unit, const std::string& what);
  /// Reads a formula of parameters whose value has to be positive (with may_vanish, not negative). A number that
  /// violates this is refused; a formula may violate it for some designs.
  limbs::Term positive(const ConfigValue& value, const std::string& unit, const std::string& what,
                       bool may_vanish = false);
  /// Reads three formulas, [x, y, z], or a formula whose value is a vector.
  limbs::Vector3 point(const ConfigValue& value, const std::string& what);
  /// Reads a point that depends on parameters only.
  limbs::Vector3 point_of_design(const ConfigValue& value, const std::string& what);
  /// Reads a direction, which depends on parameters only, and normalises it.
  limbs::Vector3 direction(const ConfigValue& value, const std::string& what);
  /// Value of a formula for the default parameters at an arbitrary pose; used to test equations that must hold at every
  /// pose.
  double at_default(const limbs::Term& term) const;
  /// Refuses a range that is empty for the default parameters.
  void refuse_empty(const ConfigValue& range, const limbs::Term& from, const limbs::Term& to) const;

  /// Marks the square roots in `node` as defined wherever the constraints of the pose are satisfied; add_domains() then
  /// adds no margins for them.
  void mark_as_defined(expression::Node node);
  /// Adds the conditions that the operations in joints and margins of the model are defined (for example, that
  /// radicands are not negative) to the model's domains. Conditions that concern only limits of quantities become
  /// margins instead.
  void add_domains();

 private:
  const Value& value_of(std::size_t index, const ConfigValue& user);
  limbs::Vector3 vector(const ConfigValue& value, const std::string& unit, const std::string& what,
                        const char* expected, bool depends_on_pose);
  /// Refuses a value that depends on the pose.
  void refuse_pose(const ConfigValue& value, std::span<const limbs::Term> terms) const;

  /// The nodes that `root` depends on and that have not been visited yet, in topological order.
  std::vector<expression::Node> unvisited_nodes(expression::Node root) const;

  /// Registers the operations in a node that are undefined for some arguments, for add_domains().
  void register_partial_operations(expression::Node root, const std::string& what);

  /// An operation that is undefined for some arguments, with the names used in its message and in its constraint.
  struct PartialOperation {
    expression::Node node;
    std::string what, name;
  };

  generic::Model& model_;
  expression::Names names_;
  std::vector<Value> values_;
  /// A name whose value has not been computed yet.
  struct Deferred {
    std::string name;
    std::function<Value()> compute;  ///< empty while the value is being computed
  };
  std::map<std::size_t, Deferred> deferred_;  ///< names without a value so far, by their index in names_
  /// For each name, the place of its definition, such as "parameters.a (line 7)"; "" if the name is predefined.
  std::vector<std::string> origins_;
  std::vector<PartialOperation> partial_operations_;
  std::unordered_set<expression::Node> visited_;
  bool motion_allowed_ = false;
};

}  // namespace pkm
