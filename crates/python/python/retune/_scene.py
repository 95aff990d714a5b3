"""What a scene is made of. Each part is checked as it is made, by the rules of study files. Each number may be a text with a unit."""

from __future__ import annotations

import json
import math
import numbers
from dataclasses import asdict, dataclass, field, fields
from typing import Any, ClassVar

from retune import _core, _show
from retune._arrays import plain, scalar
from retune._errors import StudyError

#: Symbols, their SI units and what they are.
MEANING = {symbol: (unit, words) for symbol, unit, words in _core.parameters()}


class Part:
    """A part of a scene, shown as a table of its numbers."""

    title: ClassVar[str]

    def _in_si(self) -> None:
        """Texts with a unit become numbers in SI units, and numbers of numpy those of Python."""
        for name, value in list(vars(self).items()):
            if isinstance(value, str):
                object.__setattr__(self, name, scalar(value, name))
            elif isinstance(value, numbers.Real) and not isinstance(value, (int, float)):
                object.__setattr__(self, name, float(value))

    def _known(self) -> dict[str, Any]:
        """What is shown, by its symbol."""
        return vars(self)

    def _rows(self) -> list[list[object]]:
        return [[name, value, *MEANING[name]] for name, value in self._known().items() if isinstance(value, (int, float))]

    def __repr__(self) -> str:
        return f"{self.title}\n{_show.text(['', 'value', 'unit', ''], self._rows())}"

    def _repr_html_(self) -> str:
        return _show.page(["", "value", "unit", ""], self._rows(), self.title)


@dataclass(frozen=True, kw_only=True, repr=False)
class Structure(Part):
    """The structure whose vibration is to be reduced: ``m1`` (kg), ``c1`` (N s/m), ``k1`` (N/m)."""

    title: ClassVar[str] = "structure"
    m1: float
    c1: float
    k1: float

    def __post_init__(self) -> None:
        self._in_si()
        _check(asdict(self), None)


@dataclass(frozen=True, kw_only=True, repr=False)
class Contact(Part):
    """The colliding surfaces of an SSVI NES; the defaults are those of the paper.

    ``R`` (m) is the radius of the damper's surfaces, ``q`` the geometrical coefficient of Hertz's theory, ``E1`` to ``E4`` (Pa) and
    ``nu1`` to ``nu4`` are Young's moduli and Poisson's ratios: 1 the structure, 2 the damper where it meets the structure, 3 the
    obstacle, 4 the damper where it meets the obstacle. ``loss`` is what contacts lose: ``{"restitution": e}`` for the same restitution at
    every speed, or the law of Hunt and Crossley, ``{"lambda": s/m}`` or ``{"restitution": e, "at": v}`` for an undisturbed collision at a
    speed of v (m/s); nothing if left out.
    ``strength`` (Pa), the yield strength of the weakest surface, and ``density`` (kg/m³), that of the damper, change no motion: with them
    ``simulate(...).maxima["warnings"]``, and the answers of searches, tell contacts that yield or are too short for Hertz's law.
    ``rigid`` is the restitution of rigid walls, 0 to 1, in the place of all that.
    """

    title: ClassVar[str] = "colliding surfaces"
    R: float = 2.0
    q: float = 0.318
    E1: float = 2.1e11
    nu1: float = 0.3
    E2: float = 2.21e7
    nu2: float = 0.4
    E3: float = 2.1e11
    nu3: float = 0.3
    E4: float = 2.05e7
    nu4: float = 0.4
    loss: dict[str, float] | None = None
    strength: float | None = None
    density: float | None = None
    rigid: float | None = None

    def __post_init__(self) -> None:
        self._in_si()
        _check(None, {"m2": 1, "k2": 0, "c2": 0, "D": 0, "C": 0, "contact": self._study()})

    def _study(self) -> dict[str, Any]:
        if self.rigid is not None:
            # Surfaces that are given beside it are refused as in a study.
            given = {of.name: getattr(self, of.name) for of in fields(self) if getattr(self, of.name) != of.default}
            return {**given, "rigid": {"restitution": self.rigid}}
        return {name: value for name, value in vars(self).items() if value is not None}

    def _known(self) -> dict[str, Any]:
        return vars(self) if self.rigid is None else {"restitution": self.rigid}


@dataclass(frozen=True, repr=False)
class TMD(Part):
    """A tuned mass damper, without walls: ``m2`` (kg), ``k2`` (N/m), ``c2`` (N s/m).

    ``retune.compare`` finds ``k2`` and ``c2`` itself where they are left out.
    """

    title: ClassVar[str] = "TMD"
    m2: float
    k2: float | None = field(default=None, kw_only=True)
    c2: float | None = field(default=None, kw_only=True)

    def __post_init__(self) -> None:
        self._in_si()
        _check(None, {"k2": 0, "c2": 0, **self._study()})

    def _study(self) -> dict[str, Any]:
        return {name: value for name, value in vars(self).items() if value is not None}


@dataclass(frozen=True, repr=False)
class SSVI(Part):
    """A single-sided vibro-impact nonlinear energy sink: ``m2`` (kg), ``k2`` (N/m), ``c2`` (N s/m), ``D`` and ``C`` (m), ``contact``.

    ``retune.compare`` finds all but ``m2`` itself where they are left out. Without a ``contact`` it has the walls of the paper's damper of
    60 kg, their moduli in proportion to ``m2``: a contact lasts as long as one of the paper's at the same speed.
    """

    title: ClassVar[str] = "SSVI NES"
    m2: float
    k2: float | None = field(default=None, kw_only=True)
    c2: float | None = field(default=None, kw_only=True)
    D: float | None = field(default=None, kw_only=True)
    C: float | None = field(default=None, kw_only=True)
    contact: Contact | None = field(default=None, kw_only=True)

    def __post_init__(self) -> None:
        self._in_si()
        if self.contact is None:
            mass = scalar(self.m2, "m2")
            chosen = Contact(**json.loads(_core.contact(mass))) if 0 < mass < math.inf else Contact()
            object.__setattr__(self, "contact", chosen)
        _check(None, {"k2": 0, "c2": 0, "D": 0, "C": 0, **self._study()})

    def _study(self) -> dict[str, Any]:
        return {
            name: value._study() if isinstance(value, Contact) else value
            for name, value in vars(self).items()
            if value is not None
        }


def _check(primary: dict[str, Any] | None, damper: dict[str, Any] | None) -> None:
    """Refuses a part that no study may have: the rules are those of study files."""
    scene = {"primary": primary or {"m1": 1, "c1": 0, "k1": 1}, "forcing": {"P": 0, "omega": 1}, "damper": damper}
    study = {"scene": scene, "window": {"t0": 0, "T": 1}}
    try:
        _core.Core(json.dumps(plain(study)))
    except StudyError as error:
        field = error.field.rpartition(".")[2] if error.field else None
        raise StudyError(str(error).removeprefix((error.field or "").rpartition(".")[0] + "."), field, error.value) from None
