"""G-code: lines and arcs against formulas, units and modes, and what is refused."""
# ruff: noqa: E501 -- a row is a line

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from mistakes import Invalid, assert_told

import beetle_ik as bik

api: Any = bik
ORIGIN = "G0 X0 Y0 Z0\n"


def read(text: str, **options: Any) -> bik.paths.GcodeProgram:
    return bik.paths.from_gcode(ORIGIN + text, **options)


def points(program: bik.paths.GcodeProgram) -> np.ndarray:
    """Points (m, 3) in millimetres."""
    return 1e3 * program.poses[:, :3, 3]


def test_lines_have_points_speeds_and_kinds() -> None:
    program = read("G1 X10 F600\nG0 Z5 (up)\nG1 Y20 F1200 ; on")
    np.testing.assert_allclose(points(program), [(0, 0, 0), (10, 0, 0), (10, 0, 5), (10, 20, 5)], atol=1e-12)
    np.testing.assert_allclose(program.feeds, [0.01, np.nan, 0.02])
    assert program.rapid.tolist() == [False, True, False]
    assert [(move.kind, move.line) for move in program.moves] == [("line", 2), ("rapid", 3), ("line", 4)]
    assert program.length == pytest.approx(0.03)


def test_the_tool_points_down_with_x_along_x() -> None:
    np.testing.assert_array_equal(read("G1 X10 F600").poses[0, :3, :3], np.diag([1.0, -1.0, -1.0]))
    level = read("G1 X10 F600", axis=(1, 0, 0)).poses[0, :3, :3]
    np.testing.assert_allclose(level[:, [0, 2]], [(0, 1), (1, 0), (0, 0)], atol=1e-12)


def test_a_frame_moves_the_program() -> None:
    frame = bik.pose([0.5, 0.1, 0.2], rpy=[0.0, 0.0, np.pi / 2])
    np.testing.assert_allclose(read("G1 X10 F600", frame=frame).poses[-1, :3, 3], [0.5, 0.11, 0.2], atol=1e-12)


@pytest.mark.parametrize(
    ("plane", "axes", "center"),
    [
        ("G17", (0, 1, 2), "I-30"),
        ("G18", (2, 0, 1), "K-30"),
        ("G19", (1, 2, 0), "J-30"),
    ],
)
@pytest.mark.parametrize(("code", "sign"), [("G2", -1.0), ("G3", 1.0)])
@pytest.mark.parametrize("by", ["center", "radius"])
def test_arcs_and_helices_in_all_planes_follow_the_circle(
    plane: str, axes: tuple[int, int, int], center: str, code: str, sign: float, by: str
) -> None:
    first, second, third = axes
    names = "XYZ"
    angle = np.radians(100.0)
    end = 30.0 * (np.cos(angle) - 1.0), sign * 30.0 * np.sin(angle)
    ends = f"{names[first]}{end[0]:.9f} {names[second]}{end[1]:.9f} {names[third]}6"
    how = center if by == "center" else "R30"
    program = read(f"{plane} {code} {ends} {how} F600", tolerance=1e-6)
    at = points(program)
    share = np.linspace(0.0, 1.0, len(at))
    np.testing.assert_allclose(at[:, first], 30.0 * (np.cos(share * angle) - 1.0), atol=1e-6)
    np.testing.assert_allclose(at[:, second], sign * 30.0 * np.sin(share * angle), atol=1e-6)
    np.testing.assert_allclose(at[:, third], 6.0 * share, atol=1e-6)
    # The chords' distance from the arc, in metres.
    assert 0.03 * (1.0 - np.cos(angle / (len(at) - 1) / 2.0)) <= 1e-6


@pytest.mark.parametrize(("code", "turn"), [("G2", -1.0), ("G3", 1.0)])
def test_an_arc_that_ends_at_its_start_is_a_full_circle(code: str, turn: float) -> None:
    at = points(read(f"{code} I20 F600"))
    np.testing.assert_allclose(np.hypot(at[:, 0] - 20.0, at[:, 1]), 20.0, atol=1e-9)
    around = np.unwrap(np.arctan2(at[:, 1], at[:, 0] - 20.0))
    assert around[-1] - around[0] == pytest.approx(turn * 2 * np.pi)
    np.testing.assert_array_equal(at[-1], at[0])


@pytest.mark.parametrize(("radius", "length"), [("R10", np.pi / 2), ("R-10", 3 * np.pi / 2)])
def test_a_negative_radius_is_the_longer_arc(radius: str, length: float) -> None:
    program = read(f"G3 X10 Y10 {radius} F600", tolerance=1e-8)
    assert program.length == pytest.approx(0.01 * length, rel=1e-5)


def test_a_half_circle_by_its_rounded_radius_is_taken() -> None:
    assert read("G2 X20 R9.9999 F600").length == pytest.approx(0.01 * np.pi, rel=1e-3)


def test_an_arc_whose_end_is_rounded_ends_there() -> None:
    program = read("G3 X7.07 Y2.93 J10 F600")
    np.testing.assert_allclose(points(program)[-1], [7.07, 2.93, 0.0], atol=1e-12)


def test_inches_and_relative_positions_are_read() -> None:
    program = read("G20 G91\nG1 X1 F60\nX1 Y-.5\nG90 Y0\nG21 X0")
    inch = 25.4
    np.testing.assert_allclose(
        points(program), [(0, 0, 0), (inch, 0, 0), (2 * inch, -0.5 * inch, 0), (2 * inch, 0, 0), (0, 0, 0)], atol=1e-12
    )
    np.testing.assert_allclose(program.feeds, 0.0254)


def test_absolute_centers_are_read() -> None:
    relative = read("G1 X10 F600\nG3 X0 Y10 I-10")
    np.testing.assert_allclose(read("G1 X10 F600\nG90.1 G3 X0 Y10 I0 J0").poses, relative.poses, atol=1e-12)


def test_the_path_begins_at_the_origin_or_where_told() -> None:
    square = "G1 X10 F600\nG1 Y10\nG1 X0\nG1 Y0\n"
    np.testing.assert_allclose(
        points(bik.paths.from_gcode(square)), [(0, 0, 0), (10, 0, 0), (10, 10, 0), (0, 10, 0), (0, 0, 0)], atol=1e-12
    )
    begun = bik.paths.from_gcode("G91\nG1 X5 F600\n", start=(0.1, 0.2, 0.3))
    np.testing.assert_allclose(points(begun), [(100, 200, 300), (105, 200, 300)], atol=1e-12)


@pytest.mark.parametrize("before", ["", "G28\n", "G28 X0 Y0\nG28 Z0\n"])
def test_an_unknown_start_is_left_out_and_told(before: str) -> None:
    text = f"{before}G1 Z0.2 F1200\nG0 X5 Y5\nG1 X10\n"
    program = bik.paths.from_gcode(text, start=None if not before else (0.0, 0.0, 0.0))
    np.testing.assert_allclose(points(program), [(5, 5, 0.2), (10, 5, 0.2)], atol=1e-12)
    assert program.ignored[-1][1] == "G1 Z0.2 F1200"


def test_homing_is_told_and_left_by_a_rapid_move() -> None:
    program = read("G1 X10 F600\nG28 Z0\nG1 X20\nG1 Z1\nG1 X30")
    np.testing.assert_allclose(points(program), [(0, 0, 0), (10, 0, 0), (20, 0, 1), (30, 0, 1)], atol=1e-12)
    assert program.rapid.tolist() == [False, True, False]
    assert program.ignored == [(3, "G28 Z0"), (4, "G1 X20"), (5, "G1 Z1")]


def test_what_moves_nothing_is_told() -> None:
    text = (
        "M104 S200\nM117 Printing; layer 1\nN40 G1 X10 F600 M8*71\nSTART_PRINT BED=60\nT1\nG4 P500\nS1000 M3\nM30\nG81"
    )
    assert read(text).ignored == [
        (2, "M104 S200"), (3, "M117 Printing"), (4, "M8"), (5, "START_PRINT BED=60"), (6, "T1"), (7, "G4 P500"),
        (8, "S1000"), (8, "M3"),
    ]  # fmt: skip


def test_words_need_no_spaces_and_no_capitals() -> None:
    np.testing.assert_array_equal(read("g1x10y5f600").poses, read("G01 X 10. Y +5.0 F600").poses)


def test_extrusion_divides_printing_from_travel() -> None:
    text = "M82\nG92 E0\nG1 X10 E0.5 F1200\nG1 E-1 F2400\nG1 Y10 F6000\nG1 E0.5\nG1 X0 E1.0\nG92 E0\nM83\nG1 Y0 E.2"
    program = read(text)
    np.testing.assert_allclose(program.extrusion, np.array([0.5, 0.0, 0.5, 0.2]) * 1e-3, atol=1e-15)
    seams = program.seams()
    assert [len(seam) for seam in seams] == [2, 3]
    np.testing.assert_array_equal(seams[1].poses, program.poses[2:])


def test_seams_end_at_rapid_moves() -> None:
    program = read("G1 X10 F600\nG3 I5\nG0 Z5\nG0 X0\nG1 Z0\nG1 Y5")
    assert [round(seam.length, 4) for seam in program.seams()] == [0.0414, 0.01]


def test_a_path_keeps_the_speeds_of_the_program() -> None:
    program = read("G1 X10 F600\nG0 Z5\nG1 Y20 F1200")
    path = program.path(rapid_speed=0.1)
    assert path.duration == pytest.approx(1.0 + 0.05 + 1.0)
    assert np.linalg.norm(path.velocity(1.5)) == pytest.approx(0.02)


def test_rotary_axes_turn_the_tool_about_its_tip() -> None:
    program = read("G1 X10 A30 C90 F600", rotary=True)
    turn = bik.pose(rpy=np.radians([30.0, 0.0, 90.0]))[:3, :3]
    np.testing.assert_allclose(program.poses[-1, :3, :3], turn @ np.diag([1.0, -1.0, -1.0]), atol=1e-12)
    turns = program.poses[:-1, :3, :3].transpose(0, 2, 1) @ program.poses[1:, :3, :3]
    assert np.degrees(np.arccos((np.trace(turns, axis1=1, axis2=2) - 1.0) / 2.0)).max() < 5.0
    turned = read("G1 A90 F600", rotary=True)
    assert turned.path(0.1, turn_speed=0.5).duration == pytest.approx(np.pi)


def test_a_file_is_read_and_named_in_errors(tmp_path: Path) -> None:
    (tmp_path / "part.nc").write_text("%\nO1000\n" + ORIGIN + "G1 X10 F600\n%\n")
    assert len(bik.paths.from_gcode(tmp_path / "part.nc")) == 2
    (tmp_path / "bad.nc").write_text("G5 X1")
    told = f"{tmp_path / 'bad.nc'}: line 1: G5 is not read: G0 to G3, G17 to G21, G90 and G91 are"
    assert_told(lambda: bik.paths.from_gcode(tmp_path / "bad.nc"), Invalid, told)


def test_calls_take_a_program_as_poses() -> None:
    robot = bik.Robot.named("ur5e")
    program = read("G1 X50 F600\nG3 X50 Y50 J25", frame=bik.pose([0.4, 0.0, 0.2]), tolerance=1e-4)
    plan = bik.plan_along_path(robot, program, task=bik.tasks.Pointing(), limits=bik.Limits(acceleration=5.0))
    assert plan.success


AFTER_ORIGIN = {
    "G1 X1": "line 2: G1 X1: no F before it, so that its speed is not known: give feed=",
    "G1 X1 F0": "line 2: F0: a feed must be positive",
    "G2 X1 R1000000000000 F1": "line 2: R1e+12: a number beyond 1e+09",
    "G1 X1..2 F1": "line 2: '.2' is no word: a letter and a number, such as X10.5",
    "G1 X1e F1": "line 2: 'e' is no word: a letter and a number, such as X10.5",
    "G1 X F1": "line 2: 'X' is no word: a letter and a number, such as X10.5",
    "G1 Xnan F1": "line 2: 'Xnan' is no word: a letter and a number, such as X10.5",
    "G1 X1 X2 F1": "line 2: G1 X1 X2 F1: two words X in one line",
    "G1 G2 X1 F1": "line 2: G1 G2 X1 F1: two moves in one line",
    "G1 X1 I2 F1": "line 2: I2: only arcs, G2 and G3, have a centre or a radius",
    "G1 X1 U2 F1": "line 2: U2: words U are not read",
    "G2 X1 F1": "line 2: G2 X1 F1: an arc needs R, or its centre by I, J, K",
    "G2 X1 I0 J0 F1": "line 2: the centre of the arc is its start: the radius is 0",
    "G2 X0 Y0 R5 F1": "line 2: an arc by R needs an end other than its start: a full circle takes I, J or K",
    "G2 X10 R0 F1": "line 2: R of 0 m does not reach: half the distance to the end is 0.005 m",
    "G2 X10 R4.9 F1": "line 2: R of 0.0049 m does not reach: half the distance to the end is 0.005 m",
    "G2 X10 I3 F1": "line 2: the end is 0.007 m from the centre of the arc, and the start 0.003 m",
    "G2 X10 I5 K2 F1": "line 2: K: the arc lies in the plane of G17, without this axis",
    "G2 X10 I5 R5 F1": "line 2: R and I in one arc: give one of them",
    "G2 X10 I5 P2 F1": "line 2: P2: arcs of several turns are not read",
    "G1 X1 A90 F1": "line 2: A90: rotary axes are read with rotary=True alone, which takes X, Y, Z as the tip in the frame of the part",
    "G41 D1": "line 2: G41 is not read: G0 to G3, G17 to G21, G90 and G91 are",
    "G81 X1 Z-5 R2 F1": "line 2: G81 is not read: G0 to G3, G17 to G21, G90 and G91 are",
    "G55": "line 2: G55 is not read: G0 to G3, G17 to G21, G90 and G91 are",
    "G93": "line 2: G93 is not read: G0 to G3, G17 to G21, G90 and G91 are",
    "G92 X0": "line 2: G92 X0: a new origin is not read: give frame=",
    "G92": "line 2: G92: a new origin is not read: give frame=",
    "G10 L2 P1 X5": "line 2: G10 L: offsets are not read: give frame=, or the program in the frame of the part",
    "G28 G1 X5": "line 2: G28 G1 X5: a move beside a wait or homing in one line",
    "M98 P2": "line 2: M98: subprograms are not read: let the program be written out",
    "#1=5": "line 2: #1=5: parameters, expressions and jumps are not read: let the program be written out",
    "G1 X[1+2] F1": "line 2: G1 X[1+2] F1: parameters, expressions and jumps are not read: let the program be written out",
    "GOTO 10": "line 2: GOTO 10: parameters, expressions and jumps are not read: let the program be written out",
    "/G1 X1 F1": "line 2: /G1 X1 F1: a line that a switch leaves out (/) is not read: delete it, or its /",
    "G1 X1e-05 F1": "line 2: X1e-05: numbers have no exponents in G-code",
}


@pytest.mark.parametrize("text", AFTER_ORIGIN)
def test_what_is_not_read_is_refused_by_line_and_word(text: str) -> None:
    assert_told(lambda: read(text), Invalid, AFTER_ORIGIN[text])


@pytest.mark.parametrize(("call", "message"), [
    (lambda: api.paths.from_gcode("\n"), "no move between two known positions: the program draws no path"),
    (lambda: api.paths.from_gcode("; only\n(comments)\n"), "no move between two known positions: the program draws no path"),
    (lambda: api.paths.from_gcode("G0 X1 Y1\nG1 X2 F1", start=None), "no move between two known positions: the program draws no path"),
    (lambda: api.paths.from_gcode("X1\n"), "line 1: X1: a position before any G0 to G3"),
    (lambda: api.paths.from_gcode("G91 G1 X1 F1\n", start=None), "line 1: X1: G91 from a place that is not known: give start="),
    (lambda: api.paths.from_gcode("G2 X1 Y1 Z0 I1 F1\n", start=None), "line 1: an arc from a place that is not known: give start="),
    (lambda: api.paths.from_gcode("none.nc"), "cannot read file 'none.nc': No such file or directory; a program given as text has at least two lines"),
    (lambda: api.paths.from_gcode(5), "file must be a file, or the text of a program, got 5"),
    (lambda: api.paths.from_gcode(ORIGIN, axis=(0, 0, 0)), "axis must not be zero, got [0.0, 0.0, 0.0]"),
    (lambda: api.paths.from_gcode(ORIGIN, start=(0, 0)), "start: expected shape (3,), got (2,)"),
    (lambda: api.paths.from_gcode(ORIGIN, feed=0), "feed must be positive and finite, got 0"),
    (lambda: api.paths.from_gcode(ORIGIN, tolerance=np.nan), "tolerance must be positive and finite, got nan"),
    (lambda: api.paths.from_gcode(ORIGIN, rotary=1), "rotary must be True or False, got 1"),
    (lambda: read("G3 I1000 F1", tolerance=1e-300), "tolerance: 1e-300 m would make 1.57e+150 poses; at most 1,000,000 are made"),
    (lambda: read("G1 X1 F1").path(0), "rapid_speed must be positive and finite, got 0"),
])  # fmt: skip
def test_wrong_input_is_told(call: Callable[[], object], message: str) -> None:
    assert_told(call, Invalid, message)
