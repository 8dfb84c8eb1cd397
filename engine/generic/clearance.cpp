#include "engine/generic/clearance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <unordered_map>

#include "engine/core/catalogue.hpp"

namespace pkm::generic {
namespace {

// Number of program outputs for each link: three coordinates of each end of its axis, and its radius.
constexpr std::size_t kNumbers = 7;

template <class ValueOf>
auto capsule_of(const ValueOf& value) -> Capsule<decltype(value(0))> {
  return {{{value(0), value(1), value(2)}, {value(3), value(4), value(5)}}, value(6)};
}

bool is_fixed(const Graph& graph, const LinkNodes& link) {
  const auto is_constant = [&](Node node) { return (graph[node].groups & ~Inputs::kDesign) == 0; };
  return std::ranges::all_of(link.from, is_constant) && std::ranges::all_of(link.to, is_constant);
}

/// The groups of each link as ascending numbers, which are faster to compare than strings.
std::vector<std::vector<std::size_t>> numbered_groups(const std::vector<LinkNodes>& links) {
  std::unordered_map<std::string, std::size_t> numbers;
  std::vector<std::vector<std::size_t>> all;
  for (const LinkNodes& link : links) {
    std::vector<std::size_t>& groups = all.emplace_back();
    for (const std::string& group : link.groups)
      groups.push_back(numbers.try_emplace(group, numbers.size()).first->second);
    std::ranges::sort(groups);
  }
  return all;
}

/// Whether two ascending lists have a number in common.
bool overlap(const std::vector<std::size_t>& a, const std::vector<std::size_t>& b) {
  for (auto i = a.begin(), k = b.begin(); i != a.end() && k != b.end();) {
    if (*i == *k) return true;
    ++(*i < *k ? i : k);
  }
  return false;
}

bool share_a_joint(const LinkNodes& a, const LinkNodes& b) {
  return a.from == b.from || a.from == b.to || a.to == b.from || a.to == b.to;
}

std::vector<Node> nodes_of(const std::vector<LinkNodes>& links) {
  std::vector<Node> nodes;
  for (const LinkNodes& link : links) {
    nodes.insert(nodes.end(), link.from.begin(), link.from.end());
    nodes.insert(nodes.end(), link.to.begin(), link.to.end());
    nodes.push_back(link.radius);
  }
  return nodes;
}

/// Finds the pair with the minimum clearance by sweep and prune: the links are sorted by the lower ends of their
/// bounding boxes along the axis of largest extent, and each is compared with the following ones until their boxes are
/// farther apart than the minimum so far. Among pairs of equal clearance the first one is returned.
/// @param pairs  pairs of link indices whose clearance is tested, in ascending order
template <class S>
ClosestPair<S> nearest_pair(const std::vector<Capsule<S>>& links, const std::vector<LinkPair>& pairs) {
  ClosestPair<S> nearest{S(std::numeric_limits<double>::infinity())};
  if (pairs.empty()) return nearest;
  std::vector<Bounds<S>> boxes;
  double max_radius = 0;
  for (const Capsule<S>& link : links) {
    boxes.push_back(bounds_of(link.axis));
    max_radius = std::max(max_radius, value_of(link.radius));
  }
  const auto extent = [&](std::size_t axis) {
    const auto lower = [axis](const Bounds<S>& each) { return value_of(each.lower[axis]); };
    const auto [first, last] = std::ranges::minmax(boxes, {}, lower);
    return lower(last) - lower(first);
  };
  std::size_t axis = 0;
  for (const std::size_t other : {1, 2})
    if (extent(other) > extent(axis)) axis = other;
  std::vector<std::size_t> order(links.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::sort(order, {}, [&](std::size_t i) { return value_of(boxes[i].lower[axis]); });
  const auto ends = [](const LinkPair& pair) { return std::pair(pair.first, pair.second); };
  for (auto i = order.begin(); i != order.end(); ++i)
    for (auto k = i + 1; k != order.end(); ++k) {
      const double apart = value_of(boxes[*k].lower[axis]) - value_of(boxes[*i].upper[axis]);
      if (apart - (value_of(links[*i].radius) + max_radius) > value_of(nearest.clearance)) break;
      const LinkPair pair{std::min(*i, *k), std::max(*i, *k)};
      // The distance between the bounding boxes is a lower bound of the distance between the links.
      const double radii = value_of(links[pair.first].radius) + value_of(links[pair.second].radius);
      if (value_of(distance_of_bounds(boxes[pair.first], boxes[pair.second])) - radii > value_of(nearest.clearance))
        continue;
      if (!std::ranges::binary_search(pairs, ends(pair), {}, ends)) continue;
      const S found = capsule_distance(links[pair.first], links[pair.second]);
      const bool is_first = ends(pair) < std::pair(nearest.first, nearest.second);
      if (const double minimum = value_of(nearest.clearance);
          value_of(found) < minimum || (value_of(found) == minimum && is_first))
        nearest = {found, pair.first, pair.second};
    }
  return nearest;
}

}  // namespace

std::vector<LinkPair> pairs_to_keep_clear(const Graph& graph, const std::vector<LinkNodes>& links) {
  const std::vector<std::vector<std::size_t>> groups = numbered_groups(links);
  std::vector<bool> fixed;
  for (const LinkNodes& link : links) fixed.push_back(is_fixed(graph, link));
  std::vector<LinkPair> pairs;
  pairs.reserve(links.size() * links.size() / 2);
  for (std::size_t i = 0; i < links.size(); ++i)
    for (std::size_t k = i + 1; k < links.size(); ++k)
      if (links[i].has_clearance && links[k].has_clearance && !(fixed[i] && fixed[k]) &&
          !overlap(groups[i], groups[k]) && !share_a_joint(links[i], links[k]))
        pairs.push_back({i, k});
  return pairs;
}

std::vector<std::size_t> moving_links(const Graph& graph, const std::vector<LinkNodes>& links) {
  std::vector<std::size_t> moving;
  for (std::size_t i = 0; i < links.size(); ++i)
    if (links[i].has_clearance && !is_fixed(graph, links[i])) moving.push_back(i);
  return moving;
}

std::vector<JoinedLinks> joined_links(const Model& model) {
  std::vector<JoinedLinks> all;
  if (model.link_pairs.empty()) return all;
  const std::size_t count = model.links.size();
  std::vector<bool> is_pair(count * count);
  for (const auto& [first, second] : model.link_pairs)
    is_pair[first * count + second] = is_pair[second * count + first] = true;
  for (std::size_t i = 0; i < count; ++i) {
    const std::string& name = model.links[i].name;  // the segments of an arc share their name
    auto entry = std::ranges::find(all, name, &JoinedLinks::link);
    if (entry == all.end()) entry = all.insert(entry, {name, {}});
    for (std::size_t k = 0; k < count; ++k) {
      const std::string& other = model.links[k].name;
      if (other != name && !is_pair[i * count + k] && !contains(entry->others, other)) entry->others.push_back(other);
    }
  }
  return all;
}

std::optional<double> clearance_of(const Model& model, const LimitSpec& limits) {
  if (!model.clearance_limit) return {};
  const auto& given = limits.given[*model.clearance_limit];
  return given && *given > kInactiveClearance ? given : std::nullopt;
}

void refuse_clearance(const Model& model, const LimitSpec& limits, const std::string& why) {
  if (clearance_of(model, limits)) throw std::invalid_argument("mechanism " + model.info.name + " " + why);
}

template <class S>
std::vector<Capsule<S>> capsules_at(const Evaluation& e, const std::vector<S>& inputs) {
  const std::vector<S> values = outputs_of(e.links, inputs);
  std::vector<Capsule<S>> links;
  if (!std::ranges::all_of(values, [](const S& x) { return std::isfinite(value_of(x)); })) return links;
  for (auto at = values.begin(); at != values.end(); at += kNumbers)
    links.push_back(capsule_of([&](std::size_t i) { return at[static_cast<std::ptrdiff_t>(i)]; }));
  return links;
}

template <class S>
std::optional<NearestBodies<S>> nearest_bodies(const Evaluation& e, const std::vector<S>& inputs,
                                               const Obstacles& obstacles) {
  const Model& model = e.model;
  if (model.link_pairs.empty() && (obstacles.empty() || model.moving_links.empty())) return {};
  const std::vector<Capsule<S>> links = capsules_at(e, inputs);
  if (links.empty()) return NearestBodies<S>{S(std::nan("")), "", ""};
  const ClosestPair<S> nearest = nearest_pair(links, model.link_pairs);
  const ClosestPair<S> other = nearest_obstacle<S>(links, model.moving_links, obstacles);
  if (value_of(other.clearance) < value_of(nearest.clearance))
    return NearestBodies<S>{other.clearance, model.links[other.first].name, obstacles[other.second].name};
  return NearestBodies<S>{nearest.clearance, model.links[nearest.first].name, model.links[nearest.second].name};
}

template std::vector<Capsule<double>> capsules_at(const Evaluation&, const std::vector<double>&);
template std::optional<NearestBodies<double>> nearest_bodies(const Evaluation&, const std::vector<double>&,
                                                             const Obstacles&);
template std::optional<NearestBodies<Dual4>> nearest_bodies(const Evaluation&, const std::vector<Dual4>&,
                                                            const Obstacles&);

ClearanceBatch::ClearanceBatch(const Evaluation& evaluation, const std::vector<int>& swept, std::size_t mode,
                               double limit, const Obstacles& obstacles)
    : model_(evaluation.model),
      limit_(limit),
      obstacles_(obstacles),
      batch_(evaluation.model, nodes_of(evaluation.model.links), swept, mode) {
  for (std::size_t i = 0; i < kNumbers * evaluation.model.links.size(); ++i) operands_.push_back(batch_.operand(i));
}

void ClearanceBatch::start(const std::vector<double>& inputs, ClearanceScratch& scratch) const {
  batch_.start(inputs, scratch.poses);
  scratch.links.resize(operands_.size() / kNumbers);
  scratch.boxes.resize(scratch.links.size());
}

bool ClearanceBatch::is_clear(std::size_t pose, ClearanceScratch& scratch) const {
  bool finite = true;
  for (std::size_t i = 0; i < scratch.links.size(); ++i)
    scratch.links[i] = capsule_of([&](std::size_t k) {
      const double value = PoseBatch::value(operands_[i * kNumbers + k], pose, scratch.poses);
      finite = finite && std::isfinite(value);
      return value;
    });
  return finite && respects_clearance(scratch.links, model_.link_pairs, limit_, scratch.boxes) &&
         respects_obstacle_clearance(obstacles_, scratch.links, model_.moving_links, limit_);
}

}  // namespace pkm::generic
