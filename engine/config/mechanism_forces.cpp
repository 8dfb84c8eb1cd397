// Reads the tensions of cables and [forces], and adds the margin and the quantities of the cables.
#include "engine/config/mechanism_draft.hpp"
#include "engine/config/mechanism_limb.hpp"
#include "engine/core/catalogue.hpp"
#include "engine/expression/derivative.hpp"
#include "engine/generic/performance/tension_limits.hpp"

namespace pkm {
namespace {

using expression::TermMatrix;
using generic::LoadSet;
using limbs::Term, limbs::Vector3;

/// Reads the loads that cables have to balance.
class Loads {
 public:
  Loads(const std::optional<ConfigValue>& table, MechanismDraft& draft)
      : table_(table), draft_(draft), model_(draft.model), n_(model_.inputs.coordinates) {}

  /// The sets of loads that the cables have to balance: one set, or one for each end of the range of the payload.
  std::vector<LoadSet> sets() {
    LoadSet common{std::vector<Term>(n_, draft_.zero()), {}};
    if (model_.equations)
      for (std::size_t i = 0; i < n_; ++i) common.centre[i] = model_.term(model_.equations->G_X[i]);
    add_wrench(common);
    std::vector<LoadSet> sets;
    for (const Term& mass : payloads()) {
      LoadSet with_payload = common;
      for (std::size_t i = 0; i < n_; ++i)
        with_payload.centre[i] = with_payload.centre[i] + mass * kGravity * payload_rates_[i][2];
      add_inertia(mass, with_payload);
      sets.push_back(std::move(with_payload));
    }
    return sets;
  }

 private:
  std::optional<ConfigValue> find(const char* key) const { return table_ ? table_->find(key) : std::nullopt; }

  /// Velocities of a point of the platform for unit rates of the coordinates.
  std::vector<Vector3> rates_of(const Vector3& point) {
    std::vector<Vector3> rates;
    for (std::size_t i = 0; i < n_; ++i) {
      const auto rate = [&](std::size_t axis) {
        return model_.term(expression::derivative(model_.graph, point[axis].node(), model_.coordinate(i)));
      };
      rates.emplace_back(rate(0), rate(1), rate(2));
    }
    return rates;
  }
  Vector3 terms(const std::array<expression::Node, 3>& v) {
    return {model_.term(v[0]), model_.term(v[1]), model_.term(v[2])};
  }

  /// Adds external forces or moments to a set of loads. @param key  "force" or "moment"
  void add_components(const char* key, const char* unit, const std::vector<Vector3>& rates, LoadSet& set) {
    const auto given = find(key);
    if (!given) return;
    const auto components = given->elements("three magnitudes along x, y, z");
    if (components.size() != 3) throw given->error("three magnitudes along x, y, z");
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const Term magnitude = draft_.scope.positive(components[axis], unit, key, true);
      std::vector<Term> load;
      for (const Vector3& rate : rates) load.push_back(magnitude * rate[axis]);
      if (!magnitude.is(0)) set.half_axes.push_back(load);
    }
  }
  void add_wrench(LoadSet& set) {
    add_components("force", "N", rates_of(terms(model_.wrench_point.value_or(model_.origin))), set);
    std::vector<Vector3> rotations;
    for (const auto& direction : model_.rotation_directions) rotations.push_back(terms(direction));
    add_components("moment", "N m", rotations, set);
  }

  /// The smallest and the largest mass of the payload; only the mass 0 if there is no payload.
  std::vector<Term> payloads() {
    const auto at = find("payload_at");
    const auto range = find("payload");
    if (at && !range) throw at->refusal("`payload_at` requires `payload`");
    payload_rates_ =
        rates_of(at ? draft_.origin + draft_.turn * draft_.scope.point_of_design(*at, "payload_at") : draft_.origin);
    if (!range) return {draft_.zero()};
    const auto [from, to] = read_range(*range, "kg", "payload", draft_);
    model_.required.push_back({"payload", "kg", from.node()});
    return {from, to};
  }

  /// Adds to a set of loads the inertia forces of platform, limbs and payload for the accelerations in [forces] at zero
  /// velocity.
  void add_inertia(const Term& payload, LoadSet& set) {
    const auto given = table_ ? table_->find_table("acceleration") : std::nullopt;
    if (!given) return;
    if (!model_.equations && !find("payload"))
      throw given->refusal("accelerations have no inertia forces: neither the mechanism nor a `payload` has a mass");
    given->allow(names_of(model_.info.coordinates), "coordinate");
    for (std::size_t j = 0; j < n_; ++j) {
      const AxisInfo& coordinate = model_.info.coordinates[j];
      const auto magnitude = given->find(coordinate.name);
      if (!magnitude) continue;
      const Term a = draft_.scope.positive(*magnitude, coordinate.unit + "/s^2", "acceleration", true);
      std::vector<Term> load;
      for (std::size_t i = 0; i < n_; ++i) {
        Term inertia = payload * limbs::Term(dot(payload_rates_[i], payload_rates_[j]));
        if (model_.equations) inertia = inertia + model_.term(model_.equations->M_X[i * n_ + j]);
        load.push_back(inertia * a);
      }
      set.half_axes.push_back(load);
    }
  }

  const std::optional<ConfigValue>& table_;
  MechanismDraft& draft_;
  generic::Model& model_;
  std::size_t n_;
  std::vector<Vector3> payload_rates_;
};

/// Reads the keys of [forces] that determine how redundant drives share a load.
void read_sharing(const ConfigValue& table, bool has_cables, MechanismDraft& draft) {
  generic::Model& model = draft.model;
  for (const char* const key : {"distribution", "relative_to"})
    if (const auto given = table.find(key); given && model.info.joints.size() <= model.inputs.coordinates)
      throw given->refusal("the drives are not redundant: there are " + std::to_string(model.info.joints.size()) +
                           " joints for " + std::to_string(model.inputs.coordinates) + " coordinates");
  if (const auto given = table.find("distribution")) {
    const std::string& word = given->word();
    if (word == "centre" && !has_cables)
      throw given->refusal("a centre requires cables, i.e. limbs with `tension`, whose forces have limits");
    model.sharing = word == "centre"          ? ForceSharing::centre
                    : word == "least-maximum" ? ForceSharing::least_maximum
                                              : ForceSharing::least_norm;
  }
  if (const auto given = table.find("relative_to")) {
    if (model.sharing == ForceSharing::centre)
      throw given->refusal("the centre of the allowed tensions does not depend on `relative_to`");
    constexpr const char* kExpected = "one force or torque for each joint";
    const auto scales = given->elements(kExpected);
    if (scales.size() != model.info.joints.size()) throw given->error(kExpected);
    for (std::size_t i = 0; i < scales.size(); ++i)
      model.force_scales.push_back(
          draft.scope.positive(scales[i], model.info.joints[i].turns() ? "N m" : "N", "relative_to").node());
  }
}

/// Adds constraints that follow from the balance of forces along an axis of a translation: some cable has to pull
/// against the load and, without a load, not all cables that pull can pull to the same side. They bound the pose
/// without a limit of the cables' lengths. All limbs have to be cables.
/// @param closure  true: the tensions balance each other, without loads
void add_reach_of_cables(const std::vector<LoadSet>& loads, bool closure, MechanismDraft& draft) {
  generic::Model& model = draft.model;
  const auto greater = [](const Term& a, const Term& b) { return call(expression::operation("max"), a, b); };
  const auto magnitude = [](const Term& a) { return call(expression::operation("abs"), a); };
  const Term none = draft.zero();
  // The constraint: a value that is positive if not all tensions can be 0.
  Term pull = closure ? Term(model.graph, 1.0) : none;
  for (const NamedLimb& limb : draft.limbs) pull = pull + (*limb.tension)[0];
  for (std::size_t i = 0; i < model.inputs.coordinates; ++i)
    if (model.translation_axes[i]) pull = pull + magnitude(loads.front().centre[i]);
  for (std::size_t i = 0; i < model.inputs.coordinates; ++i) {
    if (!model.translation_axes[i]) continue;
    const std::size_t axis = *model.translation_axes[i];
    const expression::Node coordinate =
        model.graph.input(model.inputs.coordinate(i), generic::Inputs::coordinate_group(i));
    std::optional<std::array<Term, 2>> farthest;  // largest distance from a joint on the base, along -axis and +axis
    bool is_translation = true;
    for (const NamedLimb& limb : draft.limbs) {
      const Vector3 v = limb.points.at("B") - limb.points.at("A");
      for (std::size_t k = 0; k < 3; ++k)
        is_translation = is_translation &&
                         model.term(expression::derivative(model.graph, v[k].node(), coordinate)).is(k == axis ? 1 : 0);
      std::array<Term, 2> ends = {none - v[axis], v[axis]};
      if (limb.pulley_radius)  // the cable leaves the pulley at a distance of at most 2 radius from A
        for (Term& end : ends) end = end + *limb.pulley_radius * 2.0;
      farthest = farthest ? std::array{greater((*farthest)[0], ends[0]), greater((*farthest)[1], ends[1])} : ends;
    }
    if (!is_translation) continue;
    for (const LoadSet& set : loads) {
      Term half = none;
      for (const auto& axes : set.half_axes) half = half + magnitude(axes[i]);
      const bool is_free = closure || (set.centre[i].is(0) && half.is(0));
      const Term up = is_free ? pull : set.centre[i] - half, down = is_free ? pull : none - set.centre[i] - half;
      model.reach_constraints.push_back(greater((*farthest)[0], none - up).node());
      model.reach_constraints.push_back(greater((*farthest)[1], none - down).node());
    }
  }
}

}  // namespace

void read_tension(const ConfigValue& table, NamedLimb& limb, MechanismDraft& draft) {
  const auto tension = table.find("tension");
  if (!tension) return;
  if (const auto radius = table.find("pulley_radius"))
    limb.pulley_radius = draft.scope.positive(*radius, "m", limb.group);
  limb.tension = read_range(*tension, "N", limb.group, draft);
  const auto& [from, to] = *limb.tension;
  draft.model.required.push_back({limb.name + ": minimum tension", "N", from.node()});
  draft.model.required.push_back({limb.name + ": maximum - minimum tension", "N", (to - from).node()});
}

void add_forces(const ConfigValue& root, const ConfigValue* study, MechanismDraft& draft) {
  generic::Model& model = draft.model;
  const std::size_t joints = model.info.joints.size(), coordinates = model.inputs.coordinates;
  std::vector<std::optional<std::array<Term, 2>>> tensions(joints);
  std::size_t cables = 0;
  for (const NamedLimb& limb : draft.limbs)
    if (limb.tension) {
      tensions[limb.joint] = limb.tension;
      ++cables;
    }
  const auto table = root.find_table("forces");
  if (table) {
    if (cables == 0)
      for (const char* const key : {"cables", "payload", "payload_at", "force", "moment", "acceleration"})
        if (const auto given = table->find(key))
          throw given->refusal(std::string("`") + key + "` requires cables, i.e. limbs with `tension`");
    read_sharing(*table, cables > 0, draft);
  }
  if (cables == 0) return;
  const std::string counts = std::to_string(joints) + " joints for " + std::to_string(coordinates) + " coordinates";
  if (joints < coordinates)
    throw root.refusal("limits of the tension need at least as many joints as coordinates, but there are " + counts);
  if (joints - cables >= coordinates)
    throw root.refusal("limits of the tension have no effect: the drives that are no cables balance every load alone");
  for (const auto& tension : tensions)
    model.tensions.push_back(tension ? std::optional(std::array{(*tension)[0].node(), (*tension)[1].node()})
                                     : std::nullopt);
  const auto kinematics = generic::first_order_kinematics(model);
  const std::vector<LoadSet> loads = Loads(table, draft).sets();
  const generic::TensionBalance balance =
      generic::tension_balance(kinematics.J, kinematics.translation, tensions, loads);
  const auto add = [&](const char* name, const char* unit, const Term& value, const char* meaning) {
    add_predefined_quantity(root, study, {name, unit, meaning, value}, draft);
  };
  add("tension_factor", "1", balance.factor,
      "largest ratio of minimum to maximum tension with which the cables balance each other; < 0: they cannot");
  add("tension_reserve", "N", balance.reserve,
      "by how much all limits of the tensions can be tightened while the cables balance all loads");
  if (balance.capacity)
    add("wrench_capacity", "N", *balance.capacity,
        "largest force in every direction at the platform that the cables balance in addition to all loads");
  const bool closure = table && table->word_at("cables") == "wrench-closure";
  if (cables == joints) add_reach_of_cables(loads, closure, draft);
  model.margins.push_back(closure ? generic::Result{"wrench-closure", "1", balance.factor.node()}
                                  : generic::Result{"wrench-feasible", "N", balance.reserve.node()});
  draft.scope.mark_as_defined(model.margins.back().node);
  generic::BalanceNodes balanced{.margin = model.margins.back().node, .J = {}, .loads = {}};
  for (std::size_t i = 0; i < joints * coordinates; ++i)
    balanced.J.push_back(kinematics.J(i / coordinates, i % coordinates).node());
  const auto nodes_of = [](const std::vector<Term>& terms) {
    std::vector<expression::Node> nodes;
    for (const Term& term : terms) nodes.push_back(term.node());
    return nodes;
  };
  for (const LoadSet& set : loads) {
    if (closure) break;
    balanced.loads.push_back({nodes_of(set.centre), {}});
    for (const auto& axis : set.half_axes) balanced.loads.back().half_axes.push_back(nodes_of(axis));
  }
  model.balance = std::move(balanced);
}

}  // namespace pkm
