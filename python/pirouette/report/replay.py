"""3D replay of runs beside each other, as one HTML page that needs nothing else.

The robot, its forces and the path of its centre of mass are the simulator's truth. Planned points
and the terrain plane are drawn where the controller believed them to be relative to the robot: the
odometry's error of position is taken out.
"""

import contextlib
import io
from dataclasses import dataclass

import numpy as np
import viser

from pirouette import style
from pirouette.robot import load_model
from pirouette.run_folder import LEGS, Run
from pirouette.scene import TILE, RobotNodes, add_ground

FRAME_RATE = 25.0  # Hz, about
LONGEST = 120.0  # s, of a run that is shown: its end
MARGIN = 0.7  # m, of ground around the path
GAP = 0.2  # m, between the grounds of two runs
METRES_PER_NEWTON = 0.0025
LEAST_FORCE = 1.0  # N, that is drawn
PLANE_SIZE = 0.5  # m
ABOVE_GROUND = 0.004  # m, at which flat things are drawn
BALL, DIAMOND = 0.01, 0.012  # m, radius of the planned centre of mass and side of a foothold
STICK = 0.1  # m, of a vertex of weight 1


def page(runs: list[Run]) -> str:
    """The replay as an HTML document that follows the reader's light or dark mode."""
    with contextlib.redirect_stdout(io.StringIO()):  # viser greets
        server = viser.ViserServer(host="127.0.0.1", port=0, verbose=False)
        try:
            with server.atomic():  # nobody listens: do not wake the server for each message
                html = record(server, runs)
        finally:
            server.stop()
    dark = "matchMedia('(prefers-color-scheme: dark)').matches"
    return html.replace("{darkMode:false}", f"{{darkMode:{dark}}}")


def record(server: viser.ViserServer, runs: list[Run]) -> str:
    """Builds the scene, plays it into a recording and returns that as HTML."""
    server.scene.configure_default_lights(cast_shadow=False)
    actors = beside_each_other(server.scene, runs)
    aim_camera(server, actors)
    recording = server.get_scene_serializer()
    duration = max(actor.time[-1] - actor.time[0] for actor in actors)
    for frame in range(int(duration * FRAME_RATE) + 1):
        for actor in actors:
            actor.show(frame / FRAME_RATE)
        recording.insert_sleep(1.0 / FRAME_RATE)
    return recording.as_html()


def aim_camera(server: viser.ViserServer, actors: list["Actor"]) -> None:
    """From below a climb along x, where risers are seen: at one run from its side, at several so
    that the first is at the left."""
    length = max(actor.size[0] for actor in actors)
    width = sum(actor.size[1] for actor in actors) + GAP * (len(actors) - 1)
    direction = np.array([-0.8, -0.5 if len(actors) == 1 else 0.0, 0.55])
    distance = max(0.95, 0.65 * width, 0.5 * length)
    server.initial_camera.look_at = (0.0, 0.0, 0.12)
    server.initial_camera.position = tuple(distance * direction)
    server.initial_camera.fov = np.radians(50.0)


def beside_each_other(scene: viser.SceneApi, runs: list[Run]) -> list["Actor"]:
    """One actor a run, in a row along y around the origin."""
    corners = [bounds(run) for run in runs]
    widths = [high[1] - low[1] for low, high in corners]
    left = 0.5 * (sum(widths) + GAP * (len(runs) - 1))
    actors = []
    for i, (run, (low, high), width) in enumerate(zip(runs, corners, widths, strict=True)):
        middle = 0.5 * (low + high)
        height = float(run.ground.height(*middle))
        origin = np.array([-middle[0], left - 0.5 * width - middle[1], -height])
        left -= width + GAP
        actors.append(Actor(scene, run, f"/{i + 1} {run.name}", origin, low, high, i))
    return actors


def bounds(run: Run) -> tuple[np.ndarray, np.ndarray]:
    """Lower and upper corner of the ground that is drawn, m, shape (2,)."""
    path = run.trace["true_com_position"][:, :2]
    return path.min(axis=0) - MARGIN, path.max(axis=0) + MARGIN


@dataclass
class Plan:
    """Handles of what the controller planned; the frame takes the odometry's error out."""

    frame: viser.FrameHandle
    com: viser.SceneNodeHandle
    footholds: viser.PointCloudHandle
    polygon: viser.LineSegmentsHandle
    plane: viser.SceneNodeHandle


class Actor:
    """One run in the scene: builds its nodes once, then moves them to a time."""

    def __init__(
        self,
        scene: viser.SceneApi,
        run: Run,
        root: str,
        origin: np.ndarray,
        low: np.ndarray,
        high: np.ndarray,
        index: int,
    ) -> None:
        self.scene, self.run, self.root = scene, run, root
        self.size = high - low  # m, of its ground, shape (2,)
        rows = run.trace[run.trace["time"] >= run.trace["time"][-1] - LONGEST]
        self.rows, self.time = rows, rows["time"]
        self.shows_plan = run.has(
            "base_position",
            "com_plan",
            "foothold",
            "contact",
            "contact_point",
            "phase_progress",
            "psp_weight",
            "plane",
        )
        scene.add_frame(root, show_axes=False, position=origin)
        add_ground(scene, root, run.ground.cropped(low, high, TILE))
        self.add_path(index)
        self.robot = RobotNodes(scene, root, load_model(run))
        self.forces = self.add_forces() if run.has("true_foot_force", "true_foot_position") else []
        self.lift_off = rows["contact_point"][0].copy() if self.shows_plan else None
        self.plan = self.add_plan() if self.shows_plan else None

    def add_path(self, index: int) -> None:
        """The whole path of the centre of mass on the ground, the commanded point, the name."""
        com = self.run.record["true_com_position"]
        stride = max(1, len(com) // 3000)
        path = com[::stride].copy()
        path[:, 2] = self.run.ground.height(path[:, 0], path[:, 1]) + ABOVE_GROUND
        self.scene.add_line_segments(
            f"{self.root}/path of the centre of mass",
            np.stack([path[:-1], path[1:]], axis=1),
            style.rgb(index),
            thickness=0.003,
        )
        if self.run.spins:
            point = np.append(self.run.point, self.run.ground.height(*self.run.point))
            self.scene.add_cylinder(
                f"{self.root}/commanded point",
                radius=0.012,
                height=0.002,
                color=(230, 159, 0),
                position=point + [0.0, 0.0, ABOVE_GROUND],
            )
        above = np.append(com.mean(axis=0)[:2], com[:, 2].max() + 0.3)
        self.scene.add_label(f"{self.root}/name", self.run.name, position=above)

    def add_forces(self) -> list[viser.ArrowsHandle]:
        return [
            self.scene.add_arrows(
                f"{self.root}/contact forces/{leg}",
                np.zeros((1, 2, 3)),
                style.rgb(5),
                shaft_radius=0.004,
                head_radius=0.01,
                head_length=0.025,
                visible=False,
            )
            for leg in LEGS
        ]

    def add_plan(self) -> Plan:
        half = 0.5 * PLANE_SIZE
        corners = np.array([[-half, -half, 0], [half, -half, 0], [half, half, 0], [-half, half, 0]])
        root = f"{self.root}/plan"
        return Plan(
            self.scene.add_frame(root, show_axes=False),
            self.scene.add_icosphere(
                f"{root}/planned centre of mass", radius=BALL, color=style.rgb(1)
            ),
            self.scene.add_point_cloud(
                f"{root}/footholds",
                np.zeros((4, 3)),
                style.rgb(2),
                point_size=DIAMOND,
                point_shape="diamond",
                point_shading="flat",
                precision="float32",
            ),
            self.scene.add_line_segments(
                f"{root}/PSP vertices and weights",
                np.zeros((8, 2, 3)),
                style.rgb(3),
                thickness=0.005,
            ),
            self.scene.add_mesh_simple(
                f"{root}/terrain plane",
                corners,
                np.array([[0, 1, 2], [0, 2, 3]]),
                color=style.rgb(4),
                opacity=0.35,
                side="double",
                cast_shadow=False,
                receive_shadow=False,
            ),
        )

    def show(self, elapsed: float) -> None:
        """Moves everything to the time since the first shown row; stays at the end."""
        index = int(np.searchsorted(self.time, self.time[0] + elapsed - 1e-9))
        row = self.rows[min(index, len(self.rows) - 1)]
        self.robot.show(row)
        for leg, arrow in enumerate(self.forces):
            force = row["true_foot_force"][leg]
            arrow.visible = bool(np.linalg.norm(force) > LEAST_FORCE)
            if arrow.visible:
                foot = row["true_foot_position"][leg]
                arrow.points = np.stack([foot, foot + METRES_PER_NEWTON * force])[None]
        if self.plan:
            self.show_plan(row)

    def show_plan(self, row: np.void) -> None:
        a0, a1, a2 = row["plane"]
        self.plan.frame.position = row["true_base_position"] - row["base_position"]

        def on_plane(xy: np.ndarray) -> np.ndarray:
            z = a0 + a1 * xy[..., 0] + a2 * xy[..., 1] + ABOVE_GROUND
            return np.concatenate([xy, z[..., None]], axis=-1)

        # On the ground: at its height the trunk hides it.
        self.plan.com.position = on_plane(row["com_plan"]) + [0.0, 0.0, BALL]
        self.plan.footholds.points = row["foothold"] + [0.0, 0.0, DIAMOND]
        self.plan.plane.position = on_plane(row["com_position"][:2])
        normal = np.array([-a1, -a2, 1.0]) / np.sqrt(1.0 + a1 * a1 + a2 * a2)
        half = np.array([1.0 + normal[2], -normal[1], normal[0], 0.0])  # turns z onto the normal
        self.plan.plane.wxyz = half / np.linalg.norm(half)

        vertices = on_plane(self.vertices(row))
        around = vertices[[0, 1, 3, 2]]  # FR FL RL RR
        tips = vertices + np.outer(row["psp_weight"], [0.0, 0.0, STICK])
        self.plan.polygon.points = np.concatenate(
            [
                np.stack([around, np.roll(around, -1, axis=0)], axis=1),
                np.stack([vertices, tips], axis=1),
            ]
        )

    def vertices(self, row: np.void) -> np.ndarray:
        """Vertices of the projected support polygon, shape (4, 2): contacts, and for feet in swing
        the smooth way from the last contact to the next foothold, E19."""
        down = row["contact"]
        self.lift_off[down] = row["contact_point"][down]
        f = row["phase_progress"]
        share = np.where(down, 0.0, f**3 * (10.0 + f * (-15.0 + 6.0 * f)))[:, None]
        start, end = self.lift_off[:, :2], row["foothold"][:, :2]
        return start + share * (end - start)
