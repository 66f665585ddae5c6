"""The run as an MCAP file with Foxglove's schemas, for Foxglove and PlotJuggler.

    /tf            foxglove.FrameTransforms  every body of the robot, truth; frame `estimate`
    /joint_states  foxglove.JointStates      truth
    /trunk/true, /trunk/estimate, /com/true, /com/plan
                   foxglove.PoseInFrame
    /scene         foxglove.SceneUpdate      robot and ground, once, at the start
    /trace         JSON with a schema        every column of trace.npy

Message times are simulated time, from 0.
"""

import json
from pathlib import Path

import foxglove
import mujoco
import numpy as np
from foxglove.channels import (
    FrameTransformsChannel,
    JointStatesChannel,
    PoseInFrameChannel,
    SceneUpdateChannel,
)
from foxglove.messages import (
    FrameTransform,
    FrameTransforms,
    JointState,
    JointStates,
    Pose,
    PoseInFrame,
    Quaternion,
    Timestamp,
    Vector3,
)

from pirouette.export.shapes import scene
from pirouette.robot import Poser, load_model
from pirouette.run_folder import Run

WORLD, ESTIMATE = "world", "estimate"
UPRIGHT = (1.0, 0.0, 0.0, 0.0)


def quaternion_of(rpy: np.ndarray) -> np.ndarray:
    """(w, x, y, z) of roll, pitch, yaw, rad."""
    quaternion = np.zeros(4)
    mujoco.mju_euler2Quat(quaternion, np.asarray(rpy[::-1], dtype=float), "zyx")
    return quaternion


def vector(values: np.ndarray) -> Vector3:
    return Vector3(x=float(values[0]), y=float(values[1]), z=float(values[2]))


def rotation(wxyz: np.ndarray | tuple) -> Quaternion:
    w, x, y, z = map(float, wxyz)
    return Quaternion(w=w, x=x, y=y, z=z)


def nanoseconds(time: float) -> int:
    return round(float(time) * 1e9)


def stamp(time: float) -> Timestamp:
    return Timestamp(*divmod(nanoseconds(time), 1_000_000_000))


def trace_schema(dtype: np.dtype) -> dict:
    """JSON schema of one row of the trace."""
    kinds = {"f": "number", "i": "integer", "u": "integer", "b": "boolean"}
    properties = {}
    for name in dtype.names:
        column = dtype[name]
        schema = {"type": kinds[column.base.kind]}
        for _ in column.shape:
            schema = {"type": "array", "items": schema}
        properties[name] = schema
    return {"type": "object", "title": "pirouette.Trace", "properties": properties}


def row_json(row: np.void) -> bytes:
    """A row of the trace; what is not finite is null."""
    values = dict(zip(row.dtype.names, (np.asarray(v).tolist() for v in row), strict=True))
    try:
        return json.dumps(values, allow_nan=False).encode()
    except ValueError:
        return json.dumps(finite_or_none(values)).encode()


def finite_or_none(value: object) -> object:
    if isinstance(value, dict):
        return {key: finite_or_none(item) for key, item in value.items()}
    if isinstance(value, list):
        return [finite_or_none(item) for item in value]
    return None if isinstance(value, float) and not np.isfinite(value) else value


class Recorder:
    """The channels of one file, on a context of their own."""

    def __init__(self, run: Run, context: foxglove.Context) -> None:
        self.run = run
        self.poser = Poser(load_model(run))
        self.transforms = FrameTransformsChannel("/tf", context=context)
        self.scene = SceneUpdateChannel("/scene", context=context)
        self.joints = JointStatesChannel("/joint_states", context=context)
        self.poses = {
            topic: PoseInFrameChannel(topic, context=context)
            for topic in ("/trunk/true", "/trunk/estimate", "/com/true", "/com/plan")
        }
        self.trace = foxglove.Channel(
            "/trace", schema=trace_schema(run.trace.dtype), context=context
        )

    def log_scene(self) -> None:
        start = self.run.trace["time"][0]
        message = scene(self.run, self.poser, WORLD, stamp(start))
        self.scene.log(message, log_time=nanoseconds(start))

    def log(self, row: np.void) -> None:
        at = nanoseconds(row["time"])
        self.trace.log(row_json(row), log_time=at)
        self.transforms.log(self.frames(row), log_time=at)
        self.joints.log(self.joint_states(row), log_time=at)
        self.log_pose("/trunk/true", row, row["true_base_position"], quaternion_of(row["true_rpy"]))
        self.log_pose("/com/true", row, row["true_com_position"], UPRIGHT)
        if self.run.has("base_position", "base_rpy"):
            attitude = quaternion_of(row["base_rpy"])
            self.log_pose("/trunk/estimate", row, row["base_position"], attitude)
        if self.run.has("com_plan", "com_position"):
            plan = np.append(row["com_plan"], row["com_position"][2])
            self.log_pose("/com/plan", row, plan, UPRIGHT)

    def log_pose(self, topic: str, row: np.void, position: np.ndarray, wxyz) -> None:
        pose = Pose(position=vector(position), orientation=rotation(wxyz))
        message = PoseInFrame(timestamp=stamp(row["time"]), frame_id=WORLD, pose=pose)
        self.poses[topic].log(message, log_time=nanoseconds(row["time"]))

    def frames(self, row: np.void) -> FrameTransforms:
        self.poser.set(row)
        model, time = self.poser.model, stamp(row["time"])
        frames = []
        for body in range(1, model.nbody):
            position, quaternion = self.poser.parent_pose(body)
            parent = int(model.body_parentid[body])
            frames.append(
                FrameTransform(
                    timestamp=time,
                    parent_frame_id=model.body(parent).name if parent else WORLD,
                    child_frame_id=model.body(body).name,
                    translation=vector(position),
                    rotation=rotation(quaternion),
                )
            )
        if self.run.has("base_position", "base_rpy"):
            frames.append(
                FrameTransform(
                    timestamp=time,
                    parent_frame_id=WORLD,
                    child_frame_id=ESTIMATE,
                    translation=vector(row["base_position"]),
                    rotation=rotation(quaternion_of(row["base_rpy"])),
                )
            )
        return FrameTransforms(transforms=frames)

    def joint_states(self, row: np.void) -> JointStates:
        position = row["true_joint_position"].ravel()
        moving = self.run.has("true_joint_velocity", "true_joint_torque")
        states = []
        for i, name in enumerate(self.poser.joint_names):
            state = JointState(name=name, position=float(position[i]))
            if moving:
                state = JointState(
                    name=name,
                    position=float(position[i]),
                    velocity=float(row["true_joint_velocity"].ravel()[i]),
                    effort=float(row["true_joint_torque"].ravel()[i]),
                )
            states.append(state)
        return JointStates(timestamp=stamp(row["time"]), joints=states)


def write_mcap(run: Run, file: Path) -> None:
    context = foxglove.Context()
    recorder = Recorder(run, context)
    with foxglove.open_mcap(file, context=context):
        recorder.log_scene()
        for row in run.trace:
            recorder.log(row)
