"""The command line: exit codes, JSON, files, messages."""

import json
import re
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pair_of_pandas import pair_of_pandas
from typer.testing import CliRunner, Result

import beetle_ik as bik
from beetle_ik.cli.app import app

CIRCLE = [
    "--curve",
    "circle",
    "--center",
    "4,1,0",
    "--diameter",
    "1.4",
    "--duration",
    "30",
    "--position-tolerance",
    "4e-5",
]
TRACK = ["track", "planar5", *CIRCLE]
FREE = ["--velocity-limit", "inf"]  # planar5 has no velocity limits of its own
FILES = {"trajectory.csv", "trajectory.npz", "track.png", "summary.json"}


def run(*arguments: str) -> Result:
    return CliRunner().invoke(app, list(arguments))


def refused(*arguments: str) -> str:
    """What is said about wrong input."""
    result = run(*arguments)
    assert (result.exit_code, result.stdout) == (2, "")
    return result.stderr.strip()


def run_json(*arguments: str) -> Any:
    result = run(*arguments, "--json")
    assert result.exit_code == 0, result.output
    return json.loads(result.stdout)


def test_robots_lists_all_built_in_robots() -> None:
    robots = {robot["name"]: robot for robot in run_json("robots")}
    assert set(robots) == set(bik.Robot.names())
    assert len(robots["iiwa14"]["joints"]) == robots["iiwa14"]["dof"] == 7
    assert "iiwa14" in run("robots").stdout


def test_reach_writes_a_map_and_a_picture(tmp_path: Path) -> None:
    out, picture = tmp_path / "map.npz", tmp_path / "map.png"
    options = ["--voxel", "0.2", "--directions", "10", "--rolls", "2"]
    answer = run_json("reach", "ur5e", *options, "--out", str(out), "--picture", str(picture))
    found = bik.ReachabilityMap.load(out, robot=bik.Robot.named("ur5e"))
    assert answer["shape"] == list(found.shape)
    assert answer["orientations"] == 20
    assert answer["voxels_reached"] == int((found.index > 0).sum()) > 100
    assert picture.read_bytes().startswith(b"\x89PNG")
    assert run("reach", "ur5e", *options).stdout.startswith(f"ur5e: {answer['voxels_reached']} of 1728 voxels reached")
    assert refused("reach", "ur5e", "--voxel", "0") == "Error: voxel must be positive and finite, got 0"


def test_fk_gives_the_pose() -> None:
    q = [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7]
    answer = run_json("fk", "iiwa14", "--q", ",".join(map(str, q)))
    assert answer["pose"] == bik.Robot.named("iiwa14").fk(q).tolist()


def test_fk_takes_a_negative_first_angle() -> None:
    assert "position [m]" in run("fk", "planar5", "--q", "-0.1,0,0,0,0").stdout


def test_fk_shows_rounding_noise_as_zero() -> None:
    shown = run("fk", "planar5", "--q", "3.141592653589793,0,0,0,0").stdout
    assert re.search(r"position \[m\] +-5, 0, 0 *\n", shown)


def test_solved_angles_can_be_fed_back() -> None:
    shown = run("solve", "planar5", "--position", "3,1,0").stdout
    q = re.search(r"q \[rad, m\]: (.*)", shown)
    assert q is not None
    pose = run_json("fk", "planar5", "--q", q[1])["pose"]
    assert [row[3] for row in pose[:2]] == pytest.approx([3.0, 1.0], abs=2e-6)


def test_several_tips_take_a_target_each(tmp_path: Path) -> None:
    file, tips = tmp_path / "pair.urdf", ["left_tool", "right_tool"]
    file.write_text(pair_of_pandas())
    pair = bik.Robot.from_urdf(file, tip=tips)
    placed = zip(tips, pair.fk(pair.random_configurations(1)[0]), strict=True)
    targets = [f"--target={tip}={','.join(f'{x:.6f}' for x in pose[:3, 3])}" for tip, pose in placed]
    robot = ["solve", "--urdf", str(file), "--tip", "left_tool", "--tip", "right_tool"]
    assert list(run_json(*robot, *targets)["errors"]) == tips
    assert "position error of left_tool [m]" in run(*robot, *targets).stdout
    assert refused(*robot, "--target", "left_tool=1,2").endswith(
        "--target: expected tip=x,y,z or tip=x,y,z,roll,pitch,yaw, got 'left_tool=1,2'"
    )
    assert refused(*robot).endswith(
        "no target was given: use --position x,y,z, or --target tip=x,y,z for each of several tips"
    )
    assert refused(*robot, *targets, "--position", "1,2,3").endswith(
        "--target gives tips their targets: leave out --position and --rpy"
    )


def test_a_budget_of_evaluations_is_kept() -> None:
    result = run("solve", "iiwa14", "--position", "0,0,0.36", "--max-evaluations", "50", "--json")
    answer = json.loads(result.stdout)
    assert (result.exit_code, answer["status"]) == (1, "BUDGET_SPENT")
    assert answer["evaluations"] <= 50


def test_one_step_is_no_plural() -> None:
    assert "planar5, 1 step of 0.2 s: " in run(*TRACK, *FREE, "--duration", "0.2").stdout


def test_version_is_printed() -> None:
    result = run("--version")
    assert (result.exit_code, result.stdout) == (0, f"beetle-ik {bik.__version__}\n")


def test_solve_reaches_a_position_and_a_pose() -> None:
    free = run_json("solve", "iiwa14", "--position", "0.4,0.3,1.0")
    assert free["success"]
    assert free["rotation_error"] is None
    posed = run_json("solve", "iiwa14", "--position", "0.4,0.2,0.8", "--rpy", "0,1.5,0")
    assert posed["rotation_error"] <= 1e-6


def test_all_solutions_and_whether_any_is_missing() -> None:
    arguments = ("solve", "ur10", "--position", "0.5,0.2,0.4", "--rpy", "0,1.5,0", "--all")
    found = run_json(*arguments)
    assert (len(found["q"]), found["complete"], found["status"]) == (8, True, "SOLVED")
    shown = run(*arguments).stdout
    assert "8 distinct solutions, no others inside the limits" in shown
    assert "axes 2 to 4 parallel; at most 8 solutions" in shown
    assert shown.count("q [rad, m]: ") == 8


def test_out_of_reach_is_computed_and_exits_with_1() -> None:
    result = run("solve", "planar5", "--position", "9,0,0")
    assert result.exit_code == 1
    assert "position error [m]" in result.stdout


def test_track_writes_its_files(tmp_path: Path) -> None:
    folder = tmp_path / "new" / "results"
    summary = run_json(*TRACK, "--velocity-sinusoid", "0.2,0.004,1", "--out", str(folder))
    assert {file.name for file in folder.iterdir()} == FILES
    assert json.loads((folder / "summary.json").read_text()) == summary
    assert (summary["success"], summary["steps"]) == (True, 150)
    assert summary["position_error"]["steady_mean"] <= 4e-5
    assert summary["velocity_limit"]["source"] == "--velocity-sinusoid"
    from_csv = bik.Trajectory.from_csv(folder / "trajectory.csv")
    from_npz = bik.Trajectory.from_npz(folder / "trajectory.npz")
    assert (from_csv.q == from_npz.q).all()


def test_track_keeps_accelerations(tmp_path: Path) -> None:
    limits = ["--velocity-limit", "1", "--acceleration-limit", "0.5,0.5,0.5,0.5,0.5"]
    assert run(*TRACK, *limits, "--out", str(tmp_path / "out")).exit_code == 0
    trajectory = bik.Trajectory.from_npz(tmp_path / "out" / "trajectory.npz")
    assert 0.0 < np.abs(np.diff(trajectory.qd[1:], axis=0)).max() <= 0.5 * 0.2 + 1e-12


def test_track_repeats_bit_for_bit(tmp_path: Path) -> None:
    for folder in ("first", "second"):
        assert run(*TRACK, *FREE, "--seed", "3", "--out", str(tmp_path / folder)).exit_code == 0
    for name in ("trajectory.csv", "trajectory.npz"):
        assert (tmp_path / "first" / name).read_bytes() == (tmp_path / "second" / name).read_bytes()


@pytest.mark.parametrize("solver", ["bas", "chain", "greedy", "lm"])
def test_every_solver_tracks(solver: str) -> None:
    assert run_json(*TRACK, *FREE, "--solver", solver)["solver"] == solver


def test_without_a_solver_the_library_chooses() -> None:
    summary = run_json(*TRACK, *FREE)
    assert summary["solver"] == "model-based"
    assert summary["evaluations"] < 3 * summary["steps"]


@pytest.mark.parametrize("curve", ["circle", "hypotrochoid", "letter-m", "pentagram", "rose"])
@pytest.mark.parametrize("robot", bik.Robot.names())
def test_every_arm_follows_every_curve_as_it_is_placed_for_it(robot: str, curve: str) -> None:
    own = np.isfinite(bik.Robot.named(robot).velocity_limit).all()
    result = run("track", robot, "--curve", curve, *([] if own else FREE))
    assert result.exit_code == 0, result.output


def test_an_arm_without_speeds_is_told_the_option() -> None:
    joints = ", ".join(f"'joint_{i}'" for i in range(1, 6))
    assert refused(*TRACK) == (
        f"Error: joints {joints} have neither a velocity nor an acceleration limit, so that nothing sets their pace: "
        "give --velocity-limit, infinite where a joint may jump to any position in one tick"
    )


def test_a_limit_above_the_real_arm_is_told() -> None:
    result = run("track", "iiwa14", "--curve", "circle", "--velocity-sinusoid", "2,0.004,1")
    assert (
        "Note: a velocity limit of up to 2.004 rad/s is above the real iiwa14's own in 4 of its 7 joints"
        in result.stdout
    )


def test_a_path_file_may_have_times_or_a_duration(tmp_path: Path) -> None:
    timed, untimed = tmp_path / "timed.csv", tmp_path / "untimed.csv"
    timed.write_text("time,x,y,z\n0,4,1,0\n2,4,0.9,0\n")
    untimed.write_text("x,y,z\n4,1,0\n4,0.9,0\n")
    assert run_json("track", "planar5", "--path", str(timed), *FREE)["steps"] == 10
    assert run_json("track", "planar5", "--path", str(untimed), "--duration", "4", *FREE)["steps"] == 20
    assert refused("track", "planar5", "--path", str(timed), "--duration", "4") == (
        f"Error: --duration: '{timed}' has a column 'time', which sets the duration; leave one of them out"
    )
    untimed.write_bytes(b"x,y,z\n4,1,\xb0\n")
    assert refused("track", "planar5", "--path", str(untimed)) == (
        f"Error: {untimed}, line 2: byte 0xb0 is not UTF-8; save the file as CSV with the encoding UTF-8"
    )
    untimed.write_text("x,y\n4,1\n")
    assert refused("track", "planar5", "--path", str(untimed)) == (
        f"Error: {untimed}, line 1: column 'z' is missing; columns found: x, y"
    )


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (
            ["fk", "--q", "0"],
            "no robot was given: name a built-in one (`beetle-ik robots` lists them) or a file, such as arm.urdf",
        ),
        (
            ["fk", "iiwa14", "--urdf", "arm.urdf", "--q", "0"],
            "both the robot 'iiwa14' and --urdf 'arm.urdf' were given: give one of them",
        ),
        (
            ["fk", "iiwa14", "--tip", "x", "--q", "0"],
            "--base and --tip choose links of a file; the built-in robot 'iiwa14' has its own: leave them out",
        ),
        (["fk", "planar5", "--q", "0,0,x,0,0"], "--q: 'x' is not a number"),
        (
            ["solve", "planar5", "--position", "1,2"],
            "--position: expected 3 numbers separated by commas, got 2 in '1,2'",
        ),
        (
            ["track", "planar5"],
            "no path was given: use --path FILE or --curve with one of circle, hypotrochoid, letter-m, pentagram, rose",
        ),
        (
            ["track", "planar5", "--curve", "circle", "--k", "3"],
            "--k does not belong to the curve 'circle', which takes --center, --diameter, --a, --b",
        ),
        (
            ["track", "planar5", "--curve", "circle", "--path", "points.csv"],
            "--path takes its points from the file: leave out --curve and its parameters",
        ),
        (
            [*TRACK, "--velocity-limit", "1", "--velocity-sinusoid", "1,0.1,1"],
            "both --velocity-limit and --velocity-sinusoid were given: give one of them",
        ),
        (
            [*TRACK, "--velocity-sinusoid", "1,2"],
            "--velocity-sinusoid: expected 3 numbers separated by commas, got 2 in '1,2'",
        ),
    ],
)
def test_wrong_input_is_told_exactly(arguments: list[str], message: str) -> None:
    assert refused(*arguments) == f"Error: {message}"


@pytest.mark.parametrize(
    "arguments",
    [
        ["fk", "iiwa", "--q", "0"],
        ["fk", "iiwa14", "--q", "0,0"],
        ["fk", "--urdf", "no-such-file.urdf", "--q", "0"],
        [*TRACK, "--dt", "0"],
        [*TRACK, "--start-q", "9,9,9,9,9"],
        [*TRACK, "--velocity-limit", "-1"],
        [*TRACK, "--velocity-sinusoid", "0.1,0.2,1"],
        ["track", "planar5", "--path", "no-such-file.csv"],
        ["track", "planar5", "--curve", "spiral"],
    ],
)
def test_errors_of_the_core_exit_with_2(arguments: list[str]) -> None:
    assert "Error" in refused(*arguments)


def test_an_unwritable_folder_is_refused_before_any_work(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("beetle_ik.cli.track.track_path", lambda *_, **__: pytest.fail("work was done"))
    blocked = tmp_path / "file"
    blocked.touch()
    assert refused(*TRACK, "--out", str(blocked / "results")).startswith(
        f"Error: --out: folder '{blocked / 'results'}' cannot be written: "
    )


def test_a_failure_half_way_leaves_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def fail_half_way(folder: Path, *_others: object) -> None:
        (folder / "trajectory.csv").touch()
        raise OSError("disk full")

    monkeypatch.setattr("beetle_ik.cli.track.write_files", fail_half_way)
    assert refused(*TRACK, *FREE, "--out", str(tmp_path / "new" / "results")) == "Error: disk full"
    assert list(tmp_path.iterdir()) == []


def test_a_failure_half_way_keeps_what_was_in_the_folder(tmp_path: Path) -> None:
    (tmp_path / "mine.txt").touch()
    refused(*TRACK, "--dt", "0", "--out", str(tmp_path))
    assert [file.name for file in tmp_path.iterdir()] == ["mine.txt"]


def test_ctrl_c_is_told_and_leaves_nothing(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def interrupt(*_: object, **__: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr("beetle_ik.cli.track.track_path", interrupt)
    result = run(*TRACK, "--out", str(tmp_path / "new"))
    assert (result.exit_code, result.stdout, result.stderr) == (130, "", "Interrupted: nothing was written.\n")
    assert list(tmp_path.iterdir()) == []


def test_the_module_runs_and_a_pipe_gets_no_progress_bar() -> None:
    command = [sys.executable, "-m", "beetle_ik", *TRACK, *FREE]
    done = subprocess.run(command, check=False, capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (0, "")
    assert "mean position error [m]" in done.stdout


@pytest.mark.parametrize("command", ["", "robots", "fk", "solve", "track", "plan", "reproduce", "doctor"])
def test_every_command_has_help(command: str) -> None:
    result = run(*command.split(), "--help")
    assert result.exit_code == 0
    assert "Usage: " in result.stdout


@pytest.mark.parametrize(
    ("command", "message"),
    [
        (
            "track ur5e --curve circle --dt 0.1 --ease",
            "--ease is an approach under acceleration or jerk limits, and there are none: give --acceleration-limit",
        ),
        ("solve panda --position 0.4 0 0.5 --margin 0.1", "--margin needs --scene"),
        (
            "plan along-path planar5 --curve circle --method tpbso --velocity-limit 1 --jerk-limit 9",
            "--method tpbso cannot honour jerk limits: leave them out, and add them with `beetle-ik plan retime`",
        ),
    ],
)
def test_messages_name_options_instead_of_keywords(command: str, message: str) -> None:
    refused = CliRunner().invoke(app, command.split())
    assert (refused.exit_code, refused.stderr.strip()) == (2, f"Error: {message}")


def test_joint_weights_are_options_of_solve_and_track() -> None:
    start = "0,-0.4,0,-2,0,1.6,0.8"
    asked = ("solve", "panda", "--position", "0.4,0.1,0.5", "--start-q", start)
    plain, weighted = (np.array(run_json(*asked, *more)["q"]) for more in ((), ("--joint-weights", "100,1,1,1,1,1,1")))
    assert abs(weighted[0]) < 0.1 * abs(plain[0])
    without_start = refused("solve", "panda", "--position", "0.4,0.1,0.5", "--joint-weights", "2,1,1,1,1,1,1")
    assert "--joint-weights need a start to measure motions from" in without_start
    assert "--joint-weights choose one solution: leave out --all" in refused(
        *asked, "--all", "--joint-weights", "2,1,1,1,1,1,1"
    )
    assert "joint-weights" in run("track", "--help").stdout


def test_a_track_with_a_payload_keeps_the_torques_of_the_file() -> None:
    path = (
        "track",
        "panda",
        "--curve",
        "circle",
        "--diameter",
        "0.1",
        "--duration",
        "2",
        "--dt",
        "0.01",
        "--position-tolerance",
        "1",
    )
    accelerations = ("--acceleration-limit", "15,7.5,10,12.5,15,20,20")
    summary = run_json(*path, "--payload", "2", "--torque-limits", *accelerations)
    assert summary["steps"] == 200
    rated = [87, 87, 87, 87, 12, 12, 12]
    assert (summary["payload"], summary["torque_limit"]) == (2, rated)
    ends = ("--start-q=0,-0.3,0,-2,0,1.8,0.8", "--end-q=0.3,-0.3,0,-2,0,1.8,0.8")
    planned = run_json("plan", "point-to-point", "panda", *ends, "--payload", "3", "--torque-limits", *accelerations)
    assert (planned["payload"], planned["torque_limit"]) == (3, rated)
    assert "payload" not in run_json("plan", "point-to-point", "panda", *ends)
    assert refused(*path, "--payload", "2") == (
        "Error: --payload counts only where torques are limited: use --torque-limits too"
    )
    assert refused(*path, "--torque-limits") == (
        "Error: track cannot honour torque limits: joint 'panda_joint1' may change its velocity at once, which takes "
        "any torque: give --acceleration-limit"
    )
    ends = ("--start-q=0,-1.5,1.5,0,0,0", "--end-q=1,-1,1,0,0,0", "--acceleration-limit", "5")
    assert refused("plan", "point-to-point", "ur5e", *ends, "--torque-limits").startswith(
        "Error: robot 'ur5e' has no dynamics: no link has a mass"
    )
