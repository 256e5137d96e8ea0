"""Reachability maps: computation, queries, inverse, storage and figures, and the best placement of a base."""

from .base_placement import BasePlacement, best_base
from .compute import reachability
from .inverse_map import InverseReachabilityMap
from .reachability_map import ReachabilityMap

__all__ = ["BasePlacement", "InverseReachabilityMap", "ReachabilityMap", "best_base", "reachability"]
