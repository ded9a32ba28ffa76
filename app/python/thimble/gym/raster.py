"""Draws shaded triangles into arrays with numpy: a picture without OpenGL, a display or other packages."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Vector = NDArray[np.float64]

# Pixels that are tested at once, about 100 MB of temporary arrays. [chosen]
_MAX_CANDIDATES = 1_000_000
# Corners are shaded smoothly if the faces around them are within 37 degrees of their mean. [chosen: facets of
# round shapes are below it, edges of boxes (55 degrees) above]
_SMOOTH = 0.8
AMBIENT = 0.45  # light without a direction, of 1 in all [chosen: shapes are read, shaded sides keep their colour]


class Camera:
    """A perspective camera: a point to look at, yaw about z and pitch above the horizon (rad), distance (m)."""

    def __init__(self, target: Vector, yaw: float, pitch: float, distance: float, width: int, height: int) -> None:
        away = np.array([np.cos(pitch) * np.cos(yaw), np.cos(pitch) * np.sin(yaw), np.sin(pitch)])
        right = np.array([-np.sin(yaw), np.cos(yaw), 0.0])
        self.axes = np.stack([right, np.cross(away, right), away])
        self.eye = target + distance * away
        self.near = 0.02 * distance
        self.scale = 1.2 * min(width / 1.2, height)  # focal length, pixels: 45 degrees of height [chosen]
        self.centre = np.array([0.5 * width, 0.5 * height])
        light = np.array([0.45, 0.75, 1.0]) @ self.axes  # from above the right shoulder of the user [chosen]
        self.light = light / np.linalg.norm(light)

    def project(self, points: Vector) -> Vector:
        """Return pixel x, pixel y and inverse distance, (n, 3). Points behind the camera have inverse 0."""
        seen = (points - self.eye) @ self.axes.T
        depth = -seen[:, 2]
        inverse = np.where(depth > self.near, 1.0 / np.maximum(depth, self.near), 0.0)
        return np.column_stack([
            self.centre[0] + self.scale * seen[:, 0] * inverse,
            self.centre[1] - self.scale * seen[:, 1] * inverse,
            inverse,
        ])


def corner_light(vertices: Vector, triangles: Any, camera: Camera, ambient: float) -> Vector:
    """Return the brightness of each corner of each triangle, (t, 3)."""
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    faces = np.cross(b - a, c - a)
    summed = np.zeros_like(vertices)
    for k in range(3):
        for axis in range(3):
            summed[:, axis] += np.bincount(triangles[:, k], faces[:, axis], len(vertices))
    faces /= np.maximum(np.linalg.norm(faces, axis=1, keepdims=True), 1e-30)
    summed /= np.maximum(np.linalg.norm(summed, axis=1, keepdims=True), 1e-30)
    corners = summed[triangles]
    smooth = np.einsum("tki,ti->tk", corners, faces) > _SMOOTH
    normals = np.where(smooth[..., np.newaxis], corners, faces[:, np.newaxis])
    towards = np.einsum("ti,ti->t", faces, camera.eye - a) < 0.0  # seen from behind: an open mesh
    normals[towards] *= -1.0
    return ambient + (1.0 - ambient) * np.clip(normals @ camera.light, 0.0, 1.0)


class Layer:
    """A picture with the inverse distance of each pixel, in rows from the top."""

    def __init__(self, width: int, height: int, camera: Camera) -> None:
        self.width, self.height, self.camera = width, height, camera
        rows = np.linspace(0.0, 1.0, height)[:, np.newaxis]
        background = (1.0 - rows) * np.array([251, 252, 253.0]) + rows * np.array([222, 227, 232.0])
        self.colours = np.repeat(background[:, np.newaxis].astype(np.float32), width, axis=1).reshape(-1, 3)
        self.inverse = np.zeros(width * height, np.float32)

    def copy(self) -> "Layer":
        """Return a copy to draw on."""
        other = object.__new__(Layer)
        other.width, other.height, other.camera = self.width, self.height, self.camera
        other.colours, other.inverse = self.colours.copy(), self.inverse.copy()
        return other

    def draw(
        self, vertices: Vector, triangles: Any, colour: Vector, through: float = 0.0, ambient: float = AMBIENT
    ) -> None:
        """Draw a mesh. through: opacity of its parts behind what was drawn before. ambient: light on shaded sides."""
        triangles = np.asarray(triangles)
        if not len(triangles):
            return
        points = self.camera.project(vertices)[triangles]
        light = corner_light(vertices, triangles, self.camera, ambient)
        in_front = (points[..., 2] > 0.0).all(axis=1)
        low = np.ceil(points[..., :2].min(axis=1) - 0.5)
        high = np.floor(points[..., :2].max(axis=1) - 0.5)
        low = np.clip(low, 0, [self.width, self.height]).astype(np.int64)
        high = np.clip(high, -1, [self.width - 1, self.height - 1]).astype(np.int64)
        widths, heights = np.maximum(high - low + 1, 0).T
        counts = np.where(in_front, widths * heights, 0)
        drawn = np.flatnonzero(counts)
        ends = np.cumsum(counts[drawn])
        begin = 0
        while begin < len(drawn):
            done = ends[begin - 1] if begin else 0
            end = max(begin + 1, int(np.searchsorted(ends, done + _MAX_CANDIDATES, "right")))
            part = drawn[begin:end]
            self._fill(points[part], light[part], low[part], widths[part], counts[part], colour, through)
            begin = end

    def _fill(self, points: Any, light: Any, low: Any, widths: Any, counts: Any, colour: Vector, through: float) -> None:
        which = np.repeat(np.arange(len(counts)), counts)
        offset = np.arange(len(which)) - np.repeat(np.cumsum(counts) - counts, counts)
        x = low[which, 0] + offset % widths[which]
        y = low[which, 1] + offset // widths[which]
        (ax, ay), (bx, by), (cx, cy) = (points[:, k, :2].T for k in range(3))
        area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
        with np.errstate(divide="ignore"):
            per_area = np.where(area == 0.0, 0.0, 1.0 / area)[which]
        px, py = x + 0.5, y + 0.5
        u = ((bx[which] - px) * (cy[which] - py) - (by[which] - py) * (cx[which] - px)) * per_area
        v = ((cx[which] - px) * (ay[which] - py) - (cy[which] - py) * (ax[which] - px)) * per_area
        w = 1.0 - u - v
        inside = np.flatnonzero((u >= 0.0) & (v >= 0.0) & (w >= 0.0) & (per_area != 0.0))
        which, at = which[inside], (y[inside] * self.width + x[inside])
        weights = np.stack([u[inside], v[inside], w[inside]])
        inverse = np.einsum("kn,nk->n", weights, points[which, :, 2]).astype(np.float32)
        bright = np.einsum("kn,nk->n", weights, light[which])
        front = inverse > self.inverse[at]
        if through:
            behind = np.unique(at[~front])
            self.colours[behind] += np.float32(through) * (colour.astype(np.float32) - self.colours[behind])
        at, inverse, bright = at[front], inverse[front], bright[front]
        order = np.argsort(inverse, kind="stable")  # the last of several values for a pixel remains: the nearest
        at = at[order]
        self.inverse[at] = inverse[order]
        self.colours[at] = bright[order, np.newaxis] * colour

    def pixels(self, sampling: int) -> NDArray[np.uint8]:
        """Return RGB values, each the mean of sampling x sampling pixels."""
        shape = (self.height // sampling, sampling, self.width // sampling, sampling, 3)
        mean = self.colours.reshape(shape).mean(axis=(1, 3)) if sampling > 1 else self.colours.reshape(shape[0], shape[2], 3)
        return np.clip(mean + 0.5, 0, 255).astype(np.uint8)
