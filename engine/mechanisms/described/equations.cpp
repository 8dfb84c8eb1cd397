#include "engine/mechanisms/described/equations.hpp"

#include <map>

#include "engine/dynamics/pose_dynamics.hpp"
#include "engine/graph/derivative.hpp"

namespace pkm::described {
namespace {

using graph::Derivative, graph::Term;

class Equations {
 public:
  explicit Equations(Model& model) : model_(model), along_(model.graph), n_(model.inputs.coordinates) {
    for (std::size_t i = 0; i < n_; ++i) {
      const Node coordinate = model.graph.input(model.inputs.coordinate(i), Inputs::coordinate_group(i));
      by_.emplace_back(model.graph).move(coordinate, model.graph.number(1));
      along_.move(coordinate, model.graph.input(model.inputs.rate(i), Inputs::kRates));
    }
  }

  EquationNodes found() {
    EquationNodes e;
    for (const Node joint : model_.joints) {
      for (Derivative& by : by_) e.J.push_back(by.of(joint).node());
      e.J_rate_X.push_back(along_.of(along_.of(joint)).node());
    }
    std::vector<Term> G(n_, number(0));
    for (const DescribedBody& body : model_.bodies) {
      const Term mass = model_.term(body.mass);
      for (const Node place : body.centre) add(place, mass);
      for (std::size_t i = 0; i < n_; ++i) G[i] = G[i] + mass * kGravity * by_[i].of(body.centre[2]);
      for (const DescribedBody::Turn& turn : body.turns)
        for (const Node component : turn.follows) add(component, model_.term(turn.moment));
    }
    put(G, e.G_X);
    put(inertia(), e.M_X);
    put(centrifugal(), e.h_X);
    add_wrench(e.J_wrench);
    return e;
  }

 private:
  /// Numbers that differ by a constant.
  struct Moving {
    std::vector<Term> by;  ///< derivatives by the coordinates
    Node one;              ///< of them
    Term weight;
  };

  Term number(double value) { return {model_.graph, value}; }
  static void put(const std::vector<Term>& terms, std::vector<Node>& to) {
    for (const Term& term : terms) to.push_back(term.node());
  }

  void add(Node of, const Term& weight) {
    std::vector<Term> by;
    std::vector<Node> key;
    for (Derivative& each : by_) by.push_back(each.of(of));
    put(by, key);
    if (std::ranges::all_of(by, [](const Term& term) { return term.is(0); })) return;
    const auto [place, is_new] = known_.try_emplace(key, moving_.size());
    if (is_new)
      moving_.push_back({by, of, weight});
    else
      moving_[place->second].weight = moving_[place->second].weight + weight;
  }

  std::vector<Term> inertia() {
    std::vector<Term> M(n_ * n_, number(0));
    for (const Moving& m : moving_)
      for (std::size_t i = 0; i < n_; ++i) {
        const Term weighted = m.weight * m.by[i];
        for (std::size_t j = i; j < n_; ++j) M[i * n_ + j] = M[i * n_ + j] + weighted * m.by[j];
      }
    for (std::size_t i = 0; i < n_; ++i)
      for (std::size_t j = 0; j < i; ++j) M[i * n_ + j] = M[j * n_ + i];
    return M;
  }
  std::vector<Term> centrifugal() {
    std::vector<Term> h(n_, number(0));
    for (const Moving& m : moving_) {
      const Term second = along_.of(along_.of(m.one));
      for (std::size_t i = 0; i < n_; ++i) h[i] = h[i] + m.weight * m.by[i] * second;
    }
    return h;
  }
  void add_wrench(std::vector<Node>& J) {
    for (const Node place : *model_.wrench_point)
      for (Derivative& by : by_) J.push_back(by.of(place).node());
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (std::size_t i = 0; i < n_; ++i) J.push_back(model_.turn_axes[i][axis]);
  }

  Model& model_;
  std::vector<Derivative> by_;  ///< by each coordinate
  Derivative along_;            ///< the velocity
  std::size_t n_;
  std::map<std::vector<Node>, std::size_t> known_;
  std::vector<Moving> moving_;
};

}  // namespace

EquationNodes equations_of(Model& model) { return Equations(model).found(); }

}  // namespace pkm::described
