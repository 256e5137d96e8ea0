"""Takes the still pictures of the site's recordings, which the gallery shows for its examples too.

    python tools/recording_pictures.py [NAME ...]

Writes docs/static/pictures/NAME.webp; docs/extensions/recorded_scenes.py has the names. Needs the extra `docs`,
playwright and Chromium.
"""

import importlib
import io
import sys
import tempfile
from pathlib import Path
from typing import Any

from check_site import served
from PIL import Image
from viewer_pictures import visits

from beetle_ik.viewing import write_player

ROOT = Path(__file__).parents[1]
PICTURES = ROOT / "docs" / "static" / "pictures"
sys.path.insert(0, str(ROOT / "docs" / "extensions"))
_SIZE, _BAR = (640, 432), 40  # pixels; the bar below is the player's
_UNDER_WAY, _PATIENCE = 9000, 120_000  # ms; shapes fade in
_NO_NOTES = ".mantine-Notification-root, .mantine-ActionIcon-root { display: none !important; }"


def take(browser: Any, address: str, name: str) -> bytes:
    """Returns a picture of a playing recording, without its controls."""
    page = browser.new_page(device_scale_factor=1, viewport={"width": _SIZE[0], "height": _SIZE[1] + _BAR})
    page.set_default_timeout(_PATIENCE)
    page.goto(f"{address}/player.html?playbackPath={name}.viser")
    page.add_style_tag(content=_NO_NOTES)
    page.wait_for_timeout(_UNDER_WAY)
    picture: bytes = page.screenshot(clip={"x": 0, "y": 0, "width": _SIZE[0], "height": _SIZE[1]})
    page.close()
    return picture


def main() -> None:
    """Takes the named pictures, or all."""
    recorded_scenes = importlib.import_module("recorded_scenes")
    PICTURES.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as folder:
        site = Path(folder)
        write_player(site / "player.html")
        names = sys.argv[1:] or recorded_scenes.NAMES
        for name in names:
            recorded_scenes.write(name, site / f"{name}.viser")
        with served(site) as address, visits() as browser:
            for name in names:
                Image.open(io.BytesIO(take(browser, address, name))).save(PICTURES / f"{name}.webp", quality=80)
                print(name)


if __name__ == "__main__":
    main()
