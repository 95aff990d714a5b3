"""Numbers from whatever the caller has."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from retune import _core
from retune._errors import Error, StudyError


def refused(error: Exception, name: str, wanted: str) -> StudyError:
    """What an object that raises becomes, whatever it raises: the exception of the argument that it was given as."""
    return StudyError(f"{name}: {type(error).__name__}: {error}: give {wanted}", name)


def scalar(value: Any, name: str, of: str | None = None) -> float:
    """A number, or a text with its unit ("20 kN/m"); ``of`` is what it is in the catalogue, if that is not its name."""
    try:
        if isinstance(value, str):
            return _typed(value, name, of or name.rpartition(".")[2])
        return float(value)
    except (Error, MemoryError):
        raise
    except Exception as error:
        raise refused(error, name, "a number") from error


def _typed(text: str, name: str, of: str) -> float:
    try:
        return _core.typed(of, text)
    except ValueError as error:
        raise StudyError(f"{name}: {error}", name, text) from None


def pair(values: Any, name: str) -> tuple[Any, Any]:
    """Two of anything: a window, a band, bounds."""
    if isinstance(values, str):
        raise StudyError(f'{name}: "{values}" is not allowed here: give two, for instance (5, 8) or ("0.8 Hz", "1.3 Hz")', name, values)
    try:
        first, second = values
    except (Error, MemoryError):
        raise
    except Exception as error:
        raise refused(error, name, "two numbers") from error
    return first, second


def floats(values: Any, name: str) -> NDArray[np.float64]:
    """The numbers of any array, list or scalar, 64-bit, aligned, in C order."""
    if values is None:
        raise StudyError(f"{name}: None is not allowed here: give real numbers", name)
    try:
        array = np.asarray(values)
        if array.dtype.kind not in "biufO":
            raise StudyError(f"{name}: {array.dtype} is not allowed here: give real numbers", name)
        return np.require(array, np.float64, ["C", "A"])
    except (Error, MemoryError):
        raise
    except Exception as error:
        raise refused(error, name, "real numbers") from error


def plain(value: Any, path: str = "") -> Any:
    """A value as JSON can hold it: numpy's numbers and arrays become Python's, and what no study may have is refused by its path."""
    try:
        return _plain(value, path)
    except (Error, MemoryError):
        raise
    except Exception as error:
        raise refused(error, path, "a number, a text, a list or a mapping") from error


def _plain(value: Any, path: str) -> Any:
    if isinstance(value, Mapping):
        return {str(key): plain(item, f"{path}.{key}".lstrip(".")) for key, item in value.items()}
    if isinstance(value, np.ndarray):
        value = value.tolist()
    if isinstance(value, (list, tuple)):
        return [plain(item, f"{path}[{i}]") for i, item in enumerate(value)]
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, float) and not math.isfinite(value):
        raise StudyError(f"{path}: {value} is not allowed here: give a finite number", path, value)
    if value is None or isinstance(value, (bool, int, float, str)):
        return value
    raise StudyError(f"{path}: {type(value).__name__} is not allowed here: give a number, a text, a list or a mapping", path, value)
