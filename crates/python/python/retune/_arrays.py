"""Numbers from whatever the caller has."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from retune._errors import StudyError


def floats(values: Any, name: str) -> NDArray[np.float64]:
    """The numbers of any array, list or scalar, 64-bit, aligned, in C order."""
    try:
        array = np.asarray(values)
        if array.dtype.kind not in "biufO":
            raise StudyError(f"{name}: {array.dtype} is not allowed here: give real numbers", name)
        return np.require(array, np.float64, ["C", "A"])
    except (TypeError, ValueError, OverflowError) as error:
        if isinstance(error, StudyError):
            raise
        raise StudyError(f"{name}: {error}: give real numbers", name) from error


def plain(value: Any, path: str = "") -> Any:
    """A value as JSON can hold it: numpy's numbers and arrays become Python's, and what no study may have is refused by its path."""
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
