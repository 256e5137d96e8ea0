"""Calibrations of arms with known errors, judged by forward kinematics in numpy."""

from __future__ import annotations

from typing import Any

import numpy as np

from .. import arms
from ..attack import Attack, BrokenError, Case

_KINDS = ("positions", "poses", "distances")
_PARTS = ("offsets", "links", "tool", "base")


class Calibrations(Attack):
    name = "calibrations"
    promise = "A calibrated arm fits its measurements at least as well as its model, and errors are as they are told"
    page = "calibration"

    def draw(self, random: np.random.Generator, hard: bool) -> Case:
        joints = arms.arm(random, hard, (1, 7))
        size = float(random.choice([0.0, 1e-3, 5e-3]))
        return {
            "joints": joints,
            "kind": str(random.choice(_KINDS)),
            "fit": [part for part in _PARTS if random.random() < 0.8] or ["offsets"],
            "count": int(random.choice([2, 20, 60])),
            "tool": arms.triple(random.choice([0.0, 0.0, 0.1], 3)),
            "errors": (size, size),
            "noise": float(random.choice([0.0, 1e-4, 1e-3])),
            "seed": int(random.integers(1000)),
        }

    def program(self, case: Case) -> str:
        length, angle = case["errors"]
        measured = {
            "positions": "tips[:, :3, 3] + noise",
            "poses": "tips",
            "distances": "np.linalg.norm(tips[:, :3, 3] - [3.0, 0.0, 0.1], axis=1) + noise[:, 0]",
        }[case["kind"]]
        center = ", center=[3.0, 0.01, 0.1]" if case["kind"] == "distances" else ""
        return (
            f"{arms.written(case['joints'])}robot = robot.with_tool(bik.pose({case['tool']}))\n"
            f"built = robot.with_errors(length={length}, angle={angle}, seed={case['seed']})\n"
            f"q = robot.random_configurations({case['count']}, seed={case['seed']})\n"
            f"noise = np.random.default_rng({case['seed']}).normal(0.0, {case['noise']}, ({case['count']}, 3))\n"
            "tips = built.fk(q)\n"
            f"measured = {measured}\n"
            f"found = bik.calibrate(robot, q, measured, fit={case['fit']}{center})\n"
        )

    def judge(self, case: Case, left: dict[str, Any]) -> int:
        found, q, measured, robot = (left[name] for name in ("found", "q", "measured", "robot"))
        kept = np.setdiff1d(np.arange(len(q)), found.outliers)
        size = 1.0 + np.abs(left["tips"][:, :3, 3]).max()

        def errors(arm: Any, center: Any) -> Any:
            tips = arm.fk(q)[:, :3, 3]
            if case["kind"] == "distances":
                return np.abs(np.linalg.norm(tips - center, axis=1) - measured)
            return np.linalg.norm(tips - (measured if measured.ndim == 2 else measured[:, :3, 3]), axis=1)

        after = errors(found.robot, found.center)
        before = errors(robot, [3.0, 0.01, 0.1])
        for what, told, right in (("before", found.errors_before, before), ("after", found.errors_after, after)):
            if not np.abs(told - right).max() < 1e-9 * size:
                raise BrokenError(f"the errors {what} are not as told", np.abs(told - right).max())
        if case["kind"] != "poses" and not found.rms_after <= found.rms_before * (1 + 1e-6) + 1e-6 * size:
            raise BrokenError("the calibrated arm is worse", (found.rms_before, found.rms_after))
        if not abs(np.sqrt((after[kept] ** 2).mean()) - found.rms_after) < 1e-9 * size:
            raise BrokenError("the root mean square is not as told", found.rms_after)
        if not np.isfinite(found.covariance).all():
            raise BrokenError("the covariance is none")
        spread = np.linalg.eigvalsh(found.covariance)
        if spread.min() < -1e-11 * max(spread.max(), 1.0):  # more than rounding
            raise BrokenError("the covariance is none")
        known = found.identifiable
        if not 0 <= known.rank <= known.possible <= len(found.parameters):
            raise BrokenError("the rank is impossible", (known.rank, known.possible))
        return len(q)


ATTACKS = [Calibrations()]
