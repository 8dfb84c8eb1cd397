"""scipy's differential_evolution with default settings (best1bin, mutation 0.5 to 1, recombination 0.7, Latin
hypercube), except that polishing is off, because voxel counts have no gradients, and that the tolerance is 0, which
prevents stopping early."""

import numpy as np
from scipy.optimize import Bounds, NonlinearConstraint, differential_evolution


def search(trials, seed, population, generations):
    problem = trials.problem

    # With constraints, scipy evaluates the constraints of a candidate first, and its ratio only if they are satisfied.
    # (Constructing the constraint evaluates five designs for finite differences, which are counted.)
    def objective(design):
        if not problem.constrained:
            trials.margins(design)
        return -trials.ratio(design)

    constraints = NonlinearConstraint(trials.margins, 0, np.inf) if problem.constrained else ()
    differential_evolution(objective, Bounds(problem.lower, problem.upper), constraints=constraints, seed=seed,
                           popsize=population // len(problem.lower), maxiter=generations, tol=0, polish=False)
