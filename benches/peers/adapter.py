"""Interface of `compare.py` to a library."""

# ruff: noqa: D102, D107, N818

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, ClassVar

import numpy as np

from .chain import Chain


class Unsupported(Exception):
    """Refusal of a library to solve this robot."""


class Adapter:
    """One library on one robot. Each call must do what a user's call would do, conversions included.

    A method that is not overridden is not offered by the library; `compare.py` then leaves the cell empty. The import
    belongs in `__init__`, so that a library that is not installed is named and not fatal.
    """

    name: ClassVar[str]
    distribution: ClassVar[str]
    settings: ClassVar[str]  # as a reader would need them to repeat the run

    def __init__(self, chain: Chain, tolerance: float) -> None:
        raise NotImplementedError

    def solve_pose(self, target: np.ndarray, start: np.ndarray) -> np.ndarray | None:
        """Joint values whose tip pose is `target` (4, 4), in m and rad; None where the library reports failure."""
        raise NotImplementedError

    def chosen(self, answer: Any) -> np.ndarray | None:
        """Joint values in an answer of `solve_pose` or `solve_position`; not timed."""
        return answer

    def solve_position(self, point: np.ndarray, start: np.ndarray) -> np.ndarray | None:
        """Joint values whose tip is at `point` (3,), in m, with any orientation."""
        raise NotImplementedError

    def solve_all(self, target: np.ndarray, start: np.ndarray) -> np.ndarray:
        """All configurations (k, n) that the library finds for the pose, as it returns them."""
        raise NotImplementedError

    def follow(self, points: np.ndarray, start: np.ndarray) -> list[np.ndarray | None]:
        """Joint values whose tip is at each of `points` (k, 3), each found from the one before."""
        followed, q = [], start
        for point in points:
            followed.append(self.solve_position(point, q))
            q = q if followed[-1] is None else followed[-1]
        return followed

    def fk(self, q: np.ndarray) -> object:
        """Tip pose, in the library's own type."""
        raise NotImplementedError

    def fk_and_jacobian(self, q: np.ndarray) -> object:
        """Tip pose and its Jacobian."""
        raise NotImplementedError

    @classmethod
    def offers(cls, method: str) -> bool:
        return getattr(cls, method) is not getattr(Adapter, method)


def load(libraries: Iterable[type], chain: Chain, options: Any) -> tuple[list[Any], dict[str, str]]:
    """Loads the libraries that are installed and accept this robot, and the reasons for the missing ones."""
    taken, missing = [], {}
    for library in libraries:
        try:
            taken.append(library(chain, options))
        except (ImportError, Unsupported) as reason:
            missing[library.name] = str(reason)
        except Exception as failure:  # of any kind: one library must not end the run of the others
            missing[library.name] = f"{type(failure).__name__}: {failure}"
    return taken, missing
