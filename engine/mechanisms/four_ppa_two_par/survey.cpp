#include "engine/mechanisms/four_ppa_two_par/survey.hpp"

#include <stdexcept>

#include "engine/mechanisms/four_ppa_two_par/clear_volume.hpp"
#include "engine/mechanisms/four_ppa_two_par/voxels.hpp"
#include "engine/survey/share_samples.hpp"
#include "engine/survey/with_slopes.hpp"

namespace pkm::four_ppa_two_par {
namespace {

template <class S>
S plane(const Geometry<S>& g, const HeldCoordinate& held) {
  return held.kind == HeldCoordinate::Kind::value ? S(held.value) : middle_plane(g);
}

template <class S>
S gamma(const Geometry<S>& g, const Demand& demand) {
  return demand.characteristic_length ? S(g.a / (2 * *demand.characteristic_length)) : S(1.0);  // default L_c = a/2
}

constexpr int kY = 1;  ///< the coordinate that surveys hold

/// The only mode whose poses are surveyed.
constexpr const char* kSurveyedMode = "lower,lower";

template <class S>
SampleContents<S> contents(std::span<const S> parameters, const Demand& demand) {
  SampleContents<S> c{.conditioning = demand.has(kConditioning),
                      .poses = demand.poses,
                      .inertia = demand.needs_inertia(),
                      .gamma = gamma(geometry(parameters), demand),
                      .masses = {}};
  if (c.inertia) {
    c.masses = masses(parameters);
    std::ranges::copy(demand.rotors, c.masses.rotors.begin());
  }
  return c;
}

class ColumnSurveyor final : public WithSlopes<ColumnSurveyor> {
 public:
  ColumnSurveyor(const SurveyPlan& plan, const ColumnOptions& columns, const Demand& demand)
      : limits_(plan.limits),
        held_(how_held(plan, kY)),
        columns_(columns),
        demand_(demand),
        inner_rule_(gauss_legendre(columns.nodes[0] > 0 ? columns.nodes[0] : kSampleNodes)),
        theta_rule_(gauss_legendre(columns.nodes[1] > 0 ? columns.nodes[1] : kSampleNodes)) {}

  const SlopeSurveyor* slopes() const override { return limits_.given[kClearanceMin] ? nullptr : this; }
  std::string why_no_slopes() const override {
    return "the study limits the clearance of links (clearance_min), which may end columns where no formula says, and "
           "such surveys have no derivatives; take an optimiser without gradients, or keep the sliders apart by h_min";
  }

 private:
  friend WithSlopes<ColumnSurveyor>;
  static constexpr int kSampleNodes = 12, kInertiaNodesOverY = 8;

  template <class S>
  void run(std::span<const S> parameters, Scratch& room, Survey<S>& survey) const {
    survey.clear(demand_.fields);
    ColumnScratch<S>& scratch = room.get<ColumnScratch<S>>();
    const Geometry<S> g = geometry(parameters);
    Limits<S> l = limits(g, limits_);
    std::optional<ClearanceTest> clearance;
    if constexpr (std::is_same_v<S, double>) clearance = take_clearance(g, l);
    const ClearanceTest* const test = clearance ? &*clearance : nullptr;
    const S y = plane(g, held_);
    const Frame<S> f = frame(g, l, y);
    const bool over_y = held_.kind == HeldCoordinate::Kind::integrated;
    const Integral<S> volume = volume_of(f, test, over_y, scratch);
    survey.volume = volume.value;
    survey.error = value_of(volume.value) > 0 ? volume.error / value_of(volume.value) : 0;
    survey.columns = volume.evaluations;
    if (!demand_.needs_samples()) return;
    const SampleContents<S> wanted = contents(parameters, demand_);
    if (!over_y) {
      sample(f, wanted, value_of(y) > value_of(S(g.L0 - y)) ? Planes::far : Planes::near, S(1.0), theta_rule_,
             inner_rule_, test, scratch, survey);
      return;
    }
    const Piece<S> half{l.h_min, g.L0 * 0.5, true, false};
    if (!(value_of(half.upper) > value_of(half.lower))) return;
    // Over y every node has eight poses: samples that tell them apart make do with a coarser rule.
    static const GaussRule coarse = gauss_legendre(kInertiaNodesOverY);
    const GaussRule &inner = wanted.told_apart() ? coarse : inner_rule_,
                    &outer = wanted.told_apart() ? coarse : theta_rule_;
    for (std::size_t i = 0; i < inner.node.size(); ++i) {
      const auto [at, jacobian] = map_node(half, inner.node[i]);
      sample(frame(g, l, at), wanted, Planes::both, S(jacobian * inner.weight[i]), outer, inner, test, scratch, survey);
    }
  }

  template <class S>
  Integral<S> volume_of(const Frame<S>& f, const ClearanceTest* test, bool over_y, ColumnScratch<S>& scratch) const {
    if constexpr (std::is_same_v<S, double>) {
      if (test)
        return columns_.nodes[1] > 0 ? clear_volume_by_rule(f, *test, theta_rule_, inner_rule_, scratch)
                                     : clear_volume(f, *test, over_y, columns_.tolerance, scratch);
    }
    return over_y                  ? volume_over_y(f.g, f.l, columns_.tolerance, scratch)
           : columns_.nodes[1] > 0 ? fixed_rule(f, scratch)
                                   : plane_volume(f, columns_.tolerance, scratch);
  }

  /// The volume by the study's own number of theta nodes per piece; no error is estimated.
  template <class S>
  Integral<S> fixed_rule(const Frame<S>& f, ColumnScratch<S>& scratch) const {
    find_pieces(f, scratch.breaks, scratch.pieces);
    Integral<S> result;
    for (const auto& piece : scratch.pieces)
      for (std::size_t i = 0; i < theta_rule_.node.size(); ++i) {
        const auto [theta, jacobian] = map_node(piece, theta_rule_.node[i]);
        const auto [s, c] = sincos(theta);
        result.value += (2 * theta_rule_.weight[i]) * jacobian * area(f, section(f, s, c));
        ++result.evaluations;
      }
    return result;
  }

  LimitSpec limits_;
  HeldCoordinate held_;
  ColumnOptions columns_;
  Demand demand_;
  GaussRule inner_rule_, theta_rule_;
};

class OfVoxels final : public VoxelSurveyor {
 public:
  OfVoxels(const SurveyPlan& plan, const VoxelOptions& voxels, const Demand& demand)
      : limits_(plan.limits),
        held_(how_held(plan, kY)),
        voxels_(voxels),
        demand_(demand),
        counter_(voxels.cells, voxels.box ? (*voxels.box)[2] : kTheta) {}

  VoxelMap map(std::span<const double> parameters) const override {
    const Geometry<double> g = geometry(parameters);
    Limits<double> l = limits(g, limits_);
    const auto clearance = take_clearance(g, l);
    const VoxelGrid grid(voxels_.cells, voxels_.box ? *voxels_.box : default_box(g));
    VoxelMap m = grid.map();
    ColumnBlock columns;
    const double y = plane(g, held_);
    counter_.visit_columns({.g = g, .l = l, .test = clearance ? &*clearance : nullptr, .y = y, .grid = grid}, columns,
                           [&](std::int64_t i, std::int64_t first, std::int64_t end, std::int64_t k) {
                             for (std::int64_t j = first; j < end; ++j)
                               m.feasible[static_cast<std::size_t>((i * grid.cells[1] + j) * grid.cells[2] + k)] = 1;
                           });
    return m;
  }

 private:
  static constexpr std::array<double, 2> kTheta = {-kPi / 2, kPi / 2};

  void survey(std::span<const double> parameters, Scratch& room, Survey<double>& survey) const override {
    survey.clear(demand_.fields);
    VoxelScratch& scratch = room.get<VoxelScratch>();
    const Geometry<double> g = geometry(parameters);
    Limits<double> l = limits(g, limits_);
    const auto clearance = take_clearance(g, l);
    const ClearanceTest* const test = clearance ? &*clearance : nullptr;
    const VoxelGrid grid(voxels_.cells, voxels_.box ? *voxels_.box : default_box(g));
    const bool over_y = held_.kind == HeldCoordinate::Kind::integrated;
    const SampleContents<double> wanted = contents(parameters, demand_);
    const std::int64_t planes = over_y ? held_.cells : 1;
    const double y_step = over_y ? g.L0 / static_cast<double>(planes) : 1;
    survey.cells = grid.count() * planes;
    survey.cell_volume = grid.cell_volume() * y_step;
    for (std::int64_t p = 0; p < planes; ++p) {
      const double y = over_y ? (static_cast<double>(p) + 0.5) * y_step : plane(g, held_);
      const VoxelPlane at{.g = g, .l = l, .test = test, .y = y, .grid = grid};
      bool touches = false;
      survey.feasible_cells += counter_.count(at, scratch, touches);
      survey.touches_box = survey.touches_box || touches;
      if (demand_.needs_samples()) sample(at, wanted, scratch, survey);
    }
    survey.volume = static_cast<double>(survey.feasible_cells) * survey.cell_volume;
  }

  void sample(const VoxelPlane& at, const SampleContents<double>& wanted, VoxelScratch& scratch,
              Survey<double>& survey) const {
    const Geometry<double>& g = at.g;
    const VoxelGrid& grid = at.grid;
    // Conditioning is the same at mirrored poses: one sample stands for all of them, unless they are told apart.
    const bool together = !wanted.told_apart() && !at.test;
    const Halves halves = together ? counter_.halves(at) : counter_.whole();
    share_samples(counter_.blocks(halves), survey, [&](std::size_t block, Survey<double>& part, std::size_t worker) {
      VoxelWorker& own = scratch.workers[worker];
      ColumnConditioning<double>& poses = own.poses;
      const Sampled<double> to(part);
      counter_.visit_block(
          at, block, halves, own.columns, [&](std::int64_t i, std::int64_t first, std::int64_t end, std::int64_t k) {
            const double s = counter_.sin_theta(k), c = counter_.cos_theta(k), x = grid.centre(0, i);
            const std::array<double, 2> x_j = {x - g.a * c / 2, g.b - x - g.a * c / 2};
            const std::array<double, 2> sigma = {root_or_zero((g.l_d - x_j[0]) * (g.l_d + x_j[0])),
                                                 root_or_zero((g.l_d - x_j[1]) * (g.l_d + x_j[1]))};
            poses.clear();
            for (std::int64_t j = first; j < end; ++j) {
              const double z = grid.centre(1, j) + g.d;
              poses.add(z + sigma[0], z + sigma[1]);
            }
            if (wanted.conditioning) poses.compute({g.l_u, wanted.gamma, s, c, x_j, sigma});
            const double weight = survey.cell_volume * halves.images(i, k);
            for (std::int64_t j = first; j < end; ++j) {
              const auto n = static_cast<std::size_t>(j - first);
              if (wanted.inertia)
                inertia_values(joint_inertia(g, wanted.masses, s, c, x_j, sigma, {poses.z_c[0][n], poses.z_c[1][n]}),
                               part, own.inertia);
              add_sample(wanted, weight, {x, at.y, grid.centre(1, j), grid.centre(2, k)},
                         wanted.conditioning ? poses.index[n] : 0, own.inertia, false, to);
            }
          });
    });
  }

  LimitSpec limits_;
  HeldCoordinate held_;
  VoxelOptions voxels_;
  Demand demand_;
  VoxelCounter counter_;
};

/// Samples stand for mirrored poses, where the two sliders of a rail change places.
void refuse_unequal_rotors(const Demand& demand) {
  const std::vector<double>& rotors = demand.rotors;
  if (demand.needs_inertia() && !rotors.empty() && (rotors[0] != rotors[1] || rotors[2] != rotors[3]))
    throw std::invalid_argument(
        "workspaces of mechanism 4ppa-2par need drive trains of the same inertia on both sliders of a rail");
}

void refuse_demand(const Demand& demand) {
  refuse_unequal_rotors(demand);
  if (demand.needs_inertia() && !demand.mode.empty() && demand.mode != kSurveyedMode)
    throw std::invalid_argument("workspaces of mechanism 4ppa-2par are of the working mode " +
                                std::string(kSurveyedMode) + ", so inertia is not surveyed in the mode " + demand.mode);
}

bool is_over_y(const SurveyPlan& plan) { return how_held(plan, kY).kind == HeldCoordinate::Kind::integrated; }

}  // namespace

std::unique_ptr<const Surveyor> make_column_surveyor(const SurveyPlan& plan, const ColumnOptions& columns,
                                                     const Demand& demand) {
  refuse_demand(demand);
  if (is_over_y(plan) && columns.nodes[0] > 0)
    throw std::invalid_argument(
        "nodes fix the accuracy on one plane y only; with y = \"integrated\" give a tolerance instead");
  return std::make_unique<ColumnSurveyor>(plan, columns, demand);
}

std::unique_ptr<const VoxelSurveyor> make_voxel_surveyor(const SurveyPlan& plan, const VoxelOptions& voxels,
                                                         const Demand& demand) {
  refuse_demand(demand);
  if (is_over_y(plan) && how_held(plan, kY).cells < 1)
    throw std::invalid_argument("voxels integrated over y need a number of cells for y");
  return std::make_unique<OfVoxels>(plan, voxels, demand);
}

}  // namespace pkm::four_ppa_two_par
