"""The list of commands, and the reporting of errors."""

import logging
import warnings
from functools import partial
from typing import Annotated, Any

import typer
from typer.core import TyperGroup

from .. import BeetleIkError, UnitsWarning, __version__
from .calibrate import calibrate
from .doctor import doctor
from .fk import fk
from .options import numbers_joined
from .plan import plan
from .reach import reach
from .reproduce import reproduce
from .robots import robots
from .ros import ros
from .solve import solve
from .track import track
from .view import view
from .wording import in_options

_WRONG_INPUT = 2
_INTERRUPTED = 130  # the convention of shells: 128 + SIGINT


class _Commands(TyperGroup):
    """Prints an error as one line instead of a traceback."""

    def list_commands(self, ctx: Any) -> list[str]:
        """Lists `reproduce` last; Typer would put the group `plan` there."""
        return sorted(super().list_commands(ctx), key=lambda name: name == "reproduce")

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Reads numbers separated by spaces, as in `--position 0.4 0.2 0.5`, as one value of the option."""
        return super().parse_args(ctx, numbers_joined(args))

    def invoke(self, ctx: Any) -> Any:
        try:
            with warnings.catch_warnings():
                warnings.showwarning = partial(_show_warning, warnings.showwarning)
                return super().invoke(ctx)
        except BrokenPipeError:
            raise  # the reader of our output has closed the pipe: Typer exits silently
        except BeetleIkError as error:
            typer.echo(f"Error: {in_options(error)}", err=True)
            raise typer.Exit(_WRONG_INPUT) from error
        except OSError as error:
            where = "" if error.filename is None else f"'{error.filename}': "
            typer.echo(f"Error: {where}{error.strerror or error}", err=True)
            raise typer.Exit(_WRONG_INPUT) from error
        except KeyboardInterrupt as interrupt:
            # True for every command: its files appear only when all of them are complete.
            typer.echo("Interrupted: nothing was written.", err=True)
            raise typer.Exit(_INTERRUPTED) from interrupt


def _show_warning(others: Any, message: Warning | str, category: type[Warning], *place: Any, **more: Any) -> None:
    """Prints a warning of this library, or one for users, as one line; `others` shows those of other libraries."""
    if category in (UnitsWarning, UserWarning):
        typer.echo(f"Warning: {in_options(message)}", err=True)
    else:
        others(message, category, *place, **more)


app = typer.Typer(
    cls=_Commands,
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    help="Inverse kinematics, path tracking and planning for robot manipulators. SI units and radians.",
    epilog="Exit status: 0 target reached, 1 computed but not reached, 2 wrong input, 130 interrupted.",
)


def _print_version(asked: bool) -> None:
    if asked:
        typer.echo(f"beetle-ik {__version__}")
        raise typer.Exit


@app.callback()
def _options_of_all(
    *,
    _version: Annotated[
        bool, typer.Option("--version", callback=_print_version, is_eager=True, help="Print the version and exit.")
    ] = False,
    verbose: Annotated[bool, typer.Option("--verbose", help="Log to stderr what the library does.")] = False,
) -> None:
    """Options that belong to no single command."""
    if verbose:
        logging.basicConfig(level=logging.INFO, format="%(asctime)s %(name)s: %(message)s")


for command in (robots, fk, solve, track, reach, calibrate, view, ros, doctor):
    app.command()(command)
app.add_typer(plan, name="plan")
app.command()(reproduce)
