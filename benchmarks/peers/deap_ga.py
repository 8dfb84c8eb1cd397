"""DEAP's eaSimple with the parameters of its documentation (tournament of 3, crossover 0.5, mutation 0.2), the bounded
operators of its examples for real variables (eta 20, one variable in four mutated), and DeltaPenalty for the
constraints."""

import random

from deap import algorithms, base, creator, tools

from trials import margins, violation

creator.create("Fitness", base.Fitness, weights=(1.0,))
creator.create("Individual", list, fitness=creator.Fitness)


def search(trials, seed, population, generations):
    random.seed(seed)
    problem = trials.problem
    box = {"low": problem.lower, "up": problem.upper}
    toolbox = base.Toolbox()
    toolbox.register("individual", lambda: creator.Individual(map(random.uniform, problem.lower, problem.upper)))
    toolbox.register("population", tools.initRepeat, list, toolbox.individual)
    toolbox.register("evaluate", lambda design: (trials.ratio(design),))
    toolbox.decorate("evaluate", tools.DeltaPenalty(lambda design: violation(trials.margins(design)) == 0, 0.0,
                                                    lambda design: violation(margins(problem, design))))
    toolbox.register("mate", tools.cxSimulatedBinaryBounded, eta=20.0, **box)
    toolbox.register("mutate", tools.mutPolynomialBounded, eta=20.0, indpb=1 / len(problem.lower), **box)
    toolbox.register("select", tools.selTournament, tournsize=3)
    algorithms.eaSimple(toolbox.population(population), toolbox, cxpb=0.5, mutpb=0.2, ngen=generations, verbose=False)
