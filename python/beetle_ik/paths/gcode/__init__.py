"""Programs of machine tools and printers (G-code) as paths.

read      the call `from_gcode`: opens the program, and makes poses of its points
program   the result
lines     lines of text as words
machine   the state that words change, and the moves they make
arcs      points of circular arcs
"""

from .program import GcodeMove, GcodeProgram
from .read import from_gcode

__all__ = ["GcodeMove", "GcodeProgram", "from_gcode"]
