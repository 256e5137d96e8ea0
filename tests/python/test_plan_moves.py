"""`plan_moves` against random programs, and by name against what nobody can make."""

import itertools
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
import trees_of_tips
from mistakes import Invalid
from move_programs import Turned, arc, draw, faults, line, moves_of, nothing, of_axis, of_vector

import beetle_ik as bik
from beetle_ik.moves import Arc, Joints, Line, Wait

UR5 = bik.Robot.named("ur5e")
HOME = np.array([0.0, -1.5, 1.8, -1.9, -1.57, 0.3])
STARTS = {
    "ur5e": HOME,
    "panda": np.array([0.0, -0.6, 0.0, -2.2, 0.0, 1.8, 0.7]),
    "iiwa14": np.array([0.0, 0.6, 0.0, -1.5, 0.0, 0.9, 0.0]),
}
ACCELERATION, JERK = 5.0, 100.0
LIMITS = bik.Limits(acceleration=ACCELERATION)


def pose(x: float, y: float, z: float, yaw: float = 0.0) -> np.ndarray:
    return bik.pose([x, y, z], rpy=[np.pi, 0.0, yaw])


def shifted(x: float = 0.0, y: float = 0.0, z: float = 0.0) -> np.ndarray:
    moved = UR5.fk(HOME)
    moved[:3, 3] += [x, y, z]
    return moved


def planned(program: list[dict[str, Any]], **given: Any) -> list[str]:
    given = {"limits": LIMITS, "start_q": HOME, **given}
    plan = bik.plan_moves(UR5, moves_of(program), **given)
    assert plan.success
    limits = {"velocity": UR5.velocity_limit, "acceleration": np.full(6, ACCELERATION)}
    return faults(UR5, UR5.fk, program, plan, limits)


@pytest.mark.parametrize("jerk", [False, True], ids=["acceleration", "jerk"])
@pytest.mark.parametrize("name", STARTS)
def test_random_programs_are_made_as_asked(name: str, jerk: bool) -> None:
    robot = bik.Robot.named(name)
    limits = {"velocity": robot.velocity_limit, "acceleration": np.full(robot.dof, ACCELERATION)}
    if jerk:
        limits["jerk"] = np.full(robot.dof, JERK)
    made = 0
    for seed in range(5):
        random = np.random.default_rng(seed)
        start = STARTS[name] + random.uniform(-0.2, 0.2, robot.dof)
        program = draw(robot, start, 6, random)
        given = bik.Limits(acceleration=ACCELERATION, jerk=JERK if jerk else None)
        try:
            plan = bik.plan_moves(robot, moves_of(program), start_q=start, limits=given)
        except bik.InvalidInputError as error:
            said = str(error)
            if "move " not in said:
                raise
            continue
        made += 1
        assert plan.success
        assert faults(robot, robot.fk, program, plan, limits, samples=3000) == []
    assert made >= 3


CONE = 0.1
TASKS: dict[str, tuple[bik.tasks.Task, Turned]] = {
    "spin": (bik.tasks.Pointing(axis=(0.0, 0.0, 2.0)), of_axis(np.eye(3)[2])),
    "cone": (bik.tasks.Pointing(tolerance=(1.0, 1.0, 1.0, CONE)), of_axis(np.eye(3)[2], CONE)),
    "band": (bik.tasks.Pose(tolerance=(1.0, 1.0, 1.0, 0.05, 0.1, np.inf)), of_vector(np.array([0.05, 0.1, np.inf]))),
    "position": (bik.tasks.Position(), nothing),
}


def duration(robot: bik.Robot, program: list[dict[str, Any]], start: np.ndarray) -> float | None:
    """The duration with whole poses (s); None where these cannot be met."""
    try:
        return bik.plan_moves(robot, moves_of(program), start_q=start, limits=LIMITS).trajectory.duration
    except bik.InvalidInputError:
        return None


@pytest.mark.parametrize("task", TASKS)
@pytest.mark.parametrize("name", STARTS)
def test_programs_meet_their_task_and_are_never_slower(name: str, task: str) -> None:
    robot = bik.Robot.named(name)
    limits = {"velocity": robot.velocity_limit, "acceleration": np.full(robot.dof, ACCELERATION)}
    wanted, turned = TASKS[task]
    made = 0
    for seed in range(4):
        random = np.random.default_rng(seed)
        start = STARTS[name] + random.uniform(-0.2, 0.2, robot.dof)
        program = draw(robot, start, 6, random)
        whole = duration(robot, program, start)
        try:
            plan = bik.plan_moves(robot, moves_of(program), start_q=start, limits=LIMITS, task=wanted)
        except bik.InvalidInputError:
            assert whole is None
            continue
        made += 1
        assert plan.success
        assert whole is None or plan.trajectory.duration <= whole
        assert faults(robot, robot.fk, program, plan, limits, samples=3000, turned=turned) == []
    assert made >= 2


# The least motion of the first and the third leads into a singularity or a limit. The others pass a singularity so
# closely that a step of the search can meet another branch of configurations.
FOLLOWABLE = [
    ("iiwa14", [1.0, 0.4, -0.1, 1.1, 1.2, -0.4, 2.3], [-0.2, -0.3, -0.3]),
    ("panda", [1.8, 0.3, 1.9, -0.5, 0.0, 2.6, -1.3], [0.1, 0.1, 0.0]),
    ("panda", [0.2, 0.4, -1.7, -1.4, 0.7, 1.4, 1.7], [0.3, 0.4, 0.1]),
    ("ur5e", [-0.6, -0.7, -2.2, 1.8, -2.3, -1.4], [0.4, -0.3, 0.3]),
    ("ur5e", [-0.7, 2.4, -1.5, -2.2, -2.1, 2.5], [0.2, -0.2, -0.2]),
]


@pytest.mark.parametrize(("name", "start", "way"), FOLLOWABLE)
def test_a_line_that_can_be_followed_is_followed(name: str, start: list[float], way: list[float]) -> None:
    robot = bik.Robot.named(name)
    goal = robot.fk(start)
    goal[:3, 3] += way
    program = [{"kind": "line", "pose": goal, "speed": 0.1}]
    plan = bik.plan_moves(robot, moves_of(program), start_q=start, limits=LIMITS)
    limits = {"velocity": robot.velocity_limit, "acceleration": np.full(robot.dof, ACCELERATION)}
    assert faults(robot, robot.fk, program, plan, limits, samples=3000) == []


def test_random_lines_that_can_be_followed_are_followed() -> None:
    followed = 0
    for name in ("ur5e", "panda", "iiwa14", "gen3"):
        robot = bik.Robot.named(name)
        lower, upper = np.clip(robot.lower, -3.0, 3.0), np.clip(robot.upper, -3.0, 3.0)
        for seed in range(12):
            random = np.random.default_rng(seed)
            start = np.round(lower + (upper - lower) * random.uniform(0.1, 0.9, robot.dof), int(random.integers(1, 4)))
            goal = robot.fk(start)
            goal[:3, 3] += np.round(random.uniform(-0.3, 0.3, 3), 1)
            if not can_follow(robot, start, goal):
                continue
            followed += 1
            assert bik.plan_moves(robot, [Line(goal)], start_q=start, limits=LIMITS).success, (name, seed)
    assert followed >= 8


def can_follow(robot: bik.Robot, start: np.ndarray, goal: np.ndarray) -> bool:
    """Whether small steps with the pseudo-inverse reach the end of a line, with room to the limits."""
    q, begin = start.copy(), robot.fk(start)
    for part in np.linspace(0.0, 1.0, 80)[1:]:
        before = q
        for _ in range(10):
            pose = robot.fk(q)
            skew = 0.5 * (begin[:3, :3] @ pose[:3, :3].T - pose[:3, :3] @ begin[:3, :3].T)
            place = (1 - part) * begin[:3, 3] + part * goal[:3, 3]
            missing = np.r_[place - pose[:3, 3], skew[2, 1], skew[0, 2], skew[1, 0]]
            q = q + np.linalg.pinv(robot.jacobian(q), rcond=1e-6) @ missing
        if np.linalg.norm(missing) > 1e-9 or np.abs(q - before).max() > 0.05:
            return False
        if (q < robot.lower + 0.02).any() or (q > robot.upper - 0.02).any():
            return False
    return bool(np.linalg.norm(goal[:3, 3] - begin[:3, 3]) > 0.01)


def widenable(random: np.random.Generator) -> list[dict[str, Any]]:
    """Moves along the axes by round lengths, each with the `size` that its blends may take up to half of."""
    pose, program = UR5.fk(HOME), list[dict[str, Any]]()
    for _ in range(random.integers(2, 4)):
        kind, size = str(random.choice(["line", "line", "arc", "joints"])), float(random.choice([0.02, 0.05, 0.1]))
        speed = [None, 0.05, 0.25, 2.0][random.integers(4)]
        if kind == "joints":
            goal = HOME + np.round(random.uniform(-0.3, 0.3, 6), 1)
            pose = UR5.fk(goal)
            program.append({"kind": kind, "goal": goal, "size": size})
            continue
        first, second = np.eye(3)[random.permutation(3)[:2]] * random.choice([-1.0, 1.0], 2)[:, None]
        via, pose = pose[:3, 3] + 0.5 * size * (first + second), pose.copy()
        pose[:3, 3] += size * first
        given = {"via": via} if kind == "arc" else {}
        program.append({"kind": kind, "pose": pose, "speed": speed, "size": size, **given})
    return program


@pytest.mark.parametrize("jerk", [None, 100.0], ids=["acceleration", "jerk"])
def test_more_room_never_makes_a_program_slower(jerk: float | None) -> None:
    # Under jerk limits the fastest timing is found to some thousandths.
    most = 1 + 1e-6 if jerk is None else 1.005
    for seed in range(12 if jerk is None else 6):
        random = np.random.default_rng(seed)
        moves, acceleration = widenable(random), float(random.choice([2.0, 5.0, 8.0]))

        def duration(blend: float, speed: float, wider: float, moves: Any = moves, a: float = acceleration) -> float:
            program = []
            for i, move in enumerate(moves):
                given = {key: value for key, value in move.items() if key != "size"}
                if i + 1 < len(moves):
                    given["blend"] = blend * min(move["size"], moves[i + 1]["size"])
                if given.get("speed"):
                    given["speed"] *= speed
                program.append(given)
            limits = bik.Limits(velocity=2.0 * wider, acceleration=a * wider, jerk=jerk and jerk * wider)
            return bik.plan_moves(UR5, moves_of(program), start_q=HOME, limits=limits).trajectory.duration

        steps = [duration(blend, 1.0, 1.0) for blend in (0.0, 0.1, 0.3, 0.5)]
        steps += [duration(0.5, 1.5, 1.0), duration(0.5, 1.5, 1.5)]
        assert all(after <= most * before for before, after in itertools.pairwise(steps)), (seed, steps)


def test_the_place_counts_from_the_start_of_a_blended_move() -> None:
    corner, far = shifted(z=-0.1), shifted(y=2.0, z=-0.1)
    places = []
    for blend in (0.0, 0.01, 0.04):
        with pytest.raises(Invalid, match=r"move 1 cannot be reached: (.*) m along it") as error:
            bik.plan_moves(UR5, [Line(corner, blend=blend), Line(far)], start_q=HOME, limits=LIMITS)
        places.append(float(str(error.value).split(": ")[1].split(" m along")[0]))
    assert np.ptp(places) < 5e-3


def test_the_judge_notices_what_is_wrong() -> None:
    program = [{"kind": "line", "pose": shifted(z=-0.1), "speed": 0.1}]
    limits = {"velocity": UR5.velocity_limit, "acceleration": np.full(6, ACCELERATION)}
    plan = bik.plan_moves(UR5, moves_of(program), start_q=HOME, limits=LIMITS)
    assert faults(UR5, UR5.fk, program, plan, limits) == []
    slower = [{**program[0], "speed": 0.05}]
    farther = [{**program[0], "pose": shifted(y=0.01, z=-0.1)}]
    tighter = {**limits, "acceleration": np.full(6, 0.5)}
    assert "asked for" in faults(UR5, UR5.fk, slower, plan, limits)[0]
    assert "off its path" in faults(UR5, UR5.fk, farther, plan, limits)[0]
    assert "acceleration" in faults(UR5, UR5.fk, program, plan, tighter)[0]


def test_curves_of_the_judge_pass_their_points() -> None:
    start, end = shifted(), shifted(x=0.1, y=0.1)
    via = shifted(x=0.1)[:3, 3]
    for curve, length in ((line(start, end), 0.1 * np.sqrt(2)), (arc(start, via, end), np.pi * 0.05 * np.sqrt(2))):
        ends = curve.at(np.array([0.0, curve.length]))
        np.testing.assert_allclose(ends, [start[:3, 3], end[:3, 3]], atol=1e-12)
        assert curve.length == pytest.approx(length)
    circle = arc(start, via, end)
    assert np.linalg.norm(circle.at(circle.nearest(via[None])) - via) < 1e-12


def test_a_speed_is_kept_but_for_starting_and_stopping() -> None:
    plan = bik.plan_moves(UR5, [Line(shifted(z=-0.2), speed=0.05)], start_q=HOME, limits=LIMITS)
    [report] = plan.moves
    assert report.speed == pytest.approx(0.05, rel=1e-6)
    assert {bound.limit for bound in report.bound_by} == {"acceleration"}
    assert sum(bound.end - bound.start for bound in report.bound_by) < 0.1
    assert plan.trajectory.duration == pytest.approx(4.0, abs=0.1)


def test_a_speed_under_jerk_limits_is_kept_for_an_instant_too() -> None:
    """The fastest instant is beside the middle of a segment of the trajectory; between segments the speed was right."""
    program = [Line(shifted(z=0.01), speed=0.1, blend=0.002), Line(shifted(z=0.06), speed=0.01)]
    plan = bik.plan_moves(UR5, program, start_q=HOME, limits=bik.Limits(acceleration=4.0, jerk=80.0))
    first = plan.moves[0]
    q, qd, _ = plan.trajectory.at(np.linspace(first.start, first.end, 4001))
    speeds = np.linalg.norm((UR5.jacobian(q)[:, :3] @ qd[:, :, None])[:, :, 0], axis=1)
    way = UR5.fk(q)[:, 2, 3] - shifted()[2, 3]
    assert speeds[way < 0.0079].max() == pytest.approx(0.1, rel=1.3e-3)


def test_a_speed_that_joints_cannot_reach_is_no_error() -> None:
    plan = bik.plan_moves(UR5, [Line(shifted(y=0.3, z=-0.1), speed=15.0)], start_q=HOME, limits=LIMITS)
    [report] = plan.moves
    assert plan.success
    assert 0.1 < report.speed < 5.0
    assert report.bound_by[0].start == 0.0
    assert report.bound_by[-1].end == pytest.approx(plan.trajectory.duration)


def test_a_full_circle_comes_back() -> None:
    start = shifted()
    centre = start[:3, 3] + np.array([0.0, 0.05, 0.0])
    end = shifted(y=0.1)
    via = centre + np.array([0.05, 0.0, 0.0])
    program = [{"kind": "arc", "via": via, "pose": end, "angle": 2 * np.pi, "speed": 0.1}]
    assert planned(program) == []
    plan = bik.plan_moves(UR5, moves_of(program), start_q=HOME, limits=LIMITS)
    np.testing.assert_allclose(UR5.fk(plan.trajectory.at(plan.trajectory.duration)[0]), start, atol=1e-6)


def test_blends_keep_the_speed_through_a_corner() -> None:
    corner = [
        {"kind": "line", "pose": shifted(y=0.1), "speed": 0.05, "blend": 0.02},
        {"kind": "line", "pose": shifted(y=0.1, z=-0.1), "speed": 0.05},
    ]
    assert planned(corner) == []
    sharp = [{**corner[0], "blend": 0.0}, corner[1]]
    assert planned(sharp) == []
    durations = [
        bik.plan_moves(UR5, moves_of(program), start_q=HOME, limits=LIMITS).trajectory.duration
        for program in (corner, sharp)
    ]
    assert durations[0] < durations[1]


def test_the_arm_stops_where_a_blend_would_turn_back() -> None:
    back = [{"kind": "line", "pose": shifted(y=0.1), "speed": 0.1, "blend": 0.02}, {"kind": "line", "pose": shifted()}]
    assert planned(back) == []
    plan = bik.plan_moves(UR5, moves_of(back), start_q=HOME, limits=LIMITS)
    assert np.abs(plan.trajectory.at(plan.moves[0].end)[1]).max() < 1e-9


@pytest.mark.parametrize("yaw", [np.pi / 2, np.pi, -np.pi / 2])
def test_a_turn_on_the_spot_counts_a_tenth_of_a_metre(yaw: float) -> None:
    there, turned = pose(0.4, -0.1, 0.3), pose(0.4, -0.1, 0.3, yaw)
    plan = bik.plan_moves(UR5, [Joints(there), Line(turned, speed=0.02)], start_q=HOME, limits=LIMITS)
    report = plan.moves[1]
    assert report.end - report.start == pytest.approx(abs(yaw) * 0.1 / 0.02, rel=0.02)


def test_moves_to_where_the_arm_is_take_no_time() -> None:
    here = UR5.fk(HOME)
    plan = bik.plan_moves(UR5, [Joints(HOME), Line(here), Wait(0.25), Line(here)], start_q=HOME, limits=LIMITS)
    assert [(report.start, report.end) for report in plan.moves] == [(0.0, 0.0)] * 2 + [(0.0, 0.25), (0.25, 0.25)]
    assert plan.trajectory.duration == 0.25


def test_the_first_joint_move_suits_the_line_after_it() -> None:
    # From some branches and turns of the first pose, a joint meets its limit on the way to the second.
    narrow = UR5.with_limits(lower=[-3.2] * 6, upper=[3.2] * 6)
    found = 0
    for seed in range(20):
        random = np.random.default_rng(seed)
        q = random.uniform(-3.0, 3.0, 6)
        first = narrow.fk(q)
        second = first.copy()
        second[:3, 3] += random.uniform(-0.2, 0.2, 3)
        try:
            plan = bik.plan_moves(narrow, [Joints(first), Line(second)], start_q=HOME, limits=LIMITS)
        except bik.InvalidInputError as error:
            said = str(error)
            if "move " not in said:
                raise
            continue
        found += 1
        q = plan.trajectory.sample(0.01)[1]
        assert (np.abs(q) <= 3.2 + 1e-9).all()
    assert found >= 12


SLOW = Line(shifted(z=-0.1), speed=0.05)
WRONG: list[tuple[list[Any], str]] = [
    (
        [Arc(UR5.fk(HOME)[:3, 3], shifted(y=0.1))],
        "move 0: an arc needs three points, and its start is via: for a full circle give another point of it as "
        "the end, and the angle",
    ),
    (
        [Arc(shifted(x=0.1)[:3, 3], UR5.fk(HOME))],
        "move 0: an arc needs three points, and its start is its end: for a full circle give another point of it "
        "as the end, and the angle",
    ),
    (
        [Line(shifted(y=0.1), blend=0.2), Line(shifted())],
        "move 0: its blend of 0.2 m does not fit into move 0, which is 0.1000 m long: make the blend smaller",
    ),
    (
        [Line(shifted(y=0.1), blend=0.01), Line(shifted(y=0.1))],
        "move 0: its blend has no room, because move 1 ends where it begins: leave that out, or give no blend",
    ),
    (
        [
            Line(shifted(y=0.1), blend=0.06, name="a"),
            Line(shifted(y=0.1, z=0.1), blend=0.06, name="b"),
            Line(shifted()),
        ],
        "move 1 'b': its blend of 0.06 m, with the blend at its other end, does not fit into move 1 'b', which is "
        "0.1000 m long: make the blend smaller",
    ),
]


WRONG_NUMBERS: list[tuple[Callable[[], Any], str]] = [
    (lambda: Line(shifted(), speed=-1.0, name="in"), "speed of move 'in' must be positive and finite, got -1"),
    (lambda: Line(shifted(), speed=np.nan), "speed must be positive and finite, got NaN"),
    (lambda: Line(shifted(), blend=-0.1), "blend must be zero or more and finite, got -0.1"),
    (lambda: Arc(HOME[:3], shifted(), speed=0.0), "speed must be positive and finite, got 0"),
    (lambda: Arc(HOME[:3], shifted(), angle=-np.pi), "angle must be positive and finite, got -3.141592653589793"),
    (lambda: Arc(HOME[:3] * np.nan, shifted()), "via must be finite, but entry 0 is NaN"),
    (lambda: Joints(HOME, blend=np.inf), "blend must be zero or more and finite, got inf"),
    (lambda: Joints(HOME * np.nan), "joint positions must be finite, but entry 0 is NaN"),
    (lambda: Wait(-1.0, name="rest"), "time of move 'rest' must be from 0 to 1000000 s, got -1"),
    (lambda: Wait(np.inf), "time must be from 0 to 1000000 s, got inf"),
]


@pytest.mark.parametrize(("make", "message"), WRONG_NUMBERS, ids=[message for _, message in WRONG_NUMBERS])
def test_wrong_numbers_are_refused_where_a_move_is_made(make: Callable[[], Any], message: str) -> None:
    with pytest.raises(Invalid) as caught:
        make()
    assert str(caught.value) == message


@pytest.mark.parametrize(("program", "message"), WRONG, ids=[message[:30] for _, message in WRONG])
def test_wrong_moves_are_named(program: list[Any], message: str) -> None:
    with pytest.raises(Invalid) as caught:
        bik.plan_moves(UR5, program, start_q=HOME, limits=LIMITS)
    assert str(caught.value) == message


def test_a_line_out_of_reach_says_where() -> None:
    with pytest.raises(Invalid, match=r"^move 0 'out' cannot be reached: 0.* m along it, no solution") as caught:
        bik.plan_moves(UR5, [Line(shifted(x=-0.9), name="out")], start_q=HOME, limits=LIMITS)
    assert "(no configuration has this pose)" in str(caught.value)


@pytest.mark.parametrize("yaw", [0.0, 1.0, 2.0])
def test_a_line_that_leaves_the_reach_says_where_it_ends(yaw: float) -> None:
    start, end = bik.pose([0.4, -0.1, 0.3], rpy=[0.8, 0.5, yaw]), bik.pose([1.4, 0.0, 0.3], rpy=[0.8, 0.5, yaw])
    q = bik.solve(UR5, start).q
    with pytest.raises(Invalid, match=r"^move 0 cannot be reached: .* m along it, no solution") as caught:
        bik.plan_moves(UR5, [Line(end)], start_q=q, limits=LIMITS)
    along = float(str(caught.value).split()[5])
    way = (end - start)[:3, 3] / np.linalg.norm((end - start)[:3, 3])

    def has_solution(length: float) -> bool:
        place = start.copy()
        place[:3, 3] += length * way
        return bik.solve(UR5, place).success

    assert has_solution(along - 0.003)
    assert not has_solution(along + 0.003)
    assert not any(has_solution(length) for length in np.linspace(along + 0.01, 1.0, 20))


@pytest.mark.parametrize("blend", [1e-12, 1e-9, 9e-6])
def test_a_blend_below_what_paths_are_kept_to_is_a_stop(blend: float) -> None:
    program = [Line(shifted(y=0.1), blend=blend), Line(shifted(y=0.1, z=0.1))]
    plan = bik.plan_moves(UR5, program, start_q=HOME, limits=LIMITS)
    stopped = bik.plan_moves(UR5, [Line(shifted(y=0.1)), program[1]], start_q=HOME, limits=LIMITS)
    assert plan.trajectory == stopped.trajectory
    _, qd, _ = plan.trajectory.at(plan.moves[0].end)
    assert np.abs(qd).max() < 1e-9


def test_reports_say_what_a_move_does() -> None:
    program = [Line(shifted(y=0.1)), Wait(0.5), Line(shifted(y=0.1), name="nowhere"), Joints(HOME)]
    plan = bik.plan_moves(UR5, program, start_q=HOME, limits=LIMITS)
    said = [report.message for report in plan.moves]
    assert said[1:3] == ["the arm rests", "the arm rests"]
    assert said[0] == f"up to {plan.moves[0].speed:.4f} m/s between blends"
    assert repr(plan.moves[1]).endswith(" s, the arm rests>")
    short = [Line(shifted(y=0.1), blend=0.02), Line(shifted(y=0.1, z=0.04), blend=0.02), Line(shifted(z=0.04))]
    plan = bik.plan_moves(UR5, short, start_q=HOME, limits=LIMITS)
    assert [report.message for report in plan.moves][1] == "wholly in blends"
    assert plan.moves[1].speed == 0.0


def test_a_joint_that_meets_its_limit_is_named() -> None:
    narrow = UR5.with_limits(lower=HOME - 0.2, upper=HOME + 0.2)
    with pytest.raises(Invalid, match=r"a motion along move 0 was not found: .* joint 'shoulder_pan_joint' would have"):
        bik.plan_moves(narrow, [Line(shifted(y=0.3))], start_q=HOME, limits=LIMITS)
    with pytest.raises(Invalid, match=r"; no other configuration helps: 0.* m along it, no solution \(all 8"):
        bik.plan_moves(narrow, [Line(shifted(y=0.3))], start_q=HOME, limits=LIMITS)


def test_a_line_through_an_obstacle_is_refused_by_name() -> None:
    thick = UR5.with_capsules(radius=0.04)
    tip = shifted(z=-0.1)[:3, 3]
    ball = bik.obstacles.Sphere(tip - [0.0, 0.0, 0.05], 0.04)
    with pytest.raises(Invalid, match=r"a motion along move 0 'in' was not found: .* obstacle 0 .Sphere."):
        bik.plan_moves(thick, [Line(shifted(z=-0.1), name="in")], start_q=HOME, limits=LIMITS, obstacles=[ball])


def test_a_joint_move_goes_around_an_obstacle() -> None:
    thick = UR5.with_capsules(radius=0.04)
    there = HOME + 1.5 * np.eye(6)[0]
    post = bik.obstacles.Sphere(thick.fk(HOME + 0.75 * np.eye(6)[0])[:3, 3], 0.05)
    program = [Joints(there, name="over"), Line(thick.fk(there) @ bik.pose([0.0, 0.0, -0.05]), speed=0.1)]
    plan = bik.plan_moves(thick, program, start_q=HOME, limits=LIMITS, obstacles=[post])
    assert plan.success
    q = plan.trajectory.sample(0.005)[1]
    assert bik.obstacles.clearance(thick, q, [post]).min() > 1e-3


def test_what_is_to_be_kept_holds_or_is_refused() -> None:
    flat = bik.Keep(UR5.fk(HOME)[:3, 3], bik.tasks.Position(tolerance=[np.inf, np.inf, 0.01]))
    across = [Line(shifted(y=0.1), speed=0.1, name="across")]
    plan = bik.plan_moves(UR5, across, start_q=HOME, limits=LIMITS, keep=flat)
    assert plan.success
    assert plan.kept[0][1][2] < 2e-4
    with pytest.raises(Invalid, match=r"a motion along move 0 'down' was not found: .* to be kept"):
        bik.plan_moves(UR5, [Line(shifted(z=-0.1), name="down")], start_q=HOME, limits=LIMITS, keep=flat)


def test_a_program_is_not_retimed() -> None:
    plan = bik.plan_moves(UR5, [SLOW], start_q=HOME, limits=LIMITS)
    with pytest.raises(bik.InfeasibleError, match="a program keeps the speeds of its moves"):
        plan.retime(bik.Limits(acceleration=1.0))


def test_moves_show_what_they_were_made_of() -> None:
    assert repr(Wait(0.5, name="w")) == "moves.Wait(0.5, name='w')"
    assert repr(Line(np.eye(4), speed=0.1)) == "moves.Line(pose at [0.0, 0.0, 0.0], speed=0.1)"
    assert Joints([0.0, 1.0], blend=0.1) == Joints([0.0, 1.0], blend=0.1)
    assert Joints([0.0, 1.0]) != Joints([0.0, 1.5])
    with pytest.raises(Invalid, match=r"moves.1. must be one of beetle_ik.moves, got"):
        bik.plan_moves(UR5, [SLOW, "down"], start_q=HOME, limits=LIMITS)  # type: ignore[list-item]


def test_a_huge_arm_keeps_the_speed_of_a_short_line_before_a_blend() -> None:
    # The corner of the joints is long beside the line, and its spline rang into it: 0.36 % too fast.
    a, d = 300.0 * np.array([0.0, -0.425, -0.392, 0.0, 0.0, 0.0]), 300.0 * np.array([0.089, 0, 0, 0.109, 0.095, 0.082])
    alpha = [np.pi / 2, 0.0, 0.0, np.pi / 2, -np.pi / 2, 0.0]
    with pytest.warns(bik.UnitsWarning):
        huge = bik.Robot.from_dh(a=a, alpha=alpha, d=d, convention="standard", velocity=np.ones(6))
    q = np.array([0.3, -1.5, 1.8, -1.9, -1.2, 0.3])
    begin, end = huge.fk(q), huge.fk(q)
    end[0, 3] -= 0.01
    away = np.array([0.07, -0.03, 0.04, 0.05, 0.02, -0.004])
    program = [Line(end, speed=0.01, blend=0.002), Joints(q + away)]
    plan = bik.plan_moves(huge, program, start_q=q, limits=bik.Limits(acceleration=4.0))
    tip = huge.fk(plan.trajectory.at(np.linspace(0.0, plan.moves[0].end, 4001))[0])[:, :3, 3]
    before_blend = np.linalg.norm(tip - begin[:3, 3], axis=1) < 0.0079
    speed = np.linalg.norm(np.diff(tip, axis=0), axis=1) * 4000 / plan.moves[0].end
    assert speed[before_blend[1:]].max() == pytest.approx(0.01, rel=2e-4)


def test_a_tip_rests_between_its_own_moves() -> None:
    # Arms without a closed form, whose poses are met by a search up to its tolerance.
    axes = ("0.1 0.2 1", "0.2 1 0.1", "0.3 1 -0.2", "1 0.1 0.2", "-0.2 1 0.3", "0.1 -0.1 1", "1 0.2 0.3")
    joints = [(axis, (0.03, 0.02 * i, 0.15)) for i, axis in enumerate(axes)]
    arms = [trees_of_tips.limb(tip, "floor", tip, joints, 2.0) for tip in ("left", "right")]
    robot = bik.Robot.from_urdf(
        f"<robot name='pair'><link name='floor'/>{''.join(arms)}</robot>", tip=["left", "right"]
    )
    own, rng = [robot.joint_names.index(f"left_{i}") for i in range(7)], np.random.default_rng(4)
    for _ in range(5):
        start = rng.uniform(-0.8, 0.8, robot.dof)
        poses = robot.fk(start + rng.uniform(-0.2, 0.2, robot.dof))
        program = [
            Joints(poses[0], tip="left"),
            Joints(poses[1], tip="right", name="other"),
            Line(poses[0] @ bik.pose(rng.uniform(-0.02, 0.02, 3)), speed=0.05, tip="left"),
        ]
        plan = bik.plan_moves(robot, program, start_q=start, limits=LIMITS)
        other = next(move for move in plan.moves if move.name == "other")
        q = plan.trajectory.at(np.linspace(other.start, other.end, 50))[0]
        assert np.ptp(q[:, own], axis=0).max() < 1e-9
