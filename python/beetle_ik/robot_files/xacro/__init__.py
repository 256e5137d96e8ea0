"""Xacro files, expanded by the Python package xacro. Reading one executes nothing, unless it is trusted.

expand        one file
copies        a copy of the package xacro for each call, whose functions can be replaced
guard         what replaces them: expressions, commands and includes are checked
expressions   the values of expressions, found without Python's `eval`
functions     the functions and constants that an expression may name
budget        a bound on the work and the memory that a file asks for
packages      `$(find package)`, and which files may be included

The functions of xacro that are replaced are listed in `guard`.
"""

from .expand import expand

__all__ = ["expand"]
