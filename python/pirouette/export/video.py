"""The run as a video at real-time speed, rendered without a display."""

from fractions import Fraction
from pathlib import Path

from pirouette.stage import add_forces, options, renderer, stage  # isort: skip - chooses the renderer for mujoco

import av
import mujoco
import numpy as np

from pirouette.robot import Poser, robot_file
from pirouette.run_folder import Run

FRAME_RATE = 30  # Hz
SIZE = (800, 450)  # pixels
QUALITY = "23"  # of x264, lower is better


def camera_at(centre: np.ndarray) -> mujoco.MjvCamera:
    camera = mujoco.MjvCamera()
    camera.lookat[:] = [centre[0], centre[1], centre[2] - 0.08]
    camera.distance, camera.azimuth, camera.elevation = 1.15, 35, -22
    return camera


def write_video(run: Run, file: Path) -> None:
    """H.264; a frame shows the row of the trace at its time. The camera follows a robot that walks."""
    time, com = run.trace["time"], run.trace["true_com_position"]
    middle = com.mean(axis=0)
    poser = Poser(stage(robot_file(run), run.ground, com, SIZE, samples=0, pitch=0.02))
    has_forces = run.has("true_foot_force", "true_foot_position")
    shown = np.searchsorted(time, np.arange(time[0], time[-1], 1.0 / FRAME_RATE))
    with (
        av.open(str(file), "w") as container,
        renderer(poser.model, SIZE) as painter,
    ):
        painter.scene.flags[mujoco.mjtRndFlag.mjRND_SHADOW] = False  # most of the time otherwise
        stream = container.add_stream("libx264", rate=FRAME_RATE)
        stream.width, stream.height = SIZE
        stream.pix_fmt = "yuv420p"
        stream.time_base = Fraction(1, FRAME_RATE)
        stream.options = {"crf": QUALITY, "preset": "veryfast"}
        for row in shown:
            data = poser.set(run.trace[row])
            mujoco.mj_camlight(poser.model, data)
            painter.update_scene(data, camera_at(middle if run.spins else com[row]), options())
            if has_forces:
                add_forces(painter.scene, run.trace[row])
            frame = av.VideoFrame.from_ndarray(painter.render(), format="rgb24")
            container.mux(stream.encode(frame))
        container.mux(stream.encode())
