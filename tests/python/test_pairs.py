"""Pairs of links that are tested against each other, and bodies attached to a link."""

import xml.etree.ElementTree as ET
from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray
from oracle import SHARED, needs_shared
from test_tree import GRIPPER

import beetle_ik as bik

Array = NDArray[np.float64]
PANDA = bik.Robot.named("panda").with_capsules(radius=0.06)
READY = [0, -np.pi / 4, 0, -3 * np.pi / 4, 0, np.pi / 2, np.pi / 4]
MODELS = SHARED / "motionbenchmaker" / "robots"


def test_the_ready_stance_is_clear_of_itself() -> None:
    assert PANDA.collision_pairs
    assert bik.obstacles.clearance(PANDA, READY) > 0
    assert PANDA.with_collision_pairs([]).collision_pairs == []


def smallest_distance(robot: bik.Robot, q: Array, tested: Callable[[str, str], bool]) -> Array:
    """The smallest distance of spheres on links that are tested, by brute force, at q (m, n)."""
    links = [link for link, *_ in robot.capsules]
    at = np.array([robot.fk(q, link=link) for link in links])
    centers = np.einsum("lmij,lj->lmi", at[..., :3, :3], [a for _, a, _, _ in robot.capsules]) + at[..., :3, 3]
    radii = np.array([radius for *_, radius in robot.capsules])
    nearest = np.full(len(q), np.inf)
    for i, one in enumerate(links):
        for j in range(i):
            if tested(one, links[j]):
                gap = np.linalg.norm(centers[i] - centers[j], axis=-1) - radii[i] - radii[j]
                nearest = np.minimum(nearest, gap)
    return nearest


@needs_shared
@pytest.mark.parametrize(("name", "tip"), [("panda", "panda_hand"), ("ur5", "robotiq_85_base_link")])
def test_spheres_and_srdf_give_the_known_answers(name: str, tip: str) -> None:
    srdf = MODELS / name / f"{name}.srdf"
    robot = bik.Robot.from_urdf(MODELS / name / f"{name}_spherized.urdf", tip=tip, srdf=srdf)
    disabled = {
        frozenset((pair.attrib["link1"], pair.attrib["link2"])) for pair in ET.parse(srdf).iter("disable_collisions")
    }
    disabled.add(frozenset(("wrist_2_link", "fts_robotside")))  # they always touch, though the SRDF does not say so
    q = robot.random_configurations(3000, seed=5)
    apart = {link: robot.fk(q[:2], link=link) for link, *_ in robot.capsules}

    def tested(one: str, other: str) -> bool:
        seen = np.linalg.inv(apart[one]) @ apart[other]
        fixed = np.allclose(seen[0], seen[1], rtol=0, atol=1e-9)
        return not fixed and frozenset((one, other)) not in disabled

    expected = smallest_distance(robot, q, tested)
    np.testing.assert_allclose(bik.obstacles.clearance(robot, q), expected, rtol=0, atol=1e-9)
    for stance in robot.stances.values():
        assert bik.obstacles.clearance(robot, stance) > 0


@needs_shared
@pytest.mark.parametrize(("name", "tip"), [("panda", "panda_hand"), ("ur5", "robotiq_85_base_link")])
def test_pairs_found_by_sampling_miss_no_contact(name: str, tip: str) -> None:
    file = MODELS / name / f"{name}_spherized.urdf"
    by_srdf = bik.Robot.from_urdf(file, tip=tip, srdf=MODELS / name / f"{name}.srdf")
    sampled = bik.Robot.from_urdf(file, tip=tip)
    q = sampled.random_configurations(3000, seed=6)
    touching = bik.obstacles.clearance(by_srdf, q) < 0
    found = bik.obstacles.clearance(sampled, q) < 0
    assert np.all(found[touching])
    assert np.mean(found & ~touching) < 0.005


def test_what_is_grasped_collides_with_what_is_around() -> None:
    part = bik.obstacles.Box((0, 0, 0.15), (0.04, 0.04, 0.3))
    carrying = PANDA.with_attached("flange", part, touch=["link_6"], name="stick")
    assert carrying.all_link_names[-1] == "stick"
    assert ("link_6", "stick") not in carrying.collision_pairs
    same = bik.obstacles.Box((0, 0, 0.15), (0.04, 0.04, 0.3), touch=["link_6"])
    assert PANDA.with_attached("flange", same, name="stick").collision_pairs == carrying.collision_pairs
    end = carrying.fk(READY, link="stick") @ [0, 0, 0.3, 1]
    ball = bik.obstacles.Sphere(end[:3], 0.02)
    assert bik.obstacles.clearance(PANDA, READY, [ball]) > 0.1 > 0 > bik.obstacles.clearance(carrying, READY, [ball])
    nearest = bik.obstacles.nearest(carrying, READY, [ball])
    assert nearest.body == "stick"


HAND = bik.Robot.from_urdf(GRIPPER, tip="hand")
LINKS = "its links: base, upper, hand, left, right"


@pytest.mark.parametrize(
    ("call", "kind", "message"),
    [
        (
            lambda: HAND.with_collision_pairs([("hand", "bse")]),
            bik.UnknownNameError,
            f"robot 'arm' has no link 'bse' (did you mean 'base'?); {LINKS}",
        ),
        (
            lambda: HAND.with_collision_pairs(["hand"]),  # type: ignore[list-item]
            bik.InvalidInputError,
            "pairs must be a list of (link, link), got ['hand']",
        ),
        (
            lambda: HAND.with_srdf("<robot><disable_collisions link1='a' link2='b'/></robot>"),
            bik.UrdfError,
            "SRDF: it is for another robot: 'arm' has no link 'a' and none of the pairs that it disables; " + LINKS,
        ),
        (
            lambda: HAND.with_attached("hnd", bik.obstacles.Sphere((0, 0, 0), 0.1)),
            bik.UnknownNameError,
            f"robot 'arm' has no link 'hnd' (did you mean 'hand'?); {LINKS}",
        ),
        (
            lambda: HAND.with_attached("hand", 3),  # type: ignore[arg-type]
            bik.InvalidInputError,
            "shape must be made by bik.obstacles, such as Sphere or Box, got 3",
        ),
        (
            lambda: bik.Robot.from_urdf(GRIPPER, tip="hand", collision="hull"),  # type: ignore[arg-type]
            bik.InvalidInputError,
            "collision must be one of 'primitives', 'fit', 'hulls' or None, got 'hull'",
        ),
    ],
)
def test_mistakes_are_told(call: Callable[[], object], kind: type[Exception], message: str) -> None:
    with pytest.raises(kind) as told:
        call()
    assert str(told.value) == message
