"""Exports, read back with the readers of their formats."""

import json

import av
import numpy as np
import pyarrow.csv
import pyarrow.parquet
import pytest
from mcap.reader import make_reader
from mcap_protobuf.decoder import DecoderFactory

from pirouette.export import write
from pirouette.export.tables import flat_columns
from pirouette.run_folder import load


@pytest.fixture(scope="module")
def run(spin_folder):
    return load(spin_folder)


@pytest.fixture(scope="module")
def messages(spin_folder, tmp_path_factory):
    """Per topic the log times (ns) and messages of the MCAP file, in its order."""
    file = write(spin_folder, "mcap", tmp_path_factory.mktemp("mcap") / "run.mcap")
    topics = {}
    with file.open("rb") as stream:
        reader = make_reader(stream, decoder_factories=[DecoderFactory()])
        for schema, channel, message in reader.iter_messages():
            decoder = DecoderFactory().decoder_for(channel.message_encoding, schema)
            decode = decoder or json.loads
            times, values, names = topics.setdefault(channel.topic, ([], [], set()))
            times.append(message.log_time)
            values.append(decode(message.data))
            names.add(schema.name)
    return topics


def test_every_row_of_the_trace_is_a_message_of_every_topic(messages, run):
    expected = [round(time * 1e9) for time in run.trace["time"]]
    topics = messages.keys() - {"/scene"}
    assert len(topics) == 7
    assert all(messages[topic][0] == expected for topic in topics)


def test_topics_carry_foxglove_schemas(messages):
    schemas = {topic: names for topic, (_, _, names) in messages.items()}
    assert schemas["/tf"] == {"foxglove.FrameTransforms"}
    assert schemas["/joint_states"] == {"foxglove.JointStates"}
    assert schemas["/trunk/true"] == schemas["/com/plan"] == {"foxglove.PoseInFrame"}


def test_the_json_topic_is_the_trace_bit_for_bit(messages, run):
    rows = messages["/trace"][1]
    for name in run.trace.dtype.names:
        assert np.array_equal([row[name] for row in rows], run.trace[name]), name


def test_joint_states_are_the_true_joints_by_name(messages, run):
    states = messages["/joint_states"][1]
    first = ["FR_abad", "FR_hip", "FR_knee", "FL_abad"]
    assert [joint.name for joint in states[0].joints][:4] == first
    position = np.array([[joint.position for joint in state.joints] for state in states])
    assert np.array_equal(position, run.trace["true_joint_position"].reshape(-1, 12))


def test_transforms_chain_from_the_world_to_the_shank(messages, run):
    last = messages["/tf"][1][-1].transforms
    parents = {t.child_frame_id: t.parent_frame_id for t in last}
    assert parents["trunk"] == parents["estimate"] == "world"
    trunk = next(t for t in last if t.child_frame_id == "trunk").translation
    assert np.array_equal([trunk.x, trunk.y, trunk.z], run.trace["true_base_position"][-1])
    frame = "RL_shank"
    for _ in range(4):
        frame = parents[frame]
    assert frame == "world"


def test_the_scene_holds_robot_and_ground_in_frames_of_the_transforms(messages, run):
    times, (scene,), schemas = messages["/scene"]
    assert (times, schemas) == ([0], {"foxglove.SceneUpdate"})
    frames = {t.child_frame_id for t in messages["/tf"][1][0].transforms}
    bodies = {entity.frame_id: entity for entity in scene.entities}
    assert bodies.keys() - frames == {"world"}
    assert {"trunk", "FR_thigh", "RL_shank"} <= bodies.keys()
    reach = [point.x for part in bodies["trunk"].triangles for point in part.points]
    assert np.ptp(reach) == pytest.approx(0.354, abs=0.01)  # m, with the motors
    assert all(max(part.indices) < len(part.points) for part in bodies["world"].triangles)


@pytest.mark.parametrize(
    ("kind", "read"),
    [("csv", pyarrow.csv.read_csv), ("parquet", pyarrow.parquet.read_table)],
)
def test_tables_hold_every_number_of_the_trace(spin_folder, run, tmp_path, kind, read):
    table = read(write(spin_folder, kind, tmp_path / "table"))
    columns = flat_columns(run.trace)
    assert table.column_names == list(columns)
    for name, values in columns.items():
        assert np.array_equal(table[name].to_numpy(), values), name
    foot = table["true_foot_position_RL_2"].to_numpy()
    assert np.array_equal(foot, run.trace["true_foot_position"][:, 3, 2])


def test_the_video_is_as_long_as_the_run_and_moves(spin_folder, run, tmp_path):
    with av.open(str(write(spin_folder, "video", tmp_path / "run.mp4"))) as container:
        frames = [frame.to_ndarray(format="gray") for frame in container.decode(video=0)]
        duration = float(container.duration / av.time_base)
    # One frame more or less than the run.
    assert duration == pytest.approx(run.trace["time"][-1] - run.trace["time"][0], abs=2 / 30)
    assert frames[0].std() > 10
    difference = np.abs(frames[-1].astype(int) - frames[0].astype(int))
    assert (difference > 40).mean() > 0.01
