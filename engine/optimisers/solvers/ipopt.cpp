// Solver stage with Ipopt (interior-point method): exact gradients and a limited-memory quasi-Newton Hessian.
//
// Debian's MUMPS is not thread-safe and Ipopt 3.11 does not protect it. Therefore a mutex is locked from the
// construction of an Ipopt application to its destruction. A file ipopt.opt in the working folder is not read. An
// exception thrown by a callback ends the solver with a separate status; this is also used to stop a run.
#include <algorithm>
#include <map>
#include <mutex>
#include <new>
#include <stdexcept>
#include <utility>

#include <IpIpoptApplication.hpp>
#include <IpRegOptions.hpp>
#include <IpTNLP.hpp>

#include "engine/core/catalogue.hpp"
#include "engine/optimisers/list.hpp"
#include "engine/optimisers/option_specs.hpp"
#include "engine/optimisers/solvers/solver_stage.hpp"

namespace pkm {
namespace {

std::mutex ipopt_mutex;

struct StopRequested {};

/// Adapter from NonlinearProgram to Ipopt's interface.
class IpoptProblem final : public Ipopt::TNLP {
 public:
  using Index = Ipopt::Index;
  using Number = Ipopt::Number;

  IpoptProblem(NonlinearProgram& program, const std::vector<double>& start, double tighten)
      : program_(program), start_(start), tighten_(tighten) {}
  const std::vector<double>& solution() const { return solution_; }

  bool get_nlp_info(Index& n, Index& m, Index& jacobian, Index& hessian, IndexStyleEnum& style) override {
    n = static_cast<Index>(program_.dimension());
    m = static_cast<Index>(program_.constraints());
    jacobian = n * m;
    hessian = 0;
    style = C_STYLE;
    return true;
  }
  bool get_bounds_info(Index n, Number* lower, Number* upper, Index m, Number* g_lower, Number* g_upper) override {
    std::fill_n(lower, n, 0.0);
    std::fill_n(upper, n, 1.0);
    std::fill_n(g_lower, m, tighten_);
    std::fill_n(g_upper, m, 2e19);  // 2e19 is no upper bound: Ipopt treats values from 1e19 as infinite
    return true;
  }
  bool get_starting_point(Index, bool, Number* u, bool, Number*, Number*, Index, bool, Number*) override {
    std::ranges::copy(start_, u);
    return true;
  }
  bool eval_f(Index, const Number* u, bool, Number& value) override {
    const NonlinearProgram::Point& point = evaluate(u);
    value = point.objective;
    return point.usable;  // Ipopt reduces its step if false is returned
  }
  bool eval_grad_f(Index, const Number* u, bool, Number* gradient) override {
    const NonlinearProgram::Point& point = evaluate(u);
    std::ranges::copy(point.gradient, gradient);
    return point.usable;
  }
  bool eval_g(Index, const Number* u, bool, Index, Number* margins) override {
    const NonlinearProgram::Point& point = evaluate(u);
    std::ranges::copy(point.margins, margins);
    return point.usable;
  }
  bool eval_jac_g(Index n, const Number* u, bool, Index m, Index, Index* row, Index* column, Number* values) override {
    if (!values) {  // Ipopt requests the sparsity structure of the Jacobian, which is dense
      for (Index k = 0; k < n * m; ++k) {
        row[k] = k / n;
        column[k] = k % n;
      }
      return true;
    }
    const NonlinearProgram::Point& point = evaluate(u);
    std::ranges::copy(point.margin_jacobian, values);
    return point.usable;
  }
  void finalize_solution(Ipopt::SolverReturn, Index n, const Number* u, const Number*, const Number*, Index,
                         const Number*, const Number*, Number, const Ipopt::IpoptData*,
                         Ipopt::IpoptCalculatedQuantities*) override {
    solution_.assign(u, u + n);
  }

 private:
  const NonlinearProgram::Point& evaluate(const Number* u) {
    const NonlinearProgram::Point* point = program_.evaluate(u);
    if (!point) throw StopRequested{};
    return *point;
  }

  NonlinearProgram& program_;
  const std::vector<double>& start_;
  double tighten_;
  std::vector<double> solution_;
};

/// Sets an option of Ipopt.
/// @return "", or an error message if Ipopt rejects the option
std::string set_option(Ipopt::IpoptApplication& application, const std::string& name, const Setting& value) {
  using namespace Ipopt;
  const SmartPtr<const RegisteredOption> option = application.RegOptions()->GetOption(name);
  if (!IsValid(option)) {
    std::vector<std::string> known;
    for (const auto& [each, ignored] : application.RegOptions()->RegisteredOptionsList()) known.push_back(each);
    return "Ipopt has no option '" + name + "'" + did_you_mean(name, known);
  }
  const auto options = application.Options();
  const auto* text = std::get_if<std::string>(&value);
  const auto* whole = std::get_if<std::int64_t>(&value);
  const double number = text ? 0 : whole ? static_cast<double>(*whole) : std::get<double>(value);
  const std::string shown = text ? '"' + *text + '"' : whole ? std::to_string(*whole) : shortest(number);
  switch (option->Type()) {
    case OT_Number:
      if (!text && option->IsValidNumberSetting(number) && options->SetNumericValue(name, number)) return "";
      return "Ipopt's option " + name + " = " + shown + " is invalid; expected a number in the option's range";
    case OT_Integer:
      // The value must fit into Ipopt's integer type, which has fewer bits.
      if (whole && std::in_range<Index>(*whole) && option->IsValidIntegerSetting(static_cast<Index>(*whole)) &&
          options->SetIntegerValue(name, static_cast<Index>(*whole)))
        return "";
      return "Ipopt's option " + name + " = " + shown + " is invalid; expected an integer in the option's range";
    case OT_String:
      if (text && option->IsValidStringSetting(*text) && options->SetStringValue(name, *text)) return "";
      return "Ipopt's option " + name + " = " + shown + " is invalid; expected one of the option's values";
    case OT_Unknown:
      break;
  }
  return "Ipopt's option " + name + " has an unsupported type";
}

/// Options that the stage sets itself and that a study must not change.
const char* const kReserved[] = {"hessian_approximation", "max_iter",        "output_file", "print_level", "sb",
                                 "bound_relax_factor",    "option_file_name"};

/// Status message in words for a return code of Ipopt.
std::string status_text(Ipopt::ApplicationReturnStatus status) {
  static const std::map<Ipopt::ApplicationReturnStatus, std::string> words = {
      {Ipopt::Solve_Succeeded, "optimal solution found"},
      {Ipopt::Solved_To_Acceptable_Level, "solved to acceptable level"},
      {Ipopt::Infeasible_Problem_Detected, "converged to a point of local infeasibility"},
      {Ipopt::Search_Direction_Becomes_Too_Small, "search direction becomes too small"},
      {Ipopt::Diverging_Iterates, "iterates diverge"},
      {Ipopt::Restoration_Failed, "restoration failed"},
      {Ipopt::Error_In_Step_Computation, "error in step computation"},
      {Ipopt::Invalid_Number_Detected, "a value or derivative is not a finite number"},
      {Ipopt::Not_Enough_Degrees_Of_Freedom, "not enough degrees of freedom"},
      {Ipopt::NonIpopt_Exception_Thrown, "stopped"},
  };
  const auto known = words.find(status);
  return known != words.end() ? known->second : "status " + std::to_string(static_cast<int>(status));
}

class IpoptSolver final : public Solver {
 public:
  explicit IpoptSolver(const Options& options) : options_(options) {}

  /// Creates an Ipopt application. Throws std::invalid_argument if an option is invalid. The caller must have locked
  /// `ipopt_mutex`.
  Ipopt::SmartPtr<Ipopt::IpoptApplication> application() const {
    Ipopt::SmartPtr<Ipopt::IpoptApplication> app = new Ipopt::IpoptApplication(false);
    const auto options = app->Options();
    options->SetStringValue("sb", "yes");  // Ipopt prints no banner
    options->SetIntegerValue("print_level", 0);
    options->SetStringValue("hessian_approximation", "limited-memory");
    // Ipopt's limit on iterations is practically infinite, because the stage limits the evaluations itself.
    options->SetIntegerValue("max_iter", 1000000);
    options->SetNumericValue("bound_relax_factor", 0);
    options->SetNumericValue("tol", 1e-9);
    options->SetStringValue("mu_strategy", "adaptive");
    if (options_.has("options"))
      for (const auto& [name, value] : options_.settings("options")) {
        std::string error = set_option(*app, name, value);
        if (std::ranges::find(kReserved, name) != std::end(kReserved))
          error = "Ipopt's option " + name + " is set by the stage and cannot be changed";
        if (!error.empty()) throw std::invalid_argument(error);
      }
    if (app->Initialize("") != Ipopt::Solve_Succeeded)
      throw std::runtime_error("Ipopt cannot be initialised with these options");
    return app;
  }

  SolverResult solve(NonlinearProgram& program, const std::vector<double>& start, std::uint64_t) const override {
    const std::lock_guard guard(ipopt_mutex);
    const auto app = application();
    const Ipopt::SmartPtr<IpoptProblem> problem = new IpoptProblem(program, start, options_.number("tighten"));
    const Ipopt::ApplicationReturnStatus status = app->OptimizeTNLP(problem);
    if (status == Ipopt::Insufficient_Memory) throw std::bad_alloc();
    return {status == Ipopt::Solve_Succeeded || status == Ipopt::Solved_To_Acceptable_Level, status_text(status),
            problem->solution()};
  }

 private:
  Options options_;
};

Capabilities ipopt_capabilities(const Options& options) { return solver_capabilities(options, true, true); }

std::unique_ptr<Optimiser> make_ipopt(const Options& options, const DesignSpace&) {
  SolverPlan plan = solver_plan(options);
  const auto solver = std::make_shared<IpoptSolver>(options);
  {
    const std::lock_guard guard(ipopt_mutex);
    solver->application();  // this application is created only to check the options
  }
  plan.solver = solver;
  plan.concurrent = false;
  plan.detail = Detail::derivatives;
  return make_solver_stage(std::move(plan));
}

std::vector<OptionSpec> ipopt_options() {
  std::vector<OptionSpec> specs = solver_options();
  specs.push_back(tighten_option());
  specs.push_back({.name = "options",
                   .kind = OptionKind::named_settings,
                   .meaning = "Ipopt's own options, such as { tol = 1e-10, mu_strategy = \"monotone\" }"});
  return specs;
}

}  // namespace

OptimiserEntry ipopt_stage() {
  return {.name = "ipopt",
          .meaning = "Ipopt: local optimisation by an interior-point method, with gradients",
          .capabilities = ipopt_capabilities,
          .options = ipopt_options(),
          .make = make_ipopt};
}

}  // namespace pkm
