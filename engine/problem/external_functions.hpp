// Functions of a study that another program evaluates, such as functions in Python. They depend on the parameters of a
// design only. Their values are computed after those that pkmopt computes itself, for a batch of designs at a time.
#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "engine/problem/quantity.hpp"

namespace pkm {

/// The value of a function for one design.
struct ExternalValue {
  double value = 0;
  double seconds = 0;        ///< time of the call [s]
  std::string failure = {};  ///< why the call failed; "" if it succeeded
  bool is_computed = false;  ///< false: the value has not been computed because of a stop request
};

/// Calls the functions of a study.
class FunctionCaller {
 public:
  virtual ~FunctionCaller() = default;
  /// Calls a function for several designs. Thread-safe.
  /// @param call        the function as the study names it, "cost.py:price"
  /// @param parameters  [values.size()][parameters]: all parameters of the mechanism in SI units
  /// @param values      receives the results. After a stop request, throws Stopped; values not computed by then have
  ///                    is_computed = false
  virtual void evaluate(const std::string& call, std::span<const double> parameters,
                        std::span<ExternalValue> values) = 0;
  /// Hash of the source text that defines the function; "": unknown.
  virtual std::string source_hash(const std::string& call) const = 0;
};

/// The caller of the functions of a study, and the failures of its calls. Shared by all copies of the study's problem.
/// The caller must be set before designs are evaluated.
class ExternalFunctions {
 public:
  std::shared_ptr<FunctionCaller> caller;  ///< calls the functions; null: functions are not called, because results are
                                           ///< only displayed

  /// Records the reason of a failure, unless a failure of the same function has been recorded before. Thread-safe.
  void note_failure(const std::string& call, const std::string& reason);
  std::map<std::string, std::string> failures() const;  ///< for each function that failed, the reason

 private:
  mutable std::mutex mutex_;
  std::map<std::string, std::string> failures_;
};

/// A quantity whose value is that of an external function.
class ExternalQuantity final : public Quantity {
 public:
  explicit ExternalQuantity(std::string call) : call_(std::move(call)) {}
  const std::string* external_call() const override { return &call_; }
  double value(const DesignView<double>&) const override {
    throw std::logic_error("an external value is not computed");
  }
  Dual4 smooth(const DesignView<Dual4>&) const override { throw std::logic_error(*why_no_derivatives()); }
  Unsupported why_no_derivatives() const override {
    return "the Python function " + call_ + " has none; use an optimiser without gradients";
  }

 private:
  std::string call_;
};

}  // namespace pkm
