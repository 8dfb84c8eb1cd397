// Constraint wrenches of the limbs, and the quantity `constraint_singular_value`, which shows constraint singularities.
//
// With free drives, the joints of a limb still transmit some forces and couples to the platform: the wrenches that are
// reciprocal to the twists of all its joints. Let F be the motions of a rigid body that are not among the coordinates
// of the platform, one unit twist for each: dependent coordinates, translations along, and rotations about the other
// axes. The platform cannot perform them as long as the matrix of the powers of all constraint wrenches for the twists
// F has full rank. Its smallest singular value is 0 at a constraint singularity, where the platform gains a freedom
// although all drives are locked.
//
// Forces and couples have unit magnitude, translations the size of the characteristic length.
//
// Reference: Zlatanov, Bonev, Gosselin, "Constraint singularities of parallel mechanisms", ICRA 2002.
#include <algorithm>

#include "engine/config/mechanism_draft.hpp"
#include "engine/expression/term_matrix.hpp"

namespace pkm {
namespace {

using generic::TermMatrix;
using limbs::Term, limbs::Vector3;

/// A wrench with the moment about the origin of the platform, or a twist with the velocity of this origin.
struct Screw {
  Vector3 linear, angular;
};

/// Thrown, with one sentence as the reason, if the constraint wrenches are unknown or if there are none.
struct NoConstraints {
  std::string why;
};

class ConstraintSystem {
 public:
  ConstraintSystem(const ConfigValue& root, MechanismDraft& draft)
      : draft_(draft), platform_(draft.frames.at(kPlatformFrame)), one_(draft.model.graph, 1.0), zero_(draft.zero()) {
    if (root.at("platform").has("origin"))
      throw NoConstraints{"`origin` of the platform is given by formulas, which may contain parasitic motions"};
    find_prevented();
    if (prevented_.empty()) throw NoConstraints{"the coordinates are all six motions of a rigid body"};
    for (const NamedLimb& limb : draft.limbs) add_limb(limb);
    if (independent_ < prevented_.size())
      throw NoConstraints{"the joints of the limbs transmit " + std::to_string(independent_) +
                          " constraint forces and couples, but " + std::to_string(prevented_.size()) +
                          " motions are not among the coordinates"};
    if (is_planar())
      throw NoConstraints{"all limbs move in parallel planes, so that the constraints are always regular"};
  }

  Term smallest_singular_value() const {
    const std::size_t n = prevented_.size();
    TermMatrix powers(draft_.model.graph, wrenches_.size(), n);
    for (std::size_t i = 0; i < wrenches_.size(); ++i)
      for (std::size_t j = 0; j < n; ++j) powers(i, j) = power(wrenches_[i], prevented_[j]);
    const TermMatrix gram = powers.transposed() * powers;
    if (n <= 3) return sqrt(call(expression::operation("max"), expression::eigenvalue_range(gram)[0], zero_));
    const auto [adjugate, determinant] = inverse_of(gram);  // 1/lambda_min(A) = lambda_max(A^-1)
    return sqrt(determinant / greatest_eigenvalue(adjugate));
  }

 private:
  Vector3 none() const { return {zero_, zero_, zero_}; }
  Vector3 axis(std::size_t k) const {
    Vector3 e = none();
    e[k] = one_;
    return e;
  }

  void find_prevented() {
    std::array<bool, 3> translates{};
    std::size_t turn = 0;
    for (const PlatformMotion& motion : draft_.motions) {
      if (!motion.rotates) translates[motion.axis] = true;
      const Vector3 direction = motion.rotates ? draft_.turns[turn++].axis : axis(motion.axis);
      if (motion.coordinate) continue;
      prevented_.push_back(motion.rotates ? Screw{none(), direction} : Screw{direction, none()});
    }
    for (std::size_t k = 0; k < 3; ++k)
      if (!translates[k]) prevented_.push_back({axis(k), none()});
    if (draft_.turns.size() < 2) {
      for (std::size_t k = 0; k < 3; ++k)
        if (draft_.turns.empty() || draft_.turns.front().index != k) prevented_.push_back({none(), axis(k)});
    } else if (draft_.turns.size() == 2) {
      prevented_.push_back({none(), unit_vector(cross(draft_.turns[0].axis, draft_.turns[1].axis))});
    }
  }

  void add_limb(const NamedLimb& limb) {
    if (limb.drive == "formula")
      throw NoConstraints{"the joints of limb " + limb.name +
                          (limb.points.contains("J1") ? " have no closed form" : " are given by formulas")};
    if (limb.axes && limb.begin_on == kBaseFrame && limb.end_on == kPlatformFrame) {
      const Vector3& centre = limb.parts.front().arc->centre;  // forces through it do no work in the three joints
      for (std::size_t k = 0; k < 3; ++k) add({axis(k), moment_of(axis(k), centre)});
      return;
    }
    if (limb.parts.size() == 1)
      throw NoConstraints{"limb " + limb.name + " has neither `rod` nor `links` that connect it to the platform"};
    if (limb.begin_on != kBaseFrame || limb.end_on != kPlatformFrame)
      throw NoConstraints{"limb " + limb.name + " does not connect the base with the platform"};
    const Vector3 &A = limb.points.at("A"), &B = limb.points.at("B");
    const Vector3 rod = B - limb.points.at("C");
    if (limb.revolute) return add_parallel_revolutes(limb, B);
    if (limb.beside) return add_couple(unit_vector(cross(*limb.beside, rod)));
    if (limb.universal) add_universal(limb, B - A, rod);
  }
  /// Parallel revolute joints transmit the force along their axes, unless a slide is parallel to it, and the couples
  /// normal to the axes; the last joint rotates with the platform about the platform's axes, too. A spherical or
  /// universal joint at the base transmits the force through its centre, and the couple normal to both of its axes.
  void add_parallel_revolutes(const NamedLimb& limb, const Vector3& B) {
    const Vector3 n = unit_vector(*limb.revolute);
    if (limb.is_hinged_at_end()) {
      add({n, moment_of(n, limb.points.at("A"))});
      if (limb.swivel) add_couple(unit_vector(cross(*limb.swivel, n)));
      return;
    }
    if (!limb.has_links) add({n, moment_of(n, B)});
    if (limb.ends_in_ball) return;
    std::vector<Vector3> free = {n};
    for (const Vector3& turn : *platform_.turns)
      if (free.size() == 1 ? !are_dependent(cross(n, turn)) : !are_dependent(turn, free)) free.push_back(turn);
    if (free.size() == 2) add_couple(unit_vector(cross(free[0], free[1])));
    if (free.size() != 1) return;
    for (std::size_t k = 0; k < 3; ++k) wrenches_.push_back({none(), axis(k) - n * n[k]});  // projector, of rank 2
    independent_ += 2;
  }
  bool are_dependent(const Vector3& normal) const { return draft_.scope.at_default(dot(normal, normal)) < 1e-18; }
  bool are_dependent(const Vector3& turn, const std::vector<Vector3>& free) const {
    if (free.size() != 2) return true;
    const double volume = draft_.scope.at_default(dot(turn, cross(free[0], free[1])));
    return volume * volume < 1e-18;
  }
  /// The rod or leg has universal joints with the axes a, a x rod and b, b x rod. The couple m along b x (b x rod) does
  /// no work in the second joint, and the force f makes up for its work in the first joint and in the drive:
  /// f . (a x rod) = -m . a, f . ((a x rod) x rod) = -m . (a x rod), and for the drive's twist (v, w) at B
  /// f . v = -m . w.
  void add_universal(const NamedLimb& limb, const Vector3& from_A, const Vector3& rod) {
    const auto& [a, b] = *limb.universal;
    const Vector3 m = unit_vector(cross(b, cross(b, rod))), p = cross(a, rod), q = cross(p, rod);
    const Vector3 across = p * (dot(m, a) / dot(p, p)) + q * (dot(m, p) / dot(q, q));  // -f across the rod
    const bool telescope = limb.drive == "telescope", turns = limb.drive == "crank";
    Vector3 f = none() - across;
    if (!telescope) {
      const Vector3 v = turns ? cross(*limb.axis, from_A) : *limb.axis;
      Term along = dot(across, v);
      if (turns) along = along - dot(m, *limb.axis);
      f = f + rod * (along / dot(rod, v));
    }
    const Term size = sqrt(dot(m, m) + dot(f, f) * length() * length());
    const Vector3 moment = m / length() + moment_of(f, limb.points.at("B"));
    add({f * (length() / size), moment * (length() / size)});
  }

  void add_couple(const Vector3& couple) { add({none(), couple}); }
  void add(const Screw& wrench) {
    wrenches_.push_back(wrench);
    ++independent_;
  }
  /// Moment of a force in B about the origin of the platform, divided by the characteristic length.
  Vector3 moment_of(const Vector3& force, const Vector3& B) const {
    const Vector3 moment = cross(B - draft_.origin, force);
    const bool vanishes = std::ranges::all_of(moment, [](const Term& term) { return term.is(0); });
    return vanishes ? moment : moment / length();
  }
  Term length() const {
    if (!draft_.model.length) throw NoConstraints{"it needs `characteristic_length`, to compare forces with couples"};
    return draft_.model.term(*draft_.model.length);
  }
  static Vector3 unit_vector(const Vector3& v) { return v / limbs::length(v); }
  static Term power(const Screw& wrench, const Screw& twist) {
    return dot(wrench.linear, twist.linear) + dot(wrench.angular, twist.angular);
  }
  /// Whether all limbs have parallel revolute joints with the same, fixed axis.
  bool is_planar() const {
    const auto& first = draft_.limbs.front().revolute;
    return std::ranges::all_of(draft_.limbs, [&](const NamedLimb& limb) {
      return limb.revolute && !limb.has_links && are_dependent(cross(*limb.revolute, *first)) &&
             std::ranges::none_of(*limb.revolute,
                                  [](const Term& term) { return depends_on_pose(term.graph(), term.node()); });
    });
  }

  MechanismDraft& draft_;
  const NamedFrame& platform_;
  Term one_, zero_;
  std::vector<Screw> prevented_;  ///< unit twists of the motions that are not among the coordinates
  std::vector<Screw> wrenches_;
  std::size_t independent_ = 0;  ///< number of the limbs' independent wrenches, summed over the limbs
};

}  // namespace

void add_constraint_quantity(const ConfigValue& root, const ConfigValue* study, MechanismDraft& draft) {
  constexpr const char* kName = "constraint_singular_value";
  try {
    const Term value = ConstraintSystem(root, draft).smallest_singular_value();
    if (!depends_on_pose(value.graph(), value.node()))
      throw NoConstraints{"the constraints of the limbs have the same rank at every pose"};
    add_predefined_quantity(
        root, study,
        {kName, "1", "minimum singular value of the limbs' constraints, 0 at constraint singularities", value}, draft);
  } catch (const NoConstraints& none) {
    draft.model.info.undefined_quantities.push_back({kName, none.why});
  }
}

}  // namespace pkm
