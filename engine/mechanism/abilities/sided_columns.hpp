// Interface of analyses by columns that can be restricted to poses on one side of the singularities.
#pragma once

#include <cstdint>
#include <memory>

namespace pkm {

class Mechanism;

/// Implemented by classes that also implement Columns; both have to be public base classes.
class SidedColumns {
 public:
  virtual ~SidedColumns() = default;
  /// The mechanism restricted to poses on one side of its singularities, for an analysis by columns; null if this is
  /// not supported. @param side  PoseSides::kPositive or PoseSides::kNegative
  virtual std::shared_ptr<const Mechanism> on_side(std::int8_t side) const = 0;
};

/// The mechanism restricted to poses on one side of its singularities, for an analysis by columns; null if the class of
/// `columns` does not implement SidedColumns.
template <class Columns>
std::shared_ptr<const Mechanism> columns_on_side(const Columns& columns, std::int8_t side) {
  const auto* const sided = dynamic_cast<const SidedColumns*>(&columns);
  return sided ? sided->on_side(side) : nullptr;
}

}  // namespace pkm
