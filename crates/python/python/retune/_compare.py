"""Several dampers for one problem."""

from __future__ import annotations

import json
import os
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from retune import _core, _show
from retune._arrays import plain
from retune._errors import StudyError
from retune._jobs import DESIGN, Directory, Result, optimize
from retune._problem import Problem
from retune._scene import MEANING, SSVI, TMD
from retune._table import frame

if TYPE_CHECKING:
    import pandas as pd


class Comparison:
    """Dampers that were each tuned for the same problem, the best first."""

    results: list[Result]

    def __init__(self, results: Sequence[Result]) -> None:
        self.results = sorted(results, key=lambda result: (not result.success, result.fun))

    @property
    def best(self) -> Result:
        """The result with the smallest value of those that keep the limits."""
        return self.results[0]

    def _head(self) -> list[str]:
        quantity, unit = self.best.problem.quantity
        design = [f"{name}, {MEANING[name][0]}" for name in DESIGN]
        return ["damper", *design, f"{quantity}, {unit}", "none /", "verdict"]

    def _rows(self) -> list[list[object]]:
        rows: list[list[object]] = []
        for result in self.results:
            quantity = result.problem.quantity[0]
            design = [result.data.get(name, "none") for name in DESIGN]
            none = result.data.get(f"{quantity}_none")
            ratio = "" if none is None else none / result.fun
            rows.append([result.data["damper_type"], *design, result.fun, ratio, result.data["certificate"]["verdict"]])
        return rows

    def report(self) -> _show.Report:
        """A page of HTML, which a notebook shows: the comparison, and the figures of the best."""
        return _show.report("Comparison", f"{self._repr_html_()}{self.best.report()._repr_html_()}")

    def to_pandas(self) -> pd.DataFrame:
        """A pandas DataFrame with a row for each damper, the best first, as of ``Result.to_pandas``."""
        return frame([result._row() for result in self.results])

    def __repr__(self) -> str:
        return _show.text(self._head(), self._rows())

    def _repr_html_(self) -> str:
        return _show.page(self._head(), self._rows())


def compare(
    problem: Problem,
    dampers: Sequence[TMD | SSVI],
    out: Directory | None = None,
    *,
    resume: bool = False,
    restart: bool = False,
    replace: bool = False,
    threads: int | None = None,
    progress: bool = True,
) -> Comparison:
    """Tunes each damper for the structure, the forcing, the objective and the limits of a problem, and compares them.

    Any number of dampers, by any quantity that the problem makes small (``quantity="x1max"``), whatever moves the structure. A damper with all its numbers is tuned within the bounds of the problem. Of one with its mass alone the search is that of
    `retune design`, which is for a forcing with a frequency: k2 is bounded by the problem's largest k2, if it has one, everything else as wide as the structure suggests. The results go
    to ``out``, by default ``results/`` and the name of the problem, one directory for each damper.
    """
    place = Path(os.fspath(out)) if out is not None else Path("results") / str(problem.study["name"])
    results = []
    for number, damper in enumerate(dampers, 1):
        study = _study(problem, damper)
        study["name"] = f"{number}-{'tmd' if isinstance(damper, TMD) else 'ssvi'}"
        tuned = Problem.from_study(study)
        results.append(
            optimize(
                tuned,
                place / str(study["name"]),
                resume=resume,
                restart=restart,
                replace=replace,
                threads=threads,
                progress=progress,
            )
        )
    if not results:
        raise StudyError("dampers: an empty list is not allowed here: give one damper or more", "dampers")
    return Comparison(results)


def _study(problem: Problem, damper: TMD | SSVI) -> dict[str, Any]:
    """The study of a problem with another damper."""
    study = problem.study
    if study["optimize"] is None:
        raise StudyError("optimize: missing; say what to tune, for instance vary=['k2', 'c2']", "optimize")
    names = ("k2", "c2") if isinstance(damper, TMD) else ("k2", "c2", "D", "C")
    numbers = damper._study()
    if missing := [name for name in names if name not in numbers]:
        designed = _designed(problem, study, damper, missing)
        found = designed["scene"]["damper"]
        numbers = {**{name: found[name] for name in names}, **numbers}
        search = {key: designed["optimize"][key] for key in ("vary", "bounds", "surf", "refine")}
        optimize = {**search, "objective": study["optimize"]["objective"], "limits": study["optimize"].get("limits", {})}
    else:
        vary = [name for name in problem.names if name in numbers]
        optimize = {**study["optimize"], "vary": vary}
        for field in ("bounds", "surf"):
            axes = optimize.get(field) or {}
            optimize[field] = {name: axis for name, axis in axes.items() if name in vary} or ({} if field == "bounds" else None)
        limit = 200 * len(vary)
        optimize["refine"] = {**optimize["refine"], "MaxIter": limit, "MaxFunEvals": limit}
        if vary != problem.names:
            optimize.pop("starts", None)
    study["scene"]["damper"] = numbers
    study["optimize"] = optimize
    return study


def _designed(problem: Problem, study: dict[str, Any], damper: TMD | SSVI, missing: Sequence[str]) -> dict[str, Any]:
    """The study with which `retune design` would tune a damper of this mass."""
    scene = study["scene"]
    forcing = scene["forcing"]
    harmonic = _core.amplitudes()
    by = next((name for name in harmonic if name in forcing), None)
    if by is None:
        first = missing[0]
        raise StudyError(
            f"damper.{first}: missing, and only for a forcing with a frequency ({', '.join(harmonic)}) it is found from the structure: "
            f"give {', '.join(missing)}",
            f"damper.{first}",
        )
    band = study["optimize"]["objective"].get("omega")
    unit = (scene["primary"]["k1"] / scene["primary"]["m1"]) ** 0.5 if band and band.get("relative") else 1.0
    ends = [unit * band["from"], unit * band["to"]] if band else [0.8 * forcing["omega"], 1.25 * forcing["omega"]]
    stiffest = dict(zip(problem.names, problem.bounds)).get("k2", (0.0, float("inf")))[1]
    wishes = {
        **scene["primary"],
        by: forcing[by],
        "band": ends,
        "mass": damper.m2,
        "k2_max": stiffest if stiffest < float("inf") else None,
        "stroke": None,
        "k1_error": None,
    }
    found: dict[str, Any] = json.loads(_core.design_study(json.dumps(plain(wishes)), damper.title))
    return found
