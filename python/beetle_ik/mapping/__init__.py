"""Maps of what an arm reaches: how they are made, asked, inverted, stored and drawn, and where a base best stands."""

from .base_placement import BasePlacement, best_base
from .compute import reachability
from .inverse_map import InverseReachabilityMap
from .reachability_map import ReachabilityMap

__all__ = ["BasePlacement", "InverseReachabilityMap", "ReachabilityMap", "best_base", "reachability"]
