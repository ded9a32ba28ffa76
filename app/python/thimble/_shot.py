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
    """A picture of a moment of a scene, as PNG; a notebook shows it by itself."""

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


class Touched(NamedTuple):
    """What a run was made of, as far as it can be drawn; `why_not` says why it cannot."""

    scene: str
    arm: Optional[PathOrName]
    seed: Optional[int]
    why_not: str

    def shot(self, **options: Any) -> Shot:
        """Draw it."""
        if self.why_not:
            raise Error(f"The run cannot be drawn: {self.why_not}; thimble.shot(SCENE) draws the scene without it.")
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
    show_arm: bool = True,
    caption: bool = True,
) -> Shot:
    """Draw a moment of a scene, touched by the simulated hand (``thimble shot``).

    scene, set, arm: as of :func:`run`. at: second to draw; when most is felt if absent. size: width and
    height in pixels. camera: yaw and pitch in degrees (about z from the user, above the horizon) and, if
    given, a factor by which it is closer. plots: force and depth over time below. Raises ArgumentError
    with what the program said of wrong ones, Error if the program cannot draw here.
    """
    width, height = (whole_of("size", one, 64, 8192) for one in _numbers("size", size, (2,)))
    command = ["--size", f"{width}x{height}"]
    if at is not None:
        command += ["--at", repr(number_of("at", at))]
    if arm is not None:
        command += ["--arm", path_of("arm", arm)]
    if camera is not None:
        command += ["--camera", *map(repr, _numbers("camera", camera, (2, 3)))]
    command += ["--plots"] * plots + ["--no-arm"] * (not show_arm) + ["--no-caption"] * (not caption)
    file = scene_file(scene, set, keep=False)
    with tempfile.TemporaryDirectory(prefix="thimble-shot-") as folder:
        picture = Path(folder, "shot.png")
        done = subprocess.run(
            [program(), "shot", file, "--out", str(picture), *command], capture_output=True, text=True, check=False
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
