"""The order of the gallery: what a newcomer needs first."""

from pathlib import Path

_ORDER = (
    "pose_ik",
    "your_urdf",
    "circle_by_bas",
    "all_solutions",
    "reachability_map",
    "joint_at_its_limit",
    "control_loop",
    "pointing",
    "best_posture",
    "without_a_model",
    "round_an_obstacle",
    "waypoints_in_minimum_time",
    "pentagram_in_minimum_time",
    "own_objective",
)


class NewcomersFirst:
    """Sorts the examples of a folder; those without a place come last."""

    def __init__(self, _folder: str) -> None:
        """Sphinx-gallery gives the folder."""

    def __call__(self, file: str) -> tuple[int, str]:
        """Where this file comes."""
        name = Path(file).stem
        return (_ORDER.index(name) if name in _ORDER else len(_ORDER), name)
