"""scipy's differential_evolution with its defaults (best1bin, mutation 0.5 to 1, recombination 0.7, Latin hypercube),
but for the polish, which needs gradients that counts do not have, and the tolerance, which would stop early."""

import numpy as np
from scipy.optimize import Bounds, NonlinearConstraint, differential_evolution


def search(trials, seed, population, generations):
    problem = trials.problem

    # With constraints scipy asks for a candidate's margins first, and for its ratio only if they hold. (Building the
    # constraint costs it five designs for finite differences, which are counted.)
    def objective(design):
        if not problem.constrained:
            trials.margins(design)
        return -trials.ratio(design)

    constraints = NonlinearConstraint(trials.margins, 0, np.inf) if problem.constrained else ()
    differential_evolution(objective, Bounds(problem.lower, problem.upper), constraints=constraints, seed=seed,
                           popsize=population // len(problem.lower), maxiter=generations, tol=0, polish=False)
