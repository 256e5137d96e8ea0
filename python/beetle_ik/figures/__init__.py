"""Drawings of robots, motions and obstacles.

style         palette and sizes of all figures
shapes        stick figures, bodies and obstacles in matplotlib
surface       shaded triangles in matplotlib
plan_figure   figure and animation of a planned motion
track_figure  figures of tracked paths
joints        joint values over time
frames        animation frames, apart from their figure
skeleton      the axes and rigid parts of a robot without meshes
solids        solids of revolution along that skeleton
sketch        small drawings as SVG, without matplotlib
notebook      robots and results as HTML, with these drawings

`beetle_ik.plot` has the public figures, `beetle_ik.viewing` the page in the browser.
"""
