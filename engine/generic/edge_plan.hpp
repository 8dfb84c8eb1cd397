// Recognition of workspaces that are solids bounded by planes, spheres, cylinders and tori, and their volumes.
#pragma once

#include <optional>
#include <string>

#include "engine/expression/program.hpp"
#include "engine/generic/edges/proven_volume.hpp"
#include "engine/generic/evaluation.hpp"
#include "engine/math/quadrature.hpp"

namespace pkm::generic::edges {

/// The workspace over three swept coordinates as an intersection of bodies. A rod with a range becomes a slide or a
/// crank; every other constraint has to be a quadric in the swept coordinates. Immutable, shared by threads.
class EdgePlan {
 public:
  /// @param swept      indices of the three coordinates of the solid; all other coordinates are inputs
  /// @param box        range of each coordinate that is searched; std::nullopt: the range of the model
  /// @param tolerance  relative error of the volume
  EdgePlan(const Evaluation& evaluation, std::size_t mode, const std::vector<int>& swept,
           const std::vector<std::optional<std::array<double, 2>>>& box, double tolerance);

  /// Reason why the workspace is not an intersection of slides, cranks and quadrics; empty if it is.
  const std::string& why_not() const { return why_not_; }

  struct Scratch;

  /// The volume of a design, if why_not() is empty; std::nullopt if a quadric is no plane, sphere or cylinder, two
  /// faces are on the same surface, or the edges are not closed.
  /// @param inputs    values of the inputs of the model's graph
  /// @param by_input  derivatives by input, to which those of the volume are added; empty: not requested
  std::optional<Integral<double>> measure(std::span<const double> inputs, Scratch& scratch,
                                          std::span<double> by_input = {}) const;
  /// Proven bounds of the volume of a design, if why_not() is empty. The inputs are exactly the given numbers; all
  /// rounding errors are included. std::nullopt if no bounds can be proven.
  std::optional<Interval> prove(std::span<const double> inputs, Scratch& scratch) const;

 private:
  /// A disjunction of quadric constraints: at least one of the quadrics is >= 0. Each element identifies a quadric by
  /// the index of the program output that is the first of its 10 coefficients.
  using Clause = std::vector<std::size_t>;
  struct Rod {
    /// Index of the first program output that describes this rod. The outputs are: B - A with all coordinates 0 (three
    /// outputs), axis (three), zero (three), rod length, crank length, lower and upper end of the joint range.
    std::size_t output;
    bool is_crank, is_first_root;
  };
  /// Source of a body of the solid: a rod, a quadric constraint, or a bound of the search box.
  struct Source {
    enum class Kind { rod, quadric, box };
    Kind kind;
    std::size_t output;  ///< index of the first program output that describes the body
    double side = 0;     ///< 1 for an upper bound of the search box; otherwise unused
  };
  /// The solid of one design.
  struct Design {
    std::vector<double> registers, outputs;
    Vector3 origin;
    Solid solid;
    std::vector<Source> sources;  ///< source of each body of the solid, by body
    bool is_empty = false;
    /// Sum of the distances by which bodies of the solid extend beyond planes that were omitted as bodies.
    double beyond = 0;

    /// Upper bound of the distance of the solid's points from the origin of the coordinates.
    double reach() const { return solid.bound + norm(origin); }
  };
  /// Builds the solid of a design. @return false if a quadric is no plane, sphere or cylinder
  bool build(std::span<const double> inputs, Design& design) const;
  /// Encloses a body: the same body with intervals that contain its exact numbers; std::nullopt if the type of the body
  /// is not supported.
  static std::optional<IntervalBody> enclose(const Body& body, const Source& source, const Vector3& origin,
                                             std::span<const Interval> values);
  /// True if it is proven that the quadrics that are not bodies of the solid have no effect in the search box: their
  /// clause is satisfied everywhere without them, or they are violated everywhere.
  bool are_others_superfluous(const Design& design, std::span<const Interval> values) const;
  void add_gradient(Scratch& scratch, std::span<double> by_input) const;

  expression::Program program_;
  /// Index of the first program output that is a constraint on the design only; these outputs are the last ones.
  std::size_t constants_ = 0;
  std::size_t box_ = 0;  ///< index of the first program output of the box: lower and upper bound of each coordinate
  std::vector<Rod> rods_;
  std::vector<Clause> clauses_;
  std::string why_not_;
  double tolerance_;
};

/// Scratch memory of one thread.
struct EdgePlan::Scratch {
  Design design;
  VolumeScratch volume;
  std::vector<Body> gradient;
  std::vector<double> adjoints;
};

}  // namespace pkm::generic::edges
