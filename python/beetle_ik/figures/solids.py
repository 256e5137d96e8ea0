"""Appearance of an arm without meshes: solids of revolution along its skeleton, in the colours of its maker."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from .._core import Capsule, Sphere
from .skeleton import Part, skeleton

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from .._core import Robot

    Array = NDArray[np.float64]
    Finger = tuple[Array, Array, float]
    """Ends (3,) of the axis of a capsule (m), the one nearer to the flange first, and its radius (m)."""

_THICK, _THIN = 0.042, 0.030  # radii at base and tip, as fractions of the length of the skeleton
_AROUND = 24  # corners of a circle
_ARC = 3  # points of a rounded edge
_BEYOND = 1.12  # overhang of a link beyond a crossing link, as a fraction of its radius
_SHORTEST = 1e-6  # m: shortest arm that can be drawn
_DARK = "#3A3F47"


class Look(NamedTuple):
    """Colours of links, joints and caps, and the thickness of an arm relative to the usual."""

    links: str
    joints: str
    caps: str
    thickness: float = 1.0


_USUAL = Look("#E4E7EB", "#8FA5BC", "#5D7A99")
_MAKERS = {
    "panda": Look("#F4F4F2", "#E9EAEA", _DARK, 1.15),
    "fr3": Look("#F4F4F2", "#E9EAEA", _DARK, 1.15),
    "iiwa": Look("#D9DCDF", "#D9DCDF", "#F08A24", 1.35),
    "kr210": Look("#F2691B", "#F2691B", _DARK, 1.35),
    **dict.fromkeys(("ur3", "ur5", "ur10"), Look("#D5DADF", "#C3C9CF", "#4F9BD9")),
    "gen3": Look("#F2F2F2", _DARK, _DARK),
}


class Solid(NamedTuple):
    """A surface on a link: corners (k, 3) (m) in its frame, normals (k, 3) and faces (t, 3)."""

    link: str
    color: str
    vertices: Array
    normals: Array
    faces: NDArray[np.int64]

    @property
    def triangles(self) -> Array:
        """The triangles (t, 3, 3)."""
        return self.vertices[self.faces]


def solids(robot: Robot, q: Array) -> list[Solid]:
    """Returns solids for the links of a robot without meshes. `q` (n,) is any configuration.

    A robot with bodies other than capsules and balls is drawn by these bodies: nothing is returned.
    """
    links = {link for way in robot._links_to_tips() for link in way}
    if not all(isinstance(body.shape, Capsule | Sphere) for body in robot.bodies if body.link in links):
        return []
    roots, poses = skeleton(robot, q)
    length = max((part.distance + part.stub + part.way_to_tip for part in _all(roots)), default=0.0)
    if length < _SHORTEST:
        return []
    look = next((each for name, each in _MAKERS.items() if robot.name.startswith(name)), _USUAL)
    frames = dict(zip(robot.all_link_names, poses, strict=True))
    drawn = _Drawing(look, length, frames, robot.capsules)
    for root in roots:
        drawn.base(root)
        for part in _all(root.after):
            drawn.part(part)
    return drawn.solids


def _all(parts: list[Part]) -> list[Part]:
    return [each for part in parts for each in (part, *_all(part.after))]


class _Drawing:
    """Solids of the parts of one robot."""

    def __init__(
        self, look: Look, length: float, frames: dict[str, Array], capsules: list[tuple[str, Array, Array, float]]
    ) -> None:
        self.solids: list[Solid] = []
        self._look, self._length, self._frames, self._capsules = look, length, frames, capsules

    def base(self, part: Part) -> None:
        """Draws a fixed part: a foot, and columns up to the axes."""
        frame = self._frames[part.links[0]]
        foot = frame[:3, 3]
        for each in part.after:
            r, axis = self._radius(each), each.about
            up = axis.along * (1.0 if axis.along @ frame[:3, 2] >= 0 else -1.0)
            if np.linalg.norm(foot - axis.enter) < r and self._rolls(each):
                self._rod(part, axis.enter, axis.enter + 0.3 * r * up, 1.5 * r, self._look.joints, edge=0.1)
                self._rod(part, axis.enter, axis.enter + 0.9 * r * up, (1.3 * r, 1.02 * r), self._look.links)
            else:
                self._rod(part, foot, axis.enter, r, self._look.links, edge=0.9)
            self._arrival(part, each)

    def part(self, part: Part) -> None:
        """Draws a moving part: the housing of its joint, the links to the next joints and to the tips."""
        axis, r = part.about, self._radius(part)
        if axis.travel is not None:
            self._rod(
                part, axis.enter - r * axis.along, axis.enter + r * axis.along, 1.25 * r, self._look.joints, around=4
            )
            self._rod(part, axis.enter, axis.leave, r, self._look.links, edge=0.9)
        elif self._rolls(part):
            along = (axis.leave - axis.enter) / part.stub
            middle = 0.5 * (axis.enter + axis.leave)
            self._rod(part, middle - 0.06 * r * along, middle + 0.06 * r * along, 1.03 * r, self._look.caps, edge=0.03)
            self._capped(part, middle, axis.leave, along, -0.3 * r if self._is_flange(part) else _BEYOND * r)
        else:
            reach = (0.5 * part.stub + 1.16 * r) * axis.along
            centre = 0.5 * (axis.enter + axis.leave)
            self._rod(part, centre - reach, centre + reach, 1.14 * r, self._look.joints, edge=0.25)
            for side in (reach, -reach):
                self._rod(part, centre + 0.9 * side, centre + 1.03 * side, 0.8 * r, self._look.caps, edge=0.1)
        for each in part.after:
            self._rod(part, axis.leave, each.about.enter, (r, self._radius(each)), self._look.links, edge=0.9)
            self._arrival(part, each)
        for link, tip in part.ends:
            self._end(part, axis.leave, link[:3, 3], tip)

    def _arrival(self, part: Part, after: Part) -> None:
        """Draws the extent of a part along the axis of the part after it."""
        axis, r = after.about, self._radius(after)
        if axis.travel is not None:
            low, high = (np.clip(end, -self._length, self._length) for end in axis.travel)
            self._rod(part, axis.enter + low * axis.along, axis.enter + high * axis.along, 0.8 * r, _DARK, around=4)
        elif self._rolls(after):
            along = (axis.leave - axis.enter) / after.stub
            standing = part.axis is None and not part.distance
            self._capped(part, 0.5 * (axis.enter + axis.leave), axis.enter, -along, 0.0 if standing else _BEYOND * r)

    def _capped(self, part: Part, start: Array, end: Array, along: Array, beyond: float) -> None:
        """Draws a link along an axis, to its end and beyond, with a cap."""
        r = self._radius(part)
        self._rod(part, start, end + beyond * along, r, self._look.links, edge=0.2)
        if beyond > 0.0:
            cap = end + beyond * along
            self._rod(part, cap - 0.1 * r * along, cap + 0.05 * r * along, 0.78 * r, self._look.caps, edge=0.08)

    def _end(self, part: Part, start: Array, flange: Array, tip: Array) -> None:
        """Draws the link to a flange, and a tool on it that ends in a point."""
        r = self._radius(part)
        self._rod(part, start, flange, (r, 0.8 * r), self._look.links, edge=0.9)
        if self._is_flange(part) and part.axis is not None and part.stub:
            along = (part.axis.leave - part.axis.enter) / part.stub
            self._rod(part, flange - 0.35 * r * along, flange, 0.85 * r, _DARK, edge=0.08)
        self._tool(part, flange, tip[:3, 3], r)

    def _tool(self, part: Part, flange: Array, tip: Array, r: float) -> None:
        """Draws a tool that ends in a point, or the gripper that the bodies of the model make about the tip."""
        fingers = self._fingers(part, flange, tip)
        if not fingers:
            self._rod(part, flange, tip, (0.45 * r, 0.15 * r), _DARK, edge=0.14)
            return
        length = float(np.linalg.norm(tip - flange))
        along = (tip - flange) / length
        begin = min(float((start - flange) @ along) for start, _, _ in fingers)
        first = fingers[0][0] - flange
        aside = first - along * (first @ along)
        across = aside / np.linalg.norm(aside)
        reach = max(abs(float((start - flange) @ across)) + radius for start, _, radius in fingers)
        palm = max(begin - 1.2 * r, 0.0)
        self._rod(part, flange, flange + palm * along, 0.5 * r, self._look.joints)
        thin = max(radius for _, _, radius in fingers)
        corner = np.sqrt(2.0)  # a rod with four corners is that much thinner between them
        self._rod(
            part, flange + palm * along, flange + (begin + thin) * along, 1.6 * corner * thin, self._look.joints,
            edge=0.2, around=4, wider=(across, (reach + 0.5 * thin) / (1.6 * thin)),
        )  # fmt: skip
        for start, end, radius in fingers:
            self._rod(part, start, end, radius, _DARK, edge=0.8)

    def _fingers(self, part: Part, flange: Array, tip: Array) -> list[Finger]:
        """Returns the capsules of a part that lie beyond the flange and beside the line to the tip."""
        length = float(np.linalg.norm(tip - flange))
        if length < _SHORTEST:
            return []
        along = (tip - flange) / length
        found = []
        for link, start, end, radius in self._capsules:
            if link not in part.links or not radius:
                continue
            frame = self._frames[link]
            ends = [frame[:3, :3] @ each + frame[:3, 3] - flange for each in (start, end)]
            beside = min(float(np.linalg.norm(each - along * (each @ along))) for each in ends)
            if min(float(each @ along) for each in ends) > 0.0 and beside > radius:
                ends.sort(key=lambda each: float(each @ along))
                found.append((ends[0] + flange, ends[1] + flange, float(radius)))
        return found

    def _radius(self, part: Part) -> float:
        share = min(part.distance / self._length, 1.0)
        return self._look.thickness * self._length * (_THICK + share * (_THIN - _THICK))

    def _rolls(self, part: Part) -> bool:
        """Whether a link runs along the axis of a part: its joint is drawn as a cut across it, others as hinges."""
        return part.stub > 1.2 * self._radius(part)

    def _is_flange(self, part: Part) -> bool:
        """Whether a part ends on its own axis."""
        if part.axis is None or not part.ends:
            return False
        return float(np.linalg.norm(part.ends[0][0][:3, 3] - part.axis.leave)) < 0.1 * self._radius(part)

    def _rod(
        self,
        part: Part,
        start: Array,
        end: Array,
        radius: float | tuple[float, float],
        color: str,
        *,
        edge: float = 0.2,
        around: int = _AROUND,
        wider: tuple[Array, float] | None = None,
    ) -> None:
        """Draws a rod between two points, its edges rounded by a fraction `edge` of the radius; none if it is short.

        `wider` is a direction across the rod, and by how much the rod is wider in that direction.
        """
        first, last = radius if isinstance(radius, tuple) else (radius, radius)
        length = float(np.linalg.norm(end - start))
        if length < 0.1 * min(first, last) and length < 0.02 * self._length * _THIN:
            return
        frame = self._frames[part.links[0]]
        along = (end - start) / length
        profile = _profile(first, last, length, edge)
        turn, origin = frame[:3, :3], frame[:3, 3]
        vertices, normals, faces = _revolved(profile, around)
        place = _upright(along)
        if wider is not None:
            side, stretch = wider
            place = np.column_stack((side, np.cross(along, side), along))
            vertices[:, 0] *= stretch
            normals[:, 0] /= stretch
            normals /= np.linalg.norm(normals, axis=1, keepdims=True)
        vertices = (vertices @ place.T + start - origin) @ turn
        self.solids.append(Solid(part.links[0], color, vertices, normals @ place.T @ turn, faces))


def _profile(first: float, last: float, length: float, edge: float) -> Array:
    """Returns radii and heights (k, 2) of a rod with rounded edges."""
    angles = np.linspace(0.0, 0.5 * np.pi, _ARC)
    arcs = []
    for radius, sign, end in ((first, 1.0, 0.0), (last, -1.0, length)):
        bow = min(edge * radius, 0.4 * length)
        arcs.append(np.column_stack((radius - bow * (1 - np.sin(angles)), end + sign * bow * (1 - np.cos(angles)))))
    return np.vstack(([0.0, 0.0], arcs[0], arcs[1][::-1], [0.0, length]))


def _revolved(profile: Array, around: int) -> tuple[Array, Array, NDArray[np.int64]]:
    """Returns corners, normals and faces of a profile (k, 2) turned about the z axis."""
    slopes = np.gradient(profile, axis=0)
    slopes /= np.linalg.norm(slopes, axis=1, keepdims=True)
    angles = np.linspace(0.0, 2 * np.pi, around, endpoint=False) + np.pi / around
    circle = np.column_stack((np.cos(angles), np.sin(angles)))
    vertices = [np.column_stack((radius * circle, np.full(around, height))) for radius, height in profile]
    normals = [np.column_stack((rise * circle, np.full(around, -out))) for out, rise in slopes]
    i, j = np.arange(around), (np.arange(around) + 1) % around
    faces = []
    for ring in range(len(profile) - 1):
        low, high = ring * around, (ring + 1) * around
        if profile[ring, 0] > 0:
            faces.append(np.column_stack((low + i, low + j, high + i)))
        if profile[ring + 1, 0] > 0:
            faces.append(np.column_stack((low + j, high + j, high + i)))
    return np.concatenate(vertices), np.concatenate(normals), np.concatenate(faces)


def _upright(along: Array) -> Array:
    """Returns a rotation (3, 3) that turns the z axis to a direction."""
    side = np.cross(along, np.eye(3)[np.abs(along).argmin()])
    side /= np.linalg.norm(side)
    return np.column_stack((side, np.cross(along, side), along))
