"""What `noisy_targets.py` asks of a library: one configuration a tick, towards a target that moves."""

# ruff: noqa: ARG002, D107

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

import numpy as np

from .chain import Chain


@dataclass(frozen=True)
class Setting:
    """The tick and the limits of every joint; `jerk` None where there is none."""

    dt: float  # s
    velocity: float  # rad/s, m/s
    acceleration: float  # rad/s^2, m/s^2
    jerk: float | None  # rad/s^3, m/s^3


class Mover:
    """One library with one arm in its hands. Each step must do what a user's loop would do, conversions included."""

    name: ClassVar[str]
    distribution: ClassVar[str]
    settings: ClassVar[str]  # as a reader would need them to repeat the run

    def __init__(self, chain: Chain, setting: Setting) -> None:
        raise NotImplementedError

    def begin(self, q: np.ndarray) -> None:
        """Put the arm to rest at `q`."""
        raise NotImplementedError

    def step(self, target: np.ndarray) -> np.ndarray:
        """The configuration to command at the end of this tick; `target` (4, 4) is the target at that time."""
        raise NotImplementedError

    def listen(self, target: np.ndarray | None, stamp: float | None) -> np.ndarray:
        """As `step`, from a slow stream: None in a tick that brings no target; `stamp` is when one was measured (s).

        A library that knows nothing of streams is given the last target again.
        """
        if target is not None:
            self._held = target
        return self.step(self._held)
