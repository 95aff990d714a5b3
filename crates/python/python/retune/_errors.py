"""The exceptions of the package."""

from __future__ import annotations

from typing import Any


class Error(Exception):
    """What Retune refuses, or cannot do; the message says what to do about it."""


class StudyError(Error, ValueError):
    """A field of a study, an argument or a design is wrong."""

    #: The path of the field, for instance ``scene.damper.k2``; None if there is no single one.
    field: str | None
    #: The refused value; None if it is not one value.
    value: Any

    def __init__(self, message: str, field: str | None = None, value: Any = None) -> None:
        super().__init__(message, field, value)
        self.field, self.value = field, value

    def __str__(self) -> str:
        return str(self.args[0])


class SolverError(Error, RuntimeError):
    """A run could not be finished."""

    #: The time that was reached, s.
    t: float

    def __init__(self, message: str, t: float = float("nan")) -> None:
        super().__init__(message, t)
        self.t = t

    def __str__(self) -> str:
        return str(self.args[0])
