"""An arm of seven joints with a gripper of two fingers, with collision shapes, as a URDF: the measures of a Panda."""

_PLACES = [  # of each joint: origin, rotation
    ("0 0 0.333", "0 0 0"),
    ("0 0 0", "-1.5707963267948966 0 0"),
    ("0 -0.316 0", "1.5707963267948966 0 0"),
    ("0.0825 0 0", "1.5707963267948966 0 0"),
    ("-0.0825 0.384 0", "-1.5707963267948966 0 0"),
    ("0 0 0", "1.5707963267948966 0 0"),
    ("0.088 0 0", "1.5707963267948966 0 0"),
]
_LIMITS = [(-2.9, 2.9), (-1.76, 1.76), (-2.9, 2.9), (-3.07, -0.07), (-2.9, 2.9), (-0.02, 3.75), (-2.9, 2.9)]
_BALLS = [  # of each link: centre, radius
    ("0 0 0.1", 0.09),
    ("0 0 0", 0.08),
    ("0 -0.15 0", 0.07),
    ("0.08 0 0", 0.07),
    ("-0.08 0.15 0", 0.07),
    ("0 0 -0.1", 0.07),
    ("0.05 0 0", 0.07),
    ("0 0 0.05", 0.06),
]


def _link(name: str, ball: tuple[str, float] | None = None, shape: str = "") -> str:
    if ball is not None:
        shape = f"<origin xyz='{ball[0]}'/><geometry><sphere radius='{ball[1]}'/></geometry>"
    return f"<link name='{name}'>" + (f"<collision>{shape}</collision>" if shape else "") + "</link>"


def _joint(name: str, kind: str, ends: str, origin: str, rest: str) -> str:
    parent, child = ends.split()
    ends = f"<parent link='{parent}'/><child link='{child}'/>"
    return f"<joint name='{name}' type='{kind}'>{ends}<origin {origin}/>{rest}</joint>"


def _finger(side: str, sign: int, mimic: str) -> str:
    box = "<origin xyz='0 0 0.03'/><geometry><box size='0.02 0.02 0.05'/></geometry>"
    moving = f"<axis xyz='0 {sign} 0'/><limit lower='0' upper='0.04' velocity='0.2' effort='9'/>{mimic}"
    joint = _joint(f"{side}_finger_joint", "prismatic", f"hand {side}_finger", "xyz='0 0 0.058'", moving)
    return _link(f"{side}_finger", shape=box) + joint


GRIPPER_ARM = (
    "<robot name='gripper_arm'>"
    + "".join(_link(f"link{i}", ball) for i, ball in enumerate(_BALLS))
    + "".join(
        _joint(
            f"joint{i + 1}",
            "revolute",
            f"link{i} link{i + 1}",
            f"xyz='{xyz}' rpy='{rpy}'",
            f"<axis xyz='0 0 1'/><limit lower='{lower}' upper='{upper}' velocity='2' effort='9'/>",
        )
        for i, ((xyz, rpy), (lower, upper)) in enumerate(zip(_PLACES, _LIMITS, strict=True))
    )
    + _link("hand", ("0 0 0.03", 0.045))
    + _joint("hand_joint", "fixed", "link7 hand", "xyz='0 0 0.107' rpy='0 0 -0.785398163397'", "")
    + _finger("left", 1, "")
    + _finger("right", -1, "<mimic joint='left_finger_joint'/>")
    + "</robot>"
)
READY = [0.0, 0.19, 0.0, -2.62, 0.0, 2.94, 0.79, 0.02, 0.02]
