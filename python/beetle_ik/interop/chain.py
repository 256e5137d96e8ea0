"""The elements of a robot's chain, as an intermediate form between libraries."""

from dataclasses import dataclass, field
from typing import Literal, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .._core import InvalidInputError, Robot
from ..calls.arguments import require
from ..calls.text import listed

Matrix: TypeAlias = NDArray[np.float64]
Kind: TypeAlias = Literal["revolute", "continuous", "prismatic"]


@dataclass(frozen=True)
class Motion:
    """A joint: rotates about its axis (3,) or translates along it, by its entry of q plus `offset` (rad, m)."""

    joint: int
    turns: bool
    axis: Matrix
    offset: float


@dataclass(frozen=True)
class Link:
    """Marks the current frame as the frame of a link."""

    name: str


@dataclass
class ChainReader:
    """Builds a chain element by element, starting at link `base`."""

    name: str
    base: str
    joints: list[tuple[str, Kind, float, float, float]] = field(default_factory=list)
    elements: list[tuple[object, ...]] = field(default_factory=list)

    def fixed(self, pose: ArrayLike) -> None:
        """Appends a constant transform (4, 4)."""
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
        """Appends an independent joint about or along `axis` (3,)."""
        self.elements.append(
            ("moving", len(self.joints), kind != "prismatic", np.asarray(axis, dtype=float), 1.0, offset)
        )
        self.joints.append((name, kind, float(lower), float(upper), float(velocity)))

    def link(self, name: str) -> None:
        """Names the current frame."""
        self.elements.append(("link", name))

    def robot(self) -> Robot:
        """Returns the robot."""
        return Robot._from_chain(self.name, self.base, self.joints, self.elements)


def parts(robot: Robot, library: str) -> tuple[Matrix, list[Matrix | Motion | Link], Matrix]:
    """Returns pose of the base link, elements up to the last link, and tool, for a library without mimic joints.

    Raises:
        InvalidInputError: not a `Robot`, or a robot with a mimic joint; the message names the joint that it follows.
    """
    require("robot", robot, Robot)
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
                    f"joint '{robot.joint_names[joint]}' of robot '{robot.name}' has mimic joints, "
                    f"which the conversion to {library} does not support"
                )
            seen.add(joint)
            # Turns the axis around for a scale of -1.
            shown.append(Motion(joint, turns, scale * axis, scale * offset))
    return base, shown, tool


def only_leaf(library: str, what: str, leaves: list[str]) -> str:
    """Returns the only leaf, as the default tip.

    Raises:
        InvalidInputError: several leaves; the message lists them.
    """
    if len(leaves) == 1:
        return leaves[0]
    raise InvalidInputError(f"the model of {library} has {len(leaves)} leaf {what}; give tip= one of: {listed(leaves)}")
