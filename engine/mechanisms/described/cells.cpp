#include "engine/mechanisms/described/cells.hpp"

#include <algorithm>
#include <bit>
#include <numeric>

#include "engine/math/lanes.hpp"
#include "engine/mechanisms/described/conditions.hpp"

namespace pkm::described {
namespace {

using graph::kRow, graph::Program, graph::RowStage;

constexpr std::size_t kOuter = 1, kMiddle = 2, kInner = 3;  // stages; 0: the design and what is held

/// Centres of cells [first, first + count), and of some beyond, up to whole lanes.
std::size_t fill_centres(const VoxelGrid& grid, std::size_t axis, std::size_t first, std::size_t count, double* to) {
  const std::size_t whole = (count + kLanes - 1) / kLanes * kLanes;
  for (std::size_t k = 0; k < whole; ++k) to[k] = grid.centre(axis, static_cast<std::int64_t>(first + k));
  return whole;
}

/// Bits [from, to) of a word.
std::uint64_t range_of_bits(double from, double to, std::size_t word) {
  const double first = static_cast<double>(word * 64);
  const auto below = [&](double end) {  // bits before it
    const double bits = std::clamp(end - first, 0.0, 64.0);
    return bits >= 64 ? ~std::uint64_t{0} : (std::uint64_t{1} << static_cast<unsigned>(bits)) - 1;
  };
  return below(to) & ~below(from);
}

Shape shape_of(const graph::Graph& graph, Node leading) {
  const graph::Entry& entry = graph[leading];
  if (!entry.is_number()) return Shape::any;
  return entry.number < 0 ? Shape::concave : entry.number > 0 ? Shape::convex : Shape::line;
}

/// Leaves out clauses that others imply, makes one of those that differ in their constants alone, and moves those that
/// do not depend on z to `plain`.
void simplify(graph::Graph& graph, std::vector<graph::Clause>& clauses, std::vector<Node>& plain) {
  const Node zero = graph.number(0);
  std::vector<graph::Polynomial> single;
  for (const graph::Clause& clause : clauses)
    if (clause.size() == 1) single.push_back(clause.front());
  std::erase_if(clauses, [&](const graph::Clause& clause) {
    return clause.size() == 1 || std::ranges::any_of(clause, [&](const graph::Polynomial& q) {
             return std::ranges::find(single, q) != single.end();
           });
  });
  std::ranges::sort(clauses);
  clauses.erase(std::unique(clauses.begin(), clauses.end()), clauses.end());
  std::ranges::sort(single, {}, [](const graph::Polynomial& q) { return std::pair(q.c[1], q.c[2]); });
  for (std::size_t i = 0; i < single.size();) {
    graph::Polynomial all = single[i];
    for (++i; i < single.size() && single[i].c[1] == all.c[1] && single[i].c[2] == all.c[2]; ++i)
      if (single[i].c[0] != all.c[0])
        all.c[0] = graph.apply(graph::operation("min"), std::array{all.c[0], single[i].c[0]});
    if (all.c[1] == zero && all.c[2] == zero)
      plain.push_back(all.c[0]);
    else
      clauses.push_back({all});
  }
}

/// The surfaces of a crank's range along z; none: they are no quadratics, or not along z.
std::optional<std::array<graph::Polynomial, 4>> surfaces_of(graph::Graph& graph, const CoveredRange& crank, Groups z) {
  if ((graph[crank.reach].groups & z) == 0 || (graph[crank.half_turn].groups & ~Inputs::kDesign) != 0 ||
      !graph[crank.branch].is_number())
    return {};
  std::array<graph::Polynomial, 4> surfaces;
  for (std::size_t k = 0; const Node node : {crank.at_min, crank.at_max, crank.after_min, crank.before_max}) {
    const auto found = lowered(graph, node, z);
    if (!found || found->size() != 1 || found->front().size() != 1) return {};
    surfaces[k++] = found->front().front();
  }
  return surfaces;
}

/// What a step takes, in additions.
double cost_of(const std::vector<Program::Step>& steps) {
  double sum = 0;
  for (const Program::Step& step : steps) {
    const graph::Code code = step.operation->code;
    sum += code == graph::Code::other ? 40 : code == graph::Code::sqrt || code == graph::Code::divide ? 4 : 1;
  }
  return sum;
}

}  // namespace

CellTest::CellTest(const Evaluation& evaluation, const std::vector<int>& swept, std::vector<std::size_t> order,
                   std::size_t mode)
    : order_(std::move(order)) {
  const Model& model = evaluation.model;
  Conditions known = conditions_of(model, mode);
  graph::Graph& graph = known.graph;
  std::vector<Node>& conditions = known.all;
  std::vector<CoveredRange>& ranges = known.cranks;

  std::array<Groups, 4> groups{~Groups{0}, 0, 0, 0};
  for (std::size_t i = 0; i < order_.size(); ++i) {
    Groups& group = groups[kInner + 1 + i - order_.size()];
    group = Inputs::coordinate_group(static_cast<std::size_t>(swept[order_[i]]));
    groups[0] &= ~group;
  }
  std::vector<std::array<graph::Polynomial, 4>> surfaces;
  std::erase_if(ranges, [&](const CoveredRange& crank) {
    const auto found = surfaces_of(graph, crank, groups[kInner]);
    if (!found) return true;
    surfaces.push_back(*found);
    std::erase_if(conditions,
                  [&](Node node) { return std::ranges::find(crank.conditions, node) != crank.conditions.end(); });
    return false;
  });
  std::vector<Node> outputs, plain;
  std::vector<graph::Clause> clauses;
  for (const Node condition : conditions) {
    const bool along = (graph[condition].groups & groups[kInner]) != 0;
    const auto lower = along ? lowered(graph, condition, groups[kInner]) : std::nullopt;
    if (lower)
      clauses.insert(clauses.end(), lower->begin(), lower->end());
    else
      plain.push_back(condition);
  }
  simplify(graph, clauses, plain);
  outputs = plain;
  for (const graph::Clause& clause : clauses)
    for (const graph::Polynomial& q : clause) outputs.insert(outputs.end(), q.c.begin(), q.c.begin() + 3);
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    for (const graph::Polynomial& q : surfaces[i]) outputs.insert(outputs.end(), q.c.begin(), q.c.begin() + 3);
    outputs.insert(outputs.end(), {ranges[i].half_turn, ranges[i].reach});
  }
  program_ = Program(graph, outputs, groups);

  std::vector<std::uint32_t> kept;
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    const std::uint32_t at = program_.outputs()[i];
    const int stage = program_.stage_of()[at];
    if (i < plain.size())
      (stage == kInner ? inner_conditions_ : stage == kMiddle ? middle_conditions_ : early_).push_back(at);
    if (stage == kMiddle) kept.push_back(at);
  }
  for (const auto& step : program_.stages()[kInner].steps)
    for (std::size_t i = 0; i < step.count; ++i)
      if (program_.stage_of()[step.from[i]] == kMiddle) handed_down_.push_back(step.from[i]);
  std::ranges::sort(handed_down_);
  handed_down_.erase(std::unique(handed_down_.begin(), handed_down_.end()), handed_down_.end());
  kept.insert(kept.end(), handed_down_.begin(), handed_down_.end());
  middle_.emplace(program_, kMiddle, kept);
  std::vector<std::uint32_t> tested;  // inner conditions, and cranks' reaches
  for (const std::uint32_t at : program_.outputs())
    if (program_.stage_of()[at] == kInner) tested.push_back(at);
  inner_.emplace(program_, kInner, tested);
  const graph::Node zero = graph.number(0);
  std::size_t output = plain.size();
  for (const graph::Clause& clause : clauses) {
    Alternatives made;
    std::optional<graph::Operand> constant;  // an alternative that is the same all along
    for (const graph::Polynomial& q : clause) {
      ColumnCondition condition{.shape = shape_of(graph, q.c[2])};
      for (graph::Operand& c : condition.c) c = middle_->operand(program_.outputs()[output++]);
      if (clause.size() == 2 && !constant && q.c[1] == zero && q.c[2] == zero)
        constant = condition.c[0];
      else
        made.push_back(condition);
    }
    if (constant) {
      made.front().has_unless = true;
      made.front().unless = *constant;
    }
    if (made.size() == 1)
      columns_.push_back(made.front());
    else
      alternatives_.push_back(made);
  }
  std::ranges::stable_sort(columns_, {}, &ColumnCondition::shape);
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    std::array<ColumnCondition, 4> conditions_of_range;
    for (std::size_t k = 0; k < 4; ++k) {
      conditions_of_range[k].shape = shape_of(graph, surfaces[i][k].c[2]);
      for (graph::Operand& c : conditions_of_range[k].c) c = middle_->operand(program_.outputs()[output++]);
    }
    const auto& [at_min, at_max, after_min, before_max] = conditions_of_range;
    cranks_.push_back({at_min, at_max, after_min, before_max, program_.outputs()[output],
                       program_.outputs()[output + 1], graph[ranges[i].branch].number < 0});
    output += 2;
  }
}

double CellTest::cost(const std::array<std::int64_t, 3>& cells) const {
  double passes = 1, sum = 0;
  std::size_t stage = kInner + 1 - order_.size();
  for (const std::size_t axis : order_) {
    passes *= static_cast<double>(cells[axis]);
    sum +=
        passes * cost_of(program_.stages()[stage].steps) * (stage == kOuter ? 4 : 1);  // numbers are slower than rows
    if (stage == kMiddle)
      sum += passes * 8 * static_cast<double>(columns_.size() + 4 * alternatives_.size() + 8 * cranks_.size());
    ++stage;
  }
  return sum;
}

CellTest CellTest::fastest(const Evaluation& evaluation, const std::vector<int>& swept,
                           const std::array<std::int64_t, 3>& cells, std::size_t mode) {
  std::vector<std::size_t> order(swept.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::optional<CellTest> best;
  double least = 0;
  do {
    CellTest test(evaluation, swept, order, mode);
    const double cost = test.cost(cells);
    if (best && cost >= least) continue;
    least = cost;
    best.emplace(std::move(test));
  } while (std::next_permutation(order.begin(), order.end()));
  return std::move(*best);
}

std::array<std::size_t, 3> CellTest::shape(const VoxelGrid& grid) const {
  std::array<std::size_t, 3> cells = {1, 1, 1};
  for (std::size_t i = 0; i < order_.size(); ++i)
    cells[3 - order_.size() + i] = static_cast<std::size_t>(grid.cells[order_[i]]);
  return cells;
}

std::array<std::int64_t, 3> CellTest::cell(std::size_t outer, std::size_t middle, std::size_t inner) const {
  const std::size_t loops[3] = {outer, middle, inner};
  std::array<std::int64_t, 3> cell{};
  for (std::size_t i = 0; i < order_.size(); ++i)
    cell[order_[i]] = static_cast<std::int64_t>(loops[3 - order_.size() + i]);
  return cell;
}

bool CellTest::is_outermost(const VoxelGrid& grid, std::size_t outer) const {
  return order_.size() == 3 && (outer == 0 || outer + 1 == shape(grid)[0]);
}

bool CellTest::at_side(const VoxelGrid& grid, std::size_t outer, std::size_t middle) const {
  return is_outermost(grid, outer) || (order_.size() >= 2 && (middle == 0 || middle + 1 == shape(grid)[1]));
}

void CellTest::start(const std::vector<double>& inputs, CellRoom& room) const {
  room.registers.resize(program_.registers());
  room.middle_rows.resize(middle_->slots() * kRow);
  room.rows.resize(inner_->slots() * kRow);
  program_.start<double>(room.registers);
  program_.run<double>(0, inputs, room.registers);
}

CellTally CellTest::test(const VoxelGrid& grid, std::size_t outer, bool want_bits, CellRoom& room) const {
  const auto [slices, columns, cells] = shape(grid);
  if (want_bits) room.bits.assign(columns * words(cells), 0);
  for (const auto& input : program_.stages()[kOuter].inputs)
    room.registers[input.to] = grid.centre(order_[0], static_cast<std::int64_t>(outer));
  program_.run<double>(kOuter, room.registers);
  CellTally tally;
  if (!std::ranges::all_of(early_, [&](std::uint32_t at) { return room.registers[at] >= 0; })) return tally;
  for (std::size_t first = 0; first < columns; first += kRow) {
    const CellTally part = test_columns(grid, outer, first, std::min(kRow, columns - first), want_bits, room);
    tally.cells += part.cells;
    tally.touches_box = tally.touches_box || part.touches_box;
  }
  return tally;
}

CellTally CellTest::test_columns(const VoxelGrid& grid, std::size_t outer, std::size_t first, std::size_t count,
                                 bool want_bits, CellRoom& room) const {
  const std::size_t cells = shape(grid)[2], inner = order_.back();
  const ColumnGrid column_grid = {grid.centre(inner, 0), grid.step[inner], static_cast<double>(cells)};
  const std::size_t whole = (count + kLanes - 1) / kLanes * kLanes;
  for (const std::uint32_t slot : middle_->inputs())
    fill_centres(grid, order_[order_.size() - 2], first, count, &room.middle_rows[slot * kRow]);
  const double* const registers = room.registers.data();
  double* const rows = room.middle_rows.data();
  middle_->run(registers, rows, whole);

  CellRanges& ranges = room.ranges;
  std::fill_n(ranges.from.begin(), whole, 0.0);
  std::fill_n(ranges.to.begin(), count, column_grid.cells);
  std::fill(ranges.to.begin() + static_cast<std::ptrdiff_t>(count),
            ranges.to.begin() + static_cast<std::ptrdiff_t>(whole), 0.0);
  for (const std::uint32_t at : middle_conditions_) {
    const double* const row = rows + middle_->operand(at).index * kRow;
    for (std::size_t j = 0; j < count; ++j) ranges.to[j] = row[j] >= 0 ? ranges.to[j] : 0;
  }
  const std::size_t length = words(cells);
  bool has_holes = false;
  for (const ColumnCondition& condition : columns_) {
    const bool holes = with_instruction_set(
        [&]<InstructionSet set> { return narrow<set>(condition, registers, rows, column_grid, whole, ranges); });
    if (!holes) continue;
    if (!has_holes) room.hole.assign(count * length, 0);
    has_holes = true;
    for (std::size_t j = 0; j < count; ++j)
      for (std::size_t word = 0; word < length; ++word)
        room.hole[j * length + word] |= range_of_bits(ranges.hole_from[j], ranges.hole_to[j], word);
  }
  CellTally tally;
  if (!want_bits && !has_holes && alternatives_.empty() && cranks_.empty() && inner_conditions_.empty()) {
    double sum = 0, at_ends = 0;  // both without a branch
    const auto number = [&](std::size_t j) { return std::max(ranges.to[j] - ranges.from[j], 0.0); };
    for (std::size_t j = 0; j < count; ++j) {
      sum += number(j);
      at_ends += ranges.from[j] == 0 || ranges.to[j] == column_grid.cells ? number(j) : 0;
    }
    const auto is_side = [&](std::size_t j) { return number(j) > 0 && at_side(grid, outer, first + j); };
    tally.cells = static_cast<std::int64_t>(sum);
    tally.touches_box = at_ends > 0 || is_side(0) || is_side(count - 1) || (sum > 0 && is_outermost(grid, outer));
    return tally;
  }
  if (!want_bits) room.bits.resize((first + count) * length);
  for (std::size_t j = 0; j < count; ++j)
    for (std::size_t word = 0; word < length; ++word)
      room.bits[(first + j) * length + word] =
          range_of_bits(ranges.from[j], ranges.to[j], word) & ~(has_holes ? room.hole[j * length + word] : 0);
  find_bits(grid, first, count, column_grid, room);
  for (std::size_t j = 0; j < count; ++j) {
    const std::uint64_t* const bits = &room.bits[(first + j) * length];
    std::int64_t number = 0;
    for (std::size_t word = 0; word < length; ++word) number += std::popcount(bits[word]);
    tally.cells += number;
    if (number == 0 || tally.touches_box) continue;
    const bool last = (bits[(cells - 1) / 64] >> ((cells - 1) % 64) & 1) != 0;
    tally.touches_box = (bits[0] & 1) != 0 || last || at_side(grid, outer, first + j);
  }
  return tally;
}

void CellTest::bits_of(const ColumnCondition& condition, const ColumnGrid& column_grid, std::size_t count,
                       CellRoom& room, std::vector<std::uint64_t>& bits) const {
  const std::size_t whole = (count + kLanes - 1) / kLanes * kLanes,
                    length = words(static_cast<std::size_t>(column_grid.cells));
  CellRanges& ranges = room.other;
  std::fill_n(ranges.from.begin(), whole, 0.0);
  std::fill_n(ranges.to.begin(), whole, column_grid.cells);
  for (auto* const hole : {&ranges.hole_from, &ranges.hole_to}) std::fill_n(hole->begin(), whole, 0.0);
  with_instruction_set([&]<InstructionSet set> {
    narrow<set>(condition, room.registers.data(), room.middle_rows.data(), column_grid, whole, ranges);
  });
  bits.resize(count * length);
  for (std::size_t j = 0; j < count; ++j)
    for (std::size_t word = 0; word < length; ++word)
      bits[j * length + word] = range_of_bits(ranges.from[j], ranges.to[j], word) &
                                ~range_of_bits(ranges.hole_from[j], ranges.hole_to[j], word);
}

/// What limbs::CrankRange says of the cells of some columns.
void CellTest::find_crank_bits(std::size_t i, const ColumnGrid& column_grid, std::size_t count, CellRoom& room) const {
  const Crank& crank = cranks_[i];
  bits_of(crank.at_min, column_grid, count, room, room.at_min);
  bits_of(crank.at_max, column_grid, count, room, room.at_max);
  bits_of(crank.after_min, column_grid, count, room, room.after_min);
  bits_of(crank.before_max, column_grid, count, room, room.before_max);
  const bool is_half = room.registers[crank.half_turn] >= 0;
  std::vector<std::uint64_t>&in = room.in_range[i], &maybe = room.if_reached[i];
  in.resize(room.at_min.size());
  maybe.resize(room.at_min.size());
  for (std::size_t k = 0; k < in.size(); ++k) {
    const std::uint64_t f1 = room.at_min[k], f2 = room.at_max[k], p1 = room.after_min[k], p2 = room.before_max[k];
    const std::uint64_t middle = is_half ? p1 & p2 : p1 | p2, opposite = is_half ? ~p1 & ~p2 : ~p1 | ~p2;
    in[k] = crank.is_first ? f1 & ~f2 : ~f1 & f2;
    maybe[k] = (f1 & f2 & middle) | (~f1 & ~f2 & opposite);
  }
}

/// What is left of room.bits by conditions with alternatives, by cranks, and by what is tested cell by cell.
void CellTest::find_bits(const VoxelGrid& grid, std::size_t first, std::size_t count, const ColumnGrid& column_grid,
                         CellRoom& room) const {
  const std::size_t length = words(shape(grid)[2]);
  std::uint64_t* const bits = &room.bits[first * length];
  for (const Alternatives& alternatives : alternatives_) {
    room.some.assign(count * length, 0);
    for (const ColumnCondition& alternative : alternatives) {
      bits_of(alternative, column_grid, count, room, room.hole);
      for (std::size_t k = 0; k < count * length; ++k) room.some[k] |= room.hole[k];
    }
    for (std::size_t k = 0; k < count * length; ++k) bits[k] &= room.some[k];
  }
  room.in_range.resize(cranks_.size());
  room.if_reached.resize(cranks_.size());
  for (std::size_t i = 0; i < cranks_.size(); ++i) {
    find_crank_bits(i, column_grid, count, room);
    for (std::size_t k = 0; k < count * length; ++k) bits[k] &= room.in_range[i][k] | room.if_reached[i][k];
  }
  for (std::size_t j = 0; j < count; ++j) {
    bool is_open = false;
    for (std::size_t k = j * length; k < (j + 1) * length; ++k) {
      is_open = is_open || (!inner_conditions_.empty() && bits[k] != 0);
      for (const auto& maybe : room.if_reached) is_open = is_open || (bits[k] & maybe[k]) != 0;
    }
    if (!is_open) continue;
    for (const std::uint32_t at : handed_down_)
      room.registers[at] = room.middle_rows[middle_->operand(at).index * kRow + j];
    test_cells(grid, first, j, room);
  }
}

/// Column first + j; j counts in what find_bits() found of cranks.
void CellTest::test_cells(const VoxelGrid& grid, std::size_t column_0, std::size_t j, CellRoom& room) const {
  static_assert(kRow == 64);  // a row is a word
  const std::size_t cells = shape(grid)[2], length = words(cells);
  for (std::size_t word = 0; word < length; ++word) {
    std::uint64_t& bits = room.bits[(column_0 + j) * length + word];
    if (bits == 0) continue;
    const std::size_t first = word * kRow, count = std::min(kRow, cells - first);
    std::size_t whole = kLanes;
    for (const std::uint32_t slot : inner_->inputs())
      whole = fill_centres(grid, order_.back(), first, count, &room.rows[slot * kRow]);
    inner_->run(room.registers.data(), room.rows.data(), whole);
    const auto holds = [&](std::uint32_t condition) {
      const double* const row = &room.rows[inner_->operand(condition).index * kRow];
      std::uint64_t found = 0;
      for (std::size_t k = 0; k < count; ++k) found |= static_cast<std::uint64_t>(row[k] >= 0) << k;
      return found;
    };
    for (const std::uint32_t condition : inner_conditions_) bits &= holds(condition);
    for (std::size_t i = 0; i < cranks_.size(); ++i)
      bits &= room.in_range[i][j * length + word] | (room.if_reached[i][j * length + word] & holds(cranks_[i].reach));
  }
}

}  // namespace pkm::described
