#include "engine/optimisers/evolutionary/breeding_plan.hpp"

#include <algorithm>

#include "engine/optimisers/option_specs.hpp"

namespace pkm {
namespace {

// Permitted values of those options of breeding_options() that are words; the position of each value is the number of
// the enumerator that it selects.
const std::vector<std::string> kSamplingMethods = {"sobol", "latin-hypercube", "random"};
const std::vector<std::string> kSelections = {"tournament", "linear-ranking"};
const std::vector<std::string> kCrossovers = {"differential", "sbx", "blend", "scattered"};
const std::vector<std::string> kMutations = {"multiscale", "gaussian", "polynomial", "uniform"};

template <class Enum>
Enum choice(const Options& options, const std::string& name, const std::vector<std::string>& words) {
  return static_cast<Enum>(std::find(words.begin(), words.end(), options.word(name)) - words.begin());
}

}  // namespace

std::vector<OptionSpec> breeding_options() {
  return {
      integer_option("population", {}, 4, 1e6, "designs per generation (default: 5 per variable, at least 20)"),
      word_option("start", kSamplingMethods, "sampling method of the initial population"),
      word_option("selection", kSelections, "parent selection; linear-ranking uses stochastic universal sampling"),
      integer_option("tournament_size", std::int64_t{2}, 1, 1e6, "tournament: number of members compared"),
      number_option("selection_pressure", 2.0, 1, 2,
                    "linear-ranking: expected number of children of the best member, relative to the average"),
      word_option("crossover", kCrossovers, "crossover operator; scattered is discrete recombination"),
      number_option("crossover_probability", 0.85, 0, 1,
                    "fraction of children made by crossover; the others start as copies of a parent"),
      number_option("crossover_eta", 15.0, 0, 1000,
                    "sbx: distribution index; larger values keep children closer to the parents"),
      word_option("mutation", kMutations, "mutation operator"),
      number_option("mutation_probability", {}, 0, 1,
                    "probability of mutating a variable of a child (default: 1 / number of variables; differential: a "
                    "fifth of that)"),
      number_option("mutation_sigma", 0.3, 0, 1,
                    "gaussian: standard deviation as a fraction of the range; multiscale: its largest value"),
      number_option("mutation_eta", 20.0, 0, 1000, "polynomial: distribution index; larger values make smaller steps"),
      flag_option("unique", true, "mutate children equal to an evaluated design until they are new"),
  };
}

void resolve_breeding(Options& options, const DesignSpace& space) {
  const auto n = static_cast<std::int64_t>(space.dimension());
  if (!options.has("population")) options.set("population", std::max<std::int64_t>(20, 5 * n));
  if (options.has("mutation_probability")) return;
  const bool differential = choice<Crossover::Kind>(options, "crossover", kCrossovers) == Crossover::Kind::differential;
  options.set("mutation_probability", (differential ? 0.2 : 1.0) / static_cast<double>(n));
}

BreedingPlan breeding_plan(Options options, const DesignSpace& space) {
  resolve_breeding(options, space);
  BreedingPlan plan;
  plan.population = static_cast<std::size_t>(options.integer("population"));
  plan.sampling = choice<Start>(options, "start", kSamplingMethods);
  plan.selection.kind = choice<Selection::Kind>(options, "selection", kSelections);
  plan.selection.tournament_size = options.integer("tournament_size");
  plan.selection.pressure = options.number("selection_pressure");
  plan.crossover.kind = choice<Crossover::Kind>(options, "crossover", kCrossovers);
  plan.crossover.eta = options.number("crossover_eta");
  plan.crossover_probability = options.number("crossover_probability");
  plan.mutation.kind = choice<Mutation::Kind>(options, "mutation", kMutations);
  plan.mutation.sigma = options.number("mutation_sigma");
  plan.mutation.eta = options.number("mutation_eta");
  plan.mutation_probability = options.number("mutation_probability");
  plan.unique = options.flag("unique");
  return plan;
}

}  // namespace pkm
