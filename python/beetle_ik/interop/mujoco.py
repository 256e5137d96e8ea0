"""Robots from MuJoCo models."""

import os
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from .._arguments import require, require_text
from .._core import InvalidInputError, Robot, UnknownNameError, pose
from .._needs import library
from .._text import listed
from .chain import ChainReader, only_leaf

if TYPE_CHECKING:
    import mujoco


def from_mujoco(
    model: "mujoco.MjModel | str | os.PathLike[str]", *, base: str | None = None, tip: str | None = None
) -> Robot:
    """Makes a robot from the chain between two bodies of a MuJoCo model, or from a body to a site.

    Args:
        model: a `mujoco.MjModel`, an MJCF file, or text that contains "<".
        base: body at the start of the chain, whose frame is the reference frame; None: "world".
        tip: body or site at the end of the chain; None: the only leaf body.

    Hinge and slide joints keep their ranges. MuJoCo has no velocity limits. Joint positions equal MuJoCo's qpos.

    Raises:
        BeetleIkError: MuJoCo is not installed.
        UnknownNameError: no body or site of that name; the message lists them.
        InvalidInputError: a model that MuJoCo cannot read, several leaves and no `tip`, a tip that is not a descendant
            of the base, ball or free joints, joints coupled by equality constraints.
    """
    mujoco = library("mujoco", "mujoco", "a MuJoCo model")
    described = model if isinstance(model, mujoco.MjModel) else _read(mujoco, model)
    bodies = [described.body(i).name or f"body_{i}" for i in range(described.nbody)]
    sites = [described.site(i).name for i in range(described.nsite)]
    tip = _leaf(described, bodies) if tip is None else tip
    start = _index(bodies, [], "world" if base is None else base)
    end = _index(bodies, sites, tip)
    site = end - len(bodies) if end >= len(bodies) else None
    chain = ChainReader(_name(described), bodies[start])
    for body in _bodies_between(described, bodies, start, end if site is None else described.site_bodyid[site]):
        chain.fixed(pose(described.body_pos[body], wxyz=described.body_quat[body]))
        _add_joints(mujoco, chain, described, body)
        chain.link(bodies[body])
    if site is not None:
        chain.fixed(pose(described.site_pos[site], wxyz=described.site_quat[site]))
        chain.link(tip if tip not in bodies else f"{tip} (site)")
    return chain.robot()


def _read(mujoco: Any, model: str | os.PathLike[str]) -> Any:
    require("model", model, mujoco.MjModel, str, os.PathLike)
    text = os.fspath(model)
    if not isinstance(text, str):
        raise InvalidInputError(f"model must be a path of text, got {text!r:.60}")
    require_text("model", text)
    try:
        return mujoco.MjModel.from_xml_string(text) if "<" in text else mujoco.MjModel.from_xml_path(str(Path(text)))
    except ValueError as error:
        raise InvalidInputError(f"MuJoCo cannot read the model: {error!s:.200}") from error


def _name(model: Any) -> str:
    return bytes(model.names).split(b"\0", 1)[0].decode() or "mujoco"


def _index(bodies: list[str], sites: list[str], name: str) -> int:
    """Returns the index of a name in the bodies followed by the sites."""
    names = bodies + sites
    if name not in names:
        named = [site for site in sites if site]
        known = f"bodies: {listed(bodies)}" + (f"; sites: {listed(named)}" if named else "")
        raise UnknownNameError(f"no body or site '{name}' in the MuJoCo model; {known}")
    return names.index(name)


def _leaf(model: Any, bodies: list[str]) -> str:
    followed = set(model.body_parentid[1:].tolist())
    return only_leaf("MuJoCo", "bodies", [name for i, name in enumerate(bodies) if i and i not in followed])


def _bodies_between(model: Any, bodies: list[str], start: int, end: int) -> list[int]:
    """Returns the bodies after `start` up to and including `end`, in order."""
    between: list[int] = []
    body = end
    while body != start:
        if body == 0:
            raise InvalidInputError(
                f"body '{bodies[end]}' of the MuJoCo model is not a descendant of body '{bodies[start]}'"
            )
        between.insert(0, body)
        body = int(model.body_parentid[body])
    return between


def _add_joints(mujoco: Any, chain: ChainReader, model: Any, body: int) -> None:
    first = model.body_jntadr[body]
    for joint in range(first, first + model.body_jntnum[body]):
        name = model.joint(joint).name or f"joint_{joint}"
        hinge = model.jnt_type[joint] == mujoco.mjtJoint.mjJNT_HINGE
        if not hinge and model.jnt_type[joint] != mujoco.mjtJoint.mjJNT_SLIDE:
            raise InvalidInputError(f"joint '{name}' of the MuJoCo model must be a hinge or a slide")
        if _is_coupled(mujoco, model, joint):
            raise InvalidInputError(
                f"joint '{name}' of the MuJoCo model is coupled to another joint by an equality constraint"
            )
        limited = bool(model.jnt_limited[joint])
        lower, upper = model.jnt_range[joint] if limited else (-np.inf, np.inf)
        # A hinge rotates about a point of the body, by qpos minus the reference qpos0.
        chain.fixed(pose(model.jnt_pos[joint]))
        chain.moving(
            name,
            ("revolute" if limited else "continuous") if hinge else "prismatic",
            model.jnt_axis[joint],
            offset=-float(model.qpos0[model.jnt_qposadr[joint]]),
            lower=lower,
            upper=upper,
        )
        chain.fixed(pose(-model.jnt_pos[joint]))


def _is_coupled(mujoco: Any, model: Any, joint: int) -> bool:
    coupling = (model.eq_type == mujoco.mjtEq.mjEQ_JOINT) & (model.eq_active0 != 0)
    return bool(np.any(coupling & ((model.eq_obj1id == joint) | (model.eq_obj2id == joint))))
