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

import atexit
import functools
import json
import os
import re
import shutil
import signal
import subprocess
import tempfile
import threading
import warnings
import weakref
from pathlib import Path
from typing import Any, Callable, Iterator, Mapping, NamedTuple, Optional, Sequence, Union, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core, _show
from ._core import Error

__version__: str = _core.version
__all__ = [
    "ArgumentError",
    "Error",
    "Figure",
    "Live",
    "NamedFile",
    "Recording",
    "Run",
    "Simulator",
    "Stepper",
    "Tick",
    "Ticks",
    "arms",
    "devices",
    "open",
    "read_recording",
    "run",
    "scenes",
    "study",
    "units",
]

PathOrName = Union[str, "os.PathLike[str]"]
Scene = Union[PathOrName, Mapping[str, Any]]
Vector = NDArray[np.float64]
Law = Callable[["Tick"], Optional[ArrayLike]]


class ArgumentError(Error, ValueError):
    """An argument that names nothing that there is, or misses its bounds; the sentence says what would do."""


class NamedFile(NamedTuple):
    """A scene or arm file that is known by name."""

    name: str
    path: Path
    description: str


class Figure(NamedTuple):
    """One number that a run or a study stands for; ``goal`` is a comparison (">= 20") or ""."""

    name: str
    value: float
    unit: str
    goal: str
    met: bool


def scenes() -> list[NamedFile]:
    """List the scenes that are known by name (``thimble run --list``)."""
    return [NamedFile(name, Path(path), about) for name, path, about in _core.scenes()]


def arms() -> list[NamedFile]:
    """List the arm files that are known by name."""
    return [NamedFile(name, Path(path), about) for name, path, about in _core.arms()]


def devices() -> list[dict[str, Any]]:
    """List the real arms that are plugged in (``thimble devices``): name, arm, bus, where, node, ready."""
    return _core.devices()


def units() -> dict[str, tuple[str, str]]:
    """Tell unit and meaning of each column of :attr:`Ticks.columns`, by its name.

    The columns are as the servo loop wrote them; times among them are whole nanoseconds.
    """
    return {name: (unit, about) for name, unit, about in _core.columns()}


class _Columns:
    """The columns of ticks by plain names; views, nothing is copied but ``time`` and ``due``."""

    def __init__(self, columns: Any) -> None:
        self.columns = columns

    def _of(self, name: str) -> Any:
        return self.columns[name]

    @property
    def time(self) -> Any:
        """When the tick began, on the loop's clock, s."""
        return self._of("time") * 1e-9

    @property
    def tip(self) -> Any:
        """Tip in the world, p_WT, m, as the encoders tell it."""
        return self._of("p_WT")

    @property
    def velocity(self) -> Any:
        """Velocity of the tip in the world, v_WT, m/s, as the driver estimates it."""
        return self._of("v_WT")

    @property
    def force(self) -> Any:
        """Force on the hand in the world that went through the safety gate to the motors, N."""
        return self._of("f_sent_W")

    @property
    def force_wanted(self) -> Any:
        """Force on the hand in the world that the force law asked for, N."""
        return self._of("f_wanted_W")

    @property
    def heat(self) -> Any:
        """Heat of each motor; 1 is its winding's limit, 0 if the arm file does not name it."""
        return self._of("heat")

    @property
    def proxy(self) -> Any:
        """Point of the surface that the tip is held at, p_WP, in the world, m; while in contact."""
        return self._of("p_WP")

    @property
    def normal(self) -> Any:
        """Outward unit normal that the force acts along, in the world; 0 without contact."""
        return self._of("n_W")

    @property
    def depth(self) -> Any:
        """Depth of the tip below the surface, m; 0 without contact."""
        return self._of("depth")

    @property
    def joints(self) -> Any:
        """Joint angles, rad; the arm's geometry says zero and sign."""
        return self._of("q")

    @property
    def orientation(self) -> Any:
        """Rotation of the stylus in the world as a quaternion w, x, y, z; zeros if the arm tells none."""
        return self._of("q_WT")

    @property
    def gimbal(self) -> Any:
        """Angles of the gimbal's axes, rad; zeros if the arm has none."""
        return self._of("gimbal")

    @property
    def gripper(self) -> Any:
        """Opening of the gripper, m; 0 if it is closed, or if the arm has none (``columns["has_gripper"]``)."""
        return self._of("gripper")

    @property
    def object(self) -> Any:
        """Number of the object that is touched, from 0 in the scene's order; -1 for none."""
        return self._of("object")


class Tick(_Columns):
    """One tick of the servo loop: numbers, and arrays of shape (3,). ``columns`` has all that it did."""

    @property
    def in_contact(self) -> bool:
        """Whether the tip is held outside an object."""
        return bool(self._of("in_contact"))

    @property
    def buttons(self) -> int:
        """Buttons of the arm, one bit each; bit 0 is the first."""
        return int(self._of("buttons"))

    @property
    def fault(self) -> str:
        """Short name of what switched the force off ("over_speed"); "" if nothing did."""
        number = int(self._of("fault"))
        return _core.fault(number)[0] if number else ""

    def __repr__(self) -> str:
        return (
            f"Tick({self.time:.4f} s, tip {np.round(self.tip, 5)} m, force {np.round(self.force, 3)} N"
            f"{', ' + self.fault if self.fault else ''})"
        )


class Ticks(_Columns):
    """What a servo loop did: n ticks, as arrays of shape (n,) and (n, 3).

    ``columns`` is a structured array with everything, by the names of a recording's columns
    (:func:`units` tells what they are); the properties are views of it.
    """

    @property
    def in_contact(self) -> NDArray[np.bool_]:
        """Whether the tip was held outside an object, (n,)."""
        return self._of("in_contact").view(np.bool_)

    def __len__(self) -> int:
        return len(self.columns)

    @overload
    def __getitem__(self, index: int) -> Tick: ...

    @overload
    def __getitem__(self, index: Union[slice, NDArray[Any]]) -> "Ticks": ...

    def __getitem__(self, index: Any) -> Any:
        """Give one tick, or several by a slice, an array of numbers or a mask: ``run[run.in_contact]``."""
        columns = self.columns[index]
        return Tick(columns) if isinstance(columns, np.void) else Ticks(columns)

    def __iter__(self) -> Iterator[Tick]:
        return map(Tick, self.columns)

    def to_pandas(self) -> Any:
        """Give all columns as a pandas DataFrame over the time in s.

        Vectors become ``p_WT_x``, ``p_WT_y``, ``p_WT_z``, what has no axes ``q_0`` and so on; units as
        :func:`units` tells them. ImportError without pandas.
        """
        return _show.to_pandas(self)

    def plot(self) -> Any:
        """Draw force and depth over time, and give matplotlib's figure. ImportError without matplotlib."""
        return _show.plot(self, self._title())

    def _title(self) -> str:
        return "ticks"

    def _figures(self) -> list[Figure]:
        return []

    def _repr_html_(self) -> str:
        return _show.html(self._title(), self, self._figures())


class Recording(Ticks):
    """A recording that was read (:func:`read_recording`).

    ``info`` says what was run (scene, scene_text, arm, device, clock, program, rate [Hz], seed ...);
    ``complete`` is False if it was cut off by a crash or a full disk.
    """

    def __init__(self, info: Mapping[str, Any], columns: Any, complete: bool) -> None:
        super().__init__(columns)
        self.info = dict(info)
        self.complete = complete

    def _title(self) -> str:
        return f"{self.info['scene']}, {self.info['arm']}"


def read_recording(path: PathOrName) -> Recording:
    """Read what ``thimble run SCENE --record FILE``, or ``record=`` here, has written (HDF5)."""
    return Recording(*_core.read_recording(os.fspath(path)))


class _Held:
    """What all that run a scene have in common."""

    _run: Union[_core.Run, _Past, _OfArm]

    @property
    def objects(self) -> list[str]:
        """Names of the scene's objects, in its order."""
        return self._run.objects

    @property
    def info(self) -> dict[str, Any]:
        """What runs, as recordings say it: scene, arm, device, clock, program, rate [Hz], seed ..."""
        return self._run.info()

    @property
    def end(self) -> str:
        """Why the run ended: "done", "stopped" or "fault"; "" while it has not."""
        return self._run.end or ""

    @property
    def stride(self) -> int:
        """Every how many-th tick is kept: 1 for runs of up to a million ticks."""
        return self._run.stride

    def mesh(self, object: Optional[str] = None) -> tuple[Vector, NDArray[np.int32]]:
        """Give the mesh of one object, or of all as one, as it is now: moved, dented, sculpted.

        Returns vertices (v, 3) in the world, m, and triangles (t, 3), counter-clockwise from outside.
        Shapes give the mesh that stands for them in pictures.
        """
        return self._run.mesh(object)

    def summary(self) -> str:
        """Tell a run that is over in plain words, as ``thimble run`` does."""
        return self._run.summary()

    def figures(self) -> list[Figure]:
        """Tell the figures of a run that is over, with their goals."""
        return [_figure(one) for one in self._run.figures()]


def _figure(one: Mapping[str, Any]) -> Figure:
    return Figure(one["name"], one["value"], one["unit"], one.get("goal", ""), one.get("met", True))


class _Past:
    """What a run that is over tells, apart from its ticks: what is left of it in another process."""

    def __init__(self, run: Union[_core.Run, "_Past"]) -> None:
        self.objects = list(run.objects)
        self.end = run.end
        self.stride = run.stride
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
            raise Error(f'The scene has no object "{object}".')
        return self._meshes[object]


class _OfArm:
    """A run as one of its arms had it."""

    def __init__(self, run: _core.Run, arm: int) -> None:
        self._run = run
        self._arm = arm

    def __getattr__(self, name: str) -> Any:
        found = getattr(self._run, name)
        if name in ("ticks", "latest", "summary", "figures", "info"):
            return lambda: found(self._arm)
        return found


class Run(_Held, Ticks):
    """A run that is over: its ticks as arrays, and what it was. May be pickled, meshes and all.

    Of a scene with several arms it is what the first of them did; ``arms`` has all of them.
    """

    def __init__(
        self,
        run: Union[_core.Run, _Past, _OfArm],
        columns: Any = None,
        arms: Optional[dict[str, "Run"]] = None,
    ) -> None:
        self._run = run
        self._arms = arms
        Ticks.__init__(self, run.ticks() if columns is None else columns)

    @property
    def arms(self) -> dict[str, "Run"]:
        """The run of each arm by its name in the scene; empty if the scene has one alone."""
        if self._arms is None:
            self._arms = {name: Run(_OfArm(self._run, i), None, {}) for i, name in enumerate(self._run.arms)}
        return self._arms

    def __reduce__(self) -> tuple[Any, ...]:
        return Run, (_Past(self._run), self.columns, self.arms)

    def _title(self) -> str:
        return f"{self.info['scene']}, {self.info['arm']}"

    def _figures(self) -> list[Figure]:
        return self.figures()


def _as_yaml(value: Any) -> str:
    """Write a value as JSON, which YAML understands; numpy's are taken as Python's own."""
    try:
        return json.dumps(value, allow_nan=False, default=lambda one: one.tolist())
    except (AttributeError, TypeError, ValueError) as wrong:
        raise ArgumentError(f"A scene cannot hold {value!r}: {wrong}.") from wrong


def _scene_file(scene: Scene, changes: Optional[Mapping[str, Any]], keep: bool) -> str:
    """Give the file of a scene; of one without a file, or changed, one that is written for it.

    keep: in the user's state folder, where a recording's replay finds it, not for this process alone.
    """
    beside = Path.cwd()
    if isinstance(scene, Mapping):
        text = _as_yaml(scene)
    elif isinstance(scene, str) and "\n" in scene:
        text = scene
    elif changes:
        file = Path(_core.find_scene(os.fspath(scene)))
        try:
            text, beside = file.read_text(encoding="utf-8"), file.parent
        except (OSError, UnicodeDecodeError) as wrong:
            raise Error(f"{file}: cannot be read: {wrong}.") from wrong
    else:
        return os.fspath(scene)
    into = "" if keep else str(_scratch())
    values = {place: _as_yaml(value) for place, value in (changes or {}).items()}
    return _core.keep_scene(text, values, str(beside), into)


@functools.lru_cache(maxsize=1)
def _scratch() -> Path:
    folder = tempfile.mkdtemp(prefix="thimble-")
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    return Path(folder)


def _begin(
    scene: Scene,
    *,
    set: Optional[Mapping[str, Any]],
    seconds: Optional[float],
    seed: Optional[int],
    arm: Optional[PathOrName],
    quality: str,
    record: Optional[PathOrName],
    law: Optional[Law] = None,
    device: str = "sim",
    agreed: bool = False,
    unchecked: bool = False,
    real_time: bool = False,
    firmware: Optional[PathOrName] = None,
    homed: bool = False,
    no_real_time: bool = False,
    ros2: Union[None, bool, dict[str, Any]] = None,
) -> _core.Run:
    run = _core.Run(
        _scene_file(scene, set, keep=record is not None),
        arm=os.fspath(arm) if arm is not None else "",
        device=device,
        agreed=agreed,
        unchecked=unchecked,
        real_time=real_time,
        seconds=seconds,
        seed=seed,
        quality=quality,
        record=os.fspath(record) if record is not None else "",
        firmware=os.fspath(firmware) if firmware is not None else "",
        law=None if law is None else lambda columns: law(Tick(columns)),
        homed=homed,
        no_real_time=no_real_time,
        ros2=ros2,
    )
    for warning in run.warnings():
        warnings.warn(warning, RuntimeWarning, stacklevel=3)
    return run


def run(
    scene: Scene,
    *,
    set: Optional[Mapping[str, Any]] = None,
    seconds: Optional[float] = None,
    seed: Optional[int] = None,
    arm: Optional[PathOrName] = None,
    quality: str = "normal",
    record: Optional[PathOrName] = None,
    law: Optional[Law] = None,
) -> Run:
    """Let the simulated hand touch a scene in virtual time, and give what was felt.

    The same to the bit as ``thimble run``, and again each time. Other Python threads go on meanwhile;
    Ctrl-C ends it.

    scene: file, or a name (:func:`scenes`); or the scene itself, as a dict or as YAML text of several
    lines, with files beside the working folder. set: values of it to be others, by where they stand:
    ``{"ball.stiffness": 300, "ball.effects.friction.coefficient": 0.2, "rate": 2000}``. seconds: how long; the scene's own if absent. seed: of
    everything random; the scene's own if absent. arm: file or name in place of the scene's arm.
    quality: "draft", "normal", "reference" or "auto". record: HDF5 file to write every tick into.

    law: a force law in place of the scene's: ``law(tick)`` is asked in each tick for the force on the
    hand, three numbers (N, in the world), or None for the scene's own, which is
    ``tick.force_wanted``. It goes through the safety gate as any force does. An exception in it is
    zero force, the end of the run, and comes out here.

    Raises Error, with what to do, if scene, arm or mesh cannot be had. A fault of the arm is no
    exception: ``end`` is "fault" then, and the last tick names it.
    """
    held = _begin(scene, set=set, seconds=seconds, seed=seed, arm=arm, quality=quality, record=record, law=law)
    held.run()
    return Run(held)


class Stepper(_Held):
    """A scene in virtual time, tick by tick. Options as of :func:`run`.

    ``while stepper.step(): ...`` is the same to the bit as :func:`run`.
    """

    def __init__(
        self,
        scene: Scene,
        *,
        set: Optional[Mapping[str, Any]] = None,
        seconds: Optional[float] = None,
        seed: Optional[int] = None,
        arm: Optional[PathOrName] = None,
        quality: str = "normal",
        record: Optional[PathOrName] = None,
        law: Optional[Law] = None,
    ) -> None:
        self._run = _begin(
            scene, set=set, seconds=seconds, seed=seed, arm=arm, quality=quality, record=record, law=law
        )

    def step(self, hand: Optional[ArrayLike] = None) -> bool:
        """Run the next tick. False, and nothing runs, if the run is over.

        hand: where the hand is led to from now on, (3,) in the world, m, in place of the scene's way:
        it goes there as a person's would, smoothly and at most with 0.4 m/s. A point outside of the
        arm's workspace is drawn to its box. Raises Error where the arm does not reach it.
        """
        return self._run.step(None if hand is None else _vector("hand", hand))

    @property
    def tick(self) -> Optional[Tick]:
        """The tick that ran last; None before the first."""
        latest = self._run.latest()
        return None if latest is None else Tick(latest)

    def stop(self) -> None:
        """End the run now, with zero force; a recording is closed."""
        self._run.stop()

    def ticks(self) -> Ticks:
        """Give all ticks so far."""
        return Ticks(self._run.ticks())


class Simulator:
    """A simulated arm without a scene, in virtual time: you are its force law.

    arm: arm file, or a name (:func:`arms`). hand: where the hand holds the tip, (3,) in the world, m.
    rate: ticks per second, Hz. seed: of the hand's tremor. Forces go through the same safety gate and
    the same bytes as those to a real arm.
    """

    def __init__(
        self,
        arm: PathOrName = "vintage_phantom",
        *,
        hand: ArrayLike = (0.0, 0.0, 0.0),
        rate: float = 1000,
        seed: int = 0,
    ) -> None:
        self._arm = _core.SimulatorSession(os.fspath(arm), _vector("hand", hand), rate, seed)

    def step(self, force: ArrayLike = (0.0, 0.0, 0.0), hand: Optional[ArrayLike] = None) -> Tick:
        """Run one tick with a force on the hand, (3,) in the world, N, and give it.

        The tick tells the tip as it was read when the tick began, so before this force acted.
        hand: where the hand is led to from now on, as in :meth:`Stepper.step`.
        After a fault (``tick.fault``) the force stays off until :meth:`activate`.
        """
        goal = None if hand is None else _vector("hand", hand)
        return Tick(self._arm.step(_vector("force", force, finite=False), goal))

    def activate(self) -> None:
        """Let forces through again after a fault, with a soft start."""
        self._arm.activate()

    @property
    def name(self) -> str:
        """Name of the arm."""
        return self._arm.name

    @property
    def true_force(self) -> Vector:
        """Force that the motors exert on the tip now, (3,) in the world, N: what no driver can see."""
        return self._arm.true_force

    @property
    def force_max(self) -> float:
        """Limit of the safety gate, N."""
        return self._arm.force_max

    @property
    def workspace(self) -> tuple[Vector, Vector]:
        """Lower and upper corner of the box in which the tip may work, (3,) in the world, m."""
        return self._arm.workspace


class Live(_Held):
    """A scene in real time, on a simulated or a real arm (:func:`open`).

    The servo loop runs in C++ on a thread of its own; Python looks on and can end it. Use it in a
    ``with``: at the end of it, at the end of the program, on Ctrl-C and SIGTERM the arm gets zero
    force. After a fault, or when the arm was pulled, the force stays off; open it anew.
    """

    def __init__(self, run: _core.Run) -> None:
        self._run = run

    def __enter__(self) -> "Live":
        return self

    def __exit__(self, *_: object) -> None:
        self.stop()

    @property
    def running(self) -> bool:
        """Whether the servo loop runs."""
        return self._run.running

    @property
    def tick(self) -> Optional[Tick]:
        """The newest tick; None before the first. The loop does not wait for who looks."""
        latest = self._run.latest()
        return None if latest is None else Tick(latest)

    @property
    def topics(self) -> str:
        """What there is to say of the topics of ROS 2, a line each; "" if there are none."""
        return self._run.topics_report()

    def stop(self) -> None:
        """End the loop with zero force, if it runs, and wait for that. A recording is closed."""
        self._run.stop()

    def ticks(self) -> Ticks:
        """Give all ticks of a run that is over; Error while it goes on."""
        return Ticks(self._run.ticks())


_live: "weakref.WeakSet[Live]" = weakref.WeakSet()


def open(
    scene: Scene,
    device: str = "auto",
    *,
    set: Optional[Mapping[str, Any]] = None,
    agree: bool = False,
    unchecked: bool = False,
    seconds: Optional[float] = None,
    seed: Optional[int] = None,
    arm: Optional[PathOrName] = None,
    quality: str = "normal",
    record: Optional[PathOrName] = None,
    firmware: Optional[PathOrName] = None,
    homed: bool = False,
    no_real_time: bool = False,
    ros2: Union[None, bool, Mapping[str, Any]] = None,
) -> Live:
    """Touch a scene in real time, and begin at once. Other options as of :func:`run`.

    device: "sim" for the simulated arm, a name that :func:`devices` tells, or "auto" for the only arm
    that is plugged in (Error if there is none). agree: **a real arm moves by itself.**
    Keep clear of it, hold its grip, have its switch at hand, and say so with ``agree=True``. unchecked: a
    real arm that has not passed ``thimble feel-check`` gets at most 0.5 N; ``unchecked=True`` gives it
    its whole force all the same. A real arm brings its own arm file; what the scene or ``arm`` say of
    limits may only tighten them, and stderr says what became of it. firmware: image for an arm that
    needs one. homed: a real arm was in its home pose when it got power, so
    that only its workspace is checked before it gets a force. no_real_time: use a real arm though
    the loop gets no real-time priority. ros2: publish the run as topics of ROS 2 (package
    thimble-ros2): True, or what ``thimble run --ros2`` takes as a dict, ``{"namespace": "/phantom",
    "names": "omni", "domain": 5, "force": "add", "limit": 1, "stale_ms": 50, "frames":
    "world,tip"}``, each of them as you like. Raises Error with what to do.
    """
    if device not in ("sim", "auto") and not agree:  # what "auto" finds is asked about beneath
        raise Error(
            f"{device} would get forces. Keep clear of it, hold its grip, keep its switch at hand, and "
            "say agree=True."
        )
    held = _begin(
        scene,
        set=set,
        seconds=seconds,
        seed=seed,
        arm=arm,
        quality=quality,
        record=record,
        device=device,
        agreed=agree,
        unchecked=unchecked,
        real_time=True,
        firmware=firmware,
        homed=homed,
        no_real_time=no_real_time,
        ros2=dict(ros2) if isinstance(ros2, Mapping) else ros2,
    )
    live = Live(held)
    _live.add(live)
    _stop_on_signals()
    held.start()
    return live


def _stop_all() -> None:
    for live in list(_live):
        live.stop()


# Signals that would end Python at once and can be caught; SIGINT comes as KeyboardInterrupt.
_ENDING = ("TERM", "HUP", "QUIT", "USR1", "USR2", "ALRM", "VTALRM", "PROF", "XCPU", "IO", "PWR")


def _stop_on_signals() -> None:
    """Let each signal that would end Python at once leave by zero force first."""
    if threading.current_thread() is not threading.main_thread():
        return

    def leave(number: int, _: Any) -> None:
        _stop_all()
        signal.signal(number, signal.SIG_DFL)
        os.kill(os.getpid(), number)

    for name in _ENDING:
        number = getattr(signal, "SIG" + name, None)
        # Somebody else's stays: his way out runs what is at exit.
        if number is not None and signal.getsignal(number) is signal.SIG_DFL:
            signal.signal(number, leave)


atexit.register(_stop_all)


def _vector(name: str, value: ArrayLike, finite: bool = True) -> Vector:
    vector = np.asarray(value, dtype=np.float64)
    if vector.shape != (3,) or (finite and not np.isfinite(vector).all()):
        raise ValueError(f"{name}: expected three numbers, found {value!r}")
    return vector


def _program() -> str:
    """Find the program: $THIMBLE_PROGRAM, the one installed or built beside this package, or in $PATH."""
    named = os.environ.get("THIMBLE_PROGRAM")
    if named:
        return named
    for above in Path(__file__).resolve().parents:
        for beside in (above / "bin" / "thimble", above / "app" / "thimble"):
            if beside.is_file() and os.access(beside, os.X_OK):
                return str(beside)
    found = shutil.which("thimble")
    if found is None:
        raise Error("The program thimble was not found; install it, or name it in $THIMBLE_PROGRAM.")
    return found


_BAD_INPUT = 2  # the program's exit code of wrong arguments, scene, arm file or mesh


def _studies() -> list[str]:
    told = subprocess.run([_program(), "study", "--help"], capture_output=True, text=True, check=True).stdout
    return re.findall(r"^  ([a-z][a-z-]*) ", told.partition("Subcommands:")[2], re.MULTILINE)


def study(
    name: str, *arguments: PathOrName, out: Optional[PathOrName] = None, **options: Any
) -> list[Figure]:
    """Run a study (``thimble study --help`` lists them), and give its figures.

    It runs in a process of its own, as several count their own instructions or use all cores. Options
    are those of the command line: ``study("stability", arm="vintage_phantom", coarse=True)``,
    ``study("accuracy", axis=["velocity", "encoder"])``. out: folder for pictures, tables and
    figures.json; "study-NAME" if absent. Raises ArgumentError if there is no such study, or it cannot
    take an option; Error with what the program said if it fails.
    """
    names = _studies()
    if name not in names:
        raise ArgumentError(f'There is no study "{name}"; there are {", ".join(names)}.')
    folder = Path(out) if out is not None else Path(f"study-{name}")
    command = [_program(), "study", name, *map(os.fspath, arguments), "--out", str(folder)]
    for key, value in options.items():
        if value is None or value is False:
            continue
        command.append("--" + key.replace("_", "-"))
        if value is not True:
            several = isinstance(value, Sequence) and not isinstance(value, str)
            command += [str(one) for one in (value if several else [value])]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        said = (done.stderr.strip() or done.stdout.strip()).removesuffix("\nRun with --help for more information.")
        kind = ArgumentError if done.returncode == _BAD_INPUT else Error
        raise kind(f"thimble study {name}: {said}")
    return [_figure(one) for one in json.loads((folder / "figures.json").read_text())]
