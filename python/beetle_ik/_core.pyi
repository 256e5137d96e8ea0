# Types of the native module. Documentation lives in its docstrings (Rust), not here.
#
# Letters in the shape comments: n = degrees of freedom, m = items of a batch, k = samples in time.
# SI units and radians throughout; results are read-only.

import os
from collections.abc import Callable, Iterable, Iterator, Sequence
from enum import IntEnum
from typing import Any, Literal, Never, Protocol, TypeAlias, final, overload, type_check_only

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import ArrayLike, NDArray
from typing_extensions import disjoint_base

__version__: str

_Array: TypeAlias = NDArray[np.float64]
_Transform: TypeAlias = _Homogeneous | _AsMatrix
_Pose: TypeAlias = ArrayLike | _Transform | Sequence[_Transform]  # a matrix, or what another library makes of it
_DerivativeFree: TypeAlias = BAS | BeeColony | BeetleSwarm | DifferentialEvolution | Firefly | Genetic | PSO | QPSO
_Single: TypeAlias = _DerivativeFree | APPS | BroydenBAS | JacobianTranspose | LevenbergMarquardt | NewtonRaphson
_Solver: TypeAlias = _Single | MultiStart
_LimitIn: TypeAlias = ArrayLike | Sinusoid | Callable[[float], ArrayLike]
_LimitOut: TypeAlias = float | _Array | Sinusoid | Callable[[float], ArrayLike] | None
_Motion: TypeAlias = Literal["pose", "position", "rotation"]
_Goals: TypeAlias = Goal | Iterable[Goal] | None
_Plant: TypeAlias = KinematicPlant | Callable[[_Array], ArrayLike] | _Mover
_Several: TypeAlias = slice | Sequence[int] | Sequence[bool] | NDArray[np.integer] | NDArray[np.bool_]  # as numpy picks
_Progress: TypeAlias = bool | Callable[[int, int], object] | None  # called with (done, total)

@type_check_only
class _Homogeneous(Protocol):  # Pinocchio's SE3
    @property
    def homogeneous(self) -> Any: ...

@type_check_only
class _AsMatrix(Protocol):  # scipy's RigidTransform and Rotation
    def as_matrix(self) -> Any: ...

@type_check_only
class _Mover(Protocol):
    def move(self, q: _Array, /) -> ArrayLike: ...  # (n,) -> (3,)

@type_check_only
class _Outcome:  # of every call that searches
    @property
    def success(self) -> bool: ...
    @property
    def status(self) -> Status: ...
    @property
    def message(self) -> str: ...
    @property
    def evaluations(self) -> int: ...
    @property
    def elapsed(self) -> float: ...  # s
    @property
    def limits(self) -> Limits: ...  # those in force

# --- errors -------------------------------------------------------------------------------------

class BeetleIkError(Exception): ...
class InvalidInputError(BeetleIkError, ValueError): ...
class UnknownNameError(BeetleIkError, LookupError): ...
class UrdfError(InvalidInputError): ...
class LimitError(InvalidInputError): ...
class UnsupportedLimit(LimitError): ...
class InfeasibleError(InvalidInputError): ...

# --- robots -------------------------------------------------------------------------------------

@final
class Robot:
    def __new__(cls, *_arguments: Never, **_options: Never) -> Robot: ...  # raises: use one of the makers below
    @staticmethod
    def from_urdf(path_or_xml: str | os.PathLike[str], *, base: str | None = None, tip: str | None = None) -> Robot: ...
    @staticmethod
    def from_dh(
        *,
        a: ArrayLike,
        alpha: ArrayLike,
        d: ArrayLike,
        theta: ArrayLike | None = None,
        kinds: list[str] | None = None,
        convention: Literal["modified", "standard"] = "modified",
        lower: ArrayLike | None = None,
        upper: ArrayLike | None = None,
        velocity: ArrayLike | None = None,
        base: _Pose | None = None,
        tool: _Pose | None = None,
        name: str | None = None,
    ) -> Robot: ...
    @staticmethod
    def planar(
        lengths: ArrayLike,
        *,
        lower: ArrayLike | None = None,
        upper: ArrayLike | None = None,
        velocity: ArrayLike | None = None,
    ) -> Robot: ...
    @staticmethod
    def named(name: str) -> Robot: ...
    @staticmethod
    def names() -> list[str]: ...
    @property
    def name(self) -> str: ...
    @property
    def dof(self) -> int: ...
    @property
    def joint_names(self) -> list[str]: ...
    @property
    def joint_kinds(self) -> list[str]: ...  # "revolute", "continuous" or "prismatic"
    @property
    def link_names(self) -> list[str]: ...  # along the chain, base first, tip last
    @property
    def lower(self) -> _Array: ...  # (n,), -inf where there is no limit
    @property
    def upper(self) -> _Array: ...  # (n,), inf where there is no limit
    @property
    def velocity_limit(self) -> _Array: ...  # (n,), inf where unknown
    @property
    def limits(self) -> Limits: ...
    def with_tool(self, tool: _Pose) -> Robot: ...
    def with_base(self, base: _Pose) -> Robot: ...
    def with_limits(
        self, *, lower: ArrayLike | None = None, upper: ArrayLike | None = None, velocity: ArrayLike | None = None
    ) -> Robot: ...
    @property
    def capsules(self) -> list[tuple[str, _Array, _Array, float]]: ...  # link, a (3,), b (3,), radius in m
    def with_capsules(
        self, capsules: list[tuple[str, ArrayLike, ArrayLike, float]] | None = None, *, radius: float | None = None
    ) -> Robot: ...
    def with_errors(self, *, length: float = 0.0, angle: float = 0.0, seed: int = 0) -> Robot: ...  # up to, m and rad
    # For interop. Elements: ("fixed", pose), ("moving", joint, turns, axis, scale, offset) or ("link", name).
    def _chain(self) -> tuple[_Array, list[tuple[Any, ...]], _Array]: ...  # base, elements, tool
    @staticmethod
    def _from_chain(
        name: str,
        base: str,
        joints: Sequence[tuple[str, str, float, float, float]],  # name, kind, lower, upper, velocity
        elements: Sequence[tuple[object, ...]],
    ) -> Robot: ...
    def fk(self, q: ArrayLike) -> _Array: ...  # (n,) -> (4, 4); (m, n) -> (m, 4, 4)
    def clip(self, q: ArrayLike) -> _Array: ...  # (n,) or (m, n)
    def link_poses(self, q: ArrayLike) -> _Array: ...  # (links, 4, 4), in the order of link_names
    def jacobian(self, q: ArrayLike) -> _Array: ...  # (n,) -> (6, n); (m, n) -> (m, 6, n)
    def random_configurations(self, m: int, seed: int = 0) -> _Array: ...  # (m, n)
    def manipulability(self, q: ArrayLike, *, motion: _Motion = "pose") -> Any: ...  # (n,) -> float; (m, n) -> (m,)
    def manipulability_gradient(self, q: ArrayLike, *, motion: _Motion = "pose") -> _Array: ...  # (n,)
    def link_manipulability(self, q: ArrayLike, *, motion: _Motion = "position") -> _Array: ...  # (links,)
    def velocity_ellipsoid(self, q: ArrayLike, *, motion: _Motion = "position") -> VelocityEllipsoid: ...

@final
class VelocityEllipsoid:
    @property
    def lengths(self) -> _Array: ...  # (directions,), longest first
    @property
    def axes(self) -> _Array: ...  # (directions, 6): linear, then angular part
    @property
    def index(self) -> float: ...
    @property
    def condition(self) -> float: ...
    @property
    def isotropy(self) -> float: ...

def pose(
    position: ArrayLike,
    *,
    xyzw: ArrayLike | None = None,
    wxyz: ArrayLike | None = None,
    rpy: ArrayLike | None = None,
    rotvec: ArrayLike | None = None,
    matrix: _Pose | None = None,
) -> _Array: ...

# --- limits -------------------------------------------------------------------------------------

@final
class Sinusoid:
    def __new__(
        cls, *, mean: ArrayLike, amplitude: ArrayLike, angular_frequency: ArrayLike, phase: ArrayLike | None = None
    ) -> Sinusoid: ...
    @property
    def mean(self) -> Any: ...  # what was given: a float or (n,)
    @property
    def amplitude(self) -> Any: ...
    @property
    def angular_frequency(self) -> Any: ...  # rad/s
    @property
    def phase(self) -> Any: ...
    def __getnewargs_ex__(self) -> tuple[tuple[Any, ...], dict[str, Any]]: ...

@final
class Limits:
    def __new__(
        cls,
        *,
        lower: _LimitIn | None = None,
        upper: _LimitIn | None = None,
        velocity: _LimitIn | None = None,
        acceleration: _LimitIn | None = None,
        jerk: _LimitIn | None = None,
    ) -> Limits: ...
    @property
    def lower(self) -> _LimitOut: ...
    @property
    def upper(self) -> _LimitOut: ...
    @property
    def velocity(self) -> _LimitOut: ...
    @property
    def acceleration(self) -> _LimitOut: ...
    @property
    def jerk(self) -> _LimitOut: ...
    def __getnewargs_ex__(self) -> tuple[tuple[Any, ...], dict[str, Any]]: ...

# --- solvers ------------------------------------------------------------------------------------

class Status(IntEnum):
    SOLVED = 0
    IMPROVED = 1
    CAPPED = 2
    STALLED = 3
    BUDGET_SPENT = 4
    TIME_UP = 5
    INTERRUPTED = 6
    LOST = 7
    INVALID = 8
    OUT_OF_REACH = 9
    PLANT_FAILED = 10
    BELOW_THRESHOLD = 11
    OUTSIDE_LIMITS = 12
    HELD_IN_REGION = 13

@final
class APPS:
    def __new__(
        cls,
        *,
        learning_rate: float | Literal["auto"] = "auto",
        step_limit: float = 0.2,  # rad or m
        error_threshold: float | None = None,
    ) -> APPS: ...
    @staticmethod
    def paper() -> APPS: ...
    @property
    def learning_rate(self) -> float | Literal["auto"]: ...
    @property
    def step_limit(self) -> float: ...
    @property
    def error_threshold(self) -> float | None: ...
    def __getnewargs_ex__(self) -> tuple[tuple[Any, ...], dict[str, Any]]: ...

@final
class BAS:
    def __new__(
        cls,
        *,
        variant: Literal["star", "chain", "greedy"] = "star",
        c1: float | None = None,  # None: what suits the variant; likewise c2 and explorations
        c2: float | None = None,
        explorations: int | None = None,
        max_passes: int = 200,
    ) -> BAS: ...
    @property
    def variant(self) -> str: ...
    @property
    def c1(self) -> float: ...
    @property
    def c2(self) -> float: ...
    @property
    def explorations(self) -> int: ...
    @property
    def max_passes(self) -> int: ...
    def __getnewargs_ex__(self) -> tuple[tuple[Any, ...], dict[str, Any]]: ...

@final
class BroydenBAS:
    def __new__(
        cls, *, antenna_length: float = ..., max_evaluations_per_step: int = 20, sensor_delay: int = 0
    ) -> BroydenBAS: ...
    @property
    def antenna_length(self) -> float: ...  # rad, m
    @property
    def max_evaluations_per_step(self) -> int: ...
    @property
    def sensor_delay(self) -> int: ...  # in measurements
    def session(
        self,
        start: ArrayLike,
        *,
        dt: float,
        limits: Limits | None = None,
        position_tolerance: float = 1e-9,
        seed: int = 0,
    ) -> ControlSession: ...
    def __getnewargs_ex__(self) -> tuple[tuple[Any, ...], dict[str, Any]]: ...

@final
class JacobianTranspose:
    def __new__(cls, *, step_size: float | Literal["auto"] = "auto") -> JacobianTranspose: ...
    @property
    def step_size(self) -> float | Literal["auto"]: ...
    def __getnewargs_ex__(self) -> tuple[tuple[Any, ...], dict[str, Any]]: ...

@final
class BeeColony:
    def __new__(
        cls,
        *,
        population: int = ...,
        limit: int | None = ...,
        max_generations: int | None = ...,
        stall_generations: int | None = ...,
    ) -> BeeColony: ...
    @property
    def population(self) -> int: ...
    @property
    def limit(self) -> int | None: ...
    @property
    def max_generations(self) -> int | None: ...
    @property
    def stall_generations(self) -> int | None: ...
    def __getnewargs_ex__(self) -> tuple[tuple[Any, ...], dict[str, Any]]: ...

@final
class BeetleSwarm:
    def __new__(
        cls,
        *,
        population: int = ...,
        inertia: float = ...,
        c1: float = ...,
        c2: float = ...,
        velocity_limit: float = ...,
        velocity_share: float = ...,
        step: float = ...,
        step_decay: float = ...,
        step_over_antennae: float = ...,
        direction: Literal["printed", "downhill"] = ...,
        max_generations: int | None = ...,
        stall_generations: int | None = ...,
    ) -> BeetleSwarm: ...
    @property
    def population(self) -> int: ...
    @property
    def inertia(self) -> float: ...
    @property
    def c1(self) -> float: ...
    @property
    def c2(self) -> float: ...
    @property
    def velocity_limit(self) -> float: ...
    @property
    def velocity_share(self) -> float: ...
    @property
    def step(self) -> float: ...
    @property
    def step_decay(self) -> float: ...
    @property
    def step_over_antennae(self) -> float: ...
    @property
    def direction(self) -> str: ...
    @property
    def max_generations(self) -> int | None: ...
    @property
    def stall_generations(self) -> int | None: ...
    def __getnewargs_ex__(self) -> tuple[tuple[Any, ...], dict[str, Any]]: ...

@final
class DifferentialEvolution:
    def __new__(
        cls,
        *,
        population: int = ...,
        weight: float = ...,
        crossover_rate: float = ...,
        update: Literal["generation", "immediate"] = ...,
        max_generations: int | None = ...,
        stall_generations: int | None = ...,
    ) -> DifferentialEvolution: ...
    @property
    def population(self) -> int: ...
    @property
    def weight(self) -> float: ...
    @property
    def crossover_rate(self) -> float: ...
    @property
    def update(self) -> str: ...
    @property
    def max_generations(self) -> int | None: ...
    @property
    def stall_generations(self) -> int | None: ...
    def __getnewargs_ex__(self) -> tuple[tuple[Any, ...], dict[str, Any]]: ...

@final
class Firefly:
    def __new__(
        cls,
        *,
        population: int = ...,
        attractiveness: float = ...,
        absorption: float = ...,
        randomness: float = ...,
        randomness_decay: float = ...,
        max_generations: int | None = ...,
        stall_generations: int | None = ...,
    ) -> Firefly: ...
    @property
    def population(self) -> int: ...
    @property
    def attractiveness(self) -> float: ...
    @property
    def absorption(self) -> float: ...
    @property
    def randomness(self) -> float: ...
    @property
    def randomness_decay(self) -> float: ...
    @property
    def max_generations(self) -> int | None: ...
    @property
    def stall_generations(self) -> int | None: ...
    def __getnewargs_ex__(self) -> tuple[tuple[Any, ...], dict[str, Any]]: ...

@final
class Genetic:
    def __new__(
        cls,
        *,
        population: int = ...,
        elite_share: float = ...,
        crossover_share: float = ...,
        tournament: int = ...,
        mutation_rate: float = ...,
        mutation_scale: float = ...,
        mutation_decay: float = ...,
        max_generations: int | None = ...,
        stall_generations: int | None = ...,
    ) -> Genetic: ...
    @property
    def population(self) -> int: ...
    @property
    def elite_share(self) -> float: ...
    @property
    def crossover_share(self) -> float: ...
    @property
    def tournament(self) -> int: ...
    @property
    def mutation_rate(self) -> float: ...
    @property
    def mutation_scale(self) -> float: ...
    @property
    def mutation_decay(self) -> float: ...
    @property
    def max_generations(self) -> int | None: ...
    @property
    def stall_generations(self) -> int | None: ...
    def __getnewargs_ex__(self) -> tuple[tuple[Any, ...], dict[str, Any]]: ...

@final
class PSO:
    def __new__(
        cls,
        *,
        population: int = ...,
        form: Literal["constriction", "inertia"] = "constriction",
        inertia: float | None = None,  # 0.729 with form "inertia"
        c1: float | None = None,
        c2: float | None = None,
        velocity_limit: float = ...,
        accept: Literal["always", "improving"] = "always",
        walls: Literal["absorbing", "random"] = "absorbing",
        max_generations: int | None = ...,
        stall_generations: int | None = ...,
    ) -> PSO: ...
    @property
    def population(self) -> int: ...
    @property
    def form(self) -> str: ...
    @property
    def inertia(self) -> float | None: ...
    @property
    def c1(self) -> float: ...
    @property
    def c2(self) -> float: ...
    @property
    def velocity_limit(self) -> float: ...
    @property
    def accept(self) -> str: ...
    @property
    def walls(self) -> str: ...
    @property
    def max_generations(self) -> int | None: ...
    @property
    def stall_generations(self) -> int | None: ...
    def __getnewargs_ex__(self) -> tuple[tuple[Any, ...], dict[str, Any]]: ...

@final
class QPSO:
    def __new__(
        cls,
        *,
        population: int = ...,
        expansion: float = ...,
        max_generations: int | None = ...,
        stall_generations: int | None = ...,
    ) -> QPSO: ...
    @property
    def population(self) -> int: ...
    @property
    def expansion(self) -> float: ...
    @property
    def max_generations(self) -> int | None: ...
    @property
    def stall_generations(self) -> int | None: ...
    def __getnewargs_ex__(self) -> tuple[tuple[Any, ...], dict[str, Any]]: ...

@final
class LevenbergMarquardt:
    def __new__(cls, *, initial_damping: float = ...) -> LevenbergMarquardt: ...
    @property
    def initial_damping(self) -> float: ...
    def __getnewargs_ex__(self) -> tuple[tuple[Any, ...], dict[str, Any]]: ...

@final
class MultiStart:
    def __new__(cls, solver: _Single, *, max_starts: int | None = None) -> MultiStart: ...
    @property
    def solver(self) -> _Single: ...
    @property
    def max_starts(self) -> int | None: ...
    def __getnewargs_ex__(self) -> tuple[tuple[Any, ...], dict[str, Any]]: ...

@final
class NewtonRaphson:
    def __new__(cls, *, step_fraction: float = ...) -> NewtonRaphson: ...
    @property
    def step_fraction(self) -> float: ...
    def __getnewargs_ex__(self) -> tuple[tuple[Any, ...], dict[str, Any]]: ...

@final
class WeightedPseudoInverse:
    def __new__(
        cls,
        *,
        gain: float | None = None,  # 1/s
        integrator: Literal["euler", "rk4"] = "euler",
        weights: ArrayLike | None = None,  # (n,)
        posture: Trajectory | None = None,
        posture_gain: float = ...,  # 1/s
        damping: float = 0.0,
    ) -> WeightedPseudoInverse: ...
    @property
    def gain(self) -> float | None: ...
    @property
    def integrator(self) -> str: ...
    @property
    def weights(self) -> _Array | None: ...
    @property
    def posture(self) -> Trajectory | None: ...
    @property
    def posture_gain(self) -> float: ...
    @property
    def damping(self) -> float: ...
    def __getnewargs_ex__(self) -> tuple[tuple[Any, ...], dict[str, Any]]: ...

@final
class Stop:
    def __new__(
        cls,
        *,
        max_evaluations: int | None = None,
        max_iterations: int | None = None,
        max_time: float | None = None,
        value_below: float | None = None,
    ) -> Stop: ...
    @property
    def max_evaluations(self) -> int | None: ...
    @property
    def max_iterations(self) -> int | None: ...
    @property
    def max_time(self) -> float | None: ...  # s
    @property
    def value_below(self) -> float | None: ...
    def __getnewargs_ex__(self) -> tuple[tuple[Any, ...], dict[str, Any]]: ...

# --- tasks and goals ----------------------------------------------------------------------------

@disjoint_base
class Task:
    @property
    def weights(self) -> _Array | None: ...
    @property
    def tolerance(self) -> _Array | None: ...  # m, rad
    @property
    def tool(self) -> _Array | None: ...  # (4, 4)
    @property
    def region(self) -> _Array | None: ...  # (2, 3) m
    def __getnewargs_ex__(self) -> tuple[tuple[Any, ...], dict[str, Any]]: ...

@final
class Pose(Task):
    def __new__(
        cls,
        *,
        weights: ArrayLike | None = None,
        tolerance: ArrayLike | None = None,
        tool: _Pose | None = None,
        region: ArrayLike | None = None,
    ) -> Pose: ...

@final
class Position(Task):
    def __new__(
        cls,
        *,
        weights: ArrayLike | None = None,
        tolerance: ArrayLike | None = None,
        tool: _Pose | None = None,
        region: ArrayLike | None = None,
    ) -> Position: ...

@final
class Orientation(Task):
    def __new__(
        cls,
        *,
        weights: ArrayLike | None = None,
        tolerance: ArrayLike | None = None,
        tool: _Pose | None = None,
        region: ArrayLike | None = None,
    ) -> Orientation: ...

@final
class Pointing(Task):
    def __new__(
        cls,
        *,
        axis: ArrayLike | None = None,  # None: (0, 0, 1)
        weights: ArrayLike | None = None,
        tolerance: ArrayLike | None = None,
        tool: _Pose | None = None,
        region: ArrayLike | None = None,
    ) -> Pointing: ...
    @property
    def axis(self) -> _Array: ...  # (3,)

@disjoint_base
class Goal:
    @property
    def weight(self) -> float: ...
    def __getnewargs_ex__(self) -> tuple[tuple[Any, ...], dict[str, Any]]: ...

@final
class Posture(Goal):
    def __new__(cls, posture: ArrayLike, *, weight: float = 1.0) -> Posture: ...
    @property
    def posture(self) -> _Array: ...  # (n,)

@final
class Centring(Goal):
    def __new__(cls, *, weight: float = 1.0) -> Centring: ...

@final
class Manipulability(Goal):
    def __new__(cls, *, motion: _Motion = "pose", weight: float = 1.0) -> Manipulability: ...

@final
class LinkManipulability(Goal):
    def __new__(cls, *, motion: _Motion = "position", weight: float = 1.0) -> LinkManipulability: ...

# --- inverse kinematics -------------------------------------------------------------------------

def solve(
    robot: Robot,
    target: _Pose,  # (4, 4) pose or (3,) position
    *,
    task: Task | None = None,
    start: ArrayLike | None = None,  # (n,)
    solver: _Solver | None = None,
    position_tolerance: float = 1e-6,
    rotation_tolerance: float = 1e-6,
    goals: _Goals = None,
    prefer: Literal["any", "nearest", "best"] = "any",
    limits: Limits | None = None,
    stop: Stop | None = None,
    seed: int = 0,
) -> Solution: ...

@final
class Solution(_Outcome):
    @property
    def q(self) -> _Array: ...  # (n,)
    @property
    def position_error(self) -> float: ...  # m
    @property
    def rotation_error(self) -> float: ...  # rad; NaN where no orientation was asked
    @property
    def iterations(self) -> int: ...
    @property
    def restarts(self) -> int: ...

def solve_all(
    robot: Robot,
    target: _Pose,  # (4, 4) pose or (3,) position
    *,
    start: ArrayLike | None = None,  # (n,)
    limit: int = 16,
    separation: float = 0.1,  # rad, m
    task: Task | None = None,
    solver: _Solver | None = None,
    position_tolerance: float = 1e-6,
    rotation_tolerance: float = 1e-6,
    limits: Limits | None = None,
    stop: Stop | None = None,  # budgets of the whole search
    seed: int = 0,
) -> SolutionSet: ...

@final
class SolutionSet(_Outcome):
    @property
    def q(self) -> _Array: ...  # (k, n)
    @property
    def miss(self) -> Solution | None: ...
    def __len__(self) -> int: ...
    @overload
    def __getitem__(self, index: int | np.integer, /) -> Solution: ...
    @overload
    def __getitem__(self, index: _Several, /) -> list[Solution]: ...
    def __iter__(self) -> Iterator[Solution]: ...

def solve_batch(
    robot: Robot,
    targets: _Pose,  # (m, 4, 4) poses or (m, 3) positions
    *,
    starts: ArrayLike | None = None,  # (m, n), or (n,) for all
    threads: int | None = None,  # None: one per core
    on_invalid: Literal["raise", "skip"] = "raise",
    progress: _Progress = None,
    task: Task | None = None,
    solver: _Solver | None = None,
    position_tolerance: float = 1e-6,
    rotation_tolerance: float = 1e-6,
    goals: _Goals = None,
    prefer: Literal["any", "nearest", "best"] = "any",
    limits: Limits | None = None,
    stop: Stop | None = None,  # budgets of each target
    seed: int = 0,
) -> BatchSolution: ...

@final
class BatchSolution:
    @property
    def q(self) -> _Array: ...  # (m, n); NaN where INVALID
    @property
    def success(self) -> NDArray[np.bool_]: ...  # (m,)
    @property
    def status(self) -> NDArray[np.uint8]: ...  # (m,), values of Status
    @property
    def message(self) -> str: ...
    @property
    def position_error(self) -> _Array: ...  # (m,), m
    @property
    def rotation_error(self) -> _Array: ...  # (m,), rad; NaN where no orientation was asked
    @property
    def iterations(self) -> NDArray[np.int64]: ...  # (m,)
    @property
    def restarts(self) -> NDArray[np.int64]: ...  # (m,)
    @property
    def evaluations(self) -> NDArray[np.int64]: ...  # (m,)
    @property
    def elapsed(self) -> float: ...  # s, in all
    @property
    def limits(self) -> Limits: ...  # those in force
    def __len__(self) -> int: ...
    @overload
    def __getitem__(self, index: int | np.integer, /) -> Solution: ...
    @overload
    def __getitem__(self, index: _Several, /) -> BatchSolution: ...
    def __iter__(self) -> Iterator[Solution]: ...

# --- minimisation of any function ----------------------------------------------------------------

def minimize(
    function: Callable[[_Array], Any],  # (n,) -> a number; vectorized: (m, n) -> (m,)
    lower: ArrayLike,
    upper: ArrayLike,
    *,
    solver: _DerivativeFree | MultiStart,
    start: ArrayLike | None = None,  # (n,)
    stop: Stop | None = None,
    seed: int = 0,
    vectorized: bool = False,
    progress: _Progress = None,
) -> Minimum: ...

@final
class Minimum(_Outcome):
    @property
    def x(self) -> _Array: ...  # (n,)
    @property
    def value(self) -> float: ...
    @property
    def history(self) -> _Array: ...  # (k, 2): evaluations, best value
    @property
    def iterations(self) -> int: ...
    @property
    def restarts(self) -> int: ...

# --- postures -----------------------------------------------------------------------------------

@final
class CircleSwarm:
    def __new__(
        cls,
        *,
        population: int = 5,
        generations: int = 10,
        c1: float = 2.05,
        c2: float = 2.05,
        velocity_limit: float = 0.2,  # m a generation
        signed: bool = False,
    ) -> CircleSwarm: ...
    @property
    def population(self) -> int: ...
    @property
    def generations(self) -> int: ...
    @property
    def c1(self) -> float: ...
    @property
    def c2(self) -> float: ...
    @property
    def velocity_limit(self) -> float: ...
    @property
    def signed(self) -> bool: ...
    def __getnewargs_ex__(self) -> tuple[tuple[Any, ...], dict[str, Any]]: ...

def planar_posture(
    robot: Robot,
    target: ArrayLike,  # (3,)
    *,
    measure: Literal["tip", "overall"] = "tip",
    region: ArrayLike | None = None,  # (2, 2): least and largest x, y (m)
    swarm: CircleSwarm | None = None,
    seed: int = 0,
) -> PlanarPosture: ...

@final
class PlanarPosture(_Outcome):
    @property
    def q(self) -> _Array: ...  # (n,)
    @property
    def index(self) -> float: ...
    @property
    def history(self) -> _Array: ...  # (generations,), or empty
    @property
    def position_error(self) -> float: ...  # m

# --- reference paths (public as beetle_ik.paths) ------------------------------------------------

@final
class Path:
    @property
    def duration(self) -> float: ...  # s
    def position(self, t: ArrayLike) -> _Array: ...  # number -> (3,); (k,) -> (k, 3)
    def velocity(self, t: ArrayLike) -> _Array: ...  # number -> (3,); (k,) -> (k, 3)
    def pose(self, t: ArrayLike) -> _Array: ...  # number -> (4, 4); (k,) -> (k, 4, 4)
    def sample(self, dt: float) -> tuple[_Array, _Array]: ...  # time (k,), positions (k, 3)
    def with_orientation(self, orientation: _Pose | Callable[[float], _Pose]) -> Path: ...  # (3, 3)

def circle(
    center: ArrayLike, diameter: float, duration: float, *, a: ArrayLike = (1, 0, 0), b: ArrayLike = (0, 1, 0)
) -> Path: ...
def letter_m(
    center: ArrayLike,
    duration: float,
    *,
    width: float,
    height: float,
    a: ArrayLike = (0, 1, 0),
    b: ArrayLike = (0, 0, 1),
) -> Path: ...
def hypotrochoid(
    center: ArrayLike,
    duration: float,
    *,
    outer_radius: float,
    inner_radius: float,
    distance: float,
    a: ArrayLike = (0, 1, 0),
    b: ArrayLike = (0, 0, 1),
) -> Path: ...
def pentagram(
    center: ArrayLike, duration: float, *, radius: float, a: ArrayLike = (1, 0, 0), b: ArrayLike = (0, 1, 0)
) -> Path: ...
def rose(
    center: ArrayLike,
    duration: float,
    *,
    radius: float,
    k: int,
    a: ArrayLike = (1, 0, 0),
    b: ArrayLike = (0, 1, 0),
) -> Path: ...
def polyline(points: ArrayLike, duration: float) -> Path: ...
def from_samples(time: ArrayLike, positions_or_poses: _Pose) -> Path: ...  # (k,) and (k, 3) or (k, 4, 4)
def from_function(function: Callable[[float], ArrayLike], duration: float) -> Path: ...

# --- tracking -----------------------------------------------------------------------------------

def track(
    robot: Robot,
    path: Path,
    start: ArrayLike | None = None,  # None solves for the path's first point
    *,
    dt: float,
    task: Task | None = None,
    solver: _Solver | WeightedPseudoInverse | None = None,
    limits: Limits | None = None,
    goals: _Goals = None,
    position_tolerance: float = 1e-6,
    rotation_tolerance: float = 1e-6,
    seed: int = 0,
    limit_at: Literal["interval", "start"] = "interval",
    progress: _Progress = None,
) -> TrackResult: ...

@final
class TrackResult(_Outcome):
    @property
    def time(self) -> _Array: ...  # (k,)
    @property
    def q(self) -> _Array: ...  # (k, n)
    @property
    def qd(self) -> _Array: ...  # (k, n), row 0 zero
    @property
    def velocity_limit(self) -> _Array: ...  # (k, n): what each qd was held against; row 0 NaN, inf where none
    @property
    def position(self) -> _Array: ...  # (k, 3)
    @property
    def reference(self) -> _Array: ...  # (k, 3)
    @property
    def position_error(self) -> _Array: ...  # (k,), m
    @property
    def rotation_error(self) -> _Array: ...  # (k,), rad; NaN where no orientation was asked
    @property
    def position_tolerance(self) -> float: ...  # m, as asked
    @property
    def rotation_tolerance(self) -> float: ...  # rad, as asked
    @property
    def step_status(self) -> NDArray[np.uint8]: ...  # (k,), values of Status
    @property
    def step_evaluations(self) -> NDArray[np.int64]: ...  # (k,)
    @property
    def step_iterations(self) -> NDArray[np.int64]: ...  # (k,): passes of BAS, steps of Levenberg-Marquardt
    @property
    def max_violation(self) -> float: ...  # rad or m; 0 within rounding
    @property
    def limit_margin(self) -> float: ...  # rad/s: smallest velocity_limit - |qd| of all; inf where no limit
    @property
    def robot(self) -> Robot: ...
    @property
    def trajectory(self) -> Trajectory: ...  # straight lines between the ticks: its velocities are exactly qd
    def plot(self) -> Figure: ...
    def __len__(self) -> int: ...

@final
class Tracker:
    def __new__(
        cls,
        robot: Robot,
        start: ArrayLike,
        *,
        dt: float,
        task: Task | None = None,
        solver: _Solver | WeightedPseudoInverse | None = None,
        limits: Limits | None = None,
        goals: _Goals = None,
        position_tolerance: float = 1e-6,
        rotation_tolerance: float = 1e-6,
        seed: int = 0,
        limit_at: Literal["interval", "start"] = "interval",
    ) -> Tracker: ...
    def step(self, target: _Pose, *, velocity: ArrayLike | None = None) -> Step: ...  # (4, 4) or (3,); m/s
    def reset(self, q: ArrayLike) -> None: ...
    @property
    def q(self) -> _Array: ...  # (n,)
    @property
    def time(self) -> float: ...  # s
    @property
    def dt(self) -> float: ...  # s
    @property
    def robot(self) -> Robot: ...
    @property
    def limits(self) -> Limits: ...  # those in force

@final
class Step(_Outcome):
    @property
    def q(self) -> _Array: ...  # (n,): what to command
    @property
    def qd(self) -> _Array: ...  # (n,): the velocity that leads there
    @property
    def position_error(self) -> float: ...  # m
    @property
    def rotation_error(self) -> float: ...  # rad; NaN where no orientation was asked
    @property
    def inside_limits(self) -> bool: ...  # False: a joint cannot be within its position limits yet

# --- obstacles ----------------------------------------------------------------------------------

@disjoint_base
class Obstacle:
    @property
    def triangles(self) -> _Array: ...  # (t, 3, 3) m, for drawing
    def __getnewargs_ex__(self) -> tuple[tuple[Any, ...], dict[str, Any]]: ...

@final
class Sphere(Obstacle):
    def __new__(cls, center: ArrayLike, radius: float) -> Sphere: ...
    @property
    def center(self) -> _Array: ...
    @property
    def radius(self) -> float: ...

@final
class Box(Obstacle):
    def __new__(cls, center: ArrayLike, size: ArrayLike, rotation: _Pose | None = None) -> Box: ...
    @property
    def center(self) -> _Array: ...
    @property
    def size(self) -> _Array: ...
    @property
    def rotation(self) -> _Array: ...  # (3, 3)

@final
class Capsule(Obstacle):
    def __new__(cls, a: ArrayLike, b: ArrayLike, radius: float) -> Capsule: ...
    @property
    def a(self) -> _Array: ...
    @property
    def b(self) -> _Array: ...
    @property
    def radius(self) -> float: ...

@final
class Ellipsoid(Obstacle):
    def __new__(cls, center: ArrayLike, semi_axes: ArrayLike, rotation: _Pose | None = None) -> Ellipsoid: ...
    @property
    def center(self) -> _Array: ...
    @property
    def semi_axes(self) -> _Array: ...
    @property
    def rotation(self) -> _Array: ...  # (3, 3)

@final
class Ellipse(Obstacle):
    def __new__(cls, center: ArrayLike, semi_axes: ArrayLike, angle: float = 0.0) -> Ellipse: ...
    @property
    def center(self) -> _Array: ...  # (2,)
    @property
    def semi_axes(self) -> _Array: ...  # (2,)
    @property
    def angle(self) -> float: ...

@final
class ConvexMesh(Obstacle):
    def __new__(cls, points: ArrayLike) -> ConvexMesh: ...  # (k, 3)
    @property
    def points(self) -> _Array: ...

# A number for q (n,), (m,) for q (m, n).
def clearance(robot: Robot, q: ArrayLike, obstacles: Iterable[Obstacle] | None = None) -> Any: ...

# --- planning -----------------------------------------------------------------------------------

def plan_point_to_point(
    robot: Robot,
    start: _Pose | None = None,  # (4, 4) pose or (3,) position
    end: _Pose | None = None,
    *,
    start_q: ArrayLike | None = None,  # (n,), instead of start
    end_q: ArrayLike | None = None,
    limits: Limits | None = None,
    method: Literal["minmax", "tpbso"] = "minmax",
    objective: Literal["time", "joint_travel", "tip_travel"] = "time",
    obstacles: Iterable[Obstacle] | None = None,
    margin: float | None = None,  # m
    elbows: Sequence[int] | None = None,
    solver: _DerivativeFree | MultiStart | None = None,
    stop: Stop | None = None,
    seed: int = 0,
    progress: _Progress = None,
) -> Plan: ...
def time_optimal(
    waypoints_q: ArrayLike,  # (k, n)
    limits: Limits,
    *,
    knots: ArrayLike | None = None,  # (k,), None: uniform in [0, 1]
    spline: Literal["natural", "not-a-knot", "clamped", "polyline"] = "natural",
    blend: float | None = None,
    gridpoints: int | None = None,
    start_speed: float = 0.0,
    end_speed: float = 0.0,
    joint_names: list[str] | None = None,
) -> Trajectory: ...
def plan_along_path(
    robot: Robot,
    path: Path | _Pose,  # or (k, 3) points or (k, 4, 4) poses
    *,
    start_q: ArrayLike | None = None,  # (n,)
    limits: Limits | None = None,
    method: Literal["timed", "tpbso"] = "timed",
    objective: Literal["time", "joint_travel"] = "time",
    elbow: int | None = None,
    accuracy: float | None = None,  # m
    solver: _DerivativeFree | MultiStart | None = None,
    stop: Stop | None = None,
    seed: int = 0,
    progress: _Progress = None,
) -> Plan: ...

@final
class Plan(_Outcome):
    @property
    def trajectory(self) -> Trajectory: ...
    @property
    def objective(self) -> str: ...
    @property
    def cost(self) -> float: ...  # of the objective on the trajectory: s, rad or m
    @property
    def history(self) -> _Array: ...  # (h, 2): evaluations, lowest cost from then on
    @property
    def clearance(self) -> float: ...  # m; NaN without obstacles
    @property
    def violations(self) -> list[Violation]: ...
    @property
    def accuracy(self) -> float: ...  # m, from the points of the path; NaN from end to end
    @property
    def redundancy(self) -> _Array: ...  # (points, links, 3): orientation chosen, lowest, highest (rad)
    @property
    def reference(self) -> _Array | None: ...  # (k, 3): the path asked for
    @property
    def robot(self) -> Robot: ...
    @property
    def obstacles(self) -> tuple[Obstacle, ...]: ...
    def plot(self) -> Figure: ...

@final
class Violation:
    @property
    def what(self) -> str: ...
    @property
    def value(self) -> float: ...
    @property
    def bound(self) -> float: ...
    @property
    def unit(self) -> str: ...

# --- tracking without a model -------------------------------------------------------------------

def track_model_free(
    plant: _Plant,
    path: Path,
    start: ArrayLike,  # (n,)
    *,
    dt: float,
    controller: BroydenBAS | ZNNBAS | None = None,  # None: BroydenBAS()
    limits: Limits | None = None,  # None: none
    position_tolerance: float = 1e-9,
    seed: int = 0,
    progress: _Progress = None,
) -> ModelFreeResult: ...

@final
class ModelFreeResult(_Outcome):
    @property
    def time(self) -> _Array: ...  # (k,)
    @property
    def q(self) -> _Array: ...  # (k, n), accepted
    @property
    def qd(self) -> _Array: ...  # (k, n), row 0 zero
    @property
    def command(self) -> _Array: ...  # (k, n), where each position was measured
    @property
    def position(self) -> _Array: ...  # (k, 3), as measured
    @property
    def reference(self) -> _Array: ...  # (k, 3)
    @property
    def position_error(self) -> _Array: ...  # (k,), m
    @property
    def position_tolerance(self) -> float: ...  # m, as asked
    @property
    def step_status(self) -> NDArray[np.uint8]: ...  # (k,), values of Status
    @property
    def step_evaluations(self) -> NDArray[np.int64]: ...  # (k,), measurements
    @property
    def max_violation(self) -> float: ...  # rad or m, of all commands; 0 within rounding
    @property
    def settled_error(self) -> float: ...  # m, root mean square over the second half
    @property
    def exception(self) -> BaseException | None: ...  # what the plant raised
    def plot(self) -> Figure: ...
    def __len__(self) -> int: ...

@final
class ZNNBAS:
    def __new__(
        cls,
        *,
        gain: float = 100.0,
        antenna_length: ArrayLike | None = None,  # constant; or c1; None for both: c1 = 0.3
        c1: float | None = None,
        delay_steps: int = 1,
        delay: Literal["sliding", "held"] = "sliding",
        accept: Literal["always", "improving"] = "always",
        sensor_delay: int = 0,
    ) -> ZNNBAS: ...
    @property
    def gain(self) -> float: ...  # 1/s
    @property
    def antenna_length(self) -> Any: ...  # what was given: None, a float or (n,)
    @property
    def c1(self) -> float | None: ...  # rad per m; None where the antenna is constant
    @property
    def delay_steps(self) -> int: ...
    @property
    def delay(self) -> str: ...
    @property
    def accept(self) -> str: ...
    @property
    def sensor_delay(self) -> int: ...  # in ticks
    def session(
        self,
        start: ArrayLike,
        *,
        dt: float,
        limits: Limits | None = None,
        position_tolerance: float = 1e-9,
        seed: int = 0,
    ) -> ControlSession: ...
    def __getnewargs_ex__(self) -> tuple[tuple[Any, ...], dict[str, Any]]: ...

@final
class ControlSession:
    def command(self, target: ArrayLike) -> _Array: ...  # (3,) -> (n,)
    def observe(self, position: ArrayLike) -> Step | None: ...  # None while the tick goes on
    @property
    def q(self) -> _Array: ...  # (n,), accepted
    @property
    def time(self) -> float: ...  # s
    @property
    def dt(self) -> float: ...  # s
    @property
    def limits(self) -> Limits: ...  # those in force

@final
class KinematicPlant:
    def __new__(cls, robot: Robot, *, noise: float = 0.0, seed: int = 0) -> KinematicPlant: ...
    @property
    def robot(self) -> Robot: ...
    @property
    def noise(self) -> float: ...  # m, standard deviation on each axis
    @property
    def seed(self) -> int: ...
    def move(self, q: ArrayLike) -> _Array: ...  # (n,) -> (3,)
    def __getnewargs_ex__(self) -> tuple[tuple[Any, ...], dict[str, Any]]: ...

# --- trajectories -------------------------------------------------------------------------------

@final
class Trajectory:
    # coefficients[i, j, p] multiplies (t - time[i])**p: (k - 1, n, degree + 1)
    def __new__(
        cls, time: ArrayLike, coefficients: ArrayLike, *, joint_names: list[str] | None = None
    ) -> Trajectory: ...
    # Straight lines through q; cubics where qd is given too, quintics where qdd is.
    @staticmethod
    def from_samples(
        time: ArrayLike,
        q: ArrayLike,
        *,
        qd: ArrayLike | None = None,
        qdd: ArrayLike | None = None,
        joint_names: list[str] | None = None,
    ) -> Trajectory: ...
    @property
    def time(self) -> _Array: ...  # (k,): the knots
    @property
    def coefficients(self) -> _Array: ...  # (k - 1, n, degree + 1)
    @property
    def q(self) -> _Array: ...  # (k, n), at the knots; likewise qd and qdd (of the piece that ends there)
    @property
    def qd(self) -> _Array: ...
    @property
    def qdd(self) -> _Array: ...
    @property
    def duration(self) -> float: ...  # s
    @property
    def joint_names(self) -> list[str]: ...
    def max_velocity(self) -> _Array: ...  # (n,), exact over all t
    def max_acceleration(self) -> _Array: ...  # (n,), exact inside the pieces
    def max_jerk(self) -> _Array: ...  # (n,), exact inside the pieces
    def at(self, t: ArrayLike) -> tuple[_Array, _Array, _Array]: ...  # q, qd, qdd: (n,) each, or (k, n) for (k,)
    def sample(self, dt: float) -> tuple[_Array, _Array, _Array, _Array]: ...  # time, q, qd, qdd
    def then(self, motion: Trajectory, *, pause: float = 0.0) -> Trajectory: ...  # s
    # Every dt (s) and at the end; None: at the knots.
    def to_csv(self, file: str | os.PathLike[str], *, dt: float | None = None) -> None: ...
    def to_npz(self, file: str | os.PathLike[str]) -> None: ...
    @staticmethod
    def from_csv(file: str | os.PathLike[str]) -> Trajectory: ...
    @staticmethod
    def from_npz(file: str | os.PathLike[str]) -> Trajectory: ...
    def plot(self) -> Figure: ...
    def __getnewargs_ex__(self) -> tuple[tuple[Any, ...], dict[str, Any]]: ...
