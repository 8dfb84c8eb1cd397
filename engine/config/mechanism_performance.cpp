// Performance quantities that every mechanism has if its file or a study gives the required data: velocity
// transmission, accuracy, stiffness, effective mass and acceleration (engine/generic/performance/performance.hpp).
#include <algorithm>
#include <numbers>

#include "engine/config/mechanism_draft.hpp"
#include "engine/config/tables.hpp"
#include "engine/core/catalogue.hpp"
#include "engine/expression/derivative.hpp"
#include "engine/generic/performance/performance.hpp"
#include "engine/geometry/mixed_units.hpp"
#include "engine/workspace/pose_quantities.hpp"

namespace pkm {
namespace {

using expression::TermMatrix;
using generic::NamedTerm;
using limbs::Term, limbs::Vector3;

class Performance {
 public:
  Performance(const ConfigValue& root, const ConfigValue* study, MechanismDraft& draft)
      : root_(root),
        study_(study),
        draft_(draft),
        model_(draft.model),
        joints_(model_.joints.size()),
        at_(first_order_kinematics(model_)) {}

  void add_all() {
    if (const std::string why = why_no_inverse(); !why.empty()) {
      for (const char* const name : {"velocity_transmission", "force_transmission", "accuracy"}) lack(name, why);
      if (const auto table = accuracy_table()) throw table->refusal("the accuracy is undefined: " + why);
    } else {
      add_velocities();
      add_accuracy();
    }
    if (model_.equations) {
      const std::size_t n = model_.inputs.coordinates;
      M_X_.emplace(model_.graph, n, n);
      for (std::size_t i = 0; i < n * n; ++i) (*M_X_)(i / n, i % n) = model_.term(model_.equations->M_X[i]);
      add_rotors();
      add(generic::inertia_quantities(at_, *M_X_));
    } else {
      lack("effective_mass", "the mechanism file has no masses");
    }
    add_stiffness();
    add_acceleration();
  }

 private:
  /// The reason why the Jacobian has neither an inverse nor a pseudo-inverse; "" if it has one.
  std::string why_no_inverse() const {
    if (joints_ >= model_.inputs.coordinates) return "";
    return "there are " + std::to_string(joints_) + " joints for " + std::to_string(model_.inputs.coordinates) +
           " coordinates";
  }
  void lack(const std::string& name, const std::string& why) {
    model_.info.undefined_quantities.push_back({name, why});
  }

  void add(const std::vector<NamedTerm>& terms) {
    for (const NamedTerm& term : terms) add(term);
  }
  void add(const NamedTerm& term) { add_predefined_quantity(root_, study_, term, draft_); }

  std::string force_unit(std::size_t joint) const { return model_.info.joints[joint].turns() ? "N m" : "N"; }
  const NamedLimb* limb_of(std::size_t joint) const {
    for (const NamedLimb& limb : draft_.limbs)
      if (limb.drive != "formula" && limb.joint == joint) return &limb;
    return nullptr;
  }

  /// Adds J^T diag(I) J to M_X, where I are the reflected inertias of the study's [[drive_train]] tables.
  void add_rotors() {
    const auto gears = by_joint("gear"), leads = by_joint("lead");
    std::vector<double> inertia(joints_, 0.0);
    bool has_inertia = false;
    const auto add_inertia = [&](std::size_t joint, const ConfigValue& given) {
      double ratio = gears[joint] ? gears[joint]->number() : 1;
      if (leads[joint]) ratio *= 2 * std::numbers::pi / leads[joint]->number();
      inertia[joint] += given.number() * ratio * ratio;
      has_inertia = has_inertia || inertia[joint] > 0;
    };
    for (const char* const key : {"rotor_inertia", "shaft_inertia"}) {
      const auto given = by_joint(key);
      for (std::size_t joint = 0; joint < joints_; ++joint)
        if (given[joint]) add_inertia(joint, *given[joint]);
    }
    const auto motors = by_joint("motor");
    for (std::size_t joint = 0; joint < joints_; ++joint)
      for (const ConfigValue& motor : motors[joint] ? study_->tables("motor") : std::vector<ConfigValue>())
        if (motor.at("name").text("a name") == motors[joint]->text("the name of a [[motor]]"))
          add_inertia(joint, motor.at("rotor_inertia"));
    if (!has_inertia) return;
    const TermMatrix& J = at_.J;
    TermMatrix weighted = J;
    for (std::size_t i = 0; i < J.rows(); ++i)
      for (std::size_t j = 0; j < J.columns(); ++j) weighted(i, j) = J(i, j) * inertia[i];
    *M_X_ = *M_X_ + J.transposed() * weighted;
  }

  void add_velocities() {
    if (mixes_units(model_.info.joints))
      for (const char* const name : {"velocity_transmission", "force_transmission"})
        lack(name, "the joints include both lengths and angles");
    else
      add(generic::velocity_quantities(model_, at_));
  }

  // The following functions add the quantities of the platform's accuracy.

  /// The table [accuracy] of the study or, if it has none, of the mechanism file; std::nullopt if neither has one.
  std::optional<ConfigValue> accuracy_table() const {
    if (study_)
      if (auto table = study_->find_table("accuracy")) return table;
    return root_.find_table("accuracy");
  }
  void add_accuracy() {
    const auto table = accuracy_table();
    const bool has_play =
        std::ranges::any_of(draft_.limbs, [](const NamedLimb& limb) { return limb.play.has_value(); });
    if (!table && !has_play)
      return lack("accuracy", "there is no [accuracy] with joint_error or parameter_error, and no limb has `play`");
    errors_ = {std::vector<Term>(joints_, draft_.zero()), std::vector<Term>(joints_, draft_.zero())};
    if (table) read_errors(*table);
    for (std::size_t joint = 0; joint < joints_; ++joint)
      if (const NamedLimb* const limb = limb_of(joint); limb && limb->play)
        for (int end = 0; end < 2; ++end) add_error(joint, *limb->play / joint_motion(*limb));
    for (const Term& bound : errors_.bound) model_.joint_errors.push_back(bound.node());
    add(generic::accuracy_quantities(at_, errors_));
  }
  /// Derivative, with respect to the joint coordinate, of the displacement of the driven end of a rod or leg along its
  /// line.
  Term joint_motion(const NamedLimb& limb) const {
    const LimbForce force = *force_of(limb);
    return limb.drive == "crank" ? force.input * limbs::length(limb.points.at("C") - limb.points.at("A")) : force.input;
  }
  void add_error(std::size_t joint, const Term& error) {
    errors_.bound[joint] = errors_.bound[joint] + abs(error);
    errors_.squared_spread[joint] = errors_.squared_spread[joint] + error * error;
  }
  void read_errors(const ConfigValue& table) {
    if (const auto given = table.find("joint_error")) read_joint_errors(*given);
    if (const auto given = table.find_table("parameter_error")) read_parameter_errors(*given);
    if (table.keys().empty()) throw table.refusal("the table is empty; expected joint_error or parameter_error");
  }
  void read_joint_errors(const ConfigValue& given) {
    const auto read = [&](const ConfigValue& value, std::size_t joint) {
      add_error(joint, draft_.scope.positive(value, model_.info.joints[joint].unit, "joint_error", true));
    };
    if (!given.is_table()) {
      if (mixes_units(model_.info.joints))
        throw given.refusal("the joints include both lengths and angles: give joint_error by joint, { " +
                            model_.info.joints.front().name + " = .., .. }");
      for (std::size_t joint = 0; joint < joints_; ++joint) read(given, joint);
      return;
    }
    const ConfigValue by_name = given.table();
    by_name.allow(names_of(model_.info.joints), "joint");
    for (std::size_t joint = 0; joint < joints_; ++joint)
      if (const auto value = by_name.find(model_.info.joints[joint].name)) read(*value, joint);
  }
  /// Reads the errors of parameters. If all limbs share a parameter, it has an independent error in each limb, which
  /// affects only the joints of that limb.
  void read_parameter_errors(const ConfigValue& all) {
    for (const std::string& name : all.dotted_keys(false)) {
      const ConfigValue value = *all.find(name);
      const auto dot = name.find('.');
      const std::string limb = dot == std::string::npos ? "" : name.substr(0, dot);
      const std::string parameter = dot == std::string::npos ? name : name.substr(dot + 1);
      const Parameter* const known = find_named(model_.info.parameters, parameter);
      if (!known)
        throw value.error_of("the unknown parameter '" + parameter + "'",
                             "one of " + join(names_of(model_.info.parameters)),
                             nearest_name(parameter, names_of(model_.info.parameters)));
      if (!limb.empty() && !find_named(draft_.limbs, limb))
        throw value.error_of("the unknown limb '" + limb + "'", "one of " + join(names_of(draft_.limbs)),
                             nearest_name(limb, names_of(draft_.limbs)));
      const Term error = draft_.scope.positive(value, known->unit, name, true);
      const auto index = static_cast<std::size_t>(known - model_.info.parameters.data());
      bool has_effect = false;
      for (std::size_t joint = 0; joint < joints_; ++joint) {
        const NamedLimb* const of = limb_of(joint);
        if (!limb.empty() && !(of && of->name == limb)) continue;
        const Term effect = by_parameter(joint, of ? of->name : "", parameter, index);
        has_effect = has_effect || !effect.is(0);
        add_error(joint, effect * error);
      }
      if (!has_effect) throw value.refusal("an error of " + name + " has no effect: no joint depends on it");
    }
  }
  /// Derivative of a joint coordinate with respect to a parameter. If the limb has its own parameter of this name, that
  /// one is used, otherwise the one that all limbs share.
  Term by_parameter(std::size_t joint, const std::string& limb, const std::string& parameter, std::size_t index) {
    expression::Node input = model_.graph.input(index, generic::Inputs::kDesign);
    for (const OwnParameter& own : draft_.own)
      if (own.limb == limb && own.parameter == parameter) input = own.node;
    return model_.term(expression::derivative(model_.graph, model_.joints[joint], input));
  }

  // The following functions add the quantities of the platform's stiffness.

  /// For each joint, the value of a key in its [[drive_train]] table of the study; std::nullopt if it is absent.
  std::vector<std::optional<ConfigValue>> by_joint(const std::string& key) const {
    std::vector<std::optional<ConfigValue>> found(joints_);
    std::vector<std::string> words = names_of(model_.info.joints);
    words.emplace_back("all");
    if (!study_) return found;
    for (const ConfigValue& table : study_->tables("drive_train"))
      if (const auto value = table.find(key)) {
        const std::string& word = table.at("joint").word(words);
        for (std::size_t joint = 0; joint < joints_; ++joint)
          if (word == "all" || word == model_.info.joints[joint].name) found[joint] = value;
      }
    return found;
  }
  void add_stiffness() {
    const auto given = by_joint("stiffness");
    std::vector<generic::LimbSpring> springs;
    bool is_rigid = true;
    for (std::size_t joint = 0; joint < joints_; ++joint) {
      if (given[joint])  // the value in the study takes precedence over the value in the mechanism file
        draft_.drive_stiffness[joint] =
            draft_.scope.positive(*given[joint], model_.info.joints[joint].turns() ? "N m/rad" : "N/m", "stiffness");
      springs.push_back(spring_of(joint, draft_.drive_stiffness[joint]));
      is_rigid = is_rigid && springs.back().compliance.is(0);
    }
    if (is_rigid) {
      for (const char* const name : {"stiffness", "natural_frequency"})
        lack(name, "no limb has `drive_stiffness` or a section with `young`, and no [[drive_train]] has `stiffness`");
      return;
    }
    for (const NamedLimb& limb : draft_.limbs)
      if (limb.begin_on != kBaseFrame)
        return lack("stiffness", "limb " + limb.name + " begins on the frame " + limb.begin_on + ", which moves");
    if (joints_ < model_.inputs.coordinates)
      return lack("stiffness", "the drives do not determine all coordinates: " + why_no_inverse());
    const auto rigid = [](const generic::LimbSpring& spring) { return spring.compliance.is(0); };
    if (joints_ > model_.inputs.coordinates && std::ranges::any_of(springs, rigid))
      return lack("stiffness", "there are more drives than coordinates, and not all of their limbs are elastic");
    add(generic::stiffness_quantities(at_, springs, M_X_));
    if (!M_X_) lack("natural_frequency", "the mechanism file has no masses");
  }
  generic::LimbSpring spring_of(std::size_t joint, const std::optional<Term>& drive) {
    const NamedLimb* const limb = limb_of(joint);
    const std::optional<LimbForce> force = limb ? force_of(*limb) : std::nullopt;
    const std::size_t n = model_.inputs.coordinates;
    const Term compliant = drive ? Term(model_.graph, 1.0) / *drive : draft_.zero();
    if (!force) {
      std::vector<Term> row;
      for (std::size_t j = 0; j < n; ++j) row.push_back(at_.J(joint, j));
      return {row, compliant};
    }
    std::vector<Term> row;
    for (std::size_t j = 0; j < n; ++j) {
      const auto by_x = [&](std::size_t axis) {
        return model_.term(expression::derivative(model_.graph, force->end[axis].node(), model_.coordinate(j)));
      };
      row.push_back(dot(force->force, Vector3{by_x(0), by_x(1), by_x(2)}));
    }
    const Term motion = joint_motion(*limb);
    const Term compliance = motion * motion * compliant;
    return {row, compliance + compliance_of_links(*limb, draft_)};
  }

  void add_acceleration() {
    const auto given = by_joint("peak_force");
    std::vector<std::optional<Term>> known;
    for (std::size_t joint = 0; joint < joints_; ++joint) {
      known.push_back(given[joint]
                          ? std::optional(draft_.scope.positive(*given[joint], force_unit(joint), "peak_force"))
                          : std::nullopt);
      model_.peak_forces.push_back(known.back() ? std::optional(known.back()->node()) : std::nullopt);
    }
    if (std::ranges::any_of(given, [](const auto& each) { return !each; }))
      return lack("acceleration", "it needs [[drive_train]] peak_force for every joint");
    if (!M_X_) return lack("acceleration", "the mechanism file has no masses");
    std::vector<Term> peak, G;
    for (const auto& each : known) peak.push_back(*each);
    for (const expression::Node node : model_.equations->G_X) G.push_back(model_.term(node));
    if (const auto found = generic::acceleration_quantity(at_, *M_X_, G, peak)) add(*found);
  }

  const ConfigValue& root_;
  const ConfigValue* study_;
  MechanismDraft& draft_;
  generic::Model& model_;
  std::size_t joints_;
  generic::FirstOrderKinematics at_;
  generic::JointErrors errors_;
  std::optional<TermMatrix> M_X_;
};

}  // namespace

void add_predefined_quantity(const ConfigValue& root, const ConfigValue* study, const NamedTerm& quantity,
                             MechanismDraft& draft) {
  const auto& [name, unit, meaning, value] = quantity;
  generic::Model& model = draft.model;
  if (draft.scope.knows(name) || defines_quantity(root, study, name)) {
    model.info.undefined_quantities.push_back({name, "the mechanism file already uses the name " + name});
    return;
  }
  const auto of_pose = formula_quantity(name, unit, meaning, model.quantities.size());
  model.quantities.push_back(value.node());
  model.info.quantities.push_back({.name = name, .unit = unit, .meaning = meaning, .of_pose = of_pose});
  draft.scope.add(root, name, value.node());
  draft.scope.mark_as_defined(value.node());
}

void add_performance(const ConfigValue& root, const ConfigValue* study, MechanismDraft& draft) {
  Performance(root, study, draft).add_all();
}

}  // namespace pkm
