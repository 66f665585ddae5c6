"""Heights of the ground, for pictures."""

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

MOST_POINTS = 60_000  # of a grid that is drawn
FINEST = 10  # lines of an uneven ground in a tile
LEVEL = 1e-6  # m, of curvature that is rounding

Trend = Callable[[np.ndarray, np.ndarray], np.ndarray]


def trend_of(terrain: str) -> Trend:
    """The formula z(x, y), in m, in the name of a terrain, which holds however far the robot walks:
    of slope:DEGREES and stairs:RISExRUN@DEGREES. Other ground is level on the whole."""
    kind, _, rest = terrain.partition("+")[0].partition(":")
    if kind == "slope":
        gradient = math.tan(math.radians(float(rest)))
        return lambda x, y: gradient * x + 0.0 * y
    if kind == "stairs":
        size, _, degrees = rest.partition("@")
        rise, run = map(float, size.split("x"))
        angle = math.radians(float(degrees or 0.0))
        c, s = math.cos(angle), math.sin(angle)
        return lambda x, y: rise * np.floor((c * x + s * y) / run + 0.5)
    return lambda x, y: 0.0 * (x + y)


@dataclass(frozen=True)
class Ground:
    """Heights z (m) in the world, shape (len(y), len(x)), at increasing x and y (m). Beyond them
    the nearest height goes on with the trend."""

    x: np.ndarray
    y: np.ndarray
    z: np.ndarray
    trend: Trend = trend_of("flat")

    @staticmethod
    def square(heights: np.ndarray, half_extent: float, terrain: str = "flat") -> "Ground":
        """A square grid about the origin; rows along y, columns along x."""
        rows, columns = heights.shape
        return Ground(
            np.linspace(-half_extent, half_extent, columns),
            np.linspace(-half_extent, half_extent, rows),
            np.asarray(heights, dtype=float),
            trend_of(terrain),
        )

    def height(self, x: np.ndarray, y: np.ndarray) -> np.ndarray:
        """m, at x and y (m, of one shape or broadcast): bilinear."""
        near_x, near_y = np.clip(x, *self.x[[0, -1]]), np.clip(y, *self.y[[0, -1]])
        column, u = cell(self.x, near_x)
        row, v = cell(self.y, near_y)
        z = self.z
        low = (1 - u) * z[row, column] + u * z[row, column + 1]
        high = (1 - u) * z[row + 1, column] + u * z[row + 1, column + 1]
        return (1 - v) * low + v * high + self.trend(x, y) - self.trend(near_x, near_y)

    def sampled(self, x: np.ndarray, y: np.ndarray) -> "Ground":
        """On other lines x and y (m, increasing)."""
        return Ground(x, y, self.height(x[None, :], y[:, None]))

    def cropped(self, low: np.ndarray, high: np.ndarray, tile: float) -> "Ground":
        """About between the corners low and high (m, shape (2,)): a line every tile (m), and where
        the ground is uneven as many between them as a picture can bear."""
        first, last = np.floor(low / tile), np.ceil(high / tile)

        def lines(parts: int) -> list[np.ndarray]:
            return [
                np.arange(parts * a, parts * b + 1) * tile / parts
                for a, b in zip(first, last, strict=True)
            ]

        tiles = float(np.prod(last - first))
        parts = max(1, min(FINEST, math.isqrt(int(MOST_POINTS / tiles))))
        fine = self.sampled(*lines(parts))
        return self.sampled(*lines(1)) if fine.is_plane else fine

    @property
    def is_plane(self) -> bool:
        return all(
            np.abs(np.diff(self.z, 2, axis=axis)).max(initial=0.0) < LEVEL for axis in (0, 1)
        )

    def vertices(self) -> np.ndarray:
        """World positions, m, shape (len(y) * len(x), 3)."""
        x, y = np.meshgrid(self.x, self.y)
        return np.stack([x, y, self.z], axis=-1).reshape(-1, 3)

    def tiles(self, size: float) -> tuple[np.ndarray, np.ndarray]:
        """Triangles (indices into vertices(), shape (n, 3)) of the light and dark tiles of a
        checkerboard with fields of this size (m)."""
        columns = len(self.x)
        row, column = np.meshgrid(np.arange(len(self.y) - 1), np.arange(columns - 1), indexing="ij")
        corner = row * columns + column
        faces = np.stack(
            [
                corner,
                corner + 1,
                corner + columns + 1,
                corner,
                corner + columns + 1,
                corner + columns,
            ],
            axis=-1,
        ).reshape(*corner.shape, 2, 3)
        middle_x, middle_y = (0.5 * (v[:-1] + v[1:]) for v in (self.x, self.y))
        dark = (np.floor(middle_x[None, :] / size) + np.floor(middle_y[:, None] / size)).astype(
            int
        ) % 2 == 1
        return faces[~dark].reshape(-1, 3), faces[dark].reshape(-1, 3)


def cell(lines: np.ndarray, values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The interval of increasing lines that holds each value, and where in it, 0 to 1."""
    index = np.clip(np.searchsorted(lines, values, side="right") - 1, 0, len(lines) - 2)
    return index, (values - lines[index]) / (lines[index + 1] - lines[index])
