"""Pictures of a moment of a run: its present meshes, the tip, the proxy and the force on the hand."""

from __future__ import annotations

from typing import Any, Mapping, Optional

import numpy as np
from numpy.typing import NDArray

from .. import Tick
from .raster import Camera, Layer

Vector = NDArray[np.float64]


def _colour(hexadecimal: int) -> Vector:
    return np.array([hexadecimal >> 16, hexadecimal >> 8 & 255, hexadecimal & 255], np.float64)


# The colours of the viewer: objects in the order of the scene, tip, proxy, force.
_OBJECTS = [_colour(one) for one in (0x8FB3D1, 0xE0B88A, 0x96C3AC, 0xC7A5C4, 0xB9BFC7, 0xD9CF9A)]
_TIP, _PROXY, _FORCE = _colour(0x0B3C5D), _colour(0xF5B700), _colour(0xD55E00)

_YAW, _PITCH = np.radians(20.0), np.radians(28.0)  # from the user's side, a little from the right [chosen]
_SAMPLING = 2  # samples per pixel and direction: smooth edges [chosen]
# Sizes relative to the distance of the camera [chosen: seen, but smaller than most objects]; opacity behind a surface
_TIP_RADIUS, _ARROW_RADIUS, _ARROW_PER_NEWTON, _THROUGH = 0.010, 0.0035, 0.06, 0.45
_BRIGHT = 0.75  # light on shaded sides of marks: they keep their colours [chosen]


class Picture:
    """Draws moments of one scene with one camera, which the first moment sets."""

    def __init__(self, width: int, height: int) -> None:
        self._size = width * _SAMPLING, height * _SAMPLING
        self._camera: Optional[Camera] = None
        self._distance = 0.0
        self._still: dict[str, Any] = {}
        self._layer: Optional[Layer] = None
        self._moving: set[str] = set()

    def draw(self, meshes: Mapping[str, tuple[Vector, NDArray[np.int32]]], tick: Tick) -> NDArray[np.uint8]:
        """Return a picture (height, width, 3) of the present meshes (vertices, triangles) and a tick."""
        if self._camera is None:
            self._aim(meshes, tick.tip)
        changed = {
            name for name, (vertices, _) in meshes.items()
            if name in self._still and not np.array_equal(vertices, self._still[name])
        }
        if self._layer is None or set(meshes) != set(self._still) or not changed <= self._moving:
            self._moving |= changed
            self._draw_still(meshes)
        assert self._camera is not None and self._layer is not None
        layer = self._layer.copy()
        for number, (name, (vertices, triangles)) in enumerate(meshes.items()):
            if name in self._moving:
                layer.draw(vertices, triangles, _OBJECTS[number % len(_OBJECTS)])
        self._draw_touch(layer, tick)
        return layer.pixels(_SAMPLING)

    def _aim(self, meshes: Mapping[str, Any], tip: Vector) -> None:
        points = np.concatenate([tip[np.newaxis], *(vertices for vertices, _ in meshes.values())])
        middle = 0.5 * (points.min(axis=0) + points.max(axis=0))
        radius = max(float(np.linalg.norm(points - middle, axis=1).max()), 1e-3)
        self._distance = 2.9 * radius  # a sphere of this radius fills 45 degrees at 2.6 [chosen: a margin of a tenth]
        self._camera = Camera(middle, _YAW, _PITCH, self._distance, *self._size)

    def _draw_still(self, meshes: Mapping[str, Any]) -> None:
        assert self._camera is not None
        self._layer = Layer(*self._size, self._camera)
        self._still = {name: vertices for name, (vertices, _) in meshes.items()}
        for number, (name, (vertices, triangles)) in enumerate(meshes.items()):
            if name not in self._moving:
                self._layer.draw(vertices, triangles, _OBJECTS[number % len(_OBJECTS)])

    def _draw_touch(self, layer: Layer, tick: Tick) -> None:
        size = self._distance
        if tick.in_contact:
            layer.draw(*_ball(tick.proxy, 0.8 * _TIP_RADIUS * size), _PROXY, _THROUGH, _BRIGHT)
        layer.draw(*_ball(tick.tip, _TIP_RADIUS * size), _TIP, _THROUGH, _BRIGHT)
        strength = float(np.linalg.norm(tick.force))
        if strength > 1e-3:  # N [chosen: shorter than the tip's ball]
            begin = tick.proxy if tick.in_contact else tick.tip
            length = _ARROW_PER_NEWTON * size * strength
            layer.draw(*_arrow(begin, tick.force / strength, length, _ARROW_RADIUS * size), _FORCE, _THROUGH, _BRIGHT)


def _ball(centre: Vector, radius: float) -> tuple[Vector, Any]:
    return centre + radius * _UNIT_BALL[0], _UNIT_BALL[1]


def _arrow(begin: Vector, way: Vector, length: float, radius: float) -> tuple[Vector, Any]:
    """Return a rod with a cone at its end, both of 12 sides."""
    aside = np.cross(way, [0.0, 0.0, 1.0] if abs(way[2]) < 0.9 else [1.0, 0.0, 0.0])
    aside /= np.linalg.norm(aside)
    head = min(0.5 * length, 6.0 * radius)
    frame = np.stack([aside, np.cross(way, aside), way])
    radii, heights = _ARROW[0] * radius, np.array([0.0, length - head, length - head, length])
    points = [np.column_stack([r * _CIRCLE, np.full(len(_CIRCLE), z)]) for r, z in zip(radii, heights)]
    return begin + np.concatenate(points) @ frame, _ARROW[1]


def _rings(counts: int, sides: int) -> NDArray[np.int32]:
    """Return the triangles between consecutive rings of points."""
    triangles = []
    for ring in range(counts - 1):
        for k in range(sides):
            a, b = ring * sides + k, ring * sides + (k + 1) % sides
            triangles += [(a, b, a + sides), (b, b + sides, a + sides)]
    return np.array(triangles, np.int32)


def _unit_ball(rings: int, sides: int) -> tuple[Vector, NDArray[np.int32]]:
    around, up = np.meshgrid(np.arange(sides) * 2 * np.pi / sides, np.linspace(-0.5, 0.5, rings) * np.pi)
    points = np.stack([np.cos(up) * np.cos(around), np.cos(up) * np.sin(around), np.sin(up)], axis=-1)
    return points.reshape(-1, 3), _rings(rings, sides)


_UNIT_BALL = _unit_ball(9, 16)
_CIRCLE = np.column_stack([np.cos(np.arange(12) * np.pi / 6), np.sin(np.arange(12) * np.pi / 6)])
_ARROW = np.array([1.0, 1.0, 2.4, 1e-3]), _rings(4, 12)
