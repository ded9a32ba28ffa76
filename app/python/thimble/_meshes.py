"""Meshes that several runs share."""

from __future__ import annotations

from typing import Any, Optional

from . import _core


class Meshes:
    """Meshes that several runs share: each is read, prepared and stored once.

        meshes = thimble.Meshes()
        for stiffness in (100, 200, 400):
            thimble.run("elephant", set={"elephant.stiffness": stiffness}, meshes=meshes)

    There is one mesh for each combination of file, pose, size and tracker. A file that has changed is
    read again. Objects that dent, flow or move are separate for each run, and every run is bit-identical
    to a run without sharing. The meshes are kept as long as this object, or until :meth:`drop_unused`.
    A pickled object is empty in the other process.
    """

    def __init__(self) -> None:
        self._meshes = _core.Meshes()

    def __len__(self) -> int:
        """Return the number of meshes."""
        return self._meshes.meshes

    def drop_unused(self) -> None:
        """Release the meshes that no run uses now."""
        self._meshes.drop_unused()

    def __reduce__(self) -> tuple[Any, ...]:
        return Meshes, ()

    def __repr__(self) -> str:
        return f"Meshes({self._meshes.meshes} meshes, {self._meshes.surfaces} prepared for contact)"


def core_meshes(meshes: Optional[Meshes]) -> Optional[_core.Meshes]:
    """Return the ``_core`` object of a Meshes. Raises TypeError for any other type."""
    if meshes is None:
        return None
    if not isinstance(meshes, Meshes):
        raise TypeError(f"meshes: expected thimble.Meshes, found {meshes!r}.")
    return meshes._meshes
