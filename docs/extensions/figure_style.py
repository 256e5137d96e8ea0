"""Draws figures on a transparent ground, which dark mode turns round (static/site.css)."""

from typing import Any

import matplotlib.pyplot as plt

STYLE = {"savefig.transparent": True}


def reset(_gallery_conf: dict[str, Any], _file: str) -> None:
    """Sets the style before each example of the gallery."""
    plt.rcParams.update(STYLE)
