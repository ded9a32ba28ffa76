"""Base class and start of all runs of a scene, and their end at the end of the program."""

from __future__ import annotations

import atexit
import warnings
import weakref
from typing import Any, Mapping, NamedTuple, Optional, Protocol, Union

import numpy as np
from numpy.typing import NDArray

from . import _core
from ._arguments import PathOrName, Vector, number_of, optional_path, path_of, whole_of
from ._core import ArgumentError, Error
from ._laws import Law, core_law
from ._meshes import Meshes, core_meshes
from ._scene_text import Scene, scene_file
from ._ticks import Figure, figure_of


class Body(NamedTuple):
    """Pose of an object that moves. A point at p before the first tick is now at position + R(orientation) p."""

    position: Vector
    """(3,), in the world, m; zeros before the first tick."""
    orientation: Vector
    """(4,): quaternion w, x, y, z; 1, 0, 0, 0 before the first tick."""


class RunBase:
    """Base class of everything that runs a scene."""

    _run: Any  # a _core.Run, or an object with its methods: FinishedRun, ArmView

    @property
    def objects(self) -> list[str]:
        """Names of the objects, in the order of the scene."""
        return self._run.objects

    @property
    def bodies(self) -> dict[str, Body]:
        """Present poses of all objects that move, by name, in the order of the scene.

        Raises Error while a run in real time continues.
        """
        return {name: Body(*pose) for name, pose in self._run.bodies.items()}

    @property
    def trackers(self) -> dict[str, tuple[str, str]]:
        """Tracker of each object that is a mesh in memory, and why it was chosen; "" if the scene names it."""
        return dict(self._run.trackers)

    @property
    def info(self) -> dict[str, Any]:
        """Description of the run, as in a recording: scene, arm, device, clock, program, rate [Hz], seed ..."""
        return self._run.info()

    @property
    def end(self) -> str:
        """Why the run ended: "done", "stopped" or "fault"; "" before its end."""
        return self._run.end or ""

    @property
    def stride(self) -> int:
        """N if every N-th tick is kept; 1 for runs of up to a million ticks."""
        return self._run.stride

    def mesh(self, object: Optional[str] = None) -> tuple[Vector, NDArray[np.int32]]:
        """Return the present mesh of one object, or one mesh of all: moved, dented, sculpted.

        Returns vertices (v, 3) in the world, m, and triangles (t, 3), counter-clockwise from outside.
        For a shape, this is the mesh that pictures of it use.
        """
        return self._run.mesh(object)

    def summary(self) -> str:
        """Return the summary of a finished run, as ``thimble run`` prints it."""
        return self._run.summary()

    def _name(self) -> str:
        """Return scene and arm, for people."""
        info = self.info
        return f"{info['scene']}, {info['arm']}"

    def figures(self) -> list[Figure]:
        """Return the figures of a finished run, with their goals."""
        return [figure_of(one) for one in self._run.figures()]


class ButtonRun(RunBase):
    """Base class of runs that continue, and whose simulated arm has buttons."""

    def hold_buttons(self, *buttons: int) -> None:
        """Hold these buttons of the first arm (1 to 16) from the next report until the next call.

        Without an argument all are released. Raises Error if the arm is real: only a hand can press its buttons.
        """
        held = {whole_of("buttons", button, 1, 16) for button in buttons}
        if not self._run.hold_buttons(sum(1 << (button - 1) for button in held)):
            raise Error('The arm is real, so only a hand can press its buttons. Use device="sim".')


class FinishedRun:
    """Copy of the results of a finished run without its ticks. It can be sent to another process."""

    def __init__(self, run: Union[_core.Run, "FinishedRun", "ArmView"]) -> None:
        self.objects: list[str] = list(run.objects)
        self.bodies: dict[str, tuple[Vector, Vector]] = dict(run.bodies)
        self.trackers: dict[str, tuple[str, str]] = dict(run.trackers)
        self.end: Optional[str] = run.end
        self.stride: int = run.stride
        self._info = run.info()
        self._summary = run.summary()
        self._figures = run.figures()
        self._meshes = {name: run.mesh(name) for name in (None, *self.objects)}

    def info(self) -> dict[str, Any]:
        return dict(self._info)

    def summary(self) -> str:
        return self._summary

    def figures(self) -> list[dict[str, Any]]:
        return self._figures

    def mesh(self, object: Optional[str] = None) -> tuple[Vector, NDArray[np.int32]]:
        if object not in self._meshes:
            raise ArgumentError(f'The scene has no object "{object}".')
        return self._meshes[object]


class ArmView:
    """View of a run for one of its arms."""

    def __init__(self, run: _core.Run, arm: int) -> None:
        self._run = run
        self._arm = arm

    def __getattr__(self, name: str) -> Any:
        found = getattr(self._run, name)
        if name in ("ticks", "latest", "summary", "figures", "info"):
            return lambda: found(self._arm)
        return found


class _Stopped(Protocol):
    def stop(self) -> None: ...


_open: "weakref.WeakSet[_Stopped]" = weakref.WeakSet()


def stop_at_exit(run: _Stopped) -> None:
    """Stop a run at the end of the program, if it still exists. It sends zero force and closes its recording."""
    _open.add(run)


def stop_all() -> None:
    """Stop all runs that were registered by :func:`stop_at_exit`."""
    for run in list(_open):
        try:
            run.stop()
        except Exception as wrong:  # stop the others in any case
            warnings.warn(str(wrong), RuntimeWarning, stacklevel=2)


atexit.register(stop_all)


def open_run(
    scene: Scene,
    *,
    set: Optional[Mapping[str, Any]],
    seconds: Optional[float],
    seed: Optional[int],
    arm: Optional[PathOrName],
    quality: str,
    record: Optional[PathOrName],
    overwrite: bool,
    law: Optional[Law] = None,
    device: str = "sim",
    agreed: bool = False,
    unchecked: bool = False,
    real_time: bool = False,
    firmware: Optional[PathOrName] = None,
    homed: bool = False,
    hold_to_run: Optional[str] = None,
    no_real_time: bool = False,
    ros2: Union[None, bool, dict[str, Any]] = None,
    meshes: Optional[Meshes] = None,
) -> _core.Run:
    if hold_to_run == "":
        raise ValueError('hold_to_run: expected "button", "button2" to "button16" or None, found "".')
    run = _core.Run(
        scene_file(scene, set, keep=record is not None),
        arm=optional_path("arm", arm),
        device=path_of("device", device, "\"sim\", \"auto\" or a name"),
        agreed=agreed,
        unchecked=unchecked,
        real_time=real_time,
        seconds=None if seconds is None else number_of("seconds", seconds),
        seed=None if seed is None else whole_of("seed", seed),
        quality=path_of("quality", quality, "draft, normal, reference or auto"),
        record=optional_path("record", record),
        overwrite=bool(overwrite),
        firmware=optional_path("firmware", firmware),
        law=core_law(law),
        homed=homed,
        hold_to_run=hold_to_run or "",
        no_real_time=no_real_time,
        ros2=ros2,
        meshes=core_meshes(meshes),
    )
    for warning in run.warnings():
        warnings.warn(warning, RuntimeWarning, stacklevel=3)
    return run
