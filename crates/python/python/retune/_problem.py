"""Problems: what is to be made small, as a function of a design."""

from __future__ import annotations

import json
import math
import os
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any, Literal, Self, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray

from retune import _core, _show
from retune._arrays import floats, pair, plain, scalar
from retune._errors import StudyError
from retune._forcing import Pulse, Record
from retune._run import Run, simulate
from retune._scene import SSVI, TMD, Structure
from retune._table import Table

Sort = TypeVar("Sort", bound=_core.Core)


@dataclass(frozen=True)
class Evaluation:
    """What a design is worth. SI units."""

    #: What searches make small: the quantity of a design that keeps the limits, above 1e100 for any other.
    value: float
    #: The name of the quantity, E1max unless the problem names another, and its unit.
    quantity: str
    unit: str
    #: The quantity itself, whether limits are kept or not.
    largest: float
    #: Largest spring deflection, m, and contact force, N; NaN where neither the quantity nor a limit asks for them.
    stroke: float
    contact_force: float
    #: The sum of reached / limit - 1 over the limits that are broken; 0 if none is.
    violation: float
    #: The frequency of the worst run, rad/s; NaN of a pulse or a record.
    omega_worst: float
    #: The number of runs, and of those that should have settled and did not.
    runs: int
    unsettled: int

    def _rows(self) -> list[list[object]]:
        return [
            [self.quantity, self.largest, self.unit],
            ["stroke", self.stroke, "m"],
            ["contact_force", self.contact_force, "N"],
            ["violation", self.violation, ""],
            ["omega_worst", self.omega_worst, "rad/s"],
        ]

    def __getattr__(self, name: str) -> float:
        """The quantity by its name, as it is printed: ``evaluation.E1max``."""
        known = vars(self)
        if name == known.get("quantity"):
            return float(known["largest"])
        raise AttributeError(f"there is no {name}: there are {', '.join([*known, str(known.get('quantity'))])}")

    def __repr__(self) -> str:
        return _show.text(["", "value", "unit"], self._rows())

    def _repr_html_(self) -> str:
        return _show.page(["", "value", "unit"], self._rows())


class Problem(_core.Core):
    """A structure, what makes it move, a damper, and what is to be made small.

    ``problem(x)`` is the value of a design ``x``: one number for each of ``problem.names``, in that order, in SI units. It is the number
    that Retune's own searches make small: the quantity (E1max, J, unless ``quantity`` names another) of a design that keeps the limits,
    and a number above 1e100, larger the more they are broken, of one that does not.

    All arguments but structure and damper are keywords:

    - ``P`` (N), ``imbalance`` (kg m), ``base`` (m) or ``base_acceleration`` (m/s²) is the size of the forcing, and ``omega`` (rad/s) its angular frequency, by default
      the natural frequency of the structure, or the end of the band that is nearest to it. ``start`` is a state (``x1``, ``v1``, ``x2``,
      ``v2``) for a free decay instead. ``record`` is a ``retune.Record`` or a ``retune.Pulse``: a force, or an acceleration of the base, that is
      given in time.
    - ``window`` (s) is the time in which maxima are taken; every run starts from rest at 0. "settled": from when the slowest transient
      with the walls open has 0.1 % of its start, for 50 periods of the force.
    - ``vary`` names the tuned parameters, of k2, c2, D, C, m2 and R; ``bounds`` gives each its smallest and largest value.
    - ``band`` (rad/s) makes the objective the worst over these frequencies, ``samples`` of which are run; ``response`` is "window",
      "steady", "settled" or "motions"; ``quantity`` is what is made small; ``objective`` has the further fields of ``optimize.objective``.
    - ``limits`` has largest allowed values of quantities, such as ``stroke``, and of ``cavity`` (SI units), and ``from`` (s).
    - ``surf``, ``coarse``, ``global_search``, ``starts``, ``refine`` say how ``retune.optimize`` searches, and ``solver`` how motions are
      integrated, with the fields of study files.

    A number with a dimension may be a text with its unit: ``P="0.8 kN"``, ``band=("0.8 Hz", "1.3 Hz")``, ``limits={"stroke": "400 mm"}``.
    What only a search needs is refused without ``vary``.
    """

    def __new__(
        cls,
        structure: Structure,
        damper: TMD | SSVI | None = None,
        *,
        P: float | str | None = None,
        imbalance: float | str | None = None,
        base: float | str | None = None,
        base_acceleration: float | str | None = None,
        start: Mapping[str, float | str] | None = None,
        record: Record | Pulse | None = None,
        omega: float | str | None = None,
        window: tuple[float | str, float | str] | Literal["settled"] = "settled",
        vary: Sequence[Literal["k2", "c2", "D", "C", "m2", "R"]] | Sequence[str] | None = None,
        bounds: Mapping[str, tuple[float | str, float | str | None]] | None = None,
        band: tuple[float | str, float | str] | None = None,
        samples: int | None = None,
        response: Literal["window", "steady", "settled", "motions"] | None = None,
        quantity: str | None = None,
        objective: Mapping[str, Any] | None = None,
        limits: Mapping[str, float | str] | None = None,
        surf: Mapping[str, Mapping[str, Any]] | None = None,
        coarse: Mapping[str, Any] | None = None,
        global_search: Mapping[str, Any] | None = None,
        starts: Sequence[Mapping[str, float | str]] | None = None,
        refine: Mapping[str, Any] | None = None,
        solver: Mapping[str, Any] | None = None,
        name: str = "problem",
    ) -> Self:
        if not isinstance(structure, Structure):
            raise TypeError(f"structure: {type(structure).__name__} is not allowed here: give a retune.Structure")
        if damper is not None and not isinstance(damper, (TMD, SSVI)):
            raise TypeError(f"damper: {type(damper).__name__} is not allowed here: give a retune.TMD, a retune.SSVI or None")
        ends = None if band is None else _band(band)
        if record is not None and not isinstance(record, (Record, Pulse)):
            raise TypeError(f"record: {type(record).__name__} is not allowed here: give a retune.Record or a retune.Pulse")
        if omega is None and start is None and record is None:
            natural = math.sqrt(structure.k1 / structure.m1)
            omega = min(max(natural, ends[0]), ends[1]) if ends is not None else natural
        frequencies = given({"from": ends and ends[0], "to": ends and ends[1], "samples": samples}) or None
        span = window if isinstance(window, str) else dict(zip(("t0", "T"), pair(window, "window")))
        goal = {**(objective or {}), **given({"omega": frequencies, "response": response, "quantity": quantity})}
        searched: dict[str, Any] = {"bounds": bounds, "band": band, "samples": samples, "response": response, "quantity": quantity, "objective": objective}
        searched |= {"limits": limits, "surf": surf, "coarse": coarse, "global_search": global_search, "starts": starts, "refine": refine}
        limited = {key: pair(both, f"optimize.bounds.{key}") for key, both in (bounds or {}).items()}
        if vary is None and (useless := list(given(searched))):
            raise StudyError(f'{useless[0]}: of no use without vary: say what to tune, for instance vary=["k2", "c2"]', useless[0])
        open_ended = {key: [low, None if high is math.inf or high == math.inf else high] for key, (low, high) in limited.items()}
        search = given({"surf": surf, "coarse": coarse, "global": global_search, "starts": starts, "refine": refine, "limits": limits})
        optimize = {"vary": vary, "bounds": open_ended, "objective": goal, **search}
        study = {
            "name": name,
            "scene": {
                "primary": asdict(structure),
                "forcing": {
                    **given({"P": P, "imbalance": imbalance, "base": base, "base_acceleration": base_acceleration, "start": start, "omega": omega}),
                    **({} if record is None else record._study()),
                },
                "damper": None if damper is None else damper._study(),
            },
            "window": span,
            "solver": solver or {},
            "optimize": None if vary is None else optimize,
        }
        problem = super().__new__(cls, json.dumps(plain(study)))
        if (words := problem._transient()) is not None:
            warnings.warn(words, stacklevel=2)
        return problem

    @classmethod
    def from_study(cls, study: str | os.PathLike[str] | Mapping[str, Any]) -> Self:
        """A problem from a study file, the directory of a search's results (with the design that it found), or a mapping with the fields
        of a study."""
        if isinstance(study, Mapping):
            return rebuilt(cls, json.dumps(plain(study)), None)
        return rebuilt(cls, _core.study_text(os.fspath(study)), os.fspath(study))

    @property
    def study(self) -> dict[str, Any]:
        """The study, with every default written out."""
        study: dict[str, Any] = json.loads(self._text())
        return study

    def save(self, file: str | os.PathLike[str]) -> None:
        """Writes the study to a file, for the command line and for the jobs that take one."""
        Path(file).write_text(json.dumps(self.study, indent=2, ensure_ascii=False) + "\n", encoding="utf-8")

    def evaluate(self, x: ArrayLike) -> Evaluation:
        """Everything that the objective finds for a design."""
        found = self._evaluation(x)
        if found["unsettled"]:
            warnings.warn(f"{found['unsettled']} of {found['runs']} runs did not settle: their largest values are those of the window", stacklevel=2)
        quantity, unit = self.quantity
        return Evaluation(quantity=quantity, unit=unit, **found)

    def gradient(self, x: ArrayLike) -> NDArray[np.float64]:
        """The derivatives of ``problem(x)`` by the design, exact: one for each of ``problem.names``, per SI unit.

        They are those of the run behind the value, at its frequency and at the time of its maximum. Over a band with impacts, the search for
        a peak may end beside its top: the derivatives of the value then differ from these. Where two maxima are equally high (two
        peaks over a band, two periods of a run) the value has a kink, and these are the derivatives of one of them: a subgradient. Of a
        design that breaks a limit they are those of its value above 1e100. Of an irregular motion they are right, large, and of no use.
        """
        return self._gradient(x)[1]

    def value_and_gradient(self, x: ArrayLike) -> tuple[float, NDArray[np.float64]]:
        """``problem(x)`` and ``problem.gradient(x)`` together: ``minimize(problem.value_and_gradient, x0, jac=True)``."""
        return self._gradient(x)

    def batch(self, X: ArrayLike, threads: int | None = None) -> Table:
        """The values of ``n`` designs, the rows of ``X`` (n, d), on all cores, or on ``threads``; the numbers do not depend on that.

        Returns columns: ``value`` as of ``problem(x)``, the quantity (``E1max``, J), ``stroke`` (m) and ``contact_force`` (N), NaN where neither
        the quantity nor a limit asks for them and the response is not steady, ``violation``, ``omega_worst`` (rad/s; NaN of a pulse or a record). A row without a value has an infinite ``value`` and NaN elsewhere;
        ``errors`` has its exception.
        """
        columns, errors = self._batch(X, threads)
        quantity, unit = self.quantity
        return Table(columns, {"value": unit, quantity: unit, "stroke": "m", "contact_force": "N", "omega_worst": "rad/s"}, dict(errors))

    def simulate(self, x: ArrayLike | None = None, *, interval: float = 0.005, **changes: float | str) -> Run:
        """One run, of a design or of the study's own: its motion every ``interval`` seconds of the window, contacts, largest values.

        ``changes`` are numbers of the study: ``omega``, ``k1``, ``P``, ``T``, ``t0`` and others by their symbols.
        """
        return simulate(self, x, interval, changes)

    def sweep(self, x: ArrayLike | None = None, *, objective: bool = False, threads: int | None = None, **over: ArrayLike) -> Table:
        """A run at each value of one parameter, given by its symbol, with the damper and without: ``sweep(x, omega=[5, 6, 7])``.

        With ``objective`` the objective at each value instead. A value that has no answer has NaN.
        """
        if len(over) != 1:
            raise TypeError("give one parameter and its values, for instance omega=numpy.linspace(5, 8, 301)")
        ((name, values),) = over.items()
        columns, units = _core.sweep(self, x, name, np.atleast_1d(floats(values, name)), objective, threads)
        return Table(columns, dict(units))

    def at(self, x: ArrayLike | None = None, **changes: float | str) -> Problem:
        """The same problem with another design as its own, or with other numbers (``k1=30000``)."""
        text = self._text() if x is None else self._tuned(x)
        problem = rebuilt(Problem, text, None)
        return rebuilt(Problem, problem._changed([(key, scalar(value, key)) for key, value in changes.items()]), None) if changes else problem

    def __eq__(self, other: object) -> bool:
        """Whether both are the same study."""
        return self._text() == other._text() if isinstance(other, Problem) else NotImplemented

    def __hash__(self) -> int:
        return hash(self._text())

    def _rows(self) -> list[list[object]]:
        return [
            [name, value, low, high, unit]
            for name, value, (low, high), unit in zip(self.names, self.start, self.bounds, self.units)
        ]

    def _title(self) -> str:
        study = self.study
        scene = study["scene"]
        goal = (study["optimize"] or {}).get("objective", {})
        band = goal.get("omega")
        where = f"worst over {band['from']:g} to {band['to']:g}{'' if band.get('relative') else ' rad/s'}" if band else ""
        parts = [f"{key} = {_in_short(value)}" for key, value in {**scene["primary"], **scene["forcing"]}.items()]
        sought = f"{self.quantity[0]} ({self.quantity[1]}) {where}".strip()
        name = "" if study["name"] == "problem" else f" {study['name']}"
        return f"problem{name}: {sought or 'one run'}, {', '.join(parts)}"

    def __repr__(self) -> str:
        return f"{self._title()}\n{_show.text(['tuned', 'value', 'from', 'to', 'unit'], self._rows())}"

    def _repr_html_(self) -> str:
        return _show.page(["tuned", "value", "from", "to", "unit"], self._rows(), self._title())


def _in_short(value: Any) -> str:
    """A number, a word, or of a record how many samples it has."""
    if isinstance(value, Mapping) and "values" in value:
        return f"{len(value['values'])} samples"
    return _show.number(value) if isinstance(value, (int, float)) else str(value)


def rebuilt(cls: type[Sort], text: str, file: str | None) -> Sort:
    """A problem from the text of its study, as pickles hold it."""
    return _core.Core.__new__(cls, text, file)


def _band(band: tuple[float | str, float | str]) -> tuple[float, float]:
    """The ends of a band, rad/s, the lower one first."""
    low, high = (scalar(end, "band", "omega") for end in pair(band, "band"))
    if low >= high:
        raise StudyError(f"band: ({low:g}, {high:g}) is not allowed here: give the lower frequency first, and another one second", "band", band)
    return low, high


def given(fields: Mapping[str, Any]) -> dict[str, Any]:
    """The fields that are not None."""
    return {key: value for key, value in fields.items() if value is not None}
