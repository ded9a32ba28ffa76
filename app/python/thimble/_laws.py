"""Custom force laws: a Python function of a tick, or a compiled function."""

from __future__ import annotations

import ctypes
from typing import Any, Callable, Optional, Union

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._arguments import Vector
from ._core import ArgumentError
from ._ticks import Tick

_three = ctypes.POINTER(ctypes.c_double)

LawFunction = ctypes.CFUNCTYPE(None, ctypes.c_double, _three, _three, _three, _three, ctypes.c_void_p)
"""ctypes type of a compiled law's C signature (:func:`compiled_law`)."""


class CompiledLaw:
    """A compiled force law (:func:`compiled_law`): its address, and the data that is passed to it."""

    def __init__(self, address: int, data: Optional[Vector], kept: object) -> None:
        self.address = address
        self.data = data
        self._kept = kept

    def __repr__(self) -> str:
        data = "" if self.data is None else f", data of {self.data.size} numbers"
        return f"CompiledLaw({getattr(self._kept, '__name__', 'function')} at {self.address:#x}{data})"


Law = Union[Callable[[Tick], Optional[ArrayLike]], CompiledLaw]


def compiled_law(function: Any, data: Optional[NDArray[np.float64]] = None) -> CompiledLaw:
    """Return a force law that runs without the interpreter, for ``law=`` of :func:`run` and :class:`Stepper`.

    function: one of

    - A Python function ``law(time, tip, velocity, wanted, force)``, which numba compiles (Debian:
      python3-numba). All arguments but the time (s) are arrays (3,) in the world: tip (m), velocity (m/s),
      the force of the scene (N), and the force on the hand (N), which the law sets and which is 0 at first.
      With ``data``, that array (n,) is a sixth argument. ``@compiled_law`` may be used as a decorator.
    - A ctypes function, a ``numba.cfunc``, or the address of a C function as an int, with this C signature
      (``LawFunction`` is its ctypes type)::

          void law(double time, const double tip[3], const double velocity[3], const double wanted[3],
                   double force[3], void *data);

    data: float64 array. Each call gets a pointer to its first element. Its values may change between two
    steps of a Stepper.

    The force goes through the safety gate. Its components are NaN at first. If a function fails before it
    has set all three, the force is zero and the run ends with the fault "force_not_finite". The signature
    of an address cannot be checked; a wrong one crashes the program.
    """
    if data is not None and not (
        isinstance(data, np.ndarray) and data.dtype == np.float64 and data.flags.c_contiguous
    ):
        raise ArgumentError(f"data: expected a C-contiguous numpy array of float64, found {data!r}.")
    address: int
    if type(function) is int:
        address = function
    elif _is_ctypes(function):
        address = ctypes.cast(function, ctypes.c_void_p).value or 0
    elif _is_numba_cfunc(function):
        address = function.address
    elif callable(function):
        function = _by_numba(function, data)
        address = function.address
    else:
        raise TypeError(f"compiled_law: expected a function or its address, found {function!r}.")
    if address <= 0:
        raise ArgumentError(f"compiled_law: {address} is not the address of a function.")
    return CompiledLaw(address, data, function)


def core_law(law: Optional[Law]) -> Any:
    """Return a law as ``_core`` takes it: a function of columns, or (address, data, object to keep alive)."""
    if law is None:
        return None
    compiled = compiled_law(law) if _is_ctypes(law) or _is_numba_cfunc(law) else law
    if isinstance(compiled, CompiledLaw):
        return compiled.address, 0 if compiled.data is None else compiled.data.ctypes.data, compiled
    if not callable(compiled):
        raise TypeError(f"law: expected a function of a tick, or a compiled_law, found {law!r}.")
    asked = compiled
    return lambda columns: asked(Tick(columns))


def _is_ctypes(law: object) -> bool:
    return isinstance(law, LawFunction.__mro__[1])  # the only access to ctypes' class of functions


def _is_numba_cfunc(law: object) -> bool:
    return type(law).__module__.startswith("numba.") and hasattr(law, "address")


def _by_numba(function: Callable[..., Any], data: Optional[Vector]) -> Any:
    try:
        import numba
    except ImportError as missing:
        raise ImportError(
            "compiled_law() of a Python function needs numba: install python3-numba, or `pip install numba`. "
            "ctypes functions and addresses work without it."
        ) from missing
    inner = function if hasattr(function, "py_func") else numba.njit(function)
    three = numba.types.CPointer(numba.types.float64)
    signature = numba.types.void(numba.types.float64, three, three, three, three, three)
    carray, zeros, size = numba.carray, np.zeros, 0 if data is None else data.size

    def plain(time: Any, tip: Any, velocity: Any, wanted: Any, force: Any, data: Any) -> None:
        filled = zeros(3)
        inner(time, carray(tip, 3), carray(velocity, 3), carray(wanted, 3), filled)
        carray(force, 3)[:] = filled  # not earlier: an exception leaves no force

    def with_data(time: Any, tip: Any, velocity: Any, wanted: Any, force: Any, data: Any) -> None:
        filled = zeros(3)
        inner(time, carray(tip, 3), carray(velocity, 3), carray(wanted, 3), filled, carray(data, size))
        carray(force, 3)[:] = filled

    try:
        return numba.cfunc(signature)(plain if data is None else with_data)
    except numba.core.errors.NumbaError as wrong:
        raise ArgumentError(f"compiled_law: numba cannot compile {function!r}: {wrong}") from wrong
