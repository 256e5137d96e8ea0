"""Suggestions for misspelt names: "did you mean ...?"."""

from collections.abc import Collection
from difflib import get_close_matches

# What other libraries, papers and other spellings say, and the names of this one.
_SAME: dict[str, tuple[str, ...]] = {
    "acc": ("acceleration",),
    "centre": ("center",),
    "clearance": ("margin",),
    "ee": ("tip",),
    "ee_link": ("tip",),
    "ee_name": ("tip",),
    "end_effector": ("tip",),
    "filename": ("file", "path_or_xml"),
    "goal": ("end", "target"),
    "guess": ("start", "start_q"),
    "init": ("start", "start_q"),
    "initial": ("start", "start_q"),
    "initial_guess": ("start", "start_q"),
    "iterations": ("stop",),
    "joint_positions": ("q", "start"),
    "joints": ("q", "start"),
    "max_evaluations": ("stop",),
    "max_iter": ("stop",),
    "max_iterations": ("stop",),
    "max_time": ("stop",),
    "offset": ("tool", "base"),
    "ori_tol": ("rotation_tolerance",),
    "orientation_tolerance": ("rotation_tolerance",),
    "pos": ("position",),
    "pos_tol": ("position_tolerance",),
    "q0": ("start", "start_q"),
    "q_goal": ("end_q",),
    "q_init": ("start", "start_q"),
    "q_start": ("start", "start_q"),
    "radius": ("diameter",),
    "random_seed": ("seed",),
    "resolution": ("voxel",),
    "safety": ("margin",),
    "scene": ("obstacles",),
    "speed": ("velocity",),
    "start": ("start_q",),
    "time_step": ("dt",),
    "timeout": ("stop",),
    "timestep": ("dt",),
    "world": ("obstacles",),
    "x0": ("start", "start_q"),
}
_SHORTEST = 3  # letters that a name is recognised by


def nearest(name: str, known: Collection[str]) -> str | None:
    """Returns the known name that is probably meant; None if no name is near."""
    asked = name.lower()
    for same in _SAME.get(asked, ()):
        if same in known:
            return same
    close = get_close_matches(asked, known, n=1, cutoff=0.75)
    if close:
        return close[0]
    if len(asked) < _SHORTEST:
        return None
    begun = [other for other in known if other.startswith(asked) or asked.startswith(f"{other}_")]
    within = begun or [other for other in known if asked in other.split("_")]
    return min(within, key=len) if within else None


def meant(name: str, known: Collection[str]) -> str:
    """Returns " (did you mean 'center'?)", or nothing if no name is near."""
    near = nearest(name, known)
    return "" if near is None else f" (did you mean '{near}'?)"
