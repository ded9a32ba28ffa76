"""Pictures of scenes, as `thimble shot` draws them."""

from __future__ import annotations

import subprocess
import tempfile
from pathlib import Path
from typing import Any, Mapping, NamedTuple, Optional, Sequence

from ._arguments import PathOrName, number_of, path_of, whole_of
from ._core import ArgumentError, Error
from ._scene_text import Scene, scene_file
from ._study import BAD_INPUT, program


class Shot:
    """A picture of a moment of a scene, as PNG. A notebook displays it."""

    def __init__(self, png: bytes) -> None:
        self.png = png

    def save(self, path: PathOrName) -> None:
        """Write it as a PNG file."""
        Path(path).write_bytes(self.png)

    def _repr_png_(self) -> bytes:
        return self.png

    def __repr__(self) -> str:
        width, height = (int.from_bytes(self.png[at : at + 4], "big") for at in (16, 20))
        return f"Shot({width} x {height} pixels)"


class ShotSource(NamedTuple):
    """Scene, arm and seed of a run, to draw it. `why_not`: why it cannot be drawn, or ""."""

    scene: str
    arm: Optional[PathOrName]
    seed: Optional[int]
    why_not: str

    def shot(self, **options: Any) -> Shot:
        """Draw a moment of the run."""
        if self.why_not:
            raise Error(f"The run cannot be drawn: {self.why_not}. Draw the scene without it: thimble.shot(SCENE).")
        changes = None if self.seed is None else {"seed": self.seed}
        return shot(self.scene, set=changes, arm=self.arm, **options)


def shot(
    scene: Scene,
    *,
    set: Optional[Mapping[str, Any]] = None,
    at: Optional[float] = None,
    arm: Optional[PathOrName] = None,
    size: Sequence[int] = (960, 640),
    camera: Optional[Sequence[float]] = None,
    plots: bool = False,
    collision: bool = False,
    show_arm: bool = True,
    caption: bool = True,
) -> Shot:
    """Draw a moment of a scene, touched by the simulated hand (``thimble shot``).

    scene, set, arm: as in :func:`run`. at: time to draw, s; by default the moment of the largest force.
    size: width and height, pixels. camera: yaw (about z, from the user) and pitch (above the horizon),
    degrees; a third number is the factor by which the camera is closer. plots: also draw force and depth
    over time, below the picture. collision: also show the shapes with which bodies meet. Raises ArgumentError
    for wrong arguments, Error if the program cannot draw on this computer; both have the message of the program.
    """
    width, height = (whole_of("size", one, 64, 8192) for one in _numbers("size", size, (2,)))
    command = ["--size", f"{width}x{height}"]
    if at is not None:
        command += ["--at", repr(number_of("at", at))]
    if arm is not None:
        command += ["--arm", path_of("arm", arm)]
    if camera is not None:
        command += ["--camera", *map(repr, _numbers("camera", camera, (2, 3)))]
    command += ["--plots"] * plots + ["--collision"] * collision
    command += ["--no-arm"] * (not show_arm) + ["--no-caption"] * (not caption)
    file = scene_file(scene, set, keep=False)
    with tempfile.TemporaryDirectory(prefix="thimble-shot-") as folder:
        picture = Path(folder, "shot.png")
        done = subprocess.run(
            [program(), "shot", file, "--output", str(picture), *command], capture_output=True, text=True, check=False
        )
        if done.returncode != 0:
            kind = ArgumentError if done.returncode == BAD_INPUT else Error
            raise kind(f"thimble shot: {done.stderr.strip() or done.stdout.strip()}")
        return Shot(picture.read_bytes())


def _numbers(name: str, values: Sequence[float], counts: Sequence[int]) -> list[float]:
    try:
        numbers = [number_of(name, one) for one in values]
    except TypeError:
        numbers = []
    if len(numbers) not in counts:
        raise ArgumentError(f"{name}: expected {' or '.join(map(str, counts))} numbers, found {values!r}.")
    return numbers
