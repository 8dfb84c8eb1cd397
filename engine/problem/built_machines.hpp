// Monte Carlo samples of machines that are built with manufacturing tolerances: errors of the parameters, and
// statistics of quantities over the samples.
//
// The samples are drawn by counters (engine/math/random.hpp). They are the same for every design, so that objectives
// are deterministic functions of the design and have derivatives.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace pkm {

class DesignProblem;

/// Name of the catalogue entry: the share of built machines that satisfy all constraints.
inline constexpr const char* kYield = "yield";

/// Error of one parameter of a built machine: uniformly distributed within +- bound, or normally distributed with a
/// standard deviation and truncated to +- bound.
struct ParameterError {
  std::string name;       ///< name of the parameter, such as "l_a" or "arm2.l_a"
  std::size_t parameter;  ///< index among the parameters of the built machine
  double bound;           ///< maximum magnitude of the error, > 0 [SI]
  double sigma = 0;       ///< standard deviation, > 0 and <= bound [SI]; 0: the error is uniformly distributed
};

/// A parameter of a single limb that only built machines have, with an error of its own. Its value before the error is
/// that of the parameter that all limbs share.
struct LimbCopy {
  std::size_t own, common;
};

/// Parameter errors that are drawn together: a single error, or several correlated, normally distributed errors.
struct ErrorGroup {
  std::vector<std::size_t> errors;
  /// Cholesky factor of the correlation matrix: rows of a lower triangular matrix. Empty for a single error.
  std::vector<std::vector<double>> factor = {};
};

/// The distribution of the parameters of built machines.
struct ToleranceModel {
  std::vector<ParameterError> errors;
  std::vector<ErrorGroup> groups;
  std::vector<LimbCopy> copies;
  std::uint64_t seed = 1;
  std::size_t samples = 64;

  /// Parameters of sample `index` of the machines built to a design.
  /// @param design      parameters of the design
  /// @param parameters  receives the parameters of the machine: those of the design, then those of LimbCopy::own
  void sample(std::size_t index, std::span<const double> design, std::vector<double>& parameters) const;
};

/// A statistic over built machines that replaces the value of a quantity: the one that the key `robust` of a study
/// selects, or a yield.
struct SampledValue {
  enum class Statistic { worst, mean, quantile, yield, yield_lower, yield_upper };
  Statistic statistic;
  double probability = 0;         ///< for a quantile: share of the machines that have a worse value
  bool greater_is_better = true;  ///< true: smaller values are worse; false: greater ones
  /// For other statistics than a yield: index of the quantity among the objectives of BuiltMachines::problem.
  std::size_t row = 0;

  bool is_yield() const { return statistic >= Statistic::yield; }
};

/// Share of the built machines that satisfy all constraints, with the numbers of machines from which it is computed.
struct Yield {
  std::size_t machines = 0, good = 0;
  /// Number of machines that violate each constraint. The workspace of a machine that violates a constraint of the
  /// design alone is not analysed, unless a robust quantity uses it.
  std::vector<std::size_t> violated = {};
  std::size_t failed = 0;  ///< number of machines that violate no constraint, but for which a constraint is undefined

  double share() const { return static_cast<double>(good) / static_cast<double>(machines); }
  /// Wilson score interval of the share, with 95 % confidence.
  std::array<double, 2> interval() const;
};

/// Objectives, margins and derivatives of all sampled machines of one design, as row-major arrays. NaN: not computed,
/// or the machine cannot be evaluated.
struct MachineValues {
  std::size_t machines = 0;
  std::vector<double> objectives;   ///< machines x objectives of BuiltMachines::problem
  std::vector<double> margins;      ///< machines x margins of BuiltMachines::problem
  std::vector<double> derivatives;  ///< machines x (objectives + margins) x (1 + parameters): smooth approximation of
                                    ///< each value, then its derivatives with respect to parameters
};

/// The statistic of the values of one quantity as a convex combination of them: pairs of an index and a weight. A
/// quantile is interpolated between two order statistics (type 7 of Hyndman and Fan 1996). If a value is NaN, so is the
/// combination.
std::vector<std::pair<std::size_t, double>> sample_weights(const SampledValue& sampled, std::span<const double> values);

/// Counts the sampled machines that satisfy all constraints, i.e. all of whose margins are >= 0.
Yield yield_of(const MachineValues& values);
/// The share of machines that satisfy all constraints or, depending on the statistic, the lower or upper bound of the
/// confidence interval of this share.
double yield_statistic(const SampledValue& sampled, const Yield& yield);

/// The distribution of built machines, and the problem that is evaluated for each sampled machine.
struct BuiltMachines {
  ToleranceModel tolerances;
  /// Objectives: the quantities of which the study needs statistics over built machines. Margins: those of all
  /// constraints if the study has a yield, otherwise none.
  std::shared_ptr<const DesignProblem> problem;
};

}  // namespace pkm
