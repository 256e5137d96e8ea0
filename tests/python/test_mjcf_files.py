"""Untrusted MuJoCo models: they read only files of their own package."""

from pathlib import Path

import pytest

import beetle_ik as bik

pytest.importorskip("mujoco", reason="MuJoCo is not installed")

OBJ = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"
BODY = '<worldbody><body name="arm"><joint name="j" axis="0 0 1"/>{}</body></worldbody>'
MESH = '<geom type="mesh" mesh="m"/>'
SPHERE = '<geom type="sphere" size="0.1"/>'
REMEDY = (
    "is not allowed in a file from anyone: trusted=True lets your own files execute code, and read the environment "
    "and other files"
)


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    home = tmp_path / "model"
    (home / "assets").mkdir(parents=True)
    (home / "sub").mkdir()
    for file in (tmp_path / "out.obj", home / "assets" / "m.obj", home / "m.obj"):
        file.write_text(OBJ)
    (tmp_path / "out.xml").write_text("<mujoco><asset/></mujoco>")
    (home / "sub" / "mesh.xml").write_text('<mujoco><asset><mesh name="m" file="m.obj"/></asset></mujoco>')
    (home / "sub" / "out.xml").write_text('<mujoco><asset><mesh name="m" file="../../out.obj"/></asset></mujoco>')
    (home / "sub" / "out.txt").write_text((home / "sub" / "out.xml").read_text())
    (home / "sub" / "dir.xml").write_text('<mujoco><compiler meshdir="../.."/></mujoco>')
    (home / "assets" / "link.obj").symlink_to(tmp_path / "out.obj")
    monkeypatch.chdir(home)
    return home


def model(head: str, geom: str = MESH) -> str:
    return f"<mujoco>{head}{BODY.format(geom)}</mujoco>"


def mesh(file: str, compiler: str = "") -> str:
    return f'{compiler}<asset><mesh name="m" file="{file}"/></asset>'


OWN = {
    "nothing": model("", SPHERE),
    "beside": model(mesh("m.obj")),
    "below": model(mesh("assets/m.obj")),
    "folder": model(mesh("m.obj", '<compiler meshdir="assets"/>')),
    "all assets": model(mesh("m.obj", '<compiler assetdir="assets"/>')),
    "there and back": model(mesh("assets/../m.obj")),
    "included": model('<include file="sub/mesh.xml"/>'),
    "named once": model('<asset><mesh file="m.obj"/></asset>'),
}


@pytest.mark.parametrize("name", OWN)
def test_models_read_files_of_their_folder(folder: Path, name: str) -> None:
    (folder / "arm.xml").write_text(OWN[name])
    assert bik.Robot.from_mjcf("arm.xml").joint_names == ["j"]
    assert bik.Robot.from_mjcf(OWN[name]).joint_names == ["j"]


FOREIGN = {
    "absolute": (mesh("{out}.obj"), "{out}.obj"),
    "above": (mesh("../out.obj"), "../out.obj"),
    "backslashes": (mesh("..\\out.obj"), "../out.obj"),
    "in two parts": (mesh("../../out.obj", '<compiler meshdir="assets"/>'), "../../out.obj"),
    "folder above": (mesh("out.obj", '<compiler meshdir=".."/>'), ".."),
    "folder said later": (mesh("out.obj") + '<compiler meshdir=".."/>', ".."),
    "absolute folder": (mesh("out.obj", '<compiler assetdir="{tmp}"/>'), "{tmp}"),
    "textures": ('<asset><texture name="t" type="cube" fileright="{out}.png"/></asset>', "{out}.png"),
    "heights": ('<asset><hfield name="h" file="../out.bin" size="1 1 1 1"/></asset>', "../out.bin"),
    "skins": ('<asset><skin name="s" file="../out.skn"/></asset>', "../out.skn"),
    "included": ('<include file="../out.xml"/>', "../out.xml"),
    "included absolute": ('<include file="/etc/passwd"/>', "/etc/passwd"),
    "in an included file": ('<include file="sub/out.xml"/>', "../../out.obj"),
    "folder of an included file": (mesh("m.obj") + '<include file="sub/dir.xml"/>', "../.."),
    "include of any name": ('<include file="sub/out.txt"/>', "../../out.obj"),
    "other letters": ('<INCLUDE FILE="../out.xml"/>', "../out.xml"),
    "link": (mesh("link.obj", '<compiler meshdir="assets"/>'), "link.obj"),
}


@pytest.mark.parametrize("as_text", [False, True], ids=["file", "text"])
@pytest.mark.parametrize("name", FOREIGN)
def test_models_read_no_other_files(folder: Path, name: str, as_text: bool) -> None:
    places = {"tmp": folder.parent, "out": folder.parent / "out"}
    head, file = (part.format(**places) for part in FOREIGN[name])
    (folder / "arm.xml").write_text(model(head, SPHERE))
    with pytest.raises(bik.InvalidInputError) as told:
        bik.Robot.from_mjcf(model(head, SPHERE) if as_text else "arm.xml")
    message = str(told.value)
    assert message.startswith("MuJoCo model: ")
    assert message.endswith(f": the file '{file}', which is outside of the package, {REMEDY}")


def test_trusted_models_read_any_file(folder: Path) -> None:
    for head in (mesh("../out.obj"), mesh("out.obj", '<compiler meshdir=".."/>'), mesh(f"{folder.parent}/out.obj")):
        assert bik.Robot.from_mjcf(model(head), trusted=True).joint_names == ["j"]


def test_a_package_is_one_folder_more(folder: Path) -> None:
    (folder.parent / "package.xml").write_text("<package/>")
    assert bik.Robot.from_mjcf(model(mesh("../out.obj"))).joint_names == ["j"]
    with pytest.raises(bik.InvalidInputError, match=r"'\.\./\.\./out\.obj', which is outside"):
        bik.Robot.from_mjcf(model(mesh("../../out.obj")))


def test_plugins_and_entities_are_refused(folder: Path) -> None:  # noqa: ARG001
    plugin = '<extension><plugin plugin="mujoco.elasticity.cable"/></extension>'
    with pytest.raises(bik.InvalidInputError) as told:
        bik.Robot.from_mjcf(model(plugin, SPHERE))
    assert str(told.value) == f"MuJoCo model: the text line 1: the plugin 'mujoco.elasticity.cable' {REMEDY}"
    with pytest.raises(bik.InvalidInputError, match="the entity 'a' is not allowed"):
        bik.Robot.from_mjcf(f'<!DOCTYPE mujoco [<!ENTITY a SYSTEM "/etc/passwd">]>{model("", SPHERE)}')


def test_messages_show_no_content_of_files(folder: Path) -> None:
    secret = folder / "secret.xml"
    secret.write_text("hunter2: not XML")
    for head in ('<include file="secret.xml"/>', mesh("secret.xml")):
        with pytest.raises(bik.InvalidInputError) as told:
            bik.Robot.from_mjcf(model(head, SPHERE))
        assert "hunter2" not in str(told.value)


@pytest.mark.parametrize("suffix", ["stl", "obj", "dae", "txt", ""])
@pytest.mark.parametrize("collision", ["fit", "hulls"])
def test_messages_on_meshes_show_no_content(folder: Path, suffix: str, collision: str) -> None:
    """A URDF may name any file as a mesh; what is in it does not come out."""
    secrets = (
        b"hunter2: x\n",
        b"v hunter2 1 2\nf hunter2 2 3\n",
        b"<hunter2 a='hunter2'>hunter2</hunter2>",
        b"solid hunter2\nfacet hunter2",
    )
    for number, content in enumerate(secrets):
        file = folder / f"secret{number}.{suffix}".rstrip(".")
        file.write_bytes(content)
        shape = f"<geometry><mesh filename='file://{file}'/></geometry>"
        urdf = (
            f"<robot name='r'><link name='a'/><link name='b'><visual>{shape}</visual>"
            f"<collision>{shape}</collision></link>"
            "<joint name='j' type='continuous'><parent link='a'/><child link='b'/></joint></robot>"
        )
        told = ""
        try:
            told = repr(bik.Robot.from_urdf(urdf, collision=collision))
        except bik.BeetleIkError as error:
            told = str(error)
        assert "hunter2" not in told
