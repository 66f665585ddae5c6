"""The compiled library from Python: runs, the controller in another loop, the simulation."""

import json
import math
import subprocess
import sys
import threading
import time

import mujoco
import numpy as np
import pytest
from conftest import PROGRAM, ROOT

import pirouette

SHORT = {"turns": 0.25, "set": {"run.settle_time": 0.5}}


@pytest.fixture(scope="module")
def result():
    return pirouette.run(**SHORT)


def test_a_run_is_the_programs_run_bit_for_bit(result, tmp_path):
    out = tmp_path / "run"
    arguments = ["--turns", "0.25", "--set", "run.settle_time=0.5", "--quiet", "--out", out]
    subprocess.run([PROGRAM, "spin", *arguments], check=True)
    trace = np.load(out / "trace.npy")
    assert result.trace.dtype == trace.dtype
    assert result.trace.tobytes() == trace.tobytes()
    metrics = json.loads((out / "metrics.json").read_text())
    assert result.metrics.keys() == metrics.keys()
    assert result.metrics["com"] == metrics["com"]
    again = pirouette.run(out / "run.toml")
    assert again.config == result.config
    assert again.trace.tobytes() == trace.tobytes()


def test_keywords_dicts_and_set_reach_the_configuration():
    result = pirouette.run(
        {"gait": {"period": 0.4}, "run.settle_time": np.float64(0.5)},
        terrain="slope:5",
        rate=-0.9,
        turns=0.1,
        point=(0.01, -0.02),
        sensors="ideal",
        controller="fkm",
        set={"gait.duty": 0.62},
    )
    config = result.config
    assert config["gait"]["period"] == 0.4
    assert config["gait"]["duty"] == 0.62
    assert config["plant"]["terrain"] == "slope:5"
    assert config["plant"]["sensors"]["ideal"] is True
    assert config["run"]["point"] == [0.01, -0.02]
    assert config["run"]["fixed_point"] is True
    assert config["path"]["tracker"] == "none"  # as the bundle says
    assert result.metrics["yaw_rate_mean"] < -0.5
    assert not result.fell


def test_a_radius_becomes_a_velocity():
    config = pirouette.run(radius=0.5, rate=0.6, heading_offset_deg=90, **SHORT).config
    assert config["run"]["velocity"] == [0.0, 0.3]
    assert config["run"]["rate"] == 0.6


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"rate": "fast"}, ["run.rate", '"fast"', "-10 to 10"]),
        ({"rate": None}, ["run.rate", "None"]),
        ({"set": {"gait.dutty": 0.5}}, ["gait.dutty", "did you mean"]),
        ({"set": {"gait.duty": 2, "com.gain": math.nan}}, ["gait.duty", "com.gain", "nan"]),
        ({"gait": 1}, ["gait", "unknown option", "terrain"]),
        ({"terrain": "mud"}, ["plant.terrain", "mud", "slope:"]),
        ({"controller": "best"}, ["controller", "best", "mit"]),
        ({"sensors": "none"}, ["sensors", "none", "ideal"]),
        ({"radius": 1, "speed": 1}, ["speed", "radius"]),
        ({"config": "no/such.toml"}, ["no/such.toml", "no such file"]),
        ({"config": {"run": {"turns": [1, 2]}}}, ["run.turns"]),
    ],
)
def test_what_is_wrong_is_said_in_one_error(arguments, words):
    with pytest.raises(pirouette.Error) as caught:
        pirouette.run(**arguments)
    assert all(word in str(caught.value) for word in words), caught.value
    assert "--" not in str(caught.value)  # no option of the program


def test_the_interpreter_is_free_while_simulating():
    stop, counted = threading.Event(), []

    def count():
        while not stop.wait(0.001):
            counted.append(time.monotonic())

    counter = threading.Thread(target=count)
    counter.start()
    start = time.monotonic()
    pirouette.run(turns=1)
    end = time.monotonic()
    stop.set()
    counter.join()
    ticks = [t for t in counted if start < t < end]
    assert len(ticks) > 50
    assert max(np.diff(ticks)) < 0.5 * (end - start)


def test_runs_in_threads_do_not_disturb_each_other(result):
    traces = [None, None]

    def run(i):
        traces[i] = pirouette.run(**SHORT).trace.tobytes()

    threads = [threading.Thread(target=run, args=(i,)) for i in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert traces == [result.trace.tobytes()] * 2


def test_the_simulation_is_the_run_tick_by_tick(result):
    simulation = pirouette.Simulation(**SHORT)
    ticks = round(0.01 / simulation.period)
    for row in result.trace:
        state = simulation.state
        assert simulation.time == row["time"]
        assert all(np.array_equal(state[name], row[name]) for name in row.dtype.names)
        simulation.step(ticks)


def test_the_simulation_takes_commands_and_pushes():
    simulation = pirouette.Simulation(rate=0.0)
    simulation.step(500)
    before = simulation.state["true_base_velocity"]
    simulation.push((0.0, 0.2, 0.0))
    assert simulation.state["true_base_velocity"] - before == pytest.approx([0, 0.2, 0], abs=1e-9)
    simulation.command = pirouette.MotionCommand(walk=True, v_H=(0.1, 0.0), yaw_rate=-1.0)
    simulation.step(2000)
    assert simulation.state["true_rpy"][2] == pytest.approx(-4.0, abs=0.5)  # the ramp takes 0.7 s
    assert simulation.status == pirouette.ControllerStatus.WALKING
    simulation.reset()
    assert simulation.time == 0.0
    assert simulation.status == pirouette.ControllerStatus.STANDING
    assert simulation.command.v_H == [0.1, 0.0]


def test_the_robot_slides_down_a_slope_that_turns_to_ice():
    simulation = pirouette.Simulation(terrain="slope:10", set={"gait.stand_time": 10})
    simulation.step(500)
    assert abs(simulation.state["true_base_position"][0]) < 0.02
    for wrong in (-0.1, 6.0, math.nan):
        with pytest.raises(pirouette.Error, match="friction: given .*; allowed: 0.0 to 5.0"):
            simulation.set_friction(wrong)
    with pytest.raises(
        pirouette.Error, match="dv_W: given .*; allowed: 0.0 to 10.0 m/s, its length"
    ):
        simulation.push((0.0, math.inf, 0.0))
    simulation.set_friction(0.05)
    simulation.step(400)
    # g (sin 10 deg - 0.05 cos 10 deg) over 0.8 s: 0.39 m
    assert simulation.state["true_base_position"][0] == pytest.approx(-0.39, abs=0.1)


def test_the_ground_is_the_terrains():
    simulation = pirouette.Simulation(terrain="slope:10")
    assert simulation.ground([0.0, 1.0], [0.0, 5.0]) == pytest.approx(
        np.tile([0.0, math.tan(math.radians(10.0))], (2, 1))
    )


def test_metrics_of_a_trace_are_those_of_its_run():
    run = pirouette.run(turns=3, set={"run.trace_rate": 500.0})
    recorded = run.trace[
        run.trace["time"] >= run.metrics["context"]["duration_s"] - 3 * 2 * np.pi / 0.7
    ]
    measured = pirouette.metrics(
        recorded["time"],
        recorded["true_com_position"],
        recorded["true_rpy"][:, 2] % (2 * np.pi),
        yaw_rate=0.7,
        point=[run.metrics["context"]["point_x"], run.metrics["context"]["point_y"]],
        roll=recorded["true_rpy"][:, 0],
    )
    for key in ("radius_mean_mm", "distance_to_point_max_mm", "drift_per_turn_mm"):
        assert measured["com"][key] == pytest.approx(run.metrics["com"][key], rel=1e-2), key
    assert measured["attitude"]["roll_mean"] == pytest.approx(
        run.metrics["attitude"]["roll_mean"], rel=1e-2
    )
    assert "estimator" not in measured
    assert "interrupted" not in measured


def test_metrics_of_a_circle_are_its_own():
    time = np.arange(0.0, 20.0, 0.01)
    yaw = np.pi * time
    com = 0.02 * np.stack([np.cos(yaw), np.sin(yaw)], axis=1)
    measured = pirouette.metrics(time, com, yaw, yaw_rate=np.pi, point=[0.0, 0.0])
    assert measured["com"]["radius_mean_mm"] == pytest.approx(20.0, abs=0.01)
    assert measured["com"]["distance_to_point_max_mm"] == pytest.approx(20.0, abs=0.01)
    assert measured["turns_done"] == pytest.approx(10.0, abs=0.01)
    with pytest.raises(pirouette.Error, match="time"):
        pirouette.metrics(time[::-1], com, yaw, yaw_rate=1.0)
    with pytest.raises(pirouette.Error, match="com"):
        pirouette.metrics(time, com[:5], yaw, yaw_rate=1.0)


def test_readings_are_arrays_of_their_own_memory():
    reading = pirouette.SensorReading()
    reading.joint_position[2, 1] = 0.5
    reading.w_WB_B = (1, 2, 3)
    reading.foot_contact = np.array([True, False, True, False])
    assert reading.joint_position[2].tolist() == [0.0, 0.5, 0.0]
    assert reading.w_WB_B.tolist() == [1.0, 2.0, 3.0]
    assert reading.foot_contact == [True, False, True, False]
    reading.foot_contact = None
    assert reading.foot_contact is None
    with pytest.raises(pirouette.Error, match=r"joint_position: given shape \(12,\).*\(4, 3\)"):
        reading.joint_position = np.zeros(12)


class Robot:
    """The robot of robots/ on a plane, in a loop of MuJoCo's own Python module."""

    def __init__(self, height: float) -> None:
        spec = mujoco.MjSpec.from_file(str(ROOT / "robots/mini_cheetah/mini_cheetah.xml"))
        spec.worldbody.add_geom(type=mujoco.mjtGeom.mjGEOM_PLANE, size=[5, 5, 0.1])
        self.model = spec.compile()
        self.model.opt.timestep = 0.001
        self.data = mujoco.MjData(self.model)
        joints = [
            self.model.joint(f"{leg}_{name}").id
            for leg in ("FR", "FL", "RR", "RL")
            for name in ("abad", "hip", "knee")
        ]
        self.q, self.v = self.model.jnt_qposadr[joints], self.model.jnt_dofadr[joints]
        self.data.qpos[2] = height
        self.data.qpos[self.q] = np.tile([0.0, 0.85, -1.75], 4)
        mujoco.mj_forward(self.model, self.data)

    def reading(self) -> pirouette.SensorReading:
        reading = pirouette.SensorReading()
        rotation = np.zeros(9)
        mujoco.mju_quat2Mat(rotation, self.data.qpos[3:7])
        acceleration = self.data.qacc[:3] + [0.0, 0.0, 9.81]
        reading.time = self.data.time
        reading.joint_position = self.data.qpos[self.q].reshape(4, 3)
        reading.joint_velocity = self.data.qvel[self.v].reshape(4, 3)
        reading.specific_force_B = rotation.reshape(3, 3).T @ acceleration
        reading.w_WB_B = self.data.qvel[3:6]
        return reading

    def hold(self, command: pirouette.JointCommand, period: float) -> None:
        """One control period: the torque law at every physics step, within the motors' limits."""
        for _ in range(round(period / self.model.opt.timestep)):
            torque = command.torque(
                self.data.qpos[self.q].reshape(4, 3), self.data.qvel[self.v].reshape(4, 3)
            )
            self.data.qfrc_applied[self.v] = np.clip(torque.ravel(), -18.0, 18.0)
            mujoco.mj_step(self.model, self.data)


def test_the_controller_turns_a_robot_in_somebody_elses_loop():
    controller = pirouette.Controller(set={"gait.stand_time": 0.0})
    robot = Robot(height=0.29)
    controller.reset(robot.data.qpos[:3], np.eye(3))
    stand = pirouette.MotionCommand()
    spin = pirouette.MotionCommand(walk=True, yaw_rate=0.7)
    for tick in range(round(2.0 / controller.period)):
        command = controller.tick(robot.reading(), stand if tick < 500 else spin)
        robot.hold(command, controller.period)
    assert not controller.stood_down
    up = 1.0 - 2.0 * (robot.data.qpos[4] ** 2 + robot.data.qpos[5] ** 2)
    yaw = 2.0 * math.atan2(robot.data.qpos[6], robot.data.qpos[3])
    assert up > 0.99
    assert yaw == pytest.approx(0.7 - 0.7**2 / 3.0, abs=0.1)  # a ramp of 1.5 rad/s^2
    assert controller.trace["base_position"] == pytest.approx(robot.data.qpos[:3], abs=0.01)


def without_the_compiled_library(code: str) -> subprocess.CompletedProcess:
    return subprocess.run(
        [sys.executable, "-c", f"import sys; sys.modules['pirouette._core'] = None\n{code}"],
        capture_output=True,
        text=True,
        env={"PYTHONPATH": str(ROOT / "python"), "MUJOCO_GL": "egl"},
    )


def test_reports_need_no_compiled_library():
    done = without_the_compiled_library("import pirouette.report.page, pirouette.export.recording")
    assert done.returncode == 0, done.stderr


def test_what_needs_the_compiled_library_says_how_to_get_it():
    done = without_the_compiled_library("import pirouette\npirouette.run()")
    assert "ImportError" in done.stderr
    assert "make python" in done.stderr
    view = "from pirouette.view import main\nsys.argv = ['view']\nsys.exit(main())"
    done = without_the_compiled_library(view)
    assert done.returncode == 2
    assert done.stderr.startswith("error: ")
    assert "make python" in done.stderr


def test_what_is_no_number_is_refused_or_given_back():
    simulation = pirouette.Simulation(terrain="rough:0.04")
    assert np.isnan(simulation.ground([math.nan], [0.0])).all()
    with pytest.raises(pirouette.Error, match="ticks: given -5; allowed: 0 and more"):
        simulation.step(-5)
    with pytest.raises(pirouette.Error, match="com: holds values that are no number"):
        pirouette.metrics([0, 1], [[math.nan] * 3] * 2, [0, 1], yaw_rate=0.7)
    with pytest.raises(pirouette.Error, match="yaw_rate: holds values that are no number"):
        pirouette.metrics([0, 1], [[0.0] * 3] * 2, [0, 1], yaw_rate=math.nan)


def test_a_turn_by_an_angle_is_an_option():
    result = pirouette.run(angle=-30, set={"gait.stand_time": 0.2})
    assert result.metrics["angle_error_deg"] == pytest.approx(0.0, abs=1.0)
    assert result.metrics["context"]["yaw_rate"] == -0.7
