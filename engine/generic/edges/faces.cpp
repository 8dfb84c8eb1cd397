#include "engine/generic/edges/faces.hpp"

namespace pkm::generic::edges {
namespace {

bool has_range(const Body& body) { return body.kind == Body::Kind::slide || body.kind == Body::Kind::crank; }

bool is_up_to_half_turn(const Body& body) { return body.kind == Body::Kind::slide || body.to - body.from <= kPi; }

using Bits = std::array<bool, kFunctions>;

/// Whether a point belongs to the body of a slide or crank, by the rule of limbs::CrankRange. A slide is treated like a
/// crank whose range is less than half a revolution.
/// @param is  is[i]: whether function i of the body (see function()) is positive at the point
bool is_in_body(const Bits& is, bool is_first_root, bool half_turn) {
  const bool after_from = is[2], before_to = !is[3];
  if (is[0] != is[1]) return is_first_root == is[0];
  if (!is[4]) return false;
  if (is[0]) return half_turn ? after_from && before_to : after_from || before_to;
  return half_turn ? !after_from && !before_to : !after_from || !before_to;
}

bool is_on_face(const Bits& is, Part part, bool is_first_root, bool half_turn) {
  if (part != Part::fold) return is[part == Part::first ? 2 : 3] == is_first_root;
  const bool after_from = is[2] == is[5], before_to = is[3] != is[5];
  return half_turn ? after_from && before_to : after_from || before_to;
}

template <class Holds>
Rule rule_of(const Holds& holds) {
  Rule rule;
  for (std::size_t code = 0; code < 64; ++code) {
    Bits is{};
    for (std::size_t i = 0; i < kFunctions; ++i) is[i] = (code >> i & 1) != 0;
    if (holds(is)) rule.holds |= SignSets{1} << code;
  }
  for (std::size_t code = 0; code < 64; ++code)
    for (std::size_t i = 0; i < kFunctions; ++i)
      if (((rule.holds >> code ^ rule.holds >> (code ^ std::size_t{1} << i)) & 1) != 0)
        rule.depends[i] |= SignSets{1} << code;
  return rule;
}

}  // namespace

PreparedBody::PreparedBody(const Body& body) : Body(body) {
  height = {axis, kind == Kind::plane ? 0 : -dot(axis, centre)};
  distance = {centre * -2.0, dot(centre, centre) + crank * crank - radius * radius};
  if (!has_range(body)) return;
  if (kind == Kind::crank) beside = cross(axis, zero);
  for (std::size_t e = 0; e < 2; ++e) {
    const double q = e == 0 ? from : to;
    const auto [s, c] = portable::sincos(q);
    end[e] = centre + (kind == Kind::slide ? axis * q : zero * (crank * c) + beside * (crank * s));
    along[e] = kind == Kind::slide ? axis : beside * c - zero * s;
    from_end[e] = {end[e] * -2.0, dot(end[e], end[e]) - radius * radius};
    ahead[e] = {along[e], -dot(along[e], end[e])};
  }
}

void add_faces(const PreparedBody& body, std::size_t number, std::vector<Face>& faces) {
  Face face{.body = &body, .number = number, .centre = body.centre, .side = body.side};
  switch (body.kind) {
    case Body::Kind::plane:
      face.centre = body.axis * body.radius;
      face.side = 1;
      break;
    case Body::Kind::sphere:
      face.surface = Surface::sphere;
      break;
    case Body::Kind::cylinder:
      face.surface = Surface::cylinder;
      break;
    case Body::Kind::slide:
    case Body::Kind::crank:
      for (const Part part : {Part::first, Part::second}) {
        const auto e = static_cast<std::size_t>(part);
        const double sign = body.is_first_root ? 1 : -1;
        face.part = part;
        face.surface = Surface::sphere;
        face.centre = body.end[e];
        face.side = e == 0 ? -sign : sign;
        face.away_from_pole = body.along[e] * sign;
        faces.push_back(face);
      }
      face = {.body = &body,
              .number = number,
              .part = Part::fold,
              .surface = body.kind == Body::Kind::slide ? Surface::cylinder : Surface::torus,
              .centre = body.centre};
  }
  faces.push_back(face);
}

std::size_t degree(const Body& body, std::size_t function) {
  if (!has_range(body)) return body.kind == Body::Kind::plane ? 1 : 2;
  return function == 2 || function == 3 ? 1 : function == 4 && body.kind == Body::Kind::crank ? 4 : 2;
}

Enclosure function(const PreparedBody& body, std::size_t number, const CurvePoint& at) {
  const auto value = [&](const Affine& f) { return dot(at.p, f.v) + f.k; };
  const auto distance = [&](const Affine& f) { return at.square + value(f); };
  switch (body.kind) {
    case Body::Kind::plane:
      return -value(body.height) + body.radius;
    case Body::Kind::sphere:
      return distance(body.distance) * -body.side;
    case Body::Kind::cylinder:
      return (square(value(body.height)) - distance(body.distance)) * body.side;
    case Body::Kind::slide:
    case Body::Kind::crank:
      break;
  }
  if (number < 2) return distance(body.from_end[number]);
  if (number < 4) return value(body.ahead[number - 2]);
  const bool is_slide = body.kind == Body::Kind::slide;
  if (is_slide && number == 5) return {1};
  const Enclosure K = distance(body.distance);
  if (number == 5) return K;
  const Enclosure Y_2 = square(value(body.height));
  if (is_slide) return Y_2 - K;
  const double l_2 = body.crank * body.crank;
  return (K - Y_2 + (body.radius * body.radius - l_2)) * (4 * l_2) - square(K);
}

const Rule& membership(const Body& body, const Part* face) {
  static const Rule single = rule_of([](const Bits& is) { return is[0]; });
  // Membership rules by three indices: is_first_root; whether the range is at most half a turn; 0 for the body, or 1 +
  // Part for a part of its boundary.
  static const auto rules = [] {
    std::array<std::array<std::array<Rule, 4>, 2>, 2> all;
    for (const bool first : {false, true})
      for (const bool half : {false, true})
        for (std::size_t i = 0; i < 4; ++i)
          all[first][half][i] = rule_of([&](const Bits& is) {
            return i == 0 ? is_in_body(is, first, half) : is_on_face(is, static_cast<Part>(i - 1), first, half);
          });
    return all;
  }();
  if (!has_range(body)) return single;
  return rules[body.is_first_root][is_up_to_half_turn(body)][face ? static_cast<std::size_t>(*face) + 1 : 0];
}

Vector3 outward(const Face& face, const Vector3& p) {
  const PreparedBody& body = *face.body;
  const Vector3 P = p - face.centre;
  switch (face.surface) {
    case Surface::plane:
      return body.axis;
    case Surface::sphere:
      return P * face.side;
    case Surface::cylinder:
      return (P - body.axis * dot(P, body.axis)) * face.side;
    case Surface::torus: {  // the normal is minus the gradient of the discriminant
      const double l = body.crank, K = dot(P, P) + l * l - body.radius * body.radius;
      return P * K - (P - body.axis * dot(P, body.axis)) * (2 * l * l);
    }
  }
  return {};
}

void Moments::add(const Moments& other, double factor) {
  normal += other.normal * factor;
  rotation += other.rotation * factor;
  for (std::size_t i = 0; i < radius.size(); ++i) radius[i] += other.radius[i] * factor;
}

Moments forms(const Face& face, const Vector3& p, const Vector3& dp) {
  const PreparedBody& body = *face.body;
  const Vector3 P = p - face.centre;
  Moments m{.normal = cross(P, dp) * 0.5, .rotation = dp * (-0.5 * dot(P, P)), .radius = {}};
  switch (face.surface) {
    case Surface::plane:
      break;
    case Surface::sphere: {
      const Vector3& t = face.away_from_pole;
      m.radius[0] = dot(cross(t, P), dp) / (1 + dot(t, P) / body.radius);
      break;
    }
    case Surface::cylinder: {
      const double s = dot(P, body.axis);
      m.radius[0] = -s * dot(cross(body.axis, P), dp) / body.radius;
      break;
    }
    case Surface::torus: {
      const double u = dot(P, body.zero), w = dot(P, body.beside), l = body.crank, rod = body.radius;
      // Sign (1 or -1) of crank + rod cos b, the signed distance of the point from the axis of the torus.
      const double outer = dot(P, P) + l * l > rod * rod ? 1 : -1;
      const double distance = outer * std::sqrt(u * u + w * w);
      if (distance == 0) break;
      const double ddistance = (u * dot(dp, body.zero) + w * dot(dp, body.beside)) / distance;
      const double cosine = (distance - l) / rod, sine = dot(P, body.axis) / rod;
      const double middle = 0.5 * (body.from + body.to);
      const auto [s, c] = portable::sincos(middle);
      const double q = portable::atan2(outer * (w * c - u * s), outer * (u * c + w * s));
      // derivative of the angle b with respect to the parameter of the edge, multiplied by the length of the rod
      const double db = cosine * dot(dp, body.axis) - sine * ddistance;
      m.radius = {q * distance * db, q * distance * cosine * db};
      break;
    }
  }
  return m;
}

double three_volumes(const Face& face, const Moments& m) {
  const PreparedBody& body = *face.body;
  return dot(face.centre, m.normal) + body.radius * m.radius[0] + body.crank * m.radius[1];
}

}  // namespace pkm::generic::edges
