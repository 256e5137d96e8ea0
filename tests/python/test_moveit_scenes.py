"""Planning scenes of MoveIt: the text of RViz, objects that the robot carries, frames, and octomaps in messages."""

import copy
import pickle
import struct
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import beetle_ik as bik

PANDA = bik.Robot.named("panda").with_capsules(radius=0.06)
Q = np.array([0.0, -0.3, 0.0, -2.0, 0.0, 1.8, 0.8])

# As MoveIt of ROS 2 and Noetic writes it: objects have a pose and subframes.
NEW = """cell+
* table
0.5 0 0.1
0 0 0.707107 0.707107
2
box
0.6 1.2 0.05
0.1 0 0
0 0 0 1
0 0 0 0
sphere
0.2
0 0 1
0 0 0 1
0.5 0.5 0.5 1
1
corner
0.3 0.6 0
0 0 0 1
* a tall post
0 0 0
0 0 0 1
1
cylinder
0.05 0.6
0.35 -0.35 0.4
0.707107 0 0 0.707107
0 0 0 0
0
.
"""
# As Kinetic and Melodic wrote it.
OLD = """(noname)+
* cone
1
cone
0.1 0.4
0 0 1
0 0 0 1
0 0 0 0
* mesh
1
mesh
3 1
0 0 0
1 0 0
0 1 0
0 1 2
0 0 2
0 0 0 1
1 0 0 1
.
"""
HELD = """
world: {collision_objects: []}
robot_state:
  attached_collision_objects:
    - link_name: link_7
      touch_links: [link_5]
      object:
        id: part
        header: {frame_id: link_7}
        pose: {position: {x: 0, y: 0, z: 0.1}, orientation: {x: 0, y: 0, z: 0, w: 1}}
        primitives: [{type: 1, dimensions: [0.03, 0.04, 0.1]}, {type: 2, dimensions: [0.05]}]
        primitive_poses:
          - {position: {x: 0, y: 0, z: 0.05}, orientation: {x: 0, y: 0, z: 0, w: 1}}
          - {position: {x: 0, y: 0, z: 0.2}, orientation: {x: 0, y: 0, z: 0, w: 1}}
"""


def read(folder: Path, text: str, name: str = "cell.scene", **options: Any) -> bik.Scene:
    if name.endswith("yaml"):
        pytest.importorskip("yaml")
    (folder / name).write_text(text)
    return bik.Scene.from_moveit(folder / name, **options)


@pytest.mark.parametrize("name", ["cell.scene", "cell.txt"])
def test_the_text_of_rviz_is_read(tmp_path: Path, name: str) -> None:
    box, ball, post = read(tmp_path, NEW, name)
    np.testing.assert_allclose(box.center, [0.5, 0.1, 0.1], atol=1e-6)
    np.testing.assert_allclose(box.rotation, [[0, -1, 0], [1, 0, 0], [0, 0, 1]], atol=1e-6)
    assert tuple(box.size) == (0.6, 1.2, 0.05)
    np.testing.assert_allclose([*ball.center, ball.radius], [0.5, 0, 1.1, 0.2], atol=1e-12)
    np.testing.assert_allclose(post.center, [0.35, -0.35, 0.4])
    np.testing.assert_allclose(np.abs(post.axis), [0, 1, 0], atol=1e-6)
    assert (post.radius, post.length) == (0.05, 0.6)
    moved = read(tmp_path, NEW, name, frame=bik.pose([0, 0, -1], rpy=[0, 0, np.pi]))
    np.testing.assert_allclose(moved[0].center, [-0.5, -0.1, -0.9], atol=1e-6)


def test_the_older_text_has_no_poses_of_objects(tmp_path: Path) -> None:
    cone, mesh = read(tmp_path, OLD)
    np.testing.assert_allclose(mesh.vertices, [[0, 0, 2], [1, 0, 2], [0, 1, 2]])
    assert mesh.faces.tolist() == [[0, 1, 2]]
    height = cone.points[:, 2]
    assert (height.min(), height.max()) == (0.8, 1.2)
    np.testing.assert_allclose(cone.points[height == 1.2], [[0, 0, 1.2]])
    rng = np.random.default_rng(0)
    around, down = rng.uniform(0, 2 * np.pi, 500), np.sqrt(rng.uniform(0, 1, 500))
    surface = np.c_[0.1 * down * np.cos(around), 0.1 * down * np.sin(around), 1.2 - 0.4 * down]
    dot = bik.Robot.planar([1.0]).with_capsules([("base", (0, 0, 0), (0, 0, 0), 0.0)]).with_collision_pairs([])
    for point in surface:
        away = bik.obstacles.ConvexMesh(cone.points - point)
        assert -2e-4 < bik.obstacles.clearance(dot, [0.0], [away]) <= 1e-9


def test_a_scene_without_objects_is_empty(tmp_path: Path) -> None:
    assert list(read(tmp_path, "cell\n.\n")) == []
    assert list(read(tmp_path, "\n.\n")) == []


@pytest.mark.parametrize(
    ("old", "new", "problem"),
    [
        (
            "cell+\n",
            "cell+\nrubbish\n",
            "line 2: expected '*' and the name of an object, or '.' at the end, got 'rubbish'",
        ),
        ("* table", "*", "line 2: expected the name of an object, got nothing"),
        ("2\nbox", "two\nbox", "line 5: expected the number of shapes of object 'table', got 'two'"),
        (
            "box",
            "octree",
            "line 6: expected the kind of shape 0 of object 'table': box, sphere, cylinder, cone, mesh, got 'octree'",
        ),
        (
            "0.6 1.2 0.05",
            "0.6 1.2",
            "line 7: expected the sizes (x y z) of shape 0 of object 'table', a box, got '0.6 1.2'",
        ),
        ("0.6 1.2 0.05", "0.6 1.2 -1", "line 6: shape 0 of object 'table': size of the box along z must be positive"),
        (
            "box\n0.6 1.2 0.05",
            "plane\n0 0 1 0",
            "line 6: shape 0 of object 'table': a plane has two sides: use a bik.obstacles.HalfSpace or a thin Box",
        ),
        ("0 0 0.707107 0.707107", "0 0 0 0", "line 4: object 'table': length of the quaternion must be positive"),
        ("0.1 0 0\n", "0.1 x 0\n", "line 8: expected the position (x y z) of shape 0 of object 'table', got '0.1 x 0'"),
        ("\n.\n", "\n", "line 29: expected '*' and the name of an object, or '.' at the end, and the file ends"),
        ("\n.\n", "\n.\n* more\n", "line 31: expected nothing after '.', got '*'"),
    ],
)
def test_mistakes_in_the_text_name_the_line(tmp_path: Path, old: str, new: str, problem: str) -> None:
    assert old in NEW
    with pytest.raises(bik.InvalidInputError) as caught:
        read(tmp_path, NEW.replace(old, new, 1))
    assert str(caught.value).startswith(f"{tmp_path / 'cell.scene'}: {problem}")


@pytest.mark.parametrize("text", [NEW, OLD])
def test_a_text_that_is_cut_off_is_refused(tmp_path: Path, text: str) -> None:
    whole = text.rstrip()
    for end in range(len(whole)):
        with pytest.raises(bik.InvalidInputError, match=r"cell\.scene: line \d+: "):
            read(tmp_path, whole[:end])


def test_what_the_robot_carries_can_be_attached(tmp_path: Path) -> None:
    scene = read(tmp_path, HELD, "held.yaml")
    box, ball = scene.attached
    assert [(entry.link, entry.touch, entry.name) for entry in scene.attached] == [
        ("link_7", ("link_5",), "part"),
        ("link_7", ("link_5",), "part_2"),
    ]
    np.testing.assert_allclose(box.shape.center, [0, 0, 0.15])
    np.testing.assert_allclose(ball.shape.center, [0, 0, 0.3])
    by_hand = PANDA
    for link, shape, touch, name in scene.attached:
        by_hand = by_hand.with_attached(link, shape, touch=touch, name=name)
    carrying = scene.attach_to(PANDA)
    assert carrying == by_hand
    wall = bik.obstacles.HalfSpace((0, 0, -1), -(carrying.fk(Q)[2, 3] - 0.2))
    among = scene + bik.Scene([wall])
    assert among.attached == scene.attached == scene[:0].attached == bik.Scene(scene).attached
    assert bik.obstacles.clearance(carrying, Q, among) == bik.obstacles.clearance(by_hand, Q, [wall])


@pytest.mark.parametrize("call", ["clearance", "solve", "solve_batch", "plan", "tracker", "map", "in chunks", "view"])
def test_no_call_leaves_out_what_the_robot_carries(tmp_path: Path, call: str) -> None:
    scene = read(tmp_path, HELD, "held.yaml")
    carrying, target = scene.attach_to(PANDA), PANDA.fk(Q)
    limits = bik.Limits(velocity=1.0, acceleration=2.0)
    if call == "in chunks":
        pytest.importorskip("dask")
    if call == "view":
        pytest.importorskip("viser")

    def made(robot: bik.Robot) -> object:
        match call:
            case "clearance":
                return bik.obstacles.clearance(robot, Q, scene)
            case "solve":
                return bik.solve(robot, target, obstacles=scene)
            case "solve_batch":
                return bik.solve_batch(robot, target[None], obstacles=scene)
            case "plan":
                return bik.plan_point_to_point(robot, start_q=Q, end_q=Q + 0.1, obstacles=scene, limits=limits)
            case "tracker":
                return bik.Tracker(robot, Q, dt=0.1, obstacles=scene)
            case "map":
                return bik.reachability(
                    robot, voxel=0.5, rolls=1, region=((0.3, 0, 0.3), (0.5, 0.2, 0.5)), obstacles=scene
                )
            case "in chunks":
                from beetle_ik.distributed import solve_batch

                return solve_batch(None, robot, target[None], obstacles=scene)
            case _:
                return bik.view(robot, port=0, obstacles=scene).close()

    with pytest.raises(bik.InvalidInputError) as caught:
        made(PANDA)
    assert str(caught.value) == (
        "in the scene, link 'link_7' carries 'part', which robot 'panda' does not: use scene.attach_to(robot)"
    )
    made(carrying)


def test_scenes_with_attached_objects_are_kept(tmp_path: Path) -> None:
    scene = read(tmp_path, HELD, "held.yaml") + bik.Scene([bik.obstacles.Sphere((1, 0, 0), 0.1)])
    scene.save(tmp_path / "scene.json")
    for again in (bik.Scene.load(tmp_path / "scene.json"), copy.deepcopy(scene), pickle.loads(pickle.dumps(scene))):
        assert again == scene
        assert hash(again) == hash(scene)
        assert again.attached == scene.attached
        assert again != bik.Scene(list(scene))
    assert "attached=[('link_7', obstacles.Box(" in repr(scene)
    with pytest.raises(bik.InvalidInputError, match="two attached objects are called 'part'"):
        _ = scene + scene


@pytest.mark.parametrize(
    ("old", "new", "problem"),
    [
        (
            "link_name: link_7",
            "link: link_7",
            'attached object 0: expected a mapping with "link_name" and "object", got ',
        ),
        (
            "frame_id: link_7",
            "frame_id: world",
            "object 'part' on link 'link_7' is given in the frame 'world': give it in the frame of the link",
        ),
        ("type: 2, dimensions: [0.05]", "type: 2, dimensions: []", "object 'part': a sphere with 0 dimensions"),
        ("id: part", "id: part\n        operation: 1", "object 'part': operation 1: only objects that are added"),
    ],
)
def test_attached_objects_that_cannot_be_read_are_named(tmp_path: Path, old: str, new: str, problem: str) -> None:
    assert old in HELD
    with pytest.raises(bik.InvalidInputError) as caught:
        read(tmp_path, HELD.replace(old, new, 1), "held.yaml")
    assert str(caught.value).startswith(f"{tmp_path / 'held.yaml'}: {problem}")


def test_a_mesh_in_the_hand_becomes_its_hull(tmp_path: Path) -> None:
    corners = ", ".join(f"{{x: {x}, y: {y}, z: {z}}}" for x, y, z in [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)])
    mesh = f"meshes: [{{vertices: [{corners}], triangles: [{{vertex_indices: [0, 1, 2]}}]}}]\n        mesh_poses:"
    text = HELD[: HELD.index("primitives: ")] + mesh + " [{position: [0, 0, 0], orientation: [0, 0, 0, 1]}]\n"
    (entry,) = read(tmp_path, text, "held.yaml").attached
    assert entry.shape == bik.obstacles.ConvexMesh([(0, 0, 0.1), (1, 0, 0.1), (0, 1, 0.1), (0, 0, 1.1)])


FRAMES = """
fixed_frame_transforms:
  - header: {frame_id: world}
    child_frame_id: shelf
    transform: {translation: {x: 1, y: 0, z: 0}, rotation: {x: 0, y: 0, z: 0.7071067811865476, w: 0.7071067811865476}}
world:
  collision_objects:
    - id: a
      header: {frame_id: world}
      primitives: [{type: 2, dimensions: [0.1]}]
      primitive_poses: [{position: [0.5, 0, 0], orientation: [0, 0, 0, 1]}]
    - id: b
      header: {frame_id: shelf}
      primitives: [{type: 2, dimensions: [0.1]}]
      primitive_poses: [{position: [0.5, 0, 0], orientation: [0, 0, 0, 1]}]
---
"""


def test_transforms_of_the_file_place_its_frames(tmp_path: Path) -> None:
    one, other = read(tmp_path, FRAMES, "scene.yaml")
    np.testing.assert_allclose([one.center, other.center], [[0.5, 0, 0], [1, 0.5, 0]], atol=1e-12)
    one, other = read(tmp_path, FRAMES, "scene.yaml", frame=bik.pose([0, 0, 1]))
    np.testing.assert_allclose([one.center, other.center], [[0.5, 0, 1], [1, 0.5, 1]], atol=1e-12)
    with pytest.raises(bik.InvalidInputError, match=r"in several frames \('bin', 'world'\)"):
        read(tmp_path, FRAMES.replace("{frame_id: shelf}", "{frame_id: bin}"), "scene.yaml")
    with pytest.raises(bik.InvalidInputError, match="a transform that cannot be read: "):
        read(tmp_path, FRAMES.replace("translation", "position"), "scene.yaml")


def test_the_octomap_of_a_scene_becomes_a_grid(tmp_path: Path) -> None:
    # 16 levels along the corner (-, -, -) of the upper children: the voxel from the origin to (0.1, 0.1, 0.1).
    first, inner, leaf = (0b11 << 14), 0b11, 0b10
    words = [first] + [inner] * 14 + [leaf]
    data = [byte - 256 if byte > 127 else byte for word in words for byte in (word % 256, word // 256)]
    at = "{position: {x: 1, y: 2, z: 3}, orientation: {x: 0, y: 0, z: 0, w: 1}}"
    octomap = f"{{binary: true, id: OcTree, resolution: 0.1, data: {data}}}"
    text = f"world: {{octomap: {{header: {{frame_id: world}}, origin: {at}, octomap: {octomap}}}}}\n"
    (grid,) = read(tmp_path, text, "scene.yaml")
    assert grid == bik.obstacles.Grid((1, 2, 3), 0.1, [[[True]]])
    nodes = b"".join(struct.pack("<fB", 0.85, mask) for mask in [0x80] + [0x01] * 15 + [0])
    whole = text.replace("binary: true", "binary: false").replace(str(data), str(list(nodes)))
    assert list(read(tmp_path, whole, "scene.yaml")) == [grid]
    for new, problem in (
        (text.replace("OcTree", "Stamped"), "octomap: a tree of the kind 'Stamped'; those that can be read: OcTree"),
        (text.replace(f"data: {data}", f"data: {data[:-1]}"), "octomap: the nodes end early"),
        (
            text.replace(f"{data[-1]}]", "'...']"),
            "octomap: expected the fields binary, id, resolution and data (bytes)",
        ),
    ):
        with pytest.raises(bik.InvalidInputError) as caught:
            read(tmp_path, new, "scene.yaml")
        assert problem in str(caught.value)
