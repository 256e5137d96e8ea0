"""Interface of `noisy_targets.py` to a library: one configuration per tick, towards a moving target."""

# ruff: noqa: ARG002, D107

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from .chain import Chain


@dataclass(frozen=True)
class Setting:
    """Tick and limits of every joint; `jerk` None without a limit."""

    dt: float  # s
    velocity: float  # rad/s, m/s
    acceleration: float  # rad/s^2, m/s^2
    jerk: float | None  # rad/s^3, m/s^3


class Mover:
    """One library moving one arm. Each step must do what a user's loop would do, conversions included."""

    name: ClassVar[str]
    distribution: ClassVar[str]
    settings: ClassVar[str]  # as a reader would need them to repeat the run

    def __init__(self, chain: Chain, setting: Setting) -> None:
        raise NotImplementedError

    def begin(self, q: np.ndarray) -> None:
        """Puts the arm to rest at `q`."""
        raise NotImplementedError

    def step(self, target: np.ndarray) -> np.ndarray:
        """Returns the configuration to command at the end of this tick; `target` (4, 4) is the target at that time."""
        raise NotImplementedError

    def listen(self, target: np.ndarray | None, stamp: float | None) -> np.ndarray:
        """Steps like `step`, from a slow stream: `target` is None in a tick without a new one.

        `stamp` is the time of its measurement (s). A library without support for streams gets the last target again.
        """
        if target is not None:
            self._held = target
        return self.step(self._held)
