"""Obstacles of a planning scene as RViz saves it: a text file "cell.scene".

    cell            name of the scene
    * table         an object
    0.5 0 0.1       its position (m) and
    0 0 0 1         orientation (x, y, z, w)
    1               number of its shapes
    box             a shape: its kind,
    0.6 1.2 0.05    sizes (m),
    0 0 0           position and
    0 0 0 1         orientation in the object, and
    0 0 0 0         colour
    0               number of its subframes, each with a line for its name and two for its pose
    .               the end

The older format (before ROS Noetic) lacks the pose and the subframes of objects. As in MoveIt, it is recognised by the
line behind the first object, which holds a single number. Sizes: box x y z; sphere radius; cylinder and cone radius
length; mesh, the numbers of vertices and triangles, then these. Source: `saveGeometryToStream` of moveit_core,
`saveAsText` of geometric_shapes.
"""

import numpy as np
from numpy.typing import NDArray

from .. import obstacles
from .._core import BeetleIkError, InvalidInputError, Obstacle, pose
from .solids import READ, moved, solid

_SIZES = {"box": "x y z", "sphere": "radius", "cylinder": "radius length", "cone": "radius length"}
_MOST = 10_000_000  # vertices or triangles of a mesh


def is_rviz_text(text: str) -> bool:
    """Whether a text looks like a scene of RViz: the second line is an object or the end."""
    lines = text.lstrip("\ufeff").splitlines()
    return len(lines) > 1 and (lines[1].lstrip().startswith("* ") or lines[1].strip() in ("*", "."))


def rviz_obstacles(where: str, text: str, place: NDArray[np.float64]) -> list[Obstacle]:
    """Reads the shapes of a scene; `place` is the pose (4, 4) of its frame in that of the robot's base.

    Raises:
        InvalidInputError: not such a text, or a shape that cannot become an obstacle; the message names file and line.
    """
    words = _Words(where, text)
    words.rest("the name of the scene", may_be_empty=True)
    found: list[Obstacle] = []
    posed = words.has_object_poses()
    while (marker := words.word("'*' and the name of an object, or '.' at the end")) == "*":
        name = words.rest("the name of an object")
        at = place @ words.pose(f"object '{name}'") if posed else place
        shapes = range(words.count(f"the number of shapes of object '{name}'"))
        found += [_shape(words, f"shape {number} of object '{name}'", at) for number in shapes]
        for _ in range(words.count(f"the number of subframes of object '{name}'") if posed else 0):
            subframe = words.word(f"the name of a subframe of object '{name}'")
            words.pose(f"subframe '{subframe}' of object '{name}'")
    if marker != ".":
        raise words.wrong("'*' and the name of an object, or '.' at the end", marker)
    if (more := words.next_word()) is not None:
        raise words.wrong("nothing after '.'", more)
    return found


def _shape(words: "_Words", what: str, at: NDArray[np.float64]) -> Obstacle:
    kind = words.word(f"the kind of {what}: {READ}, mesh")
    line = words.line
    if kind == "mesh":
        counts = [words.count(f"the number of {parts} of {what}") for parts in ("vertices", "triangles")]
        vertices = np.array([words.numbers(3, f"vertex {i} (x y z) of {what}") for i in range(counts[0])])
        faces = np.array([words.numbers(3, f"triangle {i} (three vertices) of {what}") for i in range(counts[1])])
        sizes: list[float] = []
    elif kind in _SIZES:
        sizes = words.numbers(len(_SIZES[kind].split()), f"the sizes ({_SIZES[kind]}) of {what}, a {kind}")
    elif kind == "plane":
        sizes = words.numbers(4, f"the four coefficients of {what}, a plane")
    else:
        raise words.wrong(f"the kind of {what}: {READ}, mesh", kind)
    at = at @ words.pose(what)
    words.numbers(4, f"the colour (r g b a) of {what}")
    try:
        if kind == "mesh":
            return obstacles.Mesh(moved(vertices.reshape(-1, 3), at), faces.reshape(-1, 3))
        return solid(kind, sizes[::-1] if kind in ("cylinder", "cone") else sizes, at)
    except BeetleIkError as error:
        raise words.error(f"{what}: {error}", line) from error


class _Words:
    """Words of a text, read one by one, with the lines they are in."""

    def __init__(self, where: str, text: str) -> None:
        """Begins before the first word."""
        self._where = where
        self._lines = text.lstrip("\ufeff").splitlines()
        self._next = 0
        self._words: list[str] = []

    @property
    def line(self) -> int:
        """The number of the current line."""
        return max(self._next, 1)

    def has_object_poses(self) -> bool:
        """Whether the line behind the first object holds several numbers."""
        first = next((i for i in range(self._next, len(self._lines)) if self._lines[i].startswith("*")), None)
        return first is not None and len(" ".join(self._lines[first + 1 : first + 2]).split()) > 1

    def rest(self, what: str, *, may_be_empty: bool = False) -> str:
        """Returns the rest of the line, or the next line if none has been begun."""
        if self._words or self._next == 0:
            text = " ".join(self._words) if self._words else (self._lines or [""])[0].strip()
            self._next = max(self._next, 1)
            self._words = []
        else:
            text = ""
        if not (text or may_be_empty):
            raise self.wrong(what, None)
        return text

    def next_word(self) -> str | None:
        """Returns the next word; None at the end."""
        while not self._words:
            if self._next >= len(self._lines):
                return None
            self._words = self._lines[self._next].split()
            self._next += 1
        return self._words.pop(0)

    def word(self, what: str) -> str:
        """Returns the next word, which must exist."""
        if (word := self.next_word()) is None:
            raise self.error(f"expected {what}, and the file ends: it is not complete", self.line)
        return word

    def numbers(self, count: int, what: str) -> list[float]:
        """Returns the numbers of the line, which must be this many."""
        found = [self.word(what), *self._words]
        self._words = []
        try:
            numbers = [float(word) for word in found]
        except ValueError:
            numbers = []
        if len(numbers) != count:
            raise self.wrong(what, " ".join(found))
        return numbers

    def count(self, what: str) -> int:
        """Returns a whole number."""
        word = self.word(what)
        if not (word.isascii() and word.isdigit() and len(word) < 10 and int(word) <= _MOST):
            raise self.wrong(what, word)
        return int(word)

    def pose(self, what: str) -> NDArray[np.float64]:
        """Returns the pose (4, 4) from a position and an orientation, which may be rounded."""
        position = self.numbers(3, f"the position (x y z) of {what}")
        orientation = self.numbers(4, f"the orientation (x y z w) of {what}")
        try:
            return pose(position, xyzw=orientation)
        except BeetleIkError as error:
            raise self.error(f"{what}: {error}", self.line) from error

    def wrong(self, what: str, got: str | None) -> InvalidInputError:
        """Returns the error for a word that is not what was expected."""
        return self.error(f"expected {what}, got {'nothing' if got is None else repr(got)[:60]}", self.line)

    def error(self, problem: str, line: int) -> InvalidInputError:
        """Returns an error with file and line."""
        return InvalidInputError(f"{self._where}: line {line}: {problem}")
