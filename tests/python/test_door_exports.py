"""Trajectories as episodes of LeRobot, messages of MoveIt and bags of ROS 2, read back where the libraries are."""

import importlib.util
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import beetle_ik as bik

NAMES = ["shoulder", "elbow, left", "wrist"]
LIMITS = bik.Limits(velocity=1.0, acceleration=[2.0, 3.0, 4.0], jerk=30.0)


def motion(*, end: float = 1.5) -> bik.Trajectory:
    corners = [[0.0, 0.0, 0.0], [0.5, np.pi / 2, -0.25], [end, 0.5, 1e-7]]
    return bik.time_optimal(corners, LIMITS, joint_names=NAMES)


# --- LeRobot ------------------------------------------------------------------------------------


@pytest.mark.parametrize("fps", [1, 7, 30, 50, 1000])
def test_frames_are_the_motion_in_degrees(fps: int) -> None:
    trajectory = motion()
    features, frames = bik.interop.to_lerobot(trajectory, fps=fps, task="wave", others={"gripper": 50.0})
    names = ["shoulder.pos", "elbow, left.pos", "wrist.pos", "gripper.pos"]
    assert features["action"] == {"dtype": "float32", "shape": (4,), "names": names}
    assert features["observation.state"] == features["action"]
    state = np.array([frame["observation.state"] for frame in frames])
    action = np.array([frame["action"] for frame in frames])
    assert (len(frames) - 2) / fps < trajectory.duration <= (len(frames) - 1) / fps + 1e-6
    times = np.minimum(np.arange(len(frames)) / fps, trajectory.duration)
    np.testing.assert_allclose(state[:, :3], np.rad2deg(trajectory.at(times)[0]), rtol=0, atol=1e-4)
    assert np.all(state[:, 3] == 50.0)
    np.testing.assert_array_equal(action[:-1], state[1:])
    np.testing.assert_allclose(state[-1, :3], np.rad2deg(trajectory.q[-1]), rtol=0, atol=1e-4)
    assert {frame["task"] for frame in frames} == {"wave"}
    assert state.dtype == action.dtype == np.float32


def test_frames_may_be_in_radians() -> None:
    _, frames = bik.interop.to_lerobot(motion(), fps=30, task="wave", degrees=False, joint_names=["a", "b", "c"])
    np.testing.assert_allclose(frames[-1]["action"], motion().q[-1], rtol=0, atol=1e-6)


def test_lerobot_accepts_the_frames() -> None:
    if not all(importlib.util.find_spec(name) for name in ("lerobot", "torch", "datasets")):
        pytest.skip("lerobot, torch or datasets is not installed")
    validate_frame = pytest.importorskip("lerobot.datasets.utils").validate_frame
    features, frames = bik.interop.to_lerobot(motion(), fps=30, task="wave")
    for frame in frames:
        validate_frame(frame, features)


# --- MoveIt -------------------------------------------------------------------------------------


def test_a_message_of_moveit_holds_the_one_of_ros(tmp_path: Path) -> None:
    message = bik.interop.to_moveit(motion(), dt=0.1, frame_id="base", joint_names=["a", "b", "c"])
    joints = bik.interop.to_ros(motion(), dt=0.1, frame_id="base", joint_names=["a", "b", "c"])
    assert message["joint_trajectory"] == joints
    assert message["multi_dof_joint_trajectory"] == {"header": joints["header"], "joint_names": [], "points": []}
    yaml = pytest.importorskip("yaml", reason="PyYAML is not installed")
    (tmp_path / "motion.yaml").write_text(yaml.safe_dump(message))
    assert yaml.safe_load((tmp_path / "motion.yaml").read_text()) == message


# --- bags ---------------------------------------------------------------------------------------


def read(folder: Path) -> dict[str, list[tuple[int, Any]]]:
    """Messages of a bag by topic, with their times (ns)."""
    anyreader = pytest.importorskip("rosbags.highlevel", reason="rosbags is not installed")
    found: dict[str, list[tuple[int, Any]]] = {}
    with anyreader.AnyReader([folder]) as reader:
        for connection, at, raw in reader.messages():
            found.setdefault(connection.topic, []).append((at, reader.deserialize(raw, connection.msgtype)))
    return found


@pytest.mark.parametrize("stamp", [0.0, 1_700_000_000.25])
def test_a_bag_is_read_back_by_rosbags(tmp_path: Path, stamp: float) -> None:
    pytest.importorskip("rosbags", reason="rosbags is not installed")
    trajectory = motion()
    bik.interop.to_rosbag(trajectory, tmp_path / "bag", dt=0.02, stamp=stamp, frame_id="base")
    assert sorted(file.name for file in tmp_path.iterdir()) == ["bag"]
    assert sorted(file.name for file in (tmp_path / "bag").iterdir()) == ["bag.mcap", "metadata.yaml"]
    topics = read(tmp_path / "bag")
    time, q, qd, _ = trajectory.sample(0.02)
    ((begin, whole),) = topics["/joint_trajectory"]
    assert begin == round(stamp * 1e9)
    assert whole.joint_names == NAMES
    assert whole.header.frame_id == "base"
    assert whole.header.stamp.sec + 1e-9 * whole.header.stamp.nanosec == pytest.approx(stamp)
    np.testing.assert_array_equal([point.positions for point in whole.points], q)
    np.testing.assert_array_equal([point.velocities for point in whole.points], qd)
    since = [point.time_from_start.sec + 1e-9 * point.time_from_start.nanosec for point in whole.points]
    np.testing.assert_allclose(since, time, rtol=0, atol=1e-9)
    states = topics["/joint_states"]
    np.testing.assert_allclose([at - begin for at, _ in states], 1e9 * time, rtol=0, atol=1)
    np.testing.assert_array_equal([state.position for _, state in states], q)
    np.testing.assert_array_equal([state.velocity for _, state in states], qd)
    assert {tuple(state.name) for _, state in states} == {tuple(NAMES)}
    assert {len(state.effort) for _, state in states} == {0}


def test_topics_and_names_of_a_bag_may_be_chosen(tmp_path: Path) -> None:
    pytest.importorskip("rosbags", reason="rosbags is not installed")
    names = ["a", "b", "c"]
    bik.interop.to_rosbag(motion(), tmp_path / "bag", joint_names=names, topic="/goal", states="/arm/states")
    topics = read(tmp_path / "bag")
    assert sorted(topics) == ["/arm/states", "/goal"]
    assert topics["/goal"][0][1].joint_names == names


def test_a_bag_is_written_whole_or_not_at_all(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    bags = pytest.importorskip("rosbags.rosbag2", reason="rosbags is not installed")

    def full(*_: object) -> None:
        raise OSError("No space left on device")

    monkeypatch.setattr(bags.Writer, "write", full)
    with pytest.raises(OSError, match="No space left on device"):
        bik.interop.to_rosbag(motion(), tmp_path / "bag")
    assert list(tmp_path.iterdir()) == []


def test_a_bag_never_replaces_another(tmp_path: Path) -> None:
    pytest.importorskip("rosbags", reason="rosbags is not installed")
    (tmp_path / "bag").mkdir()
    with pytest.raises(FileExistsError) as caught:
        bik.interop.to_rosbag(motion(), tmp_path / "bag")
    assert str(caught.value) == f"The folder exists: '{tmp_path / 'bag'}'"
    with pytest.raises(FileNotFoundError) as missing:
        bik.interop.to_rosbag(motion(), tmp_path / "none" / "bag")
    assert str(missing.value) == f"No such folder: '{tmp_path / 'none'}'"
