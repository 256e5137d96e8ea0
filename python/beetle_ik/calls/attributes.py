"""Hints for attributes that a value lacks: the one of another name, or of its trajectory, that was probably meant."""

from typing import Any, NoReturn

from .._core import Trajectory

# Names that other libraries use, and the attributes here.
_SAME: dict[str, tuple[str, ...]] = {
    "acceleration": ("qdd",),
    "accelerations": ("qdd",),
    "angles": ("q",),
    "configuration": ("q",),
    "error": ("position_error",),
    "forward_kinematics": ("fk",),
    "iterations": ("evaluations",),
    "joint_angles": ("q",),
    "joint_limits": ("limits", "lower"),
    "joint_positions": ("q",),
    "joints": ("q", "joint_names"),
    "n_joints": ("dof",),
    "num_joints": ("dof",),
    "ok": ("success",),
    "positions": ("q",),
    "runtime": ("elapsed",),
    "t": ("time",),
    "times": ("time",),
    "velocities": ("qd",),
    "velocity": ("qd",),
    "x": ("q",),
}


def hint_at_attributes(*classes: type) -> None:
    """Makes values of native classes name the attribute that was probably meant, where they have none of a name."""
    for each in classes:
        each.__getattr__ = _missing  # type: ignore[attr-defined]


def _missing(value: Any, name: str) -> NoReturn:
    """Raises `AttributeError`. Python asks here after it has found no attribute of this name."""
    hint = "" if name.startswith("_") else _hint(value, name)
    raise AttributeError(f"'{type(value).__name__}' object has no attribute '{name}'{hint}")


def _hint(value: Any, name: str) -> str:
    from .names import meant  # slow to import

    known, of_motion = _public(type(value)), _public(Trajectory)
    wanted = (name, *_SAME.get(name, ()))
    for each in wanted:
        if each in known:
            return f" (did you mean '{each}'?)"
    if "trajectory" in known:
        for each in wanted:
            if each in of_motion:
                return f": its trajectory has it, .trajectory.{each}"
    return meant(name, known)


def _public(kind: type) -> list[str]:
    return [name for name in dir(kind) if not name.startswith("_")]
