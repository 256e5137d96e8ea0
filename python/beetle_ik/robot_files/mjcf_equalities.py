"""Equality constraints of a MuJoCo model: couplings are followed, and MuJoCo says which of the others are kept."""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any, NamedTuple

import numpy as np
from numpy.polynomial import Polynomial

from .._core import InvalidInputError, Robot

_CLOSED = 1e-4
"""Residual (m, rad) up to which an equality counts as kept: the rounding of numbers in files."""
_CONFIGURATIONS = 8
_ROUNDING = 1e-9
"""Excess over a range (rad, m) that counts as rounding, and relative imaginary part of a double root."""


class Drive(NamedTuple):
    """Position of a joint: scale times the position of another joint plus offset, or offset alone without one."""

    master: int | None
    scale: float
    offset: float


class Curve(NamedTuple):
    """Position of a joint: a polynomial of the position of another joint, not linear."""

    leader: int
    polynomial: Polynomial


@dataclass(frozen=True)
class Open:
    """An equality that a robot does not keep: its description, the joints it couples, and its residual (m, rad)."""

    described: str
    joints: set[int]
    residual: float


class Equalities:
    """The active equality constraints of a model, and the joints that couplings drive."""

    def __init__(self, mujoco: Any, model: Any, joints: Sequence[str]) -> None:
        """Solves the linear equalities, then the polynomial ones; `joints` are the names of all joints."""
        self.mujoco, self.model, self.joints = mujoco, model, joints
        off = mujoco.mjtDisableBit.mjDSBL_EQUALITY | mujoco.mjtDisableBit.mjDSBL_CONSTRAINT
        self.active = [] if model.opt.disableflags & off else [int(i) for i in np.flatnonzero(model.eq_active0)]
        self.drives: dict[int, Drive] = {}
        self.curves: dict[int, Curve] = {}
        equations = [equation for equality in self.active for equation in self._linear(equality)]
        self._coupled = [set(factors) for factors, _ in equations]
        self._coupled += [set(self._ends(equality)) for equality in self.active if self._is_bend(equality)]
        self._solve(equations)
        for equality in self.active:
            self._follow_curve(equality)

    def lock(self, joint: int) -> float | None:
        """Returns the position (rad, m) at which a joint is locked; None for a joint that moves."""
        drive = self.drives.get(joint)
        return drive.offset if drive and drive.master is None else None

    def require_lock_in_range(self, joint: int) -> None:
        """Raises `InvalidInputError` for a joint that is locked outside its range."""
        locked, (lower, upper) = self.lock(joint), map(float, self.model.jnt_range[joint])
        if locked is None or not self.model.jnt_limited[joint] or lower - _CLOSED <= locked <= upper + _CLOSED:
            return
        raise InvalidInputError(
            f"MuJoCo model: equalities lock joint '{self.joints[joint]}' at {locked:.4g}, outside its range from "
            f"{lower:.4g} to {upper:.4g}: leave out one of them (active='false'), or widen the range"
        )

    def leader(self, joint: int) -> str | None:
        """Returns the name of the independent joint that moves a joint; None for a locked one."""
        first = self._first(joint)
        return None if first is None else self.joints[first]

    def _first(self, joint: int) -> int | None:
        """Returns the independent joint that moves a joint; None for a locked one."""
        if joint in self.curves:
            return self._first(self.curves[joint].leader)
        master = self.drives.get(joint, Drive(joint, 1.0, 0.0)).master
        return master if master is None or master == joint else self._first(master)

    def position(self, joint: int, first: float) -> float:
        """Returns the position of a joint for that of the independent joint that moves it."""
        if joint in self.curves:
            leader, polynomial = self.curves[joint]
            return float(polynomial(self.position(leader, first)))
        master, scale, offset = self.drives.get(joint, Drive(joint, 1.0, 0.0))
        if master is None:
            return offset
        return first if master == joint else scale * self.position(master, first) + offset

    def range(self, joint: int) -> tuple[float, float] | None:
        """Returns the range of a joint (rad, m); None for one without limits.

        The followers of a joint by a polynomial stay within their ranges: of several stretches in which they do, it is
        that with the reference position of the joint, or the nearest.

        Raises:
            InvalidInputError: a follower stays within its range nowhere.
        """
        model = self.model
        followers = [follower for follower, curve in self.curves.items() if curve.leader == joint]
        lower, upper = map(float, model.jnt_range[joint]) if model.jnt_limited[joint] else (-np.inf, np.inf)
        for follower in followers:
            if model.jnt_limited[follower]:
                within = self._within(follower, lower, upper)
                if within is None:
                    raise InvalidInputError(
                        f"MuJoCo model: joint '{self.joints[follower]}' follows '{self.joints[joint]}' by a "
                        f"polynomial, and leaves its range wherever '{self.joints[joint]}' is inside its own"
                    )
                lower, upper = within
        return (lower, upper) if np.isfinite(lower) or np.isfinite(upper) else None

    def _within(self, follower: int, lower: float, upper: float) -> tuple[float, float] | None:
        """Returns the stretch between two positions of its leader in which a follower stays within its range."""
        leader, polynomial = self.curves[follower]
        rest = float(np.clip(self.model.qpos0[self.model.jnt_qposadr[leader]], lower, upper))
        limits = self.model.jnt_range[follower]
        crossings = np.concatenate([(polynomial - limit).roots() for limit in limits])
        real = np.real(crossings[np.abs(np.imag(crossings)) < _ROUNDING * (1.0 + np.abs(crossings))])
        ends = [lower, *sorted(float(at) for at in real if lower < at < upper), upper]
        stretches: list[tuple[float, float]] = []
        for start, end in pairwise(ends):
            middle = start + 1.0 if end == np.inf else end - 1.0 if start == -np.inf else 0.5 * (start + end)
            if not limits[0] - _ROUNDING <= polynomial(middle) <= limits[1] + _ROUNDING:
                continue
            if stretches and stretches[-1][1] == start:
                start = stretches.pop()[0]
            stretches.append((start, end))
        return min(stretches, key=lambda ends: max(ends[0] - rest, rest - ends[1]), default=None)

    def coupled_with(self, joints: set[int]) -> set[int]:
        """Returns these joints and all that equalities of joints couple with them."""
        while more := {joint for each in self._coupled if each & joints for joint in each} - joints:
            joints = joints | more
        return joints

    def open_in(self, robot: Robot) -> Iterator[Open]:
        """Yields the equalities that configurations of the robot do not keep."""
        if not self.active:
            return
        mujoco, model, data = self.mujoco, self.model, self.mujoco.MjData(self.model)
        residuals: dict[int, float] = {}
        touched: dict[int, set[int]] = {}
        for q in robot.random_configurations(_CONFIGURATIONS, seed=0):
            data.qpos[:] = self._qpos(robot, q)
            for compute in (mujoco.mj_kinematics, mujoco.mj_comPos, mujoco.mj_tendon, mujoco.mj_makeConstraint):
                compute(model, data)
            jacobian = self._jacobian(data)
            for row in np.flatnonzero(data.efc_type == int(mujoco.mjtConstraint.mjCNSTR_EQUALITY)):
                equality = int(data.efc_id[row])
                residuals[equality] = max(residuals.get(equality, 0.0), abs(float(data.efc_pos[row])))
                moves = np.flatnonzero(np.abs(jacobian[row]) > _CLOSED * np.abs(jacobian[row]).max(initial=0.0))
                joints = self.between(self._bodies(equality)) or {int(model.dof_jntid[dof]) for dof in moves}
                touched[equality] = touched.get(equality, set()) | joints
        for equality, residual in residuals.items():
            if residual > _CLOSED and not self._is_free(equality, touched[equality]):
                yield Open(self._described(equality), touched[equality], residual)

    def _jacobian(self, data: Any) -> Any:
        rows, dofs = data.nefc, self.model.nv
        if not self.mujoco.mj_isSparse(self.model):
            # MuJoCo leaves out rows of zeros, and keeps room for them.
            return np.reshape(np.ravel(data.efc_J)[: rows * dofs], (rows, dofs))
        dense = np.zeros((rows, dofs))
        self.mujoco.mju_sparse2dense(
            dense, np.ravel(data.efc_J), data.efc_J_rownnz, data.efc_J_rowadr, np.ravel(data.efc_J_colind)
        )
        return dense

    def _qpos(self, robot: Robot, q: Any) -> Any:
        """Returns the positions of all joints of the model; those without an axis stay where the model has them."""
        known = dict(zip(robot.joint_names, q, strict=True)) | robot.held_joints
        positions = np.array(self.model.qpos0)
        for joint in range(len(self.joints)):
            first = self._first(joint)
            at = 0.0 if first is None else known.get(self.joints[first])
            if at is not None:
                positions[self.model.jnt_qposadr[joint]] = self.position(joint, at)
        return positions

    def _is_free(self, equality: int, joints: set[int]) -> bool:
        """Whether a free body follows: one that is moved by hand (mocap), or one with a free joint."""
        if any(self._joint_kind(joint) == "mjJNT_FREE" for joint in joints):
            return True
        return any(self.model.body_mocapid[self.model.body_rootid[body]] >= 0 for body in self._bodies(equality))

    def _joint_kind(self, joint: int) -> str:
        name: str = self.mujoco.mjtJoint(self.model.jnt_type[joint]).name
        return name

    def _kind(self, equality: int) -> str:
        name: str = self.mujoco.mjtEq(self.model.eq_type[equality]).name
        return name.removeprefix("mjEQ_").lower()

    def _ends(self, equality: int) -> list[int]:
        """Returns the indices of the one or two objects that an equality couples."""
        ends = (int(self.model.eq_obj1id[equality]), int(self.model.eq_obj2id[equality]))
        return [end for end in ends if end >= 0]

    def _bodies(self, equality: int) -> list[int]:
        """Returns the two bodies of a connect or weld."""
        if self._kind(equality) not in ("connect", "weld"):
            return []
        of_sites = self.model.eq_objtype[equality] == int(self.mujoco.mjtObj.mjOBJ_SITE)
        return [int(self.model.site_bodyid[end]) if of_sites else end for end in self._ends(equality)]

    def between(self, bodies: Iterable[int]) -> set[int]:
        """Returns the joints on the way between two bodies; the empty set without bodies.

        The Jacobian of an open loop would name those below both bodies too, which turn the gap.
        """
        joints: set[int] = set()
        for body in bodies:
            at = body
            while at > 0:
                first, count = self.model.body_jntadr[at], self.model.body_jntnum[at]
                joints ^= set(range(first, first + count))
                at = int(self.model.body_parentid[at])
        return joints

    def _described(self, equality: int) -> str:
        """Returns kind, name and ends of an equality, for messages."""
        model, kind, ends = self.model, self._kind(equality), self._ends(equality)
        if bodies := self._bodies(equality):
            ends_shown = [f"'{model.body(body).name or f'body_{body}'}'" for body in bodies]
        elif kind == "tendon":
            ends_shown = [f"'{model.tendon(end).name or f'tendon_{end}'}'" for end in ends]
        else:
            ends_shown = [f"'{self.joints[end]}'" for end in ends] if kind == "joint" else []
        name = model.equality(equality).name
        of = f" of {' and '.join(ends_shown)}" if ends_shown else ""
        return f"the {kind} equality" + (f" '{name}'" if name else "") + of

    def _linear(self, equality: int) -> Iterator[tuple[dict[int, float], float]]:
        """Yields the equation of a linear equality: factors by joint, the follower first, and their weighted sum."""
        model, kind, ends = self.model, self._kind(equality), self._ends(equality)
        if kind == "weld":
            yield from self._weld(equality)
        constant, scale, *bends = (float(factor) for factor in model.eq_data[equality][:5])
        if kind not in ("joint", "tendon") or (len(ends) == 2 and any(bends)):
            return
        if kind == "joint":
            sides: list[dict[int, float] | None] = [{end: 1.0} for end in ends]
            rests = [float(model.qpos0[model.jnt_qposadr[end]]) for end in ends]
        else:
            sides = [self._tendon(end) for end in ends]
            rests = [float(model.tendon_length0[end]) for end in ends]
        factors, total = dict[int, float](), constant
        for side, rest, sign in zip(sides, rests, (1.0, -scale), strict=False):
            if side is None:
                return
            total += sign * rest
            for joint, factor in side.items():
                factors[joint] = factors.get(joint, 0.0) + sign * factor
        yield factors, total

    def _follow_curve(self, equality: int) -> None:
        """Lets a joint follow another one by the polynomial of an equality, unless something else moves it already."""
        if not self._is_bend(equality):
            return
        model, ends = self.model, self._ends(equality)
        follower, leader = ends
        if follower in self.drives or follower in self.curves or self._first(leader) == follower:
            return
        own, other = (float(model.qpos0[model.jnt_qposadr[end]]) for end in ends)
        polynomial = Polynomial(np.array(model.eq_data[equality][:5]))(Polynomial([-other, 1.0])) + own
        if self._first(leader) is None:
            self.drives[follower] = Drive(None, 1.0, float(polynomial(self.position(leader, 0.0))))
        elif not self._is_curved(leader) and follower not in {curve.leader for curve in self.curves.values()}:
            self.curves[follower] = Curve(leader, polynomial)

    def _is_bend(self, equality: int) -> bool:
        """Whether an equality couples two joints by a polynomial that is no line."""
        bends = bool(self.model.eq_data[equality][2:5].any())
        return self._kind(equality) == "joint" and len(self._ends(equality)) == 2 and bends

    def _is_curved(self, joint: int | None) -> bool:
        """Whether a joint follows another one by a polynomial, itself or through others."""
        while joint is not None and joint not in self.curves:
            before, joint = joint, self.drives.get(joint, Drive(joint, 1.0, 0.0)).master
            if before == joint:
                return False
        return joint is not None

    def _weld(self, equality: int) -> Iterator[tuple[dict[int, float], float]]:
        """Yields the lock of a weld across one hinge or slide."""
        joints = self.between(self._bodies(equality))
        if len(joints) == 1 and not self._is_free(equality, joints):
            (joint,) = joints
            if self._joint_kind(joint) in ("mjJNT_HINGE", "mjJNT_SLIDE"):
                yield {joint: 1.0}, float(self.model.qpos0[self.model.jnt_qposadr[joint]])

    def _tendon(self, tendon: int) -> dict[int, float] | None:
        """Returns the coefficients of joints in the length of a fixed tendon, later joints first; None for others."""
        model = self.model
        factors: dict[int, float] = {}
        first, count = model.tendon_adr[tendon], model.tendon_num[tendon]
        for wrap in range(first, first + count):
            if model.wrap_type[wrap] != int(self.mujoco.mjtWrap.mjWRAP_JOINT):
                return None
            joint = int(model.wrap_objid[wrap])
            factors[joint] = factors.get(joint, 0.0) + float(model.wrap_prm[wrap])
        return dict(sorted(factors.items(), reverse=True))

    def _solve(self, equations: list[tuple[dict[int, float], float]]) -> None:
        """Makes each equation of one or two independent joints a drive, until none is left."""
        found = True
        while found:
            found = False
            for equation in list(equations):
                factors, total = self._reduced(*equation)
                if len(factors) > 2:
                    continue
                equations.remove(equation)
                if factors:
                    self._drive(factors, total)
                    found = True

    def _reduced(self, factors: dict[int, float], total: float) -> tuple[dict[int, float], float]:
        """Expresses an equation by independent joints."""
        reduced: dict[int, float] = {}
        for joint, factor in factors.items():
            master, scale, offset = self.drives.get(joint, Drive(joint, 1.0, 0.0))
            total -= factor * offset
            if master is not None:
                reduced[master] = reduced.get(master, 0.0) + factor * scale
        return {joint: factor for joint, factor in reduced.items() if abs(factor) > 1e-12}, total

    def _drive(self, factors: dict[int, float], total: float) -> None:
        """Lets the first joint of an equation, and its followers, follow the second; locks it without one."""
        (follower, own), *others = factors.items()
        master, factor = others[0] if others else (None, 0.0)
        self.drives[follower] = Drive(follower, 1.0, 0.0)
        for joint, drive in self.drives.items():
            if drive.master == follower:
                offset = drive.offset + drive.scale * total / own
                self.drives[joint] = Drive(master, -drive.scale * factor / own, offset)
