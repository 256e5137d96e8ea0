"""`beetle-ik fk`: forward kinematics."""

from typing import Annotated

import typer

from .options import AsJson, BaseLink, RobotName, TipLink, Trusted, UrdfFile, load_robot, numbers
from .show import listed, print_json, print_pairs


def fk(
    robot: RobotName = None,
    *,
    q: Annotated[str, typer.Option("--q", help="Joint positions: q1,q2,... (rad, or 90deg; m for slides).")],
    urdf: UrdfFile = None,
    tip: TipLink = None,
    base: BaseLink = None,
    trusted: Trusted = False,
    as_json: AsJson = False,
) -> None:
    """Forward kinematics: the pose of the tip in the frame of the base."""
    arm = load_robot(robot, urdf, base, tip, trusted=trusted)
    pose = arm.fk(numbers("--q", q))
    if as_json:
        print_json({"robot": arm.name, "tip": arm.link_names[-1], "pose": pose})
    else:
        rotation = [(f"rotation, row {i + 1}", listed(row)) for i, row in enumerate(pose[:3, :3])]
        print_pairs(f"{arm.name}: {arm.link_names[-1]}", [("position [m]", listed(pose[:3, 3])), *rotation])
