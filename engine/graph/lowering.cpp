#include "engine/graph/lowering.hpp"

#include <algorithm>
#include <unordered_map>

#include "engine/math/scalar.hpp"

namespace pkm::graph {
namespace {

constexpr std::size_t kMostCoefficients = 5;  // on the way: squares of degree two
// Formulas within formulas, and how many of them are examined: beyond, one is of another kind.
constexpr int kMaxDepth = 500, kMaxSteps = 100'000;

/// A polynomial in z by its coefficients, the lowest first; empty is 0.
using Terms = std::vector<Term>;

struct Form {
  Terms A, B;
  Node radicand{};  ///< where B is there: of the root
  Terms Q;          ///< the same as a polynomial
};

Terms trimmed(Terms p) {
  while (!p.empty() && p.back().is(0)) p.pop_back();
  return p;
}
Terms sum(const Terms& p, const Terms& q) {
  Terms r = p.size() >= q.size() ? p : q;
  const Terms& shorter = p.size() >= q.size() ? q : p;
  for (std::size_t i = 0; i < shorter.size(); ++i) r[i] = p[i] + q[i];
  return trimmed(r);
}
Terms negative(Terms p) {
  for (Term& c : p) c = -c;
  return p;
}
std::optional<Terms> product(const Terms& p, const Terms& q) {
  if (p.empty() || q.empty()) return Terms();
  if (p.size() + q.size() - 1 > kMostCoefficients) return {};
  Terms r(p.size() + q.size() - 1, Term(p[0].graph(), 0.0));
  for (std::size_t i = 0; i < p.size(); ++i)
    for (std::size_t j = 0; j < q.size(); ++j) r[i + j] = r[i + j] + p[i] * q[j];
  return trimmed(r);
}

class Lowering {
 public:
  Lowering(Graph& graph, Groups z, std::size_t degree, bool squares)
      : graph_(graph), z_(z), degree_(degree), squares_(squares) {}

  /// f as a form; none: it is of another kind. Each formula within it once, on a stack of its own: it may be made of
  /// 10^5, and may use them twice.
  std::optional<Form> form(Node root) {
    std::vector<Node> waiting = {root};
    while (!waiting.empty()) {
      const Node node = waiting.back();
      const std::vector<Node> parts = forms_.contains(node) ? std::vector<Node>() : parts_of_form(node);
      const auto next = std::ranges::find_if(parts, [&](Node part) { return !forms_.contains(part); });
      if (next != parts.end()) {
        waiting.push_back(*next);
        continue;
      }
      waiting.pop_back();
      if (!forms_.contains(node)) forms_.emplace(node, form_of_parts(node));
    }
    return forms_.at(root);
  }

  std::optional<std::vector<Clause>> conditions(Node node) {
    if (depth_ > kMaxDepth || ++steps_ > kMaxSteps) return {};
    ++depth_;
    auto found = clauses(node);
    --depth_;
    return found;
  }

 private:
  using Clauses = std::optional<std::vector<Clause>>;

  /// The formulas whose forms make that of a node.
  std::vector<Node> parts_of_form(Node node) const {
    const Entry& entry = graph_[node];
    if ((entry.groups & z_) == 0 || !entry.operation) return {};
    switch (entry.operation->code) {
      case Code::add:
      case Code::subtract:
      case Code::multiply:
        return {entry.arguments[0], entry.arguments[1]};
      case Code::divide:
        if ((graph_[entry.arguments[1]].groups & z_) != 0) return {};
        [[fallthrough]];
      case Code::negate:
      case Code::sqrt:
        return {entry.arguments[0]};
      default:
        return {};
    }
  }
  std::optional<Form> form_of_parts(Node node) {
    const Entry entry = graph_[node];
    if ((entry.groups & z_) == 0) return Form{.A = trimmed({Term(graph_, node)}), .B = {}, .Q = {}};
    if (entry.input >= 0) return Form{.A = {Term(graph_, 0.0), Term(graph_, 1.0)}, .B = {}, .Q = {}};
    switch (entry.operation->code) {
      case Code::add:
      case Code::subtract: {
        auto x = forms_.at(entry.arguments[0]), y = forms_.at(entry.arguments[1]);
        if (!x || !y) return {};
        if (entry.operation->code == Code::subtract) y = Form{negative(y->A), negative(y->B), y->radicand, y->Q};
        if (!x->B.empty() && !y->B.empty() && x->radicand != y->radicand) return {};
        const Form& rooted = x->B.empty() ? *y : *x;
        return Form{sum(x->A, y->A), sum(x->B, y->B), rooted.radicand, rooted.Q};
      }
      case Code::negate: {
        const auto& x = forms_.at(entry.arguments[0]);
        if (!x) return {};
        return Form{negative(x->A), negative(x->B), x->radicand, x->Q};
      }
      case Code::multiply:
        return times(forms_.at(entry.arguments[0]), forms_.at(entry.arguments[1]));
      case Code::divide: {
        if ((graph_[entry.arguments[1]].groups & z_) != 0) return {};
        const Term divisor(graph_, entry.arguments[1]);
        auto x = forms_.at(entry.arguments[0]);
        if (!x) return {};
        for (Terms* p : {&x->A, &x->B})
          for (Term& c : *p) c = c / divisor;
        return x;
      }
      case Code::sqrt: {
        const auto& x = forms_.at(entry.arguments[0]);
        if (!x || !x->B.empty()) return {};
        return Form{.A = {}, .B = {Term(graph_, 1.0)}, .radicand = entry.arguments[0], .Q = x->A};
      }
      default:
        return {};
    }
  }

  Clauses clauses(Node node) {
    const Entry entry = graph_[node];
    if ((entry.groups & z_) != 0 && entry.operation) {
      const Code code = entry.operation->code;
      if (code == Code::min) return both(conditions(entry.arguments[0]), conditions(entry.arguments[1]));
      if (code == Code::max) return either(conditions(entry.arguments[0]), conditions(entry.arguments[1]));
      if (code == Code::subtract) {
        const Term x(graph_, entry.arguments[0]), y(graph_, entry.arguments[1]);
        if (const auto inner = inside_of_abs(y))  // x - |u|
          return both(conditions((x - *inner).node()), conditions((x + *inner).node()));
        if (const auto inner = inside_of_abs(x))  // |u| - y
          return either(conditions((*inner - y).node()), conditions((-*inner - y).node()));
      }
    }
    if (auto found = conditions_of_form(node)) return found;
    return squares_ ? conditions_of_squares(node) : std::nullopt;
  }

  /// Known to be >= 0 whatever the inputs: numbers, squares, roots, and sums, products, quotients of such.
  bool is_positive(Node root) const {
    std::vector<Node> waiting = {root};
    for (int steps = 0; !waiting.empty(); ++steps) {
      if (steps > kMaxSteps) return false;
      const Entry& entry = graph_[waiting.back()];
      waiting.pop_back();
      const Code code = entry.operation ? entry.operation->code : Code::other;
      if (entry.is_number() ? entry.number >= 0 : code == Code::sqrt || code == Code::abs) continue;
      if (code == Code::multiply && entry.arguments[0] == entry.arguments[1]) continue;
      if (code != Code::multiply && code != Code::add && code != Code::divide) return false;
      waiting.insert(waiting.end(), entry.operands().begin(), entry.operands().end());
    }
    return true;
  }

  Clauses conditions_of_form(Node node) {
    const auto f = form(node);
    if (!f) return {};
    if (f->B.empty()) return one({f->A});
    const auto BB = product(f->B, f->B), AA = product(f->A, f->A);
    if (!BB || !AA) return {};
    const auto BBQ = product(*BB, f->Q);
    if (!BBQ) return {};
    if (f->B.size() != 1) return {};
    const Term b = f->B[0];
    if (is_positive((-b).node()) ||
        (graph_[b.node()].operation == &negation() && is_positive(graph_[b.node()].arguments[0])))
      return both(one({f->A}), one({sum(*AA, negative(*BBQ))}));
    if (is_positive(b.node())) return one({f->A, sum(*BBQ, negative(*AA))});
    if (!squares_) return {};
    const Terms R = sum(*AA, negative(*BBQ));  // of unknown sign is b
    return both(both(one({f->A, f->B}), one({f->A, negative(R)})), one({f->B, R}));
  }

  bool is_free(const Term& x) const { return (graph_[x.node()].groups & z_) == 0; }

  /// Y - u^2 with a Y that does not depend on z.
  struct Difference {
    Term Y, u;
  };
  std::optional<Difference> difference(Node node) {
    const Entry entry = graph_[node];
    if (!entry.operation || entry.operation->code != Code::subtract) return {};
    const Term Y(graph_, entry.arguments[0]);
    const Entry square = graph_[entry.arguments[1]];
    if (!is_free(Y) || !square.operation || square.operation->code != Code::multiply ||
        square.arguments[0] != square.arguments[1])
      return {};
    return Difference{Y, Term(graph_, square.arguments[0])};
  }
  /// X + sqrt(P), or X - sqrt(P), with an X that does not depend on z.
  struct Rooted {
    Term X;
    bool plus;
    Node P;
  };
  std::optional<Rooted> rooted(Node node, int depth = 0) {
    const Entry entry = graph_[node];
    if (!entry.operation || depth > kMaxDepth) return {};
    const Code code = entry.operation->code;
    if (code == Code::sqrt) return Rooted{Term(graph_, 0.0), true, entry.arguments[0]};
    if (code != Code::add && code != Code::subtract && code != Code::negate) return {};
    const Term x(graph_, entry.arguments[0]);
    if (code == Code::negate) {
      const auto inner = rooted(x.node(), depth + 1);
      return inner ? std::optional(Rooted{-inner->X, !inner->plus, inner->P}) : std::nullopt;
    }
    const Term y(graph_, entry.arguments[1]);
    const bool adds = code == Code::add;
    if (is_free(y)) {
      const auto inner = rooted(x.node(), depth + 1);
      return inner ? std::optional(Rooted{adds ? inner->X + y : inner->X - y, inner->plus, inner->P}) : std::nullopt;
    }
    const auto inner = is_free(x) ? rooted(y.node(), depth + 1) : std::nullopt;
    return inner ? std::optional(Rooted{adds ? x + inner->X : x - inner->X, inner->plus == adds, inner->P})
                 : std::nullopt;
  }

  /// |u| <= sqrt(Y)
  Clauses within(const Term& u, const Term& Y) {
    const Entry entry = graph_[Y.node()];
    const bool is_square =
        entry.operation && entry.operation->code == Code::multiply && entry.arguments[0] == entry.arguments[1];
    const Term root = is_square ? abs(Term(graph_, entry.arguments[0])) : sqrt(Y);
    return both(conditions((root - u).node()), conditions((root + u).node()));
  }
  /// |u| >= sqrt(Y), or Y <= 0
  Clauses beyond(const Term& u, const Term& Y) {
    const Term root = sqrt(Y);
    return either(conditions((-Y).node()), either(conditions((u - root).node()), conditions((-u - root).node())));
  }
  /// N / w - c, c - N / w, and the same with the arc cosine of N / w, where w is a root and c does not depend on z.
  Clauses conditions_of_quotient(Node node) {
    const Entry entry = graph_[node];
    if (!entry.operation || entry.operation->code != Code::subtract) return {};
    Term x(graph_, entry.arguments[0]), y(graph_, entry.arguments[1]);
    const bool is_least = is_free(y);  // that c is the least value
    if (!is_least && !is_free(x)) return {};
    const Term c = is_least ? y : x, value = is_least ? x : y;
    const Entry of = graph_[value.node()];
    if (!of.operation) return {};
    if (of.operation == &operation("acos")) {
      const Term cosine(graph_, of.arguments[0]), pi(graph_, kPi);
      const Term difference = is_least ? cos(c) - cosine : cosine - cos(c);
      return is_least
                 ? either(conditions((-c).node()), both(conditions((pi - c).node()), conditions(difference.node())))
                 : both(conditions(c.node()), either(conditions((c - pi).node()), conditions(difference.node())));
    }
    if (of.operation->code != Code::divide || graph_[of.arguments[1]].operation != &operation("sqrt")) return {};
    const Term N(graph_, of.arguments[0]), w(graph_, of.arguments[1]);
    return conditions((is_least ? N - c * w : c * w - N).node());
  }

  /// Squares of forms, taken apart instead of multiplied out.
  Clauses conditions_of_squares(Node node) {
    if (const auto found = difference(node)) return within(found->u, found->Y);
    if (auto found = conditions_of_quotient(node)) return found;
    const auto root = rooted(node);
    if (!root) return {};
    const auto inside = difference(root->P);
    if (!inside) return {};
    const Clauses X = conditions(root->X.node());
    const Term Y = inside->Y - root->X * root->X;
    return root->plus ? either(X, within(inside->u, Y)) : both(X, beyond(inside->u, Y));
  }

  /// u, where the term is |u|, or |u| / d with d >= 0 (then u / d); and where z is in it.
  std::optional<Term> inside_of_abs(const Term& term, int depth = 0) {
    const Entry entry = graph_[term.node()];
    if (!entry.operation || (entry.groups & z_) == 0) return {};
    if (entry.operation->code == Code::abs) return Term(graph_, entry.arguments[0]);
    if (entry.operation->code != Code::divide || !is_positive(entry.arguments[1])) return {};
    if (depth > kMaxDepth) return {};
    const auto inner = inside_of_abs(Term(graph_, entry.arguments[0]), depth + 1);
    if (!inner) return {};
    return *inner / Term(graph_, entry.arguments[1]);
  }

  std::optional<Form> times(const std::optional<Form>& x, const std::optional<Form>& y) {
    if (!x || !y) return {};
    if (!x->B.empty() && !y->B.empty() && x->radicand != y->radicand) return {};
    const Form& rooted = x->B.empty() ? *y : *x;
    const auto AA = product(x->A, y->A), BB = product(x->B, y->B), AB = product(x->A, y->B), BA = product(x->B, y->A);
    if (!AA || !BB || !AB || !BA) return {};
    const auto BBQ = product(*BB, rooted.Q);
    if (!BBQ) return {};
    return Form{sum(*AA, *BBQ), sum(*AB, *BA), rooted.radicand, rooted.Q};
  }

  /// One clause of these polynomials.
  Clauses one(const std::vector<Terms>& polynomials) {
    Clause clause;
    for (const Terms& p : polynomials) {
      if (p.size() > degree_ + 1) return {};
      clause.emplace_back().c.fill(graph_.number(0));
      std::ranges::transform(p, clause.back().c.begin(), &Term::node);
    }
    return {{clause}};
  }
  static Clauses both(Clauses x, const Clauses& y) {
    if (!x || !y) return {};
    x->insert(x->end(), y->begin(), y->end());
    return x;
  }
  static Clauses either(const Clauses& x, const Clauses& y) {
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
  std::unordered_map<Node, std::optional<Form>> forms_;
  int depth_ = 0, steps_ = 0;
};

}  // namespace

std::optional<std::vector<Clause>> lowered(Graph& graph, Node f, Groups z, std::size_t degree, bool squares) {
  return Lowering(graph, z, degree, squares).conditions(f);
}

std::optional<std::vector<Node>> polynomial(Graph& graph, Node f, Groups z) {
  const auto form = Lowering(graph, z, kMostCoefficients - 1, false).form(f);
  if (!form || !form->B.empty()) return {};
  std::vector<Node> coefficients;
  for (const Term& c : form->A) coefficients.push_back(c.node());
  return coefficients;
}

}  // namespace pkm::graph
