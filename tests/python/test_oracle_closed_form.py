"""`solve_all` against other closed forms, and poses of arms that are not built in."""

import sys
from pathlib import Path

import numpy as np
import pytest
from oracle import SHARED, needs_shared

import beetle_ik as bik

pytest.importorskip("pinocchio", reason="Pinocchio is not installed")
sys.path.insert(0, str(Path(__file__).parents[2] / "benches"))

from peers import closed_form, completeness
from peers.chain import Chain, load_chains

OTHERS = [
    (closed_form.Eaik, "eaik", ["ur5", "kr210"]),
    (closed_form.Ssik, "ssik", ["ur5", "kr210"]),
    (closed_form.Opw, "py_opw_kinematics", ["kr210"]),
]
ROBOTS = sorted(path.stem for path in (SHARED / "robots").glob("*.urdf"))


def chain_of(name: str, scratch: Path) -> Chain:
    """The chain of a shared URDF."""
    return load_chains([SHARED / "robots" / f"{name}.urdf"], scratch)[0]


def robot_of(chain: Chain) -> bik.Robot:
    """The same chain in this library."""
    return bik.Robot.from_urdf(chain.urdf, base=chain.base, tip=chain.tip)


@needs_shared
@pytest.mark.parametrize(
    ("library", "module", "name"), [(library, module, name) for library, module, names in OTHERS for name in names]
)
def test_no_solution_of_another_library_is_missing(library: type, module: str, name: str, tmp_path: Path) -> None:
    pytest.importorskip(module, reason=f"{module} is not installed")
    chain = chain_of(name, tmp_path)
    robot, other = robot_of(chain), library(chain, 1e-6)
    targets, starts = chain.targets(100)
    ours = [bik.solve_all(robot, target) for target in targets]
    theirs = [other.solve_all(target, start) for target, start in zip(targets, starts, strict=True)]
    verdict = completeness.judge(chain, targets, [found.q for found in ours], theirs)
    assert verdict.missing == []
    assert verdict.wrong == 0
    assert sum(found.complete for found in ours) >= 90  # beside singular poses nothing is claimed


@needs_shared
@pytest.mark.parametrize("name", ROBOTS)
def test_every_reachable_pose_of_an_arm_is_solved(name: str, tmp_path: Path) -> None:
    chain = chain_of(name, tmp_path)
    robot = robot_of(chain)
    targets, _ = chain.targets(1000)
    batch = bik.solve_batch(robot, targets, threads=1)
    assert batch.success.all()
    assert np.array_equal(batch.q, bik.solve_batch(robot, targets, threads=2).q)
    assert ((robot.lower <= batch.q) & (batch.q <= robot.upper)).all()
    for target, q in zip(targets[:100], batch.q[:100], strict=True):
        np.testing.assert_allclose(chain.pose(q), target, atol=2e-6)
