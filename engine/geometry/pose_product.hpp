// Cartesian product of poses with the values of a coordinate.
#pragma once

#include <span>
#include <vector>

#include "engine/geometry/pose.hpp"

namespace pkm {

/// Each of the poses with each of the values of one coordinate; the values vary fastest.
inline std::vector<Pose<double>> with_each(const std::vector<Pose<double>>& poses, int coordinate,
                                           std::span<const double> values) {
  std::vector<Pose<double>> product;
  for (const Pose<double>& pose : poses)
    for (const double value : values) {
      product.push_back(pose);
      product.back()[static_cast<std::size_t>(coordinate)] = value;
    }
  return product;
}

}  // namespace pkm
