"""A hand of four fingers with four joints each, as a URDF: three in a row, and a thumb across from them."""

FINGERS = ("index", "middle", "ring", "thumb")
_BASES = {
    "index": ("0 0.045 0.09", "0 0 0"),
    "middle": ("0 0 0.095", "0 0 0"),
    "ring": ("0 -0.045 0.09", "0 0 0"),
    "thumb": ("0.03 0.05 0.02", "0 0.5 2.6"),
}
_PIECES = (0.05, 0.04, 0.03)


def _joint(name: str, ends: str, origin: str, rest: str, kind: str = "revolute") -> str:
    parent, child = ends.split()
    links = f"<parent link='{parent}'/><child link='{child}'/>"
    return f"<link name='{child}'/><joint name='{name}' type='{kind}'>{links}<origin {origin}/>{rest}</joint>"


def _finger(name: str) -> str:
    xyz, rpy = _BASES[name]
    bend = "<axis xyz='0 1 0'/><limit lower='-0.2' upper='1.7' velocity='8' effort='1'/>"
    spread = "<axis xyz='1 0 0'/><limit lower='-0.5' upper='0.5' velocity='8' effort='1'/>"
    text = _joint(f"{name}_spread", f"palm {name}_0", f"xyz='{xyz}' rpy='{rpy}'", spread)
    for i, length in enumerate((0.0, *_PIECES[:2])):
        text += _joint(f"{name}_bend{i}", f"{name}_{i} {name}_{i + 1}", f"xyz='0 0 {length}'", bend)
    return text + _joint(f"{name}_end", f"{name}_3 {name}_tip", f"xyz='0 0 {_PIECES[2]}'", "", "fixed")


FOUR_FINGERS = "<robot name='four_fingers'><link name='palm'/>" + "".join(map(_finger, FINGERS)) + "</robot>"
TIPS = [f"{name}_tip" for name in FINGERS]
