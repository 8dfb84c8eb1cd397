// How the parts of an integral move with the design: nodes of the outer coordinates move along.
#include "engine/mechanisms/described/columns/sections_integral.hpp"

namespace pkm::described {

void SectionsIntegral::start_moving(std::span<const Dual4> inputs, IntegralRoom& room) const {
  const graph::Program& program = plan().program;
  room.moving.resize(program.registers());
  program.start<Dual4>(room.moving);
  program.run<Dual4>(0, inputs, room.moving);
}

void SectionsIntegral::set_moving(std::size_t level, const Dual4& at, IntegralRoom& room) const {
  for (const auto& input : plan().program.stages()[level + 1].inputs) room.moving[input.to] = at;
  plan().program.run<Dual4>(level + 1, std::span<Dual4>(room.moving));
}

/// Parts that halving made of one divide it as they do, wherever its ends move.
std::vector<Piece<Dual4>> SectionsIntegral::moving_pieces(std::size_t level, IntegralRoom& room) const {
  const std::vector<SlicePart>& parts = room.levels[level].parts;
  const auto goes_on = [](const SlicePart& part, const SlicePart& next) {
    return part.piece.upper == next.piece.lower && part.above.hash == next.below.hash;
  };
  std::vector<Piece<Dual4>> all;
  for (std::size_t first = 0, end; first < parts.size(); first = end) {
    for (end = first + 1; end < parts.size() && goes_on(parts[end - 1], parts[end]);) ++end;
    const Dual4 lower = moving_end(level, parts[first], false, room),
                upper = moving_end(level, parts[end - 1], true, room);
    const auto between = [&](double at) -> Dual4 {
      return {at, lower.v + (upper.v - lower.v) * ((at - lower.a) / (upper.a - lower.a))};
    };
    for (std::size_t i = first; i < end; ++i) {
      const Piece<double>& piece = parts[i].piece;
      all.push_back({between(piece.lower), between(piece.upper), piece.root_lower, piece.root_upper});
    }
  }
  return all;
}

/// An end of a part. A break of breaks, further out, stays: the slices go on there, so that the sum's derivative is
/// that of the integral but for the rule's error.
Dual4 SectionsIntegral::moving_end(std::size_t level, const SlicePart& part, bool upper, IntegralRoom& room) const {
  const graph::Program& program = plan().program;
  const Closing closing = upper ? part.upper : part.lower;
  const double at = upper ? part.piece.upper : part.piece.lower;
  const auto [from, to] = plan().range[level];
  if (closing == kBox) return {at, room.moving[upper ? to : from].v};
  if (closing != kChange) {
    const double slope = slope_of_plain(level, closing, at, room);
    return moved(at, motion_of(room.own, room.moving), slope);
  }
  if (level + 1 < levels()) return at;
  const double beside = (upper ? -kSettled : kSettled) * (room.registers[to] - room.registers[from]);
  const auto ends_at = [&](double place) {
    return slice(level, place, room).hash == 0 ? std::vector<ArcEnd>() : arc_ends(section_, room.section);
  };
  const std::vector<ArcEnd> outside = ends_at(at - beside), inside = ends_at(at + beside);
  set_moving(level, at, room);
  room.along.assign(room.registers.begin(), room.registers.end());
  for (const auto& input : program.stages()[level + 1].inputs) room.along[input.to] = Dual4::variable(at, 0);
  program.run<Dual4>(level + 1, std::span<Dual4>(room.along));
  return moving_break(at, inside, outside, room.section,
                      SectionMotion(section_, room.section, room.moving, room.registers),
                      SectionMotion(section_, room.section, room.along, room.registers));
}

}  // namespace pkm::described
