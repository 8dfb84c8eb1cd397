#include "engine/expression/polynomial_form.hpp"

#include <algorithm>
#include <cstdint>
#include <initializer_list>
#include <span>

#include "engine/math/scalar.hpp"

namespace pkm::expression {
namespace {

// Maximum number of coefficients of intermediate polynomials; the square of a quadratic has 5.
constexpr std::size_t kMaxCoefficients = 5;
// Maximum nesting depth, and maximum number of nodes visited; a constraint that exceeds one of them is not converted.
constexpr int kMaxDepth = 500, kMaxSteps = 100'000;

/// Coefficients of a polynomial in z, constant term first; an empty list is the polynomial 0.
class Coefficients {
 public:
  std::size_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  Node& operator[](std::size_t i) { return c_[i]; }
  Node operator[](std::size_t i) const { return c_[i]; }
  auto begin() { return c_.begin(); }
  auto end() { return c_.begin() + size_; }
  auto begin() const { return c_.begin(); }
  auto end() const { return c_.begin() + size_; }
  void resize(std::size_t size) { size_ = static_cast<std::uint8_t>(size); }

 private:
  std::array<Node, kMaxCoefficients> c_{};
  std::uint8_t size_ = 0;
};

/// The radical form A + B sqrt(Q) of a node, where A, B and Q are polynomials in z.
struct RadicalForm {
  Coefficients A, B;
  Node radicand{};  ///< the node Q under the root; meaningful only if B is not 0
  Coefficients Q;
};

class NormalForm {
 public:
  NormalForm(Graph& graph, Groups z, std::size_t degree, bool squares, const std::vector<bool>& nonnegative)
      : graph_(graph), z_(z), degree_(degree), squares_(squares), nonnegative_(nonnegative) {}

  /// The radical form of a node; std::nullopt if it has none. The graph is traversed depth-first with an explicit stack
  /// and a cache, because a node may depend on 10^5 others, and on each of them in several ways.
  std::optional<RadicalForm> form(Node root) {
    std::vector<Node> stack = {root};
    while (!stack.empty()) {
      const Node node = stack.back();
      const std::span<const Node> operands = is_known(node) ? std::span<const Node>() : operands_of_form(node);
      const auto next = std::ranges::find_if(operands, [&](Node operand) { return !is_known(operand); });
      if (next != operands.end()) {
        stack.push_back(*next);
        continue;
      }
      stack.pop_back();
      if (is_known(node)) continue;
      const auto combined = combine_forms(node);
      forms_.push_back(combined);
      index_.resize(graph_.size());
      index_[static_cast<std::size_t>(node)] = static_cast<std::uint32_t>(forms_.size());
    }
    return known_form(root);
  }

  /// The constraint node >= 0 in conjunctive normal form; std::nullopt if it has no such form or exceeds the limits.
  std::optional<std::vector<Clause>> clauses(Node node) {
    if (depth_ > kMaxDepth || ++steps_ > kMaxSteps) return {};
    ++depth_;
    auto found = convert(node);
    --depth_;
    return found;
  }

 private:
  using Clauses = std::optional<std::vector<Clause>>;

  bool is_known(Node node) const {
    const auto i = static_cast<std::size_t>(node);
    return i < index_.size() && index_[i] != 0;
  }
  const std::optional<RadicalForm>& known_form(Node node) const {
    return forms_[index_[static_cast<std::size_t>(node)] - 1];
  }

  /// The operands of a node whose radical forms combine_forms() needs to find that of the node.
  std::span<const Node> operands_of_form(Node node) const {
    const Entry& entry = graph_[node];
    if ((entry.groups & z_) == 0 || !entry.operation) return {};
    switch (entry.operation->code) {
      case Code::add:
      case Code::subtract:
      case Code::multiply:
        return entry.operands();
      case Code::divide:
        if ((graph_[entry.arguments[1]].groups & z_) != 0) return {};
        [[fallthrough]];
      case Code::negate:
      case Code::sqrt:
      case Code::abs:
        return entry.operands().first(1);
      default:
        return {};
    }
  }
  Term term(Node node) const { return {graph_, node}; }
  /// The polynomial with these coefficients, without leading zeros.
  Coefficients polynomial_of(std::initializer_list<Term> c) const {
    Coefficients p;
    for (const Term& each : c) {
      p.resize(p.size() + 1);
      p[p.size() - 1] = each.node();
    }
    return trimmed(p);
  }
  Coefficients trimmed(Coefficients p) const {
    while (!p.empty() && term(p[p.size() - 1]).is(0)) p.resize(p.size() - 1);
    return p;
  }
  Coefficients sum(const Coefficients& p, const Coefficients& q) const {
    Coefficients r = p.size() >= q.size() ? p : q;
    const Coefficients& shorter = p.size() >= q.size() ? q : p;
    for (std::size_t i = 0; i < shorter.size(); ++i) r[i] = (term(p[i]) + term(q[i])).node();
    return trimmed(r);
  }
  Coefficients negated(Coefficients p) const {
    for (Node& c : p) c = (-term(c)).node();
    return p;
  }
  std::optional<Coefficients> product(const Coefficients& p, const Coefficients& q) const {
    if (p.empty() || q.empty()) return Coefficients();
    if (p.size() + q.size() - 1 > kMaxCoefficients) return {};
    Coefficients r;
    r.resize(p.size() + q.size() - 1);
    std::ranges::fill(r, graph_.number(0));
    for (std::size_t i = 0; i < p.size(); ++i)
      for (std::size_t j = 0; j < q.size(); ++j) r[i + j] = (term(r[i + j]) + term(p[i]) * term(q[j])).node();
    return trimmed(r);
  }

  /// The radical form of a node from the cached forms of its operands.
  std::optional<RadicalForm> combine_forms(Node node) {
    const Entry entry = graph_[node];
    if ((entry.groups & z_) == 0) return RadicalForm{.A = polynomial_of({term(node)}), .B = {}, .Q = {}};
    if (entry.input >= 0)
      return RadicalForm{.A = polynomial_of({Term(graph_, 0.0), Term(graph_, 1.0)}), .B = {}, .Q = {}};
    switch (entry.operation->code) {
      case Code::add:
      case Code::subtract: {
        auto x = known_form(entry.arguments[0]), y = known_form(entry.arguments[1]);
        if (!x || !y) return {};
        if (entry.operation->code == Code::subtract) y = RadicalForm{negated(y->A), negated(y->B), y->radicand, y->Q};
        if (!x->B.empty() && !y->B.empty() && x->radicand != y->radicand) return {};
        const RadicalForm& radical = x->B.empty() ? *y : *x;
        return RadicalForm{sum(x->A, y->A), sum(x->B, y->B), radical.radicand, radical.Q};
      }
      case Code::negate: {
        const auto& x = known_form(entry.arguments[0]);
        if (!x) return {};
        return RadicalForm{negated(x->A), negated(x->B), x->radicand, x->Q};
      }
      case Code::multiply:
        return times(known_form(entry.arguments[0]), known_form(entry.arguments[1]));
      case Code::divide: {
        if ((graph_[entry.arguments[1]].groups & z_) != 0) return {};
        const Term divisor(graph_, entry.arguments[1]);
        auto x = known_form(entry.arguments[0]);
        if (!x) return {};
        for (Coefficients* p : {&x->A, &x->B})
          for (Node& c : *p) c = (term(c) / divisor).node();
        return x;
      }
      case Code::sqrt: {
        const auto& x = known_form(entry.arguments[0]);
        if (!x || !x->B.empty()) return {};
        return RadicalForm{.A = {}, .B = polynomial_of({Term(graph_, 1.0)}), .radicand = entry.arguments[0], .Q = x->A};
      }
      case Code::abs: {  // |b sqrt(Q)| is replaced by |b| sqrt(Q)
        const auto& x = known_form(entry.arguments[0]);
        if (!squares_ || !x || !x->A.empty() || x->B.size() != 1) return {};
        return RadicalForm{.A = {}, .B = polynomial_of({abs(term(x->B[0]))}), .radicand = x->radicand, .Q = x->Q};
      }
      default:
        return {};
    }
  }

  Clauses convert(Node node) {
    const Entry entry = graph_[node];
    if ((entry.groups & z_) != 0 && entry.operation) {
      const Code code = entry.operation->code;
      if (code == Code::min) return conjunction(clauses(entry.arguments[0]), clauses(entry.arguments[1]));
      if (code == Code::max) return disjunction(clauses(entry.arguments[0]), clauses(entry.arguments[1]));
      if (code == Code::subtract) {
        const Term x(graph_, entry.arguments[0]), y(graph_, entry.arguments[1]);
        if (auto found = squares_ ? clauses_of_form(node) : std::nullopt) return found;
        if (const auto inner = inside_of_abs(y))  // the constraint is x - |u| >= 0
          return conjunction(clauses((x - *inner).node()), clauses((x + *inner).node()));
        if (const auto inner = inside_of_abs(x))  // the constraint is |u| - y >= 0
          return disjunction(clauses((*inner - y).node()), clauses((-*inner - y).node()));
        if (auto found = squares_ ? clauses_of_moved(x, y) : std::nullopt) return found;
      }
    }
    if (auto found = clauses_of_form(node)) return found;
    if (auto found = squares_ ? clauses_of_squares(node) : std::nullopt) return found;
    return clauses_of_multiple(node);
  }

  /// Converts x - y >= 0, where one of x and y is a minimum or a maximum, and the other one does not depend on z.
  Clauses clauses_of_moved(const Term& x, const Term& y) {
    const bool is_first = is_independent(y);
    if (!is_first && !is_independent(x)) return {};
    const Entry entry = graph_[(is_first ? x : y).node()];
    const Code code = entry.operation ? entry.operation->code : Code::other;
    if (code != Code::min && code != Code::max) return {};
    const Term a(graph_, entry.arguments[0]), b(graph_, entry.arguments[1]);
    const Clauses first = clauses((is_first ? a - y : x - a).node()),
                  second = clauses((is_first ? b - y : x - b).node());
    return (code == Code::min) == is_first ? conjunction(first, second) : disjunction(first, second);
  }

  /// Converts c f >= 0 and f / c >= 0, where c does not depend on z but f contains minima, maxima or absolute values,
  /// to (f >= 0 or -c >= 0) and (-f >= 0 or c >= 0). Sums c x + c y and c x - c y are converted in the same way.
  Clauses clauses_of_multiple(Node node) {
    const Entry entry = graph_[node];
    if (!entry.operation) return {};
    const Term x(graph_, entry.arguments[0]), y(graph_, entry.arguments[1]);
    const auto multiple = [&](const Term& c, const Term& f) {
      if (c.is(0)) return Clauses();
      if (graph_[c.node()].is_number()) return graph_[c.node()].number > 0 ? clauses(f.node()) : clauses_of_negative(f);
      return conjunction(disjunction(clauses(f.node()), clauses((-c).node())),
                         disjunction(clauses_of_negative(f), clauses(c.node())));
    };
    const Code code = entry.operation->code;
    if (code == Code::negate) return clauses_of_negative(x);
    if (code == Code::multiply && is_independent(x)) return multiple(x, y);
    if ((code == Code::multiply || code == Code::divide) && is_independent(y)) return multiple(y, x);
    const Entry p = graph_[x.node()], q = graph_[y.node()];
    const auto is_product = [](const Entry& e) { return e.operation && e.operation->code == Code::multiply; };
    if ((code != Code::add && code != Code::subtract) || !is_product(p) || !is_product(q)) return {};
    for (const std::size_t i : {0, 1})
      for (const std::size_t j : {0, 1})
        if (const Term c(graph_, p.arguments[i]); c.node() == q.arguments[j] && is_independent(c)) {
          const Term a(graph_, p.arguments[1 - i]), b(graph_, q.arguments[1 - j]);
          return multiple(c, code == Code::add ? a + b : a - b);
        }
    return {};
  }
  /// Converts -f >= 0 for a difference, minimum or maximum f.
  Clauses clauses_of_negative(const Term& f) {
    const Entry entry = graph_[f.node()];
    const Code code = entry.operation ? entry.operation->code : Code::other;
    const Term x(graph_, entry.arguments[0]), y(graph_, entry.arguments[1]);
    if (code == Code::subtract) return clauses((y - x).node());
    if (code == Code::min) return disjunction(clauses((-x).node()), clauses((-y).node()));
    if (code == Code::max) return conjunction(clauses((-x).node()), clauses((-y).node()));
    return {};
  }

  /// Sufficient test: true if a node is >= 0 for all inputs, because it is composed of non-negative constants, squares,
  /// roots and absolute values by sums, products and quotients.
  bool is_nonnegative(Node root) const {
    std::vector<Node> stack = {root};
    for (int steps = 0; !stack.empty(); ++steps) {
      if (steps > kMaxSteps) return false;
      const Entry& entry = graph_[stack.back()];
      stack.pop_back();
      const Code code = entry.operation ? entry.operation->code : Code::other;
      if (entry.is_number() ? entry.number >= 0 : code == Code::sqrt || code == Code::abs) continue;
      if (entry.input >= 0 && static_cast<std::size_t>(entry.input) < nonnegative_.size() &&
          nonnegative_[static_cast<std::size_t>(entry.input)])
        continue;
      if (code == Code::multiply && entry.arguments[0] == entry.arguments[1]) continue;
      if (code != Code::multiply && code != Code::add && code != Code::divide) return false;
      stack.insert(stack.end(), entry.operands().begin(), entry.operands().end());
    }
    return true;
  }

  /// Returns -f; if f is a negation, or a product or quotient with a negative number, this is f without the minus sign.
  Node negated_factor(Node f) const {
    const Entry entry = graph_[f];
    const Code code = entry.operation ? entry.operation->code : Code::other;
    if (code == Code::negate) return entry.arguments[0];
    if (code == Code::multiply || code == Code::divide)
      for (const std::size_t i : {0, 1})
        if (const Entry& factor = graph_[entry.arguments[i]]; factor.is_number() && factor.number < 0) {
          const Term positive(graph_, -factor.number), other(graph_, entry.arguments[1 - i]);
          return (code == Code::multiply ? positive * other : i == 0 ? positive / other : other / positive).node();
        }
    return (-Term(graph_, f)).node();
  }

  /// Converts A + B sqrt(Q) >= 0, where B does not depend on z.
  Clauses clauses_of_form(Node node) {
    const auto f = form(node);
    if (!f) return {};
    if (f->B.empty()) return clause({f->A});
    const auto BB = product(f->B, f->B), AA = product(f->A, f->A);
    if (!BB || !AA) return {};
    const auto BBQ = product(*BB, f->Q);
    if (!BBQ) return {};
    if (f->B.size() != 1) return {};
    const Term b = term(f->B[0]);
    if (is_nonnegative(negated_factor(b.node()))) return conjunction(clause({f->A}), clause({sum(*AA, negated(*BBQ))}));
    if (is_nonnegative(b.node())) return clause({f->A, sum(*BBQ, negated(*AA))});
    if (!squares_) return {};
    // If the sign of B is unknown, combine the two cases B >= 0 and B <= 0 in conjunctive normal form.
    const Coefficients R = sum(*AA, negated(*BBQ));
    return conjunction(conjunction(clause({f->A, f->B}), clause({f->A, negated(R)})), clause({f->B, R}));
  }

  bool is_independent(const Term& x) const { return (graph_[x.node()].groups & z_) == 0; }

  /// The polynomial Y - u^2, where Y does not depend on z, and u may.
  struct SquareBound {
    Term Y, u;
  };
  std::optional<SquareBound> square_bound(Node node) {
    const Entry entry = graph_[node];
    if (!entry.operation || entry.operation->code != Code::subtract) return {};
    const Term Y(graph_, entry.arguments[0]);
    const Entry square = graph_[entry.arguments[1]];
    if (!is_independent(Y) || !square.operation || square.operation->code != Code::multiply ||
        square.arguments[0] != square.arguments[1])
      return {};
    return SquareBound{Y, Term(graph_, square.arguments[0])};
  }
  /// X + sqrt(P) or X - sqrt(P), where the term X does not depend on z, and P is any node.
  struct RootSum {
    Term X;
    bool plus;  ///< true: X + sqrt(P); false: X - sqrt(P)
    Node P;
  };
  std::optional<RootSum> root_sum(Node node, int depth = 0) {
    const Entry entry = graph_[node];
    if (!entry.operation || depth > kMaxDepth) return {};
    const Code code = entry.operation->code;
    if (code == Code::sqrt) return RootSum{Term(graph_, 0.0), true, entry.arguments[0]};
    if (code != Code::add && code != Code::subtract && code != Code::negate) return {};
    const Term x(graph_, entry.arguments[0]);
    if (code == Code::negate) {
      const auto inner = root_sum(x.node(), depth + 1);
      return inner ? std::optional(RootSum{-inner->X, !inner->plus, inner->P}) : std::nullopt;
    }
    const Term y(graph_, entry.arguments[1]);
    const bool adds = code == Code::add;
    if (is_independent(y)) {
      const auto inner = root_sum(x.node(), depth + 1);
      return inner ? std::optional(RootSum{adds ? inner->X + y : inner->X - y, inner->plus, inner->P}) : std::nullopt;
    }
    const auto inner = is_independent(x) ? root_sum(y.node(), depth + 1) : std::nullopt;
    return inner ? std::optional(RootSum{adds ? x + inner->X : x - inner->X, inner->plus == adds, inner->P})
                 : std::nullopt;
  }

  /// Converts |u| <= sqrt(Y) to the two constraints sqrt(Y) - u >= 0 and sqrt(Y) + u >= 0, which are linear in u.
  Clauses abs_at_most(const Term& u, const Term& Y) {
    const Entry entry = graph_[Y.node()];
    const bool is_square =
        entry.operation && entry.operation->code == Code::multiply && entry.arguments[0] == entry.arguments[1];
    const Term root = is_square ? abs(Term(graph_, entry.arguments[0])) : sqrt(Y);
    return conjunction(clauses((root - u).node()), clauses((root + u).node()));
  }
  /// Converts the disjunction "|u| >= sqrt(Y) or Y <= 0".
  Clauses abs_at_least(const Term& u, const Term& Y) {
    const Term root = sqrt(Y);
    return disjunction(clauses((-Y).node()), disjunction(clauses((u - root).node()), clauses((-u - root).node())));
  }
  /// Converts lower and upper bounds c of a quotient or of an angle, where c does not depend on z: N / w - c >= 0 and
  /// c - N / w >= 0 with a square root w, acos(q) - c >= 0 and c - acos(q) >= 0. acos(q) >= 0 itself holds wherever
  /// acos(q) is defined.
  Clauses clauses_of_quotient(Node node) {
    const Entry entry = graph_[node];
    if (entry.operation == &operation("acos")) return std::vector<Clause>{};
    if (!entry.operation || entry.operation->code != Code::subtract) return {};
    Term x(graph_, entry.arguments[0]), y(graph_, entry.arguments[1]);
    const bool is_lower = is_independent(y);  // true: c is a lower bound of the other operand; false: an upper bound
    if (!is_lower && !is_independent(x)) return {};
    const Term c = is_lower ? y : x, value = is_lower ? x : y;
    const Entry of = graph_[value.node()];
    if (!of.operation) return {};
    if (of.operation == &operation("acos")) {
      const Term cosine(graph_, of.arguments[0]), pi(graph_, kPi);
      const Term difference = is_lower ? cos(c) - cosine : cosine - cos(c);
      return is_lower
                 ? disjunction(clauses((-c).node()), conjunction(clauses((pi - c).node()), clauses(difference.node())))
                 : conjunction(clauses(c.node()), disjunction(clauses((c - pi).node()), clauses(difference.node())));
    }
    if (of.operation->code != Code::divide || graph_[of.arguments[1]].operation != &operation("sqrt")) return {};
    const Term N(graph_, of.arguments[0]), w(graph_, of.arguments[1]);
    return clauses((is_lower ? N - c * w : c * w - N).node());
  }

  /// Converts Y - u^2 >= 0 and constraints that contain sqrt(Y - u^2), by factoring Y - u^2: expanding u^2 would double
  /// the degree.
  Clauses clauses_of_squares(Node node) {
    if (const auto found = square_bound(node)) return abs_at_most(found->u, found->Y);
    if (auto found = clauses_of_quotient(node)) return found;
    const auto root = root_sum(node);
    if (!root) return {};
    const auto inside = square_bound(root->P);
    if (!inside) return {};
    const Clauses X = clauses(root->X.node());
    const Term Y = inside->Y - root->X * root->X;
    return root->plus ? disjunction(X, abs_at_most(inside->u, Y)) : conjunction(X, abs_at_least(inside->u, Y));
  }

  /// u if the term is |u|, or u / d if it is |u| / d with d >= 0; std::nullopt otherwise, or if it is constant in z.
  std::optional<Term> inside_of_abs(const Term& term, int depth = 0) {
    const Entry entry = graph_[term.node()];
    if (!entry.operation || (entry.groups & z_) == 0) return {};
    if (entry.operation->code == Code::abs) return Term(graph_, entry.arguments[0]);
    if (entry.operation->code != Code::divide || !is_nonnegative(entry.arguments[1])) return {};
    if (depth > kMaxDepth) return {};
    const auto inner = inside_of_abs(Term(graph_, entry.arguments[0]), depth + 1);
    if (!inner) return {};
    return *inner / Term(graph_, entry.arguments[1]);
  }

  std::optional<RadicalForm> times(const std::optional<RadicalForm>& x, const std::optional<RadicalForm>& y) {
    if (!x || !y) return {};
    if (!x->B.empty() && !y->B.empty() && x->radicand != y->radicand) return {};
    const RadicalForm& radical = x->B.empty() ? *y : *x;
    const auto AA = product(x->A, y->A), BB = product(x->B, y->B), AB = product(x->A, y->B), BA = product(x->B, y->A);
    if (!AA || !BB || !AB || !BA) return {};
    const auto BBQ = product(*BB, radical.Q);
    if (!BBQ) return {};
    return RadicalForm{sum(*AA, *BBQ), sum(*AB, *BA), radical.radicand, radical.Q};
  }

  /// The constraint that at least one of these polynomials is >= 0, as a list of one clause; std::nullopt if a
  /// polynomial exceeds the maximum degree.
  Clauses clause(const std::vector<Coefficients>& polynomials) {
    Clause made;
    for (const Coefficients& p : polynomials) {
      if (p.size() > degree_ + 1) return {};
      made.emplace_back().c.fill(graph_.number(0));
      std::ranges::copy(p, made.back().c.begin());
    }
    return {{made}};
  }
  static Clauses conjunction(Clauses x, const Clauses& y) {
    if (!x || !y) return {};
    x->insert(x->end(), y->begin(), y->end());
    return x;
  }
  /// The conjunctive normal form of "x or y", by the distributive law.
  static Clauses disjunction(const Clauses& x, const Clauses& y) {
    if (!x || !y) return {};
    std::vector<Clause> all;
    for (const Clause& a : *x)
      for (const Clause& b : *y) {
        all.push_back(a);
        all.back().insert(all.back().end(), b.begin(), b.end());
      }
    return all;
  }

  Graph& graph_;
  Groups z_;
  std::size_t degree_;
  bool squares_;
  const std::vector<bool>& nonnegative_;
  /// Radical forms computed so far; std::nullopt: the node has none.
  std::vector<std::optional<RadicalForm>> forms_;
  std::vector<std::uint32_t> index_;  ///< by node: index in `forms_` plus 1; 0 or beyond the end: not computed yet
  int depth_ = 0, steps_ = 0;         ///< recursion depth and number of steps of clauses()
};

}  // namespace

std::optional<std::vector<Clause>> polynomial_clauses(Graph& graph, Node f, Groups z, std::size_t degree, bool squares,
                                                      const std::vector<bool>& nonnegative) {
  return NormalForm(graph, z, degree, squares, nonnegative).clauses(f);
}

std::optional<std::vector<Node>> polynomial(Graph& graph, Node f, Groups z) {
  const auto form = NormalForm(graph, z, kMaxCoefficients - 1, false, {}).form(f);
  if (!form || !form->B.empty()) return {};
  return std::vector<Node>(form->A.begin(), form->A.end());
}

}  // namespace pkm::expression
