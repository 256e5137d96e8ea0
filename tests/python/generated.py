"""Random robots as URDF."""

import numpy as np

KINDS = ("revolute", "continuous", "prismatic")


def chain(joints: int, place: str, seed: int) -> tuple[str, str, str]:
    """A URDF with `joints` moving joints between its base and its tip, and the names of these two links.

    `place` says where the base is: the "root" of the tree, a link further "inside", or on another "branch" than the
    tip, so that part of the chain is passed from child to parent. Fixed joints stand in between, one in four of the
    moving joints follows one before it, and origins and axes point anywhere.
    """
    rng = np.random.default_rng([seed, joints])
    back = int(rng.integers(1, joints + 1)) if place == "branch" else 0
    tree = _Tree(rng)
    trunk = tree.grow("root", "lead", moving=int(place == "inside"), fixed=2)
    base = tree.grow(trunk, "back", moving=back, fixed=1)
    tip = tree.grow(trunk, "arm", moving=joints - back, fixed=2)
    tree.grow(tip, "beyond", moving=1, fixed=0)
    return tree.urdf(), ("root" if place == "root" else base), tip


class _Tree:
    def __init__(self, rng: np.random.Generator) -> None:
        self.rng = rng
        self.links = ["root"]
        self.joints: list[str] = []
        self.masters: list[str] = []

    def grow(self, parent: str, branch: str, moving: int, fixed: int) -> str:
        """Adds joints one behind the other in random order, and returns the last link."""
        moves = self.rng.permutation([True] * moving + [False] * fixed)
        for i, move in enumerate(moves):
            child = f"{branch}_{i}"
            self.links.append(child)
            self._join(parent, child, str(self.rng.choice(KINDS)) if move else "fixed")
            parent = child
        return parent

    def _join(self, parent: str, child: str, kind: str) -> None:
        name = f"{child}_joint"
        axis = self.rng.normal(size=3) * 10.0 ** self.rng.uniform(-3, 3)
        follows = self.masters and kind != "fixed" and self.rng.random() < 0.25
        mimic = ""
        if follows:
            factor, offset = self.rng.normal(size=2)
            master = self.rng.choice(self.masters)
            mimic = f'<mimic joint="{master}" multiplier="{factor}" offset="{offset}"/>'
        elif kind != "fixed":
            self.masters.append(name)
        self.joints.append(
            f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>'
            f'<origin xyz="{_triple(self.rng.uniform(-1, 1, 3))}" rpy="{_triple(self.rng.uniform(-3, 3, 3))}"/>'
            f'<axis xyz="{_triple(axis)}"/><limit lower="-100" upper="100" effort="1" velocity="1"/>{mimic}</joint>'
        )

    def urdf(self) -> str:
        links = "".join(f'<link name="{name}"/>' for name in self.links)
        return f'<robot name="generated">{links}{"".join(self.joints)}</robot>'


def _triple(numbers: np.ndarray) -> str:
    return " ".join(map(repr, numbers.tolist()))
