// The parts on which an integral's nodes are, and how they move with the design: the nodes move along.
#include "engine/generic/columns/sections_integral.hpp"

namespace pkm::generic {

void SectionsIntegral::start_moving(std::span<const Dual4> inputs, IntegralRoom& room) const {
  const expression::Program& program = plan().program;
  room.moving.resize(program.registers());
  program.start<Dual4>(room.moving);
  program.run<Dual4>(0, inputs, room.moving);
}

void SectionsIntegral::set_moving(std::size_t level, const Dual4& at, IntegralRoom& room) const {
  for (const auto& input : plan().program.stages()[level + 1].inputs) room.moving[input.to] = at;
  plan().program.run<Dual4>(level + 1, std::span<Dual4>(room.moving));
}

std::vector<SlicePart> SectionsIntegral::whole_parts(std::size_t level, const IntegralRoom& room) {
  std::vector<SlicePart> whole;
  for (const SlicePart& part : room.levels[level].parts) {
    SlicePart* const last = whole.empty() ? nullptr : &whole.back();
    if (!last || last->piece.upper != part.piece.lower || last->above.hash != part.below.hash) {
      whole.push_back(part);
      continue;
    }
    last->piece.upper = part.piece.upper;
    last->piece.sqrt_at_upper = part.piece.sqrt_at_upper;
    last->above = part.above;
    last->upper = part.upper;
    last->beyond_upper = part.beyond_upper;
  }
  return whole;
}

Piece<Dual4> SectionsIntegral::moving_piece(std::size_t level, const SlicePart& part, const Dual4* below,
                                            IntegralRoom& room) const {
  const bool goes_on = below && part.lower == kChange && below->a == part.piece.lower;
  return {goes_on ? *below : moving_end(level, part, false, room), moving_end(level, part, true, room),
          part.piece.sqrt_at_lower, part.piece.sqrt_at_upper};
}

/// An end of a part. A break of breaks, further out, and breaks between lines stay: the slices go on there, so that the
/// sum's derivative is that of the integral but for the rule's error. Where they jump, a break moves as the constraint
/// does that is violated beyond it.
Dual4 SectionsIntegral::moving_end(std::size_t level, const SlicePart& part, bool upper, IntegralRoom& room) const {
  const expression::Program& program = plan().program;
  const Closing closing = upper ? part.upper : part.lower;
  const double at = upper ? part.piece.upper : part.piece.lower;
  const auto [from, to] = plan().range[level];
  if (closing == kBox) return {at, room.moving[upper ? to : from].v};
  if (closing != kChange) {
    const double slope = slope_of_plain(level, closing, at, room);
    return moved(at, motion_of(room.own, room.moving), slope);
  }
  if (may_jump(level, part, upper, room)) {  // by the mean over the points that come or go
    Components<4> motion;
    double all = 0;
    for (const double side : {-1.0, 1.0})
      visit_lost(level, part, upper, side, room, [&](double weight, double slope) {
        motion = motion + motion_of(room.own, room.moving) * (-weight / slope);
        all += weight;
      });
    if (all > 0) return {at, motion * (1 / all)};
  }
  const auto* const section = std::get_if<Section>(&innermost_);
  if (level + 1 < levels() || !section) return at;
  set_moving(level, at, room);
  room.along.assign(room.registers.begin(), room.registers.end());
  for (const auto& input : program.stages()[level + 1].inputs) room.along[input.to] = Dual4::variable(at, 0);
  program.run<Dual4>(level + 1, std::span<Dual4>(room.along));
  const auto ends_at = [&](double place) {
    return slice(level, place, room).hash == 0 ? std::vector<ArcEnd>() : arc_ends(*section, room.section);
  };
  // Beside the break; further off, where rounding decides what is beside it.
  for (double share = kSettled; share < 1e-3; share *= 1e3) {
    const double beside = (upper ? -share : share) * (room.registers[to] - room.registers[from]);
    const std::vector<ArcEnd> outside = ends_at(at - beside), inside = ends_at(at + beside);
    const auto motion = moving_break(at, inside, outside, room.section,
                                     SectionMotion(*section, room.section, room.moving, room.registers),
                                     SectionMotion(*section, room.section, room.along, room.registers));
    if (motion) return *motion;
  }
  return at;
}

}  // namespace pkm::generic
