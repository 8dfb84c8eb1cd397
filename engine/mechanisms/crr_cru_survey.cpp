#include "engine/mechanisms/crr_cru_survey.hpp"

#include "engine/mechanisms/crr_cru_columns.hpp"
#include "engine/mechanisms/crr_cru_voxels.hpp"

namespace pkm::crr_cru {
namespace {

Held held_of(int coordinate, const SurveyPlan& plan) {
  return {static_cast<std::size_t>(coordinate), plan.held.kind == HeldCoordinate::Kind::middle, plan.held.value};
}

/// Conditioning depends on phi alone: one sample stands for all positions at one phi.
template <class S>
void add_conditioning(const Geometry<S>& g, const Demand& demand, const S& phi, const S& weight, Survey<S>& survey) {
  if (!(value_of(weight) > 0)) return;
  const auto [s, c] = sincos(phi);
  const S length = demand.characteristic_length ? S(*demand.characteristic_length) : characteristic_length(g);
  survey.weight.push_back(weight);
  survey.conditioning.push_back(conditioning(arms(g, s, c), length));
}

class ColumnSurveyor final : public Surveyor {
 public:
  ColumnSurveyor(Platform platform, int held, const SurveyPlan& plan, const Demand& demand)
      : platform_(platform),
        held_(held_of(held, plan)),
        limits_(limits(plan.limits)),
        tolerance_(plan.tolerance),
        fixed_(plan.nodes[0] > 0),
        demand_(demand) {
    // Nodes come in the order of the swept coordinates; phi is the last of them.
    const std::size_t outer = cuts(held_).outer_is_phi ? 1 : 0;
    outer_rule_ = gauss_legendre(fixed_ ? plan.nodes[outer] : kSampleNodes);
    if (fixed_) inner_rule_ = gauss_legendre(plan.nodes[1 - outer]);
  }

  void survey(std::span<const double> parameters, Survey<double>& survey) const override { run(parameters, survey); }
  void survey(std::span<const Dual4> parameters, Survey<Dual4>& survey) const override { run(parameters, survey); }
  std::string no_derivatives() const override { return {}; }

 private:
  static constexpr int kSampleNodes = 32;

  template <class S>
  void run(std::span<const S> parameters, Survey<S>& survey) const {
    thread_local ColumnScratch<S> scratch;
    survey.clear();
    const auto s = sweeping(design(geometry(platform_, parameters), limits_), held_);
    find_outer_pieces(s, still<double>(parameters), still<Dual<1>>(parameters), scratch);
    long columns = 0;
    if (!fixed_) {
      const Integral<S> volume =
          integrate<S>([&](const S& outer) { return area_at(s, outer, scratch); }, scratch.pieces, tolerance_,
                       roundoff(s, scratch.pieces), scratch.integrals);
      survey.volume = volume.value;
      survey.error = value_of(volume.value) > 0 ? volume.error / value_of(volume.value) : 0;
      columns = volume.evaluations;
    }
    const Geometry<S>& g = s.design.g;
    if (fixed_ || (demand_.conditioning && s.cuts.outer_is_phi))
      for (const Piece<S>& piece : scratch.pieces)
        for (std::size_t i = 0; i < outer_rule_.node.size(); ++i) {
          const auto [outer, jacobian] = map_node(piece, outer_rule_.node[i]);
          const S area = fixed_ ? area_of_columns(s, outer, inner_rule_, scratch, columns) : area_at(s, outer, scratch);
          const S weight = area * jacobian * outer_rule_.weight[i];
          if (fixed_) survey.volume += weight;
          if (demand_.conditioning && s.cuts.outer_is_phi) add_conditioning(g, demand_, outer, weight, survey);
        }
    if (demand_.conditioning && !s.cuts.outer_is_phi) add_conditioning(g, demand_, s.held, survey.volume, survey);
    survey.columns = columns;
  }

  /// The design as constants of another scalar.
  template <class To, class From>
  Sweeping<To> still(std::span<const From> parameters) const {
    std::array<To, kParameters> values;
    for (std::size_t i = 0; i < values.size(); ++i) values[i] = To(value_of(parameters[i]));
    return sweeping(design(geometry(platform_, std::span<const To>(values)), limits_), held_);
  }

  Platform platform_;
  Held held_;
  Limits limits_;
  double tolerance_;
  bool fixed_;  ///< numbers of nodes are given
  Demand demand_;
  GaussRule outer_rule_, inner_rule_;
};

class VoxelSurveyor final : public Surveyor {
 public:
  VoxelSurveyor(Platform platform, int held, const SurveyPlan& plan, const Demand& demand)
      : platform_(platform), held_(held_of(held, plan)), plan_(plan), limits_(limits(plan.limits)), demand_(demand) {}

  std::string no_derivatives() const override {
    return "the study surveys voxels, whose sums have no derivatives; take workspace.method = \"columns\"";
  }

  void survey(std::span<const double> parameters, Survey<double>& survey) const override {
    survey.clear();
    const Design<double> d = design(geometry(platform_, parameters), limits_);
    const VoxelGrid grid = grid_of(d);
    const GridAxes axes = grid_axes(held_);
    const bool over_phi = cuts(held_).outer_is_phi;
    survey.cells = grid.count();
    survey.cell_volume = grid.cell_volume();
    std::int64_t plane = -1, in_plane = 0;
    const auto close_plane = [&] {
      survey.feasible_cells += in_plane;
      if (demand_.conditioning && over_phi && in_plane > 0)
        add_conditioning(d.g, demand_, grid.centre(axes.outer, plane),
                         static_cast<double>(in_plane) * survey.cell_volume, survey);
      in_plane = 0;
    };
    const std::int64_t last = grid.cells[axes.v] - 1;
    rows().visit_columns(d, held_, grid, [&](std::int64_t outer, std::int64_t u, const auto& row) {
      if (outer != plane) close_plane();
      plane = outer;
      for (const std::uint64_t word : row) in_plane += std::popcount(word);
      survey.touches_box = survey.touches_box || outer == 0 || outer == grid.cells[axes.outer] - 1 || u == 0 ||
                           u == grid.cells[axes.u] - 1 || (row.front() & 1) ||
                           (row.back() >> static_cast<std::size_t>(last % 64) & 1);
    });
    close_plane();
    survey.volume = static_cast<double>(survey.feasible_cells) * survey.cell_volume;
    if (demand_.conditioning && !over_phi)
      add_conditioning(d.g, demand_, held_value(d.g, held_), survey.volume, survey);
  }

  VoxelMap map(std::span<const double> parameters) const {
    const Design<double> d = design(geometry(platform_, parameters), limits_);
    const VoxelGrid grid = grid_of(d);
    const GridAxes axes = grid_axes(held_);
    VoxelMap m = grid.map();
    std::array<std::int64_t, 3> cell{};
    rows().visit_columns(d, held_, grid, [&](std::int64_t outer, std::int64_t u, const auto& row) {
      cell[axes.outer] = outer;
      cell[axes.u] = u;
      for (std::int64_t v = 0; v < grid.cells[axes.v]; ++v) {
        if (!(row[static_cast<std::size_t>(v / 64)] >> static_cast<std::size_t>(v % 64) & 1)) continue;
        cell[axes.v] = v;
        m.feasible[static_cast<std::size_t>((cell[0] * grid.cells[1] + cell[1]) * grid.cells[2] + cell[2])] = 1;
      }
    });
    return m;
  }

 private:
  VoxelGrid grid_of(const Design<double>& d) const {
    return {plan_.cells, plan_.box ? *plan_.box : default_box(d, held_)};
  }
  static VoxelRows& rows() {
    thread_local VoxelRows storage;
    return storage;
  }

  Platform platform_;
  Held held_;
  SurveyPlan plan_;
  Limits limits_;
  Demand demand_;
};

}  // namespace

std::unique_ptr<const Surveyor> make_surveyor(Platform platform, int held, const SurveyPlan& plan,
                                              const Demand& demand) {
  if (plan.method == Method::columns) return std::make_unique<ColumnSurveyor>(platform, held, plan, demand);
  return std::make_unique<VoxelSurveyor>(platform, held, plan, demand);
}

VoxelMap voxel_map(Platform platform, int held, std::span<const double> parameters, const SurveyPlan& plan) {
  return VoxelSurveyor(platform, held, plan, {}).map(parameters);
}

}  // namespace pkm::crr_cru
