"""The call that opens a viewer."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING

from .._core import Obstacle, Robot
from ..calls.arguments import require
from ..calls.wording import worded_call
from .viewer import Viewer

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from .._core import Path


@worded_call
def view(
    robot: Robot,
    q: ArrayLike | None = None,
    *,
    obstacles: Iterable[Obstacle] | None = None,
    path: Path | ArrayLike | None = None,
    host: str = "127.0.0.1",
    port: int = 8080,
    block: bool = False,
) -> Viewer:
    """Shows a robot in the browser, where its tip, its joints and obstacles can be dragged. Needs the extra "view".

    The arm follows the handle at its tip like `Tracker`: within its limits, and certified clear of obstacles and of
    itself. A robot with several tips has a handle for each. The page has sliders for the joints, shows all solutions
    and the self-motion, and plays motions back. Links show the meshes of `robot.visuals` whose files are found,
    otherwise their collision meshes or bodies; a robot without bodies gets capsules along its links. In a notebook the
    viewer appears inline.

    Args:
        robot: the robot.
        q: joint positions (n,) to begin at (rad, m); None: the stance "ready" of an SRDF, or a bent and clear
            configuration near the middle of the limits.
        obstacles: obstacles of `bik.obstacles`, or a `Scene`, in the frame of the robot's base.
        path: a path to draw: one of `bik.paths`, positions (k, 3) (m) or poses (k, 4, 4).
        host: the address at which the page is served. "127.0.0.1": this machine alone; "0.0.0.0": everyone who reaches
            it and knows the token, which is part of the address.
        port: the port; if it is in use, the next free one. 0: any.
        block: whether to wait until Ctrl-C, which closes the viewer.

    Returns:
        A `Viewer`; `viewer.url` is the address of the page.

    Raises:
        BeetleIkError: viser is not installed.
        InvalidInputError: wrong shape, NaN, or a host or port that cannot be used.
        LimitError: a configuration outside the limits.
    """
    require("block", block, bool)
    viewer = Viewer(robot, q, obstacles=obstacles, path=path, host=host, port=port)
    if block:
        viewer.wait()
    return viewer
