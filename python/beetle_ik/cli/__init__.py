"""The command line: `beetle-ik robots | fk | solve | track | plan | view | ros | reproduce | doctor`.

Exit status: 0 target reached, 1 computed but not reached, 2 wrong input, 130 interrupted by Ctrl-C.
"""

import sys

_WRONG_INPUT = 2


def main() -> None:
    """Runs the command line on the arguments of the process, or says what it needs."""
    try:
        from .app import app
    except ModuleNotFoundError as error:
        if error.name not in ("typer", "rich"):
            raise
        print("Error: the command line needs typer: pip install 'beetle-ik[cli]'", file=sys.stderr)
        sys.exit(_WRONG_INPUT)
    app(prog_name="beetle-ik")


__all__ = ["main"]
