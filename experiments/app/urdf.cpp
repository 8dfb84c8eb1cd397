#include "experiments/app/urdf.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <utility>

#include "experiments/app/print.hpp"

namespace pkm {
namespace {

constexpr double kSamePlace = 1e-9;  // share of the mechanism's size

using Place = Point3<double>;

double distance(const Place& a, const Place& b) { return segment_distance<double>({a, a}, {b, b}); }

/// Capsules that are one link of the tree.
struct TreeLink {
  std::string name;
  std::vector<Capsule<double>> shape = {};

  bool is_point() const { return shape.size() == 1 && shape[0].axis.from == shape[0].axis.to; }
  bool has(const Place& place, double tolerance) const {
    return std::ranges::any_of(shape, [&](const auto& part) {
      return segment_distance<double>({place, place}, part.axis) <= tolerance;
    });
  }
};

/// Where two bodies meet.
struct Meeting {
  std::size_t first, second;
  Place place;
};

/// A link's place in the tree.
struct Hold {
  std::size_t parent;
  Place place;
};

/// What several programs take for a name: letters, digits and underscores.
std::string plain_name(std::string name) {
  for (char& c : name)
    if (!std::isalnum(static_cast<unsigned char>(c))) c = '_';
  return name;
}

/// The frame first, which no pose moves; then the links, those of the platform as one.
std::vector<TreeLink> bodies_of(const std::vector<PlacedLink>& links) {
  std::vector<TreeLink> bodies = {{kFramePart}};
  for (const PlacedLink& link : links) {
    const bool whole = link.part == kFramePart || link.part == kPlatformPart;
    const std::string name = plain_name(whole ? link.part : link.part + ' ' + link.name);
    auto body = std::ranges::find(bodies, name, &TreeLink::name);
    if (body == bodies.end()) body = bodies.insert(body, {name});
    body->shape.push_back(link.body);
  }
  return bodies;
}

/// The ends of capsules, each place once, and whether another pose leaves it where it is.
struct End {
  Place place;
  bool stays;
};

std::vector<End> ends_of(const std::vector<PlacedLink>& links, const std::vector<PlacedLink>& moved, double tolerance) {
  std::vector<End> ends;
  for (std::size_t i = 0; i < links.size(); ++i)
    for (const auto end : {&Segment<double>::from, &Segment<double>::to}) {
      const Place& place = links[i].body.axis.*end;
      if (std::ranges::any_of(ends, [&](const End& other) { return distance(place, other.place) <= tolerance; }))
        continue;
      ends.push_back({place, !moved.empty() && distance(place, moved[i].body.axis.*end) <= tolerance});
    }
  return ends;
}

/// A slide: all of it lies on the frame.
bool rides_on(const TreeLink& frame, const TreeLink& body, double tolerance) {
  return std::ranges::all_of(body.shape, [&](const auto& part) {
    return frame.has(part.axis.from, tolerance) && frame.has(part.axis.to, tolerance);
  });
}

/// Where an end of one body lies on another, or stays where it is, on the frame. Of several bodies in one place, each
/// meets the first that is a slide or a point there, else the first of all; two bodies meet once.
std::vector<Meeting> meetings_of(const std::vector<TreeLink>& bodies, const std::vector<End>& ends, double tolerance) {
  std::vector<Meeting> meetings;
  const auto known = [&meetings](std::size_t a, std::size_t b) {
    return std::ranges::any_of(
        meetings, [&](const Meeting& other) { return std::minmax(other.first, other.second) == std::minmax(a, b); });
  };
  for (const auto& [place, stays] : ends) {
    std::vector<std::size_t> here;
    for (std::size_t i = 0; i < bodies.size(); ++i)
      if ((i == 0 && stays) || bodies[i].has(place, tolerance)) here.push_back(i);
    const auto middle = std::ranges::find_if(here, [&](std::size_t i) {
      return i > 0 && (bodies[i].is_point() || rides_on(bodies[0], bodies[i], tolerance));
    });
    if (middle != here.end()) std::swap(*middle, here.front());
    for (std::size_t k = 1; k < here.size(); ++k)
      if (!known(here[0], here[k])) meetings.push_back({here[0], here[k], place});
  }
  return meetings;
}

/// What holds each body but the frame.
struct Tree {
  std::vector<Hold> holds;
  std::vector<std::size_t> order = {};  ///< parents before their children
  std::vector<Meeting> cuts = {};       ///< meetings that the tree leaves out: each closes a loop
  std::vector<std::size_t> loose = {};  ///< bodies that no meeting leads to, with what they hold
};

Tree tree_of(const std::vector<TreeLink>& bodies, const std::vector<Meeting>& meetings) {
  Tree tree{std::vector<Hold>(bodies.size())};
  std::vector<bool> reached(bodies.size()), used(meetings.size());
  const auto reach = [&](std::size_t body, const Hold& hold) {
    tree.holds[body] = hold;
    tree.order.push_back(body);
    reached[body] = true;
  };
  std::size_t next = 0;
  for (std::size_t root = 0; root < bodies.size(); ++root) {
    if (reached[root]) continue;
    if (root > 0) tree.loose.push_back(root);
    reach(root, {0, root > 0 ? bodies[root].shape[0].axis.from : Place{}});
    for (; next < tree.order.size(); ++next)
      for (std::size_t k = 0; k < meetings.size(); ++k) {
        const std::size_t parent = tree.order[next];
        const auto& [first, second, place] = meetings[k];
        if (used[k] || (first != parent && second != parent)) continue;
        used[k] = true;
        const std::size_t child = first == parent ? second : first;
        if (reached[child])
          tree.cuts.push_back(meetings[k]);
        else
          reach(child, {parent, place});
      }
  }
  return tree;
}

std::string numbers(const Place& p) {
  return formatted("%.12g", p[0]) + ' ' + formatted("%.12g", p[1]) + ' ' + formatted("%.12g", p[2]);
}

std::string origin(const Place& place, const Place& turns = {}) {
  return "<origin xyz=\"" + numbers(place) + "\" rpy=\"" + numbers(turns) + "\"/>";
}

/// A cylinder along its axis, which in URDF is along z before it is turned about x, y and z; a ball where it is a
/// point.
std::string visual(const Capsule<double>& capsule, const Place& from) {
  const Place way = difference(capsule.axis.to, capsule.axis.from);
  const double length = std::sqrt(dot(way, way));
  Place middle{};
  for (std::size_t i = 0; i < 3; ++i) middle[i] = (capsule.axis.from[i] + capsule.axis.to[i]) / 2 - from[i];
  const Place turns = {0, std::atan2(std::hypot(way[0], way[1]), way[2]), std::atan2(way[1], way[0])};
  const std::string radius = "radius=\"" + formatted("%.12g", capsule.radius) + '"';
  const std::string shape = length > 0 ? "<cylinder " + radius + " length=\"" + formatted("%.12g", length) + "\"/>"
                                       : "<sphere " + radius + "/>";
  return "    <visual>" + origin(middle, turns) + "<geometry>" + shape + "</geometry></visual>\n";
}

/// Two hyphens would end a comment.
std::string xml_comment(std::string text) {
  for (auto at = text.find("--"); at != std::string::npos; at = text.find("--", at)) text.insert(at + 1, " ");
  return "  <!-- " + xml_text(text) + " -->\n";
}

}  // namespace

std::string links_urdf(const std::vector<PlacedLink>& links, const std::vector<PlacedLink>& moved,
                       const std::string& name, const std::string& title) {
  double size = 0;
  for (const PlacedLink& link : links)
    size = std::max({size, distance(link.body.axis.from, {}), distance(link.body.axis.to, {})});
  const double tolerance = kSamePlace * size;
  const std::vector<TreeLink> bodies = bodies_of(links);
  const Tree tree = tree_of(bodies, meetings_of(bodies, ends_of(links, moved, tolerance), tolerance));

  std::string urdf = "<?xml version=\"1.0\"?>\n<robot name=\"" + plain_name(name) + "\">\n" + xml_comment(title) +
                     xml_comment(
                         "All joints are fixed, at this pose: what is drawn says where links meet, not how they "
                         "move.");
  for (const Meeting& cut : tree.cuts)
    urdf += xml_comment("cut loop: " + bodies[cut.first].name + " meets " + bodies[cut.second].name + " at " +
                        numbers(cut.place));
  for (const std::size_t i : tree.loose)
    urdf += xml_comment("meets none of these as it is drawn, hangs on the frame: " + bodies[i].name);
  for (const std::size_t i : tree.order) {
    const auto& [parent, place] = tree.holds[i];
    urdf += "  <link name=\"" + bodies[i].name + "\">\n";
    for (const auto& part : bodies[i].shape) urdf += visual(part, place);
    urdf += "  </link>\n";
    if (i > 0)
      urdf += "  <joint name=\"" + bodies[parent].name + "_to_" + bodies[i].name + "\" type=\"fixed\"><parent link=\"" +
              bodies[parent].name + "\"/><child link=\"" + bodies[i].name + "\"/>" +
              origin(difference(place, tree.holds[parent].place)) + "</joint>\n";
  }
  return urdf + "</robot>\n";
}

}  // namespace pkm
