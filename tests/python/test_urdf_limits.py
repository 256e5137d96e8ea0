"""Limits of a URDF: rates of URDF 1.2, joints without limits, and speeds of zero or none in every call."""

import pickle

import numpy as np
import pytest

import beetle_ik as bik

AXES = ("0 0 1", "0 1 0", "0 1 0", "0 0 1", "0 1 0", "0 0 1")
NAMED = ", ".join(f"'j{i}'" for i in range(1, 7))
START, GOAL = np.zeros(6), np.array([0.3, 0.2, 0.5, 0.1, 0.2, 0.1])


def arm(limit: str, *, kind: str = "revolute") -> str:
    """Returns an arm of six joints "j1" to "j6", each with this element `limit`."""
    links = ["base", "a", "b", "c", "d", "e", "tip"]
    joints = "".join(
        f"<link name='{child}'/>\n<joint name='j{i}' type='{kind}'><parent link='{parent}'/><child link='{child}'/>"
        f"<origin xyz='0.02 0 0.15'/><axis xyz='{axis}'/>{limit}</joint>"
        for i, (parent, child, axis) in enumerate(zip(links, links[1:], AXES, strict=False), 1)
    )
    return f"<robot name='arm'><link name='base'/>{joints}</robot>"


def loaded(limit: str, **options: str) -> bik.Robot:
    return bik.Robot.from_urdf(arm(limit, **options))


RANGE = "lower='-2' upper='2'"
NUMBERS = (0.5, 1.0, 2.0, 1e-3, 1e6, 0.123)


def test_rates_of_urdf_1_2_are_rated_limits() -> None:
    for acceleration in (None, *NUMBERS):
        for deceleration in (None, *NUMBERS):
            for jerk in (None, 30.0):
                given = {"acceleration": acceleration, "deceleration": deceleration, "jerk": jerk}
                attributes = " ".join(f"{name}='{value}'" for name, value in given.items() if value is not None)
                rated = loaded(f"<limit {RANGE} velocity='1' effort='5' {attributes}/>").rated_limits
                known = [value for value in (acceleration, deceleration) if value is not None]
                assert rated.velocity.tolist() == [1.0] * 6
                assert (rated.acceleration is None) == (not known)
                if known:
                    assert rated.acceleration.tolist() == [min(known)] * 6
                assert jerk == (None if rated.jerk is None else rated.jerk[0])


def test_rates_of_a_file_count_only_where_they_are_given() -> None:
    robot = loaded(f"<limit {RANGE} velocity='1' acceleration='2' deceleration='0.5' jerk='30'/>")
    assert robot.limits == loaded(f"<limit {RANGE} velocity='1'/>").limits
    plan = bik.plan_point_to_point(robot, start_q=START, end_q=GOAL, limits=robot.rated_limits)
    assert np.all(plan.trajectory.max_acceleration() <= 0.5 * (1 + 1e-9))


def test_a_follower_limits_the_rates_of_its_master() -> None:
    text = arm(f"<limit {RANGE} velocity='1' acceleration='2' jerk='8'/>")
    text = text.replace("<axis xyz='0 0 1'/>", "<axis xyz='0 0 1'/><mimic joint='j2' multiplier='-4'/>", 2)
    rated = bik.Robot.from_urdf(text).rated_limits
    assert (rated.acceleration[0], rated.jerk[0], rated.velocity[0]) == (0.5, 2.0, 0.25)


def test_a_negative_rate_is_refused_with_its_line() -> None:
    for rate in ("acceleration", "deceleration", "jerk"):
        with pytest.raises(bik.UrdfError) as told:
            loaded(f"<limit {RANGE} {rate}='-1'/>")
        assert str(told.value) == f"URDF line 2: limit {rate} of joint 'j1' is -1: a limit cannot be negative"


def test_a_joint_without_limit_is_refused_with_its_line() -> None:
    remedies = {
        "revolute": 'give lower and upper, or write <joint type="continuous">',
        "prismatic": "give lower and upper, perhaps -inf and inf",
    }
    for kind, remedy in remedies.items():
        with pytest.raises(bik.UrdfError) as told:
            loaded("", kind=kind)
        assert str(told.value) == f"URDF line 2: joint 'j1' is {kind} and has no <limit>, which URDF requires: {remedy}"
    assert loaded("", kind="continuous").joint_kinds == ["continuous"] * 6


def test_a_follower_needs_no_limit_of_its_own() -> None:
    limit = f"<limit {RANGE}/>"
    text = arm(limit).replace(f"<axis xyz='0 1 0'/>{limit}", "<axis xyz='0 1 0'/><mimic joint='j1'/>", 1)
    assert bik.Robot.from_urdf(text).joint_names == ["j1", "j3", "j4", "j5", "j6"]


def test_a_joint_without_limit_beside_the_chain_is_held() -> None:
    finger = (
        "<link name='f'/><joint name='finger' type='revolute'><parent link='tip'/><child link='f'/></joint></robot>"
    )
    text = arm(f"<limit {RANGE}/>").replace("</robot>", finger)
    assert bik.Robot.from_urdf(text, tip="tip").held_joints == {"finger": 0.0}


def test_a_revolute_joint_without_a_range_is_continuous() -> None:
    robot = loaded("<limit velocity='1' effort='3'/>")
    assert robot.joint_kinds == ["continuous"] * 6
    assert np.all(np.isinf([robot.lower, robot.upper]))
    assert loaded("<limit upper='1'/>").joint_kinds == ["revolute"] * 6


CALLS = {
    "plan_point_to_point": lambda robot, **o: bik.plan_point_to_point(robot, start_q=START, end_q=GOAL, **o),
    "tpbso": lambda robot, **o: bik.plan_point_to_point(robot, start_q=START, end_q=GOAL, method="tpbso", **o),
    "plan_along_path": lambda robot, **o: bik.plan_along_path(robot, circle(robot), **o),
    "track": lambda robot, **o: bik.track(robot, circle(robot), dt=0.01, start_q=GOAL, **o),
    "Tracker": lambda robot, **o: steps(robot, **o)[-1],
}


def circle(robot: bik.Robot) -> bik.Path:
    return bik.paths.circle(robot.fk(GOAL)[:3, 3], diameter=0.04, duration=4.0)


def steps(robot: bik.Robot, **options: object) -> list[bik.Step]:
    tracker = bik.Tracker(robot, START, dt=0.01, **options)
    return [tracker.step(robot.fk(GOAL)) for _ in range(20)]


@pytest.mark.parametrize("name", CALLS)
def test_a_speed_of_zero_is_named_by_each_call(name: str) -> None:
    robot = loaded(f"<limit {RANGE} velocity='0' effort='0'/>")
    if name in ("track", "Tracker"):
        locked = f": joints {NAMED} cannot move, since the velocity limit in the robot's description is 0: give "
        assert locked + "limits=Limits(velocity=...)" in CALLS[name](robot).message
        return
    with pytest.raises(bik.InvalidInputError) as told:
        CALLS[name](robot)
    assert str(told.value) == (
        f"velocity limit of joints {NAMED} must be positive (the robot's description gives 0): give "
        "limits=Limits(velocity=...), got 0"
    )


def test_one_locked_joint_is_named_where_the_target_is_missed() -> None:
    limit = f"<limit {RANGE} velocity='1'/>"
    robot = bik.Robot.from_urdf(arm(limit).replace(limit, f"<limit {RANGE} velocity='0'/>", 1))
    target = robot.fk(np.array([1.0, 0, 0, 0, 0, 0])) @ bik.pose([0.3, 0.3, 0.0])
    tracker = bik.Tracker(robot, START, dt=0.01)
    locked = "joint 'j1' cannot move, since the velocity limit in the robot's description is 0: "
    step = next(step for step in (tracker.step(target) for _ in range(2000)) if "no nearer" in step.message)
    assert step.message.endswith(locked + "give limits=Limits(velocity=...)")
    assert pickle.loads(pickle.dumps(step)).message == step.message
    assert "cannot move" not in bik.Tracker(robot, START, dt=0.01).step(robot.fk(START)).message


def test_given_limits_of_zero_are_named_as_given() -> None:
    robot = loaded(f"<limit {RANGE} velocity='1'/>")
    for field in ("velocity", "acceleration", "jerk"):
        told = steps(robot, limits=bik.Limits(**{field: 0.0}))[-1].message
        assert f"joints {NAMED} cannot move, since the {field} limit is 0: give limits=Limits({field}=...)" in told


@pytest.mark.parametrize("name", CALLS)
def test_a_joint_without_any_speed_limit_is_refused(name: str) -> None:
    robot = loaded(f"<limit {RANGE}/>")
    with pytest.raises((bik.InvalidInputError, bik.UnsupportedLimit)) as told:
        CALLS[name](robot)
    lacking = (
        f"joints {NAMED} have neither a velocity nor an acceleration limit, so that nothing sets their pace: give "
    )
    if name in ("track", "Tracker"):
        remedy = "limits=Limits(velocity=...), infinite where a joint may jump to any position in one tick"
        assert str(told.value) == lacking + remedy
    elif name == "plan_point_to_point":
        assert str(told.value) == lacking + "limits=Limits(velocity=...)"


@pytest.mark.parametrize("name", ["track", "Tracker"])
def test_infinite_velocity_limits_allow_jumps_when_given(name: str) -> None:
    robot = loaded(f"<limit {RANGE}/>")
    assert CALLS[name](robot, limits=bik.Limits(velocity=np.inf)).success
    assert CALLS[name](robot, limits=bik.Limits(acceleration=5.0)) is not None
    for silent in (bik.Limits(lower=-1.0), robot.rated_limits):
        with pytest.raises(bik.InvalidInputError, match="so that nothing sets their pace"):
            CALLS[name](robot, limits=silent)
