// The length of columns whose ends are roots of polynomials of degree four or less, which is all that the fold of a
// crank and a rod, a torus, lets one say exactly; or roots of any formulas, which intervals isolate.
#pragma once

#include <limits>

#include "engine/generic/columns/ends.hpp"
#include "engine/generic/columns/section_plan.hpp"
#include "engine/math/dual.hpp"
#include "engine/math/interval.hpp"
#include "engine/math/quadrature.hpp"

namespace pkm::generic {

/// What a column overwrites. The label of an end is twice its surface, and one more where that falls.
struct ColumnRoom {
  struct Piece {
    std::pair<double, EndLabel> lower, upper;
  };
  std::vector<Piece> pieces;
  Ends ends;         ///< all places where surfaces change their signs and it may matter
  Ends flat, steep;  ///< of surfaces of degree two or less and curves, in order; of others between two of those
  std::vector<Interval> intervals;  ///< registers
  std::vector<EndLabel> labels;     ///< of the pieces' ends
  Structure structure = 0;
  long halvings = 0;                                      ///< of intervals of curves, so far
  long most_halvings = std::numeric_limits<long>::max();  ///< then TooManyHalvings
};

/// Whether a column has so many ends that it takes much longer than a microsecond.
inline bool is_long(const ColumnRoom& room) { return room.ends.size() > 64; }

/// Thrown by measure().
struct TooManyHalvings {};

class Column {
 public:
  /// @param plan  of a SectionOrder without v
  explicit Column(SectionPlan plan);

  const SectionPlan& plan() const { return plan_; }
  /// The length, its structure and its pieces. @param registers  after all stages but that of z
  double measure(std::span<double> registers, ColumnRoom& room) const;
  /// Adds the derivatives of factor * measure(), after it, to the adjoints of the program's registers.
  void add_slopes(double factor, std::span<double> registers, std::span<double> adjoints, const ColumnRoom& room) const;
  /// An end with its derivatives, after measure(). @param moving  registers after all stages but that of z
  Dual4 moving_end(const std::pair<double, EndLabel>& end, std::span<Dual4> moving) const;
  /// Calls visit(z, weight) with nodes inside the column, after measure(). @param end_of  an end as S
  template <class S, class EndOf, class Visit>
  void for_each_node(const GaussRule& along_z, const ColumnRoom& room, const EndOf& end_of, const Visit& visit) const {
    for (const auto& piece : room.pieces) {
      const S lower = end_of(piece.lower), length = end_of(piece.upper) - lower;
      for (std::size_t j = 0; j < along_z.node.size(); ++j)
        visit(lower + length * along_z.node[j], length * along_z.weight[j]);
    }
  }

 private:
  bool find_flat_ends(std::span<const double> registers, Signs& signs, std::array<double, 2>& range,
                      ColumnRoom& room) const;
  /// Computes what depends on z; S is double, Dual4 or Interval.
  template <class S>
  void set_z(const S& z, std::span<S> registers) const {
    const expression::Program& program = plan_.program;
    for (const auto& input : program.stages().back().inputs) registers[input.to] = z;
    program.run<S>(program.stages().size() - 1, registers);
  }
  void find_curve_ends(const std::array<double, 2>& range, std::span<double> registers, Signs& signs,
                       ColumnRoom& room) const;
  void isolate(Signs curves, double from, double to, double narrow, std::span<double> registers,
               ColumnRoom& room) const;
  void add_slopes_of_curve(const Surface& surface, double z, double factor, std::span<double> registers,
                           std::span<double> adjoints) const;
  double root_between(std::size_t curve, double from, double to, std::span<double> registers) const;
  void find_steep_ends(std::span<const double> registers, double from, double to, Signs& signs, ColumnRoom& room) const;
  double blur(const std::pair<double, EndLabel>& end, std::span<const double> registers) const;
  void settle(std::span<const double> registers, double tie, ColumnRoom& room) const;

  SectionPlan plan_;
  Signs steep_ = 0;  ///< surfaces of degree three and four
  Signs helps_ = 0;  ///< those of them that a formula holds the better with
  Signs curves_ = 0;
};

}  // namespace pkm::generic
