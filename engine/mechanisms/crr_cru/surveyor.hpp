// (3CRR/R)&CRU and Quadrupteron: what surveyors by columns and by voxels share.
#pragma once

#include "engine/mechanism/mechanism.hpp"
#include "engine/mechanisms/crr_cru/frame.hpp"
#include "engine/mechanisms/crr_cru/masses.hpp"

namespace pkm::crr_cru {

class SurveyorOfPlan : public Surveyor {
 public:
  SurveyorOfPlan(Platform platform, MassModel mass_model, const WorkingMode& mode, int held, const SurveyPlan& plan,
                 const Demand& demand)
      : platform_(platform),
        mass_model_(mass_model),
        mode_(mode),
        held_{static_cast<std::size_t>(held), how_held(plan, held).kind == HeldCoordinate::Kind::middle,
              how_held(plan, held).value},
        limits_(limits(plan.limits)),
        demand_(demand) {}

 protected:
  bool needs_inertia() const { return demand_.dci || demand_.inertia_condition; }

  /// Conditioning depends on phi alone.
  template <class S>
  S conditioning_at(const Geometry<S>& g, const S& phi) const {
    const auto [s, c] = sincos(phi);
    const S length = demand_.characteristic_length ? S(*demand_.characteristic_length) : characteristic_length(g);
    return conditioning(arms(g, s, c), length);
  }

  /// One sample stands for all positions at one phi.
  template <class S>
  void add_conditioning(const Geometry<S>& g, const S& phi, const S& weight, Survey<S>& survey) const {
    if (!(value_of(weight) > 0)) return;
    survey.weight.push_back(weight);
    survey.conditioning.push_back(conditioning_at(g, phi));
  }

  Platform platform_;
  MassModel mass_model_;
  WorkingMode mode_;
  Held held_;
  Limits limits_;
  Demand demand_;
};

}  // namespace pkm::crr_cru
