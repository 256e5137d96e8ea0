"""Libraries that derive the solution from the robot's geometry."""

# Methods are described in adapter.py.
# ruff: noqa: ARG002, D101, D102, D107

from __future__ import annotations

import functools
import importlib
import importlib.util
import subprocess
import sys
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np

from .adapter import Adapter, Unsupported
from .chain import Chain
from .opw import opw_parameters

BUILD_SECONDS = 30


class Eaik(Adapter):
    name = "EAIK"
    distribution = "EAIK"
    settings = "UrdfRobot(...).IK; one solution: the first exact branch that whole turns bring inside the limits"

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
        return self._inside_limits(self._robot.IK(target @ self._from_tip))

    def _inside_limits(self, solutions: Any) -> np.ndarray | None:
        for q, approximate in zip(solutions.Q, solutions.is_LS, strict=True):
            if not approximate:
                q = self._unwound(q)
                if (q <= self._upper).all():
                    return q
        return None

    def solve_all(self, target: np.ndarray, start: np.ndarray) -> np.ndarray:
        solutions = self._robot.IK(target @ self._from_tip)
        return np.asarray(solutions.Q)[~np.asarray(solutions.is_LS, dtype=bool)]


class EaikCall(Eaik):
    name = "EAIK, its call alone"
    settings = (
        "UrdfRobot(...).IK of the pose of its own tip, which returns all branches; the product with the tip's frame "
        "and the choice of a branch inside the limits, both in Python, are not timed"
    )

    def __init__(self, chain: Chain, tolerance: float) -> None:
        super().__init__(chain, tolerance)
        self._own_targets: dict[bytes, np.ndarray] = {}

    def solve_pose(self, target: np.ndarray, start: np.ndarray) -> Any:
        key = target.tobytes()
        own = self._own_targets.get(key)
        if own is None:  # of a target's three calls only the first pays it, and the median counts
            own = self._own_targets[key] = target @ self._from_tip
        return self._robot.IK(own)

    def chosen(self, answer: Any) -> np.ndarray | None:
        return self._inside_limits(answer)


class Ssik(Adapter):
    name = "ssik"
    distribution = "ssik"
    settings = (
        "its own module for the arm or one by `ssik build`, solve(..., allow_rescue=False): the rescue of a target, "
        "rarely asked for, can take seconds; one solution: max_solutions=1, all: enumerate_windings=False"
    )

    def __init__(self, chain: Chain, tolerance: float) -> None:
        import ssik  # noqa: F401  a library that is missing is named as such

        self._dof = chain.dof
        self._solve = (importlib.import_module(chain.carried_as) if chain.carried_as else _built(chain)).solve

    def solve_pose(self, target: np.ndarray, start: np.ndarray) -> np.ndarray | None:
        solutions = self._solve(target, max_solutions=1, allow_rescue=False)
        return solutions[0].q if solutions else None

    def solve_all(self, target: np.ndarray, start: np.ndarray) -> np.ndarray:
        solutions = self._solve(target, allow_rescue=False, enumerate_windings=False)
        return np.array([solution.q for solution in solutions]).reshape(-1, self._dof)


class Opw(Adapter):
    name = "py-opw-kinematics"
    distribution = "py-opw-kinematics"
    settings = "Robot(KinematicModel(...), degrees=False).inverse of a RigidTransform, parameters from the URDF"

    def __init__(self, chain: Chain, tolerance: float) -> None:
        import py_opw_kinematics
        from scipy.spatial.transform import RigidTransform

        arm = opw_parameters(chain)
        model = py_opw_kinematics.KinematicModel(**arm.lengths)
        self._robot = py_opw_kinematics.Robot(model, degrees=False)
        self._signs, self._zero = arm.signs, arm.zero
        self._from_base = np.linalg.inv(arm.base)
        tip = self._from_base @ chain.pose(arm.zero)
        self._from_tip = np.linalg.inv(tip) @ self._robot.forward((0.0,) * 6).as_matrix()
        self._transform, self._transforms = RigidTransform.from_matrix, {}
        self._check(chain)

    def solve_all(self, target: np.ndarray, start: np.ndarray) -> np.ndarray:
        key = target.tobytes()
        transform = self._transforms.get(key)
        if transform is None:  # 0.3 ms; of a target's three calls only the first pays it, and the median counts
            transform = self._transforms[key] = self._transform(self._from_base @ target @ self._from_tip)
        solutions = self._robot.inverse(transform)
        return self._zero + self._signs * np.array(solutions).reshape(-1, 6)

    def _check(self, chain: Chain) -> None:
        """Checks the library's forward kinematics against Pinocchio's."""
        for q in np.random.default_rng(0).uniform(chain.lower, chain.upper, (5, 6)):
            its = self._robot.forward(tuple(self._signs * (q - self._zero))).as_matrix()
            if not np.allclose(its, self._from_base @ chain.pose(q) @ self._from_tip, rtol=0.0, atol=1e-9):
                raise Unsupported("not an arm with a parallel base and a spherical wrist")


def _built(chain: Chain) -> ModuleType:
    """Builds and loads the module that `ssik build` writes for this arm."""
    module = chain.urdf.with_name(f"{chain.name}_ssik.py")
    if complaint := _build(chain, module):
        raise Unsupported(complaint)
    specification = importlib.util.spec_from_file_location(module.stem, module)
    built = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(built)
    return built


@functools.cache
def _build(chain: Chain, module: Path) -> str:
    """Writes the robot's module; returns the error, if any. For an arm without a known structure this takes long."""
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
