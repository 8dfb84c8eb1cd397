#include "engine/mechanism/pose_quantity.hpp"

#include <cmath>
#include <limits>

namespace pkm {

std::shared_ptr<const PoseQuantity> formula_quantity(const std::string& name, const std::string& unit,
                                                     const std::string& meaning, std::size_t index) {
  struct Owner {
    std::string name, unit, meaning, mean, deviation, minimum, maximum;
    PoseQuantity quantity;
  };
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const std::string of = " of " + name + " over the poses";
  const auto owner = std::make_shared<Owner>(Owner{.name = name,
                                                   .unit = unit,
                                                   .meaning = meaning.empty() ? name : meaning,
                                                   .mean = "mean" + of,
                                                   .deviation = "standard deviation" + of,
                                                   .minimum = "minimum" + of,
                                                   .maximum = "maximum" + of,
                                                   .quantity = {}});
  owner->quantity = {.name = owner->name.c_str(),
                     .unit = owner->unit.c_str(),
                     .meaning = owner->meaning.c_str(),
                     .lower = -kInfinity,
                     .upper = kInfinity,
                     .worst = PoseQuantity::Worst::minimum,
                     .value_if_undefined = std::nan(""),
                     .results = {{{"mean", owner->mean.c_str()},
                                  {"std", owner->deviation.c_str()},
                                  {"min", owner->minimum.c_str()},
                                  {"max", owner->maximum.c_str()}}},
                     .formula = index};
  return {owner, &owner->quantity};
}

}  // namespace pkm
