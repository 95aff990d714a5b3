"""Jobs on study files, whose answer is the files that they write: byte for byte those of the command line."""

from __future__ import annotations

import csv
import json
import os
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, TypedDict, Unpack

from retune import _core, _show
from retune._arrays import plain
from retune._jobs import Certificate, Directory, Result, asked
from retune._problem import Problem
from retune._progress import Progress
from retune._scene import Structure
from retune._table import frame

if TYPE_CHECKING:
    import pandas as pd


class Options(TypedDict, total=False):
    """How a job is run, with the meaning of ``retune.optimize``."""

    resume: bool
    restart: bool
    replace: bool
    threads: int | None
    progress: bool


class Design:
    """What ``retune.design`` found: the answer in words, and every damper that was tuned for it."""

    #: The directory of the results; `comparison.csv` is the table, `studies-tmd.json` and `studies-ssvi.json` are the studies.
    out: Path
    #: The better damper, what it does, and what each limit costs.
    answer: str
    #: The rows of `comparison.csv`: no damper, each damper under all limits, and without each of them.
    rows: list[dict[str, float | str]]

    def __init__(self, out: Path) -> None:
        self.out, self._page = out, (out / "report.html").absolute()
        self.answer = (out / "answer.txt").read_text(encoding="utf-8").strip()
        with open(out / "comparison.csv", newline="", encoding="utf-8") as file:
            self.rows = [{name: _value(text) for name, text in row.items()} for row in csv.DictReader(file)]

    def report(self) -> _show.Report:
        """``report.html`` of the results, which a notebook shows."""
        return _show.Report(self._page.read_text(encoding="utf-8"))

    def to_pandas(self) -> pd.DataFrame:
        """The rows of `comparison.csv` as a pandas DataFrame."""
        return frame(self.rows)

    def __repr__(self) -> str:
        return self.answer

    def _repr_html_(self) -> str:
        head = list(self.rows[0])
        # Lines that go on are indented.
        first = " ".join(re.split(r"\n(?! )", self.answer)[0].split())
        return _show.page(head, [[row[name] for name in head] for row in self.rows], first)


def design(
    structure: Structure,
    out: Directory = "results/design",
    *,
    P: float | str | None = None,
    imbalance: float | str | None = None,
    base: float | str | None = None,
    base_acceleration: float | str | None = None,
    band: tuple[float, float] | str | None = None,
    shock: str | None = None,
    record: str | None = None,
    after: float | str | None = None,
    mass: float | str,
    stroke: float | str | None = None,
    k2_max: float | str | None = None,
    k1_error: float | str | None = None,
    goal: str = "E1max",
    limits: Mapping[str, float | str] | None = None,
    damper: Literal["tmd", "ssvi", "both"] = "both",
    wall: str | None = None,
    **options: Unpack[Options],
) -> Design:
    """Designs a damper for a structure, as `retune design` does: the better of a TMD and an SSVI NES, what each limit costs, how sure that is.

    What moves it is one of ``P``, the amplitude of a force (N), ``imbalance`` (kg m), ``base``, the amplitude of a moving base (m), and
    ``base_acceleration`` (m/s²), within ``band``, the range of angular frequencies (rad/s); or a ``shock``, "half-sine,20ms,5g", or a
    ``record``, "quake.csv,unit=g", of which largest values count from ``after`` (s) on. ``mass`` is that of the damper (kg),
    ``stroke`` the largest deflection of its spring (m), ``k2_max`` the largest stiffness of its spring (N/m), ``k1_error`` the share by
    which the stiffness of the structure may be off: the damper is tuned for the worst within it, and limits hold for all. ``goal`` is what
    is made small, ``limits`` has the largest value allowed of other quantities, ``damper`` is "tmd", "ssvi" or "both", ``wall`` has the
    damper's surfaces ("R=20mm,E=5MPa", "R=20mm,rubber", "R=20mm,steel,e=0.7").
    Each number may be a text with a unit: ``band="1.8Hz..2.2Hz", mass="2 %"``.
    """
    wishes = {
        **asdict(structure),
        "P": P,
        "imbalance": imbalance,
        "base": base,
        "base_acceleration": base_acceleration,
        "band": band,
        "shock": shock,
        "record": record,
        "after": after,
        "mass": mass,
        "stroke": stroke,
        "k2_max": k2_max,
        "k1_error": k1_error,
        "goal": goal,
        "limits": dict(limits or {}),
        "damper": damper,
        "wall": wall,
    }
    return Design(Path(_job(out, {"design": wishes}, out, options)))


def certify_file(design: Directory, out: Directory | None = None, **options: Unpack[Options]) -> Certificate:
    """Certifies the damper of a study file, or the design in a directory of results, as `retune certify` does: writes `certificate.json`."""
    return Certificate(_job(design, "certify", out, options))


def table2(study: Directory = "studies/table2.json", out: Directory | None = None, **options: Unpack[Options]) -> Path:
    """Re-optimises the dampers of a study of kind `table2` from their own designs, as `retune table2` does; returns the directory."""
    return Path(_job(study, "table2", out, options))


def retention(study: Directory, k1: Iterable[float], out: Directory | None = None, **options: Unpack[Options]) -> Path:
    """How long tunings last: tunes the dampers of a study of kind `table2` anew at stiffnesses ``k1`` (N/m), as `retune retention` does.

    Returns the directory of the results; ``README.md`` there is the answer.
    """
    return Path(_job(study, {"retention": [float(value) for value in k1]}, out, options))


def fronts(study: Directory = "studies/fronts.json", out: Directory | None = None, **options: Unpack[Options]) -> Path:
    """Pareto fronts of a study of kind `fronts`, as `retune fronts` does; returns the directory of the results."""
    return Path(_job(study, "fronts", out, options))


def losses(study: Directory = "studies/ssvi-hedged.json", out: Directory | None = None, **options: Unpack[Options]) -> Path:
    """What dampers are worth when their contacts lose energy: tunes one for each restitution of the objective of a study and one for
    the worst of all, as `retune losses` does; returns the directory of the results."""
    return Path(_job(study, "losses", out, options))


def reproduce(
    only: str | None = None, out: Directory | None = None, *, study: Directory = "studies/paper.json", **options: Unpack[Options]
) -> Path:
    """Makes every table and figure of the paper, or ``only`` one ("figure3", "table1"), as `retune reproduce` does; returns the directory."""
    return Path(_job(study, {"reproduce": {"only": only}}, out, options))


def sweep(
    study: Directory,
    out: Directory | None = None,
    *,
    over: str = "omega",
    span: tuple[float | str, float | str],
    points: int = 61,
    log: bool = False,
    objective: bool = False,
    quantities: Sequence[str] = (),
    shard: tuple[int, int] | None = None,
    merge: bool = False,
    **options: Unpack[Options],
) -> dict[str, Any] | None:
    """Sweeps a parameter and writes table and figure, as `retune sweep` does; returns what `sweep.json` holds.

    ``span`` is the range in SI units, of a frequency also with a unit ("0.8Hz"). ``shard=(3, 64)`` computes the third of 64 shares and
    returns nothing; ``merge=True`` puts the shares together. For numbers alone see ``Problem.sweep``.
    """
    first, last = (end if isinstance(end, str) else repr(float(end)) for end in span)
    what = {"over": over, "from": first, "to": last, "points": points, "log": log, "quantities": quantities, "objective": objective}
    part = {"shard": shard and _share(shard), "merge": merge}
    table: dict[str, Any] | None = _job(study, {"sweep": {**what, **part}}, out, options)
    return table


def share(study: Directory, shard: tuple[int, int], out: Directory | None = None, **options: Unpack[Options]) -> Path:
    """Computes a share of the grid of a search, ``(3, 64)`` for the third of 64, as `retune optimize --shard` does; returns the directory."""
    return Path(_job(study, {"share": _share(shard)}, out, options))


def merge(study: Directory, parts: Iterable[Directory] = (), out: Directory | None = None, **options: Unpack[Options]) -> Result:
    """Puts the shares of a grid together and goes on with the search, as `retune merge` does; by default all that are in the results."""
    problem = Problem.from_study(study)
    return Result(problem, Path(_job(study, {"merge": {"parts": [os.fspath(part) for part in parts]}}, out, options)))


def _share(shard: tuple[int, int]) -> str:
    number, count = shard
    return f"{number}/{count}"


def _value(text: str) -> float | str:
    try:
        return float(text)
    except ValueError:
        return text


def _job(study: Directory, job: str | dict[str, Any], out: Directory | None, options: Options) -> Any:
    """Does a job and returns its answer."""
    how: dict[str, Any] = {**options}
    progress = Progress(how.pop("progress", True))
    return json.loads(_core.job(os.fspath(study), json.dumps(plain(job)), asked(out, **how), progress))
