"""beetle-ik's `Tracker` in the loops of `noisy_targets.py`."""

# Methods are described in mover.py.
# ruff: noqa: D101, D102, D107

from __future__ import annotations

from typing import Any

import numpy as np

from .chain import Chain
from .mover import Mover, Setting


class BeetleIk(Mover):
    name = "beetle-ik"
    distribution = "beetle-ik"
    settings = "Tracker, defaults"

    def __init__(self, chain: Chain, setting: Setting) -> None:
        import beetle_ik

        self._bik = beetle_ik
        self._robot = beetle_ik.Robot.from_urdf(chain.urdf, base=chain.base, tip=chain.tip)
        self._dt = setting.dt
        fields = {"velocity": setting.velocity, "acceleration": setting.acceleration}
        if setting.jerk is not None:
            fields["jerk"] = setting.jerk
        self._limits = beetle_ik.Limits(**fields)

    def begin(self, q: np.ndarray) -> None:
        self._tracker = self._bik.Tracker(self._robot, q, dt=self._dt, limits=self._limits, **self._options())

    def step(self, target: np.ndarray) -> np.ndarray:
        return self._tracker.step(target).q

    def _options(self) -> dict[str, Any]:
        return {}


class BeetleIkStream(BeetleIk):
    name = "beetle-ik, stamps"
    settings = "Tracker.step(target, stamp=) where one arrives, Tracker.step(None) elsewhere"

    def listen(self, target: np.ndarray | None, stamp: float | None) -> np.ndarray:
        if target is None:
            return self._tracker.step(None).q
        return self._tracker.step(target, stamp=stamp).q


class BeetleIkOneEuro(BeetleIkStream):
    name = "beetle-ik, stamps, One Euro"
    settings = "as before, target_filter=filters.OneEuro(min_cutoff=2.0, beta=20.0)"

    def _options(self) -> dict[str, Any]:
        return {"target_filter": self._bik.filters.OneEuro(min_cutoff=2.0, beta=20.0)}


class BeetleIkLowPass(BeetleIkStream):
    name = "beetle-ik, stamps, low-pass"
    settings = "as before, target_filter=filters.LowPass(cutoff=5.0)"

    def _options(self) -> dict[str, Any]:
        return {"target_filter": self._bik.filters.LowPass(cutoff=5.0)}
