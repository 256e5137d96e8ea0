"""`beetle-ik plan point-to-point`: ends, obstacles from a file, and what is refused."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner, Result

import beetle_ik as bik
from beetle_ik._scene import read_obstacles
from beetle_ik.cli import app

LIMITS = ["--velocity-limit", "1", "--acceleration-limit", "2"]
SHAPES: list[dict[str, Any]] = [
    {"type": "sphere", "center": [0.1, 0.2, 0.3], "radius": 0.5},
    {"type": "box", "center": [0.1, 0.2, 0.3], "size": [1, 2, 3], "rotation": [[0, -1, 0], [1, 0, 0], [0, 0, 1]]},
    {"type": "capsule", "a": [0, 0, 0], "b": [1, 0, 0], "radius": 0.25},
    {"type": "ellipsoid", "center": [0.1, 0.2, 0.3], "semi_axes": [1, 2, 3]},
    {"type": "ellipse", "center": [0.1, 0.2], "semi_axes": [1, 2], "angle": 0.7},
    {"type": "convex_mesh", "points": [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]},
]
OBSTACLES = [
    bik.obstacles.Sphere([0.1, 0.2, 0.3], 0.5),
    bik.obstacles.Box([0.1, 0.2, 0.3], [1, 2, 3], rotation=[[0, -1, 0], [1, 0, 0], [0, 0, 1]]),
    bik.obstacles.Capsule([0, 0, 0], [1, 0, 0], 0.25),
    bik.obstacles.Ellipsoid([0.1, 0.2, 0.3], [1, 2, 3]),
    bik.obstacles.Ellipse([0.1, 0.2], [1, 2], angle=0.7),
    bik.obstacles.ConvexMesh([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]),
]


def plan(*arguments: str) -> Result:
    return CliRunner().invoke(app, ["plan", "point-to-point", *arguments, *LIMITS])


@pytest.fixture
def scene(tmp_path: Path) -> Path:
    return tmp_path / "scene.json"


@pytest.mark.parametrize("whole", [SHAPES, {"obstacles": SHAPES}], ids=["a list", "an object"])
def test_a_scene_holds_every_shape(scene: Path, whole: object) -> None:
    scene.write_text(json.dumps(whole))
    assert read_obstacles(scene) == OBSTACLES


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("{", "not JSON: "),
        ("3", 'expected a list of shapes, or an object with such a list as "obstacles"'),
        ('{"shapes": []}', 'expected a list of shapes, or an object with such a list as "obstacles"'),
        ("[1]", 'obstacle 0: expected an object with a "type", one of sphere, box, capsule'),
        ('[{"type": "cone"}]', "obstacle 0: unknown type 'cone'; types: sphere, box, capsule"),
        ('[{"type": "sphere", "center": [0, 0, 0]}]', "obstacle 0 (sphere): missing a required argument: 'radius'"),
        ('[{"type": "sphere", "center": [0, 0], "radius": 1}]', "obstacle 0 (sphere): center: expected shape (3,)"),
        ('[{"type": "sphere", "center": [0, 0, 0], "radius": -1}]', "obstacle 0 (sphere): "),
        ('[{"type": "box", "center": [0, 0, 0], "size": [1, 1, 1], "color": 1}]', "obstacle 0 (box): "),
    ],
)
def test_what_is_no_scene_is_refused(scene: Path, text: str, problem: str) -> None:
    scene.write_text(text)
    with pytest.raises(bik.InvalidInputError) as caught:
        read_obstacles(scene)
    assert str(caught.value).startswith(f"{scene}: {problem}")


def test_a_plan_goes_round_the_obstacles_of_a_scene(scene: Path) -> None:
    scene.write_text(json.dumps([{"type": "sphere", "center": [1.9, 0.0, 0.0], "radius": 0.2}]))
    ends = ["--start-q=-0.6,0,0,0,0", "--end-q=0.6,0,0,0,0"]
    done = plan("planar5", *ends, "--scene", str(scene), "--link-radius", "0.02", "--json")
    answer = json.loads(done.stdout)
    assert answer["clearance"] >= 0.0009, done.output
    assert done.exit_code == (0 if answer["success"] else 1)
    assert json.loads(plan("planar5", *ends, "--json").stdout)["clearance"] is None


def test_an_end_may_be_a_pose() -> None:
    arm = bik.Robot.named("iiwa14")
    start = "0.1,0.4,0.1,-1.2,0.1,0.6,0.1"
    done = plan("iiwa14", "--start-q", start, "--end", "0.4,0.2,0.8,0,1.5,0", "--json")
    reached = arm.fk(json.loads(done.stdout)["end_q"])
    np.testing.assert_allclose(reached, bik.pose([0.4, 0.2, 0.8], rpy=[0, 1.5, 0]), atol=1e-5)


def test_an_end_of_four_numbers_is_refused() -> None:
    done = plan("iiwa14", "--start", "0.4,0.2,0.8,1", "--end", "0.4,0.2,0.8")
    assert done.exit_code == 2
    assert done.stderr.strip() == "Error: --start: expected X,Y,Z or X,Y,Z,ROLL,PITCH,YAW, got 4 numbers"
