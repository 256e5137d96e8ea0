"""Warnings in the file and line of the caller."""

import os
import sys
import warnings
from pathlib import Path

from .._core import UnitsWarning

_PACKAGE = f"{Path(__file__).parent.parent}{os.sep}"


def warn(message: str, category: type[Warning] = UnitsWarning) -> None:
    """Raises a warning of this category where the first file outside this package called it."""
    frame, level = sys._getframe(1), 2
    while frame.f_back is not None and frame.f_code.co_filename.startswith(_PACKAGE):
        frame, level = frame.f_back, level + 1
    warnings.warn(message, category, stacklevel=level)
