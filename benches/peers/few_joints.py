"""Arms with four and five joints, and libraries that weigh the position against the orientation."""

# Methods are described in adapter.py.
# ruff: noqa: ARG002, D101, D102, D107

from __future__ import annotations

import tempfile
from pathlib import Path

import numpy as np

import beetle_ik as bik

from .adapter import Adapter
from .chain import Chain
from .local import MAX_STEPS
from .stepping import LM_DAMPING, Mink, Placo

Vector = tuple[float, float, float]
Joint = tuple[Vector, Vector, float, float]  # origin (m), axis, limits (rad)

X, Y, Z = (1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)
PAN_TO_FLEX: list[Joint] = [
    ((0.04, 0, 0.06), Z, -1.9, 1.9),
    ((0.03, 0, 0.055), Y, -1.75, 1.75),
    ((0.03, 0, 0.115), Y, -1.7, 1.7),
    ((0.135, 0, 0), Y, -1.65, 1.65),
]
ROLL: Joint = ((0.06, 0, 0), X, -2.7, 2.8)
ARMS: dict[str, tuple[list[Joint], Vector]] = {
    "hobby arm, four joints": (PAN_TO_FLEX, (0.1, 0, 0)),
    "hobby arm, five joints": ([*PAN_TO_FLEX, ROLL], (0.1, 0, 0)),
    "the same, tip 22 mm off the last axis": ([*PAN_TO_FLEX, ROLL], (0.1, 0.02, 0.01)),
    "youBot arm": (
        [
            ((0.024, 0, 0.115), (0, 0, -1), -2.95, 2.95),
            ((0.033, 0, 0), Y, -1.13, 1.57),
            ((0, 0, 0.155), Y, -2.63, 2.55),
            ((0, 0, 0.135), Y, -1.78, 1.78),
            ((0, 0, 0.1136), (0, 0, -1), -2.92, 2.92),
        ],
        (0, 0, 0.1),
    ),
    "four joints, roll before the tip": (
        [
            ((0, 0, 0.05), Z, -2.8, 2.8),
            ((0.02, 0, 0.04), Y, -1.9, 1.9),
            ((0.12, 0, 0), Y, -2.4, 2.4),
            ((0.11, 0, 0.02), X, -2.9, 2.9),
        ],
        (0.08, 0.03, 0),
    ),
    "five joints, roll before pitch": (
        [
            ((0, 0, 0.1), Z, -3, 3),
            ((0, 0, 0.1), Y, -2, 2),
            ((0.25, 0, 0), Y, -2.5, 2.5),
            ((0.2, 0, 0), X, -2.9, 2.9),
            ((0.05, 0, 0), Y, -2, 2),
        ],
        (0.1, 0, 0),
    ),
}
WEIGHT = 0.01  # of the rotation against the position
LEAST_STEP = 1e-7  # rad; ends a descent


def arms() -> list[Chain]:
    """Returns the arms, written as files of a scratch folder."""
    folder = Path(tempfile.mkdtemp())
    return [written(name, *arm, folder / f"{k}.urdf") for k, (name, arm) in enumerate(ARMS.items())]


def written(name: str, joints: list[Joint], tip: Vector, file: Path) -> Chain:
    """Writes an arm as a file with masses, which simulators want."""
    mass = "<inertial><mass value='1'/><inertia ixx='1' iyy='1' izz='1' ixy='0' ixz='0' iyz='0'/></inertial>"
    text = f"<robot name='arm'><link name='base'>{mass}</link>"
    fixed: Joint = (tip, X, 0, 0)
    for k, (origin, axis, lower, upper) in enumerate([*joints, fixed]):
        last = k == len(joints)
        parent, child = "base" if k == 0 else f"l{k}", "tip" if last else f"l{k + 1}"
        text += (
            f"<link name='{child}'>{mass}</link><joint name='j{k + 1}' type='{'fixed' if last else 'revolute'}'>"
            f"<parent link='{parent}'/><child link='{child}'/><origin xyz='{' '.join(map(str, origin))}'/>"
            f"<axis xyz='{' '.join(map(str, axis))}'/>"
            f"<limit lower='{lower}' upper='{upper}' velocity='3' effort='1'/></joint>"
        )
    file.write_text(text + "</robot>")
    return Chain(name, file, "base", "tip")


class PositionFirst(Adapter):
    name = "beetle-ik"
    distribution = "beetle-ik"
    settings = "solve with its defaults: the position first"

    def __init__(self, chain: Chain, tolerance: float) -> None:
        self._robot = bik.Robot.from_urdf(chain.urdf, tip=chain.tip)

    def solve_pose(self, target: np.ndarray, start: np.ndarray) -> np.ndarray | None:
        return bik.solve(self._robot, target, start_q=start).q


class WeightedClik(Adapter):
    name = "pinocchio CLIK"
    distribution = "pin"
    settings = f"damped Newton on position and {WEIGHT:g} log3 (damping 1e-9, full step), clamped, {MAX_STEPS} steps"

    def __init__(self, chain: Chain, tolerance: float) -> None:
        import pinocchio as pin

        self._pin, self._model, self._data = pin, chain.model, chain.model.createData()
        self._tip, self._damping = chain.tip_frame, 1e-9 * np.eye(chain.dof)

    def solve_pose(self, target: np.ndarray, start: np.ndarray) -> np.ndarray | None:
        pin, model, data, q = self._pin, self._model, self._data, start
        frame = pin.ReferenceFrame.LOCAL_WORLD_ALIGNED
        for _ in range(MAX_STEPS):
            jacobian = pin.computeFrameJacobian(model, data, q, self._tip, frame)
            tip = data.oMf[self._tip]
            turn = target[:3, :3] @ tip.rotation.T
            error = np.concatenate((target[:3, 3] - tip.translation, WEIGHT * pin.log3(turn)))
            jacobian[3:] = WEIGHT * (pin.Jlog3(turn) @ jacobian[3:])
            step = np.linalg.solve(jacobian.T @ jacobian + self._damping, jacobian.T @ error)
            last, q = q, np.clip(q + step, model.lowerPositionLimit, model.upperPositionLimit)
            if np.abs(q - last).max() < LEAST_STEP:
                break
        return q


class WeightedPlaco(Placo):
    settings = f"soft frame task, position 1, orientation {WEIGHT**2:g}, joint limits, {MAX_STEPS} steps"

    def __init__(self, chain: Chain, tolerance: float) -> None:
        super().__init__(chain, tolerance)
        self._frame.configure("pose", "soft", 1.0, WEIGHT**2)

    def solve_pose(self, target: np.ndarray, start: np.ndarray) -> np.ndarray | None:
        return settled(self, target, start)


class WeightedMink(Mink):
    settings = f"FrameTask(position_cost=1, orientation_cost={WEIGHT:g}), limits, {MAX_STEPS} steps"

    def __init__(self, chain: Chain, tolerance: float) -> None:
        super().__init__(chain, tolerance)
        self._pose = self._library.FrameTask(
            chain.tip, "body", position_cost=1.0, orientation_cost=WEIGHT, lm_damping=LM_DAMPING
        )

    def solve_pose(self, target: np.ndarray, start: np.ndarray) -> np.ndarray | None:
        return settled(self, target, start)


def settled(library: Placo | Mink, target: np.ndarray, start: np.ndarray) -> np.ndarray | None:
    """Steps until the joints rest: an error that cannot vanish ends no loop."""
    library._place(start)
    library._aim_at_pose(target)
    last = library._configuration()
    for _ in range(MAX_STEPS):
        try:
            library._step()
        except library._no_step:
            return last
        q = library._configuration()
        if np.abs(q - last).max() < LEAST_STEP:
            return q
        last = q
    return last
