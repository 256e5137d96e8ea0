"""Planned motions: the published planner, its messages, its pictures and its command line."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from mistakes import TURNED
from typer.testing import CliRunner, Result

import beetle_ik as bik
from beetle_ik.cli.app import app
from beetle_ik.figures import plan_figure

ARM = bik.Robot.planar([1.0, 1.0, 1.0])
LIMITS = bik.Limits(velocity=np.pi, acceleration=2 * np.pi)
QUICK = bik.Stop(max_evaluations=3000)
START, END = (1.0, 0.0, 0.0), (0.5, 1.5, 0.0)
CORNER = [[1.0, 1.0, 0.0], [1.3, 1.0, 0.0], [1.3, 1.2, 0.0], [1.1, 1.3, 0.0]]


def between(start: Any = START, end: Any = END, **options: Any) -> bik.Plan:
    return bik.plan_point_to_point(ARM, start, end, **({"method": "tpbso", "limits": LIMITS, "stop": QUICK} | options))


def along(path: Any, **options: Any) -> bik.Plan:
    return bik.plan_along_path(ARM, path, **({"method": "tpbso", "limits": LIMITS, "stop": QUICK} | options))


def test_a_plan_is_at_rest_at_both_ends_and_keeps_the_limits() -> None:
    plan = between()
    assert plan.success
    assert plan.status == bik.Status.SOLVED
    assert plan.message == f"planned with a duration of {plan.cost:.3f} s"
    assert plan.cost == plan.trajectory.duration
    q, qd, _ = plan.trajectory.at([0.0, plan.trajectory.duration])
    np.testing.assert_allclose(ARM.fk(q)[:, :3, 3], [START, END], atol=1e-9)
    np.testing.assert_allclose(qd, 0.0, atol=1e-9)
    assert (plan.trajectory.max_velocity() <= np.pi * (1 + 1e-9)).all()
    assert (plan.trajectory.max_acceleration() <= 2 * np.pi * (1 + 1e-9)).all()
    assert plan.violations == []
    assert plan.evaluations == 3000
    assert np.isnan(plan.accuracy)
    assert np.isnan(plan.clearance)
    assert plan.reference is None
    assert plan.redundancy.shape == (0, 0, 3)


def test_history_falls_to_the_cost() -> None:
    plan = between(objective="joint_travel")
    evaluations, cost = plan.history.T
    assert (np.diff(evaluations) > 0).all()
    assert (np.diff(cost) < 0).all()
    assert cost[-1] == pytest.approx(plan.cost, rel=1e-9)
    assert not plan.history.flags.writeable
    travelled = np.abs(np.diff(plan.trajectory.at(np.linspace(0, plan.trajectory.duration, 4001))[0], axis=0)).sum()
    assert travelled == pytest.approx(plan.cost, rel=1e-4)


def test_elbows_are_bent_as_asked() -> None:
    q = between(method=bik.papers.TPBSO(elbows=(-1, 1))).trajectory.q
    assert q[0, 1] < 0.0 < q[-1, 1]


def test_given_end_configurations_are_kept() -> None:
    q = [0.1, 0.2, 0.3]
    plan = bik.plan_point_to_point(ARM, start_q=q, end=END, method="tpbso", limits=LIMITS, stop=QUICK)
    np.testing.assert_array_equal(plan.trajectory.q[0], q)


@pytest.mark.parametrize(
    "solver", [bik.papers.PSO(), bik.papers.Genetic(), bik.DifferentialEvolution(), bik.papers.BAS()]
)
def test_other_searches_serve(solver: Any) -> None:
    plan = between(method=bik.papers.TPBSO(solver=solver))
    assert plan.evaluations <= 3000
    ends = plan.trajectory.at([0.0, plan.trajectory.duration])[0]
    np.testing.assert_allclose(ARM.fk(ends)[:, :3, 3], [START, END], atol=1e-9)


def test_the_name_tpbso_means_its_defaults() -> None:
    np.testing.assert_array_equal(between(method=bik.papers.TPBSO()).trajectory.q, between().trajectory.q)
    np.testing.assert_array_equal(along(CORNER, method=bik.papers.TPBSO()).trajectory.q, along(CORNER).trajectory.q)
    assert bik.papers.TPBSO() == bik.papers.TPBSO(elbows=(1, 1), solver=None)
    assert repr(bik.papers.TPBSO()) == "TPBSO(elbows=(1, 1), solver=None)"
    assert bik.papers.TPBSO(solver=bik.papers.PSO()) != bik.papers.TPBSO()
    with pytest.raises(bik.InvalidInputError, match=r"^TPBSO has no derivatives: solver must be BAS, "):
        bik.papers.TPBSO(solver=bik.LevenbergMarquardt())  # type: ignore[arg-type]


@pytest.mark.parametrize("keyword", ["elbow", "elbows", "solver"])
def test_options_of_tpbso_are_no_keywords_of_the_call(keyword: str) -> None:
    with pytest.raises(TypeError, match=f"unexpected keyword argument '{keyword}'"):
        between(**{keyword: 1})


def test_a_path_is_followed_with_the_elbow_asked_for() -> None:
    assert (along(CORNER, method=bik.papers.TPBSO(elbows=(-1, -1)), accuracy=0.2).trajectory.q[:, 1] < 0.0).all()


def test_a_path_is_followed_within_the_accuracy() -> None:
    path = bik.paths.polyline(CORNER, 2.0)
    plan = along(path, accuracy=0.05)
    assert plan.success, plan.message
    assert plan.accuracy <= 0.05
    np.testing.assert_allclose(plan.reference, path.sample(0.04)[1], atol=1e-12)
    value, lowest, highest = plan.redundancy[:, 0].T
    assert (lowest <= value).all()
    assert (value <= highest).all()


def test_violations_of_the_best_plan_are_named() -> None:
    plan = bik.plan_along_path(  # two links leave no choice of how to get past the point between
        bik.Robot.planar([1.0, 1.0]),
        [[1.0, 1.0, 0.0], [1.5, 1.0, 0.0], [0.5, 1.0, 0.0]],
        method="tpbso",
        limits=LIMITS,
        accuracy=1e-3,
        stop=QUICK,
    )
    assert not plan.success
    assert plan.status == bik.Status.BUDGET_SPENT
    (missed,) = plan.violations
    assert missed.what == "distance of the tip from the path between points 0 and 1"
    assert (missed.bound, missed.unit) == (1e-3, "m")
    assert missed.value == plan.accuracy
    assert str(missed) == f"{missed.what} is {missed.value:.5f} m, allowed 0.001000 m"
    assert plan.message == (
        f"no plan keeps everything; the least violating one breaks: {missed}; try another seed, a larger budget in "
        'stop=Stop(...), wider limits, a larger accuracy, or for method="tpbso" denser points'
    )


NOT_FINITE = 'finite for method="tpbso": give limits=Limits(velocity=...)'
MISTAKES: list[tuple[Callable[[], Any], str]] = [
    (lambda: between(end=(3.5, 0, 0)), "end cannot be reached: it is 0.5000 m beyond the arm's reach"),
    (
        lambda: bik.plan_point_to_point(bik.Robot.planar([2.0, 0.5]), (0.3, 0, 0), END, method="tpbso", limits=LIMITS),
        "start cannot be reached: it is 1.200 m inside the hole that the arm leaves about its base",
    ),
    (lambda: between(end=None), "no end was given: give end= a position or pose, or end_q="),
    (lambda: between(end_q=[0, 0, 0]), "both end and end_q were given: give one of them"),
    (lambda: between(end=(1, 1, np.nan)), "end must be finite, but coordinate z is NaN"),
    (
        lambda: between(start=(1, 0)),
        "start: expected a pose (4, 4) or a position (3,), got shape (2,); joint angles go to start_q",
    ),
    (
        lambda: between(start=None, start_q=[0, 0, 4]),
        f"start_q: joint 'joint_3' at 4 is outside its limits [-3.141592653589793, 3.141592653589793] by 0.8584 rad: "
        f"{TURNED}",
    ),
    (lambda: between(start=None, start_q=[0, 0]), "start_q of robot 'planar3': expected 3 joints, got 2"),
    (lambda: between(limits=None), f"velocity limit of joint 'joint_1' must be {NOT_FINITE}, got inf"),
    (
        lambda: between(limits=bik.Limits(velocity=[1, 0, 1])),
        "velocity limit of joint 'joint_2' must be positive, got 0",
    ),
    (
        lambda: between(limits=bik.Limits(velocity=[1, 1])),
        "velocity limit: expected one number, or 3 (one per joint), got 2",
    ),
    (
        lambda: between(limits=bik.Limits(velocity=3, jerk=4)),
        'method="tpbso" cannot honour jerk limits: leave them out, and add them with plan.retime(limits)',
    ),
    (
        lambda: between(limits=bik.Limits(velocity=bik.Sinusoid(mean=2, amplitude=1, angular_frequency=1))),
        'method="tpbso" cannot honour time-varying velocity limits: give numbers',
    ),
    (lambda: between(method=3), 'method must be a name, such as "tpbso", or a TPBSO, got 3'),
    (lambda: between(method="fast"), "method must be one of 'minmax', 'tpbso', got 'fast'"),
    (
        lambda: between(objective="energy"),
        "objective must be one of 'time', 'joint_travel', 'tip_travel', got 'energy'",
    ),
    (lambda: bik.papers.TPBSO(elbows=(0, 1)), "elbows[0] must be 1 or -1, the sign of the second joint's angle, got 0"),
    (
        lambda: between(obstacles=[bik.obstacles.Ellipse((0.8, 0.8), (0.0, 0.2))]),
        "semi-axes of the ellipse along x must be positive and finite, got 0",
    ),
    (
        lambda: between(start=None, start_q=[0, 0, 0], obstacles=[bik.obstacles.Ellipse((0.8, 0.1), (0.2, 0.2))]),
        "start_q: link 'link_1' is 0.1000 m inside obstacle 0 (Ellipse)",
    ),
    (lambda: along([[1, 1, 0]]), "path: it needs at least 2 points, got 1"),
    (lambda: along([[1, 1, 0], [1, 1, 0]]), "path: point 1 repeats point 0: leave it out"),
    (
        lambda: along([[1, 1, 0], [4, 1, 0]]),
        "point 1 of the path cannot be reached: it is 1.123 m beyond the arm's reach",
    ),
    (
        lambda: along([[1, 1, 0], [1, 1, 0.1]]),
        "point 1 of the path cannot be reached: it lies beside the plane that the arm moves in",
    ),
    (lambda: along([[1, 1, 0], [1, np.inf, 0]]), "path points must be finite, but y of row 1 is inf"),
    (
        lambda: along([[1, 1], [1, 2]]),
        "path: expected a Path, points (k, 3) or poses (k, 4, 4), got shape (2, 2)",
    ),
    (
        lambda: along(CORNER, method=bik.papers.TPBSO(elbows=(1, -1))),
        "elbows is (1, -1), but along a path the arm keeps one elbow: give one sign twice",
    ),
    (
        lambda: along(CORNER, solver=bik.papers.PSO()),
        'solver is the search of method="timed": give method=TPBSO(solver=...) its own',
    ),
    (lambda: along(CORNER, accuracy=0), "accuracy must be positive and finite, got 0"),
    (
        lambda: along(CORNER, objective="tip_travel"),
        "objective along a path must be one of 'time', 'joint_travel', got 'tip_travel'",
    ),
    (
        lambda: along(CORNER, start_q=[0, 0, 0]),
        "path: start_q puts the tip 2.236 m and 0 rad from the first point; it must be there",
    ),
    (
        lambda: bik.plan_along_path(bik.Robot.named("panda"), CORNER, method="tpbso"),
        'robot \'panda\': method="tpbso" plans along paths for planar arms alone: use method="timed"',
    ),
]


@pytest.mark.parametrize(("call", "message"), MISTAKES, ids=[message[:40] for _, message in MISTAKES])
def test_mistakes_are_told(call: Callable[[], Any], message: str) -> None:
    with pytest.raises(bik.InvalidInputError) as caught:
        call()
    assert str(caught.value) == message


def test_figures_show_arm_search_and_joints(tmp_path: Path) -> None:
    figure = along(bik.paths.circle((1.2, 1.0, 0.0), 0.4, 1.0)).plot()
    assert len(figure.axes) == 7  # with the speed and the turn speed of the tip
    figure.savefig(tmp_path / "plan.png")
    in_space = bik.Robot.named("ur5e")
    plan = bik.plan_point_to_point(in_space, start_q=np.zeros(6), end_q=np.full(6, 0.4), method="tpbso", stop=QUICK)
    assert [axes.name for axes in plan.plot().axes].count("3d") == 1


def run(*arguments: str) -> Result:
    return CliRunner().invoke(app, ["plan", *arguments])


QUICKLY = ("--velocity-limit", "3.14", "--acceleration-limit", "6.28", "--max-evaluations", "3000", "--method", "tpbso")


def test_the_command_plans_from_point_to_point(tmp_path: Path) -> None:
    result = run("point-to-point", "planar5", "--start", "3,0,0", "--end", "2,2,0", *QUICKLY, "--out", str(tmp_path))
    assert result.exit_code == 0, result.output
    assert {file.name for file in tmp_path.iterdir()} == {
        "trajectory.csv",
        "trajectory.npz",
        "plan.png",
        "summary.json",
    }
    assert json.loads((tmp_path / "summary.json").read_text())["success"] is True


def test_the_command_animates_a_plan_around_an_obstacle(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(plan_figure, "_FRAMES_A_SECOND", 2)
    monkeypatch.setattr(plan_figure, "_PAUSE", 0)
    ends = ("--start-q", "0,0,0,0,0", "--end-q", "0.1,0,0,0,0")
    scene = tmp_path / "scene.json"
    scene.write_text('[{"type": "ellipse", "center": [9, 9], "semi_axes": [1, 1]}]')
    files = ("--scene", str(scene), "--animation", "--out", str(tmp_path))
    result = run("point-to-point", "planar5", *ends, *QUICKLY, *files)
    assert result.exit_code == 0, result.output
    assert "smallest clearance [m]" in result.stdout
    assert (tmp_path / "plan.gif").read_bytes().startswith(b"GIF")
    assert "--animation writes a file" in run("point-to-point", "planar5", *ends, "--animation").stderr


def test_the_command_gives_tpbso_its_search() -> None:
    ends = ("--start", "3,0,0", "--end", "2,2,0", "--solver", "pso")
    result = run("point-to-point", "planar5", *ends, *QUICKLY, "--json")
    assert json.loads(result.stdout)["evaluations"] <= 3000
    refused = run("point-to-point", "planar5", *ends)
    assert refused.exit_code == 2
    assert "--solver is the search of --method tpbso; minmax has its own: leave it out" in refused.stderr


def test_the_command_plans_along_a_path() -> None:
    result = run("along-path", "planar5", "--curve", "circle", *QUICKLY, "--json")
    summary = json.loads(result.stdout)
    assert result.exit_code == (0 if summary["success"] else 1)
    assert summary["objective"] == "time"
    assert summary["clearance"] is None


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["point-to-point", "planar5", "--start", "9,0,0", "--end", "2,2,0"], "start cannot be reached"),
        (
            ["point-to-point", "planar5", "--start", "3,0", "--end", "2,2,0"],
            "--start: expected X,Y,Z or X,Y,Z,ROLL,PITCH,YAW",
        ),
        (
            ["point-to-point", "planar5", "--start", "3,0,0"],
            "no end was given: use --end X,Y,Z[,ROLL,PITCH,YAW] or --end-q",
        ),
        (
            ["point-to-point", "planar5", "--start", "3,0,0", "--start-q", "0,0,0,0,0", "--end", "2,2,0"],
            "both --start and --start-q were given: give one of them",
        ),
        (["along-path", "planar5"], "give either --path FILE or --curve with one of circle"),
    ],
)
def test_the_command_names_mistakes(arguments: list[str], message: str) -> None:
    result = run(*arguments, *QUICKLY)
    assert result.exit_code == 2
    assert message in result.stderr
