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

inline constexpr const char* kYield = "yield";  ///< name of the objective

/// Error of one parameter of a built machine: uniformly distributed within +- bound, or normally distributed with a
/// standard deviation and truncated to +- bound.
struct ParameterError {
  std::string name;       ///< of the parameter: "l_a", "arm2.l_a"
  std::size_t parameter;  ///< index among the parameters of the built machine
  double bound;           ///< > 0 [SI]
  double sigma = 0;       ///< > 0 and <= bound [SI]; 0: uniform
};

/// A parameter of a single limb that exists in built machines only. Without its error, it has the value of the
/// parameter that all limbs share.
struct LimbCopy {
  std::size_t own, common;
};

/// Errors that are drawn together: a single one, or correlated normal errors.
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

/// A statistic over built machines that replaces the value of a quantity: `robust` of a study, or a yield.
struct SampledValue {
  enum class Statistic { worst, mean, quantile, yield, yield_lower, yield_upper };
  Statistic statistic;
  double probability = 0;         ///< of a quantile: the share of machines with a worse value
  bool greater_is_better = true;  ///< which values are worse
  std::size_t row = 0;            ///< index among the objectives of BuiltMachines::problem; unused for a yield

  bool is_yield() const { return statistic >= Statistic::yield; }
};

/// Share of built machines that satisfy all constraints.
struct Yield {
  std::size_t machines = 0, good = 0;
  /// Number of machines that violate each constraint. The workspace of a machine that violates a constraint of the
  /// design alone is not analysed, unless a robust quantity uses it.
  std::vector<std::size_t> violated = {};
  std::size_t failed = 0;  ///< number of machines for which a constraint is undefined, and none is violated

  double share() const { return static_cast<double>(good) / static_cast<double>(machines); }
  /// Wilson score interval of the share, with 95 % confidence.
  std::array<double, 2> interval() const;
};

/// Values of all samples for one design. NaN: not computed, or the machine cannot be evaluated.
struct MachineValues {
  std::size_t machines = 0;
  std::vector<double> objectives;   ///< machines x objectives of BuiltMachines::problem
  std::vector<double> margins;      ///< machines x margins
  std::vector<double> derivatives;  ///< machines x (objectives + margins) x (1 + directions): smooth values and their
                                    ///< derivatives
};

/// The statistic of the values of one quantity as a convex combination of them: pairs of an index and a weight. A
/// quantile is interpolated between two order statistics (type 7 of Hyndman and Fan 1996). If a value is NaN, so is the
/// combination.
std::vector<std::pair<std::size_t, double>> sample_weights(const SampledValue& sampled, std::span<const double> values);

/// Counts the machines all of whose margins are >= 0.
Yield yield_of(const MachineValues& values);
/// The statistic of a yield.
double yield_statistic(const SampledValue& sampled, const Yield& yield);

/// What has to be evaluated for each sample.
struct BuiltMachines {
  ToleranceModel tolerances;
  /// Its objectives are the robust quantities of the study; its margins are those of all constraints if the study has a
  /// yield, otherwise none.
  std::shared_ptr<const DesignProblem> problem;
};

}  // namespace pkm
