// Output of `pkmopt tolerances`.
#pragma once

#include "engine/generic/tolerances/certified_tolerances.hpp"
#include "engine/math/interval.hpp"
#include "experiments/app/target.hpp"

namespace pkm {

/// Writes the results of `pkmopt tolerances` as text and JSON. The arguments of the constructor must outlive the
/// object.
class ToleranceReport {
 public:
  ToleranceReport(const Target& target, const generic::ToleranceProportions& proportions,
                  const generic::CertifiedTolerances& found)
      : target_(target), proportions_(proportions), found_(found) {}

  void add_to(Printout& out) const;
  CsvTable table() const;
  /// Sentence that explains why the certified tolerances are smaller than requested: why the gap to the smallest
  /// violation is larger than `gap`, or that the design itself fails; "" if they are not.
  std::string shortfall(double gap, std::int64_t max_boxes) const;

 private:
  bool design_fails() const { return found_.violation && found_.violation->scale == 0; }
  /// The tolerance of parameter i at a scale [SI], rounded down.
  double tolerance(std::size_t i, double scale) const { return rounding::product_down(scale, proportions_.sizes[i]); }
  /// Text of the tolerances at a scale: a number if all are equal, otherwise a factor that multiplies the tolerances in
  /// the printed table; rounded down (direction -1) or up (1).
  std::string text_of(double scale, int direction) const;
  std::string relative_text(double scale) const;
  Json by_name(double scale) const;

  const Target& target_;
  const generic::ToleranceProportions& proportions_;
  const generic::CertifiedTolerances& found_;
};

}  // namespace pkm
