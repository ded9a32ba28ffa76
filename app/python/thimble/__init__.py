"""Touch virtual objects from Python: scenes, simulated arms and recordings as numpy arrays.

This package runs the same code as the program ``thimble``: a run from Python is bit-identical to
``thimble run``. All numbers are SI. Frames: W world, T tip of the arm (where the hand holds it),
P proxy (the point that stays on the surface while the tip is inside the object). ``p_WT`` is the
position of T in W. Forces act on the hand.

    import thimble
    touch = thimble.run("elephant", seconds=2)
    touch.time, touch.tip, touch.force        # (n,) s, (n, 3) m, (n, 3) N

Python never runs in the servo loop of a real arm. Its interpreter may pause for tens of milliseconds
(garbage collection, the interpreter lock, a page fault). During such a pause an arm switches its force
off or continues to apply an old one. Force laws in Python (``law=``) and single steps (:class:`Stepper`,
:class:`Simulator`) therefore exist in virtual time only, which waits for them. In real time
(:func:`open`) the loop runs in C++ on its own thread; Python only observes it.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any, NamedTuple

from . import _core, _numpy_version
from ._arguments import PathOrName
from ._compare import Comparison, Difference
from ._core import ArgumentError, Error
from ._knobs import Knob, Knobs
from ._laws import CompiledLaw, Law, LawFunction, compiled_law
from ._live import Live, open
from ._meshes import Meshes
from ._page import Page, show
from ._run_base import Body
from ._runs import Run, Stepper, run
from ._scene_text import Scene
from ._shot import Shot, shot
from ._simulator import Simulator, Simulators
from ._study import study
from ._ticks import Figure, Recording, Tick, Ticks, read_recording, units
from ._timeline import Timeline

_numpy_version.check(getattr(_core, "pybind11_version", ""))

__version__: str = _core.version
__all__ = [
    "ArgumentError",
    "Body",
    "Comparison",
    "CompiledLaw",
    "Difference",
    "Error",
    "Figure",
    "Knob",
    "Knobs",
    "LawFunction",
    "Live",
    "Meshes",
    "NamedFile",
    "Page",
    "Recording",
    "Run",
    "Shot",
    "Simulator",
    "Simulators",
    "Stepper",
    "Tick",
    "Ticks",
    "Timeline",
    "arms",
    "compiled_law",
    "devices",
    "open",
    "read_recording",
    "run",
    "scenes",
    "shot",
    "show",
    "study",
    "units",
]


class NamedFile(NamedTuple):
    """A scene or arm file that can be given by name."""

    name: str
    path: Path
    description: str


def scenes() -> list[NamedFile]:
    """Return the scenes that can be given by name (``thimble run --list``)."""
    return [NamedFile(name, Path(path), about) for name, path, about in _core.scenes()]


def arms() -> list[NamedFile]:
    """Return the arm files that can be given by name."""
    return [NamedFile(name, Path(path), about) for name, path, about in _core.arms()]


def devices() -> list[dict[str, Any]]:
    """Return the connected real arms (``thimble devices``): name, arm, bus, where, node, ready."""
    return _core.devices()


for _public in __all__:  # so that errors, pickles and help show thimble.Run
    globals()[_public].__module__ = "thimble"
