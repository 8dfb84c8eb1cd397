// Volume enclosed by a triangulated surface, by the divergence theorem.
#pragma once

#include "engine/export/isosurface.hpp"

namespace pkm::test {

/// In the product of the axes' units; positive if the triangles are counter-clockwise seen from outside.
inline double enclosed_volume(const Isosurface& surface) {
  double sixfold = 0;
  for (const auto& [a, b, c] : surface.triangles) {
    const auto &p = surface.vertices[a], &q = surface.vertices[b], &r = surface.vertices[c];
    sixfold +=
        p[0] * (q[1] * r[2] - q[2] * r[1]) + p[1] * (q[2] * r[0] - q[0] * r[2]) + p[2] * (q[0] * r[1] - q[1] * r[0]);
  }
  return sixfold / 6;
}

}  // namespace pkm::test
