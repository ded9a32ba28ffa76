"""Differences between two runs, recordings or other ticks, on the times of the first."""

from __future__ import annotations

from html import escape
from typing import TYPE_CHECKING, Any, NamedTuple, Optional

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from ._ticks import Ticks

# Compared values: property of Ticks, unit.
_COMPARED = (
    ("tip", "m"),
    ("velocity", "m/s"),
    ("force", "N"),
    ("force_wanted", "N"),
    ("depth", "m"),
    ("joints", "rad"),
)


class Difference(NamedTuple):
    """Difference of one value between two runs. Vectors are compared by the length of their difference."""

    name: str
    max: float
    """Largest difference, in `unit`."""
    rms: float
    """Root of the mean square, in `unit`."""
    at: float
    """Time of the largest difference, s."""
    unit: str


class Comparison:
    """Differences between two runs (:meth:`Ticks.compare`).

    The second run is interpolated linearly at the times of the first, where both have ticks. The differences are
    iterable, and available by name: ``comparison["force"].max``. A notebook shows them as a table.
    """

    def __init__(self, one: Ticks, other: Ticks, names: tuple[str, str], shift: float = 0.0) -> None:
        self.names = names
        """Names of the two runs."""
        self.bit_identical: bool = shift == 0.0 and one.columns.dtype == other.columns.dtype and (
            one.columns.tobytes() == other.columns.tobytes()
        )
        """Whether all columns of all ticks are bit-identical."""
        time, its_time = one.time, other.time + shift
        if len(time) and len(its_time):
            within = (time >= its_time[0]) & (time <= its_time[-1])
        else:
            within = np.zeros(len(time), np.bool_)
        self.ticks: int = int(within.sum())
        """Number of ticks of the first run that are compared."""
        self.time: NDArray[np.float64] = time[within]
        """Times of the compared ticks, s."""
        self._series: dict[str, NDArray[np.float64]] = {}
        self._differences: dict[str, Difference] = {}
        earlier = np.searchsorted(its_time, self.time, "right") - 1  # last tick at or before each time
        for name, unit in _COMPARED:
            mine = getattr(one, name)[within]
            its = _interpolated(its_time, getattr(other, name), self.time, earlier)
            apart = np.abs(mine - its) if mine.ndim == 1 else np.linalg.norm(mine - its, axis=1)
            self._series[name] = apart
            largest = int(apart.argmax()) if len(apart) else -1
            self._differences[name] = Difference(
                name,
                float(apart[largest]) if len(apart) else 0.0,
                float(np.sqrt(np.mean(apart**2))) if len(apart) else 0.0,
                float(self.time[largest]) if len(apart) else 0.0,
                unit,
            )
        contact = one.in_contact[within] == other.in_contact[earlier]
        self.contact_agreement: float = float(contact.mean()) if len(contact) else 1.0
        """Share of the compared ticks in which both or neither were in contact."""
        apart_at = [np.flatnonzero(one) for one in (*self._series.values(), ~contact)]
        first = min((int(one[0]) for one in apart_at if len(one)), default=None)
        self.first_difference: Optional[float] = None if first is None else float(self.time[first])
        """Time of the first tick with a difference, s; None if there is none."""

    def __getitem__(self, name: str) -> Difference:
        if name not in self._differences:
            raise KeyError(f"{name}: expected one of {', '.join(self._differences)}.")
        return self._differences[name]

    def __iter__(self) -> Any:
        return iter(self._differences.values())

    def __len__(self) -> int:
        return len(self._differences)

    def series(self, name: str) -> NDArray[np.float64]:
        """Return the difference of a value at each of :attr:`time`, (ticks,)."""
        self[name]
        return self._series[name]

    def _summary(self) -> str:
        what = f"{self.names[0]} and {self.names[1]}: {self.ticks} ticks compared"
        if self.bit_identical:
            return f"{what}, bit-identical"
        if self.first_difference is None:
            return f"{what}, no difference"
        return (
            f"{what}, first difference at {self.first_difference:.3f} s, "
            f"contact agrees in {100 * self.contact_agreement:.1f} %"
        )

    def __repr__(self) -> str:
        rows = [f"{one.name:<13} max {one.max:10.4g} {one.unit:<4} at {one.at:7.3f} s   rms {one.rms:10.4g} {one.unit}" for one in self]
        return "\n".join([self._summary(), *(rows if not self.bit_identical else [])])

    def _repr_html_(self) -> str:
        rows = "".join(
            f"<tr><td>{escape(one.name)}</td><td>{one.max:.4g}</td><td>{one.at:.3f} s</td><td>{one.rms:.4g}</td>"
            f"<td>{escape(one.unit)}</td></tr>"
            for one in self
        )
        return (
            f"<div>{escape(self._summary())}<table><tr><th>value</th><th>largest difference</th><th>at</th>"
            f"<th>rms</th><th>unit</th></tr>{rows}</table></div>"
        )


def _interpolated(time: Any, values: Any, at: Any, earlier: Any) -> Any:
    """Return values at other times, linear between ticks, and exactly the value of a tick at its time."""
    if not len(at):
        return values[:0]
    later = np.minimum(earlier + 1, len(time) - 1)
    span = time[later] - time[earlier]
    with np.errstate(invalid="ignore", divide="ignore"):
        share = np.where(span > 0.0, (at - time[earlier]) / span, 0.0)
    if values.ndim == 2:
        share = share[:, np.newaxis]
    return np.where(share == 0.0, values[earlier], (1.0 - share) * values[earlier] + share * values[later])
