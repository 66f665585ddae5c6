"""The robot of a run: its MJCF, and where its bodies were."""

import os
import sys
from collections.abc import Iterable, Mapping
from pathlib import Path

import mujoco
import numpy as np
import trimesh

from pirouette.run_folder import LEGS, Run, RunError

HIDDEN_GROUP = 3  # MuJoCo shows groups 0 to 2; by custom 3 and more are collision shapes


def data_folders() -> list[Path]:
    """Where robots/ may be: PIROUETTE_DATA_DIR, the source tree, the installation's share/."""
    given = os.environ.get("PIROUETTE_DATA_DIR")
    folders = [Path(given)] if given else []
    folders.append(Path(__file__).resolve().parents[2])
    folders += [Path(prefix) / "share/pirouette" for prefix in (sys.prefix, "/usr/local", "/usr")]
    return folders


def find_robot(robot: str, folders: Iterable[Path] = ()) -> Path:
    """The MJCF that the parameter `robot` names: a folder under robots/, or a file, which may be
    relative to one of `folders`."""
    if robot.endswith(".xml"):
        candidates = [Path(robot), *(folder / robot for folder in folders)]
    else:
        candidates = [folder / "robots" / robot / f"{robot}.xml" for folder in data_folders()]
    for candidate in candidates:
        if candidate.is_file():
            return candidate
    raise RunError(f"robot {robot!r} not found; tried {', '.join(str(c) for c in candidates)}")


def robot_file(run: Run) -> Path:
    """The MJCF of a run's robot: as it was read for the run, else as it is now."""
    kept = run.folder / "robot.xml"
    if kept.is_file():
        return kept
    try:
        return find_robot(run.config["robot"], run.folder.parents)
    except RunError as error:
        raise RunError(f"{run.folder / 'run.toml'}: {error}") from None


def load_model(run: Run) -> mujoco.MjModel:
    return read_model(robot_file(run))


def read_text(xml: str) -> mujoco.MjModel:
    """The model of an MJCF's text whose meshes have absolute paths."""
    return mujoco.MjModel.from_xml_string(xml)


def read_model(file: Path) -> mujoco.MjModel:
    try:
        return mujoco.MjModel.from_xml_path(str(file))
    except ValueError as error:
        raise RunError(f"{file}: {error}") from None


class Poser:
    """Puts a model where the robot truly was in a row of the trace."""

    def __init__(self, model: mujoco.MjModel) -> None:
        self.model = model
        self.data = mujoco.MjData(model)
        free = np.flatnonzero(model.jnt_type == mujoco.mjtJoint.mjJNT_FREE)
        if len(free) != 1:
            raise RunError(f"the robot has {len(free)} free joints; expected one, on the trunk")
        self.trunk = int(model.jnt_bodyid[free[0]])
        self._base = int(model.jnt_qposadr[free[0]])
        joints = self._named_joints() or [j for leg in LEGS for j in self._chain(leg)]
        self.joint_names = [model.joint(j).name for j in joints]  # legs in the order of the trace
        self._joints = model.jnt_qposadr[joints]

    def _named_joints(self) -> list[int]:
        """The joints that the file itself names in the trace's order; none in other files."""
        for i in range(self.model.ntext):
            if mujoco.mj_id2name(self.model, mujoco.mjtObj.mjOBJ_TEXT, i) != "pirouette_joints":
                continue
            start = self.model.text_adr[i]
            data = bytes(self.model.text_data[start : start + self.model.text_size[i]])
            names = data.rstrip(b"\0").decode().split(";")
            return [self.model.joint(name).id for name in names]
        return []

    def _chain(self, leg: str) -> list[int]:
        """The leg's three hinges in the order abad, hip, knee."""
        hinges = [
            j
            for j in range(self.model.njnt)
            if self.model.jnt_type[j] == mujoco.mjtJoint.mjJNT_HINGE
            and self.model.joint(j).name.upper().startswith(leg)
        ]
        if len(hinges) != 3:
            raise RunError(f"the robot has {len(hinges)} joints named {leg}...; expected 3")
        return sorted(hinges, key=lambda j: self.model.jnt_bodyid[j])  # parents come first

    def set(self, row: Mapping[str, np.ndarray] | np.void) -> mujoco.MjData:
        roll, pitch, yaw = row["true_rpy"]
        quaternion = np.zeros(4)
        mujoco.mju_euler2Quat(quaternion, np.array([yaw, pitch, roll]), "zyx")
        self.data.qpos[self._base : self._base + 3] = row["true_base_position"]
        self.data.qpos[self._base + 3 : self._base + 7] = quaternion
        self.data.qpos[self._joints] = row["true_joint_position"].ravel()
        mujoco.mj_kinematics(self.model, self.data)
        return self.data

    def parent_pose(self, body: int) -> tuple[np.ndarray, np.ndarray]:
        """Position (m) and quaternion (w, x, y, z) of a body in its parent's axes."""
        parent = self.model.body_parentid[body]
        inverse, position, quaternion = np.zeros(4), np.zeros(3), np.zeros(4)
        mujoco.mju_negQuat(inverse, self.data.xquat[parent])
        mujoco.mju_rotVecQuat(position, self.data.xpos[body] - self.data.xpos[parent], inverse)
        mujoco.mju_mulQuat(quaternion, inverse, self.data.xquat[body])
        return position, quaternion


def visible_shapes(model: mujoco.MjModel, body: int) -> dict[tuple[int, int, int], trimesh.Trimesh]:
    """The shapes of a body in its own axes, one mesh for each colour (three bytes)."""
    looks = [g for g in range(model.ngeom) if model.geom_group[g] < HIDDEN_GROUP]
    geoms = looks if looks else range(model.ngeom)
    meshes: dict[tuple[int, int, int], list[trimesh.Trimesh]] = {}
    for geom in geoms:
        if model.geom_bodyid[geom] != body:
            continue
        mesh = shape(model, geom)
        if mesh is None:
            continue
        rotation = np.zeros(9)
        mujoco.mju_quat2Mat(rotation, model.geom_quat[geom])
        pose = np.eye(4)
        pose[:3, :3], pose[:3, 3] = rotation.reshape(3, 3), model.geom_pos[geom]
        mesh.apply_transform(pose)
        material = model.geom_matid[geom]
        rgba = model.mat_rgba[material] if material >= 0 else model.geom_rgba[geom]
        red, green, blue = (int(round(255 * float(c))) for c in rgba[:3])
        meshes.setdefault((red, green, blue), []).append(mesh)
    return {colour: trimesh.util.concatenate(parts) for colour, parts in meshes.items()}


def shape(model: mujoco.MjModel, geom: int) -> trimesh.Trimesh | None:
    """The surface of a geom in its own axes; None for what has none of its own, like a plane."""
    size, kind = model.geom_size[geom], mujoco.mjtGeom(model.geom_type[geom])
    if kind == mujoco.mjtGeom.mjGEOM_BOX:
        return trimesh.creation.box(extents=2.0 * size)
    if kind == mujoco.mjtGeom.mjGEOM_SPHERE:
        return trimesh.creation.icosphere(subdivisions=2, radius=size[0])
    if kind == mujoco.mjtGeom.mjGEOM_ELLIPSOID:
        return trimesh.creation.icosphere(subdivisions=2).apply_scale(size)
    if kind == mujoco.mjtGeom.mjGEOM_CYLINDER:
        return trimesh.creation.cylinder(radius=size[0], height=2.0 * size[1], sections=24)
    if kind == mujoco.mjtGeom.mjGEOM_CAPSULE:
        mesh = trimesh.creation.capsule(radius=size[0], height=2.0 * size[1], count=[12, 12])
        return mesh.apply_translation([0.0, 0.0, -mesh.bounds.mean(axis=0)[2]])
    if kind == mujoco.mjtGeom.mjGEOM_MESH:
        data = model.mesh(model.geom_dataid[geom])
        vertices = model.mesh_vert[data.vertadr[0] :][: data.vertnum[0]]
        faces = model.mesh_face[data.faceadr[0] :][: data.facenum[0]]
        return trimesh.Trimesh(vertices, faces, process=False)
    return None
