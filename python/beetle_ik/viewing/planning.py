"""Planning to the handles."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from .._core import BeetleIkError, Limits, Stop, plan_point_to_point

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from .._core import Trajectory
    from .arm import Targets
    from .page import Page
    from .playback import Playback

ACCELERATION = 5.0  # rad/s^2, m/s^2: calm enough to watch
_PATIENCE = Stop(max_time=2.0)  # s: the page waits for the plan
_THERE = 1e-3  # m, and entries of rotations: tolerance between arm and handle


class Planning:
    """A button that plans a motion from the present configuration to the handles, clear of obstacles, and plays it."""

    def __init__(self, page: Page, playback: Playback) -> None:
        """Adds the button."""
        self._page, self._playback = page, playback
        self._made: tuple[Trajectory, NDArray[np.float64], Targets] | None = None
        button = page.server.gui.add_button(
            "Plan to the handle",
            hint="a motion from here to the handle, clear of obstacles; 'off' above lets the handle move alone",
        )
        page.on_input(button, self._plan)

    def _plan(self) -> None:
        arm = self._page.arm
        if all(np.abs(arm.tips_at(arm.q)[tip] - target).max() < _THERE for tip, target in arm.targets.items()):
            raise BeetleIkError(
                "the arm is at the handle already: choose 'off' under 'the arm follows', drag the handle, and plan"
            )
        start, targets = arm.inside, arm.targets
        plan = plan_point_to_point(
            arm.robot, start_q=start, end=arm.goal, task=arm.task, obstacles=arm.avoided,
            self_collision=arm.keeps_clear, limits=Limits(acceleration=ACCELERATION), stop=_PATIENCE,
        )  # fmt: skip
        if not plan.success:
            raise BeetleIkError(plan.message)
        self._playback.show(plan.trajectory, repeat=False, clearance=plan.clearance)
        self._made = (plan.trajectory, start, targets)

    @property
    def ends(self) -> tuple[NDArray[np.float64], Targets]:
        """Start and target of a plan: of the plan whose motion is shown, or of the next one."""
        if self._made is not None and self._playback.shows(self._made[0]):
            return self._made[1:]
        return self._page.arm.inside, self._page.arm.targets
