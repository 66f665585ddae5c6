"""Robot and ground as Foxglove's scene entities, each fixed to a frame of /tf."""

import numpy as np
import trimesh
from foxglove.messages import (
    Color,
    Point3,
    Pose,
    Quaternion,
    SceneEntity,
    SceneUpdate,
    Timestamp,
    TriangleListPrimitive,
    Vector3,
)

from pirouette.robot import Poser, visible_shapes
from pirouette.run_folder import Run
from pirouette.scene import DARK_TILE, LIGHT_TILE, TILE

MARGIN = 0.7  # m, of ground around the path
AT_FRAME = Pose(
    position=Vector3(x=0.0, y=0.0, z=0.0), orientation=Quaternion(x=0.0, y=0.0, z=0.0, w=1.0)
)


def triangles(
    vertices: np.ndarray, faces: np.ndarray, rgb: tuple[int, int, int]
) -> TriangleListPrimitive:
    """Of vertices (m, shape (n, 3)), faces (indices into them, shape (m, 3)), colour as bytes."""
    red, green, blue = (part / 255.0 for part in rgb)
    return TriangleListPrimitive(
        pose=AT_FRAME,
        points=[Point3(x=float(x), y=float(y), z=float(z)) for x, y, z in vertices],
        color=Color(r=red, g=green, b=blue, a=1.0),
        indices=[int(i) for i in faces.ravel()],
    )


def scene(run: Run, poser: Poser, world: str, at: Timestamp) -> SceneUpdate:
    """The ground in the frame `world`, every body of the robot in its own; forever."""

    def entity(frame: str, parts: list[TriangleListPrimitive]) -> SceneEntity:
        return SceneEntity(
            timestamp=at, frame_id=frame, id=frame, frame_locked=True, triangles=parts
        )

    model = poser.model
    entities = [entity(world, ground(run))]
    for body in range(1, model.nbody):
        shapes: dict[tuple[int, int, int], trimesh.Trimesh] = visible_shapes(model, body)
        parts = [triangles(mesh.vertices, mesh.faces, rgb) for rgb, mesh in shapes.items()]
        if parts:
            entities.append(entity(model.body(body).name, parts))
    return SceneUpdate(entities=entities)


def ground(run: Run) -> list[TriangleListPrimitive]:
    """The light and the dark tiles of the ground around the path."""
    path = run.trace["true_com_position"][:, :2]
    shown = run.ground.cropped(path.min(axis=0) - MARGIN, path.max(axis=0) + MARGIN, TILE)
    colours = (LIGHT_TILE, DARK_TILE)
    tiles = zip(shown.tiles(TILE), colours, strict=True)
    return [triangles(shown.vertices(), faces, rgb) for faces, rgb in tiles]
