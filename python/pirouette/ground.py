"""Heights of the ground on a rectilinear grid, for pictures."""

import math
from dataclasses import dataclass

import numpy as np

HALF_EXTENT = 5.0  # m, of ground that is known by name only
EDGE = 1e-4  # m, horizontal width at which a riser is drawn


@dataclass(frozen=True)
class Ground:
    """Heights z (m) in the world, shape (len(y), len(x)), at increasing x and y (m)."""

    x: np.ndarray
    y: np.ndarray
    z: np.ndarray

    @staticmethod
    def square(heights: np.ndarray, half_extent: float) -> "Ground":
        """A square grid about the origin; rows along y, columns along x."""
        rows, columns = heights.shape
        return Ground(
            np.linspace(-half_extent, half_extent, columns),
            np.linspace(-half_extent, half_extent, rows),
            np.asarray(heights, dtype=float),
        )

    @staticmethod
    def named(terrain: str) -> "Ground":
        """What `plant.terrain` says: slope:DEGREES, stairs:RISExRUN; anything else is level, for
        older runs without terrain.npy."""
        kind, _, rest = terrain.partition(":")
        x = np.array([-HALF_EXTENT, HALF_EXTENT])
        z = np.zeros(2)
        if kind == "slope":
            z = math.tan(math.radians(float(rest))) * x
        elif kind == "stairs":
            rise, run = (float(number) for number in rest.split("x"))
            last = math.ceil(HALF_EXTENT / run)
            treads = np.arange(-last, last + 1)
            edges = (treads[:-1] + 0.5) * run
            x = np.concatenate([[-HALF_EXTENT - run], np.repeat(edges, 2), [HALF_EXTENT + run]])
            x[1:-1] += np.tile([-EDGE / 2, EDGE / 2], len(edges))
            z = rise * np.repeat(treads, 2).astype(float)
        y = np.array([-HALF_EXTENT, HALF_EXTENT])
        return Ground(x, y, np.tile(z, (2, 1)))

    def cropped(self, low: np.ndarray, high: np.ndarray, pitch: float) -> "Ground":
        """Only between the corners low and high (m, shape (2,)), with a line every pitch (m)."""
        x, y = (
            np.unique(
                np.concatenate(
                    [
                        own[(own > low[i]) & (own < high[i])],
                        np.arange(np.ceil(low[i] / pitch), np.floor(high[i] / pitch) + 1) * pitch,
                    ]
                ).round(6)
            )
            for i, own in enumerate((self.x, self.y))
        )
        return self.sampled(x, y)

    def sampled(self, x: np.ndarray, y: np.ndarray) -> "Ground":
        """On other lines x and y (m, increasing), bilinear; constant beyond the edges."""
        along_x = np.stack([np.interp(x, self.x, row) for row in self.z])
        z = np.stack([np.interp(y, self.y, column) for column in along_x.T], axis=1)
        return Ground(x, y, z)

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
