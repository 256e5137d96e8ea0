"""A robot's chain, element by element, on its way from another library or to it."""

from dataclasses import dataclass, field
from typing import Literal, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .._core import InvalidInputError, Robot

Matrix: TypeAlias = NDArray[np.float64]
Kind: TypeAlias = Literal["revolute", "continuous", "prismatic"]


@dataclass(frozen=True)
class Motion:
    """A joint: it turns about its axis (3,) or slides along it, by its entry of q plus `offset` (rad, m)."""

    joint: int
    turns: bool
    axis: Matrix
    offset: float


@dataclass(frozen=True)
class Link:
    """The frame reached here is that of a link."""

    name: str


@dataclass
class ChainReader:
    """Collects what another library says of a chain, from link `base` on."""

    name: str
    base: str
    joints: list[tuple[str, Kind, float, float, float]] = field(default_factory=list)
    elements: list[tuple[object, ...]] = field(default_factory=list)

    def fixed(self, pose: ArrayLike) -> None:
        """A constant transform (4, 4)."""
        self.elements.append(("fixed", np.asarray(pose, dtype=float)))

    def moving(
        self,
        name: str,
        kind: Kind,
        axis: ArrayLike,
        *,
        offset: float = 0.0,
        lower: float = -np.inf,
        upper: float = np.inf,
        velocity: float = np.inf,
    ) -> None:
        """A joint of its own about or along `axis` (3,)."""
        self.elements.append(
            ("moving", len(self.joints), kind != "prismatic", np.asarray(axis, dtype=float), 1.0, offset)
        )
        self.joints.append((name, kind, float(lower), float(upper), float(velocity)))

    def link(self, name: str) -> None:
        """Name the frame reached so far."""
        self.elements.append(("link", name))

    def robot(self) -> Robot:
        """The robot collected."""
        return Robot._from_chain(self.name, self.base, self.joints, self.elements)


def parts(robot: Robot, library: str) -> tuple[Matrix, list[Matrix | Motion | Link], Matrix]:
    """Pose of the base link, what follows up to the last link, and the tool, for a library without coupled joints.

    Raises:
        InvalidInputError: a joint that moves several elements, or by a factor: names it.
    """
    base, elements, tool = robot._chain()
    seen: set[int] = set()
    shown: list[Matrix | Motion | Link] = []
    for kind, *values in elements:
        if kind == "fixed":
            shown.append(values[0])
        elif kind == "link":
            shown.append(Link(values[0]))
        else:
            joint, turns, axis, scale, offset = values
            if joint in seen or abs(scale) != 1.0:
                raise InvalidInputError(
                    f"joint '{robot.joint_names[joint]}' of robot '{robot.name}' moves several elements or by a factor "
                    f"(mimic joints), which a model of {library} made here cannot say"
                )
            seen.add(joint)
            # Backwards about an axis is forwards about its opposite.
            shown.append(Motion(joint, turns, scale * axis, scale * offset))
    return base, shown, tool


def only_leaf(library: str, what: str, leaves: list[str]) -> str:
    """The tip where none was named.

    Raises:
        InvalidInputError: there are several: lists them.
    """
    if len(leaves) == 1:
        return leaves[0]
    raise InvalidInputError(
        f"the model of {library} has {len(leaves)} {what} that nothing follows; give tip= one of: {', '.join(leaves)}"
    )
