"""The command line: `beetle-ik robots | fk | solve | track | plan | reproduce`.

Exit status: 0 what was asked was reached, 1 it was computed but not reached, 2 the input was wrong, 130 Ctrl-C.
"""

from .app import app, main

__all__ = ["app", "main"]
