#include "engine/mechanisms/hybrid/survey.hpp"

#include <stdexcept>

#include "engine/mechanisms/hybrid/columns.hpp"
#include "engine/mechanisms/hybrid/conditioning.hpp"
#include "engine/mechanisms/hybrid/influence.hpp"
#include "engine/mechanisms/hybrid/voxels.hpp"
#include "engine/survey/grid_surveyor.hpp"
#include "engine/survey/pose_quantities.hpp"
#include "engine/survey/with_slopes.hpp"

namespace pkm::hybrid {
namespace {

constexpr int kY = 1;  ///< the coordinate that surveys hold

/// What the carriage's stroke makes of a volume of (x, z, beta): its length where y is integrated over [m], else 1, or
/// 0 beyond its ends.
template <class S>
S carriage(const Limits<S>& l, const HeldCoordinate& held) {
  if (held.kind == HeldCoordinate::Kind::integrated) return l.s_max[1] - l.s_min[1];
  if (held.kind == HeldCoordinate::Kind::middle) return S(1.0);
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

class ColumnSurveyor final : public WithSlopes<ColumnSurveyor> {
 public:
  ColumnSurveyor(const Planned& planned, const ColumnOptions& columns) : planned_(planned), columns_(columns) {}

 private:
  friend WithSlopes<ColumnSurveyor>;
  static constexpr int kSampleNodes = 8;  // per strip of z and piece of beta

  template <class S>
  void run(std::span<const S> parameters, Scratch& room, Survey<S>& survey) const {
    survey.clear(planned_.demand.fields);
    ColumnScratch<S>& scratch = room.get<ColumnScratch<S>>();
    const Frame<S> f = frame_of(planned_, parameters);
    const S stroke = carriage(f.l, how_held(planned_.plan, kY));
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

class OfVoxels final : public GridSurveyor<OfVoxels> {
 public:
  OfVoxels(const Planned& planned, const VoxelOptions& voxels)
      : GridSurveyor(planned.demand), planned_(planned), voxels_(voxels) {}

 private:
  friend GridSurveyor;
  static constexpr std::int64_t kBetas = 8;  ///< of a piece

  struct Worker {
    PoseList poses;  ///< whose conditioning is asked for
    CellRuns runs;   ///< at one beta
  };
  using Rooms = GridRooms<VoxelHeights, Worker>;

  struct GriddedColumns : Gridded {
    VoxelDesign design;
    const VoxelHeights& heights;

    VoxelColumns columns() const { return {design, grid, heights}; }
    /// Calls visit(k) for the beta of a piece.
    template <class Visit>
    void for_each_beta(std::size_t piece, const Visit& visit) const {
      const auto first = static_cast<std::int64_t>(piece) * kBetas;
      for (std::int64_t k = first; k < std::min(first + kBetas, grid.cells[2]); ++k) visit(k);
    }
  };

  GriddedColumns start(std::span<const double> parameters, Rooms& rooms) const {
    const VoxelDesign d{frame_of(planned_, parameters), asks_clearance(planned_.plan, kClearanceMin)};
    const VoxelGrid grid(voxels_.cells, voxels_.box ? *voxels_.box : default_box(d));
    const double stroke = carriage(d.frame.l, how_held(planned_.plan, kY));
    GriddedColumns columns{{grid, 0}, d, rooms.common};
    if (!(stroke > 0)) return columns;
    rooms.common.fill(d.frame, grid);
    columns.pieces = static_cast<std::size_t>((grid.cells[2] + kBetas - 1) / kBetas);
    columns.cell_volume *= stroke;
    return columns;
  }

  void find(const GriddedColumns& d, std::size_t, std::size_t piece, Worker& worker, Survey<double>& to) const {
    const VoxelColumns columns = d.columns();
    const bool counts = !d.design.with_links && !planned_.demand.has(kConditioning);
    Conditioning<double> conditioning(d.design.frame, planned_.demand, worker.poses, to);
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

}  // namespace

std::unique_ptr<const Surveyor> make_surveyor(const Planned& planned, const ColumnOptions& columns) {
  if (asks_clearance(planned.plan, kClearanceMin))
    throw std::invalid_argument(
        "mechanism 2t1r-p-hybrid has no column surveys under a clearance (clearance_min), because links that meet end "
        "columns where no formula says; take voxels, or require the clearance of a task-workspace");
  return std::make_unique<ColumnSurveyor>(planned, columns);
}

std::unique_ptr<const VoxelSurveyor> make_surveyor(const Planned& planned, const VoxelOptions& voxels) {
  return std::make_unique<OfVoxels>(planned, voxels);
}

}  // namespace pkm::hybrid
