"""Versions, logs, notebooks and completion."""

import json
import logging
import re
import subprocess
import sys
import tomllib
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

import beetle_ik as bik
from beetle_ik.cli.app import app
from beetle_ik.cli.options import complete_robot
from beetle_ik.installed.versions import EXTRAS

IIWA = bik.Robot.named("iiwa14")
PYPROJECT = Path(__file__).parents[2] / "pyproject.toml"


def test_versions_name_what_matters(capsys: pytest.CaptureFixture[str]) -> None:
    bik.show_versions()
    shown = dict(line.split(maxsplit=1) for line in capsys.readouterr().out.splitlines())
    assert shown["beetle-ik"] == bik.__version__
    assert shown["numpy"] == np.__version__
    assert shown["CPU"].endswith("instructions")
    assert {f"[{extra}]" for extra in EXTRAS} <= set(shown)


def test_versions_know_every_extra() -> None:
    declared = tomllib.loads(PYPROJECT.read_text())["project"]["optional-dependencies"]
    for extra, packages in EXTRAS.items():
        ours = {name.partition(">")[0] for name in declared[extra] if not name.startswith("beetle-ik")}
        assert set(packages) == ours
    assert set(declared) - set(EXTRAS) == {"test", "oracles", "docs", "zoo"}


def test_the_doctor_solves_a_target() -> None:
    done = CliRunner().invoke(app, ["doctor", "--json"])
    found = json.loads(done.stdout)
    assert (done.exit_code, found["beetle-ik"]) == (0, bik.__version__)
    assert "self-test" in found


def test_completion_can_be_installed_and_knows_the_robots(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "iiwa").mkdir()
    for name in ("iiwa.urdf", "iiwa.txt"):
        (tmp_path / name).touch()
    assert "--install-completion" in CliRunner().invoke(app, ["--help"]).stdout
    assert complete_robot("iiwa") == ["iiwa14", "iiwa7", "iiwa/", "iiwa.urdf"]


def test_the_library_logs_only_when_asked(caplog: pytest.LogCaptureFixture, tmp_path: Path) -> None:
    script = (
        "import beetle_ik as bik; bik.Trajectory.from_samples([0, 1], [[0.0], [1.0]]).to_npz(__import__('sys').argv[1])"
    )
    command = [sys.executable, "-c", script, str(tmp_path / "quiet.npz")]
    quiet = subprocess.run(command, check=True, capture_output=True, text=True)
    assert (quiet.stdout, quiet.stderr) == ("", "")
    with caplog.at_level(logging.INFO, logger="beetle_ik"):
        bik.Trajectory.from_samples([0, 1], [[0.0], [1.0]]).to_npz(tmp_path / "motion.npz")
        batch = bik.solve_batch(IIWA, [(0.3, 0.3, 1.0)], threads=1)
    assert [record.getMessage() for record in caplog.records] == [
        f"wrote {tmp_path / 'motion.npz'}",
        f"solve_batch: {batch.message}",
    ]


def test_verbose_logs_to_stderr() -> None:
    command = [sys.executable, "-m", "beetle_ik", "--verbose", "track", "iiwa14", "--curve", "circle", "--dt", "0.5"]
    done = subprocess.run(command, check=False, capture_output=True, text=True)
    assert " beetle_ik: track: " in done.stderr


def test_a_robot_is_a_table_in_a_notebook() -> None:
    page = IIWA._repr_html_()
    assert page.startswith("<b>iiwa14</b>: 7 joints, ")
    assert page.count("<tr>") == 8
    assert page.count("<svg") == page.count("<polyline") == 2  # from the side and from above


def test_results_are_tables_in_a_notebook() -> None:
    solution = bik.solve(IIWA, (0.3, 0.3, 1.0))
    page = solution._repr_html_()
    assert page.startswith(f"<b>Solution SOLVED</b>: {solution.message}<table><tr><td>q [rad, m]</td>")
    assert "rotation_error" not in page
    batch = bik.solve_batch(IIWA, [(0.3, 0.3, 1.0)] * 30, threads=1)
    assert "array of shape (30, 7)" in batch._repr_html_()


def test_motions_scenes_and_maps_are_drawn_in_a_notebook() -> None:
    arm = bik.Robot.planar([0.4, 0.3]).with_capsules(radius=0.02)
    scene = bik.Scene([bik.obstacles.Box((0, 0, 0.5), (0.2, 0.2, 0.2)), bik.obstacles.Sphere((0.9, 0.9, 0.0), 0.1)])
    limits = bik.Limits(acceleration=5.0)
    plan = bik.plan_point_to_point(arm, start_q=[0, 1], end_q=[1, 1], obstacles=scene, limits=limits)
    page = plan._repr_html_()
    assert page.startswith(f"<b>Plan SOLVED</b>: {plan.message}<div><figure")
    assert (page.count("<svg"), page.count("<polygon")) == (3, 4)
    motion = plan.trajectory._repr_html_()
    assert motion.startswith(f"<b>Trajectory</b>: 2 joints, {plan.trajectory.duration:.6g} s, ")
    assert (motion.count("<polyline"), motion.count("<tr>")) == (2, 3)
    drawn = scene._repr_html_()
    assert (drawn.count("<polygon"), drawn.count("<tr>")) == (4, 3)
    assert bik.Scene()._repr_html_() == "<b>Scene</b>: 0 obstacles"
    cloud = bik.Scene([bik.obstacles.PointCloud(np.random.default_rng(0).random((1000, 3)), radius=0.01)] * 30)
    assert "18 more" in cloud._repr_html_()
    reached = bik.reachability(bik.Robot.planar([0.4, 0.3, 0.2]), voxel=0.2, rolls=2)
    for map_ in (reached, reached.inverse()):
        assert "<b>ReachabilityMap</b> of planar3" in map_._repr_html_()
        assert "<rect" in map_._repr_html_()


def test_a_drawing_shows_where_things_are() -> None:
    still = bik.Trajectory.from_samples([0.0, 1.0], [[0.5], [0.5]])
    points = re.findall(r'points="([^"]*)"', still._repr_html_())[0].split()
    assert {point.split(",")[1] for point in points} == {"80.0"}  # the middle
    box = bik.Scene([bik.obstacles.Box((5, 0, 0), (2, 1, 1))])._repr_html_()
    side = np.array([[float(x) for x in point.split(",")] for point in re.findall(r'points="([^"]*)"', box)[0].split()])
    np.testing.assert_allclose(np.ptp(side, axis=0), (214, 107), atol=0.1)  # twice as wide as high, as the box


@pytest.mark.parametrize("shape", ["ConvexMesh", "Mesh", "PointCloud"])
def test_a_long_list_is_shortened_in_a_repr(shape: str) -> None:
    points = np.random.default_rng(0).random((50, 3))
    more = {"ConvexMesh": (), "Mesh": ([(0, 1, 2)] * 9,), "PointCloud": (0.1,)}[shape]
    assert re.match(rf"obstacles.{shape}\(<\d+ points>", repr(getattr(bik.obstacles, shape)(points, *more)))


def test_names_are_escaped_in_a_notebook() -> None:
    robot = bik.Robot.from_dh(a=[1.0], alpha=[0.0], d=[0.0], name="<script>")
    assert "<script>" not in robot._repr_html_()
