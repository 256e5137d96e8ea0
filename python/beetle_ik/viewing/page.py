"""What the parts of the page share."""

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

    Parts ask for changes; they are carried out one at a time by the thread of the viewer, which then refreshes all.
    """

    server: viser.ViserServer
    arm: Arm
    ask: Callable[[object, Callable[[], None]], None]
    scale: float
    """Length of the arm (m)."""

    def on_input(self, handle: Any, change: Callable[[], None]) -> None:
        """Has `change` carried out when someone uses an input or a button of the page, but not when Python sets it.

        viser calls back in any of several threads, in any order: `change` must read the input when it is carried out.
        """

        def asked(event: Any) -> None:
            if event.client_id is not None:
                self.ask(handle, change)

        (handle.on_click if hasattr(handle, "on_click") else handle.on_update)(asked)


def set_value(handle: Any, value: Any) -> None:
    """Sets an input of the page. viser sends nothing if it has that value already."""
    handle.value = value  # typed as read-only
