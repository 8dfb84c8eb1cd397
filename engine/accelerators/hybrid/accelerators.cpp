#include "engine/accelerators/hybrid/accelerators.hpp"

#include "engine/accelerators/hybrid/columns.hpp"
#include "engine/accelerators/hybrid/conditioning.hpp"
#include "engine/accelerators/hybrid/forward.hpp"
#include "engine/accelerators/hybrid/voxels.hpp"
#include "engine/workspace/grid_evaluator.hpp"
#include "engine/workspace/pose_quantities.hpp"
#include "engine/workspace/with_gradients.hpp"

namespace pkm::hybrid {
namespace {

constexpr int kY = 1;  ///< index of the coordinate y, which the workspace analyses fix or integrate over

struct AnalysisSettings {
  WorkingMode signs;
  int branch;  ///< required sign (+1 or -1) of the term N2 of the loop-closure equations (README.md)
  WorkspacePlan plan;
  FieldRequest request;
};

/// Factor by which a volume of (x, z, beta) is multiplied to include y: the stroke of the carriage [m] if y is
/// integrated over; otherwise 1, or 0 if y is outside the stroke.
template <class S>
S stroke_factor(const Limits<S>& l, const WorkspacePlan& plan) {
  const FixedCoordinate y = how_fixed(plan, kY);
  if (y.kind == FixedCoordinate::Kind::integrated) return l.s_max[1] - l.s_min[1];
  if (y.kind == FixedCoordinate::Kind::default_value) return S(1.0);
  return S(y.value >= value_of(l.s_min[1]) && y.value <= value_of(l.s_max[1]) ? 1.0 : 0.0);
}

/// Appends columns along x to the samples of a workspace analysis. The conditioning does not depend on x. Without
/// derivatives, the conditioning of all samples is computed at the end, in SIMD batches.
template <class S>
class ColumnSamples {
 public:
  /// @param poses  scratch memory
  ColumnSamples(const SlicedDesign<S>& d, const FieldRequest& request, PoseList& poses, WorkspaceResult<S>& workspace)
      : design_{.L1 = d.g.L1,
                .L2 = d.g.L2,
                .L3 = d.g.L3,
                .d = d.g.d,
                .e = d.g.e,
                .signs = {1.0 * d.signs[0], 1.0 * d.signs[1], 1.0 * d.signs[2]},
                .length = request.characteristic_length ? S(*request.characteristic_length) : d.g.e},
        poses_(poses),
        workspace_(workspace),
        index_(workspace.find(kConditioning)) {
    poses_.clear();
  }

  [[gnu::always_inline]] void add(const S& z, const S& beta, const S& weight) {
    if (!index_ || !(value_of(weight) > 0)) return;
    workspace_.weight.push_back(weight);
    if constexpr (std::is_same_v<S, double>) {
      if (beta != beta_) sincos_ = sincos(beta_ = beta);
      poses_.z.push_back(z);
      poses_.sine.push_back(sincos_.sin);
      poses_.cosine.push_back(sincos_.cos);
    } else {
      const auto [sine, cosine] = sincos(beta);
      index_->push_back(conditioning(design_, z, sine, cosine));
    }
  }

  /// Computes the conditioning of all samples in one batch, if derivatives are not requested; to be called after the
  /// last add().
  void finish() {
    if constexpr (std::is_same_v<S, double>) {
      if (!index_) return;
      const std::size_t count = poses_.size(), padded = (count + kLanes - 1) / kLanes * kLanes;
      const std::size_t before = index_->size();
      for (auto* list : {&poses_.z, &poses_.sine, &poses_.cosine}) list->resize(padded);
      index_->resize(before + padded);
      with_instruction_set([&]<InstructionSet set>() {
        conditioning_of_poses<set>(design_, poses_.z.data(), poses_.sine.data(), poses_.cosine.data(), padded,
                                   index_->data() + before);
      });
      index_->resize(before + count);
    }
  }

 private:
  ConditioningDesign<S> design_;
  PoseList& poses_;
  WorkspaceResult<S>& workspace_;
  std::vector<S>* index_;  ///< values of the conditioning; null if it is not requested
  double beta_ = 0;        ///< beta of the previous column
  SinCosOf<double> sincos_{0, 1};
};

template <class S>
SlicedDesign<S> sliced(const AnalysisSettings& settings, std::span<const S> parameters) {
  return sliced_design(geometry(parameters), limits(parameters, settings.plan.limits), settings.signs, settings.branch);
}

class ClosedFormColumns final : public WithGradients<ClosedFormColumns> {
 public:
  ClosedFormColumns(const AnalysisSettings& settings, const ColumnOptions& columns)
      : settings_(settings), columns_(columns) {}

 private:
  friend WithGradients<ClosedFormColumns>;
  static constexpr int kSampleNodes = 8;  // number of nodes per strip of z and per interval of beta

  template <class S>
  void run(std::span<const S> parameters, Scratch& memory, WorkspaceResult<S>& workspace) const {
    workspace.clear(settings_.request.fields);
    ColumnScratch<S>& scratch = memory.get<ColumnScratch<S>>();
    const SlicedDesign<S> d = sliced(settings_, parameters);
    const S stroke = stroke_factor(d.l, settings_.plan);
    if (!(value_of(stroke) > 0)) return;
    find_outer_intervals(d, sliced_constant<double>(parameters), sliced_constant<Dual<1>>(parameters), scratch);
    if (!has_fixed_rules_) {
      set_volume(volume(d, columns_.tolerance, scratch), workspace);
      workspace.volume *= stroke;
      if (!settings_.request.has(kConditioning)) return;
    }
    ColumnSamples<S> samples(d, settings_.request, scratch.poses, workspace);
    visit_nodes(scratch.intervals, beta_rule_, [&](const S& beta, const S& jacobian, double rule_weight) {
      const S outer = jacobian * rule_weight * stroke;
      visit_columns(d, beta, z_rule_, scratch, [&](const S& z, const S& length, const S& inner) {
        const S weight = outer * inner * length;
        samples.add(z, beta, weight);
        if (!has_fixed_rules_) return;
        workspace.volume += weight;
        ++workspace.columns;
      });
    });
    samples.finish();
  }

  /// Converts a design to another scalar type, with zero derivatives.
  template <class To, class From>
  SlicedDesign<To> sliced_constant(std::span<const From> parameters) const {
    return sliced(settings_, std::span<const To>(constants<To, kParameters>(parameters)));
  }

  AnalysisSettings settings_;
  ColumnOptions columns_;
  /// True: the plan gives the numbers of quadrature nodes; false: it gives a tolerance.
  bool has_fixed_rules_ = columns_.nodes[0] > 0;
  GaussRule z_rule_ = gauss_legendre(has_fixed_rules_ ? columns_.nodes[0] : kSampleNodes),
            beta_rule_ = gauss_legendre(has_fixed_rules_ ? columns_.nodes[1] : kSampleNodes);
};

class ClosedFormVoxels final : public GridEvaluator<ClosedFormVoxels> {
 public:
  ClosedFormVoxels(const AnalysisSettings& settings, const VoxelOptions& voxels)
      : GridEvaluator(settings.request), settings_(settings), voxels_(voxels) {}

 private:
  friend GridEvaluator;
  static constexpr std::int64_t kBetas = 8;  ///< number of beta values per block

  struct Worker {
    PoseList poses;
    CellRuns runs;  ///< runs of feasible cells at one beta
  };
  using Buffers = GridBuffers<VoxelHeights, Worker>;

  /// Calls visit(k) for the index k of each beta value of a block.
  template <class Visit>
  static void for_each_beta(const VoxelColumns& columns, std::size_t block, const Visit& visit) {
    const auto first = static_cast<std::int64_t>(block) * kBetas;
    for (std::int64_t k = first; k < std::min(first + kBetas, columns.grid.cells[2]); ++k) visit(k);
  }

  VoxelColumns start(std::span<const double> parameters, Buffers& buffers) const {
    const SlicedDesign<double> design = sliced(settings_, parameters);
    const VoxelGrid grid(voxels_.cells, voxels_.box ? *voxels_.box : default_box(design));
    const double stroke = stroke_factor(design.l, settings_.plan);
    VoxelColumns columns{{grid, 0}, design, buffers.shared};
    if (!(stroke > 0)) return columns;
    buffers.shared.fill(design, grid);
    columns.blocks = static_cast<std::size_t>((grid.cells[2] + kBetas - 1) / kBetas);
    columns.cell_volume *= stroke;
    return columns;
  }

  void find(const VoxelColumns& columns, std::size_t, std::size_t block, Worker& worker,
            WorkspaceResult<double>& to) const {
    const bool only_counts = !settings_.request.has(kConditioning);
    const VoxelGrid& grid = columns.grid;
    ColumnSamples<double> samples(columns.design, settings_.request, worker.poses, to);
    for_each_beta(columns, block, [&](std::int64_t k) {
      if (only_counts) {
        to.feasible_cells += columns.count(k, worker.runs, to.touches_box);
        return;
      }
      columns.visit(k, worker.runs, [&](const CellRun& run) {
        count_cells(grid, run, to);
        samples.add(grid.centre(1, run.first[1]), grid.centre(2, k),
                    static_cast<double>(run.count()) * columns.cell_volume);
      });
    });
    samples.finish();
  }
  template <class Visit>
  void visit_cells(const VoxelColumns& columns, Buffers& buffers, const Visit& visit) const {
    for (std::size_t block = 0; block < columns.blocks; ++block)
      for_each_beta(columns, block, [&](std::int64_t k) {
        columns.visit(k, buffers.per_worker[0].runs, [&](const CellRun& run) { for_each_cell(run, visit); });
      });
  }

  AnalysisSettings settings_;
  VoxelOptions voxels_;
};

class Analyses final : public ColumnAccelerator, public VoxelAccelerator {
  bool serves(const WorkspacePlan& plan, const ColumnOptions& columns, const FieldRequest& request) const override {
    return serves(plan) && !columns.box && !request.poses;
  }
  bool serves(const WorkspacePlan& plan, const VoxelOptions&, const FieldRequest& request) const override {
    return serves(plan) && !request.poses;
  }
  static bool serves(const WorkspacePlan& plan) {
    return sweeps(plan, {0, 2, 3}) && !requires_clearance(plan, kClearanceMin);
  }
  std::unique_ptr<const WorkspaceEvaluator> prepare(const WorkspacePlan& plan, const ColumnOptions& columns,
                                                    const FieldRequest& request) const override {
    return std::make_unique<ClosedFormColumns>(settings(plan, request), columns);
  }
  std::unique_ptr<const VoxelEvaluator> prepare(const WorkspacePlan& plan, const VoxelOptions& voxels,
                                                const FieldRequest& request) const override {
    return std::make_unique<ClosedFormVoxels>(settings(plan, request), voxels);
  }
  /// Reads the working mode. Its name contains the signs of n1, n2, n3, followed by "/-" if N2 < 0 is required.
  /// Default: "+,-,-".
  static AnalysisSettings settings(const WorkspacePlan& plan, const FieldRequest& request) {
    const std::string mode = request.mode.empty() ? "+,-,-" : request.mode;
    const auto sign = [&](std::size_t i) { return mode[i] == '+' ? 1 : -1; };
    return {{sign(0), sign(2), sign(4)}, mode.ends_with("/-") ? -1 : 1, plan, request};
  }
};

class ClosedFormForward final : public ForwardKinematics {
  std::vector<AssemblyMode> assemblies(std::span<const double> p, const AxisVector<double>& s) const override {
    return forward(geometry(p), s).modes;
  }
  ForwardStatus status(std::span<const double> p, const AxisVector<double>& s,
                       const std::vector<AssemblyMode>&) const override {
    return forward(geometry(p), s).status;
  }
};

}  // namespace

Accelerators accelerators() {
  const auto analyses = std::make_shared<const Analyses>();
  return {.columns = analyses, .voxels = analyses, .forward = std::make_shared<const ClosedFormForward>()};
}

}  // namespace pkm::hybrid
