"""Random serial arms as plain data, their URDF, and their kinematics by numpy alone."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Joint = dict[str, Any]

AXES = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
TURNED = ("revolute", "continuous")


def triple(values: Any) -> tuple[float, float, float]:
    """Three numbers as plain data."""
    x, y, z = map(float, values)
    return x, y, z


def easy_arm(random: np.random.Generator, count: int) -> list[Joint]:
    """Draws an arm of revolute joints, some of them prismatic, with lengths and limits like those of real ones."""
    return [_joint(random) for _ in range(count)]


def hard_arm(random: np.random.Generator, count: int) -> list[Joint]:
    """Draws an arm with links of no length, joints on one axis, parallel axes, followers, and limits without width."""
    joints = easy_arm(random, count)
    scale = float(random.choice([1.0, 1.0, 1.0, 1e-3, 1e3]))
    for before, joint in zip([None, *joints], joints, strict=False):
        joint["xyz"] = triple(scale * np.array(joint["xyz"]))
        match random.integers(8):
            case 0:
                joint["xyz"] = (0.0, 0.0, 0.0)
            case 1 if before:
                joint.update(xyz=(0.0, 0.0, 0.0), rpy=(0.0, 0.0, 0.0), axis=before["axis"])
            case 2 if before:
                joint.update(rpy=(0.0, 0.0, 0.0), axis=before["axis"])
            case 3:
                joint["follows"] = (float(random.choice([1.0, -1.0, 0.0, 0.5])), float(random.choice([0.0, 0.3])))
            case 4:
                joint["upper"] = joint["lower"] = float(random.choice([0.0, 0.5]))
            case 5:
                joint.update(lower=-1e6, upper=1e6)
            case 6:
                joint["axis"] = triple(np.array(joint["axis"]) * 10.0 ** random.uniform(-6, 6))
    return joints


def arm(random: np.random.Generator, hard: bool, counts: tuple[int, int] = (2, 8)) -> list[Joint]:
    """Draws an easy or a hard arm of `counts` joints."""
    return (hard_arm if hard else easy_arm)(random, int(random.integers(counts[0], counts[1] + 1)))


def _joint(random: np.random.Generator) -> Joint:
    square = random.random() < 0.5
    kind = str(random.choice(["revolute", "revolute", "revolute", "continuous", "prismatic"]))
    width = 0.4 if kind == "prismatic" else 2.8
    return {
        "kind": kind,
        "xyz": triple(random.uniform(-0.4, 0.4, 3)),
        "rpy": triple(random.choice([-0.5, 0.0, 0.5], 3) * np.pi if square else random.uniform(-3, 3, 3)),
        "axis": AXES[random.integers(3)] if square else triple(random.normal(size=3)),
        "lower": -float(width * random.uniform(0.2, 1.0)),
        "upper": float(width * random.uniform(0.2, 1.0)),
        "follows": None,  # factor and offset of a joint that follows the one before it
        "at": (0.0,),  # its values in the configurations of the case
    }


def masters(joints: list[Joint]) -> list[int]:
    """For each joint the one that it follows, or itself."""
    found: list[int] = []
    for i, joint in enumerate(joints):
        found.append(found[-1] if joint["follows"] and found else i)
    return found


def free(joints: list[Joint]) -> list[Joint]:
    """The joints that follow no other."""
    return [joint for i, joint in enumerate(joints) if masters(joints)[i] == i]


def urdf(*branches: list[Joint]) -> str:
    """A robot as URDF: an arm from link "l0" on, and, if more are given, branches from its first moving link on.

    Links are named l0, l1 and so on, those of later branches a1, a2, and b1, b2; joints lj0, lj1 and so on.
    """
    links, text = "<link name='l0'/>", ""
    for name, joints in zip("labc", branches, strict=False):
        followed, parent = masters(joints), "l0" if name == "l" else "l1"
        for i, joint in enumerate(joints):
            x, y, z = (" ".join(map(repr, joint[key])) for key in ("xyz", "rpy", "axis"))
            factor, offset = joint["follows"] or (1.0, 0.0)
            mimic = f"<mimic joint='{name}j{followed[i]}' multiplier='{factor!r}' offset='{offset!r}'/>"
            child = f"{name}{i + 1}"
            links += f"<link name='{child}'/>"
            text += (
                f"<joint name='{name}j{i}' type='{joint['kind']}'><parent link='{parent}'/><child link='{child}'/>"
                f"<origin xyz='{x}' rpy='{y}'/><axis xyz='{z}'/>"
                f"<limit lower='{joint['lower']!r}' upper='{joint['upper']!r}' velocity='1' effort='1'/>"
                f"{mimic if followed[i] != i else ''}</joint>"
            )
            parent = child
    return f"<robot name='arm'>{links}{text}</robot>"


def written(*branches: list[Joint], tips: str = "") -> str:
    """The line of Python that makes the robot."""
    return f'robot = bik.Robot.from_urdf("""{urdf(*branches)}"""{tips})\n'


def bounds(joints: list[Joint]) -> tuple[Array, Array]:
    """Lowest and highest value of each free joint (n,), by the URDF: those that follow it keep their limits too."""
    lower, upper = (np.full(len(joints), bound) for bound in (-np.inf, np.inf))
    follow = masters(joints)
    factor, offset = _couplings(joints)
    for i, joint in enumerate(joints):
        if joint["kind"] == "continuous" or factor[i] == 0.0:
            continue
        ends = sorted((np.array([joint["lower"], joint["upper"]]) - offset[i]) / factor[i])
        lower[follow[i]], upper[follow[i]] = max(lower[follow[i]], ends[0]), min(upper[follow[i]], ends[1])
    kept = [i for i, master in enumerate(follow) if master == i]
    return lower[kept], upper[kept]


def _couplings(joints: list[Joint]) -> tuple[list[float], list[float]]:
    pairs = [
        joint["follows"] if master != i else (1.0, 0.0)
        for (i, master), joint in zip(enumerate(masters(joints)), joints, strict=True)
    ]
    return [pair[0] for pair in pairs], [pair[1] for pair in pairs]


def values(joints: list[Joint], q: Array) -> Array:
    """The values (m, joints) of all joints for those of the free ones, (m, n)."""
    follow = masters(joints)
    place = {master: i for i, master in enumerate(dict.fromkeys(follow))}
    factor, offset = _couplings(joints)
    return np.array(factor) * q[:, [place[master] for master in follow]] + np.array(offset)


def turn(axis: Array, angle: Array) -> Array:
    """Rotations (m, 3, 3) about a unit axis, by Rodrigues' formula."""
    x, y, z = axis
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    s, c = np.sin(angle)[:, None, None], np.cos(angle)[:, None, None]
    return np.eye(3) + s * cross + (1.0 - c) * (cross @ cross)


def kinematics(joints: list[Joint], q: Array) -> tuple[Array, Array]:
    """Poses of the tip (m, 4, 4) and Jacobians (m, 6, n) for the free joints q (m, n)."""
    m, all_values = len(q), values(joints, q)
    rotation, place = np.broadcast_to(np.eye(3), (m, 3, 3)), np.zeros((m, 3))
    axes, origins = [], []
    for i, joint in enumerate(joints):
        roll, pitch, yaw = (np.array([angle]) for angle in joint["rpy"])
        fixed = (turn(np.eye(3)[2], yaw) @ turn(np.eye(3)[1], pitch) @ turn(np.eye(3)[0], roll))[0]
        place = place + rotation @ np.array(joint["xyz"])
        rotation = rotation @ fixed
        unit = np.array(joint["axis"]) / np.linalg.norm(joint["axis"])
        axes.append(rotation @ unit)
        origins.append(place)
        if joint["kind"] in TURNED:
            rotation = rotation @ turn(unit, all_values[:, i])
        else:
            place = place + axes[-1] * all_values[:, i, None]
    pose = np.tile(np.eye(4), (m, 1, 1))
    pose[:, :3, :3], pose[:, :3, 3] = rotation, place
    return pose, _jacobian(joints, place, np.array(axes), np.array(origins))


def _jacobian(joints: list[Joint], tip: Array, axes: Array, origins: Array) -> Array:
    follow, factor = masters(joints), _couplings(joints)[0]
    columns = {master: i for i, master in enumerate(dict.fromkeys(follow))}
    jacobian = np.zeros((len(tip), 6, len(columns)))
    for i, joint in enumerate(joints):
        column = jacobian[:, :, columns[follow[i]]]
        if joint["kind"] in TURNED:
            column[:, :3] += factor[i] * np.cross(axes[i], tip - origins[i])
            column[:, 3:] += factor[i] * axes[i]
        else:
            column[:, :3] += factor[i] * axes[i]
    return jacobian


def put(joints: list[Joint], random: np.random.Generator, hard: bool, count: int = 1) -> None:
    """Draws `count` configurations inside the limits, kept with the joints; hard ones are at limits and at zero."""
    lower, upper = (np.clip(bound, -3.0, 3.0) for bound in bounds(joints))
    for joint, low, high in zip(free(joints), lower, upper, strict=True):
        at = low + (high - low) * random.random(count)
        if hard:
            places = np.stack([at, np.full(count, low), np.full(count, high), np.full(count, np.clip(0.0, low, high))])
            at = places[random.integers(0, 4, count), np.arange(count)]
        joint["at"] = tuple(at.tolist())


def configurations(joints: list[Joint]) -> Array:
    """The configurations (m, n) that are kept with the joints, brought inside the limits."""
    lower, upper = bounds(joints)
    return np.clip(np.array([joint["at"] for joint in free(joints)]).T, lower, upper)


def pose_error(found: Array, wanted: Array) -> tuple[Array, Array]:
    """Distances (m,) and angles (m,) between poses (m, 4, 4) and one (4, 4)."""
    away = np.linalg.norm(found[:, :3, 3] - wanted[:3, 3], axis=1)
    relative = np.swapaxes(found[:, :3, :3], 1, 2) @ wanted[:3, :3]
    skew = relative - np.swapaxes(relative, 1, 2)
    sine = 0.5 * np.linalg.norm(np.stack([skew[:, 2, 1], skew[:, 0, 2], skew[:, 1, 0]], axis=1), axis=1)
    return away, np.arctan2(sine, 0.5 * (np.trace(relative, axis1=1, axis2=2) - 1.0))


def descended(joints: list[Joint], wanted: Array, starts: Array, *, rotation: bool = True, steps: int = 60) -> Array:
    """Ends (m, n) of damped Newton descents towards a pose from starts (m, n), limits not counted."""
    q, damping = starts.copy(), np.full(len(starts), 1e-2)
    residual, jacobian = _linearized(joints, q, wanted, rotation)
    for _ in range(steps):
        normal = np.swapaxes(jacobian, 1, 2) @ jacobian + damping[:, None, None] * np.eye(q.shape[1])
        step = np.linalg.solve(normal, np.swapaxes(jacobian, 1, 2) @ residual[:, :, None])[:, :, 0]
        trial = q + np.clip(step, -1.0, 1.0)
        new_residual, new_jacobian = _linearized(joints, trial, wanted, rotation)
        better = (new_residual**2).sum(axis=1) < (residual**2).sum(axis=1)
        q, residual = np.where(better[:, None], trial, q), np.where(better[:, None], new_residual, residual)
        jacobian = np.where(better[:, None, None], new_jacobian, jacobian)
        damping = np.where(better, np.maximum(damping / 8, 1e-14), np.minimum(damping * 4, 1e6))
    return q


def _linearized(joints: list[Joint], q: Array, wanted: Array, rotation: bool) -> tuple[Array, Array]:
    """What is missing to the pose (m, 6), or to its position (m, 3), and its Jacobian."""
    poses, jacobian = kinematics(joints, q)
    missing = wanted[:3, 3] - poses[:, :3, 3]
    if not rotation:
        return missing, jacobian[:, :3]
    relative = wanted[:3, :3] @ np.swapaxes(poses[:, :3, :3], 1, 2)
    skew = 0.5 * (relative - np.swapaxes(relative, 1, 2))
    vector = np.stack([skew[:, 2, 1], skew[:, 0, 2], skew[:, 1, 0]], axis=1)
    sine = np.linalg.norm(vector, axis=1)
    angle = np.arctan2(sine, 0.5 * (np.trace(relative, axis1=1, axis2=2) - 1.0))
    vector = vector * np.where(sine > 1e-9, angle / np.maximum(sine, 1e-300), 1.0)[:, None]
    return np.hstack((missing, vector)), jacobian
