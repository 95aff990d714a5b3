"""What makes a structure move and is given in time: records and pulses."""

from __future__ import annotations

import os
from dataclasses import dataclass
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike

from retune import _core
from retune._arrays import floats, scalar
from retune._errors import StudyError


class Record:
    """Samples of a force on the structure or of an acceleration of its base, with straight lines between them.

    ``t`` (s) are the times of the samples, equidistant or not, or the time between two of them; ``a`` are the values, times ``scale``.
    ``of`` is "force" (``unit`` "N", "kN", ...) or "base acceleration" ("m/s²", "g", ...); without a ``unit`` it is the SI unit. Before the
    first and after the last sample there is nothing.

    >>> import numpy as np, retune as rt
    >>> t = np.linspace(0, 30, 3001)
    >>> record = rt.Record(t, 0.1 * np.exp(-0.2 * t) * np.sin(6 * t), of="base acceleration", unit="g")
    >>> problem = rt.Problem(rt.Structure(m1=1000, c1=452, k1=3.95e4), rt.TMD(60, k2=1900, c2=150), record=record, window=(0, 30))
    >>> round(problem.simulate().maxima["x1max"], 4)
    0.0854
    """

    def __init__(self, t: ArrayLike, a: ArrayLike, *, of: str, unit: str | None = None, scale: float = 1.0) -> None:
        values = np.atleast_1d(floats(a, "a")) * (_core.history_unit(of, unit) * scalar(scale, "scale"))
        times = floats(t, "t")
        if values.ndim != 1 or times.ndim > 1 or (times.ndim == 1 and times.shape != values.shape):
            raise StudyError(f"a: {values.shape} values for {times.shape} times: give one value for each time, in one dimension", "a")
        given = {"step": times.item()} if times.ndim == 0 else {"times": times}
        self._fields: dict[str, Any] = {"record": {**given, "values": values}, "of": of}

    @classmethod
    def read(
        cls,
        file: str | os.PathLike[str],
        *,
        of: str,
        column: str | int | None = None,
        unit: str | None = None,
        scale: float | None = None,
    ) -> Self:
        """The record of a file: CSV with a header and the time (s) in its first column, or PEER's AT2 (g)."""
        record = cls.__new__(cls)
        fields: dict[str, Any] = {"record": os.path.abspath(file), "of": of, "column": column, "unit": unit, "scale": scale}
        record._fields = {key: value for key, value in fields.items() if value is not None}
        return record

    def _study(self) -> dict[str, Any]:
        return self._fields


@dataclass(frozen=True)
class Pulse:
    """A pulse of a force on the structure or of an acceleration of its base, from t = 0 on: ``rt.Pulse("half sine", 5, 0.02, of="base
    acceleration", unit="g")``.

    ``shape`` is "half sine", "versed sine" or "rectangle", ``peak`` its largest value in ``unit`` (the SI unit if left out), ``duration`` (s) how
    long it lasts.
    """

    shape: str
    peak: float
    duration: float
    of: str
    unit: str | None = None

    def _study(self) -> dict[str, Any]:
        fields = {"pulse": self.shape, "peak": self.peak, "duration": self.duration, "of": self.of, "unit": self.unit}
        return {key: value for key, value in fields.items() if value is not None}

