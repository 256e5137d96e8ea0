"""The state of a machine, as the words of a program change it, and the moves they make."""

import math
from typing import NamedTuple

import numpy as np

from ..checks import Array
from .arcs import PLANES, arc_shares, center_of_radius
from .lines import Line, refused

_MOVES = {0.0: "rapid", 1.0: "line", 2.0: "arc", 3.0: "arc"}
_NO_EFFECT = {15, 40, 43, 49, 50, 54, 61, 61.1, 64, 69, 80, 94, 97}  # already the case, or about speed and length alone
_WAITS = {4, 10, 11, 28, 29, 30}  # waits, retractions, homing, probing
_CALLS = {96.0, 97.0, 98.0, 99.0}  # M words that leave the program
_ENDS = {2.0, 30.0}
_AXES, _TURNS, _OFFSETS = "XYZ", "ABC", "IJK"
_LARGEST = 1e9  # number of a word
_INCH, _MM = 0.0254, 0.001
_WIDEST_TURN = math.radians(5.0)  # between points


Place = tuple[float, ...]
"""X, Y, Z (m) and A, B, C (rad); NaN where not known. Plain numbers: programs have many short moves."""


class Part(NamedTuple):
    """A move: the places it goes to, without its start, and how it is made."""

    kind: str
    line: int
    places: list[Place]
    feed: float
    extruded: float


class Machine:
    """Position, units and modes; `run` takes a line and returns the move it makes."""

    def __init__(self, start: Array | None, feed: float | None, tolerance: float, *, rotary: bool) -> None:
        """Begins at `start` (3,) (m), or nowhere, with millimetres, absolute positions and the XY plane."""
        position = (math.nan,) * 3 if start is None else map(float, start)
        self.place: Place = (*position, 0.0, 0.0, 0.0)
        self.feed = math.nan if feed is None else feed
        self.ended = False
        self.told: list[tuple[int, str]] = []
        self._tolerance, self._rotary = tolerance, rotary
        self._unit, self._relative, self._centers_relative = _MM, False, True
        self._plane, self._motion = 17, math.nan
        self._extruded, self._extrudes_relative = 0.0, False

    def run(self, line: Line) -> Part | None:
        """Takes a line; returns its move, None where it makes none.

        Raises:
            InvalidInputError: a word that is not read, or a move that cannot be made; the message names the line.
        """
        values = self._values(line)
        codes = [value for letter, value in line.words if letter == "G"]
        motions = [code for code in codes if code in _MOVES]
        if len(motions) > 1:
            raise refused(line.number, f"{line.text:.40}: two moves in one line")
        for code in codes:
            self._mode(line, code)
        self._take_feed(line, values)
        self._motion = motions[0] if motions else self._motion
        if not line.words or any(code in _WAITS for code in codes):
            self._wait(line, codes, values)
        elif 92.0 in codes:
            self._set_position(line, values)
        else:
            return self._move(line, values)
        return None

    def _values(self, line: Line) -> dict[str, float]:
        """Returns the values of axes, offsets, feed and extrusion; takes M words, and notes others."""
        values: dict[str, float] = {}
        for letter, value in line.words:
            if abs(value) > _LARGEST:
                raise refused(line.number, f"{letter}{value:g}: a number beyond {_LARGEST:g}")
            if letter == "M":
                self._other(line, value)
            elif letter in "ST":
                self.told.append((line.number, f"{letter}{value:g}"))
            elif letter in values:
                raise refused(line.number, f"{line.text:.40}: two words {letter} in one line")
            elif letter in "XYZABCIJKREFDHLPQ":
                values[letter] = value
            elif letter not in "GNO":
                raise refused(line.number, f"{letter}{value:g}: words {letter} are not read")
        if not self._rotary and (turned := [letter for letter in _TURNS if letter in values]):
            raise refused(
                line.number,
                f"{turned[0]}{values[turned[0]]:g}: rotary axes are read with rotary=True alone, which takes X, Y, Z "
                "as the tip in the frame of the part",
            )
        return values

    def _other(self, line: Line, code: float) -> None:
        if code in _CALLS:
            raise refused(line.number, f"M{code:g}: subprograms are not read: let the program be written out")
        if code in (82.0, 83.0):
            self._extrudes_relative = code == 83.0
        elif code in _ENDS:
            self.ended = True
        else:
            self.told.append((line.number, line.text if len(line.words) == 1 else f"M{code:g}"))

    def _wait(self, line: Line, codes: list[float], values: dict[str, float]) -> None:
        """Notes a line that moves nothing that is read; homing leaves the axes it names, or all, at unknown places."""
        self.told.append((line.number, line.text))
        if any(code in _MOVES for code in codes):
            raise refused(line.number, f"{line.text:.40}: a move beside a wait or homing in one line")
        if {28.0, 30.0} & set(codes):
            named = [letter for letter in _AXES if letter in values] or _AXES
            here = zip(_AXES + _TURNS, self.place, strict=True)
            self.place = tuple(math.nan if letter in named else value for letter, value in here)

    def _mode(self, line: Line, code: float) -> None:
        if code in PLANES:
            self._plane = int(code)
        elif code in (20.0, 21.0):
            self._unit = _INCH if code == 20.0 else _MM
        elif code in (90.0, 91.0):
            self._relative = code == 91.0
        elif code in (90.1, 91.1):
            self._centers_relative = code == 91.1
        elif code == 10.0 and any(letter == "L" for letter, _ in line.words):
            raise refused(
                line.number, "G10 L: offsets are not read: give frame=, or the program in the frame of the part"
            )
        elif code not in _MOVES and code not in _NO_EFFECT and code not in _WAITS and code != 92.0:
            raise refused(line.number, f"G{code:g} is not read: G0 to G3, G17 to G21, G90 and G91 are")

    def _set_position(self, line: Line, values: dict[str, float]) -> None:
        """Takes G92, which names the present position, for the extruder alone."""
        if "E" not in values or any(letter in values for letter in _AXES + _TURNS):
            raise refused(line.number, f"{line.text:.40}: a new origin is not read: give frame=")
        self._extruded = values["E"] * self._unit

    def _take_feed(self, line: Line, values: dict[str, float]) -> None:
        if "F" in values:
            self.feed = values["F"] * self._unit / 60.0
            if self.feed <= 0.0:
                raise refused(line.number, f"F{values['F']:g}: a feed must be positive")

    def _move(self, line: Line, values: dict[str, float]) -> Part | None:
        extruded = self._extrude(values)
        if not any(letter in values for letter in _AXES + _TURNS + _OFFSETS + "R"):
            return None
        if math.isnan(self._motion):
            raise refused(line.number, f"{line.text:.40}: a position before any G0 to G3")
        kind = _MOVES[self._motion]
        if kind != "arc" and (given := [letter for letter in _OFFSETS + "R" if letter in values]):
            raise refused(
                line.number, f"{given[0]}{values[given[0]]:g}: only arcs, G2 and G3, have a centre or a radius"
            )
        start, end = self.place, self._end(line, values)
        self.place = end
        if math.isnan(sum(start)) or math.isnan(sum(end)):
            if kind == "arc":
                raise refused(line.number, "an arc from a place that is not known: give start=")
            if kind != "rapid":
                self.told.append((line.number, line.text))
            return None if math.isnan(sum(end)) else Part("rapid", line.number, [end], math.nan, 0.0)
        if kind != "rapid" and math.isnan(self.feed):
            raise refused(line.number, f"{line.text:.40}: no F before it, so that its speed is not known: give feed=")
        places = self._arc(line, values, start, end) if kind == "arc" else _straight(start, end)
        if not places:
            return None
        return Part(kind, line.number, places, math.nan if kind == "rapid" else self.feed, extruded)

    def _extrude(self, values: dict[str, float]) -> float:
        if "E" not in values:
            return 0.0
        before, given = self._extruded, values["E"] * self._unit
        self._extruded = before + given if self._extrudes_relative else given
        return self._extruded - before

    def _end(self, line: Line, values: dict[str, float]) -> Place:
        end = list(self.place)
        for axis, letter in enumerate(_AXES + _TURNS):
            if letter in values:
                if self._relative and math.isnan(end[axis]):
                    raise refused(
                        line.number, f"{letter}{values[letter]:g}: G91 from a place that is not known: give start="
                    )
                given = values[letter] * self._unit if axis < len(_AXES) else math.radians(values[letter])
                end[axis] = given + (end[axis] if self._relative else 0.0)
        return tuple(end)

    def _arc(self, line: Line, values: dict[str, float], start: Place, end: Place) -> list[Place]:
        if "P" in values:
            raise refused(line.number, f"P{values['P']:g}: arcs of several turns are not read")
        plane = list(PLANES[self._plane][:2])
        clockwise = self._motion == 2.0
        first, last = np.array(start), np.array(end)
        center = self._center(line, values, first[plane], last[plane], clockwise=clockwise)
        around, share = arc_shares(
            line.number, first[plane], last[plane], center, clockwise=clockwise, tolerance=self._tolerance
        )
        places = first + share[:, None] * (last - first)
        places[:, plane] = around
        places[-1] = last
        return [tuple(place) for place in places.tolist()]

    def _center(self, line: Line, values: dict[str, float], start: Array, end: Array, *, clockwise: bool) -> Array:
        """Returns the centre (2,) of an arc in its plane."""
        first, second, third = PLANES[self._plane]
        given = [letter for letter in _OFFSETS if letter in values]
        if "R" in values and given:
            raise refused(line.number, f"R and {given[0]} in one arc: give one of them")
        if "R" in values:
            return center_of_radius(line.number, start, end, values["R"] * self._unit, clockwise=clockwise)
        if not given:
            raise refused(line.number, f"{line.text:.40}: an arc needs R, or its centre by I, J, K")
        if _OFFSETS[third] in given:
            raise refused(
                line.number, f"{_OFFSETS[third]}: the arc lies in the plane of G{self._plane}, without this axis"
            )
        offset = np.array([values.get(_OFFSETS[axis], 0.0) for axis in (first, second)]) * self._unit
        return start + offset if self._centers_relative else offset


def _straight(start: Place, end: Place) -> list[Place]:
    """Returns the end of a line, with places before where the tool turns on the way; none where nothing moves."""
    if start == end:
        return []
    if start[3:] == end[3:]:
        return [end]
    count = math.ceil(sum(abs(to - of) for of, to in zip(start[3:], end[3:], strict=True)) / _WIDEST_TURN)
    between = [tuple(of + i / count * (to - of) for of, to in zip(start, end, strict=True)) for i in range(1, count)]
    return [*between, end]
