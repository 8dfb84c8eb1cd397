#include "engine/generic/edges/faces.hpp"

namespace pkm::generic::edges {
namespace {

bool has_range(const Body& body) { return body.kind == Body::Kind::slide || body.kind == Body::Kind::crank; }

bool is_up_to_half_turn(const Body& body) { return body.kind == Body::Kind::slide || body.to - body.from <= kPi; }

using Bits = std::array<bool, kFunctions>;

/// As limbs::CrankRange; the range of a slide is one of less than half a revolution.
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

/// Membership for all 3^6 combinations of signs.
using Table = std::array<Membership, 729>;

template <class Rule>
Table table_of(const Rule& rule) {
  Table table;
  for (std::size_t code = 0; code < table.size(); ++code) {
    std::array<int, kFunctions> sign{};
    for (std::size_t i = 0, rest = code; i < kFunctions; ++i, rest /= 3) sign[i] = static_cast<int>(rest % 3) - 1;
    Membership found{0, 0};
    bool may_be_in = false, may_be_out = false;
    for (unsigned all = 0; all < (1U << kFunctions); ++all) {
      Bits is{};
      bool agrees = true;
      for (std::size_t i = 0; i < kFunctions; ++i) {
        is[i] = ((all >> i) & 1U) != 0;
        agrees = agrees && (sign[i] == 0 || is[i] == (sign[i] > 0));
      }
      if (!agrees) continue;
      const bool in = rule(is);
      (in ? may_be_in : may_be_out) = true;
      for (std::size_t i = 0; i < kFunctions; ++i) {
        Bits other = is;
        other[i] = !is[i];
        if (sign[i] == 0 && rule(other) != in) found.relevant = static_cast<std::uint8_t>(found.relevant | (1U << i));
      }
    }
    found.result = static_cast<std::int8_t>(may_be_in && may_be_out ? 0 : may_be_in ? 1 : -1);
    table[code] = found;
  }
  return table;
}

/// By root, half turn, and the body or the part of its boundary.
const Table& table(bool is_first_root, bool half_turn, std::size_t what) {
  static const auto tables = [] {
    std::array<std::array<std::array<Table, 4>, 2>, 2> all;
    for (const bool first : {false, true})
      for (const bool half : {false, true})
        for (std::size_t i = 0; i < 4; ++i)
          all[first][half][i] = table_of([&](const Bits& is) {
            return i == 0 ? is_in_body(is, first, half) : is_on_face(is, static_cast<Part>(i - 1), first, half);
          });
    return all;
  }();
  return tables[is_first_root][half_turn][what];
}

}  // namespace

PreparedBody::PreparedBody(const Body& body) : Body(body) {
  if (kind == Kind::crank) beside = cross(axis, zero);
  for (std::size_t e = 0; e < 2; ++e) {
    const double q = e == 0 ? from : to;
    const auto [s, c] = portable::sincos(q);
    end[e] = centre + (kind == Kind::slide ? axis * q : zero * (crank * c) + beside * (crank * s));
    along[e] = kind == Kind::slide ? axis : beside * c - zero * s;
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

std::size_t count_functions(const Body& body) { return has_range(body) ? kFunctions : 1; }

int degree(const Body& body, std::size_t function) {
  if (!has_range(body)) return body.kind == Body::Kind::plane ? 1 : 2;
  return function == 2 || function == 3 ? 1 : function == 4 && body.kind == Body::Kind::crank ? 4 : 2;
}

void evaluate(const PreparedBody& body, const Enclosure3& p, Functions& f) {
  if (body.kind == Body::Kind::plane) {
    f[0] = -dot(p, body.axis) + body.radius;
    return;
  }
  const Enclosure3 P = p - body.centre;
  const Enclosure squares = square(P[0]) + square(P[1]) + square(P[2]);
  const double rod_2 = body.radius * body.radius;
  switch (body.kind) {
    case Body::Kind::plane:
      break;
    case Body::Kind::sphere:
      f[0] = (-squares + rod_2) * body.side;
      break;
    case Body::Kind::cylinder:
      f[0] = (square(dot(P, body.axis)) - squares + rod_2) * body.side;
      break;
    case Body::Kind::slide: {
      const Enclosure s = dot(P, body.axis);
      const Enclosure distance = squares - rod_2;
      f[0] = distance - s * (2 * body.from) + body.from * body.from;
      f[1] = distance - s * (2 * body.to) + body.to * body.to;
      f[2] = s - body.from;
      f[3] = s - body.to;
      f[4] = square(s) - distance;
      f[5] = Enclosure(1);
      break;
    }
    case Body::Kind::crank: {
      const double l = body.crank;
      const Enclosure K = squares + (l * l - rod_2), along_axis = dot(P, body.axis);
      for (std::size_t e = 0; e < 2; ++e) {
        f[e] = K - dot(P, body.end[e] - body.centre) * 2.0;
        f[2 + e] = dot(P, body.along[e]);
      }
      f[4] = (squares - square(along_axis)) * (4 * l * l) - square(K);
      f[5] = K;
      break;
    }
  }
}

Membership membership(const Body& body, const Part* face, const std::array<std::int8_t, kFunctions>& signs) {
  if (!has_range(body)) return face ? Membership{1, 0} : Membership{signs[0], static_cast<std::uint8_t>(signs[0] == 0)};
  std::size_t code = 0;
  for (std::size_t i = kFunctions; i-- > 0;) code = 3 * code + static_cast<std::size_t>(signs[i] + 1);
  return table(body.is_first_root, is_up_to_half_turn(body), face ? static_cast<std::size_t>(*face) + 1 : 0)[code];
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
    case Surface::torus: {  // minus the gradient of the discriminant
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
      const double outer = dot(P, P) + l * l > rod * rod ? 1 : -1;  // the sign of the distance from the axis
      const double distance = outer * std::sqrt(u * u + w * w);
      const double ddistance = (u * dot(dp, body.zero) + w * dot(dp, body.beside)) / distance;
      const double cosine = (distance - l) / rod, sine = dot(P, body.axis) / rod;
      const double middle = 0.5 * (body.from + body.to);
      const auto [s, c] = portable::sincos(middle);
      const double q = portable::atan2(outer * (w * c - u * s), outer * (u * c + w * s));
      const double db = cosine * dot(dp, body.axis) - sine * ddistance;  // times the rod
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
