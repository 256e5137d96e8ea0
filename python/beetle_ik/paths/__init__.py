"""Reference paths: curves, samples, lines over surfaces, and programs of machine tools.

The curves give the desired tip position as a function of time. Lines over surfaces and programs give poses, which
`plan_along_path` takes as they are, and a `Path` at a constant speed of the tip:

    seam = bik.paths.on_surface("part.stl", [(0.4, 0.0, 0.1), (0.5, 0.1, 0.1)], standoff=0.01)
    plan = bik.plan_along_path(robot, seam, task=bik.tasks.Pointing())
    result = bik.track(robot, seam.path(speed=0.05), dt=0.01)
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

from .._core import (
    circle,
    from_function,
    from_samples,
    hypotrochoid,
    letter_m,
    pentagram,
    polyline,
    rose,
)

if TYPE_CHECKING:
    from .gcode import GcodeMove, GcodeProgram, from_gcode
    from .joining import join
    from .passes import raster
    from .projection import on_surface
    from .seam import Seam

__all__ = [
    "GcodeMove",
    "GcodeProgram",
    "Seam",
    "circle",
    "from_function",
    "from_gcode",
    "from_samples",
    "hypotrochoid",
    "join",
    "letter_m",
    "on_surface",
    "pentagram",
    "polyline",
    "raster",
    "rose",
]

# Names imported at their first use, with their modules: they need numpy, which `import beetle_ik` does not load. A
# module must not have a public name: its import would put it in that place.
_LATER = {
    "GcodeMove": "gcode",
    "GcodeProgram": "gcode",
    "Seam": "seam",
    "from_gcode": "gcode",
    "join": "joining",
    "on_surface": "projection",
    "raster": "passes",
}


if not TYPE_CHECKING:

    def __getattr__(name: str) -> Any:
        """Imports a name at its first use."""
        if name not in _LATER:
            raise AttributeError(
                f"module '{__name__}' has no attribute '{name}'", name=name, obj=import_module(__name__)
            )
        value = getattr(import_module(f".{_LATER[name]}", __name__), name)
        globals()[name] = value
        return value
