"""`calibrate`: the arm as it is built, judged by numpy."""

import json
import pickle
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from generated import chain
from numpy.typing import NDArray
from scipy.optimize import least_squares
from scipy.spatial.transform import Rotation
from typer.testing import CliRunner

import beetle_ik as bik
from beetle_ik.cli.app import app

sys.path.insert(0, str(Path(__file__).parents[2] / "benches"))

from peers.calibration_judge import Arm, bound, built, rank, transform

Array = NDArray[np.float64]
SIGMA = 1e-4
LENS = (600.0, 605.0, 320.0, 240.0)
BOARD = np.array([(x, y, 0.0) for x in np.arange(6) * 0.03 for y in np.arange(5) * 0.03])


def model_of(name: str) -> bik.Robot:
    return bik.Robot.named(name).with_tool(transform(np.array([0.06, 0.03, 0.1]), np.zeros(3)))


def rms(a: Array, b: Array) -> float:
    return float(np.sqrt(((a - b) ** 2).sum(-1).mean()))


@pytest.mark.parametrize("name", ["panda", "ur5e"])
def test_new_poses_are_as_near_as_the_bound_allows(name: str) -> None:
    ratios = []
    for seed in range(5):
        rng = np.random.default_rng(seed)
        model = model_of(name)
        truth = built(model, rng, 1e-3, np.radians(0.5))
        q, new = model.random_configurations(40, seed=seed), model.random_configurations(100, seed=seed + 50)
        found = bik.calibrate(model, q, truth.fk(q)[:, :3, 3] + rng.normal(0, SIGMA, (40, 3)))
        error = rms(found.robot.fk(new)[:, :3, 3], truth.fk(new)[:, :3, 3])
        ratios.append(error / bound(Arm(truth), q, new, SIGMA))
        assert 0.7 * SIGMA < found.sigma[0] < 1.4 * SIGMA
        assert error < 1.5 * found.rms_held_out
    assert np.median(ratios) < 1.2


@pytest.mark.parametrize("kind", ["positions", "poses"])
@pytest.mark.parametrize("seed", range(12))
def test_the_rank_is_that_of_finite_differences(kind: str, seed: int) -> None:
    text, base, tip = chain(3 + seed % 4, ("root", "inside", "branch")[seed % 3], seed)
    model = bik.Robot.from_urdf(text, base=base, tip=tip).with_tool(transform(np.array([0.1, 0.07, 0.2]), np.zeros(3)))
    q = model.random_configurations(60, seed=seed)
    tips = model.fk(q)
    found = bik.calibrate(model, q, tips if kind == "poses" else tips[:, :3, 3])
    expected = rank(Arm(model).jacobian(q, rotations=kind == "poses"))
    assert (found.identifiable.rank, found.identifiable.possible) == (expected, expected)
    assert found.rms_after < 1e-9


def test_covariance_is_the_scatter_of_estimates() -> None:
    model = model_of("ur5e")
    q = model.random_configurations(40, seed=1)
    exact = model.fk(q)[:, :3, 3]
    scattered = []
    for seed in range(60):
        noise = np.random.default_rng(seed).normal(0, SIGMA, exact.shape)
        found = bik.calibrate(model, q, exact + noise, fit=["offsets", "tool"], sigma=SIGMA, robust=False)
        scattered.append(list(found.parameters.values()))
    told = np.sqrt(np.diag(found.covariance))
    determined = told < 1e-3
    assert determined.sum() == 6
    assert np.allclose(np.std(scattered, axis=0)[determined] / told[determined], 1.0, atol=0.35)
    assert np.allclose(told, list(found.deviations.values()))


def test_errors_are_those_of_forward_kinematics() -> None:
    model, q = model_of("panda"), model_of("panda").random_configurations(30, seed=2)
    measured = model.with_errors(length=1e-3, angle=0.01, seed=2).fk(q)
    found = bik.calibrate(model, q, measured, fit=["offsets"])
    for robot, errors, total in (
        (model, found.errors_before, found.rms_before),
        (found.robot, found.errors_after, found.rms_after),
    ):
        apart = np.linalg.norm(robot.fk(q)[:, :3, 3] - measured[:, :3, 3], axis=1)
        kept = np.setdiff1d(np.arange(30), found.outliers)
        assert np.allclose(errors, apart, atol=1e-12)
        assert total == pytest.approx(np.sqrt((apart[kept] ** 2).mean()), rel=1e-9)


@pytest.mark.parametrize("camera", ["hand", "fixed"])
def test_image_points_are_fitted_as_scipy_fits_them(camera: str) -> None:
    rng = np.random.default_rng(3)
    robot = bik.Robot.named("ur5e")
    q = np.array([0.0, -1.5, 1.5, -1.5, -1.5, 0.0]) + rng.uniform(-0.3, 0.3, (12, 6))
    tips = robot.fk(q)
    middle = robot.fk([0.0, -1.5, 1.5, -1.5, -1.5, 0.0])
    facing = middle @ transform(np.array([0.05, 0.02, 0.5]), np.array([np.pi, 0.0, 0.0]))
    if camera == "hand":
        eye, board = transform(np.array([0.05, 0.02, 0.05]), np.array([0.0, 0.1, 0.2])), facing
        seen = np.linalg.inv(tips @ eye) @ board @ transform(np.zeros(3), np.array([np.pi, 0.0, 0.0]))
        board = board @ transform(np.zeros(3), np.array([np.pi, 0.0, 0.0]))
    else:
        eye, board = facing, transform(np.array([0.0, 0.02, 0.05]), np.array([0.1, 0.1, 0.2]))
        seen = np.linalg.inv(eye) @ tips @ board

    def image(poses: Array) -> Array:
        points = np.einsum("mij,kj->mki", poses[:, :3, :3], BOARD) + poses[:, None, :3, 3]
        return points[..., :2] / points[..., 2:] * LENS[:2] + LENS[2:]

    pixels = image(seen) + rng.normal(0, 0.2, (12, len(BOARD), 2))
    pixels[2, 4:9] = np.nan
    found = bik.calibrate(robot, q, pixels, camera=camera, board=BOARD, lens=LENS, robust=False)
    assert found.unit == "pixels"
    assert 0.25 < found.rms_after < 0.32

    def residual(x: Array) -> Array:
        a, b = transform(x[:3], x[3:6]), transform(x[6:9], x[9:])
        poses = np.linalg.inv(tips @ a) @ b if camera == "hand" else np.linalg.inv(a) @ tips @ b
        return np.asarray((image(poses) - pixels)[np.isfinite(pixels)])

    start = [np.r_[pose[:3, 3], Rotation.from_matrix(pose[:3, :3]).as_rotvec()] for pose in (eye, board)]
    best = least_squares(residual, np.concatenate(start), x_scale="jac", xtol=1e-14, ftol=1e-14).x
    for told, x in ((found.camera, best[:6]), (found.board, best[6:])):
        assert told is not None
        assert np.allclose(told, transform(x[:3], x[3:]), atol=1e-5)


@pytest.mark.parametrize("seed", range(6))
def test_the_written_urdf_is_the_calibrated_arm(seed: int) -> None:
    text, base, tip = chain(4, ("root", "inside", "branch")[seed % 3], seed)
    model = bik.Robot.from_urdf(text, base=base, tip=tip)
    q = model.random_configurations(60, seed=seed)
    measured = model.with_errors(length=2e-3, angle=0.01, seed=seed).fk(q)
    found = bik.calibrate(model, q, measured)
    again = bik.Robot.from_urdf(found.to_urdf(text), base=base, tip=tip).with_base(found.base).with_tool(found.tool)
    assert np.allclose(again.fk(q), found.robot.fk(q), atol=1e-12)


def test_suggestions_are_clear_and_inside_the_limits() -> None:
    model = model_of("panda").with_capsules(radius=0.05)
    q = model.random_configurations(15, seed=1)
    box = bik.obstacles.Box((0.5, 0.0, 0.3), size=(0.3, 0.3, 0.6))
    found = bik.calibrate(model, q, model.fk(q), suggest=6, obstacles=[box], margin=0.02)
    assert found.suggested.shape == (6, 7)
    assert ((found.suggested >= model.lower) & (found.suggested <= model.upper)).all()
    assert (bik.obstacles.clearance(found.robot, found.suggested, [box]) >= 0.02).all()


def test_closed_forms_of_a_calibrated_arm_still_answer() -> None:
    model = model_of("iiwa14")
    q = model.random_configurations(40, seed=4)
    robot = bik.calibrate(model, q, model.with_errors(length=1e-3, angle=0.005, seed=1).fk(q)).robot
    for target in robot.fk(robot.random_configurations(20, seed=9)):
        solution = bik.solve(robot, target)
        assert solution.success
        assert np.allclose(robot.fk(solution.q), target, atol=1e-5)


def test_a_calibration_pickles_and_shows_itself() -> None:
    model = model_of("ur5e")
    q = model.random_configurations(40, seed=1)
    found = bik.calibrate(model, q, model.fk(q)[:, :3, 3])
    again = pickle.loads(pickle.dumps(found))
    assert again.robot == found.robot
    assert (again.parameters, again.message, again.identifiable) == (
        found.parameters,
        found.message,
        found.identifiable,
    )
    assert repr(found).startswith("<Calibration: 40 measurements, error ")
    assert repr(found.identifiable).startswith("<Identifiability: 27 of 27, condition ")


URDF = """<robot name="arm"><link name="a"/><link name="b"/><link name="c"/><link name="d"/>
<joint name="one" type="revolute"><parent link="a"/><child link="b"/><axis xyz="0 0 1"/>
<limit lower="-2" upper="2" effort="1" velocity="1"/></joint>
<joint name="two" type="revolute"><origin xyz="0.1 0 0.2"/><parent link="b"/><child link="c"/><axis xyz="0 1 0"/>
<limit lower="-2" upper="2" effort="1" velocity="1"/></joint>
<joint name="three" type="revolute"><origin xyz="0.3 0 0"/><parent link="c"/><child link="d"/><axis xyz="1 0 0"/>
<limit lower="-2" upper="2" effort="1" velocity="1"/></joint></robot>
"""


def run(*arguments: str) -> Any:
    return CliRunner().invoke(app, ["calibrate", *arguments])


def table(file: Path, names: list[str], rows: Array) -> str:
    np.savetxt(file, rows, delimiter=",", header=",".join(names), comments="")
    return str(file)


def test_the_command_line_calibrates_a_urdf(tmp_path: Path) -> None:
    arm = tmp_path / "arm.urdf"
    arm.write_text(URDF)
    model = bik.Robot.from_urdf(arm).with_tool(bik.pose([0.1, 0.2, 0.3]))
    q = model.random_configurations(30, seed=1)
    tips = model.with_errors(length=1e-3, angle=0.01, seed=2).fk(q)
    quaternions = Rotation.from_matrix(tips[:, :3, :3]).as_quat()
    names = ["q1", "q2", "q3", "x", "y", "z"]
    poses = table(tmp_path / "poses.csv", [*names, "qx", "qy", "qz", "qw"], np.c_[q, tips[:, :3, 3], quaternions])
    out = tmp_path / "out"
    result = run(poses, "--urdf", str(arm), "--tool", "0.1,0.2,0.3", "--out", str(out), "--suggest", "2")
    assert result.exit_code == 0, result.output
    files = {"calibrated.urdf", "calibration.png", "errors.csv", "parameters.csv", "report.md", "summary.json"}
    assert {file.name for file in out.iterdir()} == files
    summary = json.loads((out / "summary.json").read_text())
    assert summary["rms_after"] < 1e-6 < summary["rms_before"]
    robot = bik.Robot.from_urdf(out / "calibrated.urdf").with_base(summary["base"]).with_tool(summary["tool"])
    assert np.allclose(robot.fk(q), tips, atol=1e-5)
    assert result.stdout.count("measure at q [rad, m]: ") == 2
    points = table(tmp_path / "points.csv", ["one", "two", "three", "x", "y", "z"], np.c_[q, tips[:, :3, 3]])
    told = json.loads(run(points, "--urdf", str(arm), "--fit", "offsets,tool,base", "--json").stdout)
    assert set(told["parameters"]) >= {"offset one", "offset three", "tool x", "base rz"}
    missing = run(table(tmp_path / "less.csv", ["q1", "q2", "x", "y", "z"], np.zeros((3, 5))), "--urdf", str(arm))
    assert (missing.exit_code, missing.stdout) == (2, "")
    assert "line 1: column 'one' is missing; columns found: q1, q2, x, y, z" in missing.stderr
