"""Touch virtual objects from Python: scenes, simulated arms and recordings as numpy arrays.

Everything here runs the code of the program ``thimble`` itself; a run from Python is the same to the
bit as ``thimble run``. All numbers are SI. Frames: W world, T tip of the arm (where the hand holds
it), P proxy (the point of the surface that the tip is held at); ``p_WT`` is the position of T in W.
Forces act on the hand.

    import thimble
    touch = thimble.run("elephant", seconds=2)
    touch.time, touch.tip, touch.force        # (n,) s, (n, 3) m, (n, 3) N

Python never runs in the servo loop of a real arm: its interpreter may stand still for tens of
milliseconds (collection of garbage, its lock, a page from the disk), and after so long an arm switches
its force off, or goes on with an old one. Force laws in Python (``law=``) and steps by hand
(:class:`Stepper`, :class:`Simulator`) are therefore of virtual time, which waits for them. In real time
(:func:`open`) the loop is C++ on a thread of its own, and Python looks on.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any, NamedTuple

from . import _core
from ._arguments import PathOrName
from ._core import ArgumentError, Error
from ._knobs import Knob, Knobs
from ._laws import CompiledLaw, Law, LawFunction, compiled_law
from ._live import Live, open
from ._meshes import Meshes
from ._runs import Run, Stepper, run
from ._scene_text import Scene
from ._shot import Shot, shot
from ._simulator import Simulator, Simulators
from ._study import study
from ._ticks import Figure, Recording, Tick, Ticks, read_recording, units

__version__: str = _core.version
__all__ = [
    "ArgumentError",
    "CompiledLaw",
    "Error",
    "Figure",
    "Knob",
    "Knobs",
    "LawFunction",
    "Live",
    "Meshes",
    "NamedFile",
    "Recording",
    "Run",
    "Shot",
    "Simulator",
    "Simulators",
    "Stepper",
    "Tick",
    "Ticks",
    "arms",
    "compiled_law",
    "devices",
    "open",
    "read_recording",
    "run",
    "scenes",
    "shot",
    "study",
    "units",
]


class NamedFile(NamedTuple):
    """A scene or arm file that is known by name."""

    name: str
    path: Path
    description: str


def scenes() -> list[NamedFile]:
    """List the scenes that are known by name (``thimble run --list``)."""
    return [NamedFile(name, Path(path), about) for name, path, about in _core.scenes()]


def arms() -> list[NamedFile]:
    """List the arm files that are known by name."""
    return [NamedFile(name, Path(path), about) for name, path, about in _core.arms()]


def devices() -> list[dict[str, Any]]:
    """List the real arms that are plugged in (``thimble devices``): name, arm, bus, where, node, ready."""
    return _core.devices()


for _public in __all__:  # so that errors, pickles and help say thimble.Run
    globals()[_public].__module__ = "thimble"
