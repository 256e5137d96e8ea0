"""Robots from descriptions that the core does not read itself: xacro, MuJoCo models, packages of descriptions.

xacro          xacro files, expanded
mjcf           MuJoCo models
mjcf_files     the files that a MuJoCo model names
own_files      what a file from anyone must not do, and which files belong to it
descriptions   robots of the packages robot_descriptions and example-robot-data
"""
