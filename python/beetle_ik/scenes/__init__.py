"""Scenes of obstacles: the class, and the files and objects they come from.

scene       the class `Scene`
attached    objects that the robot carries
json_file   scenes as JSON
moveit      planning scenes of MoveIt: messages in YAML, and which of both formats a file has
rviz        planning scenes of MoveIt: the text of RViz
solids      primitive shapes of MoveIt
octomap     octomaps: files of OctoMap, and the data of messages
trimesh     meshes and scenes of trimesh
"""

from .scene import Scene, obstacles_for

__all__ = ["Scene", "obstacles_for"]
