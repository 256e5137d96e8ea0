"""README and site quote the tables of the benchmarks (`docs/comparison.csv`, `docs/tracking.csv`)."""

import csv
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
README = (ROOT / "README.md").read_text(encoding="utf-8")
BENCHMARKS = (ROOT / "docs" / "benchmarks.md").read_text(encoding="utf-8")


def table(name: str) -> dict[str, list[str]]:
    """The rows of a CSV file of the site, by their first cell."""
    with (ROOT / "docs" / name).open(encoding="utf-8", newline="") as file:
        return {first: rest for first, *rest in csv.reader(file)}


COMPARISON, TRACKING = table("comparison.csv"), table("tracking.csv")


def rows_below(header: str, page: str) -> list[list[str]]:
    """The cells of the table of a page that has this header."""
    lines = page[page.index(header) :].split("\n\n")[0].splitlines()[2:]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in lines]


def wrongly_quoted(page: str) -> list[str]:
    """Cells of the page's table of libraries that the CSV file does not have."""
    wrong = []
    for name, *cells in rows_below("| library | calls solved", page):
        quoted = re.match(r"(.+?) (\d[\w.]*)", name)
        if quoted is None:
            expected = spanned(name.split(": ")[1].split(", "))
        else:
            variant = ", start given" if ", start given" in name else ""
            _, *expected = COMPARISON[f"{quoted[1]}{variant} ({quoted[2]})"]
        for cell, number in zip(cells, expected, strict=True):
            if not re.match(re.escape(number) + r"(?! of)(?![\d.])", cell):
                wrong.append(f"{name}: {cell} where the table has {number}")
    return wrong


def spanned(libraries: list[str]) -> list[str]:
    """From the least to the most of several libraries, in each column."""
    rows = [row for name, row in COMPARISON.items() if name.rpartition(" ")[0] in libraries]
    assert len(rows) == len(libraries)
    columns = [[float(number) for row in rows for number in re.findall(r"[\d.]+", row[i])] for i in (1, 2, 3)]
    solved, calls = [n for n in columns[0] if n != max(columns[0])], max(columns[0])
    return [
        f"{min(solved):g} to {max(solved):g} of {calls:g}",
        *(f"{min(ratios):g} to {max(ratios):g}" for ratios in columns[1:]),
    ]


def test_the_readme_quotes_the_comparison() -> None:
    assert wrongly_quoted(README) == []


def test_a_wrong_digit_is_found() -> None:
    assert len(wrongly_quoted(README.replace("| 596 to 600 of 600 | 24 |", "| 600 of 600 | 25 |"))) == 2
    assert len(wrongly_quoted(README.replace("| 15 to 1200 |", "| 15 to 1100 |"))) == 1


@pytest.mark.parametrize(
    ("pattern", "ours", "column"),
    [
        (
            r"([\d.]+) ms \(`Tracker.step`\); placo takes ([\d.]+), the Robotics Toolbox ([\d.]+) and mink ([\d.]+)",
            "beetle-ik, Tracker.step",
            6,
        ),
        (r"takes ([\d.]+) ms, and the three take ([\d.]+), ([\d.]+) and ([\d.]+) times", "beetle-ik, track", 7),
    ],
)
def test_the_readme_quotes_the_circle(pattern: str, ours: str, column: int) -> None:
    quoted = re.search(pattern, README)
    assert quoted is not None
    milliseconds, *ratios = quoted.groups()
    assert milliseconds == TRACKING[ours][4]
    assert ratios == [TRACKING[library][column] for library in ("placo", "roboticstoolbox", "mink")]


def test_readme_and_site_have_the_same_table_of_kinematics() -> None:
    assert rows_below("| 7-joint arm", README) == rows_below("| 7-joint arm", BENCHMARKS)


def test_the_readme_quotes_the_circle_of_cheng() -> None:
    cells = {(row[0], row[1]): row for row in rows_below("| method | error band", BENCHMARKS)}
    published, star = cells["published: BAS in MATLAB", "1 mm"], cells['`BAS(variant="star")`, n = 20', "1 mm"]
    chain, beetle = (
        cells['`BAS(variant="chain")`', "2.2e-5 m"],
        cells["`BAS()`, set to the published error", "1.7e-5 m"],
    )
    rule = cells["model-based rule (the default)", "1e-9 m"]
    quoted = " ".join(README.split())
    assert f"takes {star[4]} to stay within 1 mm, where the paper's MATLAB program took {published[4]}" in quoted
    assert (
        f"takes {rule[4]} and {rule[3]} evaluations per step for {rule[2]}, the beetle {chain[3]} to {beetle[3]}"
        in quoted
    )


@pytest.mark.parametrize(
    "quantity",
    [
        r"[\d.]+ to [\d.]+ .s on average",
        r"median [\d.]+ .s, 99th percentile [\d.]+ to [\d.]+ .s",
        r"[\d,]+ Panda poses a second on one core and [\d,]+ on two",
        r"ours takes [\d.]+ to [\d.]+ .s|\([\d.]+ to [\d.]+ us\)",
    ],
)
def test_readme_and_site_quote_the_same_times(quantity: str) -> None:
    def numbers(page: str) -> set[str]:
        return set(
            re.findall(r"[\d.,]*\d", " ".join(re.findall(quantity, re.sub(r"\s+", " ", page.replace("µs", "us")))))
        )

    assert numbers(README) == numbers(BENCHMARKS) != set()
