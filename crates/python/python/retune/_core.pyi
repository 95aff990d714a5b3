from collections.abc import Callable, Mapping, Sequence
from typing import Any, Self

import numpy as np
from numpy.typing import ArrayLike, NDArray
from typing_extensions import disjoint_base

__all__ = [
    "Core",
    "__version__",
    "amplitudes",
    "branches",
    "certify",
    "design_study",
    "history_unit",
    "job",
    "optimize",
    "parameters",
    "prove",
    "program",
    "run",
    "contact",
    "study_text",
    "sweep",
    "typed",
    "verify",
]

__version__: str

_Tell = Callable[[str, str, int, int, int], None]
_Columns = dict[str, NDArray[Any]]

@disjoint_base
class Core:
    def __new__(cls, text: str, file: str | None = None) -> Self: ...
    @property
    def file(self) -> str | None:
        """The file that it was read from."""
    @property
    def names(self) -> list[str]:
        """The tuned parameters, in the order of a design."""
    @property
    def units(self) -> list[str]:
        """The unit of each."""
    @property
    def bounds(self) -> list[tuple[float, float]]:
        """Lower and upper bound of each; infinity for none."""
    @property
    def start(self) -> list[float]:
        """The values of the tuned parameters in the study."""
    @property
    def quantity(self) -> tuple[str, str]:
        """What is made small, and its unit."""
    def __call__(self, x: ArrayLike, /) -> float:
        """The value that searches make small."""
    def _text(self) -> str: ...
    def _transient(self) -> str | None: ...
    def _evaluation(self, x: ArrayLike) -> dict[str, Any]: ...
    def _gradient(self, x: ArrayLike) -> tuple[float, NDArray[np.float64]]: ...
    def _batch(self, x: ArrayLike, threads: int | None = None) -> tuple[_Columns, list[tuple[int, Exception]]]: ...
    def _changed(self, settings: Sequence[tuple[str, float]]) -> str: ...
    def _tuned(self, x: ArrayLike) -> str: ...
    def __reduce__(self) -> tuple[Any, ...]: ...

def study_text(path: str) -> str: ...
def contact(mass: float) -> str: ...
def typed(name: str, text: str) -> float: ...
def history_unit(of: str, unit: str | None = None) -> float: ...
def amplitudes() -> list[str]: ...
def parameters() -> list[tuple[str, str, str]]: ...
def program(words: Sequence[str]) -> int: ...
def run(
    core: Core, x: ArrayLike | None, interval: float, settings: Sequence[tuple[str, float]]
) -> tuple[_Columns, _Columns, list[tuple[str, str]], str]: ...
def sweep(
    core: Core, x: ArrayLike | None, over: str, values: NDArray[Any], objective: bool = False, threads: int | None = None
) -> tuple[_Columns, list[tuple[str, str]]]: ...
def optimize(core: Core, asked: Mapping[str, Any], tell: _Tell | None) -> str: ...
def certify(core: Core, x: ArrayLike | None, threads: int | None = None) -> str: ...
def prove(study: str, omega: float | None, tell: _Tell | None) -> str: ...
def verify(path: str, sample: int, within: float, tell: _Tell | None) -> None: ...
def design_study(requirements: str, kind: str) -> str: ...
def job(study: str, job: str, asked: Mapping[str, Any], tell: _Tell | None) -> str: ...
def branches(study: str, along: Mapping[str, Any], asked: Mapping[str, Any], tell: _Tell | None) -> str: ...
