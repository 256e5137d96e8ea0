"""Libraries that derive the solution from the robot's geometry."""

# The methods are described in adapter.py.
# ruff: noqa: ARG002, D101, D102, D107

from __future__ import annotations

import functools
import importlib.util
import subprocess
import sys
from pathlib import Path

import numpy as np

from .adapter import Adapter, Unsupported
from .chain import Chain

BUILD_SECONDS = 30


class Eaik(Adapter):
    name = "EAIK"
    distribution = "EAIK"
    settings = "UrdfRobot(...).IK, first exact branch that whole turns bring inside the limits"

    def __init__(self, chain: Chain, tolerance: float) -> None:
        from eaik.IK_URDF import UrdfRobot

        if chain.dof > 6:
            raise Unsupported("a redundant arm only with joints locked")
        self._robot = UrdfRobot(str(chain.urdf))
        if not self._robot.hasKnownDecomposition():
            raise Unsupported(f"no decomposition known: {self._robot.getKinematicFamily()}")
        zero = np.zeros(chain.dof)
        # EAIK's tip is the last joint, world-aligned at zero.
        self._from_tip = np.linalg.inv(chain.pose(zero)) @ self._robot.fwdKin(zero)
        self._unwound, self._upper = chain.unwound, chain.upper

    def solve_pose(self, target: np.ndarray, start: np.ndarray) -> np.ndarray | None:
        solutions = self._robot.IK(target @ self._from_tip)
        for q, approximate in zip(solutions.Q, solutions.is_LS, strict=True):
            if not approximate:
                q = self._unwound(q)
                if (q <= self._upper).all():
                    return q
        return None


class Ssik(Adapter):
    name = "ssik"
    distribution = "ssik"
    settings = (
        "module built for the robot by `ssik build`, solve(..., max_solutions=1, allow_rescue=False): "
        "the rescue of a target, rarely asked for, can take seconds"
    )

    def __init__(self, chain: Chain, tolerance: float) -> None:
        import ssik  # noqa: F401  a library that is missing is named as such

        module = chain.urdf.with_name(f"{chain.name}_ssik.py")
        if complaint := _build(chain, module):
            raise Unsupported(complaint)
        specification = importlib.util.spec_from_file_location(module.stem, module)
        built = importlib.util.module_from_spec(specification)
        specification.loader.exec_module(built)
        self._solve = built.solve

    def solve_pose(self, target: np.ndarray, start: np.ndarray) -> np.ndarray | None:
        solutions = self._solve(target, max_solutions=1, allow_rescue=False)
        return solutions[0].q if solutions else None


@functools.cache
def _build(chain: Chain, module: Path) -> str:
    """Write the robot's module; what went wrong, or nothing. For an arm without a known structure this is long."""
    command = "import sys; from ssik.cli import main; sys.exit(main())"
    request = ["build", chain.urdf, "--base", chain.base, "--ee", chain.tip, "--out", module, "--no-validate"]
    try:
        subprocess.run(
            [sys.executable, "-c", command, *request], check=True, capture_output=True, timeout=BUILD_SECONDS
        )
    except subprocess.TimeoutExpired:
        return f"`ssik build` takes more than {BUILD_SECONDS} s"
    except subprocess.CalledProcessError as failure:
        return f"`ssik build` fails: {failure.stderr.decode().strip().splitlines()[-1]}"
    return ""
