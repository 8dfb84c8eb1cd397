#include "tests/unit/config/fake_catalogues.hpp"

#include <stdexcept>

#include "engine/workspace/pose_quantities.hpp"

namespace pkm::testing {
namespace {

int evaluators = 0;

class IdleSurveyor final : public VoxelEvaluator {
 public:
  explicit IdleSurveyor(double plane) : plane_(plane) {}
  void evaluate(std::span<const double>, Scratch&, WorkspaceResult<double>& survey) const override {
    survey.clear();
    // The made-up rail ends at y = 2 m.
    survey.volume = plane_ <= 2 ? 1 : 0;
  }
  VoxelMap map(std::span<const double>) const override { return {}; }

 private:
  double plane_;
};

class Slider final : public Mechanism, Voxels, Columns {
 public:
  Slider() {
    info_.name = "slider";
    info_.title = "a machine for tests";
    info_.parameters = {{"a", "m", 0.2, 0, 2, "half width"},
                        {"b", "m", 0.8, 0.1, 3, "distance"},
                        {"tilt", "rad", 0.5, -1, 1, "tilt"},
                        {"mass", "kg", 2, 0, 100, "mass"}};
    info_.coordinates = {{"x", "m"}, {"y", "m"}, {"z", "m"}, {"theta", "rad"}};
    info_.joints = {{"q1", "m"}, {"q2", "m"}, {"q3", "m"}, {"q4", "m"}};
    info_.modes = {"lower"};
    info_.sweeps = {{.swept = {0, 2, 3}, .fixed = {1}, .column = 2, .integrates = true}};
    info_.limits = {{"gap_min", "m", 0, 0, 1, "gap", "2 a", "least gap"},
                    {"angle_max", "rad", 1.5, 0, 1.5, "gap", "", "greatest angle"}};
  }
  const MechanismInfo& info() const override { return info_; }
  const Voxels* voxels() const override { return this; }
  const Columns* columns() const override { return this; }
  Unsupported refuse(std::span<const double> parameters) const override {
    if (parameters[0] > 0) return {};
    return "the half width a must be > 0";
  }
  PoseReport inspect(std::span<const double>, const Pose<double>&, const std::string&,
                     const LimitSpec&) const override {
    return {};
  }

 private:
  std::unique_ptr<const VoxelEvaluator> prepare(const WorkspacePlan& plan, const VoxelOptions&,
                                                const FieldRequest&) const override {
    return prepare(plan);
  }
  std::unique_ptr<const WorkspaceEvaluator> prepare(const WorkspacePlan& plan, const ColumnOptions&,
                                                    const FieldRequest&) const override {
    return prepare(plan);
  }
  static std::unique_ptr<const VoxelEvaluator> prepare(const WorkspacePlan& plan) {
    const FixedCoordinate fixed = how_fixed(plan, 1);
    if (fixed.kind == FixedCoordinate::Kind::integrated && plan.box())
      throw std::invalid_argument("the slider cannot integrate inside a given box");
    ++evaluators;
    return std::make_unique<IdleSurveyor>(fixed.value);
  }

  MechanismInfo info_;
};

std::string volume_unit(const EntryContext&) { return "m^2 rad"; }
std::string metre(const EntryContext&) { return "m"; }
void needs_conditioning(const EntryContext& context, FieldRequest& request) {
  request.add(kConditioning);
  if (context.options.has("length")) request.characteristic_length = context.options.number("length");
}
std::unique_ptr<const Quantity> make_zero(const EntryContext&) {
  return make_quantity([](const auto&) { return 0.0; });
}

std::vector<ObjectiveEntry> make_objectives() {
  std::vector<OptionSpec> options(6);
  options[0] = {"length", OptionKind::number, "m", {}, false, 0, 10, {}, "characteristic length"};
  options[1] = {"count", OptionKind::integer, "1", std::int64_t{5}, false, 1, 100, {}, "how many"};
  options[2] = {"exact", OptionKind::flag, "1", false, false, 0, 0, {}, "exactly or not"};
  options[3] = {"statistic", OptionKind::word, "1", "mean", false, 0, 0, {"mean", "min"}, "which"};
  options[4] = {"weights", OptionKind::named_numbers, "1", {}, false, 0, 1, {}, "weights"};
  options[5] = {"note", OptionKind::word, "1", {}, false, 0, 0, {}, "any text"};
  const auto lacks_force = [](const Mechanism& mechanism) -> Unsupported {
    return "force needs bodies, which the mechanism " + mechanism.info().name + " does not describe";
  };
  return {{"volume",
           "size of the workspace",
           Direction::maximise,
           {},
           volume_unit,
           supports_every_mechanism,
           no_request,
           make_zero},
          {"shape", "how well it is shaped", Direction::maximise, options, unit_one, supports_every_mechanism,
           needs_conditioning, make_zero},
          {"force", "peak force", Direction::minimise, {}, unit_one, lacks_force, no_request, make_zero}};
}

std::vector<OptionSpec> gap_options(const MechanismInfo&) {
  return {{"angle_max", OptionKind::number, "rad", {}, false, 0, 1.5, {}, "greatest angle"}};
}
std::vector<OptionSpec> linear_options(const MechanismInfo&) {
  OptionSpec coefficients, bound;
  coefficients.name = "coefficients";
  coefficients.kind = OptionKind::named_numbers;
  coefficients.required = true;
  bound.name = "bound";
  bound.required = true;
  bound.unit = kUnitOfEntry;
  return {coefficients, bound};
}
/// gap_min follows from the parameters, angle_max if given.
LimitSpec gap_limits(const MechanismInfo& info, const Options& options) {
  LimitSpec limits = no_limits(info);
  limits.derived[0] = true;
  if (options.has("angle_max") && options.number("angle_max") == 0)
    throw std::invalid_argument("an angle_max of 0 leaves no pose");
  if (options.has("angle_max")) limits.given[1] = options.number("angle_max");
  return limits;
}
std::unique_ptr<const Quantity> make_linear(const EntryContext& context) {
  for (const auto& [name, number] : context.options.numbers("coefficients"))
    if (name != "a" && name != "b") throw std::invalid_argument("coefficients name no parameter '" + name + "'");
  return make_zero(context);
}
std::string linear_unit(const EntryContext& context) {
  return context.options.numbers("coefficients").contains("a") ? "m" : "1";
}

std::vector<ConstraintEntry> make_constraints() {
  return {{"gap", "parts stay apart", gap_options, nullptr, supports_every_mechanism, gap_limits, nullptr},
          {"reach", "long enough", no_options, metre, supports_every_mechanism, nullptr, make_zero},
          {"linear", "sum <= bound", linear_options, linear_unit, supports_every_mechanism, nullptr, make_linear}};
}

class Idle final : public Optimiser {
 public:
  StageResult minimise(const StageInput&, EvaluationTable&) const override { return {}; }
  std::int64_t evaluation_limit(const Problem&) const override { return 0; }
};

std::unique_ptr<Optimiser> make_idle(const Options&, const DesignSpace&) { return std::make_unique<Idle>(); }
std::unique_ptr<Optimiser> make_broken(const Options&, const DesignSpace&) {
  throw std::invalid_argument("elite must be smaller than population");
}

void resolve_width(Options& options, const DesignSpace& space) {
  if (!options.has("width")) options.set("width", static_cast<std::int64_t>(3 * space.dimension()));
}

std::vector<OptimiserEntry> make_optimisers() {
  OptionSpec target;
  target.name = "target";
  target.unit = kUnitOfEntry;
  const std::vector<OptionSpec> options = {
      {"population", OptionKind::integer, "1", std::int64_t{40}, false, 2, 1e6, {}, "designs per generation"},
      {"rate", OptionKind::number, "1", 0.5, false, 0, 1, {}, "mutation rate"},
      target,
      {"width", OptionKind::integer, "1", {}, false, 1, 100, {}, "starts per variable (default: 3 per variable)"}};
  return {
      {"ga", "evolves", [](const Options&) { return Capabilities{}; }, options, make_idle, resolve_width},
      {"simple",
       "unconstrained, continuous",
       [](const Options&) { return Capabilities{.constraints = false, .discrete = false}; },
       {},
       make_idle},
      {"newton", "by derivatives", [](const Options&) { return Capabilities{.needs_gradient = true}; }, {}, make_idle},
      {"sweep",
       "tries all",
       [](const Options&) { return Capabilities{.min_objectives = 0, .max_objectives = 9}; },
       {},
       make_idle},
      {"broken", "refuses its options", [](const Options&) { return Capabilities{}; }, {}, make_broken}};
}

}  // namespace

int prepared_evaluators() { return evaluators; }

Catalogues fake_catalogues() {
  static const MechanismList mechanisms{std::make_shared<const Slider>()};
  static const auto objectives = make_objectives();
  static const auto constraints = make_constraints();
  static const auto optimisers = make_optimisers();
  return {mechanisms, objectives, constraints, optimisers};
}

}  // namespace pkm::testing
