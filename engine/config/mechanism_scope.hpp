// The names that formulas of a mechanism's file know, and formulas as nodes of its graph.
#pragma once

#include <algorithm>
#include <string>
#include <unordered_set>
#include <vector>

#include "engine/config/config_value.hpp"
#include "engine/expression/symbol_table.hpp"
#include "engine/generic/model.hpp"

namespace pkm {

class MechanismScope {
 public:
  explicit MechanismScope(generic::Model& model) : model_(model) {}

  /// Refuses a name that a formula cannot hold, or that something has already.
  void add(const ConfigValue& at, const std::string& name, expression::Node node);
  /// A later meaning of a name: a threshold in place of the parameter.
  void replace(const std::string& name, expression::Node node);
  /// What all names mean now, and back to it; names that have come since stay.
  const std::vector<expression::Node>& meanings() const { return nodes_; }
  void restore(const std::vector<expression::Node>& meanings) { std::ranges::copy(meanings, nodes_.begin()); }
  bool knows(const std::string& name) const;
  /// Whether formulas may depend on rates and on [inputs]: those of quantities.
  void allow_motion(bool allowed) { motion_allowed_ = allowed; }

  /// A number, text with a unit of the dimension of `unit`, or a formula of the names known so far. Where it could be
  /// undefined, that is noted as a margin called after `what`.
  limbs::Term formula(const ConfigValue& value, const std::string& unit, const std::string& what);
  /// The same of parameters alone.
  limbs::Term of_design(const ConfigValue& value, const std::string& unit, const std::string& what);
  /// The same, of what has to be positive: refuses a plain number that is not. Formulas may be so for some designs.
  limbs::Term positive(const ConfigValue& value, const std::string& unit, const std::string& what,
                       bool may_vanish = false);
  /// Three formulas, [x, y, z].
  limbs::Vector3 point(const ConfigValue& value, const std::string& what);
  /// The same of parameters alone.
  limbs::Vector3 point_of_design(const ConfigValue& value, const std::string& what);
  /// A direction of parameters alone, scaled to length 1.
  limbs::Vector3 direction(const ConfigValue& value, const std::string& what);
  /// What a formula is for the default parameters at some pose, for what has to hold at every pose.
  double at_default(const limbs::Term& term) const;
  /// Refuses a range that the default parameters turn round.
  void refuse_empty(const ConfigValue& range, const limbs::Term& from, const limbs::Term& to) const;

  /// Roots and the like that a limb is made of: its own conditions say where they exist.
  void known_to_exist(expression::Node node);
  /// The margins of what is reachable from the model's joints and margins and could be undefined.
  void note_domains();

 private:
  /// What a node is made of and has not been looked at.
  std::vector<expression::Node> unseen(expression::Node root) const;

  void watch(expression::Node node, const std::string& what);

  struct Watched {
    expression::Node node;
    std::string what, name;
  };

  generic::Model& model_;
  expression::Names names_;
  std::vector<expression::Node> nodes_;
  std::vector<std::string> origins_;  ///< "parameters.a (line 7)"
  std::vector<Watched> watched_;
  std::unordered_set<expression::Node> seen_;
  bool motion_allowed_ = false;
};

}  // namespace pkm
