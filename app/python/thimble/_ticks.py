"""Ticks of servo loops, as arrays."""

from __future__ import annotations

from typing import Any, Generic, Iterator, Mapping, NamedTuple, TypeVar, Union, overload

import numpy as np
from numpy.typing import NDArray

from . import _core, _show
from ._arguments import PathOrName, Vector, number_of, path_of, text_of_span
from ._compare import Comparison

Number = TypeVar("Number")  # float64 of one tick, or of all ticks
Single = TypeVar("Single")  # float32
Whole = TypeVar("Whole")


class Figure(NamedTuple):
    """One result of a run or a study. ``goal`` is a comparison (">= 20") or ""."""

    name: str
    value: float
    unit: str
    goal: str
    met: bool


def figure_of(one: Mapping[str, Any]) -> Figure:
    return Figure(one["name"], one["value"], one["unit"], one.get("goal", ""), one.get("met", True))


def units() -> dict[str, tuple[str, str]]:
    """Return unit and meaning of each column of :attr:`Ticks.columns`, by its name.

    The columns hold the values that the servo loop wrote. Times in them are whole nanoseconds.
    """
    return {name: (unit, about) for name, unit, about in _core.columns()}


class _Columns(Generic[Number, Single, Whole]):
    """The columns of ticks by readable names. All are views, except ``time``, which is a copy in s."""

    def __init__(self, columns: Any) -> None:
        self.columns = columns

    def _of(self, name: str) -> Any:
        return self.columns[name]

    @property
    def time(self) -> Number:
        """Start of the tick on the loop's clock, s."""
        return self._of("time") * 1e-9

    @property
    def tip(self) -> Vector:
        """Position of the tip in the world, p_WT, m, from the encoders."""
        return self._of("p_WT")

    @property
    def velocity(self) -> Vector:
        """Velocity of the tip in the world, v_WT, m/s, as the driver estimates it."""
        return self._of("v_WT")

    @property
    def force(self) -> Vector:
        """Force on the hand in the world that the safety gate sent to the motors, N."""
        return self._of("f_sent_W")

    @property
    def force_wanted(self) -> Vector:
        """Force on the hand in the world that the force law requested, N."""
        return self._of("f_wanted_W")

    @property
    def heat(self) -> Vector:
        """Heat of each motor. 1 is the limit of its winding; 0 if the arm file does not have it."""
        return self._of("heat")

    @property
    def proxy(self) -> Vector:
        """Position of the proxy in the world, p_WP, m. Valid only in contact."""
        return self._of("p_WP")

    @property
    def normal(self) -> Vector:
        """Outward unit normal of the force in the world; 0 without contact."""
        return self._of("n_W")

    @property
    def depth(self) -> Number:
        """Depth of the tip below the surface, m; 0 without contact."""
        return self._of("depth")

    @property
    def joints(self) -> Vector:
        """Joint angles, rad. The geometry of the arm defines zero and sign."""
        return self._of("q")

    @property
    def orientation(self) -> NDArray[np.float32]:
        """Rotation of the stylus in the world, quaternion w, x, y, z; zeros if the arm does not measure it."""
        return self._of("q_WT")

    @property
    def gimbal(self) -> NDArray[np.float32]:
        """Angles of the gimbal's axes, rad; zeros if the arm has none."""
        return self._of("gimbal")

    @property
    def gripper(self) -> Single:
        """Opening of the gripper, m; 0 if it is closed or absent (``columns["has_gripper"]``)."""
        return self._of("gripper")

    @property
    def object(self) -> Whole:
        """Number of the touched object, from 0 in the order of the scene; -1 for none."""
        return self._of("object")


class Tick(_Columns[np.float64, np.float32, np.integer[Any]]):
    """One tick of the servo loop: numbers, and arrays of shape (3,). ``columns`` has all values of the tick."""

    @property
    def in_contact(self) -> bool:
        """Whether the tip touches an object."""
        return bool(self._of("in_contact"))

    @property
    def buttons(self) -> int:
        """Buttons of the arm, one bit each; bit 0 is the first button."""
        return int(self._of("buttons"))

    @property
    def fault(self) -> str:
        """Short name of the fault that switched the force off ("over_speed"); "" without a fault."""
        number = int(self._of("fault"))
        return _core.fault(number)[0] if number else ""

    def __repr__(self) -> str:
        return (
            f"Tick({self.time:.4f} s, tip {np.round(self.tip, 5)} m, force {np.round(self.force, 3)} N"
            f"{', ' + self.fault if self.fault else ''})"
        )


class Ticks(_Columns[NDArray[np.float64], NDArray[np.float32], NDArray[np.integer[Any]]]):
    """n ticks of a servo loop, as arrays of shape (n,) and (n, 3).

    ``columns`` is a structured array of all values, by the names of a recording's columns (:func:`units`
    describes them). The properties are views of it.
    """

    @property
    def in_contact(self) -> NDArray[np.bool_]:
        """Whether the tip touched an object, (n,)."""
        return self._of("in_contact").view(np.bool_)

    def __len__(self) -> int:
        return len(self.columns)

    @overload
    def __getitem__(self, index: int) -> Tick: ...

    @overload
    def __getitem__(self, index: Union[slice, NDArray[Any]]) -> "Ticks": ...

    def __getitem__(self, index: Any) -> Any:
        """Return one tick, or several for a slice, an array of indices or a mask: ``run[run.in_contact]``."""
        columns = self.columns[index]
        return Tick(columns) if isinstance(columns, np.void) else Ticks(columns)

    def __iter__(self) -> Iterator[Tick]:
        return map(Tick, self.columns)

    def to_pandas(self) -> Any:
        """Return all columns as a pandas DataFrame over the time in s.

        Vectors become ``p_WT_x``, ``p_WT_y``, ``p_WT_z``. Columns of joints, motors and the gimbal are
        numbered from 0 (``q_0``, ``counts_0``, ``heat_0``), as is the quaternion ``q_WT``. The units are
        those of :func:`units`. Raises ImportError without pandas.
        """
        return _show.to_pandas(self)

    def plot(self) -> Any:
        """Draw force and depth over time, and return the figure. Raises ImportError without matplotlib."""
        return _show.plot(self, self._title())

    def compare(self, other: "Ticks", *, shift: float = 0.0) -> Comparison:
        """Return the differences to another run or recording, which is interpolated at the times of this one.

            print(soft.compare(stiff))                      # largest difference of tip, force, depth ...
            soft.compare(stiff)["force"].max                # N

        shift: seconds by which the other is later.
        """
        if not isinstance(other, Ticks):
            raise TypeError(f"other: expected a run, a recording or ticks, found {other!r}.")
        return Comparison(self, other, (self._title(), other._title()), number_of("shift", shift))

    def __repr__(self) -> str:
        return f"{type(self).__name__}({self._contents()})"

    def _title(self) -> str:
        return "ticks"

    def _contents(self) -> str:
        """Return number, times and largest values of the ticks."""
        if not len(self):
            return "0 ticks"
        force = float(np.linalg.norm(self.force, axis=1).max())
        return (
            f"{len(self)} ticks, {text_of_span(self.time[0], self.time[-1])}, force up to {force:.3g} N, "
            f"depth up to {1e3 * float(self.depth.max()):.3g} mm, in contact {100 * float(self.in_contact.mean()):.0f} %"
        )

    def _figures(self) -> list[Figure]:
        return []

    def _repr_html_(self) -> str:
        return _show.html(self._title(), self, self._figures())


class Recording(Ticks):
    """A recording that was read from a file (:func:`read_recording`).

    ``info`` describes the run (scene, scene_text, arm, device, clock, program, rate [Hz], seed ...).
    ``complete`` is False if a crash or a full disk truncated the recording.
    """

    def __init__(self, info: Mapping[str, Any], columns: Any, complete: bool) -> None:
        super().__init__(columns)
        self.info = dict(info)
        self.complete = complete

    def _title(self) -> str:
        return f"{self.info['scene']}, {self.info['arm']}"

    def __repr__(self) -> str:
        return f"Recording({self._title()}: {self._contents()}{'' if self.complete else ', incomplete'})"


def read_recording(path: PathOrName) -> Recording:
    """Read a recording (HDF5) of ``thimble run SCENE --record FILE`` or of ``record=`` in this package."""
    return Recording(*_core.read_recording(path_of("path", path)))
