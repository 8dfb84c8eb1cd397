// A problem whose evaluation costs next to nothing: the sum of squares.
#pragma once

#include <string>

#include "engine/problem/problem.hpp"

namespace pkm::benchmarks {

class Sphere final : public Problem {
 public:
  explicit Sphere(std::size_t variables) : space_(axes(variables)) {}
  const DesignSpace& space() const override { return space_; }
  const std::vector<ObjectiveInfo>& objectives() const override { return objectives_; }
  const std::vector<MarginInfo>& margins() const override { return margins_; }
  const std::vector<ReportInfo>& reports() const override { return reports_; }
  void evaluate(std::span<const double> design, EvaluationSlot result) const override {
    double sum = 0;
    for (const double x : design) sum += x * x;
    result.objectives[0] = sum;
    result.status = Status::feasible;
  }

 private:
  static std::vector<Variable> axes(std::size_t count) {
    std::vector<Variable> list;
    for (std::size_t i = 0; i < count; ++i) list.push_back({"x" + std::to_string(i + 1), "m", -1, 2});
    return list;
  }

  DesignSpace space_;
  std::vector<ObjectiveInfo> objectives_{{"sphere", "m^2", "sum of squares", Direction::minimise}};
  std::vector<MarginInfo> margins_;
  std::vector<ReportInfo> reports_;
};

}  // namespace pkm::benchmarks
