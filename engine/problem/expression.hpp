// User-defined quantities, given as formulas in the study: `expression = "volume / (pi * b * (l_u + l_d))"`.
//
// An expression may use the parameters of the mechanism (variable or fixed), the thresholds in effect, the size of the
// mechanism and results of the workspace analysis, all in SI units and radians. Its derivatives follow by the chain
// rule (forward-mode automatic differentiation).
#pragma once

#include <string>
#include <vector>

#include "engine/expression/formula.hpp"
#include "engine/problem/quantity.hpp"

namespace pkm {

/// A name that an expression may use, and the value that it stands for.
struct ExpressionName {
  enum class Origin { parameter, threshold, size, workspace };

  std::string name;
  std::string unit;
  std::string meaning;
  Origin origin = Origin::parameter;
  std::size_t index = 0;  ///< index in the mechanism's parameters or limits, or in analysis_results()
};

/// A scalar result of a workspace analysis: the volume or a statistic of a pose quantity.
struct AnalysisResult {
  std::string name;
  std::string meaning;
  const PoseQuantity* quantity = nullptr;  ///< quantity of which the result is a statistic; null: the result is the
                                           ///< volume
  std::string statistic = {};              ///< name of the statistic, for example "mean"

  /// The value of this result. With derivatives (Dual4), a worst case is replaced by a smooth approximation.
  /// @param sharpness  sharpness of the smooth approximation
  template <class S>
  S value(const WorkspaceResult<S>& workspace, double sharpness, Scratch& scratch) const;
};

/// The volume and the statistics of all pose quantities of a mechanism.
std::vector<AnalysisResult> analysis_results(const MechanismInfo& info);

/// All names that expressions of a mechanism may use, except `pi` and functions such as `sin`, which are available in
/// every formula.
std::vector<ExpressionName> expression_names(const Mechanism& mechanism, const WorkspacePlan& plan);

/// The options that all catalogue entries with an expression share.
std::vector<OptionSpec> expression_options();

/// The expression given by the options of a catalogue entry.
class Expression {
 public:
  /// Throws std::invalid_argument with a sentence if an option is invalid or has no effect.
  explicit Expression(const EntryContext& context);

  bool needs_workspace() const;
  /// Adds to `request` the fields of the workspace analysis that the expression uses.
  void add_request(const EntryContext& context, FieldRequest& request) const;
  /// The value of the expression. With derivatives (Dual4), worst cases are replaced by smooth approximations.
  /// design.workspace may be null if needs_workspace() is false.
  template <class S>
  S value(const DesignView<S>& design) const;

 private:
  bool uses(ExpressionName::Origin origin) const;
  void refuse_unused_options(const Options& options, const FieldRequest& request) const;

  std::vector<AnalysisResult> results_;
  std::vector<ExpressionName> names_;
  Formula formula_;
  LimitSpec limits_;
  double sharpness_;
};

/// The option `unit`: the SI unit of the expression. Throws std::invalid_argument for any other unit.
std::string expression_unit(const EntryContext& context);
/// The formula on one line, for listings.
std::string expression_text(const EntryContext& context);

}  // namespace pkm
