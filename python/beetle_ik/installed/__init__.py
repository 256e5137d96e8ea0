"""Installed packages.

needs      imports an optional package, or says how to install it
versions   versions of this library and its dependencies
"""
