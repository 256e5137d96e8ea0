"""The command line: `beetle-ik robots | fk | solve | track | plan | view | reproduce | doctor`.

Exit status: 0 target reached, 1 computed but not reached, 2 wrong input, 130 interrupted by Ctrl-C.
"""

from .app import app, main

__all__ = ["app", "main"]
