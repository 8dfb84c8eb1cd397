#include "engine/export/slice_outline.hpp"

namespace pkm {

double twice_area(const SliceOutline::Loop& loop) {
  double sum = 0;
  for (std::size_t k = 0; k < loop.size(); ++k) {
    const PlanePoint &a = loop[k], &b = loop[(k + 1) % loop.size()];
    sum += (a[0] - loop[0][0]) * (b[1] - loop[0][1]) - (b[0] - loop[0][0]) * (a[1] - loop[0][1]);
  }
  return sum;
}

SliceOutline trace_outline(const SliceMesh& mesh) {
  SliceOutline outline{mesh.axes, {}, 0};
  for (const PointPath& path : join_edges(boundary_edges(mesh.polygons))) {
    SliceOutline::Loop loop;
    for (std::size_t k = 0; k + 1 < path.size(); ++k) loop.push_back(mesh.points[path[k]]);
    outline.area += twice_area(loop) / 2;
    outline.loops.push_back(std::move(loop));
  }
  return outline;
}

}  // namespace pkm
