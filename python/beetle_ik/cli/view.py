"""`beetle-ik view`: a robot in the browser."""

from typing import Annotated, Any

import typer

from .. import Robot, Scene, UrdfError
from .. import view as view_robot
from .options import (
    BaseLink,
    LinkRadius,
    RobotName,
    SceneFile,
    StartQ,
    TipLinks,
    Trusted,
    UrdfFile,
    load_robot,
    numbers,
)


def view(
    robot: RobotName = None,
    *,
    start_q: StartQ = None,
    scene: SceneFile = None,
    link_radius: LinkRadius = None,
    host: Annotated[
        str, typer.Option(help="Address to serve at; 0.0.0.0: to others, who need the token.")
    ] = "127.0.0.1",
    port: Annotated[int, typer.Option(help="Port; if it is in use, the next free one. 0: any.")] = 8080,
    urdf: UrdfFile = None,
    tip: TipLinks = None,
    base: BaseLink = None,
    trusted: Trusted = False,
) -> None:
    """Show a robot in the browser: drag its tip, its joints and obstacles. Ctrl-C ends it."""
    viewer = view_robot(
        _loaded(robot, urdf, base, tip, link_radius, trusted=trusted),
        None if start_q is None else numbers("--start-q", start_q),
        obstacles=None if scene is None else Scene.load(scene),
        host=host,
        port=port,
    )
    typer.echo("Ctrl-C ends it.")  # the address is printed
    try:
        viewer.wait()
    except KeyboardInterrupt:
        raise typer.Exit from None  # the way to end it


def _loaded(*given: Any, trusted: bool) -> Robot:
    """Loads the robot with the hulls of its collision meshes, or without the meshes if they cannot be read."""
    try:
        return load_robot(*given, trusted=trusted, collision="hulls")
    except UrdfError as error:
        arm = load_robot(*given, trusted=trusted)  # raises any other error
        typer.echo(f"Without its meshes: {error}", err=True)
        return arm
