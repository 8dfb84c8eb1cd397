// (3CRR/R)&CRU and Quadrupteron: what surveys by columns and by voxels share.
#pragma once

#include "engine/mechanism/survey.hpp"
#include "engine/mechanisms/crr_cru/frame.hpp"

namespace pkm::crr_cru {

inline Held held_of(int coordinate, const SurveyPlan& plan) {
  const HeldCoordinate held = how_held(plan, coordinate);
  return {static_cast<std::size_t>(coordinate), held.kind == HeldCoordinate::Kind::middle, held.value};
}

/// Conditioning depends on phi alone.
template <class S>
S conditioning_at(const Geometry<S>& g, const Demand& demand, const S& phi) {
  const auto [s, c] = sincos(phi);
  const S length = demand.characteristic_length ? S(*demand.characteristic_length) : characteristic_length(g);
  return conditioning(arms(g, s, c), length);
}

/// One sample stands for all positions at one phi.
template <class S>
void add_conditioning(const Geometry<S>& g, const Demand& demand, const S& phi, const S& weight, Survey<S>& survey) {
  if (!(value_of(weight) > 0)) return;
  survey.weight.push_back(weight);
  survey.conditioning.push_back(conditioning_at(g, demand, phi));
}

}  // namespace pkm::crr_cru
