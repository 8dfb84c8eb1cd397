// Solver stage with NLopt.
//
// NLopt is a C library, through which no exception may propagate: instead of throwing, the callbacks force a stop and
// return an arbitrary number. The returned status is not reliable: SLSQP can succeed with x = NaN or at an infeasible
// point, and report a round-off failure at the true optimum. COBYLA is not offered, because its inner loop can hang and
// ignore all limits.
#include <algorithm>
#include <memory>
#include <new>
#include <stdexcept>

#include <nlopt.h>

#include "engine/core/error.hpp"
#include "engine/optimisers/list.hpp"
#include "engine/optimisers/option_specs.hpp"
#include "engine/optimisers/solvers/solver_stage.hpp"

namespace pkm {
namespace {

/// An algorithm of NLopt and its capabilities. All algorithms respect bounds.
struct Algorithm {
  const char* name;
  nlopt_algorithm id;
  bool gradient, constraints;  ///< gradient: the algorithm uses gradients; constraints: it handles inequality
                               ///< constraints
  bool local;                  ///< true: the algorithm can be the inner algorithm of auglag and mlsl
  bool inner;                  ///< true: the algorithm requires an inner algorithm, which is a local one
  bool population;             ///< true: the algorithm has a population whose size can be selected
  const char* meaning;
};

constexpr Algorithm kAlgorithms[] = {
    {"slsqp", NLOPT_LD_SLSQP, true, true, true, false, false, "sequential quadratic programming"},
    {"mma", NLOPT_LD_MMA, true, true, true, false, false, "method of moving asymptotes"},
    {"ccsaq", NLOPT_LD_CCSAQ, true, true, true, false, false, "conservative convex separable approximation"},
    {"lbfgs", NLOPT_LD_LBFGS, true, false, true, false, false, "limited-memory BFGS"},
    {"auglag", NLOPT_AUGLAG, false, true, false, true, false, "augmented Lagrangian around an inner algorithm"},
    {"bobyqa", NLOPT_LN_BOBYQA, false, false, true, false, false,
     "trust region with quadratic models, derivative-free"},
    {"sbplx", NLOPT_LN_SBPLX, false, false, true, false, false, "Nelder-Mead on subspaces (Subplex), derivative-free"},
    {"isres", NLOPT_GN_ISRES, false, true, false, false, true, "evolution strategy with stochastic ranking, global"},
    {"direct_l", NLOPT_GN_DIRECT_L, false, false, false, false, false, "DIRECT, locally biased, global"},
    {"crs2", NLOPT_GN_CRS2_LM, false, false, false, false, true, "controlled random search, global"},
    {"esch", NLOPT_GN_ESCH, false, false, false, false, false, "evolution strategy, global"},
    {"mlsl", NLOPT_G_MLSL_LDS, false, false, false, true, true,
     "multi-level single linkage from a Sobol sequence, global"},
};

const Algorithm& find_algorithm(const std::string& name) {
  return *std::ranges::find_if(kAlgorithms, [&](const Algorithm& a) { return a.name == name; });
}

bool uses_gradient(const Options& options) {
  const Algorithm& outer = find_algorithm(options.word("algorithm"));
  return outer.gradient || (outer.inner && find_algorithm(options.word("inner")).gradient);
}

using Handle = std::unique_ptr<std::remove_pointer_t<nlopt_opt>, decltype(&nlopt_destroy)>;

/// Data that NLopt passes to a callback: the program and, for a constraint, its index.
struct Callback {
  NonlinearProgram& program;
  nlopt_opt opt;
  std::size_t constraint_index;
  double tighten;
};

// The returned numbers are irrelevant: NLopt checks for a forced stop before it uses them.
double force_stop(const Callback& callback, unsigned n, double* gradient) {
  if (gradient) std::fill_n(gradient, n, 0.0);
  nlopt_force_stop(callback.opt);
  return 0;
}

double objective(unsigned n, const double* u, double* gradient, void* data) {
  auto& callback = *static_cast<Callback*>(data);
  const NonlinearProgram::Point* point = callback.program.evaluate(u);
  if (!point) return force_stop(callback, n, gradient);
  if (gradient) std::ranges::copy(point->gradient, gradient);
  return point->objective;
}

// Callback of a constraint. NLopt's constraints are satisfied if they are <= 0.
double constraint(unsigned n, const double* u, double* gradient, void* data) {
  auto& callback = *static_cast<Callback*>(data);
  const NonlinearProgram::Point* point = callback.program.evaluate(u);
  if (!point) return force_stop(callback, n, gradient);
  if (gradient)
    for (unsigned i = 0; i < n; ++i) gradient[i] = -point->margin_jacobian[callback.constraint_index * n + i];
  return callback.tighten - point->margins[callback.constraint_index];
}

class NloptSolver final : public Solver {
 public:
  explicit NloptSolver(const Options& options) : options_(options) {}

  SolverResult solve(NonlinearProgram& program, const std::vector<double>& start, std::uint64_t seed) const override {
    // NLopt has one random number generator per thread, which it seeds from the clock unless it is seeded here.
    nlopt_srand(static_cast<unsigned long>(seed & 0xffffffff) | 1u);
    const auto n = static_cast<unsigned>(program.dimension());
    const Algorithm& outer = find_algorithm(options_.word("algorithm"));
    const Algorithm& local = find_algorithm(options_.word("inner"));
    const auto population = static_cast<unsigned>(options_.integer("population"));  // 0 selects NLopt's default size
    const double first_step = options_.number("initial_step"), tighten = options_.number("tighten");
    const Handle opt(nlopt_create(outer.id, n), nlopt_destroy);
    if (!opt) throw std::bad_alloc();
    const auto check_memory = [](nlopt_result result) {
      if (result == NLOPT_OUT_OF_MEMORY) throw std::bad_alloc();
    };
    std::vector<double> u = start;
    nlopt_set_lower_bounds1(opt.get(), 0);
    nlopt_set_upper_bounds1(opt.get(), 1);
    set_tolerances(opt.get());
    if (outer.population && population > 0) nlopt_set_population(opt.get(), population);
    if (!outer.gradient && !outer.inner) nlopt_set_initial_step1(opt.get(), first_step);
    if (outer.inner) {
      const Handle inner(nlopt_create(local.id, n), nlopt_destroy);
      if (!inner) throw std::bad_alloc();
      set_tolerances(inner.get());  // the inner algorithm has no other stopping criteria
      if (!local.gradient) nlopt_set_initial_step1(inner.get(), first_step);
      check_memory(nlopt_set_local_optimizer(opt.get(), inner.get()));  // NLopt copies the inner algorithm
    }
    Callback objective_data{program, opt.get(), 0, 0};
    nlopt_set_min_objective(opt.get(), objective, &objective_data);
    std::vector<Callback> callbacks;
    callbacks.reserve(program.constraints());
    for (std::size_t m = 0; m < program.constraints(); ++m) {
      callbacks.push_back({program, opt.get(), m, tighten});
      check_memory(nlopt_add_inequality_constraint(opt.get(), constraint, &callbacks.back(), 0));
    }
    double value = 0;
    const nlopt_result result = nlopt_optimize(opt.get(), u.data(), &value);
    check_memory(result);
    const char* detail = nlopt_get_errmsg(opt.get());
    SolverResult end{result > 0, nlopt_result_to_string(result), std::move(u)};
    if (detail) end.message += std::string(": ") + detail;
    return end;
  }

 private:
  void set_tolerances(nlopt_opt opt) const {
    nlopt_set_ftol_rel(opt, options_.number("ftol"));
    nlopt_set_xtol_abs1(opt, options_.number("xtol"));
  }

  Options options_;
};

Capabilities nlopt_capabilities(const Options& options) {
  return solver_capabilities(options, find_algorithm(options.word("algorithm")).constraints, uses_gradient(options));
}

std::unique_ptr<Optimiser> make_nlopt(const Options& options, const DesignSpace&) {
  const Algorithm& outer = find_algorithm(options.word("algorithm"));
  if (options.integer("population") > 0 && !outer.population) {
    std::vector<std::string> with;
    for (const Algorithm& a : kAlgorithms)
      if (a.population) with.push_back(a.name);
    throw std::invalid_argument("population = " + std::to_string(options.integer("population")) + ": the algorithm " +
                                outer.name + " has no population; expected one of " + join(with));
  }
  SolverPlan plan = solver_plan(options);
  if (plan.scalarisation.kind != Scalarisation::Kind::none && !outer.constraints)
    throw std::invalid_argument("start = \"pareto\" needs an algorithm that handles constraints; " +
                                std::string(outer.name) + " does not");
  plan.solver = std::make_shared<NloptSolver>(options);
  plan.detail = uses_gradient(options) ? Detail::derivatives : Detail::complete;
  return make_solver_stage(std::move(plan));
}

std::vector<OptionSpec> nlopt_options() {
  std::vector<std::string> all, inner;
  std::string table;
  for (const Algorithm& a : kAlgorithms) {
    all.push_back(a.name);
    if (a.local) inner.push_back(a.name);
    table += std::string(table.empty() ? "" : "; ") + a.name + ": " + a.meaning +
             (a.inner      ? ""
              : a.gradient ? ", gradients"
                           : "") +
             (a.constraints ? ", constraints" : "");
  }
  std::vector<OptionSpec> specs = {word_option("algorithm", all, table),
                                   word_option("inner", inner, "auglag and mlsl: the inner algorithm")};
  for (auto& spec : solver_options()) specs.push_back(std::move(spec));
  specs.push_back(
      number_option("ftol", 1e-13, 0, 1, "stop when a step changes the objective by less than this fraction"));
  specs.push_back(number_option("xtol", 1e-10, 0, 1, "stop when a step is shorter than this, in units of the ranges"));
  specs.push_back(tighten_option());
  specs.push_back(
      number_option("initial_step", 0.1, 1e-9, 1, "derivative-free algorithms: first step, in units of the ranges"));
  specs.push_back(
      integer_option("population", std::int64_t{0}, 0, 1e6, "isres, crs2, mlsl: population (0: NLopt's default)"));
  return specs;
}

}  // namespace

OptimiserEntry nlopt_stage() {
  return {.name = "nlopt",
          .meaning = "NLopt: local optimisation with gradients, and derivative-free and global search",
          .capabilities = nlopt_capabilities,
          .options = nlopt_options(),
          .make = make_nlopt};
}

}  // namespace pkm
