"""`beetle-ik plan ...`: motion planning."""

import typer

from .along_path import along_path
from .moves import moves
from .point_to_point import point_to_point
from .retime import retime

plan = typer.Typer(no_args_is_help=True, help="Plan motions within joint limits.")
for command in (point_to_point, along_path, moves, retime):
    plan.command()(command)

__all__ = ["plan"]
