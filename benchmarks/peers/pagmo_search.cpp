#include "benchmarks/peers/pagmo_search.hpp"

#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <limits>
#include <map>
#include <numbers>
#include <stdexcept>
#include <string>
#include <utility>

#include <pagmo/algorithm.hpp>
#include <pagmo/algorithms/cmaes.hpp>
#include <pagmo/algorithms/cstrs_self_adaptive.hpp>
#include <pagmo/algorithms/nsga2.hpp>
#include <pagmo/algorithms/sade.hpp>
#include <pagmo/algorithms/sga.hpp>
#include <pagmo/population.hpp>
#include <pagmo/problem.hpp>
#include <pagmo/problems/unconstrain.hpp>

namespace pkm::peers {
namespace {

struct Reached {};
struct Exhausted {};

double violation(const std::vector<double>& margins) {
  double sum = 0;
  for (const double margin : margins) sum -= std::fmin(margin, 0);
  return sum;
}

/// Evaluates and counts the candidates of one search. Exceptions end the search.
class CandidateEvaluator {
 public:
  CandidateEvaluator(const Task& of, double limit, double target) : task(of), limit_(limit), target_(target) {}

  /// Evaluates a candidate. @throws Reached at the target, Exhausted after the maximum number of candidates
  Candidate next(const std::vector<double>& design) {
    if (candidates_ >= limit_) throw Exhausted();
    ++candidates_;
    Candidate candidate = task.evaluate(design);
    if (violation(candidate.margins) == 0) best_ = std::fmax(best_, candidate.ratio);
    if (best_ >= target_) throw Reached();
    return candidate;
  }
  double candidates() const { return candidates_; }
  double best() const { return best_; }

  const Task& task;

 private:
  double limit_, target_, candidates_ = 0, best_ = 0;
};

/// The problem for single-objective optimisers: minimise -ratio subject to inequality constraints.
struct Constrained {
  CandidateEvaluator* evaluator = nullptr;

  pagmo::vector_double fitness(const pagmo::vector_double& design) const {
    const auto [ratio, margins] = evaluator->next(design);
    pagmo::vector_double values{-ratio};
    for (const double margin : margins) values.push_back(-margin);
    return values;
  }
  pagmo::vector_double::size_type get_nic() const { return evaluator->task.constraints; }
  std::pair<pagmo::vector_double, pagmo::vector_double> get_bounds() const {
    return {evaluator->task.lower, evaluator->task.upper};
  }
};

/// The problem for nsga2, which needs two objectives and does not support constraints: the ratio and the violation or,
/// without constraints, the ratio and the volume.
struct TwoObjectives : Constrained {
  pagmo::vector_double fitness(const pagmo::vector_double& design) const {
    const auto [ratio, margins] = evaluator->next(design);
    const double volume = ratio * std::numbers::pi * design[1] * (design[2] + design[3]);
    return {-ratio, margins.empty() ? -volume : violation(margins)};
  }
  pagmo::vector_double::size_type get_nobj() const { return 2; }
  pagmo::vector_double::size_type get_nic() const { return 0; }
};

struct Tool {
  unsigned population;
  pagmo::problem (*problem)(CandidateEvaluator& evaluator);
  pagmo::algorithm (*algorithm)(unsigned generations, unsigned seed);
};

pagmo::problem constrained(CandidateEvaluator& evaluator) { return pagmo::problem{Constrained{&evaluator}}; }

/// The l1 penalty of pagmo's `unconstrain`; its weight exceeds every multiplier of the optimum (0.2 rad/m).
pagmo::problem penalised(CandidateEvaluator& evaluator) {
  if (evaluator.task.constraints == 0) return constrained(evaluator);
  const pagmo::vector_double weights(evaluator.task.constraints, 10.0);
  return pagmo::problem{pagmo::unconstrain{Constrained{&evaluator}, "weighted", weights}};
}

pagmo::problem two_objectives(CandidateEvaluator& evaluator) { return pagmo::problem{TwoObjectives{{&evaluator}}}; }

template <class Algorithm>
pagmo::algorithm with_defaults(unsigned generations, unsigned seed) {
  pagmo::algorithm algorithm{Algorithm{generations}};
  algorithm.set_seed(seed);
  return algorithm;
}

/// CMA-ES with default settings and candidates projected onto the bounds.
pagmo::algorithm cmaes(unsigned generations, unsigned seed) {
  return pagmo::algorithm{pagmo::cmaes{generations, -1, -1, -1, -1, 0.5, 1e-6, 1e-6, false, true, seed}};
}

/// pagmo's self-adaptive constraint handling: penalties are updated every few generations.
template <class Algorithm>
pagmo::algorithm self_adaptive(unsigned generations, unsigned seed) {
  constexpr unsigned kInner = 5;
  return pagmo::algorithm{
      pagmo::cstrs_self_adaptive{generations / kInner, with_defaults<Algorithm>(kInner, seed), seed}};
}

const std::map<std::string, Tool> kTools = {
    {"sga", {20, penalised, with_defaults<pagmo::sga>}},
    {"sga-self-adaptive", {20, constrained, self_adaptive<pagmo::sga>}},
    {"sade", {20, penalised, with_defaults<pagmo::sade>}},
    {"sade-self-adaptive", {20, constrained, self_adaptive<pagmo::sade>}},
    {"cmaes", {20, penalised, cmaes}},
    {"cmaes-8", {8, penalised, cmaes}},
    {"nsga2", {20, two_objectives, with_defaults<pagmo::nsga2>}},
};

void evolve(const Tool& tool, CandidateEvaluator& evaluator, unsigned seed, unsigned generations) {
  tool.algorithm(generations, seed).evolve(pagmo::population{tool.problem(evaluator), tool.population, seed});
}

void run_generations(const Task& task, const Tool& tool, unsigned generations, unsigned seed) {
  constexpr double kUnlimited = std::numeric_limits<double>::infinity();
  CandidateEvaluator evaluator(task, kUnlimited, kUnlimited);
  const auto begin = std::chrono::steady_clock::now();
  evolve(tool, evaluator, seed, generations);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
  std::printf("{\"candidates\": %.0f, \"seconds\": %.9f}\n", evaluator.candidates(), seconds.count());
}

void run_search(const Task& task, const Tool& tool, unsigned seeds, unsigned limit) {
  const std::clock_t start = std::clock();
  for (unsigned seed = 1; seed <= seeds; ++seed) {
    CandidateEvaluator evaluator(task, limit, task.target);
    const std::clock_t begin = std::clock();
    bool reached = false;
    try {
      evolve(tool, evaluator, seed, limit);  // the candidates end the search, not the generations
    } catch (const Reached&) {
      reached = true;
    } catch (const Exhausted&) {
    }
    const double cpu = static_cast<double>(start + std::clock() - begin) / CLOCKS_PER_SEC;
    std::printf("%s{\"reached\": %s, \"tried\": %.0f, \"best\": %.9f, \"cpu\": %.9f}", seed == 1 ? "[" : ",\n ",
                reached ? "true" : "false", evaluator.candidates(), evaluator.best(), cpu);
  }
  std::printf("]\n");
}

}  // namespace

void run_pagmo(const std::string& tool, const Task& task, std::span<char* const> action) {
  const std::string name = action.size() == 3 ? action[0] : "";
  const auto run = name == "generations" ? run_generations : name == "search" ? run_search : nullptr;
  if (!run || !kTools.contains(tool)) throw std::invalid_argument("unknown action or tool " + tool);
  const auto number = [&](std::size_t i) { return static_cast<unsigned>(std::stoul(action[i])); };
  run(task, kTools.at(tool), number(1), number(2));
}

}  // namespace pkm::peers
