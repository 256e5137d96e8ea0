"""`beetle-ik plan moves`: programs from files, and refused ones by move and key."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pair_of_pandas import pair_of_pandas
from typer.testing import CliRunner, Result

import beetle_ik as bik
from beetle_ik.cli.app import app

HOME = [0.0, -1.5, 1.8, -1.9, -1.57, 0.0]
DOWN = [3.141592653589793, 0.0, 0.0]


def planned(file: Path, program: Any, *more: str) -> Result:
    file.write_text(json.dumps(program))
    start = "--start-q=" + ",".join(map(str, HOME))
    given = ["plan", "moves", str(file), "ur5e", start, "--acceleration-limit", "5", *more]
    return CliRunner().invoke(app, given)


def test_a_program_of_a_file_is_planned(tmp_path: Path) -> None:
    program = [
        {"move": "joints", "to": [0.4, -0.1, 0.3, *DOWN], "name": "above"},
        {"move": "line", "to": [0.4, -0.1, 0.2, *DOWN], "speed": 0.05, "blend": 0.01},
        {"move": "arc", "via": [0.4, 0.0, 0.25], "to": [0.4, 0.1, 0.2, *DOWN], "speed": 0.1},
        {"move": "wait", "seconds": 0.5, "name": "grip"},
        {"move": "joints", "to": {"q": HOME}},
    ]
    done = planned(tmp_path / "program.json", program, "--json")
    answer = json.loads(done.stdout)
    assert done.exit_code == 0
    assert [move["name"] for move in answer["moves"]] == ["above", None, None, "grip", None]
    assert answer["moves"][1]["speed"] == pytest.approx(0.05, rel=1e-3)
    assert answer["moves"][3]["end"] - answer["moves"][3]["start"] == pytest.approx(0.5)
    shown = planned(tmp_path / "program.json", program)
    assert "move 0 'above'" in shown.stdout


def test_the_task_of_a_file_leaves_the_spin_free(tmp_path: Path) -> None:
    turned = [DOWN[0], DOWN[1], 1.5]
    lines = [
        {"move": "joints", "to": [0.4, -0.1, 0.3, *DOWN]},
        {"move": "line", "to": [0.4, 0.0, 0.3, *turned]},
    ]
    task = {"kind": "pointing", "axis": [0, 0, 1], "tool": [0, 0, 0, 0, 0, 0]}
    whole, free = (
        json.loads(planned(tmp_path / "program.json", program, "--json").stdout)
        for program in ({"moves": lines}, {"moves": lines, "task": task})
    )
    assert free["moves"][-1]["end"] < 0.9 * whole["moves"][-1]["end"]


def test_moves_of_two_tips_name_them(tmp_path: Path) -> None:
    urdf, program = tmp_path / "pair.urdf", tmp_path / "program.json"
    urdf.write_text(pair_of_pandas())
    pair = bik.Robot.from_urdf(urdf, tip=["left_tool", "right_tool"])
    start = np.r_[0.2, 0.0, np.tile([0.0, -0.6, 0.0, -2.2, 0.0, 1.8, 0.7], 2)]
    lowered = [[*(pose[:3, 3] - [0.0, 0.0, 0.1]), 0.0, 0.0, 0.0] for pose in pair.fk(start)]
    moves = [{"move": "line", "to": to, "tip": tip} for to, tip in zip(lowered, pair.tips, strict=True)]
    position = {"kind": "position"}
    program.write_text(json.dumps({"moves": moves, "task": {"left_tool": position, "right_tool": position}}))
    q = "--start-q=" + ",".join(map(str, start))
    given = ["plan", "moves", str(program), "--urdf", str(urdf), "--tip", "left_tool", "--tip", "right_tool", q]
    done = CliRunner().invoke(app, [*given, "--acceleration-limit", "5", "--json", "--out", str(tmp_path / "out")])
    assert done.exit_code == 0, done.output
    with np.load(tmp_path / "out" / "trajectory.npz") as saved:
        _, q, _, _ = bik.Trajectory(saved["time"], saved["coefficients"]).sample(0.01)
    assert np.abs(pair.fk(q[-1])[:, :3, 3] - np.array(lowered)[:, :3]).max() < 1e-5
    middle = pair.fk(q[len(q) // 4])[:, :3, 3]
    assert (
        np.abs(middle[1] - pair.fk(start)[1, :3, 3]).max() < 1e-9 < np.abs(middle[0] - pair.fk(start)[0, :3, 3]).max()
    )


WRONG: list[tuple[Any, str]] = [
    (3, "expected a list of moves, got int"),
    ({}, "a program needs 'moves', a list; it may have a 'task'"),
    ({"moves": [], "tasks": {}}, "unknown key 'tasks'; a program takes moves, task"),
    ({"moves": [], "task": "pointing"}, "task: expected an object with the key 'kind', got 'pointing'"),
    ({"moves": [], "task": {"kind": "spin"}}, "task: 'kind' must be one of pose, position, pointing, got 'spin'"),
    (
        {"moves": [], "task": {"kind": "position", "axis": [0, 0, 1]}},
        "task: unknown key 'axis'; a position task takes tolerance, tool, weights",
    ),
    (
        {"moves": [], "task": {"kind": "pointing", "tolerance": [0.1]}},
        "task: tolerance of task Pointing: expected 4 entries (x, y, z and the angle), got 1",
    ),
    (
        {"moves": [], "task": {"left": {"kind": "spin"}}},
        "task of 'left': 'kind' must be one of pose, position, pointing, got 'spin'",
    ),
    (
        [{"move": "line", "to": [0.4, 0.0, 0.3, 0.0, 0.0, 0.0], "tip": 3}],
        "move 0: 'tip' must be a text, got 3",
    ),
    ([3], "move 0: expected an object with the key 'move', got 3"),
    ([{"move": "jump"}], "move 0: 'move' must be one of joints, line, arc, wait, got 'jump'"),
    ([{"move": ["line"]}], "move 0: 'move' must be one of joints, line, arc, wait, got ['line']"),
    ([{"move": "wait", "seconds": 1.0}, {"move": "line"}], "move 1: a line needs 'to'"),
    (
        [{"move": "wait", "seconds": 1.0, "sped": 2.0}],
        "move 0: unknown key 'sped'; a wait takes name, seconds",
    ),
    ([{"move": "line", "to": [1.0, 2.0]}], "move 0: 'to' must be a list of 6 numbers, got [1.0, 2.0]"),
    ([{"move": "wait", "seconds": "1"}], "move 0: 'seconds' must be a number, got '1'"),
    (
        [{"move": "wait", "seconds": 1.0}, {"move": "wait", "seconds": -1, "name": "rest"}],
        "move 1: time of move 'rest' must be from 0 to 1000000 s, got -1",
    ),
    ([{"move": "wait", "seconds": 1.0, "name": 3}], "move 0: 'name' must be a text, got 3"),
    (
        [{"move": "joints", "to": {"p": []}}],
        "move 0: 'to' must be six numbers or an object with the key 'q', got {'p': []}",
    ),
]


@pytest.mark.parametrize(("program", "message"), WRONG, ids=[message[:40] for _, message in WRONG])
def test_wrong_files_are_refused_by_move_and_key(tmp_path: Path, program: Any, message: str) -> None:
    file = tmp_path / "program.json"
    done = planned(file, program)
    assert done.exit_code == 2
    assert " ".join(done.stderr.split()) == f"Error: {file}: {message}"


def test_a_file_that_is_no_json_is_refused(tmp_path: Path) -> None:
    file = tmp_path / "program.json"
    planned(file, [])
    file.write_text("{")
    done = CliRunner().invoke(app, ["plan", "moves", str(file), "ur5e", "--start-q", "0,0,0,0,0,0"])
    assert done.exit_code == 2
    assert "not a readable JSON file" in done.stderr
