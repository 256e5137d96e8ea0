"""Expansion of xacro files by the Python package xacro. An untrusted file executes nothing.

expand        one file
copies        a copy of the package xacro for each call, whose functions can be replaced
guard         their replacements, which check expressions, commands and includes
expressions   the values of expressions, found without Python's `eval`
functions     the functions and constants that an expression may name
budget        a bound on the work and the memory that a file asks for
packages      `$(find package)`, and the files that may be included

The functions of xacro that are replaced are listed in `guard`.
"""

from .expand import expand

__all__ = ["expand"]
