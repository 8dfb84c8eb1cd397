// NLopt is C: no exception may pass through it, so callbacks answer with a number and a forced stop. What it returns is
// a hint at most: SLSQP can end "successfully" with x = NaN or at an infeasible point, and report a round-off failure
// at the true optimum. COBYLA is left out: its inner loop can hang with every limit ignored.
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

/// What an algorithm is, and what it can handle. All keep bounds.
struct Algorithm {
  const char* name;
  nlopt_algorithm id;
  bool gradient, constraints;
  bool local;       ///< may serve inside of auglag and mlsl
  bool inner;       ///< needs a local algorithm inside
  bool population;  ///< has a population whose size can be chosen
  const char* meaning;
};

constexpr Algorithm kAlgorithms[] = {
    {"slsqp", NLOPT_LD_SLSQP, true, true, true, false, false, "sequential quadratic programming"},
    {"mma", NLOPT_LD_MMA, true, true, true, false, false, "method of moving asymptotes"},
    {"ccsaq", NLOPT_LD_CCSAQ, true, true, true, false, false, "conservative convex separable approximation"},
    {"lbfgs", NLOPT_LD_LBFGS, true, false, true, false, false, "limited-memory BFGS"},
    {"auglag", NLOPT_AUGLAG, false, true, false, true, false, "augmented Lagrangian around an inner algorithm"},
    {"bobyqa", NLOPT_LN_BOBYQA, false, false, true, false, false, "quadratic models, no derivatives"},
    {"sbplx", NLOPT_LN_SBPLX, false, false, true, false, false, "simplices in subspaces, no derivatives"},
    {"isres", NLOPT_GN_ISRES, false, true, false, false, true, "evolution strategy with stochastic ranking, global"},
    {"direct_l", NLOPT_GN_DIRECT_L, false, false, false, false, false, "dividing rectangles, global"},
    {"crs2", NLOPT_GN_CRS2_LM, false, false, false, false, true, "controlled random search, global"},
    {"esch", NLOPT_GN_ESCH, false, false, false, false, false, "evolution strategy, global"},
    {"mlsl", NLOPT_G_MLSL_LDS, false, false, false, true, true,
     "local searches from a low-discrepancy sequence, global"},
};

const Algorithm& algorithm_called(const std::string& name) {
  return *std::ranges::find_if(kAlgorithms, [&](const Algorithm& a) { return a.name == name; });
}

bool uses_gradient(const Options& options) {
  const Algorithm& outer = algorithm_called(options.word("algorithm"));
  return outer.gradient || (outer.inner && algorithm_called(options.word("inner")).gradient);
}

using Handle = std::unique_ptr<std::remove_pointer_t<nlopt_opt>, decltype(&nlopt_destroy)>;

/// What a callback is given.
struct Callback {
  Trials& trials;
  nlopt_opt opt;
  std::size_t margin;
  double tighten;
};

// The numbers of a stopped run do not matter: NLopt looks at the force flag before it uses them.
double stop(const Callback& callback, unsigned n, double* gradient) {
  if (gradient) std::fill_n(gradient, n, 0.0);
  nlopt_force_stop(callback.opt);
  return 0;
}

double objective(unsigned n, const double* u, double* gradient, void* data) {
  auto& callback = *static_cast<Callback*>(data);
  const Trials::Point* point = callback.trials.at(u);
  if (!point) return stop(callback, n, gradient);
  if (gradient) std::ranges::copy(point->gradient, gradient);
  return point->objective;
}

// NLopt's constraints hold when <= 0.
double constraint(unsigned n, const double* u, double* gradient, void* data) {
  auto& callback = *static_cast<Callback*>(data);
  const Trials::Point* point = callback.trials.at(u);
  if (!point) return stop(callback, n, gradient);
  if (gradient)
    for (unsigned i = 0; i < n; ++i) gradient[i] = -point->margin_gradient[callback.margin * n + i];
  return callback.tighten - point->margins[callback.margin];
}

class NloptSolver final : public Solver {
 public:
  explicit NloptSolver(const Options& options) : options_(options) {}

  SolverEnd solve(Trials& trials, const std::vector<double>& from, std::uint64_t seed) const override {
    // NLopt's generator belongs to the thread and would be seeded from the clock.
    nlopt_srand(static_cast<unsigned long>(seed & 0xffffffff) | 1u);
    const auto n = static_cast<unsigned>(trials.dimension());
    const Algorithm& outer = algorithm_called(options_.word("algorithm"));
    const Algorithm& local = algorithm_called(options_.word("inner"));
    const auto population = static_cast<unsigned>(options_.integer("population"));  // 0: NLopt's own
    const double first_step = options_.number("initial_step"), tighten = options_.number("tighten");
    const Handle opt(nlopt_create(outer.id, n), nlopt_destroy);
    if (!opt) throw std::bad_alloc();
    const auto made = [](nlopt_result result) {
      if (result == NLOPT_OUT_OF_MEMORY) throw std::bad_alloc();
    };
    std::vector<double> u = from;
    nlopt_set_lower_bounds1(opt.get(), 0);
    nlopt_set_upper_bounds1(opt.get(), 1);
    set_stops(opt.get());
    if (outer.population && population > 0) nlopt_set_population(opt.get(), population);
    if (!outer.gradient && !outer.inner) nlopt_set_initial_step1(opt.get(), first_step);
    if (outer.inner) {
      const Handle inner(nlopt_create(local.id, n), nlopt_destroy);
      if (!inner) throw std::bad_alloc();
      set_stops(inner.get());  // the inner one knows no others
      if (!local.gradient) nlopt_set_initial_step1(inner.get(), first_step);
      made(nlopt_set_local_optimizer(opt.get(), inner.get()));  // copies it
    }
    Callback goal{trials, opt.get(), 0, 0};
    nlopt_set_min_objective(opt.get(), objective, &goal);
    std::vector<Callback> callbacks;
    callbacks.reserve(trials.margins());
    for (std::size_t m = 0; m < trials.margins(); ++m) {
      callbacks.push_back({trials, opt.get(), m, tighten});
      made(nlopt_add_inequality_constraint(opt.get(), constraint, &callbacks.back(), 0));
    }
    double value = 0;
    const nlopt_result result = nlopt_optimize(opt.get(), u.data(), &value);
    made(result);
    const char* detail = nlopt_get_errmsg(opt.get());
    SolverEnd end{result > 0, nlopt_result_to_string(result), std::move(u)};
    if (detail) end.message += std::string(": ") + detail;
    return end;
  }

 private:
  void set_stops(nlopt_opt opt) const {
    nlopt_set_ftol_rel(opt, options_.number("ftol"));
    nlopt_set_xtol_abs1(opt, options_.number("xtol"));
  }

  Options options_;
};

Capabilities capabilities(const Options& options) {
  return solver_capabilities(options, algorithm_called(options.word("algorithm")).constraints, uses_gradient(options));
}

std::unique_ptr<Optimiser> make(const Options& options, const DesignSpace&) {
  const Algorithm& outer = algorithm_called(options.word("algorithm"));
  if (options.integer("population") > 0 && !outer.population) {
    std::vector<std::string> with;
    for (const Algorithm& a : kAlgorithms)
      if (a.population) with.push_back(a.name);
    throw std::invalid_argument("population = " + std::to_string(options.integer("population")) +
                                " for the algorithm " + outer.name + ", which has none; those with a population are " +
                                join(with));
  }
  SolverPlan plan = solver_plan(options);
  if (plan.scalarisation.kind != Scalarisation::Kind::none && !outer.constraints)
    throw std::invalid_argument("start = \"pareto\" for the algorithm " + std::string(outer.name) +
                                ", which handles no constraints, as it would have to");
  plan.solver = std::make_shared<NloptSolver>(options);
  plan.detail = uses_gradient(options) ? Detail::derivatives : Detail::complete;
  return make_solver_stage(std::move(plan));
}

std::vector<OptionSpec> options() {
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
                                   word_option("inner", inner, "auglag and mlsl: the algorithm inside")};
  for (auto& spec : solver_options()) specs.push_back(std::move(spec));
  specs.push_back(number_option("ftol", 1e-13, 0, 1, "stop when a step changes the objective relatively less"));
  specs.push_back(number_option("xtol", 1e-10, 0, 1, "stop when a step is shorter, in units of the ranges"));
  specs.push_back(tighten_option());
  specs.push_back(
      number_option("initial_step", 0.1, 1e-9, 1, "first step without derivatives, in units of the ranges"));
  specs.push_back(
      integer_option("population", std::int64_t{0}, 0, 1e6, "isres, crs2, mlsl: population (0: NLopt's choice)"));
  return specs;
}

}  // namespace

OptimiserEntry nlopt_stage() {
  return {.name = "nlopt",
          .meaning = "NLopt: local refinement by gradients, and searches without them",
          .capabilities = capabilities,
          .options = options(),
          .make = make};
}

}  // namespace pkm
