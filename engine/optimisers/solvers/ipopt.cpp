// Ipopt with exact gradients and a limited-memory Hessian.
//
// Debian's MUMPS is not thread-safe and Ipopt 3.11 does not guard it, so one lock is held from the construction of an
// application to its destruction. Its file ipopt.opt in the working folder is never read. An exception in a callback
// ends the solver with a status of its own; that is also how a stop gets out at once.
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

std::mutex ipopt_lock;

struct StopNow {};

class Program final : public Ipopt::TNLP {
 public:
  using Index = Ipopt::Index;
  using Number = Ipopt::Number;

  Program(Trials& trials, const std::vector<double>& from, double tighten)
      : trials_(trials), from_(from), tighten_(tighten) {}
  const std::vector<double>& solution() const { return solution_; }

  bool get_nlp_info(Index& n, Index& m, Index& jacobian, Index& hessian, IndexStyleEnum& style) override {
    n = static_cast<Index>(trials_.dimension());
    m = static_cast<Index>(trials_.margins());
    jacobian = n * m;
    hessian = 0;
    style = C_STYLE;
    return true;
  }
  bool get_bounds_info(Index n, Number* lower, Number* upper, Index m, Number* least, Number* greatest) override {
    std::fill_n(lower, n, 0.0);
    std::fill_n(upper, n, 1.0);
    std::fill_n(least, m, tighten_);
    std::fill_n(greatest, m, 2e19);  // Ipopt's infinity begins at 1e19
    return true;
  }
  bool get_starting_point(Index, bool, Number* u, bool, Number*, Number*, Index, bool, Number*) override {
    std::ranges::copy(from_, u);
    return true;
  }
  bool eval_f(Index, const Number* u, bool, Number& value) override {
    const Trials::Point& point = at(u);
    value = point.objective;
    return point.usable;  // false: Ipopt cuts its step
  }
  bool eval_grad_f(Index, const Number* u, bool, Number* gradient) override {
    const Trials::Point& point = at(u);
    std::ranges::copy(point.gradient, gradient);
    return point.usable;
  }
  bool eval_g(Index, const Number* u, bool, Index, Number* margins) override {
    const Trials::Point& point = at(u);
    std::ranges::copy(point.margins, margins);
    return point.usable;
  }
  bool eval_jac_g(Index n, const Number* u, bool, Index m, Index, Index* row, Index* column, Number* values) override {
    if (!values) {  // the structure: full
      for (Index k = 0; k < n * m; ++k) {
        row[k] = k / n;
        column[k] = k % n;
      }
      return true;
    }
    const Trials::Point& point = at(u);
    std::ranges::copy(point.margin_gradient, values);
    return point.usable;
  }
  void finalize_solution(Ipopt::SolverReturn, Index n, const Number* u, const Number*, const Number*, Index,
                         const Number*, const Number*, Number, const Ipopt::IpoptData*,
                         Ipopt::IpoptCalculatedQuantities*) override {
    solution_.assign(u, u + n);
  }

 private:
  const Trials::Point& at(const Number* u) {
    const Trials::Point* point = trials_.at(u);
    if (!point) throw StopNow{};
    return *point;
  }

  Trials& trials_;
  const std::vector<double>& from_;
  double tighten_;
  std::vector<double> solution_;
};

/// "" or what is wrong with an option.
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
      return "Ipopt's option " + name + " = " + shown + ", which must be a number in Ipopt's range for it";
    case OT_Integer:
      // Ipopt's integers are shorter than ours.
      if (whole && std::in_range<Index>(*whole) && option->IsValidIntegerSetting(static_cast<Index>(*whole)) &&
          options->SetIntegerValue(name, static_cast<Index>(*whole)))
        return "";
      return "Ipopt's option " + name + " = " + shown + ", which must be an integer in Ipopt's range for it";
    case OT_String:
      if (text && option->IsValidStringSetting(*text) && options->SetStringValue(name, *text)) return "";
      return "Ipopt's option " + name + " = " + shown + ", which must be one of Ipopt's words for it";
    case OT_Unknown:
      break;
  }
  return "Ipopt's option " + name + " is of an unknown kind";
}

/// Options that belong to the stage: it would not work as it promises with others.
const char* const kReserved[] = {"hessian_approximation", "max_iter",        "output_file", "print_level", "sb",
                                 "bound_relax_factor",    "option_file_name"};

/// How Ipopt ended, in words.
std::string text(Ipopt::ApplicationReturnStatus status) {
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

  /// Throws std::invalid_argument for an option that Ipopt does not take. The lock must be held.
  Ipopt::SmartPtr<Ipopt::IpoptApplication> application() const {
    Ipopt::SmartPtr<Ipopt::IpoptApplication> made = new Ipopt::IpoptApplication(false);
    const auto options = made->Options();
    options->SetStringValue("sb", "yes");  // no banner
    options->SetIntegerValue("print_level", 0);
    options->SetStringValue("hessian_approximation", "limited-memory");
    options->SetIntegerValue("max_iter", 1000000);  // the stage counts evaluations
    options->SetNumericValue("bound_relax_factor", 0);
    options->SetNumericValue("tol", 1e-9);
    options->SetStringValue("mu_strategy", "adaptive");
    if (options_.has("options"))
      for (const auto& [name, value] : options_.settings("options")) {
        std::string wrong = set_option(*made, name, value);
        if (std::ranges::find(kReserved, name) != std::end(kReserved))
          wrong = "Ipopt's option " + name + " is set by the stage and cannot be changed";
        if (!wrong.empty()) throw std::invalid_argument(wrong);
      }
    if (made->Initialize("") != Ipopt::Solve_Succeeded)
      throw std::runtime_error("Ipopt does not start with these options");
    return made;
  }

  SolverEnd solve(Trials& trials, const std::vector<double>& from, std::uint64_t) const override {
    const std::lock_guard guard(ipopt_lock);
    const auto app = application();
    const Ipopt::SmartPtr<Program> program = new Program(trials, from, options_.number("tighten"));
    const Ipopt::ApplicationReturnStatus status = app->OptimizeTNLP(program);
    if (status == Ipopt::Insufficient_Memory) throw std::bad_alloc();
    return {status == Ipopt::Solve_Succeeded || status == Ipopt::Solved_To_Acceptable_Level, text(status),
            program->solution()};
  }

 private:
  Options options_;
};

Capabilities capabilities(const Options& options) { return solver_capabilities(options, true, true); }

std::unique_ptr<Optimiser> make(const Options& options, const DesignSpace&) {
  SolverPlan plan = solver_plan(options);
  const auto solver = std::make_shared<IpoptSolver>(options);
  {
    const std::lock_guard guard(ipopt_lock);
    solver->application();  // refuses what Ipopt does not take
  }
  plan.solver = solver;
  plan.side_by_side = false;
  plan.detail = Detail::derivatives;
  return make_solver_stage(std::move(plan));
}

std::vector<OptionSpec> options() {
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
          .meaning = "Ipopt: interior-point refinement by gradients",
          .capabilities = capabilities,
          .options = options(),
          .make = make};
}

}  // namespace pkm
