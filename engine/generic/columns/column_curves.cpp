// Roots of transcendental constraints along a column.
#include <algorithm>

#include "engine/expression/reverse_mode.hpp"
#include "engine/generic/columns/column.hpp"
#include "engine/math/satisfied.hpp"

namespace pkm::generic {

/// Appends the roots of the transcendental constraints to scratch.quadratic, which has those of constraints of degree
/// at most two.
/// @param signs  receives the signs of the transcendental constraints at the lower end of `range`
void Column::find_transcendental_roots(const std::array<double, 2>& range, std::span<double> registers, Signs& signs,
                                       ColumnScratch& scratch) const {
  constexpr long kMaxEvaluations = 4000;  // maximum number of interval evaluations per column
  const std::size_t stage = plan_.program.stages().size() - 1;
  // Number of interval operations for one evaluation of a column.
  const long operations = static_cast<long>(plan_.program.stages()[stage].steps.size());
  evaluate_stage_of_z<double>(range[0], registers);
  for (std::size_t i = 0; i < curves_.size(); ++i)
    if (is_satisfied(registers[curves_[i].value])) signs |= bit(curve_surfaces_[i]);
  const long left = std::max(0L, scratch.max_operations - scratch.operations) / operations;
  find_sign_changes(plan_.program, stage, curves_, range[0], range[1], std::min(left, kMaxEvaluations), registers,
                    scratch.sign_changes);
  scratch.operations += scratch.sign_changes.evaluations * operations;
  scratch.error = scratch.sign_changes.undecided;
  for (const SignChange& change : scratch.sign_changes.found)
    scratch.quadratic.emplace_back(change.at, 2 * curve_surfaces_[change.constraint] + (change.falls ? 1U : 0U));
}

void Column::add_gradient_of_transcendental(const Surface& surface, double z, double factor,
                                            std::span<double> registers, std::span<double> adjoints) const {
  const expression::Program& program = plan_.program;
  const std::size_t stage = program.stages().size() - 1;
  evaluate_stage_of_z<double>(z, registers);
  adjoints[surface.coefficients[0]] += factor / registers[surface.coefficients[1]];
  backward_sweep(program, stage, registers, adjoints);
  for (const auto& input : program.stages()[stage].inputs) adjoints[input.to] = 0;
}

}  // namespace pkm::generic
