"""Scenes of obstacles: the class, and the files and objects they come from.

scene       the class `Scene`
json_file   scenes as JSON
moveit      planning scenes of MoveIt
trimesh     meshes and scenes of trimesh
"""

from .scene import Scene

__all__ = ["Scene"]
