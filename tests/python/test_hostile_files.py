"""Promises of SECURITY.md on files: reading executes nothing and ends in words, writing follows no link."""

import io
import os
import pickle
import re
import subprocess
import sys
import zipfile
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from typer.testing import CliRunner

import beetle_ik as bik
from beetle_ik.cli.app import app
from beetle_ik.cli.curves import read_points
from beetle_ik.cli.plan.moves import read_program
from beetle_ik.viewing import write_player

ROOT = Path(__file__).parents[2]
ARM = (
    "<link name='a'/><link name='b'><collision><geometry><mesh filename='{mesh}'/></geometry></collision></link>"
    "<joint name='j' type='continuous'><parent link='a'/><child link='b'/></joint></robot>"
)
LAUGHS = "".join(
    f"<!ENTITY {name} '{f'&{before};' * 10}'>" for before, name in zip("abcdefgh", "bcdefghi", strict=True)
)
READERS: dict[str, Callable[[Path], object]] = {
    "urdf": lambda file: bik.Robot.from_urdf(file),
    "urdf with meshes": lambda file: bik.Robot.from_urdf(file, collision="fit"),
    "mjcf": lambda file: bik.Robot.from_mjcf(file),
    "scene": bik.Scene.load,
    "moveit": bik.Scene.from_moveit,
    "octomap": bik.Scene.from_octomap,
    "trajectory npz": bik.Trajectory.from_npz,
    "trajectory csv": bik.Trajectory.from_csv,
    "map": bik.ReachabilityMap.load,
    "gcode": bik.paths.from_gcode,
    "program": read_program,
    "points": lambda file: read_points(file, 1.0),
}


class Evil:
    """An object whose pickle starts a program."""

    def __reduce__(self) -> tuple[Any, ...]:
        return os.system, ("touch executed",)


def arrays(*names: str) -> bytes:
    """An npz file whose arrays are pickles."""
    array, file = io.BytesIO(), io.BytesIO()
    np.save(array, np.array([Evil()], dtype=object), allow_pickle=True)
    with zipfile.ZipFile(file, "w") as archive:
        for name in names:
            archive.writestr(f"{name}.npy", array.getvalue())
    return file.getvalue()


HOSTILE = {
    "pickle": pickle.dumps(Evil()),
    "pickles in npz": arrays("time", "q", "coefficients", "joint_names", "bits", "robot", "format", "origin"),
    "yaml": b"!!python/object/apply:os.system ['touch executed']\n",
    "entities": f"<!DOCTYPE robot [<!ENTITY a 'ha'>{LAUGHS}]><robot name='&i;'>{ARM}".encode(),
    "entity of a file": f"<!DOCTYPE robot [<!ENTITY a SYSTEM 'file:///etc/hosts'>]><robot name='&a;'>{ARM}".encode(),
    "mesh of a site": f"<robot name='r'>{ARM.format(mesh='http://127.0.0.1:9/x.stl')}".encode(),
    "mesh of a device": f"<robot name='r'>{ARM.format(mesh='file:///dev/zero')}".encode(),
    "deep JSON": b"[" * 100_000,
    "deep XML": b"<a>" * 100_000,
    "long number": b'[{"move": "line", "pose": ' + b"9" * 6000 + b"}]",
    "no text": bytes(range(256)),
    "empty": b"",
}
STARTED = ("subprocess.Popen", "os.system", "os.exec", "os.posix_spawn", "os.fork", "pickle.find_class")
CONNECTED = ("socket.connect", "socket.getaddrinfo", "socket.sendto", "urllib.Request")
_watching: list[str] | None = None


def _note(event: str, _: object) -> None:
    if _watching is not None and event in STARTED + CONNECTED:
        _watching.append(event)


sys.addaudithook(_note)


@pytest.fixture
def watched(monkeypatch: pytest.MonkeyPatch) -> list[str]:
    """What was started and connected during a test."""
    pytest.importorskip("mujoco")  # it starts a program when it is imported
    seen: list[str] = []
    monkeypatch.setitem(globals(), "_watching", seen)
    return seen


def test_a_started_program_is_noticed(watched: list[str]) -> None:
    subprocess.run([sys.executable, "-c", ""], check=True)
    assert "subprocess.Popen" in watched


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("content", HOSTILE.values(), ids=HOSTILE)
@pytest.mark.parametrize("reader", READERS.values(), ids=READERS)
def test_hostile_files_execute_nothing_and_are_named(
    reader: Callable[[Path], object],
    content: bytes,
    tmp_path: Path,
    watched: list[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.chdir(tmp_path)
    file = tmp_path / "hostile.file"
    file.write_bytes(content)
    try:
        reader(file)
    except bik.BeetleIkError as error:
        told = str(error)
        assert "hostile.file" in told or "cannot read" in told  # the mesh that the file names
        assert "hahaha" not in told
    assert watched == []
    assert not (tmp_path / "executed").exists()


BOMB = "a: &a [x, x, x, x, x, x, x, x, x]\n" + "".join(
    f"{name}: &{name} [{', '.join([f'*{before}'] * 9)}]\n"
    for before, name in zip("abcdefghijk", "bcdefghijkl", strict=True)
)


@pytest.mark.parametrize(
    "text",
    [
        f"{BOMB}world: {{collision_objects: *l}}",
        f"{BOMB}world: {{}}\nrobot_state: {{attached_collision_objects: [*l]}}",
        f"{BOMB}world: {{octomap: {{octomap: {{data: *l}}}}}}",
        f"{BOMB.replace('[', '{<<: [').replace(']', ']}').replace('x', '{y: 1}')}world: *l",
        "world: &w {collision_objects: [*w]}",
    ],
    ids=["objects", "attached", "octomap", "merged", "endless"],
)
def test_aliases_cannot_stand_for_more_than_there_is(text: str, tmp_path: Path) -> None:
    file = tmp_path / "scene.yaml"
    file.write_text(text)
    most = 1000 + 10 * len(text)
    with pytest.raises(bik.InvalidInputError) as told:
        bik.Scene.from_moveit(file)
    assert str(told.value) == f"{file}: its aliases (*) repeat more than {most} values: write them out"


def test_a_few_aliases_are_read(tmp_path: Path) -> None:
    file = tmp_path / "scene.yaml"
    file.write_text(
        "at: &at {position: {x: 0.5, y: 0, z: 0}, orientation: {x: 0, y: 0, z: 0, w: 1}}\n"
        "world:\n  collision_objects:\n"
        "  - {id: one, primitives: [{type: 2, dimensions: [0.1]}], primitive_poses: [*at]}\n"
        "  - {id: two, primitives: [{type: 2, dimensions: [0.2]}], primitive_poses: [*at]}\n"
    )
    assert list(bik.Scene.from_moveit(file)) == [bik.obstacles.Sphere((0.5, 0, 0), radius) for radius in (0.1, 0.2)]


def reach(file: Path) -> None:
    options = ["reach", "planar5", "--voxel", "0.5", "--directions", "2", "--rolls", "1", "--picture", str(file)]
    assert CliRunner().invoke(app, options).exit_code == 0


MOTION = bik.Trajectory.from_samples(np.linspace(0.0, 1.0, 5), np.zeros((5, 2)), joint_names=["a", "b"])
WRITERS: dict[str, Callable[[Path], object]] = {
    ".csv": MOTION.to_csv,
    ".npz": MOTION.to_npz,
    ".json": bik.Scene([bik.obstacles.Sphere((0, 0, 0), 0.1)]).save,
    ".yaml": lambda file: bik.interop.to_ros_yaml(MOTION, file, dt=0.5),
    ".html": write_player,
    ".png": reach,
}


@pytest.mark.parametrize("ending", WRITERS)
def test_a_link_is_replaced_and_not_followed(ending: str, tmp_path: Path) -> None:
    victim, file = tmp_path / "victim", tmp_path / f"written{ending}"
    victim.write_text("precious")
    file.symlink_to(victim)
    WRITERS[ending](file)
    assert victim.read_text() == "precious"
    assert not file.is_symlink()
    assert sorted(entry.name for entry in tmp_path.iterdir()) == ["victim", file.name]


def test_a_picture_of_an_unknown_form_is_refused_before_any_work(tmp_path: Path) -> None:
    for name in ("map", "map.exe"):
        told = CliRunner().invoke(app, ["reach", "panda", "--voxel", "0.001", "--picture", str(tmp_path / name)])
        assert told.exit_code == 2
        assert f"--picture: '{tmp_path / name}' must end in .png or another of " in " ".join(told.output.split())


def test_the_page_lists_all_files_with_unsafe_code() -> None:
    listed = set(re.findall(r"\| `(crates/\S+\.rs)` \|", (ROOT / "SECURITY.md").read_text(encoding="utf-8")))
    allowed = re.compile(r"^\s*#!?\[allow\(unsafe_code", re.MULTILINE)
    found = {
        file.relative_to(ROOT).as_posix()
        for file in (ROOT / "crates").rglob("*.rs")
        if allowed.search(file.read_text(encoding="utf-8"))
    }
    assert found == listed
