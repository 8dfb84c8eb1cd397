"""pkmopt: kinematics, workspaces and optimisation of parallel robots.

Mechanisms and their designs: :class:`Mechanism`, :class:`Design`, :class:`Workspace`. Design problems and studies:
:class:`Problem`, :class:`Study`, :class:`Results`. The optimisers for functions of your own: :class:`Optimiser`. A
mechanism described in Python: :func:`describe`.

Lengths are in m, angles in rad, everything else in SI units; where a value is given, a text with a unit such as "30 mm"
is accepted, too. Functions on arrays use all cores (``threads``), release the interpreter's lock, and end by Ctrl-C.
"""

from ._library import DesignError, Error, FileError, InputError, InternalError, Progress, Stopped, version
from .formulas import Description, describe
from .mechanism import (
    Design,
    Dynamics,
    Fields,
    Limit,
    Links,
    Mechanism,
    Parameter,
    Quantity,
    Surface,
    Workspace,
    mechanism_names,
)
from .optimiser import Optimiser, Told, optimiser_names
from .study import (
    FAILED,
    FEASIBLE,
    INFEASIBLE,
    REJECTED,
    Derivatives,
    Evaluation,
    Problem,
    Results,
    ScipyProblem,
    Study,
    Variable,
    open_study,
    resume,
)

__version__ = version

__all__ = [name for name in dir() if not name.startswith("_")]
