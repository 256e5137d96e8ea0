"""`beetle-ik view`: a robot in the browser."""

from pathlib import Path
from typing import Annotated

import typer

from .. import Robot, Scene, UrdfError
from .. import view as view_robot
from .options import BaseLink, LinkRadius, SceneFile, Start, TipLinks, Trusted, complete_robot, load_robot, numbers

_FILES = (".urdf", ".xacro", ".xml")


def view(
    robot: Annotated[
        str,
        typer.Argument(
            help="A built-in robot, or a file: URDF, xacro, or MJCF that ends in .xml.", autocompletion=complete_robot
        ),
    ],
    *,
    start: Start = None,
    scene: SceneFile = None,
    link_radius: LinkRadius = None,
    host: Annotated[
        str, typer.Option(help="Address to serve at; 0.0.0.0: to others, who need the token.")
    ] = "127.0.0.1",
    port: Annotated[int, typer.Option(help="Port; if it is in use, the next free one. 0: any.")] = 8080,
    tip: TipLinks = None,
    base: BaseLink = None,
    trusted: Trusted = False,
) -> None:
    """Show a robot in the browser: drag its tip, its joints and obstacles. Ctrl-C ends it."""
    arm = _loaded(robot, base, tip, trusted)
    viewer = view_robot(
        arm if link_radius is None else arm.with_capsules(radius=link_radius),
        None if start is None else numbers("--start", start),
        obstacles=None if scene is None else Scene.load(scene),
        host=host,
        port=port,
    )
    typer.echo("Ctrl-C ends it.")  # the address is printed
    try:
        viewer.wait()
    except KeyboardInterrupt:
        raise typer.Exit from None  # the way to end it


def _loaded(robot: str, base: str | None, tip: list[str] | None, trusted: bool) -> Robot:
    file, tip = Path(robot), tip or None  # no option is an empty list
    if file.suffix not in _FILES:
        return load_robot(robot, None, base, tip)
    if file.suffix == ".xml":
        return Robot.from_mjcf(file, base=base, tip=tip, collision="hulls", trusted=trusted)
    try:
        return Robot.from_urdf(file, base=base, tip=tip, collision="hulls", trusted=trusted)
    except UrdfError as error:
        arm = Robot.from_urdf(file, base=base, tip=tip, trusted=trusted)  # raises what else is wrong
        typer.echo(f"Without its meshes: {error}", err=True)
        return arm
