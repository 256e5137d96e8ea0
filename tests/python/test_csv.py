"""Tables of numbers in files."""

from pathlib import Path

import numpy as np
import pytest

from beetle_ik import InvalidInputError
from beetle_ik.files.csv_table import read_table, write_table
from beetle_ik.files.whole import whole_file


def test_numbers_come_back_with_the_same_bits(tmp_path: Path) -> None:
    rows = np.random.default_rng(0).normal(size=(20, 2)) * 10.0 ** np.arange(-150, 150, 15)[:, None]
    write_table(tmp_path / "table.csv", ["a", "b, with comma"], rows)
    table = read_table(tmp_path / "table.csv", ["a"])
    assert list(table) == ["a", "b, with comma"]
    np.testing.assert_array_equal(np.column_stack(list(table.values())), rows)


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("x,y\n1,2\n", ", line 1: column 'z' is missing; columns found: x, y"),
        ("", ", line 1: column 'x' is missing; columns found: none"),
        ("x;y;z\n1;2;3\n", ", line 1: column 'x' is missing; columns found: x;y;z; separate them by commas"),
        (
            "0.4,1e-3,-2\n1,2,3\n",
            ", line 1: column 'x' is missing; columns found: 0.4, 1e-3, -2; write their names above the numbers",
        ),
        (
            "X,Y,Z\n",
            ", line 1: column 'x' is missing; columns found: X, Y, Z; write 'x' for 'X'",
        ),
        (
            "x,Z,y\n",
            ", line 1: column 'z' is missing; columns found: x, Z, y; write 'z' for 'Z'",
        ),
        ("x,y,z,x\n", ", line 1: column 'x' appears twice"),
        ("x,y,z\n1,2,3\n4,5\n", ", line 3: column 'z' is missing"),
        ("x,y,z\n1,2,3,4\n", ", line 2: 4 entries for 3 columns"),
        ("x,y,z\n1,two,3\n", ", line 2, column 'y': 'two' is not a number"),
        ("x,y,z\n1,2,\n", ", line 2, column 'z': '' is not a number"),
        ("x,y,z\n1,nan,3\n", ", line 2, column 'y': nan is not finite"),
        ("x,y,z\n\n", ": no rows below the header"),
    ],
)
def test_mistakes_are_told_with_line_and_column(tmp_path: Path, text: str, problem: str) -> None:
    file = tmp_path / "points.csv"
    file.write_text(text)
    with pytest.raises(InvalidInputError) as caught:
        read_table(file, ["x", "y", "z"])
    assert str(caught.value) == f"{file}{problem}"


@pytest.mark.parametrize(
    ("content", "problem"),
    [
        ("x,y\n1,2\n3,é\n".encode("latin-1"), "line 3: byte 0xe9 is not UTF-8"),
        ("x,y\n1,2\n".encode("utf-16"), "line 1: byte 0xff is not UTF-8"),
    ],
)
def test_other_encodings_are_told(tmp_path: Path, content: bytes, problem: str) -> None:
    file = tmp_path / "points.csv"
    file.write_bytes(content)
    with pytest.raises(InvalidInputError) as caught:
        read_table(file, ["x", "y"])
    assert str(caught.value) == f"{file}, {problem}; save the file as CSV with the encoding UTF-8"


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ('x,"y\n1,2\n', "line 2: broken CSV: unexpected end of data"),
        ('x,y\n"1"1,2\n', "line 2: broken CSV: ',' expected after '\"'"),
    ],
)
def test_broken_quotes_are_told(tmp_path: Path, text: str, problem: str) -> None:
    file = tmp_path / "points.csv"
    file.write_text(text)
    with pytest.raises(InvalidInputError) as caught:
        read_table(file, ["x", "y"])
    assert str(caught.value) == f"{file}, {problem}; check the quotes up to this line"


def test_spreadsheet_habits_are_understood(tmp_path: Path) -> None:
    file = tmp_path / "points.csv"
    file.write_bytes(b"\xef\xbb\xbfx, y\r\n1, 2\r\n\r\n3, 4\r\n")  # byte order mark, spaces, CRLF, an empty line
    table = read_table(file, ["x", "y"])
    np.testing.assert_array_equal(table["y"], [2.0, 4.0])


def test_a_file_that_fails_half_way_leaves_the_old_one(tmp_path: Path) -> None:
    file = tmp_path / "result"
    file.write_text("old")

    def fail_half_way() -> None:
        with whole_file(file) as stream:
            stream.write(b"new, but not a")
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        fail_half_way()
    assert [path.name for path in tmp_path.iterdir()] == ["result"]
    assert file.read_text() == "old"


def test_a_long_header_is_cut(tmp_path: Path) -> None:
    file = tmp_path / "wide.csv"
    file.write_text(",".join(f"column_{i}" for i in range(10_000)) + "\n")
    with pytest.raises(InvalidInputError) as caught:
        read_table(file, ["time"])
    assert str(caught.value).endswith(" more")
    assert len(str(caught.value)) < 700
