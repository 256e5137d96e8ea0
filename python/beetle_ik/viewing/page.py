"""Data shared by the parts of the page."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    import viser

    from .arm import Arm


@dataclass(frozen=True)
class Page:
    """A served page, and the arm that it shows.

    The thread of the viewer carries out the changes that parts request, one at a time, and then refreshes all parts.
    """

    server: viser.ViserServer
    arm: Arm
    ask: Callable[[object, Callable[[], None]], None]
    scale: float
    """Length of the arm (m)."""

    def on_input(self, handle: Any, change: Callable[[], None]) -> None:
        """Requests `change` when someone uses an input or a button of the page, but not when Python sets it.

        viser calls back in any of several threads, in any order: `change` must read the input when it runs.
        """

        def asked(event: Any) -> None:
            if event.client_id is not None:
                self.ask(handle, change)

        (handle.on_click if hasattr(handle, "on_click") else handle.on_update)(asked)


def set_value(handle: Any, value: Any) -> None:
    """Sets an input of the page. viser sends nothing if the value is unchanged."""
    handle.value = value  # annotated as read-only by viser
