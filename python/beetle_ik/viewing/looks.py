"""Appearance of a robot's links: their visual meshes, read by trimesh with their materials."""

from __future__ import annotations

from itertools import cycle
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from .._core import BeetleIkError
from ..calls.text import counted
from ..figures.solids import solids
from ..figures.style import LINKS, rgb
from ..figures.surface import simplified
from ..installed.needs import library

if TYPE_CHECKING:
    import trimesh
    from numpy.typing import NDArray

    from .._core import Obstacle, Robot

    Array = NDArray[np.float64]
    Color = tuple[int, ...]

_MOST = 100_000  # triangles of a mesh
_GLOSS = 0.45  # roughness of varnish


class Look(NamedTuple):
    """Appearance of a link: a scene of trimesh in its frame."""

    link: str
    scene: trimesh.Scene


def looks(robot: Robot) -> tuple[list[Look], list[str]]:
    """Returns the appearance of the links, and sentences about files that are missing or broken.

    It consists of the visual shapes; of the collision meshes for links without visual shapes.
    """
    colors: dict[str, Color] = dict(zip(robot.all_link_names, cycle(map(rgb, LINKS)), strict=False))
    made, missing, notes = [], [], []
    for link, shape, placement, color in robot.visuals:
        if isinstance(shape, str) and not Path(shape).is_file():
            missing.append(shape)
            continue
        try:
            scene = _read(shape) if isinstance(shape, str) else _surface(shape)
            scene.apply_transform(placement)
            _paint(scene, colors[link] if color is None else tuple(np.round(255 * color).astype(int).tolist()))
        except Exception as error:  # parsers raise many kinds of errors
            notes.append(f"cannot read '{shape}': {error}")
            continue
        if not scene.is_empty:
            made.append(Look(link, scene))
    if missing:
        notes.append(f"{counted(len(missing), 'file')} of visual meshes not found, such as {missing[0]}")
    try:
        collision_meshes = robot.collision_meshes()
    except BeetleIkError as error:  # a file that no longer exists
        return made, [*notes, str(error)]
    seen = {look.link for look in made}
    for link, mesh in collision_meshes:
        if link not in seen:
            scene = _surface(mesh)
            _paint(scene, colors[link])
            made.append(Look(link, scene))
    return made, notes


def drawn_looks(robot: Robot, q: Array) -> list[Look]:
    """Returns the appearance of an arm without meshes. `q` (n,) is any configuration."""
    from trimesh import Scene, Trimesh

    scenes: dict[str, trimesh.Scene] = {}
    for solid in solids(robot, q):
        mesh = Trimesh(solid.vertices, solid.faces, vertex_normals=solid.normals, process=False)
        mesh.visual = _painted(rgb(solid.color), roughness=_GLOSS)
        scenes.setdefault(solid.link, Scene()).add_geometry(mesh)
    return [Look(link, scene) for link, scene in scenes.items()]


def _read(file: str) -> trimesh.Scene:
    """Returns the content of a mesh file, in metres."""
    scene: trimesh.Scene = library("trimesh", "trimesh", "the viewer", extra="view").load_scene(file)
    return scene if scene.units is None else scene.convert_units("meters")  # COLLADA states its units


def _surface(shape: Obstacle) -> trimesh.Scene:
    from trimesh import Scene, Trimesh

    return Scene(Trimesh(*soup(shape.triangles)))


def _paint(scene: trimesh.Scene, color: Color) -> None:
    """Colours meshes without a material, shows both sides of all meshes, and reduces large ones."""
    from trimesh import Trimesh
    from trimesh.visual import TextureVisuals
    from trimesh.visual.material import PBRMaterial, SimpleMaterial

    for name, mesh in list(scene.geometry.items()):
        if not isinstance(mesh, Trimesh):  # lines and points have no faces
            scene.delete_geometry(name)
            continue
        visual: Any = mesh.visual
        material = getattr(visual, "material", None)
        if not visual.defined:
            mesh.visual = painted = _painted(color)
            material = painted.material
        elif isinstance(material, SimpleMaterial):
            material = visual.material = material.to_pbr()
        if isinstance(material, PBRMaterial):
            material.doubleSided = True
        if len(mesh.faces) > _MOST:
            small = Trimesh(*soup(simplified(mesh.triangles, _MOST)))
            small.visual = TextureVisuals(material=material)
            scene.geometry[name] = small


def _painted(color: Color, roughness: float = 1.0) -> Any:
    """Returns a material of one colour for trimesh."""
    from trimesh.visual import TextureVisuals
    from trimesh.visual.material import PBRMaterial

    mode = "OPAQUE" if color[3:] in ((), (255,)) else "BLEND"
    shade = np.array(color[:3]) / 255.0
    linear = np.where(shade <= 0.04045, shade / 12.92, ((shade + 0.055) / 1.055) ** 2.4)  # colours of glTF are linear
    factor = [*np.round(255 * linear).astype(int).tolist(), *color[3:]]
    material = PBRMaterial(baseColorFactor=factor, metallicFactor=0.0, roughnessFactor=roughness, alphaMode=mode)
    return TextureVisuals(material=material)


def soup(triangles: Array) -> tuple[Array, NDArray[np.int64]]:
    """Returns vertices (3 t, 3) and faces (t, 3) of triangles (t, 3, 3)."""
    return triangles.reshape(-1, 3), np.arange(3 * len(triangles)).reshape(-1, 3)
