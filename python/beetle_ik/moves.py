"""Moves of programs for `plan_moves`: joint moves, lines and arcs of the tip, waits."""

from ._core import Arc, Joints, Line, Move, Wait

__all__ = ["Arc", "Joints", "Line", "Move", "Wait"]
