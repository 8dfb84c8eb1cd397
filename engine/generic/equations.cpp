#include "engine/generic/equations.hpp"

#include <algorithm>
#include <map>

#include "engine/dynamics/pose_dynamics.hpp"
#include "engine/expression/derivative.hpp"

namespace pkm::generic {
namespace {

using expression::Rates, expression::Term;
using limbs::Vector3;

class Equations {
 public:
  explicit Equations(Model& model) : model_(model), along_(model.graph), n_(model.inputs.coordinates) {
    for (std::size_t i = 0; i < n_; ++i) {
      const Node coordinate = model.coordinate(i);
      by_.emplace_back(model.graph).set_rate(coordinate, model.graph.number(1));
      along_.set_rate(coordinate, model.graph.input(model.inputs.rate(i), Inputs::kRates));
    }
    for (const ArmNodes& arm : model.arms) arm_angles_.push_back(angle_of(arm));
  }

  std::vector<Node> jacobian() {
    std::vector<Node> J;
    for (const Node joint : model_.joints)
      for (Rates& by : by_) J.push_back(by.of(joint).node());
    return J;
  }

  EquationNodes found() {
    EquationNodes e{.J = jacobian()};
    for (const Node joint : model_.joints) e.J_rate_X.push_back(along_.of(along_.of(joint)).node());
    std::vector<Term> G(n_, number(0));
    for (const BodyNodes& body : model_.bodies) {
      for (std::size_t i = 0; i < n_; ++i) G[i] = G[i] + model_.term(body.mass) * kGravity * by_[i].of(body.centre[2]);
      add(body);
    }
    append(G, e.G_X);
    add_inertia(e);
    for (const Node component : *model_.wrench_point)
      for (Rates& by : by_) e.J_wrench.push_back(by.of(component).node());
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (std::size_t i = 0; i < n_; ++i) e.J_wrench.push_back(model_.rotation_directions[i][axis]);
    return e;
  }

 private:
  /// The derivatives of a scalar function f of the pose, as nodes.
  struct Derivatives {
    std::vector<Term> by;  ///< f_X: partial derivatives with respect to the coordinates, by coordinate
    Term rate;             ///< time derivative f'
  };
  /// Total weight of each product f' g' in the kinetic energy. The key (i, j), i <= j, gives the indices of f and g in
  /// functions_.
  using Products = std::map<std::pair<std::size_t, std::size_t>, Term>;

  Term number(double value) { return {model_.graph, value}; }
  Vector3 vector(const std::array<Node, 3>& of) { return {model_.term(of[0]), model_.term(of[1]), model_.term(of[2])}; }
  static void append(const std::vector<Term>& terms, std::vector<Node>& to) {
    for (const Term& term : terms) to.push_back(term.node());
  }

  /// Derivatives of the angle q of an arm. Also sets the derivatives of the vector `arm`, by arm' = q' axis x arm.
  Derivatives angle_of(const ArmNodes& arm) {
    const Vector3 at = vector(arm.arm), rod = vector(arm.rod), tangent = cross(vector(arm.axis), at);
    const Term lever = number(1) / dot(rod, tangent);
    const auto set_rates = [&](Rates& derivative) {
      Term sum = number(0);
      for (std::size_t k = 0; k < 3; ++k) sum = sum + rod[k] * derivative.of(arm.B[k]);
      const Term rate = sum * lever;
      for (std::size_t k = 0; k < 3; ++k)
        if (!model_.graph[arm.arm[k]].is_number()) derivative.set_rate(arm.arm[k], (tangent[k] * rate).node());
      if (arm.joint) derivative.set_rate(*arm.joint, rate.node());
      return rate;
    };
    Derivatives angle{{}, set_rates(along_)};
    for (Rates& by : by_) angle.by.push_back(set_rates(by));
    return angle;
  }

  /// Finds a function in functions_ by its partial derivatives, and adds it if no function has the same derivatives.
  /// @return its index; std::nullopt if the function is constant
  std::optional<std::size_t> index_of(const Derivatives& function) {
    std::vector<Node> key;
    append(function.by, key);
    if (std::ranges::all_of(function.by, [](const Term& term) { return term.is(0); })) return {};
    const auto [found, is_new] = indices_.try_emplace(key, functions_.size());
    if (is_new) functions_.push_back(function);
    return found->second;
  }
  std::optional<std::size_t> index_of(Node node) {
    Derivatives function{{}, along_.of(node)};
    for (Rates& by : by_) function.by.push_back(by.of(node));
    return index_of(function);
  }
  void add_product(std::optional<std::size_t> f, std::optional<std::size_t> g, const Term& weight) {
    if (!f || !g) return;
    const auto [product, is_new] = products_.try_emplace(std::minmax(*f, *g), weight);
    if (!is_new) product->second = product->second + weight;
  }

  void add(const BodyNodes& body) {
    for (const BodyNodes::Product& product : body.products)
      for (std::size_t k = 0; k < 3; ++k)
        add_product(index_of(product.f[k]), index_of(product.g[k]), model_.term(product.weight));
    for (const BodyNodes::ArmRotation& rotation : body.arm_rotations) {
      const auto f = index_of(arm_angles_[rotation.arm]);
      add_product(f, f, model_.term(rotation.weight));
    }
    for (const BodyNodes::LineRotation& rotation : body.line_rotations) {  // the angular velocity is d x d' / |d|^2
      const Vector3 d = vector(rotation.d);
      const Term per_square = number(1) / dot(d, d);
      const auto omega = [&](Rates& derivative) {
        return cross(d, Vector3{derivative.of(d[0]), derivative.of(d[1]), derivative.of(d[2])}) * per_square;
      };
      std::vector<Vector3> by;
      for (Rates& each : by_) by.push_back(omega(each));
      const Vector3 rate = omega(along_);
      for (std::size_t k = 0; k < 3; ++k) {
        Derivatives component{{}, rate[k]};
        for (const Vector3& each : by) component.by.push_back(each[k]);
        const auto f = index_of(component);
        add_product(f, f, model_.term(rotation.weight));
      }
    }
  }

  /// Adds the terms of the kinetic energy to the inertia matrix M_X and to the velocity terms h_X.
  void add_inertia(EquationNodes& e) {
    std::vector<Term> M(n_ * n_, number(0)), h(n_, number(0));
    const auto add_to = [](Term& sum, const Term& x) { sum = sum + x; };
    for (const auto& [pair, weight] : products_) {
      const Derivatives &f = functions_[pair.first], &g = functions_[pair.second];
      const bool square = pair.first == pair.second;
      const Term w = square ? weight : weight * 0.5;
      const Term f_second = along_.of(f.rate), g_second = along_.of(g.rate);
      for (std::size_t i = 0; i < n_; ++i) {
        const Term wf = w * f.by[i], wg = w * g.by[i];
        for (std::size_t j = i; j < n_; ++j) {
          add_to(M[i * n_ + j], wf * g.by[j]);
          if (!square) add_to(M[i * n_ + j], wg * f.by[j]);
        }
        add_to(h[i], wf * g_second);
        if (!square) add_to(h[i], wg * f_second);
      }
    }
    for (std::size_t i = 0; i < n_; ++i)
      for (std::size_t j = 0; j < i; ++j) M[i * n_ + j] = M[j * n_ + i];
    append(M, e.M_X);
    append(h, e.h_X);
  }

  Model& model_;
  std::vector<Rates> by_;  ///< computes partial derivatives with respect to a coordinate; by coordinate
  Rates along_;            ///< computes derivatives with respect to time
  std::size_t n_;
  std::vector<Derivatives> arm_angles_;
  std::vector<Derivatives> functions_;
  /// Index in functions_ of the function with given partial derivatives.
  std::map<std::vector<Node>, std::size_t> indices_;
  Products products_;
};

}  // namespace

EquationNodes equations_of(Model& model) { return Equations(model).found(); }

std::vector<Node> jacobian_of(Model& model) { return Equations(model).jacobian(); }

}  // namespace pkm::generic
