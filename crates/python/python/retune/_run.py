"""One run."""

from __future__ import annotations

import json
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from retune import _core, _show
from retune._arrays import scalar
from retune._errors import Error
from retune._table import Table, axes

if TYPE_CHECKING:
    import pandas as pd

UNITS = {"t": "s", "x1": "m", "v1": "m/s", "x2": "m", "v2": "m/s", "E1": "J", "E2": "J", "FconL": "N", "FconR": "N"}
#: Largest values in the summary of a run, with what is shown of them.
SHOWN = {"E1max": "J", "E2max": "J", "x1max": "m", "v1max": "m/s", "a1max": "m/s2", "ground_force_max": "N", "spring_deflection_max": "m"}


class Run:
    """One run: the motion at equal intervals, its contacts, and its largest values, each located to rounding."""

    #: Time, s; displacement and velocity of the structure and the damper, m and m/s.
    t: NDArray[np.float64]
    x1: NDArray[np.float64]
    v1: NDArray[np.float64]
    x2: NDArray[np.float64]
    v2: NDArray[np.float64]
    #: The rows at equal intervals: t, x1, v1, x2, v2, the energies E1 and E2 (J), the contact forces FconL and FconR (N).
    motion: Table
    #: The same columns at the events between them, ``moment``: touch-down, force-max, lift-off, E1-max, and the ``wall`` of the contact.
    events: Table
    #: A row for each contact: touch-down and lift-off (s; NaN beyond the window), largest force (N; NaN if it is beyond the window, infinite of an
    #: impact on a rigid wall), wall ("structure" or "obstacle").
    contacts: Table
    #: The largest values and everything else that the run is known by, as `retune simulate --json` has it.
    maxima: dict[str, Any]

    def __init__(self, motion: Table, events: Table, maxima: dict[str, Any]) -> None:
        self.motion, self.events, self.maxima = motion, events, maxima
        self.t, self.x1, self.v1, self.x2, self.v2 = (motion[name] for name in ("t", "x1", "v1", "x2", "v2"))
        self.contacts = _contacts(events, maxima["force_max"])

    def to_pandas(self) -> pd.DataFrame:
        """The motion as a pandas DataFrame."""
        return self.motion.to_pandas()

    def plot(self, *names: str, ax: Any = None) -> Any:
        """Draws columns over time with matplotlib, by default x1 and x2, in axes of a figure of its own unless ``ax`` is given; returns them."""
        names = names or ("x1", "x2")
        if unknown := [name for name in names if name not in self.motion]:
            raise Error(f"there is no column {unknown[0]}: the columns are {', '.join(self.motion)}")
        ax = axes(ax)
        for name in names:
            ax.plot(self.t, self.motion[name], label=f"{name}, {UNITS[name]}")
        ax.set_xlabel("t, s")
        ax.legend()
        return ax

    def _rows(self) -> list[list[object]]:
        found: list[list[object]] = [[name, self.maxima.get(name), unit] for name, unit in SHOWN.items()]
        return [*found, ["impacts", sum(self.maxima["impacts"].values()), ""]]

    def _title(self) -> str:
        omega = self.maxima["omega"]
        at = f" at omega = {omega:g} rad/s" if omega > 0 else ""  # a pulse and a record have none
        return f"run{at}, {self.motion.rows} rows, {self.contacts.rows} contacts"

    def __repr__(self) -> str:
        return f"{self._title()}\n{_show.text(['largest', 'value', 'unit'], self._rows())}"

    def _repr_html_(self) -> str:
        return _show.page(["largest", "value", "unit"], self._rows(), self._title())


def simulate(problem: _core.Core, x: ArrayLike | None, interval: float, changes: Mapping[str, float | str]) -> Run:
    motion, events, moments, maxima = _core.run(problem, x, scalar(interval, "interval"), [(key, scalar(value, key)) for key, value in changes.items()])
    for i, name in enumerate(("moment", "wall")):
        events[name] = np.array([words[i] for words in moments], dtype=object)
    return Run(Table(motion, UNITS), Table(events, UNITS), json.loads(maxima))


def _contacts(events: Table, largest: Mapping[str, float | None]) -> Table:
    """The contacts, from their events in the order of time; ``largest`` has the largest force on each wall, None of one that has no bound."""
    rows: list[list[Any]] = []
    is_open = False
    for t, left, right, moment, wall in zip(*(events[name] for name in ("t", "FconL", "FconR", "moment", "wall"))):
        if moment == "E1-max":
            continue
        if moment == "touch-down" or not is_open:
            force = np.inf if largest["primary" if wall == "structure" else wall] is None else np.nan
            rows.append([t if moment == "touch-down" else np.nan, np.nan, force, wall])
            is_open = True
        if moment == "force-max":
            rows[-1][2] = np.fmax(rows[-1][2], max(left, right))
        if moment == "lift-off":
            rows[-1][1], is_open = t, False
    names, kinds = ("touch_down", "lift_off", "force", "wall"), (float, float, float, object)
    columns = {name: np.array([row[i] for row in rows], dtype=kind) for i, (name, kind) in enumerate(zip(names, kinds))}
    return Table(columns, {"touch_down": "s", "lift_off": "s", "force": "N"})
