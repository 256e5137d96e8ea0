"""A robot of two Panda arms on a torso that rises and turns, as a URDF."""

from math import pi

# Of each joint: origin (xyz, rpy), limits, from the maker's "Robot and interface specifications".
PANDA = [
    ((0, 0, 0.333), 0.0, -2.8973, 2.8973),
    ((0, 0, 0), -pi / 2, -1.7628, 1.7628),
    ((0, -0.316, 0), pi / 2, -2.8973, 2.8973),
    ((0.0825, 0, 0), pi / 2, -3.0718, -0.0698),
    ((-0.0825, 0.384, 0), -pi / 2, -2.8973, 2.8973),
    ((0, 0, 0), pi / 2, -0.0175, 3.7525),
    ((0.088, 0, 0), pi / 2, -2.8973, 2.8973),
]
CAPSULES = {1: ((0, 0, -0.1), 0.2), 3: ((0, 0, -0.06), 0.12), 5: ((0, 0, -0.15), 0.2), 7: ((0, 0, 0.05), 0.1)}


def pair_of_pandas() -> str:
    """Returns a URDF with the tips "left_tool" and "right_tool" and the torso's joints "lift" and "turn"."""
    torso = [
        '<link name="floor"/><link name="column"/><link name="chest"/>',
        _joint("lift", "prismatic", "floor", "column", (0, 0, 0.4), limits=(0.0, 0.5)),
        _joint("turn", "revolute", "column", "chest", (0, 0, 0.3), limits=(-1.5, 1.5)),
    ]
    return "\n".join(['<robot name="pair_of_pandas">', *torso, *_arm("left", 1), *_arm("right", -1), "</robot>"])


def _arm(side: str, sign: int) -> list[str]:
    lines = [f'<link name="{side}_link0"/>']
    lines.append(_joint(f"{side}_shoulder", "fixed", "chest", f"{side}_link0", (0, 0.15 * sign, 0), roll=-0.8 * sign))
    for i, (xyz, roll, lower, upper) in enumerate(PANDA, 1):
        parent, link = f"{side}_link{i - 1}", f"{side}_link{i}"
        lines.append(f'<link name="{link}">{_capsule(i)}</link>')
        lines.append(_joint(f"{side}_joint{i}", "revolute", parent, link, xyz, roll=roll, limits=(lower, upper)))
    lines.append(f'<link name="{side}_tool"/>')
    lines.append(_joint(f"{side}_mount", "fixed", f"{side}_link7", f"{side}_tool", (0, 0, 0.2104)))
    return lines


def _capsule(i: int) -> str:
    if i not in CAPSULES:
        return ""
    (x, y, z), length = CAPSULES[i]
    shape = f'<cylinder radius="0.06" length="{length}"/>'
    return f'<collision><origin xyz="{x} {y} {z}"/><geometry>{shape}</geometry></collision>'


def _joint(
    name: str,
    kind: str,
    parent: str,
    child: str,
    xyz: tuple[float, float, float],
    *,
    roll: float = 0.0,
    limits: tuple[float, float] | None = None,
) -> str:
    x, y, z = xyz
    range_ = "" if limits is None else f'<limit lower="{limits[0]}" upper="{limits[1]}" velocity="2" effort="1"/>'
    return (
        f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>'
        f'<origin xyz="{x} {y} {z}" rpy="{roll} 0 0"/><axis xyz="0 0 1"/>{range_}</joint>'
    )
