// Transmission indices of mechanisms in which each limb acts on the platform by a single force: cranks or sliders with
// rods, telescopic legs, and sliders that carry the platform.
//
// Limb i transmits a force along the unit vector f_i to the platform's joint B_i. The velocity of B_i is D_i x', with
// the rates x' of the coordinates, and row i of the matrix A is the power of a unit force, f_i . D_i.
//
//   input index    |f_i . t_i|, with the direction t_i in which the drive moves the other end of the rod; telescope: 1
//   output index   |f_i . v_i| / |v_i|, where v_i = D_i x' is the velocity of B_i while all other drives are locked:
//                  x' is a multiple of the cofactors of row i of A
//
// Both are in [0, 1]; input indices are 0 at serial singularities, output indices at parallel ones. The local
// transmission index is the minimum of all.
//
// Reference: Wang, Wu, Liu, "Performance evaluation of parallel manipulators: motion/force transmissibility and its
// index", Mechanism and Machine Theory 45 (2010), 1462.
#include <algorithm>

#include "engine/config/mechanism_draft.hpp"
#include "engine/expression/derivative.hpp"
#include "engine/expression/term_matrix.hpp"
#include "engine/workspace/pose_quantities.hpp"

namespace pkm {
namespace {

using expression::Node, expression::TermMatrix;
using generic::Inputs;
using limbs::Term;
using limbs::Vector3;

Vector3 unit(const Vector3& v) { return v / limbs::length(v); }

LimbForce single_force_of(const NamedLimb& limb) {
  const Vector3 &A = limb.points.at("A"), &B = limb.points.at("B"), &C = limb.points.at("C");
  const Term one(B[0].graph(), 1.0);
  if (limb.drive == "slider" && !limb.has_rod) return {unit(*limb.axis), one, B};
  Vector3 rod = B - C;
  // The limb has revolute joints with parallel axes and cannot transmit a force along these axes, so that its force is
  // normal to them.
  if (limb.revolute) {
    const Vector3 n = unit(*limb.revolute);
    rod = rod - n * dot(rod, n);
  }
  const Vector3 force = unit(rod);
  if (limb.drive == "telescope") return {force, one, B};
  const Vector3 motion = limb.drive == "crank" ? cross(*limb.axis, C - A) : *limb.axis;
  return {force, abs(dot(force, unit(motion))), B};
}

Term minimum_of(const std::vector<Term>& values) {
  Term result = values.front();
  for (std::size_t i = 1; i < values.size(); ++i) result = call(expression::operation("min"), result, values[i]);
  return result;
}

constexpr const char *kLti = "lti", *kInput = "lti_input", *kOutput = "lti_output";

std::string why_no_transmission(const ConfigValue& root, const ConfigValue* study, const MechanismDraft& draft) {
  for (const char* const name : {kLti, kInput, kOutput})
    if (draft.scope.knows(name) || defines_quantity(root, study, name))
      return std::string("the mechanism file already uses the name ") + name;
  constexpr std::size_t kMaxCoordinates = 6;
  const std::size_t coordinates = draft.model.inputs.coordinates;
  if (coordinates > kMaxCoordinates) return "there are more than six coordinates";
  for (const NamedLimb& limb : draft.limbs)
    if (limb.drive == "formula" || limb.has_links || limb.driven)
      return "limb " + limb.name + " does not act on the platform by a single force along a rod, telescope or slide";
  for (const NamedLimb& limb : draft.limbs)
    if (limb.begin_on != kBaseFrame)
      return "limb " + limb.name + " begins on the frame " + limb.begin_on + ", which moves";
  if (draft.limbs.size() != coordinates)
    return "there are " + std::to_string(draft.limbs.size()) + " limbs for " + std::to_string(coordinates) +
           " coordinates";
  return "";
}

}  // namespace

std::optional<LimbForce> force_of(const NamedLimb& limb) {
  if (limb.drive == "formula" || limb.has_links || limb.driven) return {};
  return single_force_of(limb);
}

void add_transmission(const ConfigValue& root, const ConfigValue* study, MechanismDraft& draft) {
  generic::Model& model = draft.model;
  if (const std::string why = why_no_transmission(root, study, draft); !why.empty()) {
    model.info.undefined_quantities.push_back({kLti, why});
    return;
  }
  expression::Graph& graph = model.graph;
  const std::size_t n = draft.limbs.size();
  std::vector<LimbForce> all;
  // For each limb, the velocity of its point B for a unit rate of each coordinate.
  std::vector<std::vector<Vector3>> velocities(n);
  TermMatrix powers(graph, n, n);
  for (std::size_t i = 0; i < n; ++i) {
    all.push_back(single_force_of(draft.limbs[i]));
    for (std::size_t j = 0; j < n; ++j) {
      const Node x = model.coordinate(j);
      const auto by_x = [&](std::size_t axis) {
        return Term(graph, expression::derivative(graph, all[i].end[axis].node(), x));
      };
      velocities[i].emplace_back(by_x(0), by_x(1), by_x(2));
      powers(i, j) = dot(all[i].force, velocities[i].back());
    }
  }
  const TermMatrix adjugate = inverse_of(powers).adjugate;
  std::vector<Term> inputs, outputs;
  for (std::size_t i = 0; i < n; ++i) {
    Vector3 v = velocities[i][0] * adjugate(0, i);
    for (std::size_t j = 1; j < n; ++j) v = v + velocities[i][j] * adjugate(j, i);
    inputs.push_back(all[i].input);
    outputs.push_back(abs(dot(all[i].force, v)) / limbs::length(v));
  }
  const Term input = minimum_of(inputs), output = minimum_of(outputs);
  const auto add = [&](const std::string& name, const Term& value, const std::string& meaning) {
    const auto of_pose = formula_quantity(name, "1", meaning, model.quantities.size());
    model.quantities.push_back(value.node());
    model.info.quantities.push_back({.name = name, .unit = "1", .meaning = meaning, .of_pose = of_pose});
    draft.scope.add(root, name, value.node());
  };
  add(kLti, minimum_of({input, output}), "local transmission index: minimum of lti_input and lti_output");
  add(kInput, input, "minimum over the limbs of the input transmission index, 0 at serial singularities");
  add(kOutput, output, "minimum over the limbs of the output transmission index, 0 at parallel singularities");
  const auto add_of_limb = [&](const std::string& name, const std::string& unit, const Term& value,
                               const std::string& meaning) {
    model.quantities.push_back(value.node());
    model.info.quantities.push_back({.name = name, .unit = unit, .meaning = meaning});
  };
  for (std::size_t i = 0; i < n; ++i) {
    const std::string& limb = draft.limbs[i].name;
    if (!inputs[i].is(1)) {
      add_of_limb("lti_input_" + limb, "1", inputs[i], "input transmission index of limb " + limb);
      add_of_limb("pressure_angle_" + limb, "rad", acos(inputs[i]),
                  "angle between the rod's force and the motion of the drive's end, limb " + limb);
    }
    add_of_limb("lti_output_" + limb, "1", outputs[i], "output transmission index of limb " + limb);
  }
}

}  // namespace pkm
