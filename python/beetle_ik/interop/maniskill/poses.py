"""Poses as mplib and SAPIEN have them: a position and a quaternion w x y z."""

from typing import Any, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..._core import InvalidInputError, pose

Array: TypeAlias = NDArray[np.float64]


class Pose:
    """A pose of position `p` (3,) (m) and quaternion `q` (w, x, y, z), or of a matrix (4, 4) or another pose.

    Raises:
        InvalidInputError: what is given is no pose.
    """

    def __init__(self, p: Any = (0.0, 0.0, 0.0), q: ArrayLike | None = None) -> None:
        """Makes the pose; with q None, p may be a matrix (4, 4), a 7-vector, or an object with p and q."""
        place = np.shape(getattr(p, "p", p))
        self._matrix = (
            _from_parts(p, (1.0, 0.0, 0.0, 0.0) if q is None else q)
            if place == (3,) and not hasattr(p, "p")
            else matrix_of("p", p)
        )

    @property
    def p(self) -> Array:
        """The position (3,) (m)."""
        return self._matrix[:3, 3].copy()

    @property
    def q(self) -> Array:
        """The unit quaternion (w, x, y, z), w not negative."""
        return _quaternion(self._matrix[:3, :3])

    def to_transformation_matrix(self) -> Array:
        """Returns the matrix (4, 4)."""
        return self._matrix.copy()

    def inv(self) -> "Pose":
        """Returns the inverse."""
        return Pose(_inverse(self._matrix))

    def distance(self, other: "Pose") -> float:
        """Returns the distance of the positions (m) plus that of the quaternions."""
        one, two = self.q, other.q
        apart = min(np.linalg.norm(one - two), np.linalg.norm(one + two))
        return float(np.linalg.norm(self.p - other.p) + apart)

    def __mul__(self, other: Any) -> Any:
        """Returns the composition with a pose, or a point (3,) moved by this pose."""
        if isinstance(other, Pose):
            return Pose(self._matrix @ other._matrix)
        return self._matrix[:3, :3] @ np.asarray(other, dtype=float) + self._matrix[:3, 3]

    def __repr__(self) -> str:
        """Shows position and quaternion."""
        return f"Pose(p={self.p.tolist()}, q={self.q.tolist()})"


def matrix_of(name: str, value: Any) -> Array:
    """Returns the matrix (4, 4) of a pose: of mplib or SAPIEN, a 7-vector (x, y, z, qw, qx, qy, qz), or a matrix.

    Raises:
        InvalidInputError: something else, or NaN.
    """
    if hasattr(value, "p") and hasattr(value, "q"):
        return _from_parts(value.p, value.q)
    try:
        entries = np.asarray(value, dtype=float)
    except (TypeError, ValueError):
        raise InvalidInputError(f"{name}: expected {_WANTED}, got {value!r:.60}") from None
    if entries.size == 7:
        return _from_parts(entries.ravel()[:3], entries.ravel()[3:])
    if entries.shape[-2:] != (4, 4) or entries.size != 16:
        raise InvalidInputError(f"{name}: expected {_WANTED}, got shape {entries.shape}")
    return pose(matrix=entries.reshape(4, 4))


_WANTED = "a pose with p and q, a 7-vector (x, y, z, qw, qx, qy, qz) or a matrix (4, 4)"


def _from_parts(p: ArrayLike, q: ArrayLike) -> Array:
    w, x, y, z = np.asarray(q, dtype=float).ravel()
    return pose(np.asarray(p, dtype=float).ravel(), xyzw=[x, y, z, w])


def _inverse(matrix: Array) -> Array:
    turned = matrix[:3, :3].T
    inverse = np.eye(4)
    inverse[:3, :3], inverse[:3, 3] = turned, -turned @ matrix[:3, 3]
    return inverse


def _quaternion(rotation: Array) -> Array:
    """Returns the quaternion (w, x, y, z) from the row of its largest entry (Shepperd 1978)."""
    r, trace = rotation, np.trace(rotation)
    squares = np.array([trace, *(2.0 * np.diag(r) - trace)])
    i = int(np.argmax(squares))
    if i == 0:
        q = np.array([1.0 + trace, r[2, 1] - r[1, 2], r[0, 2] - r[2, 0], r[1, 0] - r[0, 1]])
    else:
        a, b, c = i - 1, i % 3, (i + 1) % 3
        q = np.empty(4)
        q[0], q[1 + a] = r[c, b] - r[b, c], 1.0 + r[a, a] - r[b, b] - r[c, c]
        q[1 + b], q[1 + c] = r[b, a] + r[a, b], r[c, a] + r[a, c]
    q /= np.linalg.norm(q)
    return q if q[0] >= 0.0 else -q
