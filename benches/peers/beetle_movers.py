"""beetle-ik's `Tracker` in the loops of `noisy_targets.py`."""

# The methods are described in mover.py.
# ruff: noqa: D101, D102, D107

from __future__ import annotations

import inspect
from typing import Any

import numpy as np

from .adapter import Unsupported
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
        try:
            self.begin((chain.lower + chain.upper) / 2.0)
        except beetle_ik.UnsupportedLimit as refusal:
            raise Unsupported(f"refused: {refusal}") from refusal

    def begin(self, q: np.ndarray) -> None:
        self._tracker = self._bik.Tracker(self._robot, q, dt=self._dt, limits=self._limits, **self._options())

    def step(self, target: np.ndarray) -> np.ndarray:
        return self._tracker.step(target).q

    def _options(self) -> dict[str, Any]:
        return {}


class BeetleIkStream(BeetleIk):
    name = "beetle-ik, stamps"
    settings = "Tracker.step(target, stamp=) where one arrives, Tracker.step(None) elsewhere"

    def __init__(self, chain: Chain, setting: Setting) -> None:
        import beetle_ik

        if "stamp" not in inspect.signature(beetle_ik.Tracker.step).parameters:
            raise Unsupported("this version's Tracker takes no stamps")
        super().__init__(chain, setting)

    def listen(self, target: np.ndarray | None, stamp: float | None) -> np.ndarray:
        if target is None:
            return self._tracker.step(None).q
        return self._tracker.step(target, stamp=stamp).q


class _Filtered(BeetleIkStream):
    def __init__(self, chain: Chain, setting: Setting) -> None:
        import beetle_ik

        if not hasattr(beetle_ik, "filters"):
            raise Unsupported("this version has no target filters")
        super().__init__(chain, setting)


class BeetleIkOneEuro(_Filtered):
    name = "beetle-ik, stamps, One Euro"
    settings = "as before, target_filter=filters.OneEuro(min_cutoff=2.0, beta=20.0)"

    def _options(self) -> dict[str, Any]:
        return {"target_filter": self._bik.filters.OneEuro(min_cutoff=2.0, beta=20.0)}


class BeetleIkLowPass(_Filtered):
    name = "beetle-ik, stamps, low-pass"
    settings = "as before, target_filter=filters.LowPass(cutoff=5.0)"

    def _options(self) -> dict[str, Any]:
        return {"target_filter": self._bik.filters.LowPass(cutoff=5.0)}
