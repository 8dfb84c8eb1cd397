// Length of a column, whose endpoints are roots of polynomials of degree at most four (a crank and a rod describe a
// torus), or roots of transcendental constraints, isolated by interval arithmetic.
#pragma once

#include "engine/generic/columns/endpoints.hpp"
#include "engine/generic/columns/sign_changes.hpp"
#include "engine/generic/slice_plan.hpp"
#include "engine/math/dual.hpp"
#include "engine/math/interval.hpp"
#include "engine/math/quadrature.hpp"

namespace pkm::generic {

/// Scratch memory of Column, with the result of measure(). The label of an endpoint of a feasible interval is 2 k if
/// constraint k has its root there, plus 1 if this constraint decreases along z.
struct ColumnScratch {
  /// A feasible interval of the column, with the positions and labels of its endpoints.
  struct Piece {
    std::pair<double, EndLabel> lower, upper;
  };
  std::vector<Piece> pieces;
  Ends ends;  ///< position and label of all sign changes that can bound a feasible interval, in ascending order
  /// Sign changes of the constraints of degree at most two and of transcendental constraints, in ascending order.
  Ends quadratic;
  /// Sign changes of the constraints of degree three and four between two consecutive elements of `quadratic`.
  Ends high_degree;
  std::vector<EndLabel> labels;  ///< labels of the endpoints of all elements of `pieces`
  SliceType type = 0;
  double error = 0;  ///< total length of the intervals of z in which the sign of a transcendental constraint is unknown
  SignChangeScratch sign_changes;
  long operations = 0;      ///< number of interval operations in all columns so far
  long max_operations = 0;  ///< limit of `operations`, beyond which intervals with unknown signs count as error
};

/// Whether a column has so many endpoints that evaluating it takes much longer than a microsecond.
inline bool is_long(const ColumnScratch& scratch) { return scratch.ends.size() > 64; }

class Column {
 public:
  /// @param plan  a plan whose slices are lines along z, without an inner coordinate v
  explicit Column(SlicePlan plan);

  const SlicePlan& plan() const { return plan_; }
  /// Computes the length of the column, i.e. the total length of its feasible intervals, and sets the column's type and
  /// feasible intervals in `scratch`.
  /// @param registers  values of the program's registers after all stages except that of z
  double measure(std::span<double> registers, ColumnScratch& scratch) const;
  /// Adds the derivatives of factor * measure() to the adjoints of the program's registers; to be called after
  /// measure().
  void add_gradient(double factor, std::span<double> registers, std::span<double> adjoints,
                    const ColumnScratch& scratch) const;
  /// The position of an endpoint with its derivatives with respect to the design; to be called after measure().
  /// @param end             position and label of the endpoint
  /// @param dual_registers  registers with derivatives, after all stages except that of z
  Dual4 differentiable_end(const std::pair<double, EndLabel>& end, std::span<Dual4> dual_registers) const;
  /// Calls visit(z, weight) at quadrature nodes in the feasible intervals; to be called after measure().
  /// @param end_of  end_of(position and label) returns the position of an endpoint as a number of type S
  template <class S, class EndOf, class Visit>
  void for_each_node(const GaussRule& along_z, const ColumnScratch& scratch, const EndOf& end_of,
                     const Visit& visit) const {
    for (const auto& piece : scratch.pieces) {
      const S lower = end_of(piece.lower), length = end_of(piece.upper) - lower;
      for (std::size_t j = 0; j < along_z.node.size(); ++j)
        visit(lower + length * along_z.node[j], length * along_z.weight[j]);
    }
  }

 private:
  bool find_quadratic_roots(std::span<const double> registers, Signs& signs, std::array<double, 2>& range,
                            ColumnScratch& scratch) const;
  /// Evaluates the stage of the program that depends on z. S is double or Dual4.
  template <class S>
  void evaluate_stage_of_z(const S& z, std::span<S> registers) const {
    const expression::Program& program = plan_.program;
    for (const auto& input : program.stages().back().inputs) registers[input.to] = z;
    program.run<S>(program.stages().size() - 1, registers);
  }
  void find_transcendental_roots(const std::array<double, 2>& range, std::span<double> registers, Signs& signs,
                                 ColumnScratch& scratch) const;
  void add_gradient_of_transcendental(const Surface& surface, double z, double factor, std::span<double> registers,
                                      std::span<double> adjoints) const;
  void find_high_degree_roots(std::span<const double> registers, double from, double to, Signs& signs,
                              ColumnScratch& scratch) const;
  double root_error_bound(const std::pair<double, EndLabel>& end, std::span<const double> registers) const;
  void merge_coincident_roots(std::span<const double> registers, double tie, ColumnScratch& scratch) const;

  SlicePlan plan_;
  Signs high_degree_ = 0;  ///< set of the constraints of degree three and four
  /// Set of those constraints of degree three and four that occur in the feasibility formula only without negation.
  Signs positive_literals_ = 0;
  Signs transcendental_ = 0;
  /// Registers of the values of the transcendental constraints and of their derivatives by z.
  std::vector<WithDerivative> curves_;
  std::vector<EndLabel> curve_surfaces_;  ///< index of the surface of each element of `curves_`
};

}  // namespace pkm::generic
