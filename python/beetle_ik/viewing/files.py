"""Files of a page: the state as a program, and the scene to save and load."""

from __future__ import annotations

import html
from functools import partial
from typing import TYPE_CHECKING, Any

from ..scenes.json_file import obstacles_in, scene_text
from .planning import ACCELERATION
from .program import program

if TYPE_CHECKING:
    from .page import Page
    from .planning import Planning

_COPY = (
    "const text = this.previousElementSibling; text.select(); document.execCommand('copy'); this.textContent = 'Copied'"
)
_STYLE = "width:100%;font-family:monospace;font-size:0.8em;white-space:pre;overflow:auto"


class Program:
    """A button that shows the state as a program to copy."""

    def __init__(self, page: Page, planning: Planning) -> None:
        """Adds the button."""
        self._page, self._planning = page, planning
        button = page.server.gui.add_button("Copy as Python", hint="start, target and obstacles as a program")

        @button.on_click
        def _(event: Any) -> None:
            if event.client is not None:
                page.ask(button, partial(self._show, event.client))

    def text(self) -> str:
        """Returns the program."""
        return program(self._page.arm, *self._planning.ends, ACCELERATION)

    def _show(self, client: Any) -> None:
        text = self.text()
        with client.gui.add_modal("Copy as Python") as modal:
            rows = min(text.count("\n") + 1, 24)
            area = f"<textarea readonly rows='{rows}' style='{_STYLE}'>{html.escape(text)}</textarea>"
            client.gui.add_html(
                f'{area}<button style="margin:0.5em 0;padding:0.3em 1em" onclick="{_COPY}">Copy</button>'
            )
            client.gui.add_button("Close").on_click(lambda _: modal.close())


class SceneFiles:
    """Buttons that save the obstacles to a file of the visitor, and load them from one."""

    def __init__(self, page: Page) -> None:
        """Adds the buttons."""
        self._page = page
        gui = page.server.gui
        save = gui.add_button("Save scene", hint="as a file that bik.Scene.load and --scene read")
        load = gui.add_upload_button("Load scene", mime_type="application/json", hint="a file of bik.Scene.save")

        @save.on_click
        def _(event: Any) -> None:
            if event.client is not None:
                page.ask(save, partial(self._save, event.client))

        @load.on_upload
        def _(event: Any) -> None:
            if event.client is not None:
                page.ask(load, partial(self._load, event.target.value))

    def _save(self, client: Any) -> None:
        client.send_file_download("scene.json", scene_text(self._page.arm.obstacles).encode(), save_immediately=True)

    def _load(self, file: Any) -> None:
        self._page.arm.obstacles = obstacles_in(file.content, f"{file.name:.80}")
