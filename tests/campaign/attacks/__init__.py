"""The attacks, by name."""

from importlib import import_module

from ..attack import Attack
from . import (
    calibration,
    calls,
    clear_curves,
    clearance,
    command_line,
    dead_ends,
    derivatives,
    described,
    doors,
    dynamics,
    held_arms,
    joint_weights,
    keeping,
    kept,
    kinematics,
    levels,
    motion,
    motors,
    own_points,
    path_breaks,
    paths_over,
    programs,
    programs_of_tips,
    readers,
    round_poses,
    searching,
    several,
    solving,
    starts,
    stops,
    streams,
    tip_limits,
    tracking,
    units,
    xacro_files,
)

_MODULES = (
    kinematics,
    derivatives,
    dynamics,
    solving,
    round_poses,
    searching,
    several,
    levels,
    tracking,
    stops,
    starts,
    streams,
    dead_ends,
    held_arms,
    motion,
    motors,
    tip_limits,
    keeping,
    kept,
    programs,
    programs_of_tips,
    joint_weights,
    clearance,
    clear_curves,
    own_points,
    path_breaks,
    paths_over,
    readers,
    xacro_files,
    described,
    calibration,
    calls,
    command_line,
    units,
    doors,
)
ATTACKS: dict[str, Attack] = {attack.name: attack for module in _MODULES for attack in module.ATTACKS}


def named(name: str) -> Attack:
    """An attack of these by its name, or another one by "module:class"."""
    if name in ATTACKS:
        return ATTACKS[name]
    module, _, attack = name.partition(":")
    return getattr(import_module(module), attack)()
