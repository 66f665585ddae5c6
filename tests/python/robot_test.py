"""Poses of the robot against what the simulator wrote, and the ground below it."""

import mujoco
import numpy as np
import pytest

from pirouette.ground import Ground, trend_of
from pirouette.robot import Poser, load_model, visible_shapes
from pirouette.run_folder import LEGS, load
from pirouette.signals import TURN, in_heading, turn_average


@pytest.fixture(scope="module")
def run(spin_folder):
    return load(spin_folder)


def test_feet_are_where_the_simulator_had_them(run):
    poser = Poser(load_model(run))
    spheres = {leg: poser.model.geom(f"{leg}_foot").id for leg in LEGS}
    for row in run.trace[::50]:
        data = poser.set(row)
        feet = [data.geom_xpos[spheres[leg]] for leg in LEGS]
        assert feet == pytest.approx(row["true_foot_position"], abs=1e-12)  # rounding


def test_poses_in_the_parents_axes_compose_to_the_world(run):
    poser = Poser(load_model(run))
    data = poser.set(run.trace[-1])
    for body in range(1, poser.model.nbody):
        parent = poser.model.body_parentid[body]
        position, quaternion = poser.parent_pose(body)
        world, attitude = np.zeros(3), np.zeros(4)
        mujoco.mju_rotVecQuat(world, position, data.xquat[parent])
        mujoco.mju_mulQuat(attitude, data.xquat[parent], quaternion)
        assert data.xpos[parent] + world == pytest.approx(data.xpos[body], abs=1e-12)
        assert attitude == pytest.approx(data.xquat[body], abs=1e-12)


def test_no_collision_shape_is_visible(run):
    model = load_model(run)
    trunk = Poser(model).trunk
    low, high = np.array([mesh.bounds for mesh in visible_shapes(model, trunk).values()]).swapaxes(
        0, 1
    )
    # The collision box is 0.28 m long; the motors beyond it make the looks longer.
    assert np.ptp([low.min(axis=0)[0], high.max(axis=0)[0]]) == pytest.approx(0.354, abs=0.01)


@pytest.mark.parametrize("terrain", ["slope:10", "stairs:0.03x0.20@30", "slope:5+rough:0.02"])
def test_the_ground_goes_on_beyond_the_heights_of_the_run(terrain):
    wide, narrow = np.linspace(-3.0, 3.0, 61), np.linspace(-1.5, 1.5, 31)
    whole = trend_of(terrain)(*np.meshgrid(wide, wide))
    known = Ground.square(trend_of(terrain)(*np.meshgrid(narrow, narrow)), 1.5, terrain)
    assert known.sampled(wide, wide).z == pytest.approx(whole, abs=1e-9)


def test_stairs_rise_between_treads_and_uphill_of_the_start():
    stairs = trend_of("stairs:0.03x0.20")
    x = np.array([-0.11, -0.09, 0.0, 0.09, 0.11, 0.29, 0.31])
    assert stairs(x, 0.0 * x) == pytest.approx([-0.03, 0, 0, 0, 0.03, 0.03, 0.06])
    turned = trend_of("stairs:0.03x0.20@90")
    assert turned(0.0 * x, x) == pytest.approx(stairs(x, 0.0 * x))


def test_uneven_ground_is_drawn_with_more_lines_than_a_plane(simulate):
    low, high = np.array([-0.5, -0.2]), np.array([0.5, 0.2])
    slope = load(simulate("slope", "spin", "--terrain", "slope:10")).ground.cropped(low, high, 0.1)
    assert (len(slope.x), len(slope.y)) == (11, 5)
    stairs = Ground.square(np.zeros((2, 2)), 1e-3, "stairs:0.03x0.20").cropped(low, high, 0.1)
    assert (len(stairs.x), len(stairs.y)) == (101, 41)


def test_a_grid_of_heights_has_rows_along_y():
    ground = Ground.square(np.array([[0.0, 1.0], [2.0, 3.0]]), 1.0)
    assert ground.sampled(np.array([1.0]), np.array([-1.0])).z == pytest.approx(1.0)
    assert ground.sampled(np.array([-1.0]), np.array([1.0])).z == pytest.approx(2.0)


def test_tiles_cover_the_ground_once():
    ground = Ground.square(np.zeros((2, 2)), 1.0).cropped(
        np.array([-0.3, -0.3]), np.array([0.3, 0.3]), 0.1
    )
    vertices = ground.vertices()
    faces = np.concatenate(ground.tiles(0.1))
    a, b, c = (vertices[faces[:, i], :2] for i in range(3))
    areas = 0.5 * np.cross(np.pad(b - a, ((0, 0), (0, 1))), np.pad(c - a, ((0, 0), (0, 1))))[:, 2]
    assert areas.min() > 0.0  # seen from above
    assert areas.sum() == pytest.approx(np.ptp(ground.x) * np.ptp(ground.y))


def spinning(turns: float, rows: int = 1000) -> np.ndarray:
    trace = np.zeros(rows, dtype=[("time", "f8"), ("true_rpy", "f8", 3)])
    trace["time"] = np.linspace(0.0, 10.0, rows)
    trace["true_rpy"][:, 2] = np.linspace(0.0, TURN * turns, rows)
    return trace


def test_the_turn_average_removes_a_circle_and_keeps_a_drift():
    trace = spinning(5.0)
    yaw = trace["true_rpy"][:, 2]
    path = np.stack([np.cos(yaw), np.sin(yaw)], axis=1) + np.outer(trace["time"], [0.1, 0.0])
    time, average = turn_average(trace, path)
    assert average[:, 0] == pytest.approx(0.1 * time, abs=0.01)  # half a sample of the circle
    assert average[:, 1] == pytest.approx(0.0, abs=0.01)


def test_less_than_a_turn_has_no_average():
    trace = spinning(0.9)
    time, average = turn_average(trace, np.zeros((len(trace), 2)))
    assert len(time) == len(average) == 0


def test_heading_axes_turn_with_the_robot():
    left_of_east = in_heading(np.array([[0.0, 1.0]]), np.array([0.0]))
    ahead_when_facing_north = in_heading(np.array([[0.0, 1.0]]), np.array([TURN / 4]))
    assert left_of_east == pytest.approx(np.array([[0.0, 1.0]]))
    assert ahead_when_facing_north == pytest.approx(np.array([[1.0, 0.0]]), abs=1e-12)
