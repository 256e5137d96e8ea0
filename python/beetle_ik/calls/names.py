"""Suggestions for misspelt names: "did you mean ...?"."""

from collections.abc import Collection
from difflib import get_close_matches

# Names used by other libraries, papers and spellings, and the names of this library.
_SAME: dict[str, tuple[str, ...]] = {
    "acc": ("acceleration",),
    "centre": ("center",),
    "clearance": ("margin",),
    "count": ("m",),
    "dimensions": ("size",),
    "dims": ("size",),
    "ee": ("tip",),
    "ee_link": ("tip",),
    "ee_name": ("tip",),
    "end_effector": ("tip",),
    "extents": ("size",),
    "filename": ("file", "path_or_xml"),
    "frame": ("link", "base"),
    "goal": ("end", "target"),
    "guess": ("start_q",),
    "init": ("start_q",),
    "initial": ("start_q",),
    "initial_guess": ("start_q",),
    "iterations": ("stop",),
    "iters": ("stop",),
    "joint_positions": ("q", "start_q"),
    "joints": ("q", "start_q"),
    "max_evaluations": ("stop",),
    "max_iter": ("stop",),
    "max_iterations": ("stop",),
    "max_time": ("stop",),
    "n": ("m",),
    "number": ("m",),
    "offset": ("tool", "base"),
    "ori_tol": ("rotation_tolerance",),
    "orientation_tolerance": ("rotation_tolerance",),
    "pos": ("position",),
    "pos_tol": ("position_tolerance",),
    "pose": ("target", "end", "T"),
    "q0": ("start_q",),
    "q_goal": ("end_q",),
    "q_init": ("start_q",),
    "q_start": ("start_q",),
    "radius": ("diameter",),
    "random_seed": ("seed",),
    "resolution": ("voxel",),
    "safety": ("margin",),
    "scene": ("obstacles",),
    "speed": ("velocity",),
    "start": ("start_q",),
    "starts": ("start_q",),
    "target": ("end",),
    "time_step": ("dt",),
    "timeout": ("stop",),
    "timestep": ("dt",),
    "tol": ("position_tolerance",),
    "tolerance": ("position_tolerance",),
    "world": ("obstacles",),
    "x0": ("start_q",),
}
_SHORTEST = 3  # letters: a shorter name is not recognised


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
