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

/// Candidates of one search, until one of them ends it.
class Trials {
 public:
  Trials(const Task& of, double limit, double target) : task(of), limit_(limit), target_(target) {}

  /// @throws Reached, Exhausted
  Candidate next(const std::vector<double>& design) {
    if (made_ >= limit_) throw Exhausted();
    ++made_;
    Candidate candidate = task.evaluate(design);
    if (violation(candidate.margins) == 0) best_ = std::fmax(best_, candidate.ratio);
    if (best_ >= target_) throw Reached();
    return candidate;
  }
  double made() const { return made_; }
  double best() const { return best_; }

  const Task& task;

 private:
  double limit_, target_, made_ = 0, best_ = 0;
};

/// As single-objective optimisers take it.
struct Constrained {
  Trials* trials = nullptr;

  pagmo::vector_double fitness(const pagmo::vector_double& design) const {
    const auto [ratio, margins] = trials->next(design);
    pagmo::vector_double values{-ratio};
    for (const double margin : margins) values.push_back(-margin);
    return values;
  }
  pagmo::vector_double::size_type get_nic() const { return trials->task.constraints; }
  std::pair<pagmo::vector_double, pagmo::vector_double> get_bounds() const {
    return {trials->task.lower, trials->task.upper};
  }
};

/// As nsga2 takes it, which asks for two objectives and knows no constraints: the ratio and the violation, or without
/// constraints the ratio and the volume.
struct TwoObjectives : Constrained {
  pagmo::vector_double fitness(const pagmo::vector_double& design) const {
    const auto [ratio, margins] = trials->next(design);
    const double volume = ratio * std::numbers::pi * design[1] * (design[2] + design[3]);
    return {-ratio, margins.empty() ? -volume : violation(margins)};
  }
  pagmo::vector_double::size_type get_nobj() const { return 2; }
  pagmo::vector_double::size_type get_nic() const { return 0; }
};

struct Tool {
  unsigned population;
  pagmo::problem (*problem)(Trials& trials);
  pagmo::algorithm (*algorithm)(unsigned generations, unsigned seed);
};

pagmo::problem constrained(Trials& trials) { return pagmo::problem{Constrained{&trials}}; }

/// The l1 penalty of pagmo's `unconstrain`; its weight exceeds every multiplier of the optimum (0.2 rad/m).
pagmo::problem penalised(Trials& trials) {
  if (trials.task.constraints == 0) return constrained(trials);
  const pagmo::vector_double weights(trials.task.constraints, 10.0);
  return pagmo::problem{pagmo::unconstrain{Constrained{&trials}, "weighted", weights}};
}

pagmo::problem two_objectives(Trials& trials) { return pagmo::problem{TwoObjectives{{&trials}}}; }

template <class Algorithm>
pagmo::algorithm by_default(unsigned generations, unsigned seed) {
  pagmo::algorithm algorithm{Algorithm{generations}};
  algorithm.set_seed(seed);
  return algorithm;
}

/// The defaults, with candidates kept within the bounds.
pagmo::algorithm cmaes(unsigned generations, unsigned seed) {
  return pagmo::algorithm{pagmo::cmaes{generations, -1, -1, -1, -1, 0.5, 1e-6, 1e-6, false, true, seed}};
}

/// pagmo's other way with constraints: penalties that change every few generations.
template <class Algorithm>
pagmo::algorithm self_adaptive(unsigned generations, unsigned seed) {
  constexpr unsigned kInner = 5;
  return pagmo::algorithm{pagmo::cstrs_self_adaptive{generations / kInner, by_default<Algorithm>(kInner, seed), seed}};
}

const std::map<std::string, Tool> kTools = {
    {"sga", {20, penalised, by_default<pagmo::sga>}},
    {"sga-self-adaptive", {20, constrained, self_adaptive<pagmo::sga>}},
    {"sade", {20, penalised, by_default<pagmo::sade>}},
    {"sade-self-adaptive", {20, constrained, self_adaptive<pagmo::sade>}},
    {"cmaes", {20, penalised, cmaes}},
    {"cmaes-8", {8, penalised, cmaes}},
    {"nsga2", {20, two_objectives, by_default<pagmo::nsga2>}},
};

void evolve(const Tool& tool, Trials& trials, unsigned seed, unsigned generations) {
  tool.algorithm(generations, seed).evolve(pagmo::population{tool.problem(trials), tool.population, seed});
}

void run_generations(const Task& task, const Tool& tool, unsigned generations, unsigned seed) {
  constexpr double kAll = std::numeric_limits<double>::infinity();
  Trials trials(task, kAll, kAll);
  const auto begin = std::chrono::steady_clock::now();
  evolve(tool, trials, seed, generations);
  const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
  std::printf("{\"candidates\": %.0f, \"seconds\": %.9f}\n", trials.made(), seconds.count());
}

void run_search(const Task& task, const Tool& tool, unsigned seeds, unsigned limit) {
  const std::clock_t start = std::clock();
  for (unsigned seed = 1; seed <= seeds; ++seed) {
    Trials trials(task, limit, task.target);
    const std::clock_t begin = std::clock();
    bool reached = false;
    try {
      evolve(tool, trials, seed, limit);  // more generations than candidates are allowed
    } catch (const Reached&) {
      reached = true;
    } catch (const Exhausted&) {
    }
    const double cpu = static_cast<double>(start + std::clock() - begin) / CLOCKS_PER_SEC;
    std::printf("%s{\"reached\": %s, \"tried\": %.0f, \"best\": %.9f, \"cpu\": %.9f}", seed == 1 ? "[" : ",\n ",
                reached ? "true" : "false", trials.made(), trials.best(), cpu);
  }
  std::printf("]\n");
}

}  // namespace

void run_pagmo(const std::string& tool, const Task& task, std::span<char* const> action) {
  const std::string name = action.size() == 3 ? action[0] : "";
  const auto run = name == "generations" ? run_generations : name == "search" ? run_search : nullptr;
  if (!run || !kTools.contains(tool)) throw std::invalid_argument("there is no such action, or no tool " + tool);
  const auto number = [&](std::size_t i) { return static_cast<unsigned>(std::stoul(action[i])); };
  run(task, kTools.at(tool), number(1), number(2));
}

}  // namespace pkm::peers
