"""Filters for the noisy targets of a `Tracker`: less noise, more delay."""

from ._core import LowPass, OneEuro

__all__ = ["LowPass", "OneEuro"]
