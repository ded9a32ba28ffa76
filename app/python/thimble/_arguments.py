"""Checks of arguments (paths, numbers, vectors), with a readable error for a wrong one."""

from __future__ import annotations

import os
import warnings
from typing import Any, Optional, TypeVar, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._core import ArgumentError

PathOrName = Union[str, "os.PathLike[str]"]
Vector = NDArray[np.float64]
Value = TypeVar("Value")

_MAX_SEED = 2**64 - 1  # limit of the program's type


def path_of(name: str, value: PathOrName, meant: str = "a file or a name") -> str:
    """Return a path or name as text. Raises TypeError for any other type."""
    try:
        text = os.fsdecode(value)
    except TypeError:
        raise TypeError(f"{name}: expected {meant}, found {value!r}.") from None
    try:
        text.encode("utf-8")
    except UnicodeEncodeError:
        raise ArgumentError(f"{name}: {text!r} is not UTF-8; rename the file.") from None
    return text


def optional_path(name: str, value: Optional[PathOrName]) -> str:
    """Return a path or name as text, or "" for None."""
    return "" if value is None else path_of(name, value)


def number_of(name: str, value: Any) -> float:
    """Return a number as float. Raises TypeError for any other type."""
    try:
        if isinstance(value, (str, bytes, bool)):
            raise TypeError
        return float(value)
    except (TypeError, ValueError):
        raise TypeError(f"{name}: expected a number, found {value!r}.") from None


def whole_of(name: str, value: Any, minimum: int = 0, maximum: int = _MAX_SEED) -> int:
    """Return an integer. Raises TypeError for any other type, ArgumentError outside the bounds."""
    number = number_of(name, value)
    if not number.is_integer() or not minimum <= int(value) <= maximum:
        raise ArgumentError(f"{name}: expected a whole number from {minimum} to {maximum}, found {value!r}.")
    return int(value)


def vector_of(name: str, value: ArrayLike, finite: bool = True) -> Vector:
    """Return three numbers, (3,). Raises ArgumentError for anything else."""
    return _array(name, value, (3,), "three numbers", finite)


def rows_of(name: str, value: ArrayLike, rows: int, finite: bool = True) -> Vector:
    """Return an array (rows, 3). One vector (3,) is repeated for all rows."""
    if np.shape(value) == (3,):
        return np.tile(vector_of(name, value, finite), (rows, 1))
    return _array(name, value, (rows, 3), f"the shape ({rows}, 3) or (3,)", finite)


def text_of_span(begin: float, end: float) -> str:
    """Return a span of time for people: "0.000 to 2.999 s"."""
    return f"{begin:.3f} to {end:.3f} s"


def warn_renamed(old: str, new: str) -> None:
    """Warn the caller of the calling function that it used an old name."""
    warnings.warn(f"{old} is deprecated; use {new}.", DeprecationWarning, stacklevel=3)


def renamed(old: str, old_value: Optional[Value], new: str, value: Value, default: Value) -> Value:
    """Return the value of a renamed argument, given by its old or its new name.

    Raises TypeError if it is given by both.
    """
    if old_value is None:
        return value
    if value != default:
        raise TypeError(f"{old}: is the old name of {new}, which is given too; keep {new}.")
    warnings.warn(f"{old}= is deprecated; use {new}=.", DeprecationWarning, stacklevel=3)
    return old_value


def _array(name: str, value: ArrayLike, shape: tuple[int, ...], meant: str, finite: bool) -> Vector:
    try:
        array = np.ascontiguousarray(value, dtype=np.float64)
    except (TypeError, ValueError):
        array = np.empty(0)
    if array.shape != shape or (finite and not np.isfinite(array).all()):
        raise ArgumentError(f"{name}: expected {meant}, found {value!r}.")
    return array
