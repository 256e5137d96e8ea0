# Types of the native module, written by hand. The docstrings are copied from it: edit them in crates/ikpy-bind and the
# core, then build and run `python tools/stub_docstrings.py`.
#
# Letters in the shape comments: n = degrees of freedom, m = items of a batch, k = samples in time.
# SI units and radians throughout; attributes of results are read-only.

import os
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from enum import IntEnum
from typing import Any, Literal, Never, Protocol, TypeAlias, final, overload, type_check_only

import numpy as np
from matplotlib.figure import Figure
from numpy.typing import ArrayLike, NDArray
from typing_extensions import disjoint_base

__version__: str
_instructions: str

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
_Plant: TypeAlias = KinematicPlant | Callable[[_Array], _Pose] | _Mover
_Several: TypeAlias = slice | Sequence[int] | Sequence[bool] | NDArray[np.integer] | NDArray[np.bool_]  # as numpy picks
_TipKey: TypeAlias = str | tuple[str, str]  # a tip, one as seen from another, or "center_of_mass"
_Targets: TypeAlias = _Pose | Mapping[str, _Pose] | Mapping[_TipKey, _Pose]
_Tasks: TypeAlias = Task | Mapping[str, Task] | Mapping[_TipKey, Task] | None
_Paths: TypeAlias = Path | Mapping[str, Path | _Pose] | Mapping[_TipKey, Path | _Pose]
_Tolerance: TypeAlias = float | Mapping[str, float] | Mapping[_TipKey, float]
_Keeps: TypeAlias = Keep | list[Keep] | tuple[Keep, ...] | None
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

# --- errors -------------------------------------------------------------------------------------

class BeetleIkError(Exception):
    """Any error of this library."""

class InvalidInputError(BeetleIkError, ValueError):
    """An argument with a wrong value, shape or unit; the message says what is expected."""

class UnknownNameError(BeetleIkError, LookupError):
    """Unknown name of a robot, link or option; the message lists the known ones."""

class UrdfError(InvalidInputError):
    """A robot description that cannot be read; the message names the line and the joint."""

class LimitError(InvalidInputError):
    """Limits that contradict each other or exclude the start."""

class UnsupportedLimit(LimitError):
    """A limit that the method cannot keep. No method ignores one."""

class InfeasibleError(InvalidInputError):
    """Requirements that contradict each other; the message names the two."""

class CallError(InvalidInputError, TypeError):
    """A call that does not fit its signature: an argument of the wrong type, one that is missing or unknown. Also a
    `TypeError`, which Python raises there.
    """

class UnitsWarning(UserWarning):
    """A value that looks like degrees where radians are due, or millimetres for metres. The call has used it as given."""

# --- robots -------------------------------------------------------------------------------------

@final
class Robot:
    """A robot: the chain of joints from a base link to a tip link, or several chains to several `tips`, and the links that branch off.
    Immutable; made by `from_urdf`, `from_dh`, `planar` or `named`.

    A joint vector q holds the n independent joints in chain order (rad, m): with several tips one chain after another,
    shared joints once. Mimic joints follow their masters, and joints beside the chains are held. Poses are 4x4 matrices
    in the frame of the robot's base.
    """

    def __new__(cls, *_arguments: Never, **_options: Never) -> Robot: ...
    @staticmethod
    def from_urdf(
        path_or_xml: str | os.PathLike[str],
        *,
        base: str | None = None,
        tip: str | Sequence[str] | None = None,
        hold: Mapping[str, float] | None = None,
        srdf: str | os.PathLike[str] | None = None,
        collision: Literal["primitives", "fit", "hulls"] | None = "primitives",
        package_dirs: str | os.PathLike[str] | Sequence[str | os.PathLike[str]] | None = None,
        trusted: bool = False,
    ) -> Robot:
        """Makes a robot from a URDF file or a string of XML. Links and joints beside the chain are kept: see `all_link_names` and
        `held_joints`.

        Args:
            path_or_xml: a file, or text that contains "<". A file of xacro is expanded by the package xacro, of the extra
                "robots".
            base: link whose frame is the reference frame; None: the root. It need not be an ancestor of `tip`.
            tip: link at the end of the chain, or a list of several, for example ["left_tool", "right_tool"]; None: the
                only leaf. With several tips, q holds the joints of one chain after another, shared joints once.
            hold: values (rad, m) of joints beside the chain, for example {"finger_joint": 0.04}; the others are held at
                zero, or at the limit nearest to zero.
            srdf: an SRDF, file or text, whose disabled pairs of links are not tested against each other, see `with_srdf`.
            collision: treatment of collision shapes. "primitives": spheres, cylinders, capsules and boxes become
                capsules that enclose them; meshes are listed in `unread_collision_shapes`. "fit": in
                addition, each mesh (STL, OBJ, DAE) becomes a few capsules that enclose it; `mesh_fits` gives their
                quality. The fits are kept in the user's cache directory. "hulls": meshes become their convex hulls, and
                the other shapes keep their form: closer than capsules, and slower. None: no shape is read.
            package_dirs: folders that are searched first for `package://`, before the variables ROS_PACKAGE_PATH and
                AMENT_PREFIX_PATH and the folders above the file.
            trusted: whether a xacro file may do everything that xacro offers: execute any expression, read the
                environment and any file. False: the file may come from anyone; whatever the page on robots does not
                list is refused.

        Joints may be revolute, continuous, prismatic, fixed or mimic. Visuals and unknown tags are ignored, and so is
        `safety_controller`. A revolute or prismatic joint of the chain needs a `<limit>`; one without lower and upper is
        unlimited, and continuous if it turns. Velocity limits may be missing; zero locks the joint. Acceleration,
        deceleration (the smaller of both counts) and jerk of URDF 1.2 are in `rated_limits`.

        Raises:
            UrdfError: not XML, no joint, a cycle, two roots, a zero axis, a joint without `<limit>`, or several leaves and
                no `tip`.
            UnknownNameError: no link of that name; the message lists them.
        """
    @staticmethod
    def from_mjcf(
        model: Any,
        *,
        base: str | None = None,
        tip: str | Sequence[str] | None = None,
        hold: Mapping[str, float] | None = None,
        collision: Literal["primitives", "fit", "hulls"] | None = "primitives",
        trusted: bool = False,
    ) -> Robot:
        """Makes a robot from a MuJoCo model, as compiled by MuJoCo. Joint positions equal MuJoCo's qpos. Needs the extra "sim".

        Args:
            model: an MJCF file, text that contains "<", or a `mujoco.MjModel`.
            base: body whose frame is the reference frame; None: "world".
            tip: body or site at the end of the chain, or a list of several; None: the only leaf body.
            hold, collision: as in `from_urdf`.
            trusted: whether the model may use plugins, and files outside its folder. False: the model may come from
                anyone.

        Hinges and slides keep their ranges; MuJoCo has no velocity limits. These equality constraints are followed: couplings of
        two joints by a polynomial, those of fixed tendons that are linear, locks, and whatever follows from these, such as a parallelogram.
        Joints beside the chain are held at their reference positions, where loops of a gripper are closed. A
        `UserWarning` names an equality that held joints do not keep. Geoms that collide become bodies, except
        ellipsoids, planes and height fields, which are listed in `unread_collision_shapes`.

        Raises:
            BeetleIkError: MuJoCo is not installed.
            UnknownNameError: no body or site of that name; the message lists them.
            InvalidInputError: a model that MuJoCo cannot read, a ball or free joint on the chain, or an equality (connect,
                weld, tendon) that joints of the chain do not keep.
        """
    @staticmethod
    def from_description(
        name: str,
        *,
        base: str | None = None,
        tip: str | Sequence[str] | None = None,
        hold: Mapping[str, float] | None = None,
        srdf: str | os.PathLike[str] | None = None,
        collision: Literal["primitives", "fit", "hulls"] | None = None,
        trusted: bool = False,
    ) -> Robot:
        """Makes a robot by its name in the package example-robot-data, if that is installed, or robot_descriptions, for
        example "panda_description" or "panda_mj_description", which downloads it at first use. Needs the extra
        "robots".

        Args:
            name: a name of robot_descriptions; of example-robot-data, that of a folder or of a URDF.
            base, tip, hold: as in `from_urdf`.
            srdf, collision: as in `from_urdf`; None: the default of that constructor. MuJoCo models take no SRDF.
            trusted: as in `from_urdf` and `from_mjcf`.

        Raises:
            BeetleIkError: robot_descriptions is not installed, or cannot download the description.
            UnknownNameError: no description of that name; the message names the nearest.
        """
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
    ) -> Robot:
        """Makes a robot from Denavit-Hartenberg parameters, one row per joint.

        Args:
            a, alpha, d: link length (m), twist (rad), offset (m), each (n,).
            theta: constant offset of a revolute joint, or fixed angle of a prismatic joint (rad), (n,); None: zeros.
            kinds: "revolute", "continuous" or "prismatic" for each joint; None: all revolute.
            convention: "modified" (Craig: a and alpha of the previous link) or "standard".
            lower, upper, velocity: limits (rad, m; rad/s, m/s), a number or (n,); None: no limit.
            base, tool: poses (4, 4) before the first frame and after the last one.
            name: the robot's name.
        """
    @staticmethod
    def planar(
        lengths: ArrayLike,
        *,
        lower: ArrayLike | None = None,
        upper: ArrayLike | None = None,
        velocity: ArrayLike | None = None,
    ) -> Robot:
        """Makes a planar arm of revolute joints in the x-y plane, with its base at the origin.

        Args:
            lengths: link lengths (m), (n,).
            lower, upper, velocity: limits (rad, rad/s), a number or (n,); None: -pi, pi and no velocity limit.
        """
    @staticmethod
    def named(name: str) -> Robot:
        """Returns a built-in robot; `Robot.names()` lists them. Names of descriptions are found too, see `from_description`.

        Raises:
            UnknownNameError: lists the names and suggests the nearest.
        """
    @staticmethod
    def names() -> list[str]:
        """Returns the names of the built-in robots."""
    @property
    def name(self) -> str:
        """The robot's name."""
    @property
    def dof(self) -> int:
        """Degrees of freedom, n: the number of independent joints."""
    @property
    def joint_names(self) -> list[str]:
        """Names of the independent joints, in the order of q."""
    @property
    def joint_kinds(self) -> list[str]:
        """Kinds of the independent joints: "revolute", "continuous" or "prismatic"."""
    def _links_to_tips(self) -> list[list[str]]:
        """Returns the names of the links from the base to each tip, for drawings."""
    @property
    def tips(self) -> list[str]:
        """Names of the tips' links, one for a single chain. They are the keys of dicts of targets, tasks, paths and
        tolerances, and of `errors` in results.
        """
    @property
    def link_names(self) -> list[str]:
        """Names of the links along the chain, base first, tip last; with several tips, along the chain to the first."""
    @property
    def all_link_names(self) -> list[str]:
        """Names of all links: those of the chain as in `link_names`, then those that branch off it."""
    @property
    def held_joints(self) -> dict[str, float]:
        """The joints beside the chain, with the values (rad, m) at which they are held."""
    @property
    def mesh_fits(self) -> list[tuple[str, str, float, float]]:
        """Quality of the capsules fitted to meshes, each (link, file, volume ratio, largest distance): the volume of the
        capsules over that of the mesh, NaN for an open mesh, and the largest distance (m) of the capsules from the
        mesh.
        """
    def collision_meshes(self) -> list[tuple[str, Mesh]]:
        """Reads the collision meshes of a robot from a URDF, each (link, `obstacles.Mesh` in the frame of the link). Only
        files that were found when the URDF was loaded are read.

        Raises:
            InvalidInputError: a file that is no longer there, or cannot be read.
        """
    @property
    def unread_collision_shapes(self) -> list[str]:
        """Collision shapes that did not become `bodies`, for example "a mesh of link 'hand'".
        `from_urdf(..., collision="fit")` and `"hulls"` read meshes.
        """
    @property
    def visuals(self) -> list[tuple[str, Obstacle | str, _Array, _Array | None]]:
        """Visual shapes of a URDF, each (link, shape, placement (4, 4), colour (4,) or None). The shape is one of
        `bik.obstacles`, or the path of a mesh file, as written in the URDF if the file was not found. The placement
        maps it to the frame of the link and includes its scale. Colours are red, green, blue and opacity, from 0 to 1;
        materials of a mesh file take precedence.
        """
    @property
    def collision_pairs(self) -> list[tuple[str, str]]:
        """Pairs of links that are tested against each other, each (link, link). Links fixed to each other are left out.
        Without an SRDF and `with_collision_pairs`, three more kinds of pairs are left out: neighbours, links that touch
        with all joints in the middle of their ranges or in nearly all of 1,000 random configurations, and links that
        come no nearer than 20 mm in 10,000. Determined at the first access, with a fixed seed.
        """
    @property
    def stances(self) -> dict[str, _Array]:
        """Named configurations (n,) of an SRDF, for example "ready"."""
    @property
    def lower(self) -> _Array:
        """Lower position limits (n,) (rad, m); -inf for none."""
    @property
    def upper(self) -> _Array:
        """Upper position limits (n,) (rad, m); inf for none."""
    @property
    def velocity_limit(self) -> _Array:
        """Velocity limits (n,) (rad/s, m/s); inf if unknown, 0 for a locked joint."""
    @property
    def closed_form(self) -> str:
        """Structure of the arm on which its closed-form inverse kinematics rests, and the largest number of solutions of a
        pose, for example "spherical wrist; at most 8 solutions"; or "none: " and the reason. Determined at the first
        access.
        """
    @property
    def limits(self) -> Limits:
        """All limits of the robot."""
    def with_tool(self, tool: _Pose) -> Robot:
        """Returns a copy with a tool: `tool` (4, 4) is the pose of the new tip in the frame of the tip link."""
    def with_base(self, base: _Pose) -> Robot:
        """Returns a copy placed elsewhere: `base` (4, 4) is the pose of its base link."""
    def with_limits(
        self, *, lower: ArrayLike | None = None, upper: ArrayLike | None = None, velocity: ArrayLike | None = None
    ) -> Robot:
        """Returns a copy with other limits, each a number or (n,) (rad, m; rad/s, m/s); None keeps the present ones."""
    @property
    def rated_limits(self) -> Limits:
        """The maker's rated limits: `limits`, plus acceleration and jerk limits where the maker publishes them (`panda`
        and `fr3`, from the maker's "Robot and interface specifications") or a URDF 1.2 has them. Pass them as `limits=`:
        no call uses them by default.
        """

    @property
    def bodies(self) -> list[Body]:
        """Bodies of the links, used for collision tests: given by `with_capsules`, attached by `with_attached`, or read
        from the collision shapes of a file.
        """
    @property
    def capsules(self) -> list[tuple[str, _Array, _Array, float]]:
        """Capsules that enclose the `bodies`, each (link, a, b, radius): all points within the radius (m) of the segment
        from a (3,) to b (3,) in the frame of the link. Spheres and capsules are unchanged.
        """
    def with_capsules(
        self, capsules: list[tuple[str, ArrayLike, ArrayLike, float]] | None = None, *, radius: float | None = None
    ) -> Robot:
        """Returns a copy with collision capsules: one of `radius` (m) along each link, or the given ones, each (link, a,
        b, radius) with its axis from a (3,) to b (3,) in the frame of the link (m). Capsules along the links end at the
        tip, so set a tool first. The gap that a prismatic joint opens between two links is not covered.

        Raises:
            UnknownNameError: no link of that name; the message lists them.
        """
    def with_mobile_base(
        self,
        kind: Literal["planar", "floating"],
        *,
        lower: ArrayLike | None = None,
        upper: ArrayLike | None = None,
        velocity: ArrayLike | None = None,
        acceleration: ArrayLike | None = None,
    ) -> Robot:
        """Returns a copy on a mobile base, whose joints come first in `q`. Poses then refer to a new first link, "world",
        and the base pose of this robot becomes its mounting on the mobile base. In named configurations the base is at
        zero.

        Args:
            kind: "planar": base_x, base_y (m) and base_yaw (rad). "floating": base_x, base_y, base_z (m) and base_rx, base_ry,
                base_rz (rad), a rotation vector: no orientation is singular. Its velocity and acceleration are the rates of its entries.
            lower: lower position limits, (3,) or (6,); finite, since random configurations and starts of searches are drawn from the
                range. The yaw may be unlimited on both sides. The rotation vector has to stay shorter than 5.97 rad;
                -pi and pi for each entry hold every orientation.
            upper: upper position limits, likewise.
            velocity: velocity limits, a number or one per joint (m/s, rad/s); None: unknown.
            acceleration: acceleration limits for `rated_limits`, likewise (m/s^2, rad/s^2).
        """
    @property
    def inertias(self) -> list[Inertia]:
        """Inertias of the links that have one, a list of `Inertia`, in the order of the file; payloads are not among them."""
    @property
    def payloads(self) -> list[Inertia]:
        """Payloads, a list of `Inertia`, each in the frame of the link that carries it."""
    @property
    def gravity(self) -> _Array:
        """Acceleration of free fall (3,) in the frame of the base (m/s^2): (0, 0, -9.81) unless `with_gravity` has changed it."""
    @property
    def has_dynamics(self) -> bool:
        """Whether `torques`, `mass_matrix`, `accelerations` and `center_of_mass` can be computed: the masses of the links are known and
        possible, and every joint moves some. The errors of these calls say what is missing.
        """
    @property
    def torque_limit(self) -> _Array:
        """Torque limits (n,) (N m, N): the effort of a file; inf where there is none, or an effort of zero. No call uses them unless
        they are passed as limits.
        """
    def with_inertias(self, inertias: Mapping[str, Inertia] | Sequence[Inertia]) -> Robot:
        """Returns a copy with these inertias of links: a dict {link: Inertia} or a list of `Inertia`; those of other links stay.

        Raises:
            UnknownNameError: no link of that name; the message lists them.
        """
    def with_payload(
        self,
        mass: float,
        *,
        center: ArrayLike | None = None,
        matrix: ArrayLike | None = None,
        link: str | None = None,
    ) -> Robot:
        """Returns a copy that carries a payload, in place of one that the same link carries already. A mass of 0 takes it off. For what
        a payload looks like, and may collide with, see `with_attached`.

        Args:
            mass: mass (kg).
            center: centre of mass (3,) (m).
            matrix: inertia matrix (3, 3) about the centre (kg m^2); None: a point.
            link: the link that carries it, in whose frame center and matrix are; None: the tip, tool included.

        Raises:
            UnknownNameError: no link of that name; the message lists them.
            InvalidInputError: a mass or matrix that no body has; several tips and no link.
        """
    def with_gravity(self, gravity: ArrayLike) -> Robot:
        """Returns a copy under another acceleration of free fall (3,) (m/s^2), in the frame of the base."""
    def torques(
        self,
        q: ArrayLike,
        qd: ArrayLike | None = None,
        qdd: ArrayLike | None = None,
        *,
        wrench: ArrayLike | None = None,
    ) -> _Array:
        """Returns the joint torques (n,) (N m; N for prismatic joints) that cause a motion, by inverse dynamics; (m, n) for q (m, n). At
        rest they hold the arm up.

        Friction and rotors of a file count; a joint at rest has no dry friction. With a floating base, its first six entries are the
        force on it in the frame of the base, and what is conjugate to the rates of its rotation vector.

        Args:
            q: positions (n,) or (m, n).
            qd: velocities (rad/s, m/s), of the shape of q; None: at rest.
            qdd: accelerations (rad/s^2, m/s^2), of the shape of q; None: zero.
            wrench: force (N) and moment (N m) that the surroundings exert on the tip, (6,) in the axes of the base, at the tip; (m, 6)
                for each motion; (tips, 6) or (m, tips, 6) with several tips.

        Raises:
            InvalidInputError: a robot without dynamics; the message says which link or joint lacks a mass, or has an impossible one.
        """
    def mass_matrix(self, q: ArrayLike) -> _Array:
        """Returns the mass matrix (n, n) at q (n,), (m, n, n) for q (m, n), rotors included: kg m^2; rows and columns of prismatic joints
        kg m and kg. The kinetic energy is half of qd' M qd.

        Raises:
            InvalidInputError: a robot without dynamics.
        """
    def accelerations(self, q: ArrayLike, qd: ArrayLike, torques: ArrayLike) -> _Array:
        """Returns the joint accelerations (n,) (rad/s^2, m/s^2) that torques (N m, N) cause, by forward dynamics: the inverse of
        `torques`. All three arguments are (n,) or (m, n).

        Raises:
            InvalidInputError: a robot without dynamics, or a singular mass matrix.
        """
    def center_of_mass(self, q: ArrayLike) -> _Array:
        """Returns the centre of all masses (3,) at q (n,), (m, 3) for q (m, n), in the frame of the base (m). Links that stand still and
        payloads count.

        Raises:
            InvalidInputError: a robot without dynamics.
        """
    def with_held(self, hold: Mapping[str, float]) -> Robot:
        """Returns a copy with other values (rad, m) of joints beside the chain, for example
        `with_held({"finger_joint": 0.04})`.

        Raises:
            UnknownNameError: no held joint of that name; the message lists them.
            LimitError: a value outside the limits of the joint.
        """
    def with_attached(
        self, link: str, shape: Obstacle, *, touch: Sequence[str] | None = None, name: str | None = None
    ) -> Robot:
        """Returns a copy that carries `shape`, in the frame of `link`, as a body of its own, for example a grasped part.

        Args:
            link: the link that carries it.
            shape: a Sphere, Box, Capsule, Cylinder, Ellipsoid or ConvexMesh of `bik.obstacles`.
            touch: links that the shape may touch, besides those that move with `link`.
            name: name of the body in messages and in `all_link_names`; None: "attached", "attached_2" and so on.

        Raises:
            UnknownNameError: no link of that name; the message lists them.
        """
    def with_collision_pairs(self, pairs: Sequence[tuple[str, str]]) -> Robot:
        """Returns a copy that tests exactly these pairs of links against each other, each (link, link). To exclude a link:
        `robot.with_collision_pairs([pair for pair in robot.collision_pairs if "camera" not in pair])`.

        Raises:
            UnknownNameError: no link of that name; the message lists them.
        """
    def with_srdf(self, path_or_xml: str | os.PathLike[str]) -> Robot:
        """Returns a copy with the disabled pairs and named states of an SRDF; `path_or_xml` is a file, or text that
        contains "<". Disabled pairs of links are not tested against each other, and states that give all joints of the
        robot become `stances`.

        Raises:
            UrdfError: not an SRDF, or the SRDF of another robot.
        """
    def with_errors(self, *, length: float = 0.0, angle: float = 0.0, seed: int = 0) -> Robot:
        """Returns a copy with random manufacturing errors: each constant offset between two joints changes by up to `length`
        (m), and the zero of each revolute joint by up to `angle` (rad). Use it in a `KinematicPlant` to simulate an arm whose
        model is wrong.
        """
    def _doubt_degrees(self) -> None:
        """Doubts limits that a MuJoCo model gives in degrees by default."""
    # For interop. Elements: ("fixed", pose), ("moving", joint, turns, axis, scale, offset) or ("link", name).
    def _chain(self) -> tuple[_Array, list[tuple[Any, ...]], _Array]:  # base, elements, tool
        """Returns (base (4, 4), elements, tool (4, 4)) for `beetle_ik.interop`, with elements as in `_from_chain`."""
    @staticmethod
    def _from_chain(
        name: str,
        base: str,
        joints: Sequence[tuple[str, str, float, float, float]],  # name, kind, lower, upper, velocity
        elements: Sequence[tuple[object, ...]],
    ) -> Robot:
        """Makes a robot for `beetle_ik.interop`. Joints are (name, kind, lower, upper, velocity); elements are ("fixed",
        pose (4, 4)), ("moving", joint, turns, axis (3,), scale, offset) or ("link", name).
        """
    def fk(self, q: ArrayLike, *, link: str | None = None) -> _Array:
        """Returns the pose of the tip by forward kinematics: (4, 4) for q (n,), (m, 4, 4) for q (m, n). A robot with
        several tips gives the poses of all, (tips, 4, 4) or (m, tips, 4, 4), in the order of `tips`. With `link`,
        returns the pose of any link of the robot; `all_link_names` lists them.

        Raises:
            UnknownNameError: no link of that name; the message lists them.
        """
    def clip(self, q: ArrayLike) -> _Array:
        """Moves each joint of q to its nearest position limit if it is outside: (n,) for q (n,), (m, n) for q (m, n). This changes the
        pose of the tip; `wrap` takes off whole turns, which does not.
        """
    def wrap(self, q: ArrayLike, *, near: ArrayLike | None = None) -> _Array:
        """Returns the same posture with whole turns added to or taken off its joints, so that q is inside the position limits: (n,) for
        q (n,), (m, n) for q (m, n). Poses of all links stay the same.

        Controllers that report angles from 0 to 360 degrees, or count turns, become usable this way. A joint inside its limits
        stays where it is, one outside takes the fewest turns, and a joint without limits comes to (-pi, pi]; with `near`, each
        takes the turn nearest to it. Rounding beyond a limit is taken off. A joint that no turn brings inside may be outside by
        5 degrees, as the start of a motion may. Joints that slide stay as they are, outside by 5 mm at most.

        Args:
            q: joint positions (n,) or (m, n) (rad, m).
            near: configuration (n,) to which the result is as near as possible; None: see above.

        Raises:
            LimitError: a joint is farther outside its limits at every whole turn, or a joint that slides is (an
                `InvalidInputError`).

        For example:

            >>> panda = bik.Robot.named("panda")
            >>> panda.wrap([6.0, 0.2, 0.0, 4.7, 0.0, 1.6, 0.8]).round(2).tolist()
            [-0.28, 0.2, 0.0, -1.58, 0.0, 1.6, 0.8]
        """
    def q_from(
        self, names: Any, values: ArrayLike | None = None, *, degrees: bool = False, ignore_extra: bool = False
    ) -> _Array:
        """Returns joint positions by name in the order of q, (n,) or (m, n), from a message, a dict or a table.

        Args:
            names: names of the joints, in any order. Alone: values with names, such as a dict, a `sensor_msgs/JointState`, a
                row or table of pandas, or a structured array; of columns named "q:joint", these alone are taken.
            values: (k,) or (m, k), one column per name (rad, m).
            degrees: whether joints that turn are in degrees.
            ignore_extra: whether to pass over names of other joints, such as those of a gripper.

        Raises:
            UnknownNameError: a name that is no joint of q; the message lists these.
            InvalidInputError: a joint that is missing or there twice, wrong shape, or NaN.

        For example:

            >>> arm = bik.Robot.planar([1.0, 1.0])
            >>> arm.q_from(["joint_2", "joint_1"], [90.0, 0.0], degrees=True).round(2).tolist()
            [0.0, 1.57]
        """
    def link_poses(self, q: ArrayLike) -> _Array:
        """Returns the poses of the links of the chain at q (n,), in the order of `link_names`: (links, 4, 4)."""
    def all_link_poses(self, q: ArrayLike) -> _Array:
        """Returns the poses of all links at q (n,), in the order of `all_link_names`: (links, 4, 4)."""
    def jacobian(self, q: ArrayLike, *, link: str | None = None) -> _Array:
        """Returns the geometric Jacobian at the tip, (6, n) for q (n,), (m, 6, n) for q (m, n): linear rows (m per rad or
        m), then angular rows, along the axes of the base. A robot with several tips gives the Jacobians of all, (tips,
        6, n) or (m, tips, 6, n). With `link`, returns the Jacobian at the origin of any link of the robot;
        `all_link_names` lists them.

        Raises:
            UnknownNameError: no link of that name; the message lists them.
        """
    def random_configurations(self, m: int, seed: int = 0) -> _Array:
        """Draws m configurations uniformly within the limits, (m, n); joints without limits within one turn, or 2 m,
        around zero.
        """
    def manipulability(self, q: ArrayLike, *, motion: _Motion = "pose") -> Any:
        """Returns Yoshikawa's manipulability index, a number for q (n,), (m,) for q (m, n): sqrt(det(J J')), the product of the
        singular values of the Jacobian, over the directions in which the tip can move at all.

        Args:
            motion: motion of the tip that counts, "pose", "position" or "rotation".
        """
    def manipulability_gradient(self, q: ArrayLike, *, motion: _Motion = "pose") -> _Array:
        """Returns the exact gradient (n,) of `manipulability` at q (n,)."""
    def link_manipulability(self, q: ArrayLike, *, motion: _Motion = "position") -> _Array:
        """Returns the manipulability of each moving link (links,), the tip's last: of the link's tip, moved by the joints
        before it, times the volume of the unit ball (pi in the plane). The sum measures the manipulability of the whole
        arm.

        It is zero for a link with fewer joints before it than directions. `motion` is as in `manipulability`.
        """
    def velocity_ellipsoid(self, q: ArrayLike, *, motion: _Motion = "position") -> VelocityEllipsoid:
        """Returns the velocity ellipsoid of the tip at q (n,) for unit joint speeds; `motion` is as in `manipulability`."""

@final
class _JointEntries:
    """Where the joints of a robot are in arrays of another library, for `beetle_ik.interop`.

    Args:
        robot: the robot.
        at: index of each joint of the robot among the entries.
        count: number of entries that an array must have; more may follow.
        unit: what one unit of each entry is (rad, m), one per joint of the robot.
    """

    def __new__(cls, robot: Robot, at: Sequence[int], count: int, unit: Sequence[float]) -> _JointEntries: ...
    def read(self, name: str, values: ArrayLike) -> _Array:
        """Returns the entries (k,), a copy."""
    def q(self, name: str, values: ArrayLike) -> _Array:
        """Returns the joint positions of the robot (n,) (rad, m)."""
    def inside(self, name: str, values: ArrayLike) -> _Array:
        """Returns the joint positions of the robot (n,) (rad, m), each at its nearest limit if it is outside."""
    def placed(self, q: ArrayLike, entries: ArrayLike) -> _Array:
        """Returns a copy of the entries with the joint positions q (n,) (rad, m) in their places."""
    def __getnewargs__(self) -> tuple[Robot, list[int], int, list[float]]: ...

@final
class VelocityEllipsoid:
    """The ellipsoid of tip velocities for unit joint speeds, |q'| = 1. It has one semi-axis for each direction in which the
    tip can move, longest first.
    """

    @property
    def lengths(self) -> _Array:
        """Lengths of the semi-axes (directions,) (m/s, rad/s): the singular values of the Jacobian."""
    @property
    def axes(self) -> _Array:
        """Unit vectors along the semi-axes (directions, 6): linear, then angular part, along the axes of the base."""
    @property
    def index(self) -> float:
        """Yoshikawa's manipulability index: the product of the lengths."""
    @property
    def condition(self) -> float:
        """Ratio of the longest to the shortest length; inf if a direction is lost."""
    @property
    def isotropy(self) -> float:
        """Ratio of geometric to arithmetic mean of the squared lengths (Kim and Khosla 1991): 1 for a sphere, 0 if a direction
        is lost.
        """

def pose(
    position: ArrayLike | None = None,
    *,
    xyzw: ArrayLike | None = None,
    wxyz: ArrayLike | None = None,
    rpy: ArrayLike | None = None,
    rotvec: ArrayLike | None = None,
    matrix: _Pose | None = None,
    degrees: bool = False,
) -> _Array:
    """Makes a pose (4, 4) from a position (3,) (m) and an orientation. The keyword names the form of the orientation.

    Args:
        position: (3,) (m); None: the origin, or the position of a `matrix` (4, 4).
        xyzw, wxyz: quaternion (4,), of any nonzero length.
        rpy: fixed-axis roll, pitch, yaw (rad): Rz(yaw) Ry(pitch) Rx(roll), as in URDF.
        rotvec: rotation vector (rad).
        matrix: rotation matrix (3, 3), or a pose (4, 4). Rounded ones are taken, as the nearest rotation: R'R may differ from the
            identity by 0.002, as that of a matrix of three decimals does.
        degrees: whether `rpy` and `rotvec` are in degrees.

    Without an orientation the axes are those of the base.

    Raises:
        InvalidInputError: a matrix that is no rotation, a quaternion of length zero, or several orientations.

    For example:

        >>> bik.pose([0.4, 0.1, 0.3])
        array([[1. , 0. , 0. , 0.4],
               [0. , 1. , 0. , 0.1],
               [0. , 0. , 1. , 0.3],
               [0. , 0. , 0. , 1. ]])
        >>> bik.pose([0.4, 0.1, 0.3], rpy=[180, 0, 90], degrees=True)[:3, 2].round(3) + 0.0
        array([ 0.,  0., -1.])
    """

# --- limits -------------------------------------------------------------------------------------

@final
class Sinusoid:
    """A sinusoidal limit: mean + amplitude sin(angular_frequency t + phase), eq. (7) of Cheng et al. (2020) with its sign
    corrected.

    Args:
        mean, amplitude: in the unit of the limit; a number for all joints, or (n,).
        angular_frequency: angular frequency (rad/s); a number or (n,).
        phase: phase at t = 0 (rad); a number or (n,).
    """

    def __new__(
        cls, *, mean: ArrayLike, amplitude: ArrayLike, angular_frequency: ArrayLike, phase: ArrayLike | None = None
    ) -> Sinusoid: ...
    @property
    def mean(self) -> Any:
        """Mean, as given."""
    @property
    def amplitude(self) -> Any:
        """Amplitude, as given."""
    @property
    def angular_frequency(self) -> Any:
        """Angular frequency (rad/s), as given."""
    @property
    def phase(self) -> Any:
        """Phase at t = 0 (rad), as given."""
    def __getnewargs_ex__(self) -> tuple[tuple[Any, ...], dict[str, Any]]: ...

@final
class Limits:
    """Limits on joint motion. A given field replaces the robot's limit, None keeps the robot's limit, and np.inf removes it.

    Args:
        lower, upper: position limits (rad, m).
        velocity: velocity limits (rad/s, m/s).
        acceleration, jerk: acceleration limits (rad/s^2, m/s^2) and jerk limits (rad/s^3, m/s^3).
        tip_speed, tip_acceleration, tip_turn_speed: limits of the motion of the robot's tips, seen from its base: speed of the tip's
            origin (m/s), its acceleration (m/s^2), and how fast the tip turns (rad/s). A number for all tips, or a dict by tip; None: no
            limit. Planned motions keep them at every instant, not only at samples.
        torque: limits of the torques of the joints (N m, N), a number or (n,); `robot.torque_limit` has those of the robot's file. None: not
            limited. Planned motions keep them at every instant, with the masses, payload, gravity and friction of the robot; they do not
            count on friction where it would help.

    Limits of joints are a number for all joints, (n,), a `Sinusoid`, or a callable of t (s) that returns a number or (n,). Callables
    are sampled at the ends and in the middle of each tick. A method that cannot keep a limit raises `UnsupportedLimit`;
    no limit is ignored.

    For example, a cobot whose tool moves at 0.25 m/s at most:

        >>> limits = bik.Limits(velocity=2.0, acceleration=8.0, tip_speed=0.25)
        >>> plan = bik.plan_point_to_point(bik.Robot.named("ur5e"), start_q=[0, -1.5, 1.5, 0, 0, 0], end_q=[1, -1, 1, 0, 0, 0], limits=limits)
        >>> plan.success
        True

    Raises:
        LimitError: a negative limit; a limit of a tip that is not positive.
        InvalidInputError: NaN, no number, or a dict that is not by tip.
    """

    def __new__(
        cls,
        *,
        lower: _LimitIn | None = None,
        upper: _LimitIn | None = None,
        velocity: _LimitIn | None = None,
        acceleration: _LimitIn | None = None,
        jerk: _LimitIn | None = None,
        tip_speed: float | Mapping[str, float] | None = None,
        tip_acceleration: float | Mapping[str, float] | None = None,
        tip_turn_speed: float | Mapping[str, float] | None = None,
        torque: ArrayLike | None = None,
    ) -> Limits: ...
    @property
    def lower(self) -> _LimitOut:
        """Lower position limits (rad, m), as given."""
    @property
    def upper(self) -> _LimitOut:
        """Upper position limits (rad, m), as given."""
    @property
    def velocity(self) -> _LimitOut:
        """Velocity limits (rad/s, m/s), as given."""
    @property
    def acceleration(self) -> _LimitOut:
        """Acceleration limits (rad/s^2, m/s^2), as given."""
    @property
    def jerk(self) -> _LimitOut:
        """Jerk limits (rad/s^3, m/s^3), as given."""
    @property
    def torque(self) -> float | _Array | None:
        """Limits of the torques of the joints (N m, N), as given."""
    @property
    def tip_speed(self) -> float | dict[str, float] | None:
        """Limits of the speed of tips (m/s), as given."""
    @property
    def tip_acceleration(self) -> float | dict[str, float] | None:
        """Limits of the acceleration of tips (m/s^2), as given."""
    @property
    def tip_turn_speed(self) -> float | dict[str, float] | None:
        """Limits of how fast tips turn (rad/s), as given."""
    def __getnewargs_ex__(self) -> tuple[tuple[Any, ...], dict[str, Any]]: ...

# --- solvers ------------------------------------------------------------------------------------

class Status(IntEnum):
    """How a solve, an item of a batch or a step of a track ended. Only `SOLVED` is success, and true in conditions.

    - `SOLVED`: Within the tolerances.
    - `IMPROVED`: A step of a track that came nearer than the step before, not yet within the tolerance; or a search that reached the value asked for.
    - `CAPPED`: A step of a track that is neither within the tolerance nor nearer than the step before; the best configuration found is kept.
    - `STALLED`: The solver's own rule ended the search: no further progress from here.
    - `BUDGET_SPENT`: The evaluation or iteration budget is spent.
    - `TIME_UP`: The time limit is reached.
    - `INTERRUPTED`: Stopped on request before the end.
    - `LOST`: A track that did not stay within its tolerance.
    - `INVALID`: An item of a batch with an invalid target or start; it was not solved.
    - `OUT_OF_REACH`: Provably out of reach: the target is farther away than the arm is long, off its plane, or without a solution in closed form.
    - `PLANT_FAILED`: The plant raised an error or returned something other than a position; the run ended with what was recorded.
    - `BELOW_THRESHOLD`: The solver's own threshold was met before the tolerances were.
    - `OUTSIDE_LIMITS`: The search converged outside the limits, and whole turns do not bring it inside; the best configuration inside is kept.
    - `HELD_IN_REGION`: The region of the task keeps the tip from the target; the tip is in the region, as near as possible.
    - `IN_COLLISION`: Nearer than the margin to an obstacle, or with two links nearer to each other; the target may be reached.
    - `HELD_BY_OBSTACLE`: A step of a track in which obstacles, or the robot's own links, keep the tip from the target; the arm keeps its margin.
    - `ROTATION_GIVEN_UP`: The position is within its tolerance, and the rotation as near as the search found; a configuration that meets both was not found.
    - `POSITION_GIVEN_UP`: The rotation is within its tolerance, and the position as near as the search found; a configuration that meets both was not found.
    - `HELD_BY_CONSTRAINT`: A step of a track in which what is to be kept holds the tip away from the target; the arm keeps it at every instant.
    - `LEVEL_GIVEN_UP`: The tasks of the lowest level are within their tolerances, those of a higher level as near as the search found; a configuration that meets all was not found.
    - `HELD_BY_TORQUE`: A step of a track in which a torque limit holds the tip away from the target: a joint could not move or hold the arm farther on, or carries more than it can.
    """

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
    IN_COLLISION = 14
    HELD_BY_OBSTACLE = 15
    ROTATION_GIVEN_UP = 16
    POSITION_GIVEN_UP = 17
    HELD_BY_CONSTRAINT = 18
    LEVEL_GIVEN_UP = 19
    HELD_BY_TORQUE = 20

@final
class APPS:
    """Autonomous path planning solution (Yuan et al. 2016): gradient descent with a step limit for each joint. Needs no
    Jacobian and no inverse.

    The error is E of eq. (11): half the sum of squared differences between the matrices of target and tip (between the
    positions, for a position). The search may leave the limits; whole turns bring revolute joints back, eq. (12). If they
    cannot, the status is `OUTSIDE_LIMITS`, and the best configuration inside the limits is returned.

    Args:
        learning_rate: eta of eq. (13); "auto": from the curvature along the last step (Barzilai and Borwein 1988).
        step_limit: largest change of a joint per iteration, eq. (20) (rad or m).
        error_threshold: E_0; the search ends after the first update from an E of at most this value, even if the
            tolerances of the call are not met. None: it ends when they are met.
    """

    def __new__(
        cls,
        *,
        learning_rate: float | Literal["auto"] = "auto",
        step_limit: float = 0.2,
        error_threshold: float | None = None,
    ) -> APPS: ...
    @staticmethod
    def paper() -> APPS:
        """Returns the paper's parameters, in the scale of its eq. (11): rate 0.2, step limit one degree, threshold 5e-10. The
        paper's budget is `Stop(max_iterations=1000)`.
        """
    @property
    def learning_rate(self) -> float | Literal["auto"]:
        """Learning rate eta of eq. (13), or "auto"."""
    @property
    def step_limit(self) -> float:
        """Largest change of a joint per iteration (rad or m)."""
    @property
    def error_threshold(self) -> float | None:
        """Error threshold E_0, or None."""
    def __getnewargs_ex__(self) -> tuple[tuple[Any, ...], dict[str, Any]]: ...

@final
class BAS:
    """Beetle antennae search (Cheng et al. 2020, Algorithm 1): needs only values of the error, no derivatives.

    Args:
        variant: "star": all explorations of a pass start from the same point (eq. 8-11, literally); "chain": each
            exploration starts where the last one ended (the original beetle search, faster); "greedy": each starts from
            the better of the two points, and the antennae adapt to the error at once (fastest for small tolerances).
        c1: ratio of antenna length to error, eq. (12) (rad per m); None: 3 for "star", 1 for "chain", 3 for "greedy".
        c2: ratio of step length to antenna length, eq. (13); None: 1.
        explorations: explorations per pass, n in the paper; None: 50 for "star", 30 for "chain", 5 for "greedy".
        max_passes: largest number of passes; the paper has no such bound.

    The error band of the paper is the tolerance of the call.

    In `minimize`, antennae are c1 times the square root of the function's value: the minimum must be zero, and c1 must suit
    the function. With the default c1, the sum of squares about (0.3, 0.3) in [-2, 2]^2 stayed at 0.5 to 2.9 (5 seeds, 30000
    evaluations), where `DifferentialEvolution` and `PSO` found the minimum exactly.
    """

    def __new__(
        cls,
        *,
        variant: Literal["star", "chain", "greedy"] = "star",
        c1: float | None = None,
        c2: float | None = None,
        explorations: int | None = None,
        max_passes: int = 200,
    ) -> BAS: ...
    @property
    def variant(self) -> str:
        """Variant of the algorithm: "star", "chain" or "greedy"."""
    @property
    def c1(self) -> float:
        """Ratio of antenna length to error (rad per m)."""
    @property
    def c2(self) -> float:
        """Ratio of step length to antenna length."""
    @property
    def explorations(self) -> int:
        """Explorations per pass."""
    @property
    def max_passes(self) -> int:
        """Largest number of passes."""
    def __getnewargs_ex__(self) -> tuple[tuple[Any, ...], dict[str, Any]]: ...

@final
class BroydenBAS:
    """A quasi-Newton method that uses antenna differences as secants: f(q + antenna) - f(q) estimates a column of the
    Jacobian, and each step made is another secant (Broyden 1965). It needs measurements of the tip, not a model.

    It is the recommended controller for `track_model_free`: it updates its Jacobian estimate along the path, and
    estimates columns anew when the predictions of steps become wrong. An unexpected measurement is repeated before it is
    used, which makes the controller robust against noise and outliers of the sensor. As a solver, in `solve` and `track`,
    it suits problems with cheap residuals and no Jacobian; `LevenbergMarquardt` needs fewer evaluations.

    With poses, the residual has six rows, the distance (m) and the rotation vector (rad): a radian counts as much as a metre,
    also for the noise of the sensor.

    Defaults: `BroydenBAS(antenna_length=0.01, max_evaluations_per_step=20, sensor_delay=0)`.

    Args:
        antenna_length: length of the controller's antennae (rad, m). The tip displacement that they cause should be well
            above the noise of the sensor. As a solver, without noise, it uses 1e-6.
        max_evaluations_per_step: measurements per step of a path; 1: one command per tick.
        sensor_delay: delay of the plant's sensor, in measurements. Each command is repeated this many times, and the last
            measurement counts.
    """

    def __new__(
        cls, *, antenna_length: float = ..., max_evaluations_per_step: int = 20, sensor_delay: int = 0
    ) -> BroydenBAS: ...
    @property
    def antenna_length(self) -> float:
        """Length of the controller's antennae (rad, m)."""
    @property
    def max_evaluations_per_step(self) -> int:
        """Measurements per step."""
    @property
    def sensor_delay(self) -> int:
        """Delay of the sensor, in measurements."""
    def session(
        self,
        start_q: ArrayLike,
        *,
        dt: float,
        limits: Limits | None = None,
        position_tolerance: float = 1e-9,
        rotation_tolerance: float = 1e-9,
        seed: int = 0,
    ) -> ControlSession:
        """Starts a `ControlSession` at `start_q` (n,) and t = 0, for your own loop."""
    def __getnewargs_ex__(self) -> tuple[tuple[Any, ...], dict[str, Any]]: ...

@final
class JacobianTranspose:
    """Jacobian transpose method: steepest descent on the squared error, inside the limits. It inverts nothing, so that singular
    configurations do no harm, but takes many small steps.

    Args:
        step_size: factor of the step J^T e; "auto": the factor that minimises the linearised error (Buss 2004).
    """

    def __new__(cls, *, step_size: float | Literal["auto"] = "auto") -> JacobianTranspose: ...
    @property
    def step_size(self) -> float | Literal["auto"]:
        """Factor of the step J^T e, or "auto"."""
    def __getnewargs_ex__(self) -> tuple[tuple[Any, ...], dict[str, Any]]: ...

@final
class BeeColony:
    """Artificial bee colony (Karaboga 2005): needs only values.

    Defaults: `BeeColony(population=20, limit=None, max_generations=None, stall_generations=50)`.

    Args:
        population: number of food sources, of employed bees and of onlookers.
        limit: unsuccessful trials after which a source is abandoned; None: sources times dimensions.
        max_generations: largest number of generations; None: as many as the budget allows.
        stall_generations: the search ends after this many generations in a row improve the best value by less than
            a millionth; None: never.
    """

    def __new__(
        cls,
        *,
        population: int = ...,
        limit: int | None = ...,
        max_generations: int | None = ...,
        stall_generations: int | None = ...,
    ) -> BeeColony: ...
    @property
    def population(self) -> int:
        """Size of a generation."""
    @property
    def limit(self) -> int | None:
        """Unsuccessful trials after which a source is abandoned; None: sources times dimensions."""
    @property
    def max_generations(self) -> int | None:
        """Largest number of generations; None: as many as the budget allows."""
    @property
    def stall_generations(self) -> int | None:
        """Generations without improvement after which the search ends; None: never."""
    def __getnewargs_ex__(self) -> tuple[tuple[Any, ...], dict[str, Any]]: ...

@final
class BeetleSwarm:
    """Beetle swarm optimisation (Wang et al. 2019, eq. 26-32), particles with antennae: needs only values. The equations
    converge only with an inertia weight and a velocity limit; inertia=1 and velocity_limit=1 give them literally.

    Defaults: `BeetleSwarm(population=50, inertia=0.729, c1=1.494, c2=1.494, velocity_limit=0.2, velocity_share=0.9,
    step=1.0, step_decay=0.97, step_over_antennae=5.0, direction='printed', max_generations=None,
    stall_generations=50)`.

    Args:
        population: number of beetles; each needs three evaluations per generation.
        inertia: weight of the old velocity.
        c1: attraction to the beetle's own best point, eq. (27).
        c2: attraction to the swarm's best point.
        velocity_limit: largest velocity per generation, as a fraction of the box's width.
        velocity_share: lambda of eq. (26), the fraction of the velocity in a move.
        step: initial delta, eq. (28).
        step_decay: eta of eq. (32), factor that multiplies delta every generation.
        step_over_antennae: c of eq. (31), ratio of delta to the distance between the antennae.
        direction: the sign of eq. (28), as "printed" or "downhill".
        max_generations: largest number of generations; None: as many as the budget allows.
        stall_generations: the search ends after this many generations in a row improve the best value by less than
            a millionth; None: never.
    """

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
    def population(self) -> int:
        """Size of a generation."""
    @property
    def inertia(self) -> float:
        """Weight of the old velocity."""
    @property
    def c1(self) -> float:
        """Attraction to the beetle's own best point."""
    @property
    def c2(self) -> float:
        """Attraction to the swarm's best point."""
    @property
    def velocity_limit(self) -> float:
        """Largest velocity, as a fraction of the box's width."""
    @property
    def velocity_share(self) -> float:
        """Fraction of the velocity in a move."""
    @property
    def step(self) -> float:
        """Initial delta."""
    @property
    def step_decay(self) -> float:
        """Factor that multiplies delta every generation."""
    @property
    def step_over_antennae(self) -> float:
        """Ratio of delta to the distance between the antennae."""
    @property
    def direction(self) -> str:
        """Sign of eq. (28): "printed" or "downhill"."""
    @property
    def max_generations(self) -> int | None:
        """Largest number of generations; None: as many as the budget allows."""
    @property
    def stall_generations(self) -> int | None:
        """Generations without improvement after which the search ends; None: never."""
    def __getnewargs_ex__(self) -> tuple[tuple[Any, ...], dict[str, Any]]: ...

@final
class DifferentialEvolution:
    """Differential evolution, DE/rand/1/bin (Storn and Price 1997): needs only values.

    Defaults: `DifferentialEvolution(population=50, weight=0.5, crossover_rate=0.9,
    update='generation', max_generations=None, stall_generations=50)`.

    Args:
        population: number of vectors.
        weight: F, weight of the difference of two vectors.
        crossover_rate: CR, probability that a coordinate comes from the mutant.
        update: "generation": better trials replace their vectors after the whole generation, which is evaluated together
            (as published); "immediate": at once, which needs fewer evaluations, but one by one.
        max_generations: largest number of generations; None: as many as the budget allows.
        stall_generations: the search ends after this many generations in a row improve the best value by less than
            a millionth; None: never.
    """

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
    def population(self) -> int:
        """Size of a generation."""
    @property
    def weight(self) -> float:
        """Weight of the difference of two vectors."""
    @property
    def crossover_rate(self) -> float:
        """Probability that a coordinate comes from the mutant."""
    @property
    def update(self) -> str:
        """Time of replacement: "generation" or "immediate"."""
    @property
    def max_generations(self) -> int | None:
        """Largest number of generations; None: as many as the budget allows."""
    @property
    def stall_generations(self) -> int | None:
        """Generations without improvement after which the search ends; None: never."""
    def __getnewargs_ex__(self) -> tuple[tuple[Any, ...], dict[str, Any]]: ...

@final
class Firefly:
    """Firefly algorithm (Yang 2009): needs only values. Each firefly in turn attracts all less bright fireflies.

    Defaults: `Firefly(population=25, attractiveness=1.0, absorption=1.0, randomness=0.2, randomness_decay=0.97,
    max_generations=None, stall_generations=50)`.

    Args:
        population: number of fireflies.
        attractiveness: beta_0, attractiveness at distance zero.
        absorption: gamma, absorption of light, with distances in widths of the box.
        randomness: alpha, size of the random step, as a fraction of the box's width.
        randomness_decay: factor that multiplies alpha every turn.
        max_generations: largest number of generations; None: as many as the budget allows.
        stall_generations: the search ends after this many generations in a row improve the best value by less than
            a millionth; None: never.
    """

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
    def population(self) -> int:
        """Size of a generation."""
    @property
    def attractiveness(self) -> float:
        """Attractiveness at distance zero."""
    @property
    def absorption(self) -> float:
        """Absorption of light."""
    @property
    def randomness(self) -> float:
        """Initial size of the random step, as a fraction of the box's width."""
    @property
    def randomness_decay(self) -> float:
        """Factor that multiplies the randomness every turn."""
    @property
    def max_generations(self) -> int | None:
        """Largest number of generations; None: as many as the budget allows."""
    @property
    def stall_generations(self) -> int | None:
        """Generations without improvement after which the search ends; None: never."""
    def __getnewargs_ex__(self) -> tuple[tuple[Any, ...], dict[str, Any]]: ...

@final
class Genetic:
    """Genetic algorithm with the operators of MATLAB's `ga`: elite, tournaments, scattered crossover, Gaussian mutation.
    Needs only values.

    Defaults: `Genetic(population=50, elite_share=0.05, crossover_share=0.8, tournament=2,
    mutation_rate=1.0, mutation_scale=0.1, mutation_decay=0.97, max_generations=None, stall_generations=50)`.

    Args:
        population: size of a generation.
        elite_share: fraction that survives unchanged, rounded up.
        crossover_share: fraction of the remaining members produced by crossover; mutation produces the rest.
        tournament: size of a tournament; its best member becomes a parent.
        mutation_rate: probability that a coordinate of a mutant changes; at least one does. 1 changes all, as in MATLAB.
        mutation_scale: initial standard deviation of mutations, as a fraction of the box's width.
        mutation_decay: factor that multiplies the standard deviation every generation.
        max_generations: largest number of generations; None: as many as the budget allows.
        stall_generations: the search ends after this many generations in a row improve the best value by less than
            a millionth; None: never.
    """

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
    def population(self) -> int:
        """Size of a generation."""
    @property
    def elite_share(self) -> float:
        """Fraction that survives unchanged."""
    @property
    def crossover_share(self) -> float:
        """Fraction of the remaining members produced by crossover."""
    @property
    def tournament(self) -> int:
        """Size of a tournament."""
    @property
    def mutation_rate(self) -> float:
        """Probability that a coordinate of a mutant changes."""
    @property
    def mutation_scale(self) -> float:
        """Initial standard deviation of mutations, as a fraction of the box's width."""
    @property
    def mutation_decay(self) -> float:
        """Factor that multiplies the standard deviation every generation."""
    @property
    def max_generations(self) -> int | None:
        """Largest number of generations; None: as many as the budget allows."""
    @property
    def stall_generations(self) -> int | None:
        """Generations without improvement after which the search ends; None: never."""
    def __getnewargs_ex__(self) -> tuple[tuple[Any, ...], dict[str, Any]]: ...

@final
class PSO:
    """Particle swarm optimisation: needs only values.

    Defaults: `PSO(population=40, form='constriction', c1=2.05, c2=2.05, velocity_limit=0.5, accept='always',
    walls='absorbing', max_generations=None, stall_generations=50)`.

    Args:
        population: number of particles.
        form: "constriction": a factor that follows from c1 + c2 > 4 scales the whole velocity (Clerc and Kennedy 2002);
            "inertia": a weight scales the old velocity (Shi and Eberhart 1998).
        inertia: weight of the old velocity, only with form "inertia"; None: 0.729.
        c1: attraction to the particle's own best point; None: 2.05 with constriction, 1.49445 with inertia.
        c2: attraction to the swarm's best point; None: the same default as c1.
        velocity_limit: largest velocity per generation, as a fraction of the box's width; `inf`: no limit.
        accept: "always": a particle keeps its new position (as published); "improving": it returns to its best position if
            that is better.
        walls: "absorbing": a coordinate that would leave the box stops at the wall with zero velocity; "random": it is drawn
            again inside the box and keeps its velocity (compared by Helwig, Branke and Mostaghim 2013).
        max_generations: largest number of generations; None: as many as the budget allows.
        stall_generations: the search ends after this many generations in a row improve the best value by less than a
            millionth; None: never.
    """

    def __new__(
        cls,
        *,
        population: int = ...,
        form: Literal["constriction", "inertia"] = "constriction",
        inertia: float | None = None,
        c1: float | None = None,
        c2: float | None = None,
        velocity_limit: float = ...,
        accept: Literal["always", "improving"] = "always",
        walls: Literal["absorbing", "random"] = "absorbing",
        max_generations: int | None = ...,
        stall_generations: int | None = ...,
    ) -> PSO: ...
    @property
    def population(self) -> int:
        """Size of a generation."""
    @property
    def form(self) -> str:
        """Form of the velocity update: "constriction" or "inertia"."""
    @property
    def inertia(self) -> float | None:
        """Weight of the old velocity; None with constriction."""
    @property
    def c1(self) -> float:
        """Attraction to the particle's own best point."""
    @property
    def c2(self) -> float:
        """Attraction to the swarm's best point."""
    @property
    def velocity_limit(self) -> float:
        """Largest velocity per generation, as a fraction of the box's width."""
    @property
    def accept(self) -> str:
        """Rule for accepting a position: "always" or "improving"."""
    @property
    def walls(self) -> str:
        """Behaviour at the walls of the box: "absorbing" or "random"."""
    @property
    def max_generations(self) -> int | None:
        """Largest number of generations; None: as many as the budget allows."""
    @property
    def stall_generations(self) -> int | None:
        """Generations without improvement after which the search ends; None: never."""
    def __getnewargs_ex__(self) -> tuple[tuple[Any, ...], dict[str, Any]]: ...

@final
class QPSO:
    """Quantum-behaved particle swarm optimisation (Sun, Feng and Xu 2004): needs only values.

    Defaults: `QPSO(population=40, expansion=0.75, max_generations=None, stall_generations=50)`.

    Args:
        population: number of particles.
        expansion: contraction-expansion coefficient alpha; 0.75 is the fixed value of Sun et al. (2012).
        max_generations: largest number of generations; None: as many as the budget allows.
        stall_generations: the search ends after this many generations in a row improve the best value by less than
            a millionth; None: never.
    """

    def __new__(
        cls,
        *,
        population: int = ...,
        expansion: float = ...,
        max_generations: int | None = ...,
        stall_generations: int | None = ...,
    ) -> QPSO: ...
    @property
    def population(self) -> int:
        """Size of a generation."""
    @property
    def expansion(self) -> float:
        """Contraction-expansion coefficient."""
    @property
    def max_generations(self) -> int | None:
        """Largest number of generations; None: as many as the budget allows."""
    @property
    def stall_generations(self) -> int | None:
        """Generations without improvement after which the search ends; None: never."""
    def __getnewargs_ex__(self) -> tuple[tuple[Any, ...], dict[str, Any]]: ...

@final
class LevenbergMarquardt:
    """Levenberg-Marquardt with the analytic Jacobian, inside the limits: joints at a bound are held, and the step is solved
    again for the other joints.

    Defaults: `LevenbergMarquardt(initial_damping=0.05)`.

    Args:
        initial_damping: initial ratio of damping to squared error; larger values take smaller steps far from the target.
    """

    def __new__(cls, *, initial_damping: float = ...) -> LevenbergMarquardt: ...
    @property
    def initial_damping(self) -> float:
        """Initial ratio of damping to squared error."""
    def __getnewargs_ex__(self) -> tuple[tuple[Any, ...], dict[str, Any]]: ...

@final
class MultiStart:
    """Restarts a solver from random starts when it stalls or makes too little progress.

    Args:
        solver: any other solver, for example `BAS` or `LevenbergMarquardt`.
        max_starts: largest number of starts; None: as many as the evaluation budget allows.
    """

    def __new__(cls, solver: _Single, *, max_starts: int | None = None) -> MultiStart: ...
    @property
    def solver(self) -> _Single:
        """The solver that is restarted."""
    @property
    def max_starts(self) -> int | None:
        """Largest number of starts; None: as many as the evaluation budget allows."""
    def __getnewargs_ex__(self) -> tuple[tuple[Any, ...], dict[str, Any]]: ...

@final
class NewtonRaphson:
    """Newton-Raphson with the pseudo-inverse of the Jacobian, inside the limits. It converges fast from a start near a
    solution; from others it may jump around until its budget is spent.

    Defaults: `NewtonRaphson(step_fraction=1.0)`.

    Args:
        step_fraction: fraction of the full step to take, above 0 and at most 1.
    """

    def __new__(cls, *, step_fraction: float = ...) -> NewtonRaphson: ...
    @property
    def step_fraction(self) -> float:
        """Fraction of the full step to take."""
    def __getnewargs_ex__(self) -> tuple[tuple[Any, ...], dict[str, Any]]: ...

@final
class WeightedPseudoInverse:
    """Resolved motion rate control, a tick rule for `track` and `Tracker`: joint velocities follow from the velocity of the
    target by the weighted pseudo-inverse of the Jacobian, inside the limits,

    q' = Jw+ (x' + gain (x - f(q))) + (I - Jw+ J) q0',  Jw+ = W^-1 J' (J W^-1 J')^-1,

    where q0' is the negative gradient of the goals plus a velocity towards `posture`. The other joints compensate for
    joints at a limit.

    Defaults: `WeightedPseudoInverse(gain=None, integrator='euler', weights=None, posture=None, posture_gain=20.0,
    damping=0.0)`.

    Args:
        gain: feedback gain of the tip error (1/s), below 2 / dt. None: corrects half of the error in each tick.
        integrator: "euler": the velocity at the start of a tick; "rk4": four evaluations per tick and far smaller errors.
        weights: W (n,), weights of the squared joint velocities. None: 1 / (vU - vL)^2 from the velocity limits.
        posture: a `Trajectory` that the joints follow in the null space.
        posture_gain: feedback gain of the distance from `posture` (1/s).
        damping: damping relative to the squared norm of the weighted Jacobian. 0 gives the pseudo-inverse itself, which
            demands unbounded speed near singularities.
    """

    def __new__(
        cls,
        *,
        gain: float | None = None,
        integrator: Literal["euler", "rk4"] = "euler",
        weights: ArrayLike | None = None,
        posture: Trajectory | None = None,
        posture_gain: float = ...,
        damping: float = 0.0,
    ) -> WeightedPseudoInverse: ...
    @property
    def gain(self) -> float | None:
        """Feedback gain of the tip error (1/s); None: half of the error in each tick."""
    @property
    def integrator(self) -> str:
        """Integration scheme: "euler" or "rk4"."""
    @property
    def weights(self) -> _Array | None:
        """Weights of the squared joint velocities (n,); None: from the velocity limits."""
    @property
    def posture(self) -> Trajectory | None:
        """The trajectory that the joints follow in the null space."""
    @property
    def posture_gain(self) -> float:
        """Feedback gain of the distance from `posture` (1/s)."""
    @property
    def damping(self) -> float:
        """Damping relative to the squared norm of the weighted Jacobian."""
    def __getnewargs_ex__(self) -> tuple[tuple[Any, ...], dict[str, Any]]: ...

@final
class Stop:
    """Budgets of a search, which ends when the first one is spent. Without any, the default is a number of evaluations that
    keeps a 7-joint arm under about 10 ms.

    Args:
        max_evaluations: largest number of evaluations of the forward kinematics, including the start.
        max_iterations: largest number of iterations of the solver; passes of BAS.
        max_time: largest time (s). Results are then no longer repeatable.
        value_below: the search ends at a value below this one. In `minimize` it is a value of the function, and reaching it
            is success. Elsewhere it is a weighted sum of squared errors (m, rad), and the status is IMPROVED.
    """

    def __new__(
        cls,
        *,
        max_evaluations: int | None = None,
        max_iterations: int | None = None,
        max_time: float | None = None,
        value_below: float | None = None,
    ) -> Stop: ...
    @property
    def max_evaluations(self) -> int | None:
        """Largest number of evaluations, including the start."""
    @property
    def max_iterations(self) -> int | None:
        """Largest number of iterations."""
    @property
    def max_time(self) -> float | None:
        """Largest time (s)."""
    @property
    def value_below(self) -> float | None:
        """Value below which the search ends."""
    def __getnewargs_ex__(self) -> tuple[tuple[Any, ...], dict[str, Any]]: ...

# --- tasks and goals ----------------------------------------------------------------------------

@disjoint_base
class Task:
    """The part of a target that counts: `Pose`, `Position`, `Orientation` or `Pointing`.

    A `region` keeps the tip in a box, p_min < p < p_max: eq. (5) of Cheng et al. (2020). A target outside the box is
    approached as far as the box allows, and the status is `HELD_IN_REGION`. A solution with status `SOLVED` or
    `HELD_IN_REGION` always has its tip inside; so has a track at the end of each tick, with any solver. Within a tick
    the joints move linearly, so that the tip can leave the box by the curvature of its path.
    """

    @property
    def weights(self) -> _Array | None:
        """Weights of the components; None: all 1. A component of weight 0 is free."""
    @property
    def tolerance(self) -> _Array | None:
        """Largest error of each component (m, rad); None: the tolerances of the call apply."""
    @property
    def tool(self) -> _Array | None:
        """Pose of the tool in the frame of the tip (4, 4); None: the tip itself."""
    @property
    def region(self) -> _Array | None:
        """Lower and upper corner of the box that the tip stays in (2, 3) (m); None: no box."""
    @property
    def level(self) -> int:
        """Order among the tasks of several tips: tasks of a lower level are met first, those of higher levels as far as these allow."""
    def __getnewargs_ex__(self) -> tuple[tuple[Any, ...], dict[str, Any]]: ...

@final
class Pose(Task):
    """The whole pose.

    Args:
        weights: (6,), for x, y, z and the three components of the rotation vector, along the axes of the target; 0
            leaves a component free.
        tolerance: (6,) (m, rad), largest error of each component, instead of the tolerances of the call.
        tool: (4, 4), pose of the tool in the frame of the tip; the tool reaches the target.
        region: (2, 3) (m), lower and upper corner of the box in the frame of the base that the tip (or tool) stays in;
            infinite on open sides. See `Task`.
        first: "position" or "orientation", the part that is met exactly where the whole pose cannot be met; the other
            comes as near as the first allows. The status is then `ROTATION_GIVEN_UP` or `POSITION_GIVEN_UP`. None:
            "position" for an arm with fewer than six joints; for others both parts share the error. Not with weights
            or a region.
        level: Order among the tasks of several tips: tasks of a lower level are met first, those of higher levels as far as these
            allow. Tasks of the same level share the error.
    """

    def __new__(
        cls,
        *,
        weights: ArrayLike | None = None,
        tolerance: ArrayLike | None = None,
        tool: _Pose | None = None,
        region: ArrayLike | None = None,
        first: str | None = None,
        level: int = 0,
    ) -> Pose: ...
    @property
    def first(self) -> str | None:
        """The part that is met exactly where the whole pose cannot be met: "position" or "orientation"; None: "position" for an arm
        with fewer than six joints.
        """

@final
class Position(Task):
    """The position only; the orientation is free. Of a target given as a pose, only the position counts.

    Args:
        weights: (3,), for x, y and z of the base; 0 leaves a component free.
        tolerance: (3,) (m), largest error of each component, instead of the tolerance of the call.
        tool: (4, 4), pose of the tool in the frame of the tip; the tool reaches the target.
        region: (2, 3) (m), lower and upper corner of the box in the frame of the base that the tip (or tool) stays in;
            infinite on open sides. See `Task`.
        level: Order among the tasks of several tips: tasks of a lower level are met first, those of higher levels as far as these
            allow. Tasks of the same level share the error.
    """

    def __new__(
        cls,
        *,
        weights: ArrayLike | None = None,
        tolerance: ArrayLike | None = None,
        tool: _Pose | None = None,
        region: ArrayLike | None = None,
        level: int = 0,
    ) -> Position: ...

@final
class Orientation(Task):
    """The orientation only; the position is free.

    Args:
        weights: (3,), for the components of the rotation vector along the axes of the target; 0 leaves one free.
        tolerance: (3,) (rad), largest error of each component, instead of the tolerance of the call.
        tool: (4, 4), pose of the tool in the frame of the tip; the tool reaches the target.
        region: (2, 3) (m), lower and upper corner of the box in the frame of the base that the tip (or tool) stays in;
            infinite on open sides. See `Task`.
        level: Order among the tasks of several tips: tasks of a lower level are met first, those of higher levels as far as these
            allow. Tasks of the same level share the error.
    """

    def __new__(
        cls,
        *,
        weights: ArrayLike | None = None,
        tolerance: ArrayLike | None = None,
        tool: _Pose | None = None,
        region: ArrayLike | None = None,
        level: int = 0,
    ) -> Orientation: ...

@final
class Pointing(Task):
    """The position, and the direction of one axis of the tip; rotation about that axis is free. `rotation_error` is the angle
    between the axis and its target direction.

    Args:
        axis: (3,), in the frame of the tip, of any nonzero length; None: (0, 0, 1).
        weights: (4,), for x, y and z along the axes of the target, and for the angle; 0 leaves a component free.
        tolerance: (4,) (m, m, m, rad), largest error of each component, instead of the tolerances of the call.
        tool: (4, 4), pose of the tool in the frame of the tip; the tool reaches the target.
        region: (2, 3) (m), lower and upper corner of the box in the frame of the base that the tip (or tool) stays in;
            infinite on open sides. See `Task`.
        level: Order among the tasks of several tips: tasks of a lower level are met first, those of higher levels as far as these
            allow. Tasks of the same level share the error.
    """

    def __new__(
        cls,
        *,
        axis: ArrayLike | None = None,
        weights: ArrayLike | None = None,
        tolerance: ArrayLike | None = None,
        tool: _Pose | None = None,
        region: ArrayLike | None = None,
        level: int = 0,
    ) -> Pointing: ...
    @property
    def axis(self) -> _Array:
        """The axis in the frame of the tip (3,)."""

@disjoint_base
class Goal:
    """A secondary objective, optimised in the null space of the task: `Posture`, `Centring`, `Manipulability`,
    `LinkManipulability`, `Clearance` or `LeastTorque`.
    """

    @property
    def weight(self) -> float | _Array:
        """Weight relative to other goals; of a `Posture` with a weight for each joint (n,)."""
    def __getnewargs_ex__(self) -> tuple[tuple[Any, ...], dict[str, Any]]: ...

@final
class Posture(Goal):
    """Stays close to a posture: minimises weight * |q - posture|^2 or, with a weight for each joint, the sum of
    (weight * (q - posture))^2.

    Args:
        posture: (n,) (rad, m).
        weight: weight relative to other goals; or the cost of moving each joint (n,): joints of a large weight move little
            where others can do it, such as a base that is to stay while the arm moves.
    """

    def __new__(cls, posture: ArrayLike, *, weight: ArrayLike = 1.0) -> Posture: ...
    @property
    def posture(self) -> _Array:
        """The posture (n,) (rad, m)."""

@final
class Centring(Goal):
    """Stays away from the joint limits: minimises the sum of ((q - middle) / range)^2 over the joints that have limits.

    Args:
        weight: weight relative to other goals.
    """

    def __new__(cls, *, weight: float = 1.0) -> Centring: ...

@final
class Manipulability(Goal):
    """Stays away from singularities: minimises -ln w, where w is Yoshikawa's index.

    Args:
        motion: motion of the tip that counts, "pose", "position" or "rotation", as in `Robot.manipulability`.
        tip: the tip, of a robot with several; None: the only one.
        weight: weight relative to other goals.
    """

    def __new__(cls, *, motion: _Motion = "pose", tip: str | None = None, weight: float = 1.0) -> Manipulability: ...

@final
class LinkManipulability(Goal):
    """Keeps the whole arm away from singularities: minimises -ln of the sum of `Robot.link_manipulability`, so that no two
    successive links become collinear.

    Args:
        motion: motion of the link tips that counts, "pose", "position" or "rotation", as in `Robot.manipulability`.
        weight: weight relative to other goals.
    """

    def __new__(cls, *, motion: _Motion = "position", weight: float = 1.0) -> LinkManipulability: ...

@final
class Clearance(Goal):
    """Stays away from obstacles, and links from each other: minimises the sum of ((up_to - d) / up_to)^2 over all pairs of
    bodies whose distance d is below `up_to`. It needs a call with `obstacles=` or `self_collision=True`, whose margin
    holds in addition.

    Args:
        weight: weight relative to other goals.
        up_to: distance beyond which a pair no longer counts (m).
    """

    def __new__(cls, *, weight: float = 1.0, up_to: float = 0.1) -> Clearance: ...
    @property
    def up_to(self) -> float:
        """Distance beyond which a pair no longer counts (m)."""

@final
class LeastTorque(Goal):
    """Holds the arm up with little torque: minimises the sum of (torque / scale)^2 over the joints, with the torques of `Robot.torques(q)`,
    payload and gravity included. It needs a robot with masses (`Robot.has_dynamics`).

    Args:
        relative_to: torque (n,) (N m, N) that the torque of each joint is divided by; inf: the joint does not count. None: the torque limits
            of the robot, `Robot.torque_limit`, so that joints without one do not count; where no joint has one, all count alike. A
            floating base has no motors, and never counts.
        weight: weight relative to other goals.
    """

    def __new__(cls, *, relative_to: ArrayLike | None = None, weight: float = 1.0) -> LeastTorque: ...
    @property
    def relative_to(self) -> _Array | None:
        """Torque (n,) (N m, N) that the torque of each joint is divided by; None: its torque limit."""

# --- inverse kinematics -------------------------------------------------------------------------

def solve(
    robot: Robot,
    target: _Targets,
    *,
    task: _Tasks = None,
    start_q: ArrayLike | None = None,
    solver: _Solver | None = None,
    position_tolerance: _Tolerance = 1e-6,
    rotation_tolerance: _Tolerance = 1e-6,
    goals: _Goals = None,
    prefer: Literal["any", "nearest", "best"] = "any",
    joint_weights: ArrayLike | None = None,
    limits: Limits | None = None,
    obstacles: Iterable[Obstacle] | None = None,
    margin: float | None = None,
    self_collision: bool | None = None,
    stop: Stop | None = None,
    seed: int = 0,
) -> Solution:
    """Finds a configuration that brings the tip of `robot` to `target`, inside the limits.

    Args:
        robot: the arm.
        target: pose (4, 4), or position (3,) (m) with the orientation left free. For a robot with several `tips`, a
            dict from tips to targets, for example {"left_tool": T}; a tip left out is free. The key ("left_tool",
            "right_tool") gives the pose of the second tip in the frame of the first; "center_of_mass" the position (3,) (m)
            of the centre of all masses.
        task: part of the target that counts, one of `tasks`, or a dict for several tips, whose `level` says which come first where
            not all can be met; None: all of it.
        start_q: configuration (n,), a hint: one outside the limits is first brought inside, by whole turns or to the nearest limit.
            For an arm with up to 6 joints, the closed form returns the solution nearest to it; a
            search, or the descent of a redundant arm, begins there. None: the closed form returns the most central
            solution inside the limits, and a search begins at stored configurations of the robot with the tip near the
            target.
        solver: the solver of a search; None: the closed form of the arm for poses, where it has one (`Robot.closed_form`), and
            Levenberg-Marquardt from many starts for everything else.
        position_tolerance: largest position error (m); for several tips also a dict.
        rotation_tolerance: largest rotation error, a geodesic angle (rad); for several tips also a dict.
        goals: one or several of `goals`; the solution is moved along its self-motion to a local optimum of the goals.
        prefer: solution to return.
            "any": the first solution found.
            "nearest": of the solutions found, the one with the smallest |q - start_q| (rad, m). Each is moved along its
            self-motion and by whole turns towards the start; the search ends when 24 in a row are no nearer.
            "best": of the solutions found, the best one for the goals. Each is optimised along its self-motion; the
            search
            ends when 40 in a row are no better. For an arm with one redundant degree of freedom, each solution curve is
            traced once instead, including the parts beyond joint limits.
        joint_weights: cost of moving each joint away from `start_q` (n,), positive; of the solutions, the one with the least sum of
            (weight * (q - start_q))^2 is wanted: a base of weight 100 stays where the arm can do it, and still moves where only
            it can. Of the branches of a closed form, the nearest by this measure is returned; a redundant arm is moved along
            its self-motion to the nearest solution nearby, and prefer="nearest" compares many. Only ratios count, up to
            1e8. It needs start_q, and takes no goals. None: all joints cost the same.
        limits: position limits; None: the robot's.
        obstacles: obstacles of `bik.obstacles`, or a `Scene`, that a solution keeps clear of; an empty list for the robot's own
            links alone. None: nothing is checked.
        margin: least distance from obstacles and between links (m); None: 1 mm.
        self_collision: whether links must keep clear of each other; None: where `obstacles` are given, and for a robot with
            several tips all of whose collision shapes are known.
        stop: budgets; None: a count of evaluations that keeps a 7-joint arm under about 10 ms.
        seed: seed of the random draws; the same seed gives the same bits.

    Returns:
        A `Solution`. If the target is not reached, `status` says why, and `q` is the best configuration found. With
        obstacles, a solution counts as solved only if it is clear by the margin. If none is found, the status is
        IN_COLLISION, and `message` names the two bodies and says whether the hand itself is in the way.

    Raises:
        InvalidInputError: wrong shape, NaN, a target that is not a rigid transform, or obstacles and a robot without bodies.
        LimitError: limits that contradict each other.

    For example:

        >>> robot = bik.Robot.named("ur5e")
        >>> solution = bik.solve(robot, bik.pose([0.4, 0.1, 0.3], rpy=[3.14, 0, 0]))
        >>> solution.status
        <Status.SOLVED: 0>
        >>> solution.q.shape
        (6,)
    """

@final
class Solution:
    """The best configuration found, and the outcome of the search."""

    @property
    def success(self) -> bool:
        """Whether the target was reached within the tolerances."""
    @property
    def status(self) -> Status:
        """Reason why the search ended, a `Status`."""
    @property
    def message(self) -> str:
        """A sentence that says what happened and what to try."""
    @property
    def evaluations(self) -> int:
        """Evaluations of the forward kinematics."""
    @property
    def elapsed(self) -> float:
        """Time taken (s)."""
    @property
    def limits(self) -> Limits:
        """The limits in force."""
    @property
    def q(self) -> _Array:
        """The configuration (n,) (rad, m), inside the limits."""
    @property
    def errors(self) -> dict[_TipKey, tuple[float, float]]:
        """Errors of each target, by the keys of the call or the name of the only tip: {tip: (position (m), rotation (rad))}, as
        `position_error` and `rotation_error`.
        """
    @property
    def position_error(self) -> float:
        """Distance of the tip from the target (m), by forward kinematics of `q`; the largest of several tips."""
    @property
    def rotation_error(self) -> float:
        """Geodesic angle to the target's orientation (rad), the largest of several tips; NaN if the task leaves the orientation free."""
    @property
    def clearance(self) -> float:
        """Smallest distance (m) between the robot and obstacles, or between two of its links; a negative value is the depth of the
        deepest overlap. NaN where nothing is checked; inf if nothing can touch.
        """
    @property
    def nearest(self) -> Nearest | None:
        """The nearest two bodies, a `Nearest`; None where nothing is checked, or if nothing can touch."""
    @property
    def iterations(self) -> int:
        """Iterations over all starts."""
    @property
    def restarts(self) -> int:
        """Restarts after the first start."""

def solve_all(
    robot: Robot,
    target: _Targets,
    *,
    start_q: ArrayLike | None = None,
    limit: int | None = None,
    separation: float | None = None,
    redundancy: int = 16,
    turns: bool = False,
    task: _Tasks = None,
    solver: _Solver | None = None,
    position_tolerance: _Tolerance = 1e-6,
    rotation_tolerance: _Tolerance = 1e-6,
    limits: Limits | None = None,
    obstacles: Iterable[Obstacle] | None = None,
    margin: float | None = None,
    self_collision: bool | None = None,
    stop: Stop | None = None,
    seed: int = 0,
) -> SolutionSet:
    """Returns all solutions of a pose for an arm with a closed form (`Robot.closed_form`); otherwise searches for distinct
    solutions.

    The closed form serves whole poses without a `solver`, weights or region. `SolutionSet.complete` says whether it is
    proven that no solution is missing. A search ends after a hundred known solutions in a row, or when the budget is
    spent.

    Each solution is returned with the whole turns that bring it nearest to the start, or to the middle of the limits if
    no start is given. A redundant arm has infinitely many solutions: a closed form returns those at `redundancy` values
    of its parameter, a search returns some that are at least `separation` apart.

    Args:
        robot: the arm.
        target: pose (4, 4), or position (3,) (m).
        start_q: (n,), a hint as in `solve`; solutions are sorted by |q - start_q| (rad, m). None: they are returned in the order found.
        limit: largest number of solutions to return. None: all of a closed form, 16 of a search.
        separation: two solutions are distinct if some joint differs by at least this much (rad, m), modulo whole turns. None: all of
            a closed form are returned, those of a search differ by 0.1.
        redundancy: number of parameter values at which a redundant arm with a closed form is solved, spread over the
            range that its limits allow. 0: a search is used instead.
        turns: return each solution at all whole turns inside the limits. A joint that is unlimited on a side has infinitely many: it
            stays at the nearest one, and `complete` is False.
        task: part of the target that counts, one of `tasks`; None: all of it.
        solver: the solver of a search; None: the closed form where there is one, and Levenberg-Marquardt from many starts elsewhere.
        position_tolerance: largest position error (m).
        rotation_tolerance: largest rotation error, a geodesic angle (rad).
        limits: position limits; None: the robot's.
        obstacles: obstacles of `bik.obstacles`, or a `Scene`, that a solution keeps clear of; an empty list for the robot's own
            links alone. None: nothing is checked.
        margin: least distance from obstacles and between links (m); None: 1 mm.
        self_collision: whether links must keep clear of each other; None: where `obstacles` are given, and for a robot with
            several tips all of whose collision shapes are known.
        stop: budgets of the whole search; None: as for `solve`. A closed form ignores them.
        seed: seed of the random draws; the same seed gives the same bits.

    Returns:
        A `SolutionSet`. If no solution is found, it is empty, and `miss` is the nearest configuration found.

    Raises:
        InvalidInputError: wrong shape, NaN, a target that is not a rigid transform, or `turns` that make more than 10,000
            configurations; tasks of several tips of different levels, or a task with `first`, which
            all solutions would meet.
        LimitError: limits that contradict each other.

    For example:

        >>> robot = bik.Robot.named("ur5e")
        >>> solutions = bik.solve_all(robot, bik.pose([0.4, 0.1, 0.3], rpy=[3.14, 0, 0]))
        >>> len(solutions), solutions.complete
        (8, True)
    """

def calibrate(
    robot: Robot,
    q: ArrayLike,
    measured: ArrayLike,
    *,
    fit: Sequence[str] | None = None,
    sigma: ArrayLike | None = None,
    robust: bool = True,
    camera: str | None = None,
    board: ArrayLike | None = None,
    lens: ArrayLike | None = None,
    center: ArrayLike | None = None,
    plane: ArrayLike | None = None,
    suggest: int = 0,
    obstacles: Iterable[Obstacle] | None = None,
    margin: float | None = None,
    seed: int = 0,
) -> Calibration:
    """Finds the geometry of a robot as it is built from measurements, by weighted least squares.

    Args:
        robot: the model; its limits decide nothing.
        q: joint angles as the controller reports them (m, n) (rad, m); for distances between two positions (m, 2, n).
        measured: what was measured in each of the m configurations:

            - positions of the tip (m, 3) (m), or poses (m, 4, 4), in any frame, such as a tracker's;
            - with `camera`: poses of a board as the camera sees it (m, 4, 4), or with `board` and `lens` its image points (m, k, 2)
              (pixels), NaN for a point that is not seen;
            - with `center`: distances of the tip from a fixed point (m,) (m), as by a ball bar;
            - with `plane`: heights of the tip above a plane (m,) (m), zero for contacts;
            - with q (m, 2, n): distances between the tip's positions (m,) (m).
        fit: what may differ from the model: "offsets" (the zero of each joint), "links" (the transform before each joint but the first),
            "tool", "base". With a camera, "tool" and "base" mean the poses of camera and board. None: all; with a camera "tool" and
            "base", which is hand-eye calibration.
        sigma: standard deviation of the noise (m or pixels): a number, for poses also of angles (rad) or (length, angle), or one row per measurement, (m,)
            or (m, 2). None: estimated from the residuals.
        robust: whether measurements that do not belong with the others are found and left out.
        camera: "fixed": beside the robot, the board on the tip; "hand": on the tip, the board beside the robot. None: no camera.
        board: points of the board in its own frame (k, 3) (m).
        lens: focal lengths and principal point (fx, fy, cx, cy) (pixels) of a camera without distortion.
        center: fixed end of the ball bar (3,) (m), a guess in the frame of the robot's base.
        plane: (nx, ny, nz, h), a guess: the plane of the points p with n . p = h (m) in the frame of the robot's base.
        suggest: number of further configurations to suggest, those that would tell most (at most 100): inside the limits and, with a
            camera, where it sees the board.
        obstacles: what suggested configurations keep clear of, as the links of the arm keep clear of each other; an empty list checks the
            links alone, None nothing.
        margin: distance to keep (m); None: 0.001.
        seed: seed of the candidates among which they are chosen; the same seed gives the same bits.

    Returns:
        A `Calibration`, whose `robot` is the arm as it is built.

    Raises:
        InvalidInputError: too few measurements, configurations that are all alike, millimetres for metres, degrees for radians, a mirrored
            frame; wrong shape; NaN.
    """

def self_motion(
    robot: Robot,
    target: _Pose | Mapping[str, _Pose],
    *,
    start_q: ArrayLike | None = None,
    spacing: float = 0.05,
    limits: Limits | None = None,
    seed: int = 0,
) -> list[SelfMotion]:
    """Returns the curves of the self-motion: all configurations, inside the limits, that keep the tip at a target.

    The arm must have one joint more than the target constrains: seven joints for a pose, four for a position. With a
    closed form (`Robot.closed_form`), curves are sought at 64 values of its parameter, on every branch; otherwise by
    search. Each curve is followed in short steps past the joint limits and then cut there, so that short parts between
    two limits are found too. Curves that cross those found, as at singular poses, are followed as well, and so is the curve
    through a `start_q` that reaches the target, or through the solution that `solve` finds where there would be none. If
    no curve can be followed through it, it is returned as a curve of one configuration.

    Args:
        robot: the arm.
        target: pose (4, 4), or position (3,) (m).
        start_q: (n,); curves are sorted by their distance from it. None: the longest curve comes first.
        spacing: largest distance |q - q'| of consecutive configurations (rad, m), from 0.001 to 0.5.
        limits: position limits; None: the robot's.
        seed: seed of the random draws of a search; the same seed gives the same bits.

    Returns:
        A list of `SelfMotion`; empty if no configuration is found. Every configuration reaches the target to 2e-9 m and rad.

    Raises:
        InvalidInputError: wrong shape, NaN, or an arm that does not have one joint more than the target constrains.

    For example:

        >>> robot = bik.Robot.named("panda")
        >>> curves = bik.self_motion(robot, robot.fk([0.3, 0.2, -0.4, -1.7, 0.2, 1.9, 0.5]))
        >>> len(curves)
        3
    """

@final
class MapGrid:
    """Poses of a reachability map: cubic voxels, and orientations at the centre of each, numbered from 0.

    `axis` is None, or the point (2,) (m) of a vertical axis; orientations then turn with the azimuth of the voxel about
    this axis.
    """

    def __new__(
        cls,
        robot: Robot,
        *,
        voxel: float,
        directions: int,
        rolls: int,
        region: ArrayLike | None = None,
        task: Task | None = None,
        obstacles: Iterable[Obstacle] | None = None,
        margin: float | None = None,
        self_collision: bool | None = None,
    ) -> MapGrid: ...
    @property
    def origin(self) -> _Array:
        """The lower corner (3,) (m)."""
    @property
    def voxel(self) -> float:
        """Edge of a voxel (m)."""
    @property
    def shape(self) -> list[int]:
        """Number of voxels along x, y and z."""
    @property
    def axis(self) -> _Array | None:
        """Point (2,) (m) of the vertical axis about which orientations turn with the azimuth of the voxel; None without
        one.
        """
    @property
    def orientations(self) -> int:
        """Number of orientations of each voxel."""
    @property
    def rolls(self) -> int:
        """Number of rolls of each direction."""
    @property
    def bytes(self) -> int:
        """Number of bytes that hold a bit for each orientation of a voxel."""
    @property
    def chunk_shape(self) -> list[int]:
        """Largest shape of a chunk; chunks at the upper ends may be smaller."""
    @property
    def chunks(self) -> list[int]:
        """Number of chunks along x, y and z."""
    def chunk(self, number: int) -> list[list[int]]:
        """Returns the first voxel of chunk `number` and the one after its last, along x, y and z. Chunk numbers increase
        along z first.
        """
    def poses(self, voxel: Sequence[int]) -> _Array:
        """Returns the poses (orientations, 4, 4) of the voxel (x, y, z)."""
    def locate(self, T: ArrayLike) -> NDArray[np.int64]:  # noqa: N803
        """Returns the voxel and the nearest orientation of a pose (4, 4), or of each pose (n, 4, 4), as rows (x, y, z,
        orientation): (n, 4), with n = 1 for a single pose; -1 outside the map.
        """
    def __eq__(self, other: object, /) -> bool: ...

def map_chunks(
    robot: Robot,
    grid: MapGrid,
    chunks: Sequence[int],
    *,
    task: Task | None = None,
    obstacles: Iterable[Obstacle] | None = None,
    margin: float | None = None,
    self_collision: bool | None = None,
    evaluations: int = 200,
    quality: bool = False,
    threads: int | None = None,
    progress: _Progress = None,
) -> list[tuple[NDArray[np.uint8], NDArray[np.float32] | None, NDArray[np.float32] | None]]:
    """Computes chunks of the reachability map of a robot. The bits of a chunk depend neither on the other chunks nor on
    the number of threads.

    Args:
        robot, grid: the robot, and the poses of its map.
        chunks: numbers of chunks.
        task, obstacles, margin, self_collision, evaluations, quality, threads, progress: as for `reachability`. The
            first four must be those of the grid.

    Returns:
        (reached, manipulability, clearance) for each chunk: (x, y, z, grid.bytes) uint8, a bit for each orientation,
        the lowest first; then two arrays (x, y, z) float32 for the best configuration found, NaN where there is none,
        or None without `quality`.
    """

@final
class Calibration:
    """The arm as it is built, and the results of the fit. Errors of image points are in pixels, others in m."""

    @property
    def robot(self) -> Robot:
        """The robot with the geometry, base and tool that were found. It keeps joints, limits and collision shapes."""
    @property
    def success(self) -> bool:
        """Whether the descent ended at an optimum."""
    @property
    def message(self) -> str:
        """A sentence that says how good the result is, what is not known, and what to try."""
    @property
    def parameters(self) -> dict[str, float]:
        """Deviations from the model by name, in the order of `covariance` (m, rad): "offset JOINT" is added to the joint's angle; "link
        JOINT x" to "rz" are translation and rotation vector of the correction of the transform before the joint, in the frame of the
        joint; "base x" and so on likewise of base and tool, of camera and board, centre and plane.
        """
    @property
    def deviations(self) -> dict[str, float]:
        """Standard deviations of `parameters` by name (m, rad)."""
    @property
    def covariance(self) -> _Array:
        """Covariance of `parameters` (p, p) (m, rad). Along combinations that the measurements leave open it is that of the prior: how far
        arms usually are from their models.
        """
    @property
    def unit(self) -> str:
        """Unit of the errors: "m", or "pixels" for image points."""
    @property
    def rms_before(self) -> float:
        """Root mean square of the errors of the robot as it was given. All errors leave out `outliers`."""
    @property
    def rms_placed(self) -> float:
        """The same with only base and tool fitted, as far as they are to be."""
    @property
    def rms_after(self) -> float:
        """The same of the calibrated robot."""
    @property
    def rms_held_out(self) -> float:
        """The same of measurements held out one at a time: what to expect of new ones."""
    @property
    def rotation_rms_before(self) -> float:
        """Root mean square of the rotation errors of the robot as it was given (rad); NaN without orientations."""
    @property
    def rotation_rms_after(self) -> float:
        """The same of the calibrated robot (rad)."""
    @property
    def rotation_rms_held_out(self) -> float:
        """The same of measurements held out one at a time (rad)."""
    @property
    def errors_before(self) -> _Array:
        """Error of each measurement (m,) with the robot as it was given."""
    @property
    def errors_after(self) -> _Array:
        """Error of each measurement (m,) with the calibrated robot."""
    @property
    def outliers(self) -> list[int]:
        """Rows of measurements that do not belong with the others and were left out."""
    @property
    def sigma(self) -> tuple[float, float]:
        """Noise of a measurement: as given, for the first row, or estimated from the residuals (length, angle (rad)); the angle is NaN without
        orientations.
        """
    @property
    def identifiable(self) -> Identifiability:
        """Identifiability of the parameters."""
    @property
    def base(self) -> _Array:
        """Pose of the robot's base (4, 4) in the frame of the measurements, for `Robot.with_base`."""
    @property
    def tool(self) -> _Array:
        """Pose of the tool (4, 4) in the frame of the tip link, for `Robot.with_tool`."""
    @property
    def camera(self) -> _Array | None:
        """Pose of the camera (4, 4): in the frame of the robot's base if it is fixed, in that of the tip if it is on the arm; None without."""
    @property
    def board(self) -> _Array | None:
        """Pose of the board (4, 4): in the frame of the tip if the camera is fixed, else in that of the robot's base; None without a camera."""
    @property
    def center(self) -> _Array | None:
        """Centre of the ball bar (3,) (m) in the frame of the robot's base; None without."""
    @property
    def plane(self) -> _Array | None:
        """Plane (nx, ny, nz, h) (4,) in the frame of the robot's base; None without."""
    @property
    def suggested(self) -> _Array:
        """Configurations to measure too, the ones that would tell most (k, n), or (k, 2, n) for distances of pairs (rad, m)."""
    @property
    def iterations(self) -> int:
        """Steps of the descent."""
    def to_urdf(self, path_or_xml: str | os.PathLike[str]) -> str:
        """Returns a URDF with the geometry of `robot`: `path_or_xml`, which the model was loaded from, with the origins of the joints that
        changed, and every other byte as it was. The zero of a joint becomes a part of its origin. No URDF has base and tool: give them to
        the loaded robot by `with_base(c.base)` and `with_tool(c.tool)`.

        Args:
            path_or_xml: the file, or its text.

        Raises:
            UrdfError: the text of another robot, or no URDF.
        """

@final
class Identifiability:
    """Identifiability of the parameters of a calibration."""

    @property
    def rank(self) -> int:
        """Number of independent combinations of parameters that the measurements determine."""
    @property
    def possible(self) -> int:
        """Number that configurations all over the joint ranges would determine. The rest has no effect on such measurements at any
        configuration; of all models that differ in it alone, the one nearest to the given robot is taken.
        """
    @property
    def condition(self) -> float:
        """Largest over smallest singular value of the combinations determined. Below some hundreds the configurations are well chosen."""
    @property
    def singular_values(self) -> _Array:
        """Singular values of the weighted Jacobian (p,), largest first: the usual deviation of a combination over its standard deviation
        here.
        """
    @property
    def unknown(self) -> list[str]:
        """Combinations that the measurements leave open and other configurations would tell, by their main parameters."""

@final
class SelfMotion:
    """A curve of configurations that keep the tip at a target."""

    @property
    def q(self) -> _Array:
        """The configurations (k, n) (rad, m) in order, inside the limits."""
    @property
    def closed(self) -> bool:
        """Whether the last configuration is followed by the first, modulo whole turns of joints without limits."""
    @property
    def lower_cut(self) -> str | None:
        """Name of the joint whose limit ends the curve at its first configuration; None if the curve is closed or not
        followed so far.
        """
    @property
    def upper_cut(self) -> str | None:
        """Name of the joint whose limit ends the curve at its last configuration; None if the curve is closed or not
        followed so far.
        """
    @property
    def complete(self) -> bool:
        """Whether the closed form shows that the call returned every curve: for arms whose parameter is the arm angle, unless curves
        cross, as at singular poses.
        """
    @property
    def length(self) -> float:
        """Length of the curve in joint space (rad, m)."""
    def __len__(self) -> int: ...

@final
class SolutionSet:
    """The distinct solutions for one target, a sequence of `Solution`."""

    @property
    def success(self) -> bool:
        """Whether a solution was found."""
    @property
    def status(self) -> Status:
        """SOLVED if a solution was found; otherwise the reason why the last search ended."""
    @property
    def message(self) -> str:
        """A sentence that says what happened and what to try."""
    @property
    def evaluations(self) -> int:
        """Evaluations of the forward kinematics."""
    @property
    def elapsed(self) -> float:
        """Time taken (s)."""
    @property
    def limits(self) -> Limits:
        """The limits in force."""
    @property
    def q(self) -> _Array:
        """The configurations (k, n) (rad, m), inside the limits."""
    @property
    def complete(self) -> bool:
        """Whether it is proven that no other solution exists inside the limits, whole turns aside; False after a search,
        where `limit` or `separation` left solutions out, beside singular poses, for tolerances above 1e-5, and with `turns` for
        an arm with an unlimited joint.
        """
    @property
    def singular(self) -> bool:
        """Whether the pose is singular: at least one solution then represents a family in which a joint is free."""
    @property
    def miss(self) -> Solution | None:
        """Nearest `Solution` that misses the target, if no solution was found; otherwise None. For a target proven out of
        reach, it is computed at the first access.
        """
    def __len__(self) -> int: ...
    @overload
    def __getitem__(self, index: int | np.integer, /) -> Solution: ...
    @overload
    def __getitem__(self, index: _Several, /) -> list[Solution]: ...
    def __iter__(self) -> Iterator[Solution]: ...

def _batch_message(counts: Sequence[int]) -> str:
    """Returns the message of a batch in which `counts[status]` targets ended with `status`."""

def solve_batch(
    robot: Robot,
    targets: _Targets,
    *,
    start_q: ArrayLike | None = None,
    first_row: int = 0,
    threads: int | None = None,
    on_invalid: Literal["raise", "skip"] = "raise",
    progress: _Progress = None,
    task: _Tasks = None,
    solver: _Solver | None = None,
    position_tolerance: _Tolerance = 1e-6,
    rotation_tolerance: _Tolerance = 1e-6,
    goals: _Goals = None,
    prefer: Literal["any", "nearest", "best"] = "any",
    joint_weights: ArrayLike | None = None,
    limits: Limits | None = None,
    obstacles: Iterable[Obstacle] | None = None,
    margin: float | None = None,
    self_collision: bool | None = None,
    stop: Stop | None = None,
    seed: int = 0,
) -> BatchSolution:
    """Solves many targets at once, on all cores.

    The result is bit-identical for any number of threads. An item does not depend on the items after it, and item 0 equals
    the result of `solve`.

    Args:
        robot: the arm.
        targets: poses (m, 4, 4), or positions (m, 3) (m) with the orientations left free; for a robot with several
            tips, a dict of targets as for `solve`.
        start_q: the start of each target, (m, n), or (n,) for all, as in `solve`.
        first_row: row of the first of these targets in a larger batch. `solve_batch(robot, targets[k:], first_row=k)`
            gives the rows of `solve_batch(robot, targets)` from k on, to the bit, and errors name the rows of the
            larger batch.
        threads: number of threads; None: one per core. With 1, everything runs in the calling thread.
        on_invalid: treatment of an invalid target or start. "raise": raises an error that names the row; "skip": solves
            the other rows and marks this row `Status.INVALID`, with q NaN.
        progress: True shows a progress bar; a callable is called with (done, total).
        task: as for `solve`.
        solver: the solver of a search; None: the closed form of the arm for poses, where it has one (`Robot.closed_form`), and
            Levenberg-Marquardt from many starts for everything else.
        position_tolerance: largest position error (m).
        rotation_tolerance: largest rotation error, a geodesic angle (rad).
        goals, prefer, joint_weights: as for `solve`; the weights need `start_q`.
        limits: position limits; None: the robot's.
        obstacles, margin, self_collision: as for `solve`.
        stop: budgets of each target; None: as for `solve`.
        seed: seed of the random draws; the same seed gives the same bits.

    Returns:
        A `BatchSolution`. If a target is not reached, its status says why, and its q is the best configuration found.

    Raises:
        InvalidInputError: wrong shape; NaN, or a target that is not a rigid transform (names the row).
        LimitError: limits that contradict each other.

    For example:

        >>> robot = bik.Robot.named("ur5e")
        >>> targets = robot.fk(robot.random_configurations(100, seed=1))
        >>> batch = bik.solve_batch(robot, targets)
        >>> batch.q.shape, int(batch.success.sum())
        ((100, 6), 100)
    """

@final
class BatchSolution:
    """Solutions in the order of the targets, stored as columns. `b[i]` is a `Solution`; `b[10:20]` and `b[~b.success]` are
    batches.
    """

    @property
    def q(self) -> _Array:
        """The best configurations found (m, n) (rad, m), inside the limits; NaN in rows whose `status` is INVALID."""
    @property
    def success(self) -> NDArray[np.bool_]:
        """Whether each target was reached within the tolerances (m,)."""
    @property
    def status(self) -> NDArray[np.uint8]:
        """Reason why each search ended (m,), values of `Status`."""
    @property
    def message(self) -> str:
        """Number of solved targets, and advice on the others."""
    @property
    def errors(self) -> dict[_TipKey, tuple[_Array, _Array]]:
        """Errors of each target, by the keys of the call or the name of the only tip: {tip: (position (m,) (m), rotation (m,) (rad))}."""
    @property
    def position_error(self) -> _Array:
        """Distances of the tip from the targets (m,) (m), by forward kinematics of `q`; the largest of several tips."""
    @property
    def rotation_error(self) -> _Array:
        """Geodesic angles to the targets' orientations (m,) (rad), the largest of several tips; NaN if the task leaves the orientation free."""
    @property
    def clearance(self) -> _Array:
        """Smallest distances to obstacles or between links (m,) (m), as in `Solution.clearance`."""
    @property
    def iterations(self) -> NDArray[np.int64]:
        """Iterations over all starts (m,)."""
    @property
    def restarts(self) -> NDArray[np.int64]:
        """Restarts after the first start (m,)."""
    @property
    def evaluations(self) -> NDArray[np.int64]:
        """Evaluations of the forward kinematics (m,)."""
    @property
    def elapsed(self) -> float:
        """Total time (s)."""
    @property
    def limits(self) -> Limits:
        """The limits in force."""
    def __len__(self) -> int: ...
    @overload
    def __getitem__(self, index: int | np.integer, /) -> Solution: ...
    @overload
    def __getitem__(self, index: _Several, /) -> BatchSolution: ...
    def __iter__(self) -> Iterator[Solution]: ...

# --- minimisation of any function ----------------------------------------------------------------

def minimize(
    function: Callable[[_Array], Any],
    lower: ArrayLike,
    upper: ArrayLike,
    *,
    solver: _DerivativeFree | MultiStart | None = None,
    start: ArrayLike | None = None,
    stop: Stop | None = None,
    seed: int = 0,
    vectorized: bool = False,
    progress: _Progress = None,
) -> Minimum:
    """Minimises a function over a box by a derivative-free solver.

    Args:
        function: takes x (n,) and returns a number; NaN and infinities count as the worst value.
        lower: (n,), finite.
        upper: (n,), finite.
        solver: a derivative-free solver, for example `PSO`, or `MultiStart` of one; None: `DifferentialEvolution()`.
            BAS suits few functions, whose minimum must be zero: see `BAS`.
        start: (n,), first point; None: drawn at random. Swarms include it in the first generation.
        stop: budgets; None: 30000 evaluations. `Stop(value_below=...)` sets a target value.
        seed: seed of the random draws; the same seed gives the same bits.
        vectorized: whether the function takes whole generations (m, n) and returns (m,).
        progress: True shows a progress bar; a callable is called with (done, total) evaluations.

    Returns:
        A `Minimum`; its `success` is True only if a target value was given and reached.

    Raises:
        InvalidInputError: wrong shape, an infinite or empty box, a start outside it, a population larger than the budget, or
            a function that does not return numbers.

    For example:

        >>> minimum = bik.minimize(lambda x: (x[0] - 1) ** 2 + x[1] ** 2, [-5, -5], [5, 5])
        >>> minimum.value < 1e-12
        True

    Exceptions of the function and KeyboardInterrupt propagate unchanged. Their attribute `best` holds the best point so far,
    a `Minimum`, and a note on the exception says so.
    """

@final
class Minimum:
    """The best point found by `minimize`, and the outcome of the search."""

    @property
    def success(self) -> bool:
        """Whether the value is below that of `Stop(value_below=...)`; False if none was given."""
    @property
    def status(self) -> Status:
        """SOLVED on `success`; STALLED if the solver's own rule ended the search; BUDGET_SPENT, TIME_UP or INTERRUPTED."""
    @property
    def message(self) -> str:
        """A sentence that says what happened and what to try."""
    @property
    def evaluations(self) -> int:
        """Evaluations of the function."""
    @property
    def elapsed(self) -> float:
        """Time taken (s)."""
    @property
    def limits(self) -> Limits:
        """The box, given by `lower` and `upper`."""
    @property
    def x(self) -> _Array:
        """The point (n,), inside the box."""
    @property
    def value(self) -> float:
        """The function's value at `x`; inf if no value was finite."""
    @property
    def history(self) -> _Array:
        """Progress of the search (k, 2): number of evaluations, best value so far. One row for the start, one for each
        improvement and one for the end.
        """
    @property
    def iterations(self) -> int:
        """Iterations over all starts: generations of swarms, passes of BAS."""
    @property
    def restarts(self) -> int:
        """Restarts after the first start."""

# --- postures -----------------------------------------------------------------------------------

@final
class CircleSwarm:
    """The particle swarm of "Trajectory tracking of redundant manipulator based on PSO algorithm optimization": particles
    are joint positions on circles; with a constriction factor (eq. 17, 18).

    Args:
        population: number of particles.
        generations: number of generations, the initial one included.
        c1, c2: attraction to the particle's own best point and to the swarm's; their sum must be above 4.
        velocity_limit: largest velocity of a coordinate (m per generation); the paper does not give one.
        signed: draw random factors from [-1, 1], as printed, instead of [0, 1].
    """

    def __new__(
        cls,
        *,
        population: int = 5,
        generations: int = 10,
        c1: float = 2.05,
        c2: float = 2.05,
        velocity_limit: float = 0.2,
        signed: bool = False,
    ) -> CircleSwarm: ...
    @property
    def population(self) -> int:
        """Number of particles."""
    @property
    def generations(self) -> int:
        """Number of generations, the initial one included."""
    @property
    def c1(self) -> float:
        """Attraction to the particle's own best point."""
    @property
    def c2(self) -> float:
        """Attraction to the swarm's best point."""
    @property
    def velocity_limit(self) -> float:
        """Largest velocity of a coordinate (m per generation)."""
    @property
    def signed(self) -> bool:
        """Whether random factors are drawn from [-1, 1]."""
    def __getnewargs_ex__(self) -> tuple[tuple[Any, ...], dict[str, Any]]: ...

def planar_posture(
    robot: Robot,
    target: ArrayLike,
    *,
    measure: Literal["tip", "overall"] = "tip",
    region: ArrayLike | None = None,
    swarm: CircleSwarm | None = None,
    seed: int = 0,
) -> PlanarPosture:
    """Finds the posture of a planar arm with the best manipulability for a tip position: the global optimum.

    For other arms, and for poses, use `solve(robot, target, goals=goals.Manipulability(...), prefer="best")`.

    Args:
        robot: an arm of 3 or more revolute joints about z in one plane, for example `Robot.planar([...])`.
        target: position of the tip (3,) (m).
        measure: "tip": Yoshikawa's index of the tip; "overall": the sum of the indices of all links.
        region: (2, 2) (m), lower and upper corner (x, y) of a rectangle for the joint positions; None: no restriction.
        swarm: a `CircleSwarm`, the published search; None: differential evolution over the link directions.
        seed: seed of the random draws; the same seed gives the same bits.

    Returns:
        A `PlanarPosture`. A target out of reach is a status, not an error.

    Raises:
        InvalidInputError: an arm that is not planar or has fewer than 3 links; wrong shape; NaN.
    """

@final
class PlanarPosture:
    """The best posture of a planar arm for a tip position."""

    @property
    def success(self) -> bool:
        """Whether a posture was found."""
    @property
    def status(self) -> Status:
        """Reason why the search ended, a `Status`."""
    @property
    def message(self) -> str:
        """A sentence that says what happened and what to try."""
    @property
    def evaluations(self) -> int:
        """Number of postures evaluated."""
    @property
    def elapsed(self) -> float:
        """Time taken (s)."""
    @property
    def limits(self) -> Limits:
        """The limits in force: the robot's."""
    @property
    def q(self) -> _Array:
        """The configuration (n,) (rad). If no posture was found, the configuration that brings the tip nearest to the
        target.
        """
    @property
    def index(self) -> float:
        """Manipulability of the posture: `Robot.manipulability(q, motion="position")`, or for measure "overall" the sum of
        `Robot.link_manipulability(q)`. NaN if no posture was found.
        """
    @property
    def history(self) -> _Array:
        """The best index after each generation of a `CircleSwarm` (generations,); empty for the default search."""
    @property
    def position_error(self) -> float:
        """Distance of the tip from the target (m)."""

# --- reference paths (public as beetle_ik.paths) ------------------------------------------------

@final
class Path:
    """A reference path of the tip: position, and optionally orientation, for each time in [0, duration]. Times outside are
    clamped.
    """

    @property
    def duration(self) -> float:
        """Duration (s)."""
    def position(self, t: ArrayLike) -> _Array:
        """Returns the position (m): (3,) for a number t (s), (k, 3) for t (k,)."""
    def velocity(self, t: ArrayLike) -> _Array:
        """Returns the velocity (m/s): (3,) for a number t (s), (k, 3) for t (k,). Velocities of Python functions are
        central differences.
        """
    def pose(self, t: ArrayLike) -> _Array:
        """Returns the pose: (4, 4) for a number t (s), (k, 4, 4) for t (k,). The path must have an orientation."""
    def sample(self, dt: float) -> tuple[_Array, _Array]:
        """Returns the times (k,) (s) from 0 in steps of `dt`, and the positions (k, 3) (m): the samples that a tracker follows."""
    def with_orientation(self, orientation: _Pose | Callable[[float], _Pose]) -> Path:
        """Returns a copy with an orientation: a rotation matrix (3, 3), or a callable of t (s) that returns one."""

def circle(
    center: ArrayLike, diameter: float, duration: float, *, a: ArrayLike = (1, 0, 0), b: ArrayLike = (0, 1, 0)
) -> Path:
    """A circle around `center` (3,) (m), traversed once in `duration` (s), from the direction `a` towards `b`: eq. (14) of
    Cheng et al. (2020). `a` and `b` (3,) are orthonormal vectors in its plane.
    """

def letter_m(
    center: ArrayLike,
    duration: float,
    *,
    width: float,
    height: float,
    a: ArrayLike = (0, 1, 0),
    b: ArrayLike = (0, 0, 1),
) -> Path:
    """The letter M around `center` (3,), `width` along `a` and `height` along `b` (m). Its four segments take equal times
    (Khan et al. 2022).
    """

def hypotrochoid(
    center: ArrayLike,
    duration: float,
    *,
    outer_radius: float,
    inner_radius: float,
    distance: float,
    a: ArrayLike = (0, 1, 0),
    b: ArrayLike = (0, 0, 1),
) -> Path:
    """A hypotrochoid around `center` (3,): the path of a point at `distance` (m) from the centre of a circle that rolls inside
    another. Eq. (20) of Khan et al. (2022), corrected. The ratio of the radii must be a ratio of small integers.
    """

def pentagram(
    center: ArrayLike, duration: float, *, radius: float, a: ArrayLike = (1, 0, 0), b: ArrayLike = (0, 1, 0)
) -> Path:
    """A five-pointed star around `center` (3,), with its points at `radius` (m): five segments at constant speed, starting at
    the point in direction `b`.
    """

def rose(
    center: ArrayLike,
    duration: float,
    *,
    radius: float,
    k: int,
    a: ArrayLike = (1, 0, 0),
    b: ArrayLike = (0, 1, 0),
) -> Path:
    """A rose around `center` (3,): at angle u its radius is radius cos(k u) (m). Odd k gives k petals, even k gives 2 k."""

def polyline(points: ArrayLike, duration: float) -> Path:
    """Straight segments through `points` (k, 3) (m) at constant speed, in `duration` (s)."""

def from_samples(time: ArrayLike, positions_or_poses: _Pose) -> Path:
    """A path through samples: `time` (k,) (s) from 0, and positions (k, 3) (m) or poses (k, 4, 4). Positions are interpolated
    linearly, rotations along the shortest rotation.
    """

def from_function(function: Callable[[float], ArrayLike], duration: float) -> Path:
    """A path given by `function(t)`, which returns a position (3,) (m) for t (s) in [0, duration]. Trackers sample it at the
    times of their ticks before they run.
    """

# --- tracking -----------------------------------------------------------------------------------

def track(
    robot: Robot,
    path: _Paths,
    start_q: ArrayLike | None = None,
    *,
    dt: float,
    task: _Tasks = None,
    solver: _Solver | WeightedPseudoInverse | None = None,
    limits: Limits | None = None,
    goals: _Goals = None,
    joint_weights: ArrayLike | None = None,
    position_tolerance: _Tolerance = 1e-6,
    rotation_tolerance: _Tolerance = 1e-6,
    obstacles: Iterable[Obstacle] | None = None,
    margin: float | None = None,
    self_collision: bool | None = None,
    keep: Keep | Sequence[Keep] | None = None,
    seed: int = 0,
    limit_at: Literal["interval", "start"] = "interval",
    ease: bool = False,
    recover: bool = True,
    start_slack: ArrayLike | None = None,
    progress: _Progress = None,
) -> TrackResult:
    """Follows a path with the tip of the robot, tick by tick, inside the limits.

    In each tick the joints stay in a box: the position limits, and the range that the velocity limits allow from the
    last accepted configuration. So neither limit can be violated (Cheng et al. 2020, Algorithm 1). Acceleration limits
    reduce the box further, so that joints can still brake before their position limits; the arm starts at rest.

    Args:
        robot: the arm.
        path: reference positions or poses over time. For a robot with several `tips`, a dict of paths of equal
            duration, for example {"left_tool": path}; a constant pose (4, 4) or position (3,) counts as a path, and a
            tip left out is free. The key ("left_tool", "right_tool") gives the second tip in the frame of the first.
            This relative pose has priority, so that both arms lag where one cannot follow.
        start_q: (n,), configuration at t = 0; None: a solution for the first point of the path, the best one for the goals
            or, without goals, one far from singularities and limits.
        dt: time step (s).
        task: part of the path that counts, one of `tasks`, or a dict for several tips; None: all of it.
        solver: a solver or `WeightedPseudoInverse`, which runs in each tick; None: the model-based rule, which needs one or
            two evaluations per step.
        limits: limits on the joint motion; None: the robot's. Each joint needs a velocity, acceleration or jerk limit;
            `Limits(velocity=np.inf)` says that jumps are meant. Torque limits need acceleration limits, as in `Tracker`.
        goals: one or several of `goals`; each tick moves down their gradient in the null space of the task, by weight times
            dt. They need the model-based rule or `WeightedPseudoInverse`.
        joint_weights: cost of moving each joint (n,), positive: each tick follows the path with the least sum of (weight * dq)^2, so
            that a base of weight 100 stays where the arm can do it, and still moves where only it can. Only ratios count, up to
            1e8. They need the model-based rule. None: all joints cost the same.
        position_tolerance: error band of positions (m); for several tips also a dict.
        rotation_tolerance: error band of orientations (rad); for several tips also a dict.
        obstacles: obstacles of `bik.obstacles`, or a `Scene`, that the arm keeps clear of, between ticks too; an empty list for the
            robot's own links alone. Each command is certified together with the stop that follows it: the arm slides along, waits
            or stops. None: nothing is checked.
        margin: least distance from obstacles and between links (m); None: 1 mm.
        self_collision: whether links must keep clear of each other; None: where `obstacles` are given, and for a robot with
            several tips all of whose collision shapes are known.
        keep: a `Keep`, for example from `upright`, or several: constraints at every instant, between ticks too, and during the stop after
            each. The arm goes as near to the path as that allows. None: nothing.
        seed: seed of the random draws; the same seed gives the same bits.
        limit_at: velocity limit that holds in a tick: the smallest over its "interval" or, as in the paper, the limit
            at its "start".
        start_slack: how far start_q may be outside the position limits (rad, m), a number or (n,); the arm then begins there and is led
            inside within its limits, see `TrackResult.start_outside`. None: 5 degrees, 5 mm for joints that slide.
        ease: under acceleration or jerk limits, begin with an approach: the quickest motion from rest within the limits
            that meets the moving path, after which the arm is on it. The tip is off the path until then.
        recover: whether an arm that comes no nearer to the path, at a joint limit or in a singular configuration, goes to a
            configuration on it if one is known, as in `Tracker`.
        progress: True shows a progress bar; a callable is called with (done, total).

    Returns:
        A `TrackResult`. If the path cannot be followed, its status says why; that is not an error.

    Raises:
        InvalidInputError: wrong shape, NaN, a time step that is not positive, a joint that no limit slows down, or a start at which
            something in keep does not hold.
        LimitError: a start farther outside its limits than start_slack, or a negative limit.
        UnsupportedLimit: acceleration or jerk limits, or position limits that vary in time, with a task that has a
            region; position, acceleration or jerk limits that vary in time, among obstacles or with keep.

    For example:

        >>> robot = bik.Robot.named("ur5e")
        >>> path = bik.paths.circle([0.5, 0.1, 0.4], 0.2, 5.0)
        >>> track = bik.track(robot, path, dt=0.01)
        >>> track.status
        <Status.SOLVED: 0>
        >>> track.q.shape
        (501, 6)
    """

@final
class TrackResult:
    """The record of a track, k = steps + 1 rows: row 0 is the start at t = 0, row i the tick that ends at t_i = i dt."""

    @property
    def success(self) -> bool:
        """Whether the tip reached the error band and stayed there."""
    @property
    def status(self) -> Status:
        """SOLVED on `success`; LOST if the tip left its band again; otherwise the status of the last step."""
    @property
    def message(self) -> str:
        """A sentence that says what happened and what to try."""
    @property
    def evaluations(self) -> int:
        """Total number of evaluations of the forward kinematics."""
    @property
    def elapsed(self) -> float:
        """Time taken (s)."""
    @property
    def limits(self) -> Limits:
        """The limits in force."""
    @property
    def time(self) -> _Array:
        """Times (k,) (s)."""
    @property
    def q(self) -> _Array:
        """Configurations (k, n) (rad, m)."""
    @property
    def qd(self) -> _Array:
        """Velocities (k, n) (rad/s, m/s): (q_i - q_{i-1}) / dt, zero in row 0."""
    @property
    def clearance(self) -> _Array:
        """Smallest distances from obstacles and between links (k,) (m); NaN where nothing is checked."""
    @property
    def velocity_limit(self) -> _Array:
        """Velocity limits in force in each tick (k, n); NaN in row 0, inf for none."""
    @property
    def position(self) -> _Array:
        """Positions of the tip (k, 3) (m); with several tips, of the first target: `positions` has all."""
    @property
    def reference(self) -> _Array:
        """Reference positions (k, 3) (m)."""
    @property
    def position_error(self) -> _Array:
        """Distances between tip and reference (k,) (m)."""
    @property
    def rotation_error(self) -> _Array:
        """Angles to the reference orientations (k,) (rad); NaN if the orientation is left free."""
    @property
    def position_tolerance(self) -> float:
        """The error band (m)."""
    @property
    def rotation_tolerance(self) -> float:
        """The error band of orientations (rad)."""
    @property
    def step_status(self) -> NDArray[np.uint8]:
        """Status of each step (k,), values of `Status`: SOLVED inside the band, IMPROVED nearer than in the previous step,
        otherwise CAPPED.
        """
    @property
    def step_evaluations(self) -> NDArray[np.int64]:
        """Evaluations of the forward kinematics in each step (k,)."""
    @property
    def step_iterations(self) -> NDArray[np.int64]:
        """Iterations in each step (k,): passes of BAS, steps of Levenberg-Marquardt."""
    @property
    def max_violation(self) -> float:
        """Largest excess of a displacement over velocity limit times dt, or of a position over its limit (rad, m); 0 within
        rounding.
        """
    @property
    def errors(self) -> dict[_TipKey, tuple[_Array, _Array]]:
        """Errors of each target, by the keys of the call or the name of the only tip: {tip: (position (k,) (m), rotation (k,) (rad))};
        `position_error` and `rotation_error` are the largest.
        """
    @property
    def positions(self) -> dict[_TipKey, _Array]:
        """Positions of each target's tip, by the keys of the call or the name of the only tip: {tip: (k, 3) (m)}; for a
        pair, in the frame of its first tip.
        """
    @property
    def references(self) -> dict[_TipKey, _Array]:
        """Reference positions of each target, in the form of `positions`."""
    @property
    def start_outside(self) -> list[tuple[str, float, float]]:
        """Joints that began outside their position limits and were led inside, each (joint, value, limit) (rad, m)."""
    @property
    def limit_margin(self) -> float:
        """Smallest margin between a joint speed and its limit (rad/s, m/s); inf without limits."""
    @property
    def robot(self) -> Robot:
        """The robot."""
    @property
    def trajectory(self) -> Trajectory:
        """The joint trajectory. Without acceleration and jerk limits it is linear between the ticks, with the velocities
        `qd`. With them it is a cubic spline that keeps them at every instant; it passes each configuration at a
        distance of a sixth of its acceleration times dt^2 (rad, m).
        """
    def plot(self) -> Figure:
        """Draws the path of the tip, the errors, joint positions, velocities with their limits, and evaluations; returns a
        matplotlib figure.
        """
    def __len__(self) -> int: ...

@final
class LowPass:
    """First-order low-pass for the targets of a `Tracker`, for positions and orientations.

    A target that moves steadily is delayed by 1 / (2 pi cutoff): 32 ms at 5 Hz.

    Args:
        cutoff: cutoff (Hz).
    """

    def __new__(cls, cutoff: float) -> LowPass: ...
    @property
    def cutoff(self) -> float:
        """Cutoff (Hz)."""
    def __getnewargs_ex__(self) -> tuple[tuple[Any, ...], dict[str, Any]]: ...

@final
class OneEuro:
    """One-euro filter for the targets of a `Tracker`, for positions and orientations: a low-pass whose cutoff rises with the
    speed of the target (Casiez, Roussel and Vogel 2012).

    A target that moves steadily at speed v is delayed by 1 / (2 pi (min_cutoff + beta v)).

    Args:
        min_cutoff: cutoff at rest (Hz).
        beta: increase of the cutoff with speed: Hz per m/s for positions, Hz per rad/s for orientations.
    """

    def __new__(cls, *, min_cutoff: float = 1.0, beta: float = 10.0) -> OneEuro: ...
    @property
    def min_cutoff(self) -> float:
        """Cutoff at rest (Hz)."""
    @property
    def beta(self) -> float:
        """Increase of the cutoff with speed (Hz per m/s, Hz per rad/s)."""
    def __getnewargs_ex__(self) -> tuple[tuple[Any, ...], dict[str, Any]]: ...

@final
class Tracker:
    """Tracks targets that arrive one at a time, one call per tick, otherwise like `track`.

    A target may jump farther than one tick can reach: the model-based rule moves all joints in proportion, with one at a
    limit. Under acceleration or jerk limits every command leaves a full stop inside all limits, the arm brakes in time, and
    noise of the targets is recognised and not followed; a smooth target without noise is followed without lag.

    Args:
        robot: the arm.
        start_q: (n,), configuration at t = 0.
        dt: time step (s).
        task: as in `track`; it may also name tips that get their targets later.
        solver: a solver or `WeightedPseudoInverse`, which runs in each step; None: the model-based rule.
        limits: numbers and `Sinusoid`s; None: the robot's. Each joint needs a velocity, acceleration or jerk limit;
            `Limits(velocity=np.inf)` says that jumps are meant. Callables cannot be used: there is no end time up to which to
            sample them. With `torque`, which needs acceleration limits, a command is sent only if it and the stop after it are within the
            torques at every tick, with what the arm carries; see `Tracker.robot`.
        goals, joint_weights: as in `track`.
        position_tolerance: largest position error (m); for several tips also a dict.
        rotation_tolerance: largest rotation error (rad); for several tips also a dict.
        obstacles, margin, self_collision: as in `track`; obstacles may also be `obstacles.Moving`, and may be replaced between
            ticks: `tracker.obstacles = [...]`.
        keep: a `Keep`, for example from `upright`, or several, as in `track`. The stop after each command keeps them too.
        seed: seed of the random draws.
        limit_at: as in `track`.
        target_filter: `filters.OneEuro` or `filters.LowPass`, applied to the targets as they arrive; None: none.
        timeout: time without a new target after which the arm stops (s); None: never.
        start_slack: how far start_q, and q of `reset`, may be outside the position limits (rad, m), a number or (n,); the arm then begins
            there and is led inside within its limits, see `Tracker.start_outside`. None: 5 degrees, 5 mm for joints that slide.
            Rounding is taken off in any case.
        recover: whether an arm that comes no nearer to its target, at a joint limit or in a singular configuration, goes to a
            configuration on the target if one is known: by a motion of the joints inside all limits and, with obstacles, along
            a clear line. It is for the model-based rule, and tasks without a region. False: the arm stays, and `message` says so.

    For example:

        >>> robot = bik.Robot.named("ur5e")
        >>> tracker = bik.Tracker(robot, [0.0, -1.5, 1.5, -1.5, -1.5, 0.0], dt=0.01)
        >>> step = tracker.step([0.45, 0.13, 0.47])
        >>> step.q.shape, step.inside_limits
        ((6,), True)
    """

    def __new__(
        cls,
        robot: Robot,
        start_q: ArrayLike,
        *,
        dt: float,
        task: _Tasks = None,
        solver: _Solver | WeightedPseudoInverse | None = None,
        limits: Limits | None = None,
        goals: _Goals = None,
        joint_weights: ArrayLike | None = None,
        position_tolerance: _Tolerance = 1e-6,
        rotation_tolerance: _Tolerance = 1e-6,
        obstacles: Iterable[Obstacle | Moving] | None = None,
        margin: float | None = None,
        self_collision: bool | None = None,
        keep: Keep | Sequence[Keep] | None = None,
        seed: int = 0,
        limit_at: Literal["interval", "start"] = "interval",
        target_filter: LowPass | OneEuro | None = None,
        timeout: float | None = None,
        start_slack: ArrayLike | None = None,
        recover: bool = True,
    ) -> Tracker: ...
    def step(self, target: _Targets | None, *, velocity: ArrayLike | None = None, stamp: float | None = None) -> Step:
        """Moves the arm by one tick towards `target`, a pose (4, 4) or a position (3,) (m), inside the limits. For a robot
        with several `tips`, `target` is a dict, for example {"left_tool": T}; a tip left out is free. The key
        ("left_tool", "right_tool") gives the second tip in the frame of the first, "center_of_mass" is the centre of
        all masses. A pair that has reached its target is held there, with priority over all other targets.

        Targets may come more rarely than ticks: `step(None)` means that there is no new target. Under acceleration or
        jerk limits the model-based rule then follows the motion of the last targets, for two of their intervals at
        most, and stops smoothly; otherwise the arm goes on towards the last target. A loop may also pass the last
        target again in each tick until the next one comes: in a stream of 10 Hz or more, a repeated target counts as
        None for two intervals. A target that is not finite raises an error and leaves the tracker unchanged. A rotation that
        has drifted, R'R by up to 0.25 from the identity, is taken as the nearest rotation, and the message of the first such
        step says so.

        Args:
            target: target of the tip, or of several tips, at the end of the tick; None: no new target.
            velocity: (3,) (m/s), velocity of the target at the end of the tick, which only `WeightedPseudoInverse` uses;
                None: from the difference to the previous target.
            stamp: time at which the target was measured, on the tracker's own clock, `time` (s); None: the end of the
                tick. The model-based rule follows the motion of the targets up to now, over 0.25 s at most, under
                acceleration or jerk limits; without these a stamp is refused. A target whose stamp is not after the last
                one is ignored; the message says so, and the step is solved only if the arm meets this target as well.
        """
    def stop(self) -> float:
        """Starts the stop, as fast as the limits allow: each following `step(None)` is a tick of it, until a target
        arrives. Held pairs of tips stay held. The stop is the one that was certified with the last command: the arm
        does not give way to moving obstacles, and stays at rest afterwards.

        Returns:
            Duration of the stop (s), to within a tick; 0 without acceleration and jerk limits.
        """
    @property
    def start_outside(self) -> list[tuple[str, float, float]]:
        """Joints that began outside their position limits, each (joint, value, limit) (rad, m); empty once all are inside."""
    @property
    def keep(self) -> tuple[Keep, ...]:
        """Constraints at every instant, a tuple of `Keep`."""
    @property
    def obstacles(self) -> tuple[Obstacle | Moving, ...] | None:
        """Obstacles that the arm keeps clear of, a tuple; None: no check. Assign their present positions between ticks. If
        new obstacles are in the way, the arm carries on with the stop certified before.
        """
    @obstacles.setter
    def obstacles(self, value: Iterable[Obstacle | Moving] | None) -> None:
        """Obstacles that the arm keeps clear of, a tuple; None: no check. Assign their present positions between ticks. If
        new obstacles are in the way, the arm carries on with the stop certified before.
        """
    def reset(self, q: ArrayLike, qd: ArrayLike | None = None, qdd: ArrayLike | None = None) -> None:
        """Resets to q (n,) and t = 0, at rest or in motion. Like the start, q may be outside the position limits by `start_slack`.

        Args:
            q: configuration (n,) (rad, m).
            qd: velocities (n,) (rad/s, m/s): (q - q before) / dt; None: zero.
            qdd: accelerations (n,) (rad/s^2, m/s^2): differences of these velocities / dt; None: zero.
        """
    @property
    def q(self) -> _Array:
        """The last accepted configuration (n,) (rad, m)."""
    @property
    def time(self) -> float:
        """Time of the last accepted configuration (s)."""
    @property
    def dt(self) -> float:
        """Time step (s)."""
    @property
    def robot(self) -> Robot:
        """The robot. Assign it with another payload, other masses or another gravity when what it carries changes:
        `tracker.robot = robot.with_payload(2.0)`. The next command and its stop are checked with these. If the present motion is then beyond a
        torque limit, the arm brakes as well as it can, and the status is HELD_BY_TORQUE. A robot that differs in anything else is refused.
        """
    @robot.setter
    def robot(self, value: Robot) -> None:
        """The robot. Assign it with another payload, other masses or another gravity when what it carries changes:
        `tracker.robot = robot.with_payload(2.0)`. The next command and its stop are checked with these. If the present motion is then beyond a
        torque limit, the arm brakes as well as it can, and the status is HELD_BY_TORQUE. A robot that differs in anything else is refused.
        """
    @property
    def limits(self) -> Limits:
        """The limits in force."""

@final
class Step:
    """The result of one step of a `Tracker` or a `ControlSession`."""

    @property
    def success(self) -> bool:
        """Whether the tip is within the tolerances."""
    @property
    def status(self) -> Status:
        """SOLVED within the tolerances; IN_COLLISION nearer than the margin to an obstacle or between links;
        HELD_BY_OBSTACLE if an obstacle keeps the tip from the target; HELD_BY_CONSTRAINT if what is to be kept does;
        HELD_BY_TORQUE if a torque limit does, or is exceeded by what the arm carries;
        LEVEL_GIVEN_UP if the lowest level of the targets of several tips is met, not all;
        IMPROVED if nearer than in the previous step; otherwise CAPPED.
        """
    @property
    def message(self) -> str:
        """A sentence that says what happened and what to try."""
    @property
    def evaluations(self) -> int:
        """Evaluations of the forward kinematics."""
    @property
    def elapsed(self) -> float:
        """Time taken (s)."""
    @property
    def limits(self) -> Limits:
        """The limits in force."""
    @property
    def q(self) -> _Array:
        """The configuration to command (n,) (rad, m)."""
    @property
    def qd(self) -> _Array:
        """The joint velocity over the step (n,) (rad/s, m/s)."""
    @property
    def errors(self) -> dict[_TipKey, tuple[float, float]]:
        """Errors of each target, by the keys of the last call or the name of the only tip: {tip: (position (m), rotation (rad))}, as
        `position_error` and `rotation_error`; empty before the first target of several tips.
        """
    @property
    def position_error(self) -> float:
        """Distance of the tip from the target (m); the largest of several tips."""
    @property
    def rotation_error(self) -> float:
        """Geodesic angle to the target's orientation (rad), the largest of several tips; NaN if the task leaves the orientation free."""
    @property
    def inside_limits(self) -> bool:
        """Whether the step keeps all limits; False if a joint cannot be brought within its position limits, or slowed down
        to its velocity limit.
        """
    @property
    def clearance(self) -> float:
        """Smallest distance (m) between the robot and obstacles, or between two of its links, at `q`; negative by the depth of an overlap.
        NaN where nothing is checked; inf if nothing can touch.
        """
    @property
    def nearest(self) -> Nearest | None:
        """The nearest two bodies at `q`, a `Nearest`; None where nothing is checked, or if nothing can touch."""

# --- obstacles ----------------------------------------------------------------------------------

@disjoint_base
class Obstacle:
    """The base class of obstacles: a shape, fixed in the frame of the robot's base.

    Each shape takes `touch=`, names of links that need not keep clear of it. A floor under the robot is
    `HalfSpace((0, 0, 1), 0.0, touch=["panda_link0"])`.
    """

    @property
    def triangles(self) -> _Array:
        """Triangles of the surface (t, 3, 3) (m), for drawing. Their corners lie on the surface. A half-space is drawn as
        a square of 4 m, a point cloud as octahedra about at most 2,000 of its points.
        """
    @property
    def touch(self) -> tuple[str, ...]:
        """Sorted names of the links that may touch the shape. They remain allowed when it is attached to a robot
        (`robot.with_attached`).
        """
    def __getnewargs_ex__(self) -> tuple[tuple[Any, ...], dict[str, Any]]: ...

@final
class Sphere(Obstacle):
    """A sphere: centre (3,) and radius (m)."""

    def __new__(cls, center: ArrayLike, radius: float, *, touch: Sequence[str] | None = None) -> Sphere: ...
    @property
    def center(self) -> _Array:
        """Centre (3,) (m)."""
    @property
    def radius(self) -> float:
        """Radius (m)."""

@final
class Box(Obstacle):
    """A box: centre (3,), edge lengths (3,) along its own axes (m), and the rotation (3, 3) of these axes."""

    def __new__(
        cls, center: ArrayLike, size: ArrayLike, rotation: _Pose | None = None, *, touch: Sequence[str] | None = None
    ) -> Box: ...
    @property
    def center(self) -> _Array:
        """Centre (3,) (m)."""
    @property
    def size(self) -> _Array:
        """Edge lengths (3,) (m)."""
    @property
    def rotation(self) -> _Array:
        """Rotation (3, 3); its columns are the axes of the shape."""

@final
class Capsule(Obstacle):
    """A capsule: all points within `radius` (m) of the segment from a (3,) to b (3,)."""

    def __new__(cls, a: ArrayLike, b: ArrayLike, radius: float, *, touch: Sequence[str] | None = None) -> Capsule: ...
    @property
    def a(self) -> _Array:
        """First end of the axis (3,) (m)."""
    @property
    def b(self) -> _Array:
        """Second end of the axis (3,) (m)."""
    @property
    def radius(self) -> float:
        """Radius (m)."""

@final
class Cylinder(Obstacle):
    """A cylinder with flat ends: centre (3,), axis (3,) of any length, radius and length (m)."""

    def __new__(
        cls, center: ArrayLike, axis: ArrayLike, radius: float, length: float, *, touch: Sequence[str] | None = None
    ) -> Cylinder: ...
    @property
    def center(self) -> _Array:
        """Centre (3,) (m)."""
    @property
    def axis(self) -> _Array:
        """Axis (3,), of unit length."""
    @property
    def radius(self) -> float:
        """Radius (m)."""
    @property
    def length(self) -> float:
        """Length along the axis (m)."""

@final
class HalfSpace(Obstacle):
    """All points x with normal . x <= offset, for a normal (3,) of unit length: `HalfSpace([0, 0, 1], 0.0)` is a floor. A
    normal of another length is scaled; `offset` (m) is not.
    """

    def __new__(cls, normal: ArrayLike, offset: float, *, touch: Sequence[str] | None = None) -> HalfSpace: ...
    @property
    def normal(self) -> _Array:
        """Outward normal (3,), of unit length."""
    @property
    def offset(self) -> float:
        """Distance of the surface from the origin, along the normal (m)."""

@final
class Ellipsoid(Obstacle):
    """An ellipsoid: centre (3,), lengths of the semi-axes (3,) (m), and their rotation (3, 3)."""

    def __new__(
        cls,
        center: ArrayLike,
        semi_axes: ArrayLike,
        rotation: _Pose | None = None,
        *,
        touch: Sequence[str] | None = None,
    ) -> Ellipsoid: ...
    @property
    def center(self) -> _Array:
        """Centre (3,) (m)."""
    @property
    def semi_axes(self) -> _Array:
        """Lengths of the semi-axes (3,) (m)."""
    @property
    def rotation(self) -> _Array:
        """Rotation (3, 3); its columns are the axes of the shape."""

@final
class Ellipse(Obstacle):
    """An ellipse in the plane z = 0, for planar arms: centre (2,), lengths of the semi-axes (2,) (m), angle of the first
    one (rad).
    """

    def __new__(
        cls, center: ArrayLike, semi_axes: ArrayLike, angle: float = 0.0, *, touch: Sequence[str] | None = None
    ) -> Ellipse: ...
    @property
    def center(self) -> _Array:
        """Centre (2,) (m)."""
    @property
    def semi_axes(self) -> _Array:
        """Lengths of the semi-axes (2,) (m)."""
    @property
    def angle(self) -> float:
        """Angle of the first semi-axis (rad)."""

@final
class ConvexMesh(Obstacle):
    """The convex hull of points (k, 3) (m): at least four, not all in one plane."""

    def __new__(cls, points: ArrayLike, *, touch: Sequence[str] | None = None) -> ConvexMesh: ...
    @property
    def points(self) -> _Array:
        """The points as given (k, 3) (m)."""

@final
class Mesh(Obstacle):
    """A triangle mesh, convex or not: vertices (k, 3) (m) and faces (t, 3), indices of vertices. Closed parts are solid;
    open parts are surfaces without thickness.

    A part is a set of triangles connected along edges; coincident vertices count as one. It is closed if each edge
    belongs to two triangles, in any orientation, or if the orientations of the triangles along each edge cancel.
    Overlapping and inside-out parts are solid too. A part is the wall of a cavity if it lies inside another part,
    separate from all others, and its triangles have the opposite orientation.
    """

    def __new__(cls, vertices: ArrayLike, faces: ArrayLike, *, touch: Sequence[str] | None = None) -> Mesh: ...
    @property
    def vertices(self) -> _Array:
        """The vertices (k, 3) (m)."""
    @property
    def faces(self) -> NDArray[np.uint32]:
        """The faces (t, 3): indices of vertices."""
    @property
    def closed(self) -> bool:
        """Whether the inside of the mesh is known everywhere: all parts are closed, and by winding numbers no triangle has
        the outside on both sides. Coincident layers of opposite orientation fail this test if their triangles differ.
        In a large part, about 128 triangles are tested.
        """

@final
class PointCloud(Obstacle):
    """A point cloud, for example from a depth camera: balls of one `radius` (m) about points (k, 3) (m). A cloud without points
    touches nothing.

    The robot is often in the picture: `without_robot` takes its own points out.
    """

    def __new__(cls, points: ArrayLike, radius: float, *, touch: Sequence[str] | None = None) -> PointCloud: ...
    @property
    def points(self) -> _Array:
        """The points (k, 3) (m)."""
    @property
    def radius(self) -> float:
        """Radius of the ball about each point (m)."""
    @property
    def removed(self) -> int:
        """Number of the robot's own points that `without_robot` removed to make this cloud; 0 for other clouds, copies and
        files.
        """
    def without_robot(self, robot: Robot, q: ArrayLike, *, padding: float = 0.02) -> PointCloud:
        """Returns the cloud without the robot's own points: those whose ball is at most `padding` from a body of the robot.

        All bodies count: those of the base, of held and branched-off links, and attached shapes (`robot.with_attached`). The
        distance is that of `clearance`, so after this every body is more than `padding` from the cloud. `removed` of the new cloud
        is the number of points that are gone.

        Something that the robot touches or holds loses its points within `padding` too: attach what is in the hand.

        Args:
            robot: an arm with bodies.
            q: joint positions (n,) at which the cloud was taken (rad, m).
            padding: largest distance (m) of the robot's own points from its model: the noise of the sensor, and errors of model,
                calibration and time.

        Raises:
            InvalidInputError: a robot without bodies, wrong joint positions, or a padding that is negative or not finite.
        """

@final
class Grid(Obstacle):
    """An occupancy grid: cubic voxels with edges of `voxel` (m), the first with its lowest corner at `origin` (3,) (m).
    `occupied` is a boolean array (nx, ny, nz). A grid without occupied voxels touches nothing.

    The robot is often in what was measured: `without_robot` takes its own voxels out.
    """

    def __new__(
        cls, origin: ArrayLike, voxel: float, occupied: ArrayLike, *, touch: Sequence[str] | None = None
    ) -> Grid: ...
    @property
    def origin(self) -> _Array:
        """Lowest corner of the first voxel (3,) (m)."""
    @property
    def voxel(self) -> float:
        """Edge of a voxel (m)."""
    @property
    def occupied(self) -> NDArray[np.bool_]:
        """Whether each voxel is occupied (nx, ny, nz)."""
    @property
    def removed(self) -> int:
        """Number of the robot's own voxels that `without_robot` removed to make this grid; 0 for other grids, copies and files."""
    def without_robot(self, robot: Robot, q: ArrayLike, *, padding: float = 0.02) -> Grid:
        """Returns the grid without the robot's own voxels: those that are at most `padding` from a body of the robot.

        All bodies count, as in `PointCloud.without_robot`. The distance is that of `clearance` from the voxel alone. `removed` of
        the new grid is the number of voxels that are free now.

        Args:
            robot: an arm with bodies.
            q: joint positions (n,) at which the grid was measured (rad, m).
            padding: largest distance (m) of the robot's own voxels from its model.

        Raises:
            InvalidInputError: a robot without bodies, wrong joint positions, or a padding that is negative or not finite.
        """

@final
class Body:
    """A body of a robot: a convex shape fixed to a link, from `Robot.bodies`."""

    @property
    def link(self) -> str:
        """Name of the link that carries the body."""
    @property
    def shape(self) -> Obstacle:
        """The shape, in the frame of the link: a Sphere, Box, Capsule, Cylinder, Ellipsoid or ConvexMesh of `bik.obstacles`."""
    @property
    def source(self) -> str:
        """Origin of the body: "given", "attached", "collision shape" (of a file), or "mesh" and the name of its file."""

@final
class Inertia:
    """Mass, centre of mass and inertia matrix of a link, in its frame.

    Args:
        link: name of the link.
        mass: mass (kg).
        center: centre of mass (3,) (m).
        matrix: inertia matrix (3, 3) about the centre, in the axes of the link (kg m^2); None: a point.

    Raises:
        InvalidInputError: a negative mass, a matrix that is not symmetric, or principal moments that no body has: negative, or one
            above the sum of the others. Rounding to three digits is taken.
    """

    def __new__(
        cls, link: str, mass: float, center: ArrayLike | None = None, matrix: ArrayLike | None = None
    ) -> Inertia: ...
    @property
    def link(self) -> str:
        """Name of the link."""
    @property
    def mass(self) -> float:
        """Mass (kg)."""
    @property
    def center(self) -> _Array:
        """Centre of mass (3,) in the frame of the link (m)."""
    @property
    def matrix(self) -> _Array:
        """Inertia matrix (3, 3) about the centre, in the axes of the link (kg m^2)."""

@final
class PreparedObstacles:
    """The obstacles of a `Scene`, read and prepared once; `carried` are link and name of each body that the robot carries there."""

    def __new__(cls, obstacles: Sequence[Obstacle], carried: Sequence[Sequence[str]] = ()) -> PreparedObstacles: ...

@final
class Moving:
    """A moving obstacle for a `Tracker`: its present shape and its velocity.

    Assign `tracker.obstacles = [...]` at each new observation. Until then, an obstacle counts as everywhere that its
    speed could have taken it, in any direction, and commands keep clear of this region. An obstacle faster than stated
    can hit the arm, and so can any obstacle if the arm is cornered or too slow to give way.

    Args:
        shape: a shape of `bik.obstacles`, at its present position.
        velocity: (3,) (m/s), in the frame of the robot's base.
    """

    def __new__(cls, shape: Obstacle, velocity: ArrayLike) -> Moving: ...
    @property
    def shape(self) -> Obstacle:
        """The shape, at its present position."""
    @property
    def velocity(self) -> _Array:
        """Velocity (3,) (m/s), in the frame of the robot's base."""
    def __eq__(self, other: object, /) -> bool: ...
    def __hash__(self) -> int: ...
    def __getnewargs__(self) -> tuple[Obstacle, list[float]]: ...

@final
class Nearest:
    """The nearest two bodies at a configuration, from `obstacles.nearest`."""

    @property
    def body(self) -> str:
        """The link of the robot."""
    @property
    def other(self) -> str:
        """The other body: "obstacle 0 (Box)" or "link 'panda_link0'"."""
    @property
    def distance(self) -> float:
        """Distance between the two surfaces (m); minus the depth where they overlap."""
    @property
    def point(self) -> _Array:
        """Nearest point of the link (3,) (m), in the frame of the robot's base. The nearest point of the other body is
        `point - distance * normal`.
        """
    @property
    def normal(self) -> _Array:
        """Unit vector (3,) from the other body to the link, along which the distance grows fastest."""
    @property
    def gradient(self) -> _Array:
        """Derivative of the distance with respect to each joint (n,) (m/rad, m/m)."""

def nearest(robot: Robot, q: ArrayLike, obstacles: Iterable[Obstacle] | None = None) -> Nearest | None:
    """Returns the nearest two bodies: a link and an obstacle, or two links; if bodies overlap, the two with the deepest
    overlap. None if nothing can touch. Pairs and distance are defined as in `clearance`.

    Args:
        robot: an arm with bodies.
        q: joint positions (n,) (rad, m).
        obstacles: obstacles in the frame of the robot's base.

    Raises:
        InvalidInputError: a robot without bodies, or an obstacle that is not of `bik.obstacles`.
    """

def clearance(robot: Robot, q: ArrayLike, obstacles: Iterable[Obstacle] | None = None) -> Any:
    """Returns the smallest distance (m) between the robot's bodies and obstacles, or between two of its bodies: a number
    for q (n,), (m,) for q (m, n). A negative value is the depth of the deepest overlap; inf means nothing can touch.

    The result is never more than the true distance: for capsules at most 1e-9 m less, for bodies of other shapes about
    1e-7 m. Farther than 1 km from the base, 1e-12 of the coordinates is lost; beyond 1e30 m, a body that may be near
    gives -inf.

    The depth of a capsule in an obstacle is the depth of the deepest point of its axis, plus its radius. It is measured
    to the surface of a closed mesh (to 1 % or 0.1 mm), within the nearest block of voxels of a grid, or within the
    nearest ball of a point cloud. The inside of a mesh with `Mesh.closed` False is known only in part.

    Args:
        robot: an arm with bodies.
        q: joint positions (n,) or (m, n) (rad, m).
        obstacles: obstacles in the frame of the robot's base. Each is compared with all bodies, including those of the
            base and of held links, except for the links in its `touch`.

    Two links of the robot are compared if they are among `robot.collision_pairs`.

    Raises:
        InvalidInputError: a robot without bodies, or an obstacle that is not of `bik.obstacles`.
    """

# --- planning -----------------------------------------------------------------------------------

@final
class Keep:
    """Constraint at every instant of a motion: the error of a task to a target stays within the task's tolerance.

    Args:
        target: pose (4, 4) or position (3,) (m); or a dict from tips to targets, as for `solve`: the key ("left", "right") is the pose
            of the second tip in the frame of the first.
        task: part of the target that counts, one of `tasks`, with its tolerance: components without one are within 1e-6 m or rad, those
            with an infinite one, or of weight 0, are free. None: all of the target, within 1e-6.

    Raises:
        InvalidInputError: wrong shape, NaN; a task that needs an orientation with a position as target; nothing to keep; a task
            with a level, since what is kept comes before all targets.

    For example, a hand that stays within 1 cm of the plane z = 0.3 m:

        >>> free = float("inf")
        >>> plane = bik.Keep([0, 0, 0.3], bik.tasks.Position(tolerance=[free, free, 0.01]))
    """

    def __new__(cls, target: _Targets, task: Task | None = None) -> Keep: ...
    @property
    def target(self) -> Any:
        """The target: a pose (4, 4), a position (3,) (m), or a dict of them by tip."""
    @property
    def task(self) -> Task | None:
        """The part of the target that counts; None: all of it."""
    def __eq__(self, other: object, /) -> bool: ...
    def __hash__(self) -> int: ...

def upright(
    robot: Robot,
    *,
    axis: ArrayLike = (0, 0, 1),
    direction: ArrayLike = (0, 0, -1),
    tilt: float = 0.1,
    tip: str | None = None,
) -> Keep:
    """Keeps an axis of the tip within an angle of a direction all the way, such as a cup that must not spill.

    Args:
        robot: the arm.
        axis: (3,), axis of the tip, in its own frame, of any length but zero.
        direction: (3,), where the axis points, in the frame of the base; by default down, as for a hand that hangs.
        tilt: largest angle between them (rad).
        tip: name of the tip of a robot with several; None: its only one.

    Returns:
        A `Keep`, for `keep=` of `plan_point_to_point` and others.

    Raises:
        InvalidInputError: an axis or a direction of length zero; a tilt that is not positive, or beyond pi; no tip of several.
        UnknownNameError: a tip that the robot does not have.

    For example:

        >>> arm = bik.Robot.named("panda")
        >>> keep = bik.upright(arm, tilt=0.25)
    """

def plan_point_to_point(
    robot: Robot,
    start: _Pose | None = None,
    end: _Pose | None = None,
    *,
    start_q: ArrayLike | None = None,
    end_q: ArrayLike | None = None,
    start_qd: ArrayLike | None = None,
    start_slack: ArrayLike | None = None,
    end_turns: Literal["nearest", "as_given"] = "nearest",
    approach: float | StraightLine | None = None,
    retreat: float | StraightLine | None = None,
    free_start: bool = False,
    task: Task | None = None,
    keep: _Keeps = None,
    limits: Limits | None = None,
    method: Literal["minmax", "tpbso"] | TPBSO = "minmax",
    objective: Literal["time", "joint_travel", "tip_travel"] = "time",
    obstacles: Iterable[Obstacle] | None = None,
    margin: float | None = None,
    self_collision: bool | None = None,
    stop: Stop | None = None,
    seed: int = 0,
    progress: _Progress = None,
) -> Plan:
    """Plans a motion between two ends, which comes to rest at the second.

    Args:
        robot: the arm.
        start, end: position (3,) (m) or pose (4, 4) of the tip; the planner chooses the configuration. Several ends,
            (k, 3) or (k, 4, 4), are alternatives, for example grasps: the planner takes the one with the lowest cost,
            `Plan.chosen_end`. For a robot with several `tips`, dicts as for `solve`; several ends are a list of dicts.
        start_q, end_q: joint positions (n,) instead; for the end also several, (k, n).
        start_qd: velocity at the start (n,) (rad/s, m/s), with start_q, "minmax" and acceleration or jerk limits; None: at
            rest. If the arm cannot move to the end directly, it first stops as quickly as the limits allow.
        start_slack: how far start_q may be outside its position limits (rad, m), a number or (n,); the motion then begins there and
            goes inside. None: 5 degrees, 5 mm for joints that slide. Rounding is taken off in any case.
        end_turns: "nearest": joints that turn without limits go the short way round, and may end whole turns away from end_q (see
            `Plan.end_turned`); among obstacles they go the other way where that is free. "as_given": they end at end_q.
        approach: straight line of the tip before the end: its length (m), along the tip's z axis, or a `StraightLine`.
            The line has constant orientation, begins and ends at rest, and is followed within 0.1 mm.
        retreat: straight line of the tip after the start, against the z axis, otherwise like `approach`.
        free_start: whether the arm may start nearer to something than the margin. It then moves out first, and no two
            bodies come nearer than at the start; see `Plan.freed`.
        task: part of the poses that counts, one of `tasks`, as for `solve`; None: all of it.
        keep: constraints at every instant of the motion, a `Keep` or a list of them, such as `upright(robot, tilt=0.1)`. It is certified,
            not sampled; `Plan.kept` has the largest errors.
        limits: position, velocity, acceleration, jerk, tip and torque limits; None: the robot's.
        method: "minmax": joins the two configurations of the ends that are nearest in time, as fast as the limits allow;
            "tpbso" or `TPBSO(...)`: polynomials through a via point, found by a beetle swarm (Wang et al. 2019).
        objective: quantity to minimise, "time", "joint_travel" or "tip_travel".
        obstacles: a `Scene` or a list of obstacles that the robot must not touch.
        margin: least distance from obstacles and between links (m); None: 1 mm.
        self_collision: whether links must keep clear of each other; None: where the robot has bodies.
        stop: budgets; None: the method's own.
        seed: seed of the random draws; the same seed gives the same bits.
        progress: True shows a progress bar; a callable is called with (done, total).

    Returns:
        A `Plan`. If no plan meets all requirements, its status says so, and its trajectory violates them least.

    Raises:
        InvalidInputError: wrong shape, NaN, or an end that cannot be reached (names the end and the distance); of several ends
            only if none can be reached. A start_q or end_q at which `keep` does not hold (names the error and its tolerance).
        LimitError: limits that contradict each other or exclude an end; a start farther outside them than start_slack (names the
            joint and the remedy).
        InfeasibleError: an arm that cannot stop from start_qd before an obstacle or a position limit, or within tip or torque limits.
        UnsupportedLimit: limits that vary in time; jerk limits with "tpbso" (`Plan.retime` adds them).

    For example:

        >>> robot = bik.Robot.named("ur5e")
        >>> home = [0, -1.5, 1.5, -1.5, -1.5, 0]
        >>> limits = bik.Limits(acceleration=10.0)
        >>> plan = bik.plan_point_to_point(robot, start_q=home, end=[0.4, 0.1, 0.3], limits=limits)
        >>> plan.success
        True
    """

def state_to_state(
    start_q: ArrayLike,
    end_q: ArrayLike,
    limits: Limits,
    *,
    start_qd: ArrayLike | None = None,
    start_qdd: ArrayLike | None = None,
    end_qd: ArrayLike | None = None,
    end_qdd: ArrayLike | None = None,
    joint_names: list[str] | None = None,
    robot: Robot | None = None,
    start_slack: ArrayLike | None = None,
    end_turns: Literal["nearest", "as_given"] = "nearest",
) -> Trajectory:
    """Computes the fastest joint motion from one state to another; all joints arrive together.

    The limits hold at every instant. With jerk limits the acceleration is continuous; without them it jumps, and
    start_qdd and end_qdd have no effect. A joint with velocity limits alone moves at constant velocity, and start_qd and
    end_qd have no effect. A joint that begins outside its velocity or acceleration limits, or about to leave them, first
    returns inside them as quickly as its limits allow. The joint that needs longest moves as fast as it can; the others
    spread their motion over the same time (Berscheid and Kroeger 2021 treat the same problem).

    Args:
        start_q, end_q: positions at the start and at the end (n,) (rad, m).
        limits: constant limits; each joint needs one of `velocity`, `acceleration` and `jerk`. Missing fields are unlimited.
        start_qd, end_qd: velocities (n,) (rad/s, m/s); None: zero.
        start_qdd, end_qdd: accelerations (n,) (rad/s^2, m/s^2); None: zero.
        joint_names: n names; None: "q1", "q2" and so on, or those of the robot.
        robot: the arm whose joints these are: position and velocity limits left out are then its own, and joints that turn without
            limits go the short way round.
        start_slack: how far start_q may be outside its position limits (rad, m), a number or (n,); the motion then begins
            there and goes inside. None: 5 degrees, 5 mm for joints of the robot that slide. Rounding is taken off in any case.
        end_turns: "nearest": joints of the robot that turn without limits end at the whole turn of end_q nearest to start_q;
            "as_given": at end_q.

    Returns:
        A `Trajectory` of cubic segments. Its `start_outside` names the joints of start_q that it leads inside.

    Raises:
        TypeError: limits that are no `Limits`.
        InvalidInputError: wrong shape, NaN, limits that are not positive, or two equal states.
        LimitError: start_q farther outside its limits than start_slack, or end_q outside them.
        InfeasibleError: a final state that cannot be reached inside the limits, or a motion that would leave the position
            limits.
        UnsupportedLimit: limits that vary in time.

    For example:

        >>> limits = bik.Limits(velocity=2.0, acceleration=5.0)
        >>> motion = bik.state_to_state([0.0, 0.0], [1.0, -0.5], limits)
        >>> round(motion.duration, 3)
        0.9
    """

def time_optimal(
    waypoints_q: ArrayLike,
    limits: Limits,
    *,
    knots: ArrayLike | None = None,
    spline: Literal["natural", "not-a-knot", "clamped", "polyline"] = "natural",
    blend: float | None = None,
    gridpoints: int | None = None,
    start_speed: float = 0.0,
    end_speed: float = 0.0,
    joint_names: list[str] | None = None,
    tolerance: float | ArrayLike | None = None,
    robot: Robot | None = None,
) -> Trajectory:
    """Computes the time-optimal motion along a given joint path: the shape is kept, only the timing is optimised.

    The method is reachability analysis (Pham and Pham 2018), with acceleration limits imposed on whole segments instead of
    only at grid points: velocity and acceleration limits hold at every instant, on any grid. With jerk limits the squared rate
    of a smooth clock along the path is a spline, and the fastest one within all limits is found by a barrier method, after
    Debrouwere et al. (2013).

    Args:
        waypoints_q: (k, n), joint positions of the waypoints (rad, m).
        limits: constant limits: `acceleration` for all joints; optionally `velocity`, `jerk`, `lower`, `upper`.
        knots: (k,), increasing path parameters of the waypoints; None: uniform in [0, 1].
        spline: cubic spline with zero curvature at its ends ("natural"), with the cubic of the neighbouring segment
            ("not-a-knot") or with zero slope ("clamped"); or straight lines ("polyline"), see `blend`.
        blend: for a polyline: corners are rounded from this distance before to this distance after them (in joint space, at
            most half a line); None or 0: the joints stop at each corner.
        gridpoints: number of points at which the acceleration along the path may change; None: refined until the duration
            no longer improves. With jerk limits the spline has its own knots.
        start_speed, end_speed: Euclidean norm of the joint velocity at the ends (rad/s, m/s).
        joint_names: n names; None: "q1", "q2" and so on.
        tolerance: a number or (n,): the motion may leave the path by this much in each joint (rad, m), at the same path
            parameter, and then takes the smooth path in this tube on which it is fastest: noise of a recording inside it
            is smoothed. A wider tolerance hardly ever takes longer. None or 0: exactly on the path.
        robot: the robot whose joints these are: fields that `limits` leaves out are then its own, and `tip_speed`, `tip_acceleration` and
            `tip_turn_speed` of `limits` are kept for its tips, and `torque` for its joints. None: no robot, and no limits of tips or torques.

    Equal consecutive rows, as a recording has at rest, are one waypoint. Where the noise of a recording sets the duration, a `UserWarning`
    says so: by how much which joint jitters, and the `tolerance` that smooths it.

    Returns:
        A `Trajectory` exactly on the path, or on the smooth path inside `tolerance`: polynomials of degree 6 between grid
        points. With jerk limits it consists of quintic segments that meet the path at their ends. A path that begins up to 5 degrees
        or 5 mm outside its position limits is led inside; `start_outside` names the joints.

    Raises:
        InvalidInputError: wrong shape, NaN, fewer than two waypoints that differ, or a negative tolerance.
        InfeasibleError: the path leaves the position limits, needs motion of a locked joint, or the end speeds are too high.
        UnsupportedLimit: limits that vary in time, no acceleration limit, jerk limits on a polyline without `tolerance`, limits of tips
            without `robot`, or limits of a tip on a floating base.

    For example:

        >>> limits = bik.Limits(velocity=2.0, acceleration=5.0)
        >>> motion = bik.time_optimal([[0, 0], [1, 0.5], [0, 1]], limits)
        >>> round(motion.duration, 1)
        1.8
    """

@final
class StraightLine:
    """A straight line of the tip with constant orientation at an end of a motion, as `approach=` or `retreat=` of
    `plan_point_to_point`.

    Args:
        distance: length (m).
        direction: (3,), direction of the motion, of any nonzero length; None: along the tip's z axis towards the end, against
            it from the start.
        frame: frame of the direction, "tip" or "base".
        touch: contacts that are allowed on this line alone, for example of a hand that closes on a part: names of links
            that may touch any obstacle, or a dict from the index of an obstacle to the names of links that may touch
            it.
    """

    def __new__(
        cls,
        distance: float,
        *,
        direction: ArrayLike | None = None,
        frame: Literal["tip", "base"] = "tip",
        touch: Iterable[str] | Mapping[int, Iterable[str]] | None = None,
    ) -> StraightLine: ...
    @property
    def distance(self) -> float:
        """Length (m)."""
    @property
    def direction(self) -> list[float] | None:
        """Direction of the motion (3,); None: along the tip's z axis."""
    @property
    def frame(self) -> Literal["tip", "base"]:
        """Frame of the direction, "tip" or "base"."""
    @property
    def touch(self) -> list[str] | dict[int, list[str]]:
        """Contacts that are allowed on this line alone: names of links, or a dict from the index of an obstacle to names of links."""
    def __getnewargs_ex__(self) -> tuple[tuple[Any, ...], dict[str, Any]]: ...

@final
class BatchPlan:
    """Plans in the order of the problems. `b[i]` is a `Plan`, or None if problem i has none; `b[10:20]` and `b[b.success]` are
    batches.
    """

    @property
    def plans(self) -> tuple[Plan | None, ...]:
        """Plan of each problem, or None where `errors` has an exception."""
    @property
    def errors(self) -> tuple[Exception | None, ...]:
        """The exception that `plan_point_to_point` raises for each problem; None where there is a plan."""
    @property
    def success(self) -> NDArray[np.bool_]:
        """Whether each motion meets all requirements (m,)."""
    @property
    def status(self) -> NDArray[np.uint8]:
        """Status of each problem (m,), values of `Status`: the status of its plan, or else OUT_OF_REACH for an end out of
        reach, IN_COLLISION for an end in collision, INVALID for any other error.
        """
    @property
    def message(self) -> str:
        """Number of planned motions, and the reasons for failures."""
    @property
    def cost(self) -> _Array:
        """Values of the objective (m,) (s, rad or m); NaN where there is no plan."""
    @property
    def elapsed(self) -> float:
        """Total time (s)."""
    def __len__(self) -> int: ...
    @overload
    def __getitem__(self, index: int | np.integer, /) -> Plan | None: ...
    @overload
    def __getitem__(self, index: _Several, /) -> BatchPlan: ...
    def __iter__(self) -> Iterator[Plan | None]: ...

def plan_batch(
    robot: Robot,
    problems: Iterable[Mapping[str, Any]],
    *,
    threads: int | None = None,
    progress: _Progress = None,
    start_slack: ArrayLike | None = None,
    end_turns: Literal["nearest", "as_given"] = "nearest",
    approach: float | StraightLine | None = None,
    retreat: float | StraightLine | None = None,
    free_start: bool = False,
    task: Task | None = None,
    keep: _Keeps = None,
    limits: Limits | None = None,
    method: Literal["minmax", "tpbso"] | TPBSO = "minmax",
    objective: Literal["time", "joint_travel", "tip_travel"] = "time",
    obstacles: Iterable[Obstacle] | None = None,
    margin: float | None = None,
    self_collision: bool | None = None,
    stop: Stop | None = None,
    seed: int = 0,
) -> BatchPlan:
    """Plans many motions at once, on all cores.

    Item i is bit-identical to the result of `plan_point_to_point` for problem i, for any number of threads.

    Args:
        robot: the arm.
        problems: a sequence of dicts of arguments of `plan_point_to_point`: start or start_q, end or end_q, and any
            others. The arguments of a problem override the common ones.
        threads: number of threads; None: one per core. With 1, everything runs in the calling thread.
        progress: True shows a progress bar; a callable is called with (done, total).
        approach, retreat, free_start, task, keep, limits, method, objective, obstacles, margin, self_collision, stop, seed: as for
            `plan_point_to_point`, for all problems.

    Returns:
        A `BatchPlan`. A problem that raises an error, for example because an end is out of reach or in collision, does
        not stop the others: its plan is None, and the exception is in `errors`.

    Raises:
        InvalidInputError: an argument that is no argument of `plan_point_to_point`, wrong shape, NaN (names the problem and
            the argument), before anything is planned.

    For example:

        >>> robot = bik.Robot.named("ur5e")
        >>> home = [0, -1.5, 1.5, -1.5, -1.5, 0]
        >>> problems = [{"start_q": home, "end": [0.4, y, 0.3]} for y in (-0.2, 0.2, 5.0)]
        >>> plans = bik.plan_batch(robot, problems)
        >>> plans.success.tolist()
        [True, True, False]
    """

def plan_along_path(
    robot: Robot,
    path: Path | _Pose,
    *,
    start_q: ArrayLike | None = None,
    start_slack: ArrayLike | None = None,
    task: Task | None = None,
    keep: _Keeps = None,
    limits: Limits | None = None,
    method: Literal["timed", "tpbso"] | TPBSO = "timed",
    objective: Literal["time", "joint_travel"] = "time",
    obstacles: Iterable[Obstacle] | None = None,
    margin: float | None = None,
    self_collision: bool | None = None,
    accuracy: float | None = None,
    breaks: bool = False,
    solver: _DerivativeFree | MultiStart | None = None,
    stop: Stop | None = None,
    seed: int = 0,
    progress: _Progress = None,
) -> Plan:
    """Plans a motion that moves the tip along a path.

    Args:
        robot: the arm.
        path: a `Path`, whose timing is ignored, or points (k, 3) (m) or poses (k, 4, 4), joined by straight lines.
        start_q: joint positions (n,) at the start; None: chosen by the planner.
        start_slack: as for `plan_point_to_point`; where no motion leads a joint inside at once, it goes no farther out, and is inside
            at the end.
        task: part of the poses that counts, one of `tasks`, with a tool if needed. Each component stays within its
            `tolerance` at every instant; a component of weight 0 is free. The planner uses this freedom. None: the
            whole pose.
        keep: further constraints at every instant, a `Keep` or a list of them, with "timed": for example, that a tool whose orientation the
            path leaves free stays upright.
        limits: position, velocity, acceleration, jerk, tip and torque limits; None: the robot's.
        method: "timed": optimises redundancy and timing together; "tpbso" or `TPBSO(...)`: redundancy by a beetle swarm,
            uniform timing, splines through every second point (Wang et al. 2019), for planar arms.
        objective: quantity to minimise, "time" or "joint_travel".
        obstacles: a `Scene` or a list of obstacles to keep clear of, with "timed".
        margin: least distance from obstacles and between links (m); None: 1 mm.
        self_collision: whether links must keep clear of each other; None: where `obstacles` are given.
        accuracy: largest distance of the tip from the path (m), also between points, and largest rotation from it
            (rad). It determines how many points of the path the motion passes, and how far it may round corners. None: a
            thousandth of the path's extent,
            plus the rise of the arc through neighbouring points where points are given; for "tpbso" 4 %. If the `task`
            has tolerances, the accuracy is part of them and must not exceed the smallest.
        breaks: whether the tool may leave the path, with "timed". Where no motion follows the whole path, the plan then leaves it as few times
            as possible: the tool draws back along its axis (by any clear way where that is not free), moves to where another posture can
            go on, and comes near again, from rest to rest. What no posture reaches, or in none the joints can hold, is left out. `Plan.breaks` says where, when and why.
        solver: solver of the search of "timed", for an arm with redundancy; None: pattern search from the motion
            found first. `TPBSO` has a
            solver of its own.
        stop: budgets; None: the method's own.
        seed: seed of the random draws; the same seed gives the same bits.
        progress: True shows a progress bar; a callable is called with (done, total).

    Returns:
        A `Plan`. If no plan meets all requirements, its status says so, and its trajectory violates them least. With
        obstacles, a successful plan is certified to keep the margin at every instant; if none is found, the status is
        IN_COLLISION, and the message names the place on the path, the two bodies and the depth.

    Raises:
        InvalidInputError: wrong shape, NaN, fewer than two points, points out of reach, a start in collision, obstacles and
            a robot without bodies, `breaks` with "tpbso", no way beside the path at a break, or a start_q at which `keep` does not hold.
        LimitError: limits that contradict each other; a start farther outside them than start_slack.
        UnsupportedLimit: limits that vary in time, no acceleration limits with "timed", or jerk limits with "tpbso"
            (`Plan.retime` adds them).

    For example:

        >>> arm = bik.Robot.planar([1.0, 1.0, 1.0])
        >>> star = bik.paths.pentagram((1.0, 1.0, 0.0), 5.0, radius=0.5)
        >>> plan = bik.plan_along_path(arm, star, limits=bik.Limits(velocity=3.0, acceleration=10.0))
        >>> plan.success
        True
    """

@final
class TPBSO:
    """Trajectory planning by beetle swarm optimisation (Wang et al. 2019), as `method=` of `plan_point_to_point` and
    `plan_along_path`. The string "tpbso" means `TPBSO()`.

    Args:
        elbows: sign of the second joint's angle at start and end of a planar arm's motion, 1 or -1. At an end given by
            start_q or end_q, those joint positions decide. Along a path both must be equal.
        solver: solver of the search, a derivative-free one; None: the published beetle swarm.
    """

    def __new__(
        cls, *, elbows: Sequence[int] = (1, 1), solver: _DerivativeFree | MultiStart | None = None
    ) -> TPBSO: ...
    @property
    def elbows(self) -> tuple[int, int]:
        """Signs of the second joint's angle at start and end."""
    @property
    def solver(self) -> _DerivativeFree | MultiStart | None:
        """Solver of the search; None: the published beetle swarm."""
    def __getnewargs_ex__(self) -> tuple[tuple[Any, ...], dict[str, Any]]: ...

@final
class Plan:
    """A planned motion, and the outcome of its search."""

    @property
    def success(self) -> bool:
        """Whether the trajectory meets all requirements."""
    @property
    def status(self) -> Status:
        """SOLVED on `success`; otherwise the reason why the search ended."""
    @property
    def message(self) -> str:
        """A sentence that says what happened and what to try."""
    @property
    def evaluations(self) -> int:
        """Evaluations of the cost."""
    @property
    def elapsed(self) -> float:
        """Time taken (s)."""
    @property
    def limits(self) -> Limits:
        """The limits in force."""
    @property
    def trajectory(self) -> Trajectory:
        """The motion: the best one that meets all requirements, otherwise the one that violates them least."""
    @property
    def objective(self) -> str:
        """The quantity that was minimised: "time", "joint_travel" or "tip_travel"."""
    @property
    def cost(self) -> float:
        """Value of the objective on the trajectory (s, rad or m)."""
    @property
    def history(self) -> _Array:
        """Progress of the search (h, 2): number of evaluations, lowest cost found by then. The cost includes penalties
        while the plan has violations.
        """
    @property
    def clearance(self) -> float:
        """Smallest distance between robot and obstacles along the trajectory (m), without the contacts that an approach or a retreat
        allows; NaN without obstacles.
        """
    @property
    def nearest(self) -> Nearest | None:
        """Nearest two bodies over the whole trajectory, a `Nearest`; None without obstacles."""
    @property
    def start_outside(self) -> list[tuple[str, float, float]]:
        """Joints that begin outside their limits and are led inside, each (joint, value, limit) (rad, m)."""
    @property
    def end_turned(self) -> list[tuple[str, float, float]]:
        """Joints that went the short way round, and end whole turns away from the given end_q, each (joint, value at the end, value
        given) (rad).
        """
    @property
    def kept(self) -> list[tuple[Keep, _Array]]:
        """Constraints kept along the way, a list of pairs: each `Keep` of the call, and the largest error of each component of its task on
        the whole motion (m, rad), NaN for free ones; distance and angle for a task without weights or tolerances. These are bounds,
        at most a hundredth of the tolerance too large, computed at the first access.
        """
    @property
    def freed(self) -> tuple[float, float] | None:
        """Escape from a start nearer than the margin, with `free_start=True`: the smallest distance at the start (m), and
        the time (s) from which on the margin is kept; None if the start was clear.
        """
    @property
    def chosen_end(self) -> int | None:
        """Index of the chosen end among those given; None for a plan along a path."""
    @property
    def violations(self) -> list[Violation]:
        """The bounds that the trajectory exceeds, a list of `Violation`; empty on success."""
    @property
    def accuracy(self) -> float:
        """Largest distance of the tip from the path (m), at its points and between them; NaN for a point-to-point plan."""
    @property
    def redundancy(self) -> _Array:
        """Absolute orientations of the redundant links of a planar arm along the path (points, links, 3), as value, lowest and
        highest possible (rad), from the tip's link down; (0, 0, 3) without redundancy.
        """
    @property
    def reference(self) -> _Array | None:
        """Reference positions of the tip (k, 3) (m), joined by straight lines; None for a point-to-point plan."""
    @property
    def robot(self) -> Robot:
        """The robot."""
    @property
    def obstacles(self) -> tuple[Obstacle, ...]:
        """The obstacles, as given."""
    @property
    def moves(self) -> list[MoveReport]:
        """Reports on the moves of a program, a list of `MoveReport` in the order of the moves; empty for other plans."""
    def torques(self, t: ArrayLike) -> _Array:
        """Returns the joint torques (k, n) (N m; N for prismatic joints) of the plan at t (k,) (s), (n,) for a number, as `robot.torques`
        does. Times outside the plan are clamped.

        Raises:
            InvalidInputError: a robot without dynamics.
        """
    @property
    def breaks(self) -> list[Break]:
        """Places where the tool leaves its path, with `breaks=True`, a list of `Break` in order; empty where it does not."""
    def retime(self, limits: Limits) -> Plan:
        """Returns the plan retimed for other limits: the same path, as fast as they allow. Clearance and accuracy remain, and what
        the plan keeps on the way, which is certified again.

        A plan of `plan_along_path` with method "timed" gets a new optimal timing. Any other motion is scaled in time as
        a whole and passes exactly the same configurations.

        Args:
            limits: position, velocity, acceleration, jerk, tip and torque limits; a field left out is the robot's.

        Raises:
            TypeError: limits that are no `Limits`.
            InfeasibleError: a plan with violations, one of `plan_moves`, a path outside the position limits, jerk limits on a motion whose
                acceleration jumps, or a margin, or what is to be kept on the way, that the motion timed for jerk limits does not keep.
            UnsupportedLimit: limits that vary in time.
        """

    def plot(self) -> Figure:
        """Draws the arm along its path, the cost over evaluations, and the joint motions with their limits, and torques if the robot
        has dynamics; returns a matplotlib
        figure.
        """

@disjoint_base
class Move:
    """A move of a program: `Joints`, `Line`, `Arc` or `Wait`."""

    @property
    def blend(self) -> float:
        """Radius about the end of the move (m) inside which the motion may round the corner to the next move; 0: it stops there."""
    @property
    def tip(self) -> str | None:
        """The tip that the move leads, of a robot with several, or None."""
    @property
    def name(self) -> str | None:
        """Name in messages and reports, or None."""

@final
class Joints(Move):
    """All joints together to a configuration or a pose, as fast as the limits allow (PTP, movej).

    Args:
        q_or_pose: joint positions (n,) (rad, m), or a pose (4, 4) of the tip, whose configuration the planner chooses.
        blend: radius (m) about the end inside which the motion may round the corner to the next move; 0: it stops there.
        tip: name of the tip that is led to a pose, of a robot with several; joints that move another tip too stay where they are.
        name: name in messages and reports.

    Raises:
        InvalidInputError: q_or_pose of another shape, NaN, or no rigid transform; a blend below zero; a tip with joint positions.
    """

    def __new__(
        cls, q_or_pose: ArrayLike, *, blend: float = 0.0, tip: str | None = None, name: str | None = None
    ) -> Joints: ...
    @property
    def q_or_pose(self) -> _Array:
        """Joint positions at the end (n,), or the pose of the tip (4, 4)."""
    def __getnewargs_ex__(self) -> tuple[tuple[Any, ...], dict[str, Any]]: ...

@final
class Line(Move):
    """The tip along a straight line to a pose; its orientation turns uniformly with the length (LIN, movel).

    Args:
        pose: (4, 4), pose of the tip at the end.
        speed: speed of the tip (m/s), kept between the blends wherever the limits allow; a turn on the spot counts 0.1 m for
            each radian. None: as fast as the limits allow.
        blend: radius (m) about the end inside which the motion may round the corner to the next line or arc; 0: it stops there.
        tip: name of the tip, of a robot with several; joints that move another tip too stay where they are.
        name: name in messages and reports.

    Raises:
        InvalidInputError: a pose of another shape, or no rigid transform; a speed that is not positive, or a blend below zero.
    """

    def __new__(
        cls,
        pose: ArrayLike,
        *,
        speed: float | None = None,
        blend: float = 0.0,
        tip: str | None = None,
        name: str | None = None,
    ) -> Line: ...
    @property
    def pose(self) -> _Array:
        """Pose of the tip at the end (4, 4)."""
    @property
    def speed(self) -> float | None:
        """Speed of the tip (m/s); None: as fast as the limits allow."""
    def __getnewargs_ex__(self) -> tuple[tuple[Any, ...], dict[str, Any]]: ...

@final
class Arc(Move):
    """The tip along an arc of a circle; its orientation turns uniformly with the length (CIRC, movec).

    Args:
        via: point (3,) (m) that the arc passes through; of a pose (4, 4) the position counts.
        pose: (4, 4), pose of the tip at the end.
        speed: speed of the tip (m/s), kept between the blends wherever the limits allow. None: as fast as the limits allow.
        blend: radius (m) about the end inside which the motion may round the corner to the next line or arc; 0: it stops there.
        angle: angle (rad) after which the arc ends, on the circle through its start, `via` and the position of `pose`, with
            the orientation of `pose`; 2 pi is a full circle. None: it ends at `pose`.
        tip: name of the tip, of a robot with several; joints that move another tip too stay where they are.
        name: name in messages and reports.

    Raises:
        InvalidInputError: a point or a pose of another shape, or no rigid transform; a speed or an angle that is not
            positive, or a blend below zero.
    """

    def __new__(
        cls,
        via: ArrayLike,
        pose: ArrayLike,
        *,
        speed: float | None = None,
        blend: float = 0.0,
        angle: float | None = None,
        tip: str | None = None,
        name: str | None = None,
    ) -> Arc: ...
    @property
    def via(self) -> _Array:
        """Point that the arc passes through (3,) (m)."""
    @property
    def pose(self) -> _Array:
        """Pose of the tip at the end (4, 4)."""
    @property
    def speed(self) -> float | None:
        """Speed of the tip (m/s); None: as fast as the limits allow."""
    @property
    def angle(self) -> float | None:
        """Angle after which the arc ends (rad); None: it ends at `pose`."""
    def __getnewargs_ex__(self) -> tuple[tuple[Any, ...], dict[str, Any]]: ...

@final
class Wait(Move):
    """Rest for some time.

    Args:
        seconds: how long (s), from 0 to 1e6.
        name: name in messages and reports.

    Raises:
        InvalidInputError: a time outside this range.
    """

    def __new__(cls, seconds: float, *, name: str | None = None) -> Wait: ...
    @property
    def seconds(self) -> float:
        """Duration (s)."""
    def __getnewargs_ex__(self) -> tuple[tuple[Any, ...], dict[str, Any]]: ...

@final
class Break:
    """A place where the tool leaves its path, and goes on with another posture of the arm or farther along."""

    @property
    def at(self) -> float:
        """Where the tool leaves the path: the index of a point, with the part of the way to the next one (12.5 is halfway between points
        12 and 13); for a `Path` its time (s).
        """
    @property
    def until(self) -> float:
        """Where it goes on, counted alike: at the same place, where nothing is left out; at the end of the path, where it does not come back."""
    @property
    def reason(self) -> str:
        """Why the arm cannot go on along the path: a joint at its limit, a singularity, two bodies, or a point out of reach."""
    @property
    def start(self) -> float:
        """When the tool leaves the path (s)."""
    @property
    def end(self) -> float:
        """When it is back (s)."""

@final
class MoveReport:
    """Report on a move of a program."""

    @property
    def name(self) -> str | None:
        """Name of the move, or None."""
    @property
    def start(self) -> float:
        """When it starts (s). A blend belongs to its two moves by halves of its length."""
    @property
    def end(self) -> float:
        """When it ends (s)."""
    @property
    def speed(self) -> float:
        """Largest speed of the tip on it (m/s), between its blends; of a turn on the spot 0.1 m for each radian."""
    @property
    def bound_by(self) -> tuple[SpeedBound, ...]:
        """Limits that kept the tip more than 0.1 % below the requested speed, between the blends of the move, a tuple of `SpeedBound`, in
        order of time; empty where it had that speed throughout, and where none is asked for.
        """
    @property
    def message(self) -> str:
        """The motion of the tip on it, in words: its speed between blends, that the blends take the whole move, or that the arm rests."""

@final
class SpeedBound:
    """A limit that keeps the tip below the speed asked for."""

    @property
    def limit(self) -> str:
        """The limit: "velocity", "acceleration" or "jerk" of a joint, "tip speed", "tip acceleration" or "tip turn speed"."""
    @property
    def of(self) -> str:
        """Name of the joint, or of the tip."""
    @property
    def start(self) -> float:
        """From when (s)."""
    @property
    def end(self) -> float:
        """Until when (s)."""

def plan_moves(
    robot: Robot,
    moves: Iterable[Move],
    *,
    start_q: ArrayLike,
    task: _Tasks = None,
    limits: Limits | None = None,
    obstacles: Iterable[Obstacle] | None = None,
    margin: float | None = None,
    self_collision: bool | None = None,
    keep: _Keeps = None,
    stop: Stop | None = None,
    seed: int = 0,
    progress: _Progress = None,
) -> Plan:
    """Plans the motion of a program of moves, from rest at `start_q` to rest.

    Configurations are chosen for the program as a whole, so that no joint meets its limit in the middle of a move: branches and whole
    turns, and the posture of a redundant arm. Lines and arcs are kept within 10 micrometres, a blend stays within its radius, and the
    speed asked for is kept between blends to 0.1 % wherever the limits allow; `Plan.moves` says where they do not.

    With obstacles, joint moves find a way around them, and configurations are chosen whose paths are clear; the whole motion is
    certified between samples too.

    Args:
        robot: the arm, or a robot with several tips, of which each move to a pose names one. That tip is led by the joints that move
            no other one, so that all others stay where they are.
        moves: the program, a sequence of `moves.Joints`, `moves.Line`, `moves.Arc` and `moves.Wait`. Messages count them from 0.
        start_q: joint positions (n,) at the start.
        task: what lines, arcs and joint moves to poses must meet of their poses, one of `tasks`, with a tool if needed: free spin about
            an axis of the tip with `tasks.Pointing`, positions alone, or orientations within tolerances. Positions stay on the lines and
            arcs whatever their tolerance. None: whole poses. For a robot with several tips one task for all of them, or a dict by tip.
        limits: position, velocity, acceleration, jerk, tip and torque limits; None: the robot's.
        obstacles: a `Scene` or a list of obstacles to keep clear of.
        margin: least distance from obstacles and between links (m); None: 1 mm.
        self_collision: whether links must keep clear of each other; None: where `obstacles` are given.
        keep: constraints at every instant of the motion, a `Keep` or a list of them.
        stop: budgets of the search for each joint move among obstacles; None: as for `plan_point_to_point`.
        seed: seed of the random draws; the same seed gives the same bits.
        progress: True shows a progress bar; a callable is called with (done, total).

    Returns:
        A `Plan`, whose `moves` has a `MoveReport` for each move.

    Raises:
        InvalidInputError: wrong shape or NaN; a program without moves or one that takes no time; a speed that is not positive, an
            arc whose points are on a line, a blend that does not fit, and a move that the arm cannot make, or not without a
            collision, each by the name of the move; a start or joint positions in collision; obstacles and a robot without
            bodies; a task that leaves a part of the position free, has a region or an order, or a tolerance that no path is kept to; a
            move that names no tip of several, or one that no joint moves alone, and a blend from one tip to another.
        UnknownNameError: a tip that the robot has not.
        LimitError: limits that contradict each other; a start or joint positions outside them.
        UnsupportedLimit: limits that vary in time, or no acceleration limits.

    For example:

        >>> arm = bik.Robot.named("ur5e")
        >>> q = [0.0, -1.5, 1.8, -1.9, -1.57, 0.0]
        >>> down = arm.fk(q)
        >>> down[2, 3] -= 0.1
        >>> program = [bik.moves.Line(down, speed=0.05, name="down"), bik.moves.Wait(0.5)]
        >>> plan = bik.plan_moves(arm, program, start_q=q, limits=bik.Limits(acceleration=5.0))
        >>> [move.name for move in plan.moves], round(plan.moves[0].speed, 4)
        (['down', None], 0.05)
    """

@final
class Violation:
    """A bound that a planned trajectory exceeds; `str` describes it in words."""

    @property
    def what(self) -> str:
        """The quantity that exceeds the bound, for example "velocity of joint 'elbow'"."""
    @property
    def value(self) -> float:
        """Largest value on the trajectory, in `unit`."""
    @property
    def bound(self) -> float:
        """The bound, in `unit`."""
    @property
    def unit(self) -> str:
        """Unit of value and bound, for example "rad/s"."""

# --- tracking without a model -------------------------------------------------------------------

def track_model_free(
    plant: _Plant,
    path: Path,
    start_q: ArrayLike,
    *,
    dt: float,
    controller: BroydenBAS | ZNNBAS | None = None,
    limits: Limits | None = None,
    position_tolerance: float = 1e-9,
    rotation_tolerance: float = 1e-9,
    seed: int = 0,
    progress: _Progress = None,
) -> ModelFreeResult:
    """Follows a path without a model: the controller commands joint positions and measures the tip.

    If the path has orientations, the controller follows these too, and the plant must measure poses; a radian of error
    counts as much as a metre. If the path has none, the orientation is free, whatever the plant measures.

    Args:
        plant: a callable that takes q (n,) and returns the tip position (3,) (m) or its pose (4, 4); an object whose
            method `move` does so; or a `KinematicPlant`, which runs without Python in the loop. If the plant raises an
            exception or returns anything else, the run ends with the record so far; on the first measurement, the
            exception propagates.
        path: reference positions, or poses, over time.
        start_q: (n,), configuration at t = 0 (rad, m), up to 0.087 (5 degrees) outside the limits; the arm then begins there and is led
            inside.
        dt: time step (s). If it does not divide the path's duration, the last step ends after it, at the path's end.
        controller: `BroydenBAS` or `ZNNBAS`; None: `BroydenBAS()`.
        limits: lower, upper and velocity limits, kept by all commands, including probes: each is reachable from the
            configuration accepted at the start of its step. None means unlimited.
        position_tolerance: error band (m).
        rotation_tolerance: error band of orientations (rad).
        seed: seed of the controller's random draws; the same seed gives the same bits.
        progress: True shows a progress bar; a callable is called with (done, total).

    Returns:
        A `ModelFreeResult`. If the path cannot be followed, its status says why; that is not an error.

    Raises:
        InvalidInputError: wrong shape, NaN, a time step that is not positive, or a delay longer than the run.
        LimitError: a start more than 5 degrees outside the limits, or a negative limit.
        UnsupportedLimit: acceleration or jerk limits, which no controller keeps.

    For example:

        >>> arm = bik.Robot.planar([0.5, 0.4, 0.3])
        >>> path = bik.paths.circle([0.6, 0.3, 0.0], 0.2, 5.0)
        >>> run = bik.track_model_free(bik.KinematicPlant(arm), path, [0.4, 0.5, 0.6], dt=0.01)
        >>> run.settled_error < 1e-6
        True
    """

@final
class ModelFreeResult:
    """The record of a track without a model, k rows: row 0 is the start at t = 0, row i the tick that ends at t_i = i dt. If the
    plant fails, the record ends there.
    """

    @property
    def success(self) -> bool:
        """Whether the tip reached the error band and stayed there."""
    @property
    def status(self) -> Status:
        """SOLVED on `success`; LOST if the tip left its band again; PLANT_FAILED if the plant failed; otherwise the status of the
        last step.
        """
    @property
    def message(self) -> str:
        """A sentence that says what happened and what to try."""
    @property
    def evaluations(self) -> int:
        """Total number of measurements."""
    @property
    def elapsed(self) -> float:
        """Time taken (s)."""
    @property
    def limits(self) -> Limits:
        """The limits in force."""
    @property
    def time(self) -> _Array:
        """Times (k,) (s)."""
    @property
    def q(self) -> _Array:
        """Configurations accepted by the controller (k, n) (rad, m)."""
    @property
    def qd(self) -> _Array:
        """Velocities (k, n) (rad/s, m/s): (q_i - q_{i-1}) / dt, zero in row 0."""
    @property
    def command(self) -> _Array:
        """Commands at which the positions were measured (k, n) (rad, m): equal to q for `BroydenBAS`, one antenna away
        from q for `ZNNBAS`.
        """
    @property
    def position(self) -> _Array:
        """Measured positions of the tip (k, 3) (m)."""
    @property
    def reference(self) -> _Array:
        """Reference positions (k, 3) (m)."""
    @property
    def position_error(self) -> _Array:
        """Distances between tip and reference (k,) (m)."""
    @property
    def rotation_error(self) -> _Array:
        """Angles to the reference orientations (k,) (rad); NaN if the orientation is left free."""
    @property
    def position_tolerance(self) -> float:
        """The error band (m)."""
    @property
    def rotation_tolerance(self) -> float:
        """The error band of orientations (rad)."""
    @property
    def step_status(self) -> NDArray[np.uint8]:
        """Status of each step (k,), values of `Status`: SOLVED inside the band, IMPROVED nearer than in the previous step,
        otherwise CAPPED.
        """
    @property
    def step_evaluations(self) -> NDArray[np.int64]:
        """Measurements of the plant in each step (k,)."""
    @property
    def max_violation(self) -> float:
        """Largest excess of a command over a limit (rad, m), probes included; 0 within rounding."""
    @property
    def settled_error(self) -> float:
        """Root mean square of the measured error over the second half of the rows (m)."""
    @property
    def exception(self) -> BaseException | None:
        """The exception that the plant raised, or None."""
    def plot(self) -> Figure:
        """Draws the path of the tip, the error, the joint positions and the measurements; returns a matplotlib figure."""
    def __len__(self) -> int: ...

@final
class ZNNBAS:
    """Zeroing neural network with beetle antennae search (Khan et al. 2022, eq. 10 to 16): a controller that measures once per
    tick, one random antenna away from its configuration, and moves by the sign of the change in error.

    It serves to reproduce the paper, and for plants that respond within a millisecond. It learns nothing, its error grows
    with the speed of the target (about 3.5 v / (gain c1)), and its antennae shake the tool. `BroydenBAS` is better by orders
    of magnitude in all three respects.

    With poses, h is the squared distance (m^2) plus the squared angle (rad^2): a radian counts as much as a metre.

    Args:
        gain: k of eq. (14) (1/s), positive. The paper's listing has -10, the gain of a block that includes the minus sign of
            eq. (14); here a negative gain is allowed, and diverges. gain * dt should not exceed 0.3.
        antenna_length: lambda of eq. (10) (rad), a number or (n,); 0.1 in the paper.
        c1: instead of antenna_length, an antenna of c1 sqrt(h), eq. (16) (rad per m), up to 0.5 rad. None for both: c1 = 0.3.
        delay_steps: alpha of eq. (13), in ticks (10 in the paper); gain * dt * delay_steps should stay below 1.
        delay: "sliding": the measurement delay_steps ago; "held": a measurement renewed every delay_steps ticks, as in the
            paper's listing.
        accept: "always": eq. (15); "improving": the algorithm in the proof of Theorem 1, in which the arm stays at an
            antenna that is nearer and otherwise returns. It uses neither gain nor delay.
        sensor_delay: delay of the plant's sensor, in ticks.

    The paper's constants: `ZNNBAS(gain=10, antenna_length=0.1, delay_steps=10)`.
    """

    def __new__(
        cls,
        *,
        gain: float = 100.0,
        antenna_length: ArrayLike | None = None,
        c1: float | None = None,
        delay_steps: int = 1,
        delay: Literal["sliding", "held"] = "sliding",
        accept: Literal["always", "improving"] = "always",
        sensor_delay: int = 0,
    ) -> ZNNBAS: ...
    @property
    def gain(self) -> float:
        """Gain k of eq. (14) (1/s)."""
    @property
    def antenna_length(self) -> Any:
        """Constant antenna length (rad), as given; None if it follows the error."""
    @property
    def c1(self) -> float | None:
        """Ratio of antenna length to error (rad per m); None if the antenna is constant."""
    @property
    def delay_steps(self) -> int:
        """Delay alpha of eq. (13), in ticks."""
    @property
    def delay(self) -> str:
        """Kind of delay: "sliding" or "held"."""
    @property
    def accept(self) -> str:
        """Rule for accepting a position: "always" or "improving"."""
    @property
    def sensor_delay(self) -> int:
        """Delay of the sensor, in ticks."""
    def session(
        self,
        start_q: ArrayLike,
        *,
        dt: float,
        limits: Limits | None = None,
        position_tolerance: float = 1e-9,
        rotation_tolerance: float = 1e-9,
        seed: int = 0,
    ) -> ControlSession:
        """Starts a `ControlSession` at `start_q` (n,) and t = 0, for your own loop."""
    def __getnewargs_ex__(self) -> tuple[tuple[Any, ...], dict[str, Any]]: ...

@final
class ControlSession:
    """A model-free controller for your own loop and hardware.

        session = bik.BroydenBAS(max_evaluations_per_step=1).session(start_q, dt=0.01, limits=limits)
        while session.time < path.duration:
            q = session.command(path.position(session.time + session.dt))
            session.observe(measure_tip_after(q))

    The first command is the start itself: it measures where the tip is and does not advance the time. After that, a tick
    ends, and the time advances by dt, when the controller needs no further measurement: for `ZNNBAS` after each one, for
    `BroydenBAS` when the error is in its band or max_evaluations_per_step are made.
    """

    def command(self, target: _Pose) -> _Array:
        """Returns the next command (n,) (rad, m), which moves the tip towards `target` for the end of the tick: a position
        (3,) (m), or a pose (4, 4) if the first target was one. The command is inside the limits, and within the
        velocity limits from the last accepted configuration.
        """
    def observe(self, position: _Pose) -> Step | None:
        """Takes the `position` (3,) (m) or the pose (4, 4) of the tip, measured at the last command; it must be a pose if the
        targets are poses. Returns a `Step` if the tick has ended, else None.
        """
    @property
    def q(self) -> _Array:
        """The last accepted configuration (n,) (rad, m)."""
    @property
    def time(self) -> float:
        """Time of the last accepted configuration (s)."""
    @property
    def dt(self) -> float:
        """Time step (s)."""
    @property
    def limits(self) -> Limits:
        """The limits in force."""

@final
class KinematicPlant:
    """A simulated arm that executes commands exactly, with a sensor at its tip; it runs without Python in the loop. To simulate
    an arm whose model is wrong, pass a modified robot, for example `robot.with_errors(...)`.

    Args:
        robot: the arm as built.
        noise: standard deviation of the measured position on each axis (m).
        rotation_noise: standard deviation of the measured orientation about each axis (rad); 0 measures it exactly. None: the
            sensor measures positions only.
        seed: seed of the noise. Each run of `track_model_free` restarts the noise.
    """

    def __new__(
        cls, robot: Robot, *, noise: float = 0.0, rotation_noise: float | None = None, seed: int = 0
    ) -> KinematicPlant: ...
    @property
    def robot(self) -> Robot:
        """The arm as built."""
    @property
    def noise(self) -> float:
        """Standard deviation of the measured position on each axis (m)."""
    @property
    def rotation_noise(self) -> float | None:
        """Standard deviation of the measured orientation about each axis (rad); None if only the position is measured."""
    @property
    def seed(self) -> int:
        """Seed of the noise."""
    def move(self, q: ArrayLike) -> _Array:
        """Moves the arm to q (n,) (rad, m), and returns the measurement of the sensor: the position of the tip (3,) (m), or its
        pose (4, 4).
        """
    def __getnewargs_ex__(self) -> tuple[tuple[Any, ...], dict[str, Any]]: ...

# --- trajectories -------------------------------------------------------------------------------

@final
class Trajectory:
    """A joint trajectory of polynomial segments between knots: q_j(t) = sum over p of coefficients[i, j, p] (t - time[i])^p.

    Args:
        time: the knots (k,) (s), starting at 0.
        coefficients: (k - 1, n, degree + 1), in ascending powers; the degree is at most 6.
        joint_names: n names; None: "q1", "q2" and so on.
        start_outside: joints that begin outside their limits, each (joint, value, limit), as the attribute says.

    For example:

        >>> motion = bik.Trajectory.from_samples([0.0, 1.0, 2.0], [[0.0], [0.5], [0.0]])
        >>> q, qd, qdd = motion.at(0.5)
        >>> float(q[0]), float(qd[0])
        (0.25, 0.5)
    """

    def __new__(
        cls,
        time: ArrayLike,
        coefficients: ArrayLike,
        *,
        joint_names: list[str] | None = None,
        start_outside: list[tuple[str, float, float]] | None = None,
    ) -> Trajectory: ...
    @staticmethod
    def from_samples(
        time: ArrayLike,
        q: ArrayLike,
        *,
        qd: ArrayLike | None = None,
        qdd: ArrayLike | None = None,
        joint_names: list[str] | None = None,
    ) -> Trajectory:
        """Makes a trajectory through samples q (k, n) at `time` (k,) (s). Segments are linear; cubic if velocities qd (k, n)
        are given, quintic if accelerations qdd (k, n) are given too. A table of pandas gives its columns as `joint_names`.
        """
    @property
    def time(self) -> _Array:
        """The knots (k,) (s)."""
    @property
    def coefficients(self) -> _Array:
        """Coefficients (k - 1, n, degree + 1), in ascending powers of the time since the knot."""
    @property
    def q(self) -> _Array:
        """Positions at the knots (k, n) (rad, m)."""
    @property
    def qd(self) -> _Array:
        """Velocities at the knots (k, n) (rad/s, m/s), of the segment that begins there."""
    @property
    def qdd(self) -> _Array:
        """Accelerations at the knots (k, n) (rad/s^2, m/s^2), of the segment that begins there."""
    @property
    def duration(self) -> float:
        """Duration (s)."""
    @property
    def joint_names(self) -> list[str]:
        """Names of the joints, in the order of q."""
    @property
    def start_outside(self) -> list[tuple[str, float, float]]:
        """Joints that begin outside their limits and are led inside, each (joint, value, limit) (rad, m): of the motions of
        `state_to_state`, `time_optimal` and plans. Files do not hold them.
        """
    def max_velocity(self) -> _Array:
        """Returns the largest speed of each joint (n,) (rad/s, m/s), exact over all times."""
    def max_acceleration(self) -> _Array:
        """Returns the largest acceleration of each joint (n,) (rad/s^2, m/s^2), exact within the segments. Jumps of the
        velocity at knots are not included.
        """
    def max_jerk(self) -> _Array:
        """Returns the largest jerk of each joint (n,) (rad/s^3, m/s^3), exact within the segments. Jumps of the acceleration
        at knots are not included.
        """
    def at(self, t: ArrayLike) -> tuple[_Array, _Array, _Array]:
        """Returns (q, qd, qdd) at t (s): (n,) each for a number, (k, n) for t (k,). Times outside the trajectory are clamped."""
    def sample(self, dt: float) -> tuple[_Array, _Array, _Array, _Array]:
        """Returns (time, q, qd, qdd) every `dt` (s) and at the end: (k,), and (k, n) each."""
    def torques(self, robot: Robot, t: ArrayLike) -> _Array:
        """Returns the joint torques (k, n) (N m; N for prismatic joints) that cause this motion of `robot` at t (k,) (s), (n,) for a number,
        as `robot.torques` does. Times outside the trajectory are clamped.

        Raises:
            InvalidInputError: a robot without dynamics, or with another number of joints.
        """
    def then(self, motion: Trajectory, *, pause: float = 0.0) -> Trajectory:
        """Returns this trajectory followed by a rest of `pause` (s) and by `motion`, which must begin where this one ends."""
    def to_csv(self, file: str | os.PathLike[str], *, dt: float | None = None) -> None:
        """Writes samples as CSV: every `dt` (s) and at the end; None: at the knots. The file appears complete or not at all."""
    def to_npz(self, file: str | os.PathLike[str]) -> None:
        """Writes knots and coefficients as npz. The file appears complete or not at all; a name without ending gets ".npz", as by
        `numpy.savez`.
        """
    @staticmethod
    def from_csv(file: str | os.PathLike[str]) -> Trajectory:
        """Reads a file that `to_csv` wrote, or any CSV with a column `time` and one column per joint."""
    @staticmethod
    def from_npz(file: str | os.PathLike[str]) -> Trajectory:
        """Reads a file that `to_npz` wrote."""
    def plot(self) -> Figure:
        """Draws positions, velocities and accelerations; returns a matplotlib figure."""
    def __getnewargs_ex__(self) -> tuple[tuple[Any, ...], dict[str, Any]]: ...
