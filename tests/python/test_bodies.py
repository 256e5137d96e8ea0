"""Bodies of robots: shapes, origins, and the pairs that are compared."""

import copy
import pickle
from pathlib import Path

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


CUBE = np.array([[x, y, z] for x in (-0.1, 0.1) for y in (-0.1, 0.1) for z in (-0.1, 0.1)])
CORNER = [[0, 0, 0], [0.2, 0, 0], [0, 0.2, 0], [0, 0, 0.2], [0.05, 0.05, 0.05]]  # the last one is inside
FACES = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 4], [2, 3, 4], [3, 1, 4]]


def write_obj(file: Path, vertices: object, faces: object) -> None:
    lines = [f"v {' '.join(map(repr, map(float, vertex)))}" for vertex in np.asarray(vertices)]
    lines += [f"f {' '.join(map(str, face + 1))}" for face in np.asarray(faces)]
    file.write_text("\n".join(lines))


@pytest.fixture
def meshed(tmp_path: Path) -> str:
    """Returns a URDF whose tip is a mesh, and whose base is a box and a cylinder."""
    write_obj(tmp_path / "corner.obj", CORNER, FACES)
    primitives = "<collision><geometry><cylinder radius='0.1' length='0.4'/></geometry></collision>"
    mesh = (
        "<collision><origin xyz='0 0 0.1' rpy='0 0 1.5'/><geometry><mesh filename='corner.obj'/></geometry></collision>"
    )
    urdf = ARM.replace("</link>", primitives + "</link>", 1).replace("</link>\n  <joint", mesh + "</link>\n  <joint")
    (tmp_path / "arm.urdf").write_text(urdf)
    return str(tmp_path / "arm.urdf")


def test_hulls_keep_shapes_and_replace_meshes(meshed: str) -> None:
    robot = bik.Robot.from_urdf(meshed, collision="hulls")
    kinds = [(body.link, type(body.shape).__name__, body.source) for body in robot.bodies]
    assert kinds == [
        ("base", "Sphere", "collision shape"),
        ("base", "Cylinder", "collision shape"),
        ("tip", "Box", "collision shape"),
        ("tip", "ConvexMesh", "mesh corner.obj"),
    ]
    place = bik.pose((0, 0, 0.1), rpy=(0, 0, 1.5))
    expected = np.array(CORNER[:4]) @ place[:3, :3].T + place[:3, 3]
    hull = robot.bodies[-1].shape.points  # type: ignore[attr-defined]
    np.testing.assert_allclose(sorted(hull.tolist()), sorted(expected.tolist()), atol=1e-12)
    assert robot.unread_collision_shapes == []
    assert robot.mesh_fits == []
    assert pickle.loads(pickle.dumps(robot)) == robot


def test_hulls_are_nearer_to_the_mesh_than_capsules(meshed: str) -> None:
    obstacle = bik.obstacles.Sphere((0.5, 0.5, 1.3), 0.05)
    hulls, fit = (bik.Robot.from_urdf(meshed, collision=way) for way in ("hulls", "fit"))
    q = np.linspace(-1, 1, 21)[:, None]
    assert (bik.obstacles.clearance(fit, q, [obstacle]) <= bik.obstacles.clearance(hulls, q, [obstacle]) + 1e-9).all()


def test_a_mesh_in_a_plane_is_covered_by_capsules(meshed: str) -> None:
    write_obj(Path(meshed).with_name("corner.obj"), [[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    robot = bik.Robot.from_urdf(meshed, collision="hulls")
    assert type(robot.bodies[-1].shape).__name__ in ("Capsule", "Sphere")
    assert [fit[:2] for fit in robot.mesh_fits] == [("tip", "corner.obj")]


def test_meshes_of_links_are_read_in_the_frame_of_their_link(meshed: str) -> None:
    for collision in ("primitives", "fit", "hulls"):
        ((link, mesh),) = bik.Robot.from_urdf(meshed, collision=collision).collision_meshes()
        assert (link, mesh.closed) == ("tip", True)
        place = bik.pose((0, 0, 0.1), rpy=(0, 0, 1.5))
        np.testing.assert_allclose(mesh.vertices, np.array(CORNER) @ place[:3, :3].T + place[:3, 3], atol=1e-12)
    assert bik.Robot.from_urdf(meshed, collision=None).collision_meshes() == []
    robot = bik.Robot.from_urdf(meshed)
    Path(meshed).with_name("corner.obj").unlink()
    with pytest.raises(bik.BeetleIkError, match=r"corner\.obj"):
        robot.collision_meshes()
    assert bik.Robot.from_urdf(meshed).collision_meshes() == []


@pytest.mark.parametrize("content", [b"v 0 0 nan\nf 1 1 1", b"", b"v 0 0 0\nf 1 2 3", b"\x00\xff" * 40])
@pytest.mark.parametrize("collision", ["fit", "hulls"])
def test_broken_meshes_are_named(meshed: str, content: bytes, collision: str) -> None:
    Path(meshed).with_name("corner.obj").write_bytes(content)
    with pytest.raises(bik.BeetleIkError, match=r"corner\.obj"):
        bik.Robot.from_urdf(meshed, collision=collision)
    assert bik.Robot.from_urdf(meshed).unread_collision_shapes == ["a mesh of link 'tip'"]


def test_huge_meshes_become_hulls(meshed: str) -> None:
    rng = np.random.default_rng(1)
    points = rng.standard_normal((30_000, 3))
    points *= 0.1 / np.linalg.norm(points, axis=1)[:, None]
    points[1000:] *= rng.uniform(0.5, 0.9, (29_000, 1))
    write_obj(Path(meshed).with_name("corner.obj"), points, rng.integers(0, 30_000, (50_000, 3)))
    robot = bik.Robot.from_urdf(meshed, collision="hulls")
    corners = robot.bodies[-1].shape.points  # type: ignore[attr-defined]
    assert 500 < len(corners) <= 1000


def test_meshes_of_mujoco_models_become_bodies() -> None:
    pytest.importorskip("mujoco")
    vertices = " ".join(repr(float(x)) for x in CUBE.ravel())
    model = f"""
    <mujoco>
      <asset><mesh name="cube" vertex="{vertices}"/></asset>
      <worldbody>
        <body name="arm" pos="0 0 1">
          <joint name="j" axis="0 0 1" range="-60 60"/>
          <geom type="mesh" mesh="cube" pos="0.3 0.2 0.1" euler="0 0 30"/>
        </body>
      </worldbody>
    </mujoco>"""
    plain, hulls, fit = (bik.Robot.from_mjcf(model, collision=way) for way in ("primitives", "hulls", "fit"))
    assert plain.unread_collision_shapes == ["a mesh of link 'arm'"]
    (body,) = hulls.bodies
    turn = bik.pose((0.3, 0.2, 0.1), rpy=(0, 0, np.pi / 6))
    expected = CUBE @ turn[:3, :3].T + turn[:3, 3]
    for corner in body.shape.points:  # type: ignore[attr-defined]
        assert np.linalg.norm(expected - corner, axis=1).min() < 1e-6
    assert len(fit.mesh_fits) == 1
    ball = bik.obstacles.Sphere((0.6, 0.2, 1.1), 0.05)
    assert bik.obstacles.clearance(fit, [0.0], [ball]) < bik.obstacles.clearance(hulls, [0.0], [ball])
    assert hulls.collision_meshes() == []  # the files were only for loading
