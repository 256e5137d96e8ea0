"""`beetle-ik plan ...`: motions that do not exist yet."""

import typer

from .retime import retime

plan = typer.Typer(no_args_is_help=True, help="Plan motions within joint limits.")
plan.command()(retime)

__all__ = ["plan"]
