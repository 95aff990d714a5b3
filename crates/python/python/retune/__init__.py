"""Tune vibration dampers, and trust the numbers.

A ``Problem`` is a structure, what makes it move, a damper, and what is to be made small. It is a function of a design, which SciPy,
Optuna and others can make small, and it can be simulated, swept, optimized, certified and compared by Retune's own library. All numbers
are in SI units (kg, N/m, N s/m, N, m, s, rad/s), or texts with a unit ("20 kN/m"), all parameters have the symbols of the paper.

>>> import retune as rt
>>> problem = rt.Problem(rt.Structure(m1=1000, c1=452, k1=3.95e4), rt.TMD(60, k2=1900, c2=150), P=800, band=(5, 8),
...                      vary=["k2", "c2"], bounds={"k2": (10, 4000), "c2": (0, 1000)}, response="steady")
>>> round(problem([1900.0, 150.0]))
222
"""

from retune._compare import Comparison, compare
from retune._core import __version__
from retune._errors import Error, SolverError, StudyError
from retune._files import Design, certify_file, design, fronts, losses, merge, reproduce, retention, share, sweep, table2
from retune._forcing import Pulse, Record
from retune._jobs import Certificate, Result, branches, certify, optimize, prove, verify
from retune._problem import Evaluation, Problem
from retune._run import Run
from retune._scene import SSVI, TMD, Contact, Structure
from retune._table import Table

__all__ = [
    "SSVI",
    "TMD",
    "Certificate",
    "Comparison",
    "Contact",
    "Design",
    "Error",
    "Evaluation",
    "Problem",
    "Pulse",
    "Record",
    "Result",
    "Run",
    "SolverError",
    "Structure",
    "StudyError",
    "Table",
    "__version__",
    "branches",
    "certify",
    "certify_file",
    "compare",
    "design",
    "fronts",
    "losses",
    "merge",
    "optimize",
    "prove",
    "reproduce",
    "retention",
    "share",
    "sweep",
    "table2",
    "verify",
]
