"""Objects that the robot carries, as a scene lists them."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, NamedTuple

from .. import obstacles
from .._core import BeetleIkError, InvalidInputError, Obstacle

if TYPE_CHECKING:
    from .._core import Robot


class Attached(NamedTuple):
    """A shape that a link of the robot carries: the arguments of `robot.with_attached`.

    Attributes:
        link: the link that carries it.
        shape: a convex shape, in the frame of the link.
        touch: links that it may touch, besides those that move with `link`.
        name: name of the body.
    """

    link: str
    shape: Obstacle
    touch: tuple[str, ...]
    name: str


def checked(attached: Iterable[Attached], before: tuple[Attached, ...] = ()) -> tuple[Attached, ...]:
    """Returns attached objects as a tuple, behind those that were checked before.

    Raises:
        InvalidInputError: an entry is no (link, shape, touch, name), or a name is used twice.
    """
    try:
        given = tuple(attached)
    except TypeError:
        form = "a list of (link, shape, touch, name)"
        raise InvalidInputError(f"attached must be {form}, got {attached!r:.60}") from None
    entries = []
    for i, entry in enumerate(given):
        match entry:
            case (str(link), Obstacle() as shape, (list() | tuple()) as touch, str(name)):
                entries.append(Attached(link, shape, tuple(touch), name))
            case _:
                raise InvalidInputError(f"attached {i} must be (link, shape, touch, name), got {entry!r:.60}")
    entries = [*before, *entries]
    names = [entry.name for entry in entries]
    if twice := [name for name in names if names.count(name) > 1]:
        raise InvalidInputError(f"two attached objects are called '{twice[0]}'")
    return tuple(entries)


def carried(link: str, name: str, shapes: Iterable[Obstacle], touch: tuple[str, ...]) -> list[Attached]:
    """Returns an object of several shapes; meshes become their convex hulls, which contain them."""
    entries: list[Attached] = []
    for shape in shapes:
        convex = obstacles.ConvexMesh(shape.vertices) if isinstance(shape, obstacles.Mesh) else shape
        number = "" if not entries else f"_{len(entries) + 1}"
        entries.append(Attached(link, convex, touch, f"{name}{number}"))
    return entries


def require_carried(robot: Robot, attached: Iterable[Attached]) -> None:
    """Checks that the robot carries the objects.

    Raises:
        InvalidInputError: it does not; the message names the object and the remedy.
    """
    for link, _, _, name in attached:
        if name not in robot.all_link_names:
            raise InvalidInputError(
                f"in the scene, link '{link}' carries '{name}', which robot '{robot.name}' does not: "
                "use scene.attach_to(robot)"
            )


def attached_to(robot: Robot, attached: Iterable[Attached]) -> Robot:
    """Returns a copy of the robot that carries the objects.

    Raises:
        InvalidInputError: an object that the robot cannot carry; the message names it.
    """
    for link, shape, touch, name in attached:
        try:
            robot = robot.with_attached(link, shape, touch=touch, name=name)
        except BeetleIkError as error:
            raise InvalidInputError(f"attached object '{name}': {error}") from error
    return robot
