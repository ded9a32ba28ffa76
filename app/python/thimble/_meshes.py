"""Meshes that runs of like scenes share."""

from __future__ import annotations

from typing import Any, Optional

from . import _core


class Meshes:
    """Meshes that runs share: read once, made ready to be touched once, and there once.

        meshes = thimble.Meshes()
        for stiffness in (100, 200, 400):
            thimble.run("elephant", set={"elephant.stiffness": stiffness}, meshes=meshes)

    One for each file, place, size and way to touch it; a file that has changed is read anew. What
    dents, flows or moves is each run's own, and every run is to the bit what it is without. It holds
    what it has until it is gone itself, or :meth:`drop_unused`. In another process, where it comes by
    pickle, it begins empty.
    """

    def __init__(self) -> None:
        self._meshes = _core.Meshes()

    def __len__(self) -> int:
        """How many meshes there are."""
        return self._meshes.meshes

    def drop_unused(self) -> None:
        """Let go of what no run uses now."""
        self._meshes.drop_unused()

    def __reduce__(self) -> tuple[Any, ...]:
        return Meshes, ()

    def __repr__(self) -> str:
        return f"Meshes({self._meshes.meshes} meshes, {self._meshes.surfaces} to be touched)"


def core_meshes(meshes: Optional[Meshes]) -> Optional[_core.Meshes]:
    """Give what the program shares; TypeError for what is no Meshes."""
    if meshes is None:
        return None
    if not isinstance(meshes, Meshes):
        raise TypeError(f"meshes: expected thimble.Meshes, found {meshes!r}.")
    return meshes._meshes
