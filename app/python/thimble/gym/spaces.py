"""Spaces and base classes of Gymnasium if it is installed, otherwise small replacements.

The replacements have the members of a space that agents use: shape, dtype, low, high, contains, sample.
"""

from __future__ import annotations

from typing import Any, Optional, Sequence, Union

import numpy as np
from numpy.typing import NDArray

from .. import ArgumentError

try:
    import gymnasium
    from gymnasium.spaces import Box
    from gymnasium.vector import VectorEnv as VectorBase

    Base: Any = gymnasium.Env
    # Autoreset mode of vector environments; older versions of Gymnasium do not have it.
    NEXT_STEP: Any = getattr(getattr(gymnasium.vector, "AutoresetMode", None), "NEXT_STEP", "NextStep")
except ImportError:
    NEXT_STEP = "NextStep"

    class Box:  # type: ignore[no-redef]
        """The space of arrays between two bounds, bounds included."""

        def __init__(self, low: Any, high: Any, dtype: Any = np.float64) -> None:
            self.dtype = np.dtype(dtype)
            self.low = np.array(low, dtype=self.dtype)
            self.high = np.array(high, dtype=self.dtype)
            self.shape = self.low.shape
            self._random = np.random.default_rng()

        def seed(self, seed: Optional[int] = None) -> None:
            """Seed the generator of :meth:`sample`."""
            self._random = np.random.default_rng(seed)

        def sample(self) -> NDArray[Any]:
            """Draw an array: uniform between finite bounds, otherwise normal about the finite bound or 0."""
            low, high = np.isfinite(self.low), np.isfinite(self.high)
            even = self._random.random(self.shape)
            normal = self._random.normal(size=self.shape)
            with np.errstate(invalid="ignore"):
                inside = self.low + even * (self.high - self.low)
                from_one = np.where(low, self.low + np.abs(normal), np.where(high, self.high - np.abs(normal), normal))
            return np.where(low & high, inside, from_one).astype(self.dtype)

        def contains(self, x: Any) -> bool:
            """Return whether an array is in the space."""
            x = np.asarray(x)
            return x.shape == self.shape and bool((x >= self.low).all() and (x <= self.high).all())

        __contains__ = contains

        def __repr__(self) -> str:
            return f"Box({self.low.min()}, {self.high.max()}, {self.shape}, {self.dtype})"

    class Base:  # type: ignore[no-redef]
        """Replacement of gymnasium.Env: random generator, ``unwrapped``, ``with`` blocks."""

        metadata: dict[str, Any] = {}
        render_mode: Optional[str] = None
        spec: Any = None
        _np_random: Optional[np.random.Generator] = None

        @property
        def unwrapped(self) -> Any:
            """This environment."""
            return self

        @property
        def np_random(self) -> np.random.Generator:
            """Random generator of the environment, seeded by ``reset(seed=)`` or by the system."""
            if self._np_random is None:
                self._np_random = np.random.default_rng()
            return self._np_random

        def reset(self, *, seed: Optional[int] = None, options: Optional[dict[str, Any]] = None) -> Any:
            """Seed the generator if a seed is given."""
            if seed is not None:
                self._np_random = np.random.default_rng(seed)

        def close(self) -> None:
            """Release the resources of the environment."""

        def __enter__(self) -> Any:
            return self

        def __exit__(self, *_: object) -> None:
            self.close()

    VectorBase = Base  # type: ignore[misc,assignment]


def batched(space: Any, count: int) -> Any:
    """Return the space of `count` stacked elements of a box."""
    low = np.repeat(space.low[np.newaxis], count, axis=0)
    high = np.repeat(space.high[np.newaxis], count, axis=0)
    return Box(low, high, dtype=space.dtype)


def seeds_of(seed: Union[None, int, Sequence[Optional[int]]], count: int) -> list[Optional[int]]:
    """Return a seed for each of `count` environments. One number s gives s, s + 1, s + 2 and so on."""
    if seed is None or isinstance(seed, (int, np.integer)):
        return [None if seed is None else int(seed) + i for i in range(count)]
    seeds = list(seed)
    if len(seeds) != count:
        raise ArgumentError(f"seed: expected {count} seeds, found {len(seeds)}.")
    return seeds
