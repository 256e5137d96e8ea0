"""`beetle-ik reach`: a map of what an arm reaches."""

import sys
from pathlib import Path
from typing import Annotated

import typer

from .. import ReachabilityMap, Scene, reachability
from .files import require_picture, write_picture
from .options import AsJson, BaseLink, LinkRadius, Margin, RobotName, SceneFile, TipLink, Trusted, UrdfFile, load_robot
from .show import print_json, print_pairs


def reach(
    robot: RobotName = None,
    *,
    voxel: Annotated[float, typer.Option(help="Edge of the voxels in m.")] = 0.05,
    directions: Annotated[int, typer.Option(help="Directions of the tip's z axis.")] = 50,
    rolls: Annotated[int, typer.Option(help="Rolls about each direction.")] = 6,
    out: Annotated[Path | None, typer.Option(help="File to write the map to: .npz.")] = None,
    store: Annotated[
        Path | None,
        typer.Option(help="Folder of a zarr store to compute into, which goes on if interrupted."),
    ] = None,
    picture: Annotated[Path | None, typer.Option(help="File to draw slices of the map to, such as map.png.")] = None,
    scene: SceneFile = None,
    margin: Margin = None,
    link_radius: LinkRadius = None,
    urdf: UrdfFile = None,
    tip: TipLink = None,
    base: BaseLink = None,
    trusted: Trusted = False,
    as_json: AsJson = False,
) -> None:
    """Reachability map: the share of orientations that an arm reaches in each voxel of space."""
    if picture is not None:
        require_picture("--picture", picture)
    arm = load_robot(robot, urdf, base, tip, link_radius, trusted=trusted)
    found = reachability(
        arm,
        voxel=voxel,
        directions=directions,
        rolls=rolls,
        obstacles=None if scene is None else Scene.load(scene),
        margin=margin,
        progress=sys.stderr.isatty(),
        store=store,
    )
    if out is not None:
        found.to_npz(out)
    if picture is not None:
        write_picture(picture, found.plot())
    _show(found, as_json)


def _show(found: ReachabilityMap, as_json: bool) -> None:
    held = int((found.index > 0).sum())
    if as_json:
        print_json(
            {
                "robot": found.robot.name,
                "origin": found.origin,
                "voxel": found.voxel,
                "shape": list(found.shape),
                "orientations": found.orientations,
                "voxels_reached": held,
                "share": float(found.index.mean()),
            }
        )
        return
    print_pairs(
        f"{found.robot.name}: {held} of {found.index.size} voxels reached",
        [
            ("voxels", " x ".join(map(str, found.shape)) + f" of {found.voxel:g} m"),
            ("orientations of a voxel", str(found.orientations)),
            ("volume reached [m^3]", f"{held * found.voxel**3:.4g}"),
            ("poses reached [%]", f"{100 * float(found.index.mean()):.3g}"),
        ],
    )
