#include "engine/accelerators/hybrid/accelerators.hpp"

#include "engine/accelerators/hybrid/columns.hpp"
#include "engine/accelerators/hybrid/conditioning.hpp"
#include "engine/accelerators/hybrid/forward.hpp"
#include "engine/accelerators/hybrid/voxels.hpp"
#include "engine/geometry/conditioning.hpp"
#include "engine/workspace/grid_surveyor.hpp"
#include "engine/workspace/pose_quantities.hpp"
#include "engine/workspace/with_slopes.hpp"

namespace pkm::hybrid {
namespace {

constexpr int kY = 1;  ///< the coordinate that surveys hold

struct Planned {
  WorkingMode signs;
  int branch;  ///< required sign of N2, +1 or -1
  WorkspacePlan plan;
  Demand demand;
};

/// What the carriage's stroke makes of a volume of (x, z, beta): its length where y is integrated over [m], else 1, or
/// 0 beyond its ends.
template <class S>
S carriage(const Limits<S>& l, const FixedCoordinate& held) {
  if (held.kind == FixedCoordinate::Kind::integrated) return l.s_max[1] - l.s_min[1];
  if (held.kind == FixedCoordinate::Kind::middle) return S(1.0);
  return S(held.value >= value_of(l.s_min[1]) && held.value <= value_of(l.s_max[1]) ? 1.0 : 0.0);
}

/// The conditioning of columns along x, on which it does not depend. Without derivatives it is computed last, for
/// many of them side by side.
template <class S>
class Conditioning {
 public:
  /// @param poses   reused storage
  /// @param survey  to which columns are added
  Conditioning(const Frame<S>& f, const Demand& demand, PoseList& poses, Survey<S>& survey)
      : frame_(f),
        length_(demand.characteristic_length ? S(*demand.characteristic_length) : f.g.e),
        poses_(poses),
        survey_(survey),
        index_(survey.find(kConditioning)) {
    poses_.clear();
  }

  [[gnu::always_inline]] void add(const S& z, const S& beta, const S& weight) {
    if (!index_ || !(value_of(weight) > 0)) return;
    survey_.weight.push_back(weight);
    if constexpr (std::is_same_v<S, double>) {
      if (beta != beta_) sincos_ = sincos(beta_ = beta);
      poses_.z.push_back(z);
      poses_.sine.push_back(sincos_.sin);
      poses_.cosine.push_back(sincos_.cos);
    } else {
      const Joints<S> j = inverse(frame_.g, Pose<S>{S(0.0), S(0.0), z, beta}, frame_.signs);
      const bool regular = j.assembles() && !j.serial;
      index_->push_back(regular ? inverse_condition(homogeneous_jacobian(z, j, length_)) : S(0.0));
    }
  }

  /// Call it after the last one.
  void finish() {
    if constexpr (std::is_same_v<S, double>) {
      if (!index_) return;
      const std::size_t count = poses_.size(), whole = (count + kLanes - 1) / kLanes * kLanes;
      const std::size_t before = index_->size();
      for (auto* list : {&poses_.z, &poses_.sine, &poses_.cosine}) list->resize(whole);
      index_->resize(before + whole);
      const Geometry<double>& g = frame_.g;
      const ConditioningDesign design{.L1 = g.L1,
                                      .L2 = g.L2,
                                      .L3 = g.L3,
                                      .d = g.d,
                                      .e = g.e,
                                      .signs = {1.0 * frame_.signs[0], 1.0 * frame_.signs[1], 1.0 * frame_.signs[2]},
                                      .roundoff = kRoundoff,
                                      .length = length_};
      with_instruction_set([&]<InstructionSet set>() {
        inverse_conditions<set>(design, poses_.z.data(), poses_.sine.data(), poses_.cosine.data(), whole,
                                index_->data() + before);
      });
      index_->resize(before + count);
    }
  }

 private:
  const Frame<S>& frame_;
  S length_;
  PoseList& poses_;
  Survey<S>& survey_;
  std::vector<S>* index_;  ///< null: not demanded
  double beta_ = 0;        ///< the last one
  SinCosOf<double> sincos_{0, 1};
};

template <class S>
Frame<S> frame_of(const Planned& planned, std::span<const S> parameters) {
  return frame(geometry(parameters), limits(parameters, planned.plan.limits), planned.signs, planned.branch);
}

class ColumnEvaluator final : public WithGradients<ColumnEvaluator> {
 public:
  ColumnEvaluator(const Planned& planned, const ColumnOptions& columns) : planned_(planned), columns_(columns) {}

 private:
  friend WithGradients<ColumnEvaluator>;
  static constexpr int kSampleNodes = 8;  // per strip of z and piece of beta

  template <class S>
  void run(std::span<const S> parameters, Scratch& room, Survey<S>& survey) const {
    survey.clear(planned_.demand.fields);
    ColumnScratch<S>& scratch = room.get<ColumnScratch<S>>();
    const Frame<S> f = frame_of(planned_, parameters);
    const S stroke = carriage(f.l, how_fixed(planned_.plan, kY));
    if (!(value_of(stroke) > 0)) return;
    find_outer_pieces(f, still<double>(parameters), still<Dual<1>>(parameters), scratch);
    if (!fixed_) {
      take_volume(volume(f, columns_.tolerance, scratch), survey);
      survey.volume *= stroke;
      if (!planned_.demand.has(kConditioning)) return;
    }
    Conditioning<S> conditioning(f, planned_.demand, scratch.poses, survey);
    visit_nodes(scratch.pieces, beta_rule_, [&](const S& beta, const S& jacobian, double rule_weight) {
      const S outer = jacobian * rule_weight * stroke;
      visit_columns(f, beta, z_rule_, scratch, [&](const S& z, const S& length, const S& inner) {
        const S weight = outer * inner * length;
        conditioning.add(z, beta, weight);
        if (!fixed_) return;
        survey.volume += weight;
        ++survey.columns;
      });
    });
    conditioning.finish();
  }

  /// The design as constants of another scalar.
  template <class To, class From>
  Frame<To> still(std::span<const From> parameters) const {
    return frame_of(planned_, std::span<const To>(constants<To, kParameters>(parameters)));
  }

  Planned planned_;
  ColumnOptions columns_;
  bool fixed_ = columns_.nodes[0] > 0;  ///< numbers of nodes are given
  GaussRule z_rule_ = gauss_legendre(fixed_ ? columns_.nodes[0] : kSampleNodes),
            beta_rule_ = gauss_legendre(fixed_ ? columns_.nodes[1] : kSampleNodes);
};

class OfVoxels final : public GridEvaluator<OfVoxels> {
 public:
  OfVoxels(const Planned& planned, const VoxelOptions& voxels)
      : GridEvaluator(planned.demand), planned_(planned), voxels_(voxels) {}

 private:
  friend GridEvaluator;
  static constexpr std::int64_t kBetas = 8;  ///< of a piece

  struct Worker {
    PoseList poses;  ///< whose conditioning is asked for
    CellRuns runs;   ///< at one beta
  };
  using Rooms = GridRooms<VoxelHeights, Worker>;

  struct GriddedColumns : Gridded {
    Frame<double> frame;
    const VoxelHeights& heights;

    VoxelColumns columns() const { return {frame, grid, heights}; }
    /// Calls visit(k) for the beta of a piece.
    template <class Visit>
    void for_each_beta(std::size_t piece, const Visit& visit) const {
      const auto first = static_cast<std::int64_t>(piece) * kBetas;
      for (std::int64_t k = first; k < std::min(first + kBetas, grid.cells[2]); ++k) visit(k);
    }
  };

  GriddedColumns start(std::span<const double> parameters, Rooms& rooms) const {
    const Frame<double> f = frame_of(planned_, parameters);
    const VoxelGrid grid(voxels_.cells, voxels_.box ? *voxels_.box : default_box(f));
    const double stroke = carriage(f.l, how_fixed(planned_.plan, kY));
    GriddedColumns columns{{grid, 0}, f, rooms.common};
    if (!(stroke > 0)) return columns;
    rooms.common.fill(f, grid);
    columns.pieces = static_cast<std::size_t>((grid.cells[2] + kBetas - 1) / kBetas);
    columns.cell_volume *= stroke;
    return columns;
  }

  void find(const GriddedColumns& d, std::size_t, std::size_t piece, Worker& worker, Survey<double>& to) const {
    const VoxelColumns columns = d.columns();
    const bool counts = !planned_.demand.has(kConditioning);
    Conditioning<double> conditioning(d.frame, planned_.demand, worker.poses, to);
    d.for_each_beta(piece, [&](std::int64_t k) {
      if (counts) {
        to.feasible_cells += columns.count(k, worker.runs, to.touches_box);
        return;
      }
      columns.visit(k, worker.runs, [&](const CellRun& run) {
        count_cells(d.grid, run, to);
        conditioning.add(d.grid.centre(1, run.first[1]), d.grid.centre(2, k),
                         static_cast<double>(run.count()) * d.cell_volume);
      });
    });
    conditioning.finish();
  }
  template <class Visit>
  void visit_cells(const GriddedColumns& d, Rooms& rooms, const Visit& visit) const {
    for (std::size_t piece = 0; piece < d.pieces; ++piece)
      d.for_each_beta(piece, [&](std::int64_t k) {
        d.columns().visit(k, rooms.of[0].runs, [&](const CellRun& run) { for_each_cell(run, visit); });
      });
  }

  Planned planned_;
  VoxelOptions voxels_;
};

/// Signs of n1, n2, n3, and the required one of N2: "+,-,-", or "+,-,-/-" where N2 < 0 is required; "": the first.
Planned planned(const WorkspacePlan& plan, const Demand& demand) {
  const std::string name = demand.mode.empty() ? "+,-,-" : demand.mode;
  const auto sign = [&](std::size_t i) { return name[i] == '+' ? 1 : -1; };
  return {{sign(0), sign(2), sign(4)}, name.ends_with("/-") ? -1 : 1, plan, demand};
}

class Analyses final : public ColumnAccelerator, public VoxelAccelerator {
  bool serves(const WorkspacePlan& plan, const ColumnOptions& columns, const Demand&) const override {
    return serves(plan) && !columns.box;
  }
  bool serves(const WorkspacePlan& plan, const VoxelOptions&, const Demand&) const override { return serves(plan); }
  static bool serves(const WorkspacePlan& plan) {
    return sweeps(plan, {0, 2, 3}) && !asks_clearance(plan, kClearanceMin);
  }
  std::unique_ptr<const WorkspaceEvaluator> prepare(const WorkspacePlan& plan, const ColumnOptions& columns,
                                                    const Demand& demand) const override {
    return std::make_unique<ColumnEvaluator>(planned(plan, demand), columns);
  }
  std::unique_ptr<const VoxelEvaluator> prepare(const WorkspacePlan& plan, const VoxelOptions& voxels,
                                                const Demand& demand) const override {
    return std::make_unique<OfVoxels>(planned(plan, demand), voxels);
  }
};

std::string sign_name(int sign) { return sign > 0 ? "+" : sign < 0 ? "-" : "0"; }

class ForwardInClosedForm final : public ForwardKinematics {
  std::vector<AssemblyMode> assemblies(std::span<const double> p, const AxisVector<double>& s) const override {
    std::vector<AssemblyMode> modes;
    for (const Assembly& found : forward(geometry(p), s).assemblies) {
      AssemblyMode mode{found.pose, sign_name(found.sign_z) + "," + sign_name(found.sign_N2)};
      mode.working_mode = sign_name(found.mode[0]) + "," + sign_name(found.mode[1]) + "," + sign_name(found.mode[2]);
      if (found.double_z) mode.double_roots.push_back("z");
      if (found.double_beta) mode.double_roots.push_back("beta");
      modes.push_back(std::move(mode));
    }
    return modes;
  }
  ForwardStatus status(std::span<const double> p, const AxisVector<double>& s,
                       const std::vector<AssemblyMode>&) const override {
    static const std::array<ForwardStatus, 5> meanings = {
        {{},
         {"NO_XZ", "the carriages A and B are too far apart, or as far apart as links of different lengths can't be"},
         {"DEGENERATE_XZ", "A'' and B'' are as far apart as A' and B', so that the parallelogram moves freely"},
         {"NO_BETA", "link C does not reach the platform's joint C' for any beta"},
         {"DEGENERATE_BETA", "C' turns about the foot of link C, so that every beta assembles"}}};
    return meanings[static_cast<std::size_t>(forward(geometry(p), s).status)];
  }
};

}  // namespace

Accelerators accelerators() {
  const auto analyses = std::make_shared<const Analyses>();
  return {.columns = analyses, .voxels = analyses, .forward = std::make_shared<const ForwardInClosedForm>()};
}

}  // namespace pkm::hybrid
