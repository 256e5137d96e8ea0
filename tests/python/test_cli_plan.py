"""`beetle-ik plan point-to-point`: ends, obstacles from a file, and refused options."""

import json
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner, Result

import beetle_ik as bik
from beetle_ik.cli.app import app

LIMITS = ["--velocity-limit", "1", "--acceleration-limit", "2"]


def plan(*arguments: str) -> Result:
    return CliRunner().invoke(app, ["plan", "point-to-point", *arguments, *LIMITS])


@pytest.fixture
def scene(tmp_path: Path) -> Path:
    return tmp_path / "scene.json"


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


def test_a_plan_ends_with_a_straight_line() -> None:
    ends = ["--start-q=0,0.3,0,-1.5,0,1.8,0.8", "--end=0.5,0.2,0.4,3.1416,0,0", "--approach", "0.1", "--free-start"]
    direct = json.loads(plan("panda", *ends[:2], "--json").stdout)
    done = json.loads(plan("panda", *ends, "--json").stdout)
    assert done["success"]
    assert done["cost"] > direct["cost"]
    refused = plan("panda", *ends[:2], "--approach=-0.1")
    assert refused.exit_code == 2
    assert "distance of approach must be positive and finite, got -0.1" in refused.stderr


def test_a_start_in_a_cloud_of_a_scene_names_the_remedy(scene: Path) -> None:
    start = [0.0, 0.3, 0.0, -1.5, 0.0, 1.8, 0.8]
    hand = bik.Robot.named("panda").fk(start)[:3, 3]
    bik.Scene([bik.obstacles.PointCloud([hand], 0.01)]).save(scene)
    ends = ["--start-q=0,0.3,0,-1.5,0,1.8,0.8", "--end-q=0.5,0.3,0,-1.5,0,1.8,0.8"]
    refused = plan("panda", *ends, "--scene", str(scene), "--link-radius", "0.05")
    assert refused.exit_code == 2
    assert refused.stderr.strip().endswith(
        "the robot's own points may be in the cloud, and PointCloud.without_robot in Python takes them out"
    )


CUP = ["--start-q=0,-1.5,1.5,-90deg,-90deg,0", "--end-q=1.2,-1.2,1.2,-90deg,-90deg,0"]


def test_a_tilt_is_kept_and_told() -> None:
    arm = bik.Robot.named("ur5e")
    for options, most in ((["--tilt", "10deg"], np.radians(10)), (["--tilt", "0.2", "--up", "-z"], 0.2)):
        done = plan("ur5e", *CUP, *options, "--json")
        answer = json.loads(done.stdout)
        assert done.exit_code == 0
        z = arm.fk(answer["end_q"])[:3, 2]
        assert np.arctan2(np.hypot(z[0], z[1]), -z[2]) <= answer["tilt"] <= most
    assert "largest tilt [rad]" in plan("ur5e", *CUP, "--tilt", "10deg").stdout
    assert json.loads(plan("ur5e", *CUP, "--json").stdout)["tilt"] is None


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--up", "z"], "--up names the axis that --tilt keeps vertical: give --tilt too"),
        (["--tilt", "0"], "--tilt must be positive, got 0.0"),
        (["--tilt", "ten"], "--tilt: 'ten' is not a number"),
        (
            ["--tilt", "200deg"],
            "--tilt must be at most pi, at which any axis is allowed, got 3.490658503988659; 90deg is 90 degrees",
        ),
        (["--tilt", "10deg", "--up", "w"], "--up: expected x, y, z, -x, -y, -z or X,Y,Z, got 'w'"),
        (["--tilt", "10deg", "--up", "0,1"], "--up: expected 3 numbers separated by commas, got 2 in '0,1'"),
        (["--tilt", "10deg", "--up", "0,0,0"], "the length of --up must be positive, got 0.0"),
        (
            ["--tilt", "10deg", "--up", "z"],
            "--start-q: what is to be kept on the way does not hold there: tilt 3.142 rad of at most 0.1745",
        ),
        (
            ["--tilt", "10deg", "--method", "tpbso"],
            "--tilt is held by --method minmax: --method tpbso checks nothing on the way",
        ),
    ],
)  # fmt: skip
def test_a_wrong_tilt_is_refused(options: list[str], message: str) -> None:
    ends = ["--start-q=0,-90deg,90deg,-90deg,-90deg,0", CUP[1]]
    done = plan("ur5e", *ends, *options)
    assert (done.exit_code, done.stderr.strip()) == (2, f"Error: {message}")


def test_the_position_of_an_end_may_come_first() -> None:
    ends = ["--start-q=0,0.5,0.5,0.5,0.5", "--end", "1.5,1.0,0,0,0,3"]
    free = plan("planar5", *ends, "--first", "position", "--json")
    assert free.exit_code == 0, free.output
    end = json.loads(free.stdout)["end_q"]
    np.testing.assert_allclose(bik.Robot.named("planar5").fk(end)[:3, 3], [1.5, 1.0, 0.0], atol=1e-5)


def test_a_position_alone_has_no_part_that_comes_first() -> None:
    runs = [
        plan("planar5", "--start-q=0,0.5,0.5,0.5,0.5", "--end", "1.5,1.0,0", "--first", "position"),
        CliRunner().invoke(app, ["solve", "planar5", "--position", "1.5,1.0,0", "--first", "position"]),
    ]
    for refused in runs:
        assert refused.exit_code != 0
        assert "--first orders position and orientation" in refused.output.replace("\n", " ")


def test_breaks_of_a_path_are_printed(tmp_path: Path) -> None:
    file = tmp_path / "path.csv"
    file.write_text("x,y,z\n0.5,-0.4,0.3\n1.2,0,0.3\n0.5,0.4,0.3\n")

    def along(*more: str) -> Result:
        return CliRunner().invoke(app, ["plan", "along-path", "ur5e", "--path", str(file), *LIMITS, *more])

    refused = along()
    assert refused.exit_code != 0
    assert "; try --breaks, which lets the tool leave the path there and go on" in refused.output.replace("\n", " ")
    done = along("--breaks", "--json")
    [only] = json.loads(done.stdout)["breaks"]
    assert only["at"] < only["until"]
    assert "no configuration was found" in only["reason"]
    assert "break 0" in along("--breaks").output
