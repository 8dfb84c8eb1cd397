#include "engine/accelerators/four_ppa_two_par/accelerators.hpp"

#include <stdexcept>

#include "engine/accelerators/four_ppa_two_par/clear_volume.hpp"
#include "engine/accelerators/four_ppa_two_par/voxels.hpp"
#include "engine/workspace/grid_evaluator.hpp"
#include "engine/workspace/with_gradients.hpp"

namespace pkm::four_ppa_two_par {
namespace {

constexpr int kY = 1;  ///< index of the coordinate y, which the workspace analyses fix or integrate over

/// The y of the plane on which a plan fixes the platform [m]; by default, the middle of the range of y.
template <class S>
S plane(const Geometry<S>& g, const FixedCoordinate& y) {
  return y.kind == FixedCoordinate::Kind::value ? S(y.value) : S(g.L0 * 0.5);
}

bool integrates_y(const WorkspacePlan& plan) { return how_fixed(plan, kY).kind == FixedCoordinate::Kind::integrated; }

template <class S>
SampleContents<S> contents(std::span<const S> parameters, const FieldRequest& request) {
  const auto& length = request.characteristic_length;  // the default characteristic length is a/2
  SampleContents<S> c{.conditioning = request.has(kConditioning),
                      .poses = request.poses,
                      .inertia = request.needs_inertia(),
                      .gamma = length ? S(geometry(parameters).a / (2 * *length)) : S(1.0),
                      .masses = {}};
  if (c.inertia) {
    c.masses = masses(parameters);
    std::ranges::copy(request.rotors, c.masses.rotors.begin());
  }
  return c;
}

class ClosedFormColumns final : public WithGradients<ClosedFormColumns> {
 public:
  ClosedFormColumns(const WorkspacePlan& plan, const ColumnOptions& columns, const FieldRequest& request)
      : limits_(plan.limits),
        y_(how_fixed(plan, kY)),
        columns_(columns),
        request_(request),
        inner_rule_(gauss_legendre(columns.nodes[0] > 0 ? columns.nodes[0] : kSampleNodes)),
        theta_rule_(gauss_legendre(columns.nodes[1] > 0 ? columns.nodes[1] : kSampleNodes)) {}

  const GradientEvaluator* gradients() const override { return limits_.given[kClearanceMin] ? nullptr : this; }
  std::string why_no_derivatives() const override {
    return "the study limits the clearance of links (clearance_min), so that ends of columns have no closed form and "
           "the "
           "analysis has no derivatives; use an optimiser without gradients, or keep the sliders apart by h_min";
  }

 private:
  friend WithGradients<ClosedFormColumns>;
  static constexpr int kSampleNodes = 12, kInertiaNodesOverY = 8;

  template <class S>
  void run(std::span<const S> parameters, Scratch& memory, WorkspaceResult<S>& workspace) const {
    workspace.clear(request_.fields);
    ColumnScratch<S>& scratch = memory.get<ColumnScratch<S>>();
    const Geometry<S> g = geometry(parameters);
    Limits<S> l = limits(g, limits_);
    std::optional<ClearanceTest> clearance;
    if constexpr (std::is_same_v<S, double>) clearance = reduce_clearance(g, l);
    const ClearanceTest* const test = clearance ? &*clearance : nullptr;
    const S y = plane(g, y_);
    const SlicedDesign<S> d = sliced_design(g, l, y);
    const bool over_y = y_.kind == FixedCoordinate::Kind::integrated;
    set_volume(volume_of(d, test, over_y, scratch), workspace);
    if (!request_.needs_samples()) return;
    const SampleContents<S> wanted = contents(parameters, request_);
    if (!over_y) {
      sample(d, wanted, value_of(y) > value_of(S(g.L0 - y)) ? Planes::far : Planes::near, S(1.0), theta_rule_,
             inner_rule_, test, scratch, workspace);
      return;
    }
    const Subinterval<S> half{l.h_min, g.L0 * 0.5, true, false};
    if (!(value_of(half.upper) > value_of(half.lower))) return;
    // If y is integrated over, every node represents eight poses. If each of these is a separate sample, a coarser
    // quadrature rule is sufficient.
    static const GaussRule coarse = gauss_legendre(kInertiaNodesOverY);
    const GaussRule &inner = wanted.distinguishes_images() ? coarse : inner_rule_,
                    &outer = wanted.distinguishes_images() ? coarse : theta_rule_;
    visit_nodes(half, inner, [&](const S& at, const S& jacobian, double weight) {
      sample(sliced_design(g, l, at), wanted, Planes::both, S(jacobian * weight), outer, inner, test, scratch,
             workspace);
    });
  }

  template <class S>
  Integral<S> volume_of(const SlicedDesign<S>& d, const ClearanceTest* test, bool over_y,
                        ColumnScratch<S>& scratch) const {
    if constexpr (std::is_same_v<S, double>) {
      if (test)
        return columns_.nodes[1] > 0 ? clear_volume_by_rule(d, *test, over_y, theta_rule_, inner_rule_, scratch)
                                     : clear_volume(d, *test, over_y, columns_.tolerance, scratch);
    }
    return over_y                  ? volume_over_y(d.g, d.l, columns_.tolerance, scratch)
           : columns_.nodes[1] > 0 ? fixed_rule(d, scratch)
                                   : plane_volume(d, columns_.tolerance, scratch);
  }

  /// The volume by a fixed number of quadrature nodes per interval of theta, without an error estimate.
  template <class S>
  Integral<S> fixed_rule(const SlicedDesign<S>& d, ColumnScratch<S>& scratch) const {
    find_theta_intervals(d, scratch.critical_values, scratch.intervals);
    Integral<S> result;
    visit_nodes(scratch.intervals, theta_rule_, [&](const S& theta, const S& jacobian, double weight) {
      const auto [s, c] = sincos(theta);
      result.value += (2 * weight) * jacobian * area(d, slice(d, s, c));
      ++result.evaluations;
    });
    return result;
  }

  LimitSpec limits_;
  FixedCoordinate y_;
  ColumnOptions columns_;
  FieldRequest request_;
  GaussRule inner_rule_, theta_rule_;
};

class ClosedFormVoxels final : public GridEvaluator<ClosedFormVoxels> {
 public:
  ClosedFormVoxels(const WorkspacePlan& plan, const VoxelOptions& voxels, const FieldRequest& request)
      : GridEvaluator(request),
        limits_(plan.limits),
        y_(how_fixed(plan, kY)),
        voxels_(voxels),
        request_(request),
        counter_(voxels.cells, voxels.box ? (*voxels.box)[2] : kTheta) {}

 private:
  friend GridEvaluator;
  static constexpr std::array<double, 2> kTheta = {-kPi / 2, kPi / 2};
  using Buffers = GridBuffers<std::vector<FixedCells>, VoxelWorker>;

  struct GriddedPlanes : GriddedDesign {
    Geometry<double> g;
    Limits<double> l;
    std::optional<ClearanceTest> test;
    const std::vector<FixedCells>& all_y;  ///< the cells along y, if the volume is integrated over y; otherwise empty
    double y;                              ///< value of y, if y is fixed
    SampleContents<double> wanted;

    VoxelPlane operator[](std::size_t number) const {
      return {.g = g,
              .l = l,
              .test = test ? &*test : nullptr,
              .y = all_y.empty() ? y : all_y[0].centre(static_cast<std::int64_t>(number)),
              .grid = grid};
    }
  };

  GriddedPlanes start(std::span<const double> parameters, Buffers& buffers) const {
    const Geometry<double> g = geometry(parameters);
    Limits<double> l = limits(g, limits_);
    auto test = reduce_clearance(g, l);
    const VoxelGrid grid(voxels_.cells, voxels_.box ? *voxels_.box : default_box(g));
    buffers.shared.clear();
    if (y_.kind == FixedCoordinate::Kind::integrated)
      buffers.shared.push_back({kY, 0, g.L0 / static_cast<double>(y_.cells), y_.cells});
    GriddedPlanes planes{{grid, 0, buffers.shared},
                         g,
                         l,
                         std::move(test),
                         buffers.shared,
                         plane(g, y_),
                         request_.needs_samples() ? contents(parameters, request_) : SampleContents<double>{}};
    const GridPart largest = planes.grids == 1 ? representative_part(planes, planes[0]) : counter_.whole();
    planes.blocks = counts(planes) ? counter_.tiles(largest) : counter_.blocks(largest);
    return planes;
  }
  /// True if it is sufficient to count feasible cells, because no samples are needed and there is no clearance test.
  bool counts(const GriddedPlanes& planes) const { return !planes.test && !request_.needs_samples(); }
  /// The part of the grid on a plane that has to be searched. If samples of a pose also represent its mirror images,
  /// which have the same conditioning, it is a part from which symmetry gives all cells; otherwise, it is the whole
  /// grid.
  GridPart representative_part(const GriddedPlanes& planes, const VoxelPlane& at) const {
    return planes.test || planes.wanted.distinguishes_images() ? counter_.whole() : counter_.representative_part(at);
  }

  void find(const GriddedPlanes& planes, std::size_t number, std::size_t block, VoxelWorker& own,
            WorkspaceResult<double>& to) const {
    const VoxelPlane at = planes[number];
    const GridPart part = representative_part(planes, at);
    if (counts(planes)) return counter_.count(at, part, block, to);
    const SampleTarget<double> samples(to);
    counter_.visit_block(at, block, part, own.columns, [&](const CellRun& run) {
      const int images = part.images(run.first[0], run.first[2]);
      count_cells(at.grid, run, to, images);
      if (request_.needs_samples()) sample(at, planes.wanted, run, planes.cell_volume * images, own, samples);
    });
  }
  template <class Visit>
  void visit_cells(const GriddedPlanes& planes, Buffers& buffers, const Visit& visit) const {
    for (std::size_t block = 0; block < counter_.blocks(counter_.whole()); ++block)
      counter_.visit_block(planes[0], block, counter_.whole(), buffers.per_worker[0].columns,
                           [&](const CellRun& run) { for_each_cell(run, visit); });
  }

  void sample(const VoxelPlane& at, const SampleContents<double>& wanted, const CellRun& run, double weight,
              VoxelWorker& own, const SampleTarget<double>& to) const {
    const Geometry<double>& g = at.g;
    const VoxelGrid& grid = at.grid;
    const auto& [i, first, k] = run.first;
    const double s = counter_.sin_theta(k), c = counter_.cos_theta(k), x = grid.centre(0, i);
    const std::array<double, 2> x_j = {x - g.a * c / 2, g.b - x - g.a * c / 2};
    const std::array<double, 2> sigma = {sqrt_or_zero((g.l_d - x_j[0]) * (g.l_d + x_j[0])),
                                         sqrt_or_zero((g.l_d - x_j[1]) * (g.l_d + x_j[1]))};
    ColumnConditioning<double>& poses = own.poses;
    poses.clear();
    for (std::int64_t j = first; j < run.end; ++j) {
      const double z = grid.centre(1, j) + g.d;
      poses.add(z + sigma[0], z + sigma[1]);
    }
    if (wanted.conditioning) poses.compute({g.l_u, wanted.gamma, s, c, x_j, sigma});
    for (std::int64_t j = first; j < run.end; ++j) {
      const auto n = static_cast<std::size_t>(j - first);
      if (wanted.inertia)
        inertia_values(joint_inertia(g, wanted.masses, s, c, x_j, sigma, {poses.z_c[0][n], poses.z_c[1][n]}),
                       to.workspace, own.inertia);
      add_sample(wanted, weight, {x, at.y, grid.centre(1, j), grid.centre(2, k)},
                 wanted.conditioning ? poses.index[n] : 0, own.inertia, false, to);
    }
  }

  LimitSpec limits_;
  FixedCoordinate y_;
  VoxelOptions voxels_;
  FieldRequest request_;
  VoxelCounter counter_;
};

class Analyses final : public ColumnAccelerator, public VoxelAccelerator {
 public:
  bool serves(const WorkspacePlan& plan, const ColumnOptions& columns, const FieldRequest& request) const override {
    return serves(plan, request) && !columns.box && !(integrates_y(plan) && columns.nodes[0] > 0);
  }
  bool serves(const WorkspacePlan& plan, const VoxelOptions&, const FieldRequest& request) const override {
    return serves(plan, request);
  }
  std::unique_ptr<const WorkspaceEvaluator> prepare(const WorkspacePlan& plan, const ColumnOptions& columns,
                                                    const FieldRequest& request) const override {
    return std::make_unique<ClosedFormColumns>(plan, columns, request);
  }
  std::unique_ptr<const VoxelEvaluator> prepare(const WorkspacePlan& plan, const VoxelOptions& voxels,
                                                const FieldRequest& request) const override {
    if (integrates_y(plan) && how_fixed(plan, kY).cells < 1)
      throw std::invalid_argument("voxels integrated over y need a number of cells for y");
    return std::make_unique<ClosedFormVoxels>(plan, voxels, request);
  }

 private:
  static bool serves(const WorkspacePlan& plan, const FieldRequest& request) {
    // Samples also represent mirror images, in which the two sliders of a rail are exchanged; this requires that the
    // drives of the two sliders have equal rotor inertias.
    const std::vector<double>& rotors = request.rotors;
    const bool unequal = !rotors.empty() && (rotors[0] != rotors[1] || rotors[2] != rotors[3]);
    return sweeps(plan, {0, 2, 3}) && (request.mode.empty() || request.mode == "lower,lower") &&
           !(request.needs_inertia() && unequal) &&
           !(requires_clearance(plan, kClearanceMin) && !plan.limits.obstacles.empty());
  }
};

class Forward final : public ForwardKinematics {
 public:
  std::vector<AssemblyMode> assemblies(std::span<const double> parameters,
                                       const AxisVector<double>& joints) const override {
    return forward(geometry(parameters), joints);
  }
};

}  // namespace

Accelerators accelerators() {
  const auto analyses = std::make_shared<const Analyses>();
  return {.columns = analyses, .voxels = analyses, .forward = std::make_shared<const Forward>()};
}

}  // namespace pkm::four_ppa_two_par
