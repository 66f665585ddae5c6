"""The robot on its ground, as the browser shows them."""

from collections.abc import Mapping

import numpy as np
import viser

from pirouette.api import Simulation
from pirouette.ground import Ground
from pirouette import _core
from pirouette.robot import read_text
from pirouette.scene import TILE, RobotNodes, add_ground

ROOT = "/world"
HALF_SIZE = 1.5  # m, of the ground that is shown around the robot
FINE_STEPS = 4  # of uneven ground in a tile
SHIFT = 0.75  # m, from the shown ground's middle, at which it moves with the robot


class World:
    """Nodes of one robot; the ground is that of the simulation given last."""

    def __init__(self, server: viser.ViserServer, simulation: Simulation) -> None:
        self.scene = server.scene
        self.scene.configure_default_lights(cast_shadow=False)
        self.frame = self.scene.add_frame(ROOT, show_axes=False)
        model = read_text(_core.robot_mjcf(simulation.config["robot"]))
        self.robot = RobotNodes(self.scene, ROOT, model)
        server.initial_camera.look_at = (0.0, 0.0, 0.12)
        server.initial_camera.position = (1.0, -0.7, 0.7)
        server.initial_camera.fov = np.radians(50.0)
        self.enter(simulation)

    def enter(self, simulation: Simulation) -> None:
        """Shows the ground of this simulation."""
        self.simulation = simulation
        self.lay_ground(simulation.state["true_base_position"][:2])

    def lay_ground(self, around: np.ndarray) -> None:
        self.middle = TILE * np.round(around / TILE)
        fine = TILE / FINE_STEPS
        steps = fine * np.arange(-round(HALF_SIZE / fine), round(HALF_SIZE / fine) + 1)
        x, y = (steps + middle for middle in self.middle)
        fine = Ground(x, y, self.simulation.ground(x, y))
        coarse = fine.sampled(x[::FINE_STEPS], y[::FINE_STEPS])
        add_ground(self.scene, ROOT, coarse if fine.is_plane else fine)

    def show(self, state: Mapping[str, np.ndarray], follow: bool) -> None:
        """Moves the robot; with `follow` it stays in the middle and the world moves."""
        position = state["true_base_position"]
        if not np.isfinite(position).all():
            return  # the simulation broke down
        if np.abs(position[:2] - self.middle).max() > SHIFT:
            self.lay_ground(position[:2])
        self.robot.show(state)
        ground = self.simulation.ground(*position[:2, None])[0, 0]
        self.frame.position = -np.append(position[:2], ground) if follow else np.zeros(3)
