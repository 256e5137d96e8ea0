"""Scenes: obstacles kept together, saved, loaded, and from other libraries."""

import copy
import json
import pickle
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import beetle_ik as bik

SHAPES: list[dict[str, Any]] = [
    {"type": "sphere", "center": [0.1, 0.2, 0.3], "radius": 0.5},
    {"type": "box", "center": [0.1, 0.2, 0.3], "size": [1, 2, 3], "rotation": [[0, -1, 0], [1, 0, 0], [0, 0, 1]]},
    {"type": "capsule", "a": [0, 0, 0], "b": [1, 0, 0], "radius": 0.25},
    {"type": "ellipsoid", "center": [0.1, 0.2, 0.3], "semi_axes": [1, 2, 3]},
    {"type": "ellipse", "center": [0.1, 0.2], "semi_axes": [1, 2], "angle": 0.7},
    {"type": "convex_mesh", "points": [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]},
]
OBSTACLES = [
    bik.obstacles.Sphere([0.1, 0.2, 0.3], 0.5),
    bik.obstacles.Box([0.1, 0.2, 0.3], [1, 2, 3], rotation=[[0, -1, 0], [1, 0, 0], [0, 0, 1]]),
    bik.obstacles.Capsule([0, 0, 0], [1, 0, 0], 0.25),
    bik.obstacles.Ellipsoid([0.1, 0.2, 0.3], [1, 2, 3]),
    bik.obstacles.Ellipse([0.1, 0.2], [1, 2], angle=0.7),
    bik.obstacles.ConvexMesh([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]),
]


@pytest.fixture
def scene(tmp_path: Path) -> Path:
    return tmp_path / "scene.json"


@pytest.mark.parametrize("whole", [SHAPES, {"obstacles": SHAPES}], ids=["a list", "an object"])
def test_a_scene_holds_every_shape(scene: Path, whole: object) -> None:
    scene.write_text(json.dumps(whole))
    assert list(bik.Scene.load(scene)) == OBSTACLES


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("{", "not JSON: "),
        ("9" * 5000, "not JSON: Exceeds the limit"),
        ("3", 'expected a list of shapes, or an object with such a list as "obstacles"'),
        ('{"shapes": []}', 'expected a list of shapes, or an object with such a list as "obstacles"'),
        ("[1]", 'obstacle 0: expected an object with a "type", one of sphere, box, capsule'),
        ('[{"type": "cone"}]', "obstacle 0: unknown type 'cone'; types: sphere, box, capsule"),
        (
            '[{"type": "sphere", "center": [0, 0, 0]}]',
            "obstacle 0 (sphere): the key 'radius' is missing; keys: center, radius, touch",
        ),
        ('[{"type": "sphere", "center": [0, 0], "radius": 1}]', "obstacle 0 (sphere): center: expected shape (3,)"),
        ('[{"type": "sphere", "center": [0, 0, 0], "radius": -1}]', "obstacle 0 (sphere): "),
        ('[{"type": "sphere", "center": [0, 0, NaN], "radius": 1}]', "obstacle 0 (sphere): "),
        ('[{"type": "box", "center": [0, 0, 0], "size": [1, 1, 1], "color": 1}]', "obstacle 0 (box): "),
        (
            '[{"type": "sphere", "center": [0, 0, 0], "radius": 1, "touch": "base"}]',
            "obstacle 0 (sphere): touch must be a list of link names, got 'base'",
        ),
        (
            '{"version": 2, "obstacles": []}',
            "a scene of version 2; this beetle-ik reads version 1: use a later beetle-ik",
        ),
        ('{"version": "1", "obstacles": []}', "\"version\" must be 1, got '1'"),
        ('{"obstacles": [], "units": "mm"}', 'unknown key \'units\'; keys: "version", "obstacles"'),
    ],
)
def test_what_is_no_scene_is_refused(scene: Path, text: str, problem: str) -> None:
    scene.write_text(text)
    with pytest.raises(bik.InvalidInputError) as caught:
        bik.Scene.load(scene)
    assert str(caught.value).startswith(f"{scene}: {problem}")


EVERY_KIND = [
    *OBSTACLES,
    bik.obstacles.Cylinder([0.1, 0.2, 1 / 3], [0.1, 0.2, 0.3], 0.05, 0.4),
    bik.obstacles.HalfSpace([0.0, 0.6, 0.8], -0.1),
    bik.obstacles.Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]),
    bik.obstacles.PointCloud([[0.1, 0.2, 0.3], [1, 2, 3]], 0.01),
    bik.obstacles.Grid([0, 0, 0], 0.1, [[[True, False]]]),
]
TOUCHED = [
    bik.obstacles.Sphere([0.1, 0.2, 0.3], 0.5, touch=["base", "link_1"]),
    bik.obstacles.Box([0.1, 0.2, 0.3], [1, 2, 3], [[0, -1, 0], [1, 0, 0], [0, 0, 1]], touch=["base"]),
    bik.obstacles.Capsule([0, 0, 0], [1, 0, 0], 0.25, touch=["base"]),
    bik.obstacles.Ellipsoid([0.1, 0.2, 0.3], [1, 2, 3], touch=["base"]),
    bik.obstacles.Ellipse([0.1, 0.2], [1, 2], touch=["base"]),
    bik.obstacles.ConvexMesh([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], touch=["base"]),
    bik.obstacles.Cylinder([0.1, 0.2, 1 / 3], [0.1, 0.2, 0.3], 0.05, 0.4, touch=["base"]),
    bik.obstacles.HalfSpace([0.0, 0.6, 0.8], -0.1, touch=["base"]),
    bik.obstacles.Mesh([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]], touch=["base"]),
    bik.obstacles.PointCloud([[0.1, 0.2, 0.3], [1, 2, 3]], 0.01, touch=["base"]),
    bik.obstacles.Grid([0, 0, 0], 0.1, [[[True, False]]], touch=["base"]),
]


def test_a_saved_scene_is_loaded_bit_by_bit(scene: Path) -> None:
    before = bik.Scene(EVERY_KIND + TOUCHED)
    before.save(scene)
    after = bik.Scene.load(scene)
    assert after == before
    assert [shape.touch for shape in after] == [()] * 11 + [("base", "link_1")] + [("base",)] * 10
    assert json.loads(scene.read_text())["version"] == 1


def test_an_empty_scene_is_saved_and_loaded(scene: Path) -> None:
    bik.Scene().save(scene)
    assert len(bik.Scene.load(scene)) == 0


def test_a_scene_is_an_immutable_sequence() -> None:
    scene = bik.Scene(OBSTACLES)
    assert list(scene) == OBSTACLES
    assert scene[0] == OBSTACLES[0]
    assert scene[-1] == OBSTACLES[-1]
    assert scene[1:3] == bik.Scene(OBSTACLES[1:3])
    assert scene[:2] + OBSTACLES[2:] == scene
    assert OBSTACLES[1] in scene
    assert scene != OBSTACLES
    assert len({scene, bik.Scene(OBSTACLES)}) == 1
    assert pickle.loads(pickle.dumps(scene)) == scene
    assert copy.deepcopy(scene) == scene
    assert repr(scene[:1]) == "Scene([obstacles.Sphere([0.1, 0.2, 0.3], 0.5)])"
    assert repr(scene + OBSTACLES) == "<Scene: 12 obstacles>"


@pytest.mark.parametrize("shape", TOUCHED, ids=[type(shape).__name__ for shape in TOUCHED])
def test_who_may_touch_an_obstacle_is_part_of_its_value(shape: bik.obstacles.Obstacle) -> None:
    for copied in (pickle.loads(pickle.dumps(shape)), copy.deepcopy(shape)):
        assert (copied, hash(copied), repr(copied), copied.touch) == (shape, hash(shape), repr(shape), shape.touch)
    arguments, named = shape.__getnewargs_ex__()
    free = type(shape)(*arguments, **{**named, "touch": None})
    assert free != shape
    assert free.touch == ()
    assert repr(shape) == f"{repr(free)[:-1]}, touch={json.dumps(list(shape.touch))})"


def test_links_that_may_touch_are_a_set() -> None:
    def ball(touch: Any) -> bik.obstacles.Sphere:
        return bik.obstacles.Sphere([0, 0, 0], 1, touch=touch)

    assert ball(["b", "a", "b"]) == ball(("a", "b"))
    assert ball(["b", "a", "b"]).touch == ("a", "b")
    assert ball([]) == ball(None) == bik.obstacles.Sphere([0, 0, 0], 1)
    for wrong in ("base", 3, [3], [["base"]]):
        with pytest.raises(bik.InvalidInputError) as caught:
            ball(wrong)
        assert str(caught.value) == f"touch must be a list of link names, got {wrong!r}"


@pytest.mark.parametrize(
    ("given", "message"),
    [
        (3, "obstacles must be a list of bik.obstacles, got 3"),
        ([OBSTACLES[0], "box"], "obstacle 1 must be made by bik.obstacles, such as Sphere or Box, got 'box'"),
        (OBSTACLES[0], "obstacles must be a list, got a single one: [obstacles.Sphere([0.1, 0.2, 0.3], 0.5)]"),
    ],
)
def test_what_is_no_obstacle_is_refused(given: Any, message: str) -> None:
    with pytest.raises(bik.InvalidInputError) as caught:
        bik.Scene(given)
    assert str(caught.value) == message


def test_a_scene_is_taken_where_a_list_is() -> None:
    arm = bik.Robot.named("panda").with_capsules(radius=0.05)
    q = [0.0, 0.3, 0.0, -1.5, 0.0, 1.8, 0.8]
    scene = bik.Scene([bik.obstacles.Sphere([0.8, 0.0, 0.9], 0.05)])
    assert bik.obstacles.clearance(arm, q, scene) == bik.obstacles.clearance(arm, q, list(scene))
    assert bik.obstacles.nearest(arm, q, scene) == bik.obstacles.nearest(arm, q, list(scene))
    plans = [
        bik.plan_point_to_point(
            arm, start_q=q, end_q=[0.8, *q[1:]], limits=bik.Limits(acceleration=5.0), obstacles=given
        )
        for given in (scene, list(scene))
    ]
    assert plans[0].clearance == plans[1].clearance


MOVEIT = """
name: shelf
world:
  collision_objects:
    - id: table
      header: {frame_id: base}
      pose: {position: {x: 1, y: 0, z: 0}, orientation: {x: 0, y: 0, z: 0.7071067811865476, w: 0.7071067811865476}}
      primitives: [{type: 1, dimensions: [0.2, 0.4, 0.6]}, {type: 2, dimensions: [0.3]}]
      primitive_poses:
        - {position: {x: 0.5, y: 0, z: 0.3}, orientation: {x: 0, y: 0, z: 0, w: 1}}
        - {position: [0, 0, 1], orientation: [0, 0, 0, 1]}
    - id: can
      header: {frame_id: base}
      primitives: [{type: cylinder, dimensions: [0.4, 0.05]}]
      primitive_poses: [{position: [0, 0, 0], orientation: [0.7071067811865476, 0, 0, 0.7071067811865476]}]
      meshes:
        - vertices: [{x: 0, y: 0, z: 0}, {x: 1, y: 0, z: 0}, {x: 0, y: 1, z: 0}]
          triangles: [{vertex_indices: [0, 1, 2]}]
      mesh_poses: [{position: [0, 0, 2], orientation: [0, 0, 0, 1]}]
"""


@pytest.mark.parametrize("many", [1, 40])
def test_a_scene_and_the_list_of_its_obstacles_are_the_same_to_every_call(many: int) -> None:
    robot = bik.Robot.named("panda").with_capsules(radius=0.05)
    boxes = [bik.obstacles.Box((0.5 + 0.01 * i, 0.4, 0.3 + 0.02 * i), (0.1, 0.1, 0.01)) for i in range(many)]
    scene = bik.Scene(boxes)
    q = np.array([0.2, -0.4, 0.1, -2.0, 0.0, 1.8, 0.6])
    calls: list[Callable[[Any], Any]] = [
        lambda obstacles: bik.solve(robot, robot.fk(q), obstacles=obstacles).q,
        lambda obstacles: bik.solve_all(robot, robot.fk(q), obstacles=obstacles).q,
        lambda obstacles: bik.solve_batch(robot, robot.fk(np.array([q, -q])), obstacles=obstacles).q,
        lambda obstacles: bik.obstacles.clearance(robot, q, obstacles),
        lambda obstacles: bik.obstacles.nearest(robot, q, obstacles),
        lambda obstacles: bik.Tracker(robot, start_q=q, dt=0.01, obstacles=obstacles).obstacles,
        lambda obstacles: bik.plan_point_to_point(robot, start_q=q, end_q=q + 0.1, obstacles=obstacles).obstacles,
    ]
    for call in calls:
        for _ in range(2):
            np.testing.assert_array_equal(call(scene), call(boxes))
            np.testing.assert_array_equal(call(tuple(boxes)), call(boxes))


def test_a_scene_that_was_used_is_copied_and_pickled() -> None:
    scene = bik.Scene(obstacle for obstacle in OBSTACLES if not isinstance(obstacle, bik.obstacles.Ellipse))
    robot = bik.Robot.named("panda").with_capsules(radius=0.05)
    before = bik.obstacles.clearance(robot, np.zeros(7), scene)
    for copied in (copy.copy(scene), copy.deepcopy(scene), pickle.loads(pickle.dumps(scene))):
        assert copied == scene
        assert bik.obstacles.clearance(robot, np.zeros(7), copied) == before


def moveit(tmp_path: Path, text: str, **options: Any) -> bik.Scene:
    pytest.importorskip("yaml")
    file = tmp_path / "scene.yaml"
    file.write_text(text)
    return bik.Scene.from_moveit(file, **options)


def test_the_objects_of_a_moveit_scene_keep_their_places(tmp_path: Path) -> None:
    box, ball, can, mesh = moveit(tmp_path, MOVEIT)
    np.testing.assert_allclose(box.center, [1.0, 0.5, 0.3], atol=1e-12)
    np.testing.assert_allclose(box.rotation, [[0, -1, 0], [1, 0, 0], [0, 0, 1]], atol=1e-12)
    np.testing.assert_allclose([*ball.center, ball.radius], [1, 0, 1, 0.3], atol=1e-12)
    np.testing.assert_allclose(np.abs(can.axis), [0, 1, 0], atol=1e-12)
    assert (can.length, can.radius) == (0.4, 0.05)
    np.testing.assert_allclose(mesh.vertices, [[0, 0, 2], [1, 0, 2], [0, 1, 2]])
    moved = moveit(tmp_path, MOVEIT, frame=bik.pose([0, 0, -1], rpy=[0, 0, np.pi]))
    np.testing.assert_allclose(moved[0].center, [-1.0, -0.5, -0.7], atol=1e-12)


@pytest.mark.parametrize(
    ("old", "new", "problem"),
    [
        (
            "world:",
            "place:",
            'expected a MoveIt planning scene: a mapping with "world", or the .scene text of RViz',
        ),
        ("world:", "world: [", "not YAML: "),
        ("world:", f"number: {'9' * 5000}\nworld:", "not YAML: Exceeds the limit"),
        ("world:", "day: 2001-13-45\nworld:", "not YAML: month must be in 1..12"),
        ("[0.3]", f"[{'9' * 400}]", "object 'table': unreadable primitives: OverflowError"),
        (
            "type: 2",
            "type: 5",
            "object 'table': a primitive of type 'prism'; those that can be read: box, sphere, cylinder, cone",
        ),
        ("[0.3]", "[0.3, 1]", "object 'table': a sphere with 2 dimensions"),
        ("[0.3]", "[.nan]", "object 'table': "),
        ("z: 0, w: 1}}", "z: 0}}", "object 'table': a pose needs a position (x, y, z) and an orientation (x, y, z, w)"),
        (
            "base}\n      prim",
            "tip}\n      prim",
            "the objects are in several frames ('base', 'tip'); only one can be read, and those that "
            "fixed_frame_transforms lists",
        ),
        (
            "name: shelf",
            "robot_state: {attached_collision_objects: [{}]}",
            'attached object 0: expected a mapping with "link_name" and "object", got {}',
        ),
        (
            "world:",
            "world:\n  octomap: {header: {frame_id: base}, octomap: {data: [1]}}",
            "octomap: expected the fields binary, id, resolution and data (bytes), got KeyError('binary')",
        ),
        ("mesh_poses:", "places:", 'object \'can\': "meshes" and "mesh_poses" must be lists of one length'),
        (
            "id: can",
            "id: can\n      operation: 1",
            "object 'can': operation 1: only objects that are added can be read",
        ),
    ],
)
def test_what_moveit_has_and_we_have_not_is_refused(tmp_path: Path, old: str, new: str, problem: str) -> None:
    assert old in MOVEIT
    with pytest.raises(bik.InvalidInputError) as caught:
        moveit(tmp_path, MOVEIT.replace(old, new, 1))
    assert str(caught.value).startswith(f"{tmp_path / 'scene.yaml'}: {problem}")


def test_entries_of_moveit_that_are_no_mappings_count_as_missing(tmp_path: Path) -> None:
    strange = MOVEIT.replace("world:", "robot_state: 1\nworld:\n  octomap: {octomap: 1}", 1).replace(
        "{frame_id: base}", "1"
    )
    assert strange.count("header: 1") == MOVEIT.count("{frame_id: base}") > 0
    assert moveit(tmp_path, strange) == moveit(tmp_path, MOVEIT)


class Geometry:
    """What trimesh's meshes have, as far as they are read."""

    units = None
    is_watertight = is_convex = False

    def __init__(self, **attributes: Any) -> None:
        self.__dict__.update(attributes)


TRIANGLE = {"vertices": np.eye(3), "faces": np.array([[0, 1, 2]])}


def test_a_mesh_of_trimesh_is_an_obstacle() -> None:
    assert bik.Scene.from_trimesh(Geometry(**TRIANGLE)) == bik.Scene([bik.obstacles.Mesh(**TRIANGLE)])


@pytest.mark.parametrize(
    ("geometry", "problem"),
    [
        (3, "geometry must be a trimesh.Trimesh or a trimesh.Scene, got 3"),
        (
            Geometry(vertices=np.eye(3)),
            "the mesh has no faces; points become a bik.obstacles.PointCloud(points, radius)",
        ),
        (Geometry(units="mm", **TRIANGLE), "the mesh is in mm: use convert_units('meters') of trimesh first"),
        (Geometry(vertices=np.eye(3) * np.nan, faces=TRIANGLE["faces"]), "the mesh: "),
    ],
)
def test_what_is_no_mesh_of_trimesh_is_refused(geometry: Any, problem: str) -> None:
    with pytest.raises(bik.InvalidInputError) as caught:
        bik.Scene.from_trimesh(geometry)
    assert str(caught.value).startswith(problem)


def test_primitives_of_trimesh_become_the_exact_shape() -> None:
    trimesh = pytest.importorskip("trimesh")
    at = bik.pose([0.1, 0.2, 0.3], rpy=[0.4, 0.5, 0.6])
    parts = [
        trimesh.primitives.Box(extents=[0.1, 0.2, 0.3], transform=at),
        trimesh.primitives.Sphere(radius=0.1, center=[0.1, 0.2, 0.3]),
        trimesh.primitives.Cylinder(radius=0.1, height=0.5, transform=at),
        trimesh.primitives.Capsule(radius=0.1, height=0.5, transform=at),
        trimesh.creation.icosahedron(),
        trimesh.creation.annulus(0.1, 0.2, 0.3),
    ]
    place = bik.pose([1.0, 0.0, 0.0], rpy=[0.0, 0.0, 1.0])
    whole = trimesh.Scene()
    for i, part in enumerate(parts):
        whole.add_geometry(part, node_name=str(i), transform=place)
    obstacles = bik.Scene.from_trimesh(whole)
    names = [type(obstacle).__name__ for obstacle in obstacles]
    assert names == ["Box", "Sphere", "Cylinder", "Capsule", "ConvexMesh", "Mesh"]
    for obstacle, part in zip(obstacles, parts, strict=True):
        drawn = trimesh.transform_points(part.vertices, place)
        corners = obstacle.triangles.reshape(-1, 3)
        np.testing.assert_allclose(corners.min(axis=0), drawn.min(axis=0), atol=0.01)
        np.testing.assert_allclose(corners.max(axis=0), drawn.max(axis=0), atol=0.01)
