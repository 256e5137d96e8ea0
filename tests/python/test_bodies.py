"""Bodies of robots: what they are, where they come from, and what they are compared with."""

import copy
import pickle

import numpy as np
import pytest

import beetle_ik as bik

BOX = bik.obstacles.Box((0, 0, 0.1), (0.05, 0.1, 0.2), rotation=bik.pose((0, 0, 0), rpy=(0.1, 0.2, 0.3))[:3, :3])
ARM = """
<robot name="arm">
  <link name="base">
    <collision><origin xyz="0 0 0.05"/><geometry><sphere radius="0.1"/></geometry></collision>
  </link>
  <link name="tip"><collision><geometry><box size="0.1 0.2 0.4"/></geometry></collision></link>
  <joint name="j" type="revolute">
    <parent link="base"/><child link="tip"/><origin xyz="0 0 1"/><axis xyz="0 0 1"/>
    <limit lower="-1" upper="1" velocity="1" effort="1"/>
  </joint>
</robot>"""


def test_bodies_name_their_link_shape_and_source() -> None:
    robot = bik.Robot.from_urdf(ARM)
    ball, box = robot.bodies
    assert (ball.link, ball.source, ball.shape) == ("base", "collision shape", bik.obstacles.Sphere((0, 0, 0.05), 0.1))
    assert (box.link, box.source, type(box.shape).__name__) == ("tip", "collision shape", "Capsule")
    assert repr(ball) == "<Body of 'base': Sphere, collision shape>"
    given = bik.Robot.named("panda").with_capsules([("flange", (0, 0, 0), (0, 0, 0.1), 0.0)]).bodies[0]
    assert (given.source, given.shape.radius) == ("given", 0.0)  # type: ignore[attr-defined]
    assert bik.Robot.named("panda").bodies == []


@pytest.mark.parametrize(
    "shape",
    [
        BOX,
        bik.obstacles.Sphere((0, 0, 0.1), 0.05),
        bik.obstacles.Capsule((0, 0, 0), (0, 0, 0.1), 0.05),
        bik.obstacles.Cylinder((0, 0, 0.1), (0, 1, 1), 0.05, 0.2),
        bik.obstacles.Ellipsoid((0, 0, 0.1), (0.05, 0.06, 0.07)),
        bik.obstacles.ConvexMesh([(0, 0, 0), (0.1, 0, 0), (0, 0.1, 0), (0, 0, 0.1)]),
    ],
    ids=lambda shape: type(shape).__name__,
)
def test_an_attached_shape_comes_back_as_it_was(shape: bik.obstacles.Obstacle) -> None:
    robot = bik.Robot.named("panda").with_attached("flange", shape, name="part")
    body = robot.bodies[-1]
    assert (body.link, body.source) == ("part", "attached")
    assert body.shape == shape
    assert (type(body.shape), repr(body.shape)) == (type(shape), repr(shape))
    for again in (copy.deepcopy(body), pickle.loads(pickle.dumps(body)), pickle.loads(pickle.dumps(robot)).bodies[-1]):
        assert again == body
        assert hash(again) == hash(body)


def test_the_base_is_compared_with_obstacles() -> None:
    robot = bik.Robot.from_urdf(ARM)
    ball = bik.obstacles.Sphere((-0.5, 0, 0.05), 0.1)
    nearest = bik.obstacles.nearest(robot, [0.5], [ball])
    assert nearest is not None
    assert (nearest.body, nearest.other) == ("base", "obstacle 0 (Sphere)")
    assert nearest.distance == pytest.approx(0.3, abs=1e-9)
    np.testing.assert_allclose(nearest.gradient, [0.0])
    table = bik.obstacles.Box((0, 0, -0.1), (1, 1, 0.15))
    with pytest.raises(bik.InvalidInputError, match="base"):
        bik.plan_point_to_point(robot, start_q=[0.0], end_q=[0.5], obstacles=[table])
