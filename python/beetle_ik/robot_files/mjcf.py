"""MuJoCo models as robots: the compiled model becomes a URDF, which the core reads."""

import os
import re
import warnings
from collections.abc import Iterator, Mapping
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import TYPE_CHECKING, Any, Literal
from xml.sax.saxutils import quoteattr

import numpy as np
from numpy.typing import NDArray

from .._core import InvalidInputError, Robot, UnknownNameError, UrdfError, pose
from ..calls.arguments import require, require_text
from ..calls.text import exact, listed
from ..installed.needs import library
from .mjcf_equalities import Equalities
from .mjcf_files import require_own_files

if TYPE_CHECKING:
    import mujoco

Matrix = NDArray[np.float64]


def robot(
    model: "mujoco.MjModel | str | os.PathLike[str]",
    base: str | None,
    tips: list[str],
    hold: Mapping[str, float] | None,
    collision: Literal["primitives", "fit", "hulls"] | None,
    trusted: bool,
) -> Robot:
    """Reads a file, a text or a compiled model; implements `Robot.from_mjcf`."""
    mujoco = library("mujoco", "mujoco", "a MuJoCo model", extra="sim")
    described = model if isinstance(model, mujoco.MjModel) else _read(mujoco, model, trusted)
    reader = _Reader(mujoco, described)
    for link in (base, *tips):
        reader.require_known(link)
    with TemporaryDirectory() as folder:
        if collision in ("fit", "hulls"):
            reader.write_meshes(Path(folder))
        try:
            made = Robot.from_urdf(
                reader.urdf(tips), base=base, tip=tips or None, hold=hold, collision=collision, package_dirs=[folder]
            )
        except UrdfError as error:
            problem = re.sub(r"^URDF( line \d+)?: ", "MuJoCo model: ", str(error))
            raise InvalidInputError(problem) from None
    made = made.with_held(reader.rests(made, hold or {})).with_gravity(reader.gravity(made.link_names[0]))
    reader.require_kept(made)
    made._doubt_degrees()
    return made


def _read(mujoco: Any, model: str | os.PathLike[str], trusted: bool) -> Any:
    require("model", model, mujoco.MjModel, str, os.PathLike)
    text = os.fspath(model)
    if not isinstance(text, str):
        raise InvalidInputError(f"model must be a path of text, got {text!r:.60}")
    require_text("model", text)
    if not trusted:
        require_own_files(text)
    try:
        return mujoco.MjModel.from_xml_string(text) if "<" in text else mujoco.MjModel.from_xml_path(str(Path(text)))
    except ValueError as error:
        file = "" if "<" in text else f"{text:.200}: "
        raise InvalidInputError(f"MuJoCo cannot read the model: {file}{error!s:.200}") from error


class _Reader:
    """Writes the bodies, joints and collision geoms of a compiled model as a URDF."""

    def __init__(self, mujoco: Any, model: Any) -> None:
        self.mujoco, self.model = mujoco, model
        self.bodies = [model.body(i).name or f"body_{i}" for i in range(model.nbody)]
        self.sites = [model.site(i).name for i in range(model.nsite)]
        self.joints = [model.joint(i).name or f"joint_{i}" for i in range(model.njnt)]
        self.equalities = Equalities(mujoco, model, self.joints)

    def require_known(self, name: str | None) -> None:
        """Raises `UnknownNameError` unless `name` is None, a body or a site."""
        if name is not None and name not in self.bodies + self.sites:
            named = [site for site in self.sites if site]
            known = f"bodies: {listed(self.bodies)}" + (f"; sites: {listed(named)}" if named else "")
            raise UnknownNameError(f"no body or site '{name}' in the MuJoCo model; {known}")

    def rests(self, robot: Robot, hold: Mapping[str, float]) -> dict[str, float]:
        """Returns the reference positions of held joints not in `hold`: there, MuJoCo closes loops."""
        rests = {}
        for joint, name in enumerate(self.joints):
            if name in robot.held_joints and name not in hold:
                rest, (lower, upper) = (
                    float(self.model.qpos0[self.model.jnt_qposadr[joint]]),
                    self.model.jnt_range[joint],
                )
                rests[name] = float(np.clip(rest, lower, upper)) if self.model.jnt_limited[joint] else rest
        return rests

    def require_kept(self, robot: Robot) -> None:
        """Raises `InvalidInputError` for an equality that joints of the chain do not keep; warns for the others.

        One that they can only keep outside their ranges is refused too.
        """
        chain = {joint for joint in range(len(self.joints)) if self.equalities.leader(joint) in robot.joint_names}
        for tip in robot.tips:
            chain |= self.equalities.between((self._carrier(robot.link_names[0]), self._carrier(tip)))
        chain = self.equalities.coupled_with(chain)
        for found in self.equalities.open_in(robot):
            if chain & found.joints:
                coupled = listed([self.joints[joint] for joint in sorted(found.joints)])
                raise InvalidInputError(
                    f"MuJoCo model: {found.described} couples the joints {coupled}, which is not followed (locks and "
                    "couplings of two joints are, where they agree): choose base and tip on one side of it, or set "
                    "active='false' if the motion of the tip does not depend on it"
                )
            warnings.warn(
                f"MuJoCo model: {found.described} is open by {found.residual:.3g} (m or rad) where joints beside the "
                "chain are held: bodies there may stand elsewhere in MuJoCo; hold=... closes it",
                stacklevel=3,
            )
        for joint in sorted(chain):
            self.equalities.require_lock_in_range(joint)

    def _carrier(self, name: str) -> int:
        """Returns the body of this name, or the body that carries the site of this name."""
        if name in self.bodies:
            return self.bodies.index(name)
        return int(self.model.site_bodyid[self.sites.index(name)])

    def urdf(self, tips: list[str]) -> str:
        """Returns the model as a URDF; sites among `tips` become links, unless a body has the same name."""
        model = self.model
        lines = [f"<robot name={quoteattr(self._name())}>", *(f"<link name={quoteattr(self.bodies[0])}/>",)]
        for body in range(1, model.nbody):
            lines += self._joints_to(body)
            inner = [*self._inertial(body), *self._collisions(body)]
            lines += [f"<link name={quoteattr(self.bodies[body])}>", *inner, "</link>"]
        for tip in tips:
            if tip in self.bodies:
                continue
            site = self.sites.index(tip)
            carrier = self.bodies[model.site_bodyid[site]]
            place = pose(model.site_pos[site], wxyz=model.site_quat[site])
            lines += [f"<link name={quoteattr(tip)}/>", *_joint(f"{tip}/site", "fixed", carrier, tip, place)]
        return "\n".join([*lines, "</robot>"])

    def write_meshes(self, folder: Path) -> None:
        """Writes the meshes of the model as OBJ files, by the names that `urdf` gives them."""
        model = self.model
        for mesh in range(model.nmesh):
            first, count = model.mesh_vertadr[mesh], model.mesh_vertnum[mesh]
            lines = [f"v {exact(vertex)}" for vertex in model.mesh_vert[first : first + count]]
            first, count = model.mesh_faceadr[mesh], model.mesh_facenum[mesh]
            lines += [f"f {a} {b} {c}" for a, b, c in model.mesh_face[first : first + count] + 1]
            file = folder / self._mesh(mesh)
            file.parent.mkdir(exist_ok=True)
            file.write_text("\n".join(lines))

    def _mesh_element(self, geom: Any) -> str:
        mesh = self.model.geom_dataid[geom]
        return f"<mesh filename={quoteattr(f'package://{self._mesh(mesh)}')}/>" if mesh >= 0 else ""

    def _mesh(self, mesh: int) -> str:
        return f"{mesh}/{re.sub(r'[^0-9A-Za-z_-]', '_', self.model.mesh(mesh).name) or 'mesh'}.obj"

    def _name(self) -> str:
        return bytes(self.model.names).split(b"\0", 1)[0].decode() or "mujoco"

    def _joints_to(self, body: int) -> Iterator[str]:
        """Yields the joints from the parent of a body to the body, with links between several of them."""
        model, name = self.model, self.bodies[body]
        at = self.bodies[model.body_parentid[body]]
        place = pose(model.body_pos[body], wxyz=model.body_quat[body])
        first, count = model.body_jntadr[body], model.body_jntnum[body]
        for joint in range(first, first + count):
            anchor, axis = np.array(model.jnt_pos[joint]), np.array(model.jnt_axis[joint])
            kind, inner = self._kind(joint), self._attributes(joint)
            # A joint of MuJoCo moves about an anchor in the body, by qpos minus its reference value.
            rest = float(model.qpos0[model.jnt_qposadr[joint]]) if inner else 0.0
            if (locked := self.equalities.lock(joint)) is not None:
                rest -= locked
            back = pose(-rest * axis) if kind == "prismatic" else pose([0, 0, 0], rotvec=-rest * axis)
            if locked is not None:
                kind, inner = "fixed", []
            origin = place @ pose(anchor) @ back
            if joint == first + count - 1 and not anchor.any():
                yield from _joint(self.joints[joint], kind, at, name, origin, inner)
                return
            link = f"{name}/{self.joints[joint]}"
            yield f"<link name={quoteattr(link)}/>"
            yield from _joint(self.joints[joint], kind, at, link, origin, inner)
            at, place = link, pose(-anchor)
        yield from _joint(f"{name}/body", "fixed", at, name, place)

    def _kind(self, joint: int) -> str:
        kind = self.mujoco.mjtJoint(self.model.jnt_type[joint])
        if kind.name == "mjJNT_HINGE":
            if joint in self.equalities.curves:
                return "continuous"
            return "revolute" if self.equalities.range(joint) else "continuous"
        return {"mjJNT_SLIDE": "prismatic", "mjJNT_BALL": "spherical"}.get(kind.name, "floating")

    def _attributes(self, joint: int) -> list[str]:
        """Returns axis, limits and coupling of a hinge or slide; empty for other joints."""
        model = self.model
        if self._kind(joint) in ("spherical", "floating"):
            return []
        inner = [f"<axis xyz='{exact(model.jnt_axis[joint])}'/>"]
        effort = self._effort(joint)
        # The range of a follower by a polynomial is that of its leader.
        span = None if joint in self.equalities.curves else self.equalities.range(joint)
        if span or self._kind(joint) == "prismatic":
            lower, upper = span or (-np.inf, np.inf)
            inner.append(f"<limit lower='{lower!r}' upper='{upper!r}' effort='{effort!r}'/>")
        elif np.isfinite(effort):
            inner.append(f"<limit effort='{effort!r}'/>")
        dof = model.jnt_dofadr[joint]
        damping, friction, rotor = (
            float(np.ravel(values[dof])[0])
            for values in (model.dof_damping, model.dof_frictionloss, model.dof_armature)
        )
        if damping or friction or rotor:
            inner.append(f"<dynamics damping='{damping!r}' friction='{friction!r}' armature='{rotor!r}'/>")
        master, scale, offset = self.equalities.drives.get(joint, (None, 0.0, 0.0))
        if master is not None:
            name = quoteattr(self.joints[master])
            inner.append(f"<mimic joint={name} multiplier='{scale!r}' offset='{offset!r}'/>")
        if joint in self.equalities.curves:
            leader, polynomial = self.equalities.curves[joint]
            name = quoteattr(self.joints[leader])
            inner.append(f"<mimic joint={name} polynomial='{exact(polynomial.coef)}'/>")
        return inner

    def _effort(self, joint: int) -> float:
        """Returns the largest force or torque of the actuators of a joint; infinite if it is not limited."""
        model = self.model
        if model.jnt_actfrclimited[joint]:
            return float(np.abs(model.jnt_actfrcrange[joint]).min())
        on_joint = int(self.mujoco.mjtTrn.mjTRN_JOINT)
        drives = (model.actuator_trntype == on_joint) & (model.actuator_trnid[:, 0] == joint)
        if not drives.any() or not model.actuator_forcelimited[drives].all():
            return float("inf")
        forces = np.abs(model.actuator_forcerange[drives]).min(axis=1)
        return float(np.abs(model.actuator_gear[drives, 0]) @ forces) or float("inf")

    def gravity(self, base: str) -> NDArray[np.float64]:
        """Returns the acceleration of free fall (3,) in the frame of a body at the reference positions of the model."""
        data = self.mujoco.MjData(self.model)
        self.mujoco.mj_kinematics(self.model, data)
        turn = np.array(data.xmat[self.bodies.index(base)]).reshape(3, 3) if base in self.bodies else np.eye(3)
        return np.array(turn.T @ self.model.opt.gravity)

    def _inertial(self, body: int) -> Iterator[str]:
        """Yields mass, centre and principal moments of a body that has a mass."""
        model = self.model
        if not model.body_mass[body] > 0.0:
            return
        mass, place = float(model.body_mass[body]), pose(model.body_ipos[body], wxyz=model.body_iquat[body])
        moments = zip(("ixx", "iyy", "izz"), map(float, model.body_inertia[body]), strict=True)
        inertia = " ".join(f"{name}='{moment!r}'" for name, moment in moments)
        yield f"<inertial>{_origin(place)}<mass value='{mass!r}'/><inertia {inertia}/></inertial>"

    def _collisions(self, body: int) -> Iterator[str]:
        """Yields the geoms that take part in collisions."""
        model = self.model
        for geom in np.flatnonzero(model.geom_bodyid == body):
            if not (model.geom_contype[geom] or model.geom_conaffinity[geom]):
                continue
            size = [float(length) for length in model.geom_size[geom]]
            shape = {
                "mjGEOM_SPHERE": f"<sphere radius='{size[0]!r}'/>",
                "mjGEOM_CAPSULE": f"<capsule radius='{size[0]!r}' length='{2 * size[1]!r}'/>",
                "mjGEOM_CYLINDER": f"<cylinder radius='{size[0]!r}' length='{2 * size[1]!r}'/>",
                "mjGEOM_BOX": f"<box size='{exact(2 * np.array(size))}'/>",
                "mjGEOM_ELLIPSOID": "<ellipsoid/>",
                "mjGEOM_MESH": self._mesh_element(geom),
            }.get(self.mujoco.mjtGeom(model.geom_type[geom]).name, "<mesh/>")
            place = pose(model.geom_pos[geom], wxyz=model.geom_quat[geom])
            yield f"<collision>{_origin(place)}<geometry>{shape}</geometry></collision>"


def _joint(name: str, kind: str, parent: str, child: str, place: Matrix, inner: list[str] | None = None) -> list[str]:
    return [
        f"<joint name={quoteattr(name)} type='{kind}'>",
        f"<parent link={quoteattr(parent)}/><child link={quoteattr(child)}/>{_origin(place)}",
        *(inner or []),
        "</joint>",
    ]


def _origin(place: Matrix) -> str:
    """Returns a pose (4, 4) as an element. The angles are exact to rounding, also at a pitch of 90 degrees."""
    yaw = np.arctan2(place[1, 0], place[0, 0])
    sine, cosine = np.sin(yaw), np.cos(yaw)
    pitch = np.arctan2(-place[2, 0], cosine * place[0, 0] + sine * place[1, 0])
    roll = np.arctan2(sine * place[0, 2] - cosine * place[1, 2], cosine * place[1, 1] - sine * place[0, 1])
    return f"<origin xyz='{exact(place[:3, 3])}' rpy='{exact([roll, pitch, yaw])}'/>"
