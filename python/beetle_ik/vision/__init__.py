"""Locates a planar arm in an image (extra `vision`, based on scikit-image).

The camera maps pixels to the plane of the arm; the guess starts the search:

    camera = bik.vision.Camera(pixels_per_metre=80.0, origin=(128.0, 128.0), link_width=0.2)
    found = bik.vision.locate_arm(image, robot, guess, camera=camera)
    if found.success:
        start = found.q
"""

from .camera import Camera
from .locate import ArmLocation, Sight, locate_arm
from .render import outline, render

__all__ = ["ArmLocation", "Camera", "Sight", "locate_arm", "outline", "render"]
