"""The commands in one place, and how mistakes are told."""

from typing import Annotated, Any

import typer
from typer.core import TyperGroup

from .. import BeetleIkError, __version__
from .fk import fk
from .plan import plan
from .reproduce import reproduce
from .robots import robots
from .solve import solve
from .track import track

_WRONG_INPUT = 2
_INTERRUPTED = 130  # as shells have it: 128 + SIGINT


class _Commands(TyperGroup):
    """Users get the sentence of an error, not its traceback."""

    def list_commands(self, ctx: Any) -> list[str]:
        """As given, but for `plan`: Typer puts groups last."""
        return sorted(super().list_commands(ctx), key=lambda name: name == "reproduce")

    def invoke(self, ctx: Any) -> Any:
        try:
            return super().invoke(ctx)
        except BrokenPipeError:
            raise  # the reader of our output has gone: Typer leaves without a word
        except BeetleIkError as error:
            typer.echo(f"Error: {error}", err=True)
            raise typer.Exit(_WRONG_INPUT) from error
        except OSError as error:
            where = "" if error.filename is None else f"'{error.filename}': "
            typer.echo(f"Error: {where}{error.strerror or error}", err=True)
            raise typer.Exit(_WRONG_INPUT) from error
        except KeyboardInterrupt as interrupt:
            # True of every command: files appear when all of them are complete.
            typer.echo("Interrupted: nothing was written.", err=True)
            raise typer.Exit(_INTERRUPTED) from interrupt


app = typer.Typer(
    cls=_Commands,
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
    help="Inverse kinematics, path tracking and planning for robot manipulators. SI units and radians.",
    epilog="Exit status: 0 reached, 1 computed but not reached, 2 wrong input, 130 interrupted.",
)


def _print_version(asked: bool) -> None:
    if asked:
        typer.echo(f"beetle-ik {__version__}")
        raise typer.Exit


@app.callback()
def _options_of_all(
    *,
    version: Annotated[
        bool, typer.Option("--version", callback=_print_version, is_eager=True, help="Print the version and exit.")
    ] = False,
) -> None:
    """Take what belongs to no single command."""


for command in (robots, fk, solve, track):
    app.command()(command)
app.add_typer(plan, name="plan")
app.command()(reproduce)


def main() -> None:
    """Run the command line on the arguments of the process."""
    app(prog_name="beetle-ik")
