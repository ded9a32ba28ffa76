"""Versions of numpy with which the compiled module works."""

from __future__ import annotations

import numpy as np

from ._core import Error


def check(pybind11: str, numpy: str = np.__version__) -> None:
    """Raise Error for numpy 2 with a module that was compiled for numpy 1.

    pybind11: version with which the module was compiled. Before 2.12 it reads arrays of numpy 2 wrongly, because
    numpy 2 has another layout of types [pybind11 change log, 2.12].
    """
    major, minor = (int(one) for one in ((pybind11 or "0.0").split(".") + ["0"])[:2])
    if int(numpy.partition(".")[0]) >= 2 and (major, minor) < (2, 12):
        raise Error(
            f"thimble was compiled with pybind11 {pybind11 or '(unknown)'}, which works with numpy 1; numpy {numpy} is "
            'installed. Install "numpy<2", or build thimble with pybind11 2.12 or newer.'
        )
