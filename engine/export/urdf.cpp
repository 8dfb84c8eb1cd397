#include "engine/export/urdf.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/core/formatted.hpp"
#include "engine/export/multibody_xml.hpp"

namespace pkm {
namespace {

// Points closer than this, relative to the size of the mechanism, count as coincident.
constexpr double kCoincidence = 1e-9;

using Position = Point3<double>;

double distance(const Position& a, const Position& b) { return segment_distance<double>({a, a}, {b, b}); }

/// A link of the URDF tree, with the capsules that represent it.
struct TreeLink {
  std::string name;
  std::vector<Capsule<double>> shape = {};

  bool is_point() const { return shape.size() == 1 && shape[0].axis.from == shape[0].axis.to; }
  bool contains(const Position& point, double tolerance) const {
    return std::ranges::any_of(shape, [&](const auto& part) {
      return segment_distance<double>({point, point}, part.axis) <= tolerance;
    });
  }
};

/// A point at which two links are joined.
struct Junction {
  std::size_t first, second;  ///< indices of the two links
  Position point;
};

/// The joint by which a link is attached to its parent in the tree.
struct ParentJoint {
  std::size_t parent;
  Position point;
};

/// Groups the links of the mechanism into links of the tree: the first one consists of the links that do not move (the
/// frame), another one of all links of the platform.
std::vector<TreeLink> tree_links(const std::vector<PlacedLink>& links) {
  std::vector<TreeLink> found = {{kFramePart}};
  for (const PlacedLink& link : links) {
    const bool whole = link.part == kFramePart || link.part == kPlatformPart;
    const std::string name = plain_name(whole ? link.part : link.part + ' ' + link.name);
    auto body = std::ranges::find(found, name, &TreeLink::name);
    if (body == found.end()) body = found.insert(body, {name});
    body->shape.push_back(link.body);
  }
  return found;
}

/// An end of a capsule. It is stationary if its position is the same at both poses for which the links are given.
struct End {
  Position point;
  bool is_stationary;
};

/// The ends of all capsules. Ends that coincide are listed once.
std::vector<End> ends_of(const std::vector<PlacedLink>& links, const std::vector<PlacedLink>& moved, double tolerance) {
  std::vector<End> ends;
  for (std::size_t i = 0; i < links.size(); ++i)
    for (const auto end : {&Segment<double>::from, &Segment<double>::to}) {
      const Position& point = links[i].body.axis.*end;
      if (std::ranges::any_of(ends, [&](const End& e) { return distance(point, e.point) <= tolerance; })) continue;
      ends.push_back({point, !moved.empty() && distance(point, moved[i].body.axis.*end) <= tolerance});
    }
  return ends;
}

/// Returns true if both ends of all capsules of a link lie on the frame, as those of a slider do.
bool is_slide(const TreeLink& frame, const TreeLink& body, double tolerance) {
  return std::ranges::all_of(body.shape, [&](const auto& part) {
    return frame.contains(part.axis.from, tolerance) && frame.contains(part.axis.to, tolerance);
  });
}

/// Finds the junctions. Two links are joined where an end of one lies on the other; a link is joined to the frame at a
/// stationary end. If several links share a point, one of them is joined to all others: the first slider, or the first
/// link that is a point, otherwise the first link. Two links have at most one junction.
std::vector<Junction> junctions_of(const std::vector<TreeLink>& links, const std::vector<End>& ends, double tolerance) {
  std::vector<Junction> found;
  const auto joined = [&found](std::size_t a, std::size_t b) {
    return std::ranges::any_of(found,
                               [&](const Junction& j) { return std::minmax(j.first, j.second) == std::minmax(a, b); });
  };
  for (const auto& [point, is_stationary] : ends) {
    std::vector<std::size_t> here;
    for (std::size_t i = 0; i < links.size(); ++i)
      if ((i == 0 && is_stationary) || links[i].contains(point, tolerance)) here.push_back(i);
    const auto hub = std::ranges::find_if(
        here, [&](std::size_t i) { return i > 0 && (links[i].is_point() || is_slide(links[0], links[i], tolerance)); });
    if (hub != here.end()) std::swap(*hub, here.front());
    for (std::size_t k = 1; k < here.size(); ++k)
      if (!joined(here[0], here[k])) found.push_back({here[0], here[k], point});
  }
  return found;
}

/// Spanning tree of the links, rooted at the frame.
struct Tree {
  std::vector<ParentJoint> joints;      ///< joint of each link with its parent; the element of the frame is unused
  std::vector<std::size_t> order = {};  ///< indices of the links, parents before their children
  std::vector<Junction> cuts = {};      ///< junctions that are not joints of the tree: each closes a loop
  /// Indices of the links at which parts without a connection to the frame begin.
  std::vector<std::size_t> disconnected = {};
};

/// Computes the spanning tree by breadth-first search.
Tree spanning_tree(const std::vector<TreeLink>& links, const std::vector<Junction>& junctions) {
  Tree tree{std::vector<ParentJoint>(links.size())};
  std::vector<bool> reached(links.size()), used(junctions.size());
  const auto add = [&](std::size_t link, const ParentJoint& joint) {
    tree.joints[link] = joint;
    tree.order.push_back(link);
    reached[link] = true;
  };
  std::size_t next = 0;
  for (std::size_t root = 0; root < links.size(); ++root) {
    if (reached[root]) continue;
    if (root > 0) tree.disconnected.push_back(root);
    add(root, {0, root > 0 ? links[root].shape[0].axis.from : Position{}});
    for (; next < tree.order.size(); ++next)
      for (std::size_t k = 0; k < junctions.size(); ++k) {
        const std::size_t parent = tree.order[next];
        const auto& [first, second, point] = junctions[k];
        if (used[k] || (first != parent && second != parent)) continue;
        used[k] = true;
        const std::size_t child = first == parent ? second : first;
        if (reached[child])
          tree.cuts.push_back(junctions[k]);
        else
          add(child, {parent, point});
      }
  }
  return tree;
}

std::string numbers(const Position& p) {
  return formatted("%.12g", p[0]) + ' ' + formatted("%.12g", p[1]) + ' ' + formatted("%.12g", p[2]);
}

/// Element <origin> with a position and a rotation.
/// @param angles  roll, pitch and yaw [rad]
std::string origin(const Position& position, const Position& angles = {}) {
  return "<origin xyz=\"" + numbers(position) + "\" rpy=\"" + numbers(angles) + "\"/>";
}

/// Element <visual> for a capsule: a cylinder along the axis of the capsule, or a sphere if the axis is a point. In
/// URDF, the axis of a cylinder is along z before the rotations about x, y and z.
/// @param origin_of_link  origin of the link, in the frame of the capsule
std::string visual(const Capsule<double>& capsule, const Position& origin_of_link) {
  const Position along = difference(capsule.axis.to, capsule.axis.from);
  const double length = std::sqrt(dot(along, along));
  Position centre{};
  for (std::size_t i = 0; i < 3; ++i) centre[i] = (capsule.axis.from[i] + capsule.axis.to[i]) / 2 - origin_of_link[i];
  const Position angles = {0, std::atan2(std::hypot(along[0], along[1]), along[2]), std::atan2(along[1], along[0])};
  const std::string radius = "radius=\"" + formatted("%.12g", capsule.radius) + '"';
  const std::string shape = length > 0 ? "<cylinder " + radius + " length=\"" + formatted("%.12g", length) + "\"/>"
                                       : "<sphere " + radius + "/>";
  return "    <visual>" + origin(centre, angles) + "<geometry>" + shape + "</geometry></visual>\n";
}

}  // namespace

std::string links_urdf(const std::vector<PlacedLink>& links, const std::vector<PlacedLink>& moved,
                       const std::string& name, const std::string& title) {
  double size = 0;
  for (const PlacedLink& link : links)
    size = std::max({size, distance(link.body.axis.from, {}), distance(link.body.axis.to, {})});
  const double tolerance = kCoincidence * size;
  const std::vector<TreeLink> bodies = tree_links(links);
  const Tree tree = spanning_tree(bodies, junctions_of(bodies, ends_of(links, moved, tolerance), tolerance));

  std::string urdf = "<?xml version=\"1.0\"?>\n<robot name=\"" + plain_name(name) + "\">\n" + xml_comment(title) +
                     xml_comment(
                         "All joints are fixed at this pose: they show where links are connected, not how "
                         "they move.");
  for (const Junction& cut : tree.cuts)
    urdf += xml_comment("cut loop: " + bodies[cut.first].name + " and " + bodies[cut.second].name +
                        " are connected at " + numbers(cut.point));
  for (const std::size_t i : tree.disconnected)
    urdf += xml_comment("no connection to the frame found, attached to it: " + bodies[i].name);
  for (const std::size_t i : tree.order) {
    const auto& [parent, point] = tree.joints[i];
    urdf += "  <link name=\"" + bodies[i].name + "\">\n";
    for (const auto& part : bodies[i].shape) urdf += visual(part, point);
    urdf += "  </link>\n";
    if (i > 0)
      urdf += "  <joint name=\"" + bodies[parent].name + "_to_" + bodies[i].name + "\" type=\"fixed\"><parent link=\"" +
              bodies[parent].name + "\"/><child link=\"" + bodies[i].name + "\"/>" +
              origin(difference(point, tree.joints[parent].point)) + "</joint>\n";
  }
  return urdf + "</robot>\n";
}

}  // namespace pkm
