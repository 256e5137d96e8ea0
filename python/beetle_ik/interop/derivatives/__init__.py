"""Derivatives of the core's results, for many rows at once, as `interop.jax` and `interop.torch` use them.

rows           leading axes as rows of one call of the core
functions      the functions of the core that both call, with their shapes
checks         arguments of both
curvature      second derivative of the tip by the joints
following      derivative of a solution by its target, at limits and singularities too
nearest        distances and their gradients
"""
