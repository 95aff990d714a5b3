"""Jobs: searches, certificates, verification. They write the files of the command line, byte for byte."""

from __future__ import annotations

import json
import math
import os
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from retune import _core, _show
from retune._problem import Problem
from retune._progress import Progress
from retune._table import frame

if TYPE_CHECKING:
    import pandas as pd

#: The parameters of a damper that a table shows.
DESIGN = ("m2", "k2", "c2", "D", "C")

Directory = str | os.PathLike[str]


class Found:
    """What a job found, as the JSON file that holds it."""

    #: The fields of the file.
    data: dict[str, Any]

    def __init__(self, data: dict[str, Any]) -> None:
        self.data = data

    def __getitem__(self, name: str) -> Any:
        return self.data[name]

    def _rows(self) -> list[list[object]]:
        raise NotImplementedError

    def report(self) -> _show.Report:
        """A page of HTML, which a notebook shows."""
        return _show.report(type(self).__name__, self._repr_html_())

    def __repr__(self) -> str:
        return _show.text(["", ""], self._rows())

    def _repr_html_(self) -> str:
        return _show.page(["", ""], self._rows())


class Result(Found):
    """What a search found; ``optimum.json`` as ``data``, the other files in ``out``."""

    #: The design, in the order of ``problem.names``.
    x: NDArray[np.float64]
    #: The quantity there.
    fun: float
    #: Whether it keeps the limits.
    success: bool
    #: For "damper", "none" and the best linear "TMD" the largest value of each measure over all that the answer covers, from rest on, with its
    #: place: ``result.needs["damper"]["a1max"]["value"]``, ``["omega"]``, ``["k1"]``; empty where the design cannot be run.
    needs: dict[str, Any]
    #: The directory of the results; ``report.html`` is the page to open first.
    out: Path
    problem: Problem

    def __init__(self, problem: Problem, out: Path) -> None:
        super().__init__(json.loads((out / "optimum.json").read_text(encoding="utf-8")))
        self.problem, self.out, self._page = problem, out, (out / "report.html").absolute()
        self.x = np.array([self.data[name] for name in problem.names])
        self.fun = float(self.data[problem.quantity[0]])
        self.success = self.data["certificate"]["verdict"] is not None
        self.needs = self.data.get("needs") or {}

    def report(self) -> _show.Report:
        """``report.html`` of the results, which a notebook shows."""
        return _show.Report(self._page.read_text(encoding="utf-8"))

    def to_pandas(self) -> pd.DataFrame:
        """The design as a row of a pandas DataFrame, in SI units: the damper, its parameters, the quantity with it and without, the verdict."""
        return frame([self._row()])

    def _row(self) -> dict[str, Any]:
        quantity = self.problem.quantity[0]
        design = {name: self.data.get(name, math.nan) for name in DESIGN}
        none = self.data.get(f"{quantity}_none", math.nan)
        values = {quantity: self.fun, f"{quantity}_none": none}
        return {"damper": self.data["damper_type"], **design, **values, "verdict": self.data["certificate"]["verdict"]}

    def _rows(self) -> list[list[object]]:
        quantity, unit = self.problem.quantity
        design = [[name, f"{_show.number(float(value))} {unit}"] for name, value, unit in zip(self.problem.names, self.x, self.problem.units)]
        verdict = self.data["certificate"]["words"]
        return [[quantity, f"{_show.number(self.fun)} {unit}"], *design, ["verdict", verdict], ["results", str(self.out)]]

    def _repr_html_(self) -> str:
        return _show.page(["", ""], self._rows(), f"{self.data['damper_type']} of {self.problem.study['name']}")


class Certificate(Found):
    """How far a design can be relied on; ``certificate.json`` as ``data``."""

    #: The verdict: "robust", "edge", "from rest only", "sensitive" or "single chaotic realisation"; None if limits are broken.
    verdict: str | None
    #: The verdict in words.
    words: str
    #: Largest difference between the methods and tolerances of the convergence study, in the unit of the value.
    error_bar: float

    def __init__(self, data: dict[str, Any]) -> None:
        super().__init__(data)
        self.verdict, self.words = data["verdict"], data["words"]
        self.error_bar = math.nan if data["error_bar"] is None else float(data["error_bar"])

    def to_pandas(self) -> pd.DataFrame:
        """How sensitive the value is, as a pandas DataFrame with a row for each parameter: its value, the slope per percent, and the worst value
        within one percent."""
        return frame(self.data["sensitivity"])

    def _rows(self) -> list[list[object]]:
        return [["verdict", self.words], ["methods differ by", self.error_bar], ["motion", self.data["motion"].get("regime")]]


def asked(
    out: Directory | None, resume: bool = False, restart: bool = False, replace: bool = False, threads: int | None = None
) -> dict[str, Any]:
    """What every job is asked."""
    return {"out": None if out is None else os.fspath(out), "resume": resume, "restart": restart, "replace": replace, "threads": threads}


def optimize(
    problem: Problem,
    out: Directory | None = None,
    *,
    resume: bool = False,
    restart: bool = False,
    replace: bool = False,
    threads: int | None = None,
    progress: bool = True,
) -> Result:
    """Makes the whole search of a problem, as `retune optimize` does: grid, global search, refinement, certificate, figures, report.

    The results go to ``out``, by default ``results/`` and the name of the problem. Ctrl-C ends the search, and ``resume=True`` goes on
    with it, to the bytes of an unbroken one. ``replace=True`` replaces results of another study.
    """
    what = asked(out, resume, restart, replace, threads)
    return Result(problem, Path(_core.optimize(problem, what, Progress(progress))))


def certify(problem: Problem, x: ArrayLike | None = None, *, threads: int | None = None) -> Certificate:
    """The certificate of a design, or of the study's own: error bar, sensitivity, motion, verdict.

    ``retune.certify_file`` does it for a study file or for results, and writes `certificate.json`.
    """
    return Certificate(json.loads(_core.certify(problem, x, threads)))


def verify(path: Directory, *, sample: int = 20, within: float = 0.0) -> list[str]:
    """Checks results against a computation, as `retune verify` does, and returns what was checked; ``retune.Error`` if they do not hold.

    Of each table ``sample`` rows are run again; numbers that differ by at most the share ``within`` hold.
    """
    told = Progress(False)
    _core.verify(os.fspath(path), sample, within, told)
    return told.lines


def prove(study: Directory, omega: float | None = None) -> dict[str, Any]:
    """Proves by interval arithmetic that a study, or the design in a directory of results, has a periodic motion, as `retune prove` does.

    Returns the theorem: the box in which the motion is alone, its stability, bounds on E1max, stroke and contact force. ``omega`` (rad/s) is
    the frequency of the force, by default that of the worst run. ``retune.Error`` where it cannot be proven.
    """
    found: dict[str, Any] = json.loads(_core.prove(os.fspath(study), omega, Progress(False)))
    return found


def branches(
    study: Directory,
    out: Directory | None = None,
    *,
    over: str = "omega",
    span: tuple[float, float] | None = None,
    samples: int = 31,
    starts: int = 16,
    apart: int = 0,
    fine: int = 3001,
    restart: bool = False,
    replace: bool = False,
    threads: int | None = None,
    progress: bool = True,
) -> dict[str, Any]:
    """Every periodic motion of a study, or of the design in a directory of results, as `retune branches` does.

    ``over`` is the parameter, by its symbol, and ``span`` its range (SI units), by default the band of the study. Runs are started at
    ``samples`` values, from rest and from ``starts`` other states, and at ``fine`` values from rest; Newton's iteration is
    led to other motions from states of ``apart`` runs. Returns the answer as `branches.json` has it: ``branches`` with their
    ``events`` and ``largest_stable``, and the ``stable`` and ``irregular`` parts of the range.
    """
    ends = (None, None) if span is None else tuple(repr(float(end)) for end in span)
    along = {"over": over, "from": ends[0], "to": ends[1], "samples": samples, "starts": starts, "apart": apart, "fine": fine}
    what = asked(out, False, restart, replace, threads)
    answer: dict[str, Any] = json.loads(_core.branches(os.fspath(study), along, what, Progress(progress)))
    return answer
