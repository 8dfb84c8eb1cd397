// Output of `pkmopt tolerances`.
#pragma once

#include "engine/generic/tolerances/certified_tolerances.hpp"
#include "engine/math/interval.hpp"
#include "experiments/app/target.hpp"

namespace pkm {

/// The arguments must outlive the report.
class ToleranceReport {
 public:
  ToleranceReport(const Target& target, const generic::ToleranceProportions& proportions,
                  const generic::CertifiedTolerances& found)
      : target_(target), proportions_(proportions), found_(found) {}

  void add_to(Printout& out) const;
  CsvTable table() const;
  /// Why the certified tolerances are smaller than requested; "" if they are not.
  std::string shortfall(double gap, std::int64_t max_boxes) const;

 private:
  bool design_fails() const { return found_.violation && found_.violation->scale == 0; }
  /// The tolerance of a parameter [SI], not rounded up.
  double tolerance(std::size_t i, double scale) const { return rounding::product_down(scale, proportions_.sizes[i]); }
  /// The tolerances at a scale: a number if all are equal, otherwise relative to those of the table.
  std::string text_of(double scale) const;
  std::string relative_text(double scale) const;
  Json by_name(double scale) const;

  const Target& target_;
  const generic::ToleranceProportions& proportions_;
  const generic::CertifiedTolerances& found_;
};

}  // namespace pkm
