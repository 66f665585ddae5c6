"""The robot and its ground as nodes of a viser scene."""

from collections.abc import Mapping

import mujoco
import numpy as np
import viser

from pirouette.ground import Ground
from pirouette.robot import Poser, visible_shapes

STILL = 1e-6  # m, that a body may be away from where it is drawn
TILE = 0.1  # m, side of a field of the ground's checkerboard
LIGHT_TILE, DARK_TILE = (190, 193, 198), (160, 164, 171)


def add_ground(scene: viser.SceneApi, root: str, ground: Ground) -> None:
    """A checkerboard on the ground, below the node `root`; it replaces an earlier one there."""
    for faces, colour, name in zip(
        ground.tiles(TILE), (LIGHT_TILE, DARK_TILE), ("light", "dark"), strict=True
    ):
        scene.add_mesh_simple(
            f"{root}/terrain/{name}",
            ground.vertices(),
            faces,
            color=colour,
            flat_shading=True,
            side="double",
            cast_shadow=False,
        )


class RobotNodes:
    """The bodies of a robot below the node `root`: built once, then moved."""

    def __init__(self, scene: viser.SceneApi, root: str, model: mujoco.MjModel) -> None:
        self.poser = Poser(model)
        names = {0: f"{root}/robot"}
        scene.add_frame(names[0], show_axes=False)
        self.bodies = {}
        for body in range(1, model.nbody):
            parent = names[int(model.body_parentid[body])]
            names[body] = f"{parent}/{model.body(body).name or body}"
            self.bodies[body] = scene.add_frame(names[body], show_axes=False)
            for i, (colour, mesh) in enumerate(visible_shapes(model, body).items()):
                scene.add_mesh_simple(
                    f"{names[body]}/shape {i}",
                    mesh.vertices,
                    mesh.faces,
                    color=colour,
                    flat_shading=True,
                    receive_shadow=False,
                )

    def show(self, row: Mapping[str, np.ndarray] | np.void) -> None:
        """Moves the bodies to where they truly were in a row of the trace."""
        self.poser.set(row)
        for body, node in self.bodies.items():
            position, node.wxyz = self.poser.parent_pose(body)
            if np.abs(position - node.position).max() > STILL:  # hinges leave it where it is
                node.position = position
