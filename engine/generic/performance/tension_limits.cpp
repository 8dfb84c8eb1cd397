#include "engine/generic/performance/tension_limits.hpp"

#include <bit>
#include <limits>

namespace pkm::generic {
namespace {

using expression::Minors, expression::Term, expression::TermMatrix;

/// Determinants that are smaller, relative to the sum of the determinants of a matrix, are rounding errors and count as
/// 0.
constexpr double kRounding = 1e-12;
/// Value that stands for a face that does not exist; it is so large that it restricts nothing.
constexpr double kNoFace = 1e300;

Term smaller(const Term& x, const Term& y) { return call(expression::operation("min"), x, y); }
Term larger(const Term& x, const Term& y) { return call(expression::operation("max"), x, y); }
Term if_greater(const Term& x, const Term& y, const Term& then, const Term& otherwise) {
  expression::Graph& graph = x.graph();
  const expression::Node is_greater = graph.apply(expression::operation(">"), std::array{x.node(), y.node()});
  return {graph, graph.apply(expression::choice(), std::array{is_greater, then.node(), otherwise.node()})};
}

Term sum_of(const std::vector<Term>& terms, expression::Graph& graph) {
  Term sum(graph, 0.0);
  for (const Term& term : terms) sum = sum + term;
  return sum;
}
Term dot(const std::vector<Term>& x, const std::vector<Term>& y) {
  Term sum = x[0] * y[0];
  for (std::size_t i = 1; i < x.size(); ++i) sum = sum + x[i] * y[i];
  return sum;
}

/// A pair of parallel faces of the zonotope of all drive forces that allowed tensions produce.
struct Faces {
  std::vector<Term> normal;
  std::vector<std::size_t> cables;  ///< cables whose columns of the matrix A do not lie in the faces
  std::vector<Term> along;          ///< components of the columns of `cables` along the normal
  Term sum;                         ///< sum of the absolute values of `along`
};

class Zonotope {
 public:
  Zonotope(const TermMatrix& J, const std::vector<std::optional<std::array<Term, 2>>>& tensions)
      : n_(J.columns()), tensions_(tensions), A_(J.transposed() * Term(J.graph(), -1.0)), all_(A_, n_) {
    for (std::size_t i = 0; i < n_; ++i) without_row_.emplace_back(A_, i);
    unsigned unlimited = 0;
    for (std::size_t j = 0; j < tensions.size(); ++j)
      if (!tensions[j]) unlimited |= 1U << j;
    for (unsigned columns = 0; columns < 1U << tensions.size(); ++columns)
      if (static_cast<std::size_t>(std::popcount(columns)) + 1 == n_ && (columns & unlimited) == unlimited)
        faces_.push_back(faces_with(columns));
  }

  expression::Graph& graph() const { return A_.graph(); }

  /// Minimum over all pairs of faces of the value of a pair; -infinity if A does not have full rank.
  template <class Value>
  Term minimum(const Value& value) const {
    Term least(graph(), kNoFace), total(graph(), 0.0), scale(graph(), 1.0);
    for (const Faces& faces : faces_) total = total + faces.sum;
    for (const Faces& faces : faces_)
      least = smaller(least, if_greater(faces.sum, total * kRounding, value(faces), Term(graph(), kNoFace)));
    for (std::size_t i = 0; i < n_; ++i) {
      Term row(graph(), 0.0);
      for (std::size_t j = 0; j < A_.columns(); ++j) row = row + abs(A_(i, j));
      scale = scale * row;
    }
    return if_greater(total, scale * kRounding, least, Term(graph(), -std::numeric_limits<double>::infinity()));
  }

  /// The distance of a set of loads to the nearer face, times the length of the normal.
  Term slack(const Faces& faces, const LoadSet& loads) const {
    Term centre = dot(faces.normal, loads.centre), width(graph(), 0.0);
    for (std::size_t k = 0; k < faces.cables.size(); ++k) {
      const auto& [from, to] = *tensions_[faces.cables[k]];
      centre = centre - faces.along[k] * ((to + from) * 0.5);
      width = width + abs(faces.along[k]) * ((to - from) * 0.5);
    }
    for (const auto& axis : loads.half_axes) width = width - abs(dot(faces.normal, axis));
    return width - abs(centre);
  }

 private:
  Faces faces_with(unsigned columns) {
    Faces faces{{}, {}, {}, Term(graph(), 0.0)};
    for (std::size_t i = 0; i < n_; ++i) {
      const Term minor = without_row_[i].of(columns);
      faces.normal.push_back(i % 2 == 0 ? minor : -minor);
    }
    for (std::size_t j = 0; j < A_.columns(); ++j) {
      if ((columns >> j & 1U) != 0) continue;
      // The scalar product of the normal and column j is the determinant of column j followed by the other columns.
      const Term determinant = all_.of(columns | 1U << j);
      const bool is_odd = std::popcount(columns & ((1U << j) - 1)) % 2 != 0;
      faces.cables.push_back(j);
      faces.along.push_back(is_odd ? -determinant : determinant);
      faces.sum = faces.sum + abs(determinant);
    }
    return faces;
  }

  std::size_t n_;
  const std::vector<std::optional<std::array<Term, 2>>>& tensions_;
  TermMatrix A_;
  Minors all_;
  std::vector<Minors> without_row_;
  std::vector<Faces> faces_;
};

/// The tension factor as far as a pair of faces limits it: tensions between r and 1 balance each other if
/// r P <= N and r N <= P, where P and N are the sums of the positive and of the negative components along the normal.
Term factor_of(const Faces& faces) {
  expression::Graph& graph = faces.sum.graph();
  Term largest = faces.along[0], smallest = faces.along[0];
  for (const Term& each : faces.along) {
    largest = larger(largest, each);
    smallest = smaller(smallest, each);
  }
  const Term sum = sum_of(faces.along, graph), positive = faces.sum + sum, negative = faces.sum - sum;
  // The ratio `sides` is not positive if no two components along the normal have opposite signs.
  const Term sides = smaller(largest, -smallest) / larger(largest, -smallest);
  const Term rounding(graph, kRounding);
  return if_greater(sides, rounding, smaller(positive, negative) / larger(positive, negative), sides - rounding * 2);
}

}  // namespace

TensionBalance tension_balance(const TermMatrix& J, const TermMatrix& translation,
                               const std::vector<std::optional<std::array<Term, 2>>>& tensions,
                               const std::vector<LoadSet>& loads) {
  const Zonotope zonotope(J, tensions);
  const auto slack = [&](const Faces& faces) {
    Term least = zonotope.slack(faces, loads.front());
    for (std::size_t i = 1; i < loads.size(); ++i) least = smaller(least, zonotope.slack(faces, loads[i]));
    return least;
  };
  const Term reserve = zonotope.minimum([&](const Faces& faces) { return slack(faces) / faces.sum; });
  TensionBalance balance{zonotope.minimum(factor_of), reserve, {}};
  if (translation.rows() == 0) return balance;
  balance.capacity = zonotope.minimum([&](const Faces& faces) {
    Term square(zonotope.graph(), 0.0);
    for (std::size_t i = 0; i < translation.rows(); ++i) {
      Term along(zonotope.graph(), 0.0);
      for (std::size_t j = 0; j < faces.normal.size(); ++j) along = along + translation(i, j) * faces.normal[j];
      square = square + along * along;
    }
    // A face whose normal is a pure moment does not limit the force.
    const Term zero(zonotope.graph(), 0.0);
    return if_greater(square, zero, slack(faces) / sqrt(square), Term(zonotope.graph(), kNoFace));
  });
  return balance;
}

}  // namespace pkm::generic
