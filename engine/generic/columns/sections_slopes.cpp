// Derivatives of an integral: adjoints of its nodes, and ends of parts that move with the design.
#include "engine/expression/reverse_mode.hpp"
#include "engine/generic/columns/sections_integral.hpp"

namespace pkm::generic {

void SectionsIntegral::add_slopes(std::span<double> by_input, IntegralRoom& room) const {
  room.adjoints.assign(plan().program.registers(), 0);
  add_slopes(0, 1, room);
  backward_sweep(plan().program, 0, room.registers, room.adjoints);
  for (const auto& input : plan().program.stages()[0].inputs) by_input[input.position] += room.adjoints[input.to];
}

/// After inside(level), with a factor. What was kept is used up.
void SectionsIntegral::add_slopes(std::size_t level, double factor, IntegralRoom& room) const {
  if (level == levels()) {
    if (const auto* const section = std::get_if<Section>(&innermost_))
      section->add_slopes(factor, room.registers, room.adjoints, room.section);
    else
      std::get<Column>(innermost_).add_slopes(factor, room.registers, room.adjoints, room.column);
    return;
  }
  const auto& stage = plan().program.stages()[level + 1];
  for (const SlicePart& part : room.levels[level].parts) {
    for (std::size_t i = 0; i < NestedRule::kNodes; ++i) {
      if (level == 0 && !room.kept.empty()) {
        set(level, part.at[i], room);
        std::swap(room.levels[1].parts, room.kept[part.kept + i]);
      } else {
        slice(level, part.at[i], room);
      }
      add_slopes(level + 1, factor * part.weight[i], room);
      backward_sweep(plan().program, level + 1, room.registers, room.adjoints);
      for (const auto& input : stage.inputs) room.adjoints[input.to] = 0;
    }
    add_side(level, part, false, factor, room);
    add_side(level, part, true, factor, room);
  }
}

/// An end that moves with the design takes its slice along.
void SectionsIntegral::add_side(std::size_t level, const SlicePart& part, bool upper, double factor,
                                IntegralRoom& room) const {
  const Closing closing = upper ? part.upper : part.lower;
  const double at = upper ? part.piece.upper : part.piece.lower, sign = upper ? factor : -factor;
  if (closing == kChange) {
    if (may_jump(level, part, upper, room))
      visit_lost(level, part, upper, upper ? -1 : 1, room, [&](double weight, double slope) {
        for (std::size_t i = 0; i < room.own.size(); ++i) room.adjoints[i] -= sign * weight / slope * room.own[i];
      });
    return;
  }
  const double measure = (upper ? part.above : part.below).measure;
  if (closing == kBox) {
    room.adjoints[plan().range[level][upper ? 1 : 0]] += sign * measure;
    return;
  }
  const double slope = slope_of_plain(level, closing, at, room);
  if (slope == 0) return;
  for (std::size_t i = 0; i < room.own.size(); ++i) room.adjoints[i] -= sign * measure / slope * room.own[i];
}

/// How much the plain condition that closes a part changes there with the coordinate; room.own: with the registers.
double SectionsIntegral::slope_of_plain(std::size_t level, Closing closing, double at, IntegralRoom& room) const {
  set(level, at, room);
  return stage_derivative(plan().program, level + 1, plan().plain[level + 1][closing - 1], room.registers, room.own);
}

}  // namespace pkm::generic
