"""What servo loops did, as arrays."""

from __future__ import annotations

from typing import Any, Iterator, Mapping, NamedTuple, Union, overload

import numpy as np
from numpy.typing import NDArray

from . import _core, _show
from ._arguments import PathOrName, path_of


class Figure(NamedTuple):
    """One number that a run or a study stands for; ``goal`` is a comparison (">= 20") or ""."""

    name: str
    value: float
    unit: str
    goal: str
    met: bool


def figure_of(one: Mapping[str, Any]) -> Figure:
    return Figure(one["name"], one["value"], one["unit"], one.get("goal", ""), one.get("met", True))


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

        Vectors become ``p_WT_x``, ``p_WT_y``, ``p_WT_z``; columns of joints, motors and the gimbal are
        numbered from 0 (``q_0``, ``counts_0``, ``heat_0``), and so is the quaternion ``q_WT``. Units as
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
    return Recording(*_core.read_recording(path_of("path", path)))
