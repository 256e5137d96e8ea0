"""Untrusted xacro files: features of real packages are expanded; execution and other reads are refused."""

import sys
from pathlib import Path
from xml.sax.saxutils import quoteattr

import numpy as np
import pytest

import beetle_ik as bik
from beetle_ik.robot_files.xacro import expand

pytest.importorskip("xacro", reason="xacro files need the extra 'robots'")

HEAD = "<robot name='r' xmlns:xacro='http://www.ros.org/wiki/xacro'>\n"
ARM = (
    "<link name='a'/><link name='b'/>"
    "<joint name='j' type='continuous'><parent link='a'/><child link='b'/></joint></robot>"
)
REMEDY = (
    "is not allowed in a file from anyone: trusted=True lets your own files execute code, and read the environment "
    "and other files"
)


@pytest.fixture
def folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    home = tmp_path / "work"
    home.mkdir()
    monkeypatch.chdir(home)
    monkeypatch.setenv("SECRET", "hunter2")
    (tmp_path / "secret.xacro").write_text(f"{HEAD}<link name='hunter2'/></robot>")
    (tmp_path / "secret.yaml").write_text("hunter2: 1\n")
    return home


def written(inner: str, name: str = "arm.urdf.xacro") -> str:
    Path(name).write_text(f"{HEAD}{inner}{ARM}")
    return name


def value(expression: str) -> str:
    text = expand(written(f"<link name={quoteattr('${' + expression + '}')}/>"), [], False)
    return text.partition('<link name="')[2].partition('"/>')[0]


def refused(inner: str, **options: bool) -> str:
    with pytest.raises(bik.UrdfError) as told:
        expand(written(inner), [], options.get("trusted", False))
    message = str(told.value)
    assert "hunter2" not in message
    assert message.startswith("URDF: xacro cannot expand 'arm.urdf.xacro': ")
    return message


def test_an_error_of_the_expanded_text_names_the_xacro_file(tmp_path: Path) -> None:
    file = tmp_path / "arm.urdf.xacro"
    file.write_text('<robot name="arm" xmlns:xacro="http://ros.org/wiki/xacro"><link name="base"/></robot>')
    with pytest.raises(bik.UrdfError) as told:
        bik.Robot.from_urdf(file)
    assert str(told.value).startswith(f"{file}, expanded: URDF line 1: <robot> has no <joint>")


# --- what is refused ---

ESCAPES = {
    "[a:=[], a.append(b.gi_frame.f_back.f_back.f_builtins for b in a), [*a[0]][0]['open']('PWNED','w').write('x')]": (
        "the assignment :="
    ),
    "().__class__.__mro__[1].__subclasses__()": "the attribute '.__class__'",
    "().__class__": "the attribute '.__class__'",
    "(1).real": "the attribute '.real'",
    "'a'.join(['b'])": "the attribute '.join'",
    "str.format": "the attribute '.format'",
    "math.sin.__self__": "the attribute '.__self__'",
    "(x for x in [1]).gi_frame": "a comprehension",
    "[x for x in [1]]": "a comprehension",
    "list(map(lambda x: x, [1]))": "a lambda",
    "(lambda: 1)()": "a lambda",
    "[*[1]]": "an unpacking *",
    "dict(**dict(a=1))": "an unpacking **",
    "f'a'": "a formatted text",
    "'%s' % 1": "a formatted text",
    "1 << 2": "the operator <<",
    "~1": "the operator ~",
    "1j": "a literal of type complex",
    "b'a'": "a literal of type bytes",
    "__import__('os')": "the name '__import__'",
    "__builtins__": "the name '__builtins__'",
    "open('PWNED', 'w')": "a call of 'open'",
    "eval('1')": "a call of 'eval'",
    "getattr(1, 'real')": "a call of 'getattr'",
    "type(1)": "a call of 'type'",
    "python.vars()": "a call of 'python.vars'",
    "python.type('A', (), dict())": "a call of 'python.type'",
    "math.factorial(3)": "a call of 'math.factorial'",
    "1()": "a call of '1'",
    "load_yaml('../secret.yaml')": "load_yaml(), which reads files,",
    "xacro.load_yaml('../secret.yaml')": "xacro.load_yaml(), which reads files,",
    "xacro.abs_filename('x')": "xacro.abs_filename(), which reads files,",
    "list[1]": "an item of something of type type",
}


@pytest.mark.parametrize("expression", ESCAPES)
def test_expressions_that_execute_are_refused(folder: Path, expression: str) -> None:
    message = refused(f"<link name={quoteattr('${' + expression + '}')}/>")
    assert message.startswith(f"URDF: xacro cannot expand 'arm.urdf.xacro': line 2: '{expression[:100]}': ")
    assert ESCAPES[expression] in message
    assert message.endswith(REMEDY)
    assert [file.name for file in folder.iterdir()] == ["arm.urdf.xacro"]


TOO_MUCH = {
    "9**9**9": "a number that is too large",
    "2**99999": "a number that is too large",
    "int('9' * 4000) * int('9' * 4000)": "a number that is too large",
    "'a' * 10**10": "so much work or memory",
    "[0] * 10**10": "so much work or memory",
    "len([[0] * 10**4] * 10**4)": "so much work or memory",
    "int('f' * 20000, 16)": "a number that is too large",
    "list(map(int, ['f' * 20000], [16]))": "a number that is too large",
    "sorted([99999] * 1000, key=range)": "a function as an argument",
    "max([99999] * 99999, key=range)": "a function as an argument",
    "map(range, [99999] * 99999)": "map() of another function than those of numbers and texts",
    "map(map, [float], [[1]])": "map() of another function than those of numbers and texts",
    "range(10**12)": "a range of more than 100000 numbers",
    "range(-10**300, 10**300)": "a range of more than 100000 numbers",
    "round(1, -10**9)": "rounding to more than 100 digits",
    "-" * 9000 + "1": "an expression that is nested too deeply",
    "1" + "+1" * 9000: "an expression that is nested too deeply",
    "math" + ".a" * 9000: "an expression that is nested too deeply",
    "1" + " " * 30_000: "an expression of more than 20000 characters",
}


@pytest.mark.parametrize("expression", TOO_MUCH, ids=lambda text: text[:30])
def test_expressions_that_take_for_ever_are_refused(folder: Path, expression: str) -> None:  # noqa: ARG001
    message = refused(f"<link name={quoteattr('${' + expression + '}')}/>")
    assert f"{TOO_MUCH[expression]} {REMEDY}" in message


def doubled(first: str, again: str) -> str:
    steps = [f"<xacro:property name='p{i + 1}' value='{again.replace('p', f'p{i}')}'/>" for i in range(60)]
    return f"<xacro:property name='p0' value='{first}'/>{''.join(steps)}<link name='${{p60}}'/>"


def macros(body: str) -> str:
    steps = [f"<xacro:macro name='m{i + 1}'>{body.replace('m/', f'm{i}/')}</xacro:macro>" for i in range(40)]
    return f"<xacro:macro name='m0'><link name='x'/></xacro:macro>{''.join(steps)}<xacro:m40/>"


BOMBS = {
    "texts": doubled("x", "${p}${p}"),
    "sums": doubled("x", "${p+p}"),
    "lists": doubled("${[1, 1]}", "${[p, p]}"),
    "macros": macros("<xacro:m/><xacro:m/>"),
    "blocks": (
        "<xacro:macro name='m' params='*b'><o><xacro:insert_block name='b'/><xacro:insert_block name='b'/></o>"
        f"</xacro:macro>{'<xacro:m>' * 40}<link name='z'/>{'</xacro:m>' * 40}"
    ),
    "dollars": f"<link name='{'$a' * 200_000}'/>",
}


@pytest.mark.parametrize("bomb", BOMBS)
def test_short_files_cannot_ask_for_more_than_there_is(folder: Path, bomb: str) -> None:  # noqa: ARG001
    assert refused(BOMBS[bomb]).endswith(f"so much work or memory {REMEDY}")


def test_open_quotes_in_parameters_take_no_time(folder: Path) -> None:  # noqa: ARG001
    expand(written(f"<xacro:macro name='m' params=\"a:={'x' * 60}'\"/>"), [], False)


@pytest.mark.parametrize(
    "inner", ["<xacro:macro name='m'><xacro:m/></xacro:macro><xacro:m/>", f"{'<l>' * 5000}{'</l>' * 5000}"]
)
def test_endless_and_deep_files_end_with_an_error(folder: Path, inner: str) -> None:  # noqa: ARG001
    assert "maximum recursion depth exceeded" in refused(inner)


def test_files_that_include_themselves_end_with_an_error(folder: Path) -> None:  # noqa: ARG001
    refused("<xacro:include filename='arm.urdf.xacro'/>")


COMMANDS = [
    "env SECRET",
    "optenv SECRET no",
    "optenv NONE no",
    "eval 1 + 1",
    "dirname",
    "cwd",
    "anon x",
    "ls",
    " env SECRET",
]


@pytest.mark.parametrize("command", COMMANDS)
def test_commands_are_refused_by_name(folder: Path, command: str) -> None:  # noqa: ARG001
    message = refused(f"<link name='$({command})'/>")
    assert message == (
        f"URDF: xacro cannot expand 'arm.urdf.xacro': line 2: '$({command})': "
        f"the command '{command.split()[0]}' {REMEDY}"
    )


ENVIRONMENT = "$(env SECRET)"
WAYS = {
    "argument": f"<xacro:arg name='x' default='{ENVIRONMENT}'/>",
    "property": f"<xacro:property name='x' value='{ENVIRONMENT}'/><link name='${{x}}'/>",
    "greedy property": f"<xacro:property name='x' value='{ENVIRONMENT}' lazy_eval='false'/>",
    "default": f"<xacro:macro name='m' params='v:={ENVIRONMENT}'><l n='${{v}}'/></xacro:macro><xacro:m/>",
    "parameter": f"<xacro:macro name='m' params='v'><l n='${{v}}'/></xacro:macro><xacro:m v='{ENVIRONMENT}'/>",
    "inside": f"<link name='${{{ENVIRONMENT}}}'/>",
    "assembled": "<xacro:property name='x' value='env SECRET'/><link name='$(${x})'/>",
    "text": f"<l>{ENVIRONMENT}</l>",
    "comment": f"<!-- xacro:eval-comments --><!-- {ENVIRONMENT} -->",
    "element": f"<xacro:element xacro:name='{ENVIRONMENT}'/>",
    "attribute": f"<l><xacro:attribute name='n' value='{ENVIRONMENT}'/></l>",
    "call": f"<xacro:call macro='{ENVIRONMENT}'/>",
    "condition": f"<xacro:if value='{ENVIRONMENT}'/>",
    "name": f"<xacro:property name='{ENVIRONMENT}' value='1'/>",
    "include": f"<xacro:include filename='{ENVIRONMENT}'/>",
    "optional include": f"<xacro:include filename='{ENVIRONMENT}' optional='true'/>",
    "namespace": f"<xacro:include filename='x' ns='{ENVIRONMENT}'/>",
}


@pytest.mark.parametrize("way", WAYS)
def test_no_way_leads_to_the_environment(folder: Path, way: str) -> None:  # noqa: ARG001
    assert f"the command 'env' {REMEDY}" in refused(WAYS[way])


def test_escaped_commands_stay_text(folder: Path) -> None:  # noqa: ARG001
    inner = "<xacro:macro name='m' params='v'><l n='${v}'/></xacro:macro><xacro:m v='$$(env SECRET)'/>"
    assert '<l n="$(env SECRET)"/>' in expand(written(inner), [], False)


OUTSIDE = [
    "../secret.xacro",
    "{tmp}/secret.xacro",
    "sub/../../secret.xacro",
    "link.xacro",
    "../*.xacro",
    "*/../../*",
    "/etc/*",
]


@pytest.mark.parametrize("optional", ["", " optional='true'"])
@pytest.mark.parametrize("file", OUTSIDE)
def test_files_outside_the_package_are_not_included(folder: Path, file: str, optional: str) -> None:
    Path("sub").mkdir()
    Path("link.xacro").symlink_to(folder.parent / "secret.xacro")
    message = refused(f"<xacro:include filename='{file.format(tmp=folder.parent)}'{optional}/>")
    assert message.endswith(f", which is outside of the package, {REMEDY}")


def test_entities_are_refused(folder: Path) -> None:  # noqa: ARG001
    for entity in ('a "aaa"', 'a SYSTEM "../secret.xacro"', '% a "aaa"'):
        Path("arm.urdf.xacro").write_text(f"<!DOCTYPE robot [<!ENTITY {entity}>]>{HEAD}{ARM}")
        with pytest.raises(bik.UrdfError, match=r"the entity 'a' is not allowed"):
            expand("arm.urdf.xacro", [], False)


def test_a_package_of_another_make_fails_closed(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A version of xacro that reads or evaluates in another way is stopped, not used."""
    import xacro

    for change, name in (("eval_text", "evaluate_text"), ("safe_eval", "evaluate")):
        package = folder / f"{change}/xacro"
        package.mkdir(parents=True)
        for file in Path(xacro.__file__).parent.glob("*.py"):
            (package / file.name).write_text(file.read_text().replace(change, name))
        monkeypatch.syspath_prepend(str(package.parent))
        monkeypatch.delitem(sys.modules, "xacro", raising=False)
        with pytest.raises(bik.BeetleIkError, match=f"cannot be guarded, it has no {change}"):
            expand(written("<link name='${1}'/>"), [], False)
    evaluating = (Path(xacro.__file__)).read_text() + "\n\ndef eval_text(text, symbols):\n    return eval(text)\n"
    (folder / "safe_eval/xacro/__init__.py").write_text(evaluating)
    assert "eval() " + REMEDY in refused("<link name='open(1)'/>")


# --- what works ---

VALUES: dict[str, object] = {
    "1 + 2 * 3 - 4 / 8": 6.5,
    "-pi / 2": -np.pi / 2,
    "7 // 2 + 7 % 4": 6,
    "2 ** 10": 1024,
    "1e-3": 1e-3,
    "radians(90)": np.pi / 2,
    "math.degrees(math.pi)": 180.0,
    "sin(0.5) + cos(0.5) + atan2(1, 2)": np.sin(0.5) + np.cos(0.5) + np.arctan2(1, 2),
    "sqrt(2) * math.sqrt(2)": np.sqrt(2) * np.sqrt(2),
    "abs(-2)": 2,
    "max(1, 2, 3) - min([4, 5])": -1,
    "round(2.567, 1) + int('3') + float('0.5')": 6.1,
    "'a' + 'b' * 2": "abb",
    "str(1) + '_link'": "1_link",
    "1 if 2 > 1 and not False else 0": 1,
    "1 < 2 <= 2 != 3": True,
    "'a' in ['a', 'b']": True,
    "len([1, 2, 3][1:])": 2,
    "[1, 2, 3][-1]": 3,
    "(4, 5)[0]": 4,
    "dict(a=1, b=dict(c=2))['b']['c']": 2,
    "dict(a=1, b=dict(c=2)).b.c": 2,
    "xacro.dotify(dict(a=1)).a": 1,
    "sum(range(5))": 10,
    "python.abs(-1) + python.sum([1])": 2,
    "sorted([3, 1])[0]": 1,
    "list(map(float, xacro.tokenize('1 2;3')))": [1.0, 2.0, 3.0],
    "None is None": True,
    "xacro.warning('no text') + 'x'": "x",
}


@pytest.mark.parametrize("expression", VALUES)
def test_expressions_have_the_values_that_xacro_gives(folder: Path, expression: str) -> None:  # noqa: ARG001
    assert value(expression) == str(VALUES[expression])
    if expression in ("abs(-2)", "sum(range(5))", "dict(a=1, b=dict(c=2)).b.c"):
        return  # xacro 2.1 has less
    trusted = expand(written(f"<link name={quoteattr('${' + expression + '}')}/>"), [], True)
    assert f'<link name="{VALUES[expression]}"/>' in trusted


DESCRIPTION = """<robot name="arm" xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:arg name="prefix" default=""/>
  <xacro:arg name="reach" default="0.4"/>
  <xacro:property name="prefix" value="$(arg prefix)"/>
  <xacro:include filename="$(find arm_description)/urdf/inc/common.xacro"/>
  <xacro:include filename="inc/lim*.xacro" ns="limits"/>
  <xacro:macro name="segment" params="name parent length:=0.1 density:=${density} axis:='0 0 1' collide:=true
                                      *origin **extra">
    <joint name="${prefix}${name}_joint" type="revolute">
      <xacro:insert_block name="origin"/>
      <parent link="${prefix}${parent}"/>
      <child link="${prefix}${name}"/>
      <axis xyz="${axis}"/>
      <limit lower="${limits.table[name]['lower']}" upper="${limits.table[name]['upper']}" velocity="${radians(180)}"
             effort="10"/>
    </joint>
    <link name="${prefix}${name}">
      <xacro:if value="${collide and length > 0}">
        <collision>
          <origin xyz="0 0 ${length/2}" rpy="0 ${-pi/2 + half_turn/2} 0"/>
          <geometry><cylinder radius="${0.5 * thickness}" length="${length}"/></geometry>
        </collision>
      </xacro:if>
      <xacro:property name="mass" value="${length * density}"/>
      <xacro:unless value="${mass &lt; 0}"><xacro:insert_block name="extra"/></xacro:unless>
    </link>
  </xacro:macro>
  <link name="${prefix}base"/>
  <xacro:segment name="upper" parent="base" length="$(arg reach)" axis="0 1 0">
    <origin xyz="0 0 ${offsets[0]}"/>
    <extra><inertial/><visual/></extra>
  </xacro:segment>
  <xacro:property name="kind" value="segment"/>
  <xacro:call macro="${kind}" name="lower" parent="upper" axis="0 1 0" collide="false">
    <origin xyz="0 0 ${float(xacro.arg('reach')) + offsets[-1]}" rpy="${radians(90)} 0 0"/>
    <extra/>
  </xacro:call>
</robot>"""
COMMON = """<root xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:property name="density" value="${2700.0 * 1e-3}"/>
  <xacro:property name="thickness" value="0.08"/>
  <xacro:property name="half_turn" value="${pi}"/>
  <xacro:property name="offsets" value="${[0.15, 0.05]}"/>
  <xacro:property name="thickness" default="1.0"/>
</root>"""
LIMITS = """<root xmlns:xacro="http://www.ros.org/wiki/xacro">
  <xacro:property name="table" value="${dict(upper=dict(lower=-2*pi, upper=2*pi), lower=low)}"/>
  <xacro:property name="low" value="${dict(lower=-pi/2, upper=2.5)}"/>
</root>"""


def package(folder: Path) -> Path:
    urdf = folder / "src" / "arm_description" / "urdf"
    (urdf / "inc").mkdir(parents=True)
    (urdf.parent / "package.xml").write_text("<package/>")
    (urdf / "arm.urdf.xacro").write_text(DESCRIPTION)
    (urdf / "inc" / "common.xacro").write_text(COMMON)
    (urdf / "inc" / "limits.xacro").write_text(LIMITS)
    return urdf / "arm.urdf.xacro"


def test_a_description_as_manufacturers_write_it_is_read(folder: Path) -> None:
    file = package(folder)
    robot = bik.Robot.from_urdf(file)
    assert robot.joint_names == ["upper_joint", "lower_joint"]
    np.testing.assert_allclose(robot.lower, [-2 * np.pi, -np.pi / 2])
    np.testing.assert_allclose(robot.upper, [2 * np.pi, 2.5])
    np.testing.assert_allclose(robot.fk([0, 0])[:3, 3], [0, 0, 0.6], atol=1e-12)
    assert [link for link, *_ in robot.capsules] == ["upper"]
    assert robot == bik.Robot.from_urdf(file, trusted=True)


def test_packages_are_found_where_meshes_are(folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file = package(folder)
    loose = folder / "loose.urdf.xacro"
    loose.write_text(DESCRIPTION.replace("inc/lim", "$(find arm_description)/urdf/inc/lim"))
    with pytest.raises(bik.UrdfError) as told:
        bik.Robot.from_urdf(loose)
    assert str(told.value) == (
        f"URDF: xacro cannot expand '{loose}': package 'arm_description' is not found: give the folder that holds it "
        "as package_dirs"
    )
    wanted = bik.Robot.from_urdf(file)
    for given in ([file.parents[2]], [file.parents[1]]):
        assert bik.Robot.from_urdf(loose, package_dirs=given) == wanted
    monkeypatch.setenv("ROS_PACKAGE_PATH", str(file.parents[2]))
    assert bik.Robot.from_urdf(loose) == wanted


def test_trusted_files_do_all_that_xacro_can(folder: Path) -> None:
    pytest.importorskip("yaml")
    (folder / "limits.yaml").write_text("j: {lower: !degrees -90}\n")
    inner = (
        "<xacro:property name='y' value=\"${xacro.load_yaml('limits.yaml')}\"/>"
        "<link name='${y.j.lower}'/><link name='$(env SECRET)'/><link name='${[i for i in [1]]}'/>"
        "<xacro:include filename='../secret.xacro'/>"
    )
    text = expand(written(inner), [], True)
    assert [f'<link name="{name}"/>' in text for name in (str(-np.pi / 2), "hunter2", "[1]")] == [True] * 3
    assert "load_yaml(), which reads files," in refused(inner)


def test_every_door_takes_trusted_files(folder: Path) -> None:  # noqa: ARG001
    from typer.testing import CliRunner

    from beetle_ik.cli.app import app
    from beetle_ik.interop import from_mujoco

    file = written(
        "<link name='c'/><joint name='$(env SECRET)' type='fixed'><parent link='b'/><child link='c'/></joint>"
    )
    with pytest.raises(bik.UrdfError, match="the command 'env'"):
        bik.Robot.from_urdf(file)
    assert bik.Robot.from_urdf(file, trusted=True).joint_names == ["j"]
    command = ["fk", "--urdf", file, "--q", "0.1"]
    assert CliRunner().invoke(app, command).exit_code != 0
    assert CliRunner().invoke(app, [*command, "--trusted"]).exit_code == 0
    assert "trusted" in (from_mujoco.__kwdefaults__ or {})


def test_expansions_leave_the_package_as_it_was(folder: Path) -> None:  # noqa: ARG001
    import xacro

    before = {name: getattr(xacro, name) for name in dir(xacro)}
    loaded = set(sys.modules)
    value("1 + 1")
    assert all(getattr(xacro, name) is each for name, each in before.items())
    assert not {name for name in set(sys.modules) - loaded if "xacro" in name}


def test_files_are_expanded_in_several_threads(folder: Path) -> None:  # noqa: ARG001
    from concurrent.futures import ThreadPoolExecutor

    names = [
        written(f"<xacro:property name='p' value='{i}'/><link name='n${{p * 2}}'/>", f"{i}.xacro") for i in range(16)
    ]
    with ThreadPoolExecutor(4) as pool:
        texts = list(pool.map(lambda name: expand(name, [], False), names))
    assert all(f'<link name="n{2 * i}"/>' in text for i, text in enumerate(texts))
