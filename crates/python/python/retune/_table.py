"""Columns of numbers."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from retune import _show
from retune._errors import Error

if TYPE_CHECKING:
    import pandas as pd

#: Rows that are shown of a longer table.
SHOWN = 10


class Table(dict[str, NDArray[Any]]):
    """Columns by their names, each a numpy array of the same length: ``table["E1max"]`` or ``table.E1max``.

    It is a dictionary, so ``pandas.DataFrame(table)`` works, and so does ``table.to_pandas()``.
    """

    #: The SI unit of each column; empty for pure numbers.
    units: dict[str, str]
    #: The rows without a value, each with its exception, up to the first hundred.
    errors: dict[int, Exception]

    def __init__(
        self,
        columns: Mapping[str, NDArray[Any]],
        units: Mapping[str, str] | None = None,
        errors: Mapping[int, Exception] | None = None,
    ) -> None:
        super().__init__(columns)
        self.units = dict(units or {})
        self.errors = dict(errors or {})

    def __getattr__(self, name: str) -> NDArray[Any]:
        try:
            return self[name]
        except KeyError:
            raise AttributeError(f"there is no column {name}: the columns are {', '.join(self)}") from None

    def __reduce__(self) -> tuple[Any, ...]:
        return Table, (dict(self), self.units, self.errors)

    def __eq__(self, other: object) -> bool:
        """Whether both have the same columns to the last bit."""
        if not isinstance(other, Table) or list(self) != list(other):
            return NotImplemented if not isinstance(other, Table) else False
        return all(a.tobytes() == b.tobytes() for a, b in zip(self.values(), other.values()))

    @property
    def rows(self) -> int:
        """The number of rows."""
        return len(next(iter(self.values()), ()))

    def to_pandas(self) -> pd.DataFrame:
        """The same as a pandas DataFrame."""
        return frame(dict(self))

    def plot(self, y: str | None = None, x: str | None = None, ax: Any = None, **line: Any) -> Any:
        """Draws a column over another, by default the first, with matplotlib; returns the axes, which are of a figure of their own unless
        ``ax`` is given. Without ``y`` every column of numbers has axes of its own, one below the other: returns all of them."""
        x = x or next(iter(self), "")
        if unknown := [name for name in (x, y) if name is not None and name not in self]:
            raise Error(f"there is no column {unknown[0]}: the columns are {', '.join(self)}")
        if y is None:
            names = [name for name, column in self.items() if name != x and column.dtype.kind in "fiu"]
            if ax is not None and len(names) != 1:
                raise Error(f"ax: axes for one column, and there are {', '.join(names)}: name one of them")
            each = [ax] if ax is not None else column_of_axes(max(1, len(names)))
            drawn = [self.plot(name, x, own, **line) for name, own in zip(names, each)]
            return drawn[0] if len(drawn) == 1 else drawn
        ax = axes(ax)
        ax.plot(self[x], self[y], **{"label": y, **line})
        ax.set_xlabel(self._label(x))
        ax.set_ylabel(self._label(y))
        return ax

    def _label(self, name: str) -> str:
        unit = self.units.get(name)
        return f"{name}, {unit}" if unit else name

    def _shown(self) -> Iterator[list[object]]:
        half = SHOWN // 2
        few = self.rows <= SHOWN
        for i in range(self.rows) if few else [*range(half), *range(self.rows - half, self.rows)]:
            if not few and i == self.rows - half:
                yield ["..."] * len(self)
            yield [column[i].item() if isinstance(column[i], np.generic) else column[i] for column in self.values()]

    def __repr__(self) -> str:
        return f"{_show.text([self._label(name) for name in self], self._shown())}\n{self.rows} rows"

    def _repr_html_(self) -> str:
        return _show.page([self._label(name) for name in self], self._shown(), f"{self.rows} rows")


def frame(rows: Any) -> pd.DataFrame:
    """Columns, or a list of rows with the names of their columns, as a pandas DataFrame."""
    try:
        import pandas as pd
    except ImportError as error:
        raise Error("to_pandas needs pandas: pip install pandas") from error
    return pd.DataFrame(rows)


def axes(ax: Any) -> Any:
    """The given axes, or those of a figure of their own: never into someone's."""
    return column_of_axes(1)[0] if ax is None else ax


def column_of_axes(count: int) -> list[Any]:
    """Axes of a new figure, one below the other, with one x."""
    try:
        import matplotlib.pyplot as plt
    except ImportError as error:
        raise Error("plot needs matplotlib: pip install matplotlib") from error
    size = (6.4, max(4.8, 2.0 * count))
    return list(plt.subplots(count, 1, sharex=True, squeeze=False, figsize=size, layout="constrained")[1][:, 0])
