"""Knobs: settings of a scene that can be changed during the run."""

from __future__ import annotations

import re
from html import escape
from typing import Any, Iterator, NamedTuple

from . import _core
from ._arguments import number_of, warn_renamed
from ._core import ArgumentError


class Knob(NamedTuple):
    """A setting that can be changed: name, unit (SI), bounds and present value."""

    name: str
    unit: str
    min: float
    max: float
    value: float

    @property
    def least(self) -> float:
        """Former name of `min`; deprecated."""
        warn_renamed("Knob.least", "Knob.min")
        return self.min

    @property
    def most(self) -> float:
        """Former name of `max`; deprecated."""
        warn_renamed("Knob.most", "Knob.max")
        return self.max


class Knobs:
    """The settings of a scene that can be changed during the run, by name.

        live.knobs["ball: stiffness"] = 300         # N/m; or live.knobs.ball_stiffness = 300
        live.knobs["ball: stiffness"].value         # present value
        print(live.knobs)                           # names, values, bounds, units

    A change starts at the next tick and is smooth, in virtual time and on a real arm, so that the hand
    feels no step of force. From one bound to the other it takes at least 50 ms; in contact it changes
    the force by at most 40 N/s. The same change at the same tick is bit-identical. An unknown name or a
    value outside the bounds raises an ArgumentError that lists the names or bounds, and changes nothing.
    Scenes with several arms have no knobs.
    """

    _run: _core.Run

    def __init__(self, run: _core.Run) -> None:
        object.__setattr__(self, "_run", run)

    def __getitem__(self, name: str) -> Knob:
        for knob in self.values():
            if knob.name == name:
                return knob
        raise ArgumentError(f"The run has no knob {name!r}; it has {self._names()}.")

    def __setitem__(self, name: str, value: float) -> None:
        if name not in self:
            self[name]  # its error lists the known names
        self._run.turn(name, number_of(name, value))

    def __getattr__(self, attribute: str) -> Knob:
        name = self._by_attribute(attribute)
        if name is None:
            raise AttributeError(f"The run has no knob {attribute!r}; it has {', '.join(self._attributes())}.")
        return self[name]

    def __setattr__(self, attribute: str, value: float) -> None:
        name = self._by_attribute(attribute)
        if name is None:
            raise AttributeError(f"The run has no knob {attribute!r}; it has {', '.join(self._attributes())}.")
        self[name] = value

    def __iter__(self) -> Iterator[str]:
        return iter([knob.name for knob in self.values()])

    def __len__(self) -> int:
        return len(self.values())

    def __contains__(self, name: object) -> bool:
        return any(knob.name == name for knob in self.values())

    def keys(self) -> list[str]:
        """Return the names, in the order of the scene's objects."""
        return list(self)

    def values(self) -> list[Knob]:
        """Return the knobs with their present values."""
        return [Knob(*one) for one in self._run.knobs()]

    def items(self) -> list[tuple[str, Knob]]:
        """Return pairs of name and knob."""
        return [(knob.name, knob) for knob in self.values()]

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self._attributes()]

    def __repr__(self) -> str:
        if not len(self):
            return "no knobs"
        width = max(map(len, self))
        return "\n".join(
            f"{knob.name:<{width}}  {knob.value:g} {knob.unit} ({knob.min:g} to {knob.max:g})"
            for knob in self.values()
        )

    def _repr_html_(self) -> str:
        rows = "".join(
            f"<tr><td>{escape(knob.name)}</td><td>{knob.value:g}</td><td>{knob.min:g} to {knob.max:g}</td>"
            f"<td>{escape(knob.unit)}</td></tr>"
            for knob in self.values()
        )
        return f"<table><tr><th>knob</th><th>value</th><th>bounds</th><th>unit</th></tr>{rows}</table>"

    def _attributes(self) -> dict[str, str]:
        return {re.sub(r"\W+", "_", name).strip("_"): name for name in self}

    def _by_attribute(self, attribute: str) -> Any:
        return None if attribute.startswith("_") else self._attributes().get(attribute)

    def _names(self) -> str:
        return ", ".join(self) or "none"
