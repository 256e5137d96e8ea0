"""README and the papers' pages quote the numbers of the reports.

The tables in `docs/papers/tables/` come from full runs: `make papers` writes them anew. To guard a number of a page,
add a `Quote`, and the name of its table to `docs/papers/tables/`.
"""

import csv
import re
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from decimal import Decimal
from functools import cache
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
TABLES = ROOT / "docs" / "papers" / "tables"
_NUMBER = re.compile(r"\d[\d\u202f ]*\.?\d*(?:e[+-]?\d+)?")

Rows = list[dict[str, str]]


@dataclass(frozen=True, kw_only=True)
class Quote:
    """Numbers of a page, and where they come from."""

    page: str
    text: str
    """As it stands on the page; line breaks count as spaces."""
    report: str
    table: str
    values: Callable[[Rows], Iterable[float]]
    """From the rows of the table: the numbers of `text`, in their order."""


@cache
def rows(report: str, table: str) -> Rows:
    with (TABLES / report / f"{table}.csv").open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def is_rounded(quoted: str, value: float) -> bool:
    """Whether `quoted` is `value` to the digits that it has."""
    exact = Decimal(quoted.replace("\u202f", "").replace(" ", ""))
    last_digit = Decimal(1).scaleb(int(exact.as_tuple().exponent))
    return abs(exact - Decimal(value)) <= last_digit * Decimal("0.5000001")


def wrong(quote: Quote) -> str | None:
    """What is wrong with a quote."""
    page = " ".join((ROOT / quote.page).read_text(encoding="utf-8").split())
    if quote.text not in page:
        return f"{quote.page} does not say '{quote.text}'"
    numbers = [found.strip() for found in _NUMBER.findall(quote.text)]
    values = list(quote.values(rows(quote.report, quote.table)))
    if len(numbers) != len(values):
        return f"'{quote.text}' has {len(numbers)} numbers for {len(values)} values"
    off = [
        f"{number} for {value}" for number, value in zip(numbers, values, strict=True) if not is_rounded(number, value)
    ]
    return f"{quote.page}, '{quote.text}': {'; '.join(off)}" if off else None


# --- Cheng et al. 2020 --------------------------------------------------------------------------

CHENG, CHENG_PAGE = "cheng2020", "docs/papers/cheng2020.md"
BOXES = ("whole box", "trust box", "box as long as the error")


def ratios(table: Rows, box: str, accuracy: str | None = None) -> dict[str, float]:
    """Evaluations of the rivals over those of BAS."""
    return {
        f"{row['method']} {row['accuracy [m]']}": float(row["over BAS"])
        for row in table
        if row["box"] == box and row["method"] != "BAS" and accuracy in (None, row["accuracy [m]"])
    }


def span(box: str, accuracy: str | None = None) -> Callable[[Rows], Iterable[float]]:
    """Least and most."""
    return lambda table: (min(ratios(table, box, accuracy).values()), max(ratios(table, box, accuracy).values()))


def box_quote(text: str, box: str, accuracy: str | None, page: str = CHENG_PAGE) -> Quote:
    return Quote(page=page, text=text, report=CHENG, table="search_box_costs", values=span(box, accuracy))


def unreached(table: Rows) -> tuple[float, float, float]:
    left = [200 - int(row["within 2000 passes"]) for row in table]
    return min(left), max(left), 200


def shares(table: Rows) -> tuple[float, ...]:
    """Least and largest mean error over the band, and over which constants."""
    found = [float(row["mean error over band"]) for row in table]
    constants = [float(row["c₁"]) for row in table]
    return min(found), max(found), min(constants), max(constants)


def steady(table: Rows) -> tuple[float, float]:
    star = table[0]
    return float(star["mean error, second half [m] measured mean"]), float(star["error band [m]"])


CHENG_QUOTES = [
    box_quote("2.6 (FA) to 6.3 (QPSO)", "whole box", "0.001"),
    box_quote("3.6 (PSO) to 14 (QPSO)", "whole box", "0.0001"),
    box_quote("3.4 (PSO) to 10 (QPSO)", "whole box", "1e-05"),
    box_quote("1.2 (PSO) to 2.2 (QPSO)", "trust box", "0.001"),
    box_quote("1.9 (FA) to 5.1 (GA)", "trust box", "0.0001"),
    box_quote("2.3 (PSO) to 8.5 (GA)", "trust box", "1e-05"),
    box_quote("0.75 (QPSO) to 1.1 (GA)", "box as long as the error", "0.001"),
    box_quote("0.73 (QPSO) to 0.96 (GA)", "box as long as the error", "0.0001"),
    box_quote("0.73 (QPSO) to 0.95 (FA)", "box as long as the error", "1e-05"),
    box_quote("2.6 to 6.3 times the evaluations of the beetle", "whole box", "0.001", "README.md"),
    box_quote("in a fixed small box 1.2 to 2.2 times", "trust box", "0.001", "README.md"),
    box_quote("2.3 to 8.5 times", "trust box", "1e-05", "README.md"),
    box_quote("0.73 to 1.1 times at every accuracy", "box as long as the error", None, "README.md"),
    Quote(
        page=CHENG_PAGE,
        text="2.0e-5 m with a band of 4e-5 m",
        report=CHENG,
        table="steady_errors",
        values=steady,
    ),
    Quote(
        page=CHENG_PAGE,
        text="0.45 to 0.93 of the band, for c₁ and c₂ from 0.3 to 3",
        report=CHENG,
        table="shares_of_the_band",
        values=shares,
    ),
    Quote(
        page=CHENG_PAGE,
        text="2 to 14 of 200 random targets",
        report=CHENG,
        table="convergence",
        values=unreached,
    ),
    Quote(
        page=CHENG_PAGE,
        text="5 evaluations a step for 3e-6 m, where BAS needs 348",
        report=CHENG,
        table="accuracy_costs",
        values=lambda table: (
            float(table[-1]["evaluations a step"]),
            float(table[-1]["mean error, second half [m]"]),
            float(table[2]["evaluations a step"]),
        ),
    ),
]


def test_the_names_beside_the_ratios_are_right() -> None:
    """The page says which rival needs least and most."""
    table, page = rows(CHENG, "search_box_costs"), (ROOT / CHENG_PAGE).read_text(encoding="utf-8")
    cells = re.findall(r"[\d.]+ \((\w+)\) to [\d.]+ \((\w+)\)", page)
    expected = []
    for box in BOXES:
        for accuracy in ("0.001", "0.0001", "1e-05"):
            found = ratios(table, box, accuracy)
            expected.append(tuple(choose(found, key=found.__getitem__).split()[0] for choose in (min, max)))
    assert cells == expected


# --- Yuan et al. 2016 ---------------------------------------------------------------------------

YUAN, YUAN_PAGE = "yuan2016", "docs/papers/yuan2016.md"
SHARES = ("converged in 1000 iterations [%]", "solved in 1000 iterations [%]", "converged in 20000 iterations [%]")


def iterations(column: str) -> Callable[[Rows], list[float]]:
    return lambda table: [float(row[column]) for row in table]


def share(method: str, columns: Iterable[str] = SHARES[:1]) -> Callable[[Rows], list[float]]:
    return lambda table: [float(row[column]) for row in table if row["method"] == method for column in columns]


def extremes(table: Rows) -> list[float]:
    apps, newton = (iterations(f"{name}: iterations measured")(table) for name in ("APPS", "Newton-Raphson"))
    return [min(apps), max(apps), min(newton), max(newton)]


def transposed(table: Rows) -> list[float]:
    errors = iterations("Jacobian transpose, step 0.005, after 4000: MAE [mm]")(table)
    return [min(errors), max(errors), 4000]


def share_quote(text: str, method: str) -> Quote:
    return Quote(
        page="docs/papers/apps.md", text=text, report=YUAN, table="random_targets", values=share(method, SHARES[:2])
    )


PAPER = "APPS, η = 0.2 (the paper's)"
COUNTS = iterations("APPS: iterations measured")


def table_6_quote(page: str, text: str, values: Callable[[Rows], Iterable[float]]) -> Quote:
    return Quote(page=page, text=text, report=YUAN, table="table_6", values=values)


YUAN_QUOTES = [
    table_6_quote(YUAN_PAGE, "438, 256, 316, 618, 278, 233 and 281", COUNTS),
    table_6_quote("README.md", "438, 256, 316, 618, 278, 233, 281", COUNTS),
    table_6_quote(YUAN_PAGE, "within 7 iterations, more accurately", lambda table: extremes(table)[-1:]),
    table_6_quote("README.md", "it needs 7 iterations at most", lambda table: extremes(table)[-1:]),
    table_6_quote(YUAN_PAGE, "233 to 618 iterations against 3 to 7", extremes),
    table_6_quote(YUAN_PAGE, "1.3 to 118 mm away after 4000", transposed),
    Quote(
        page=YUAN_PAGE,
        text="a rate taken from the gradients themselves 85 %",
        report=YUAN,
        table="random_targets",
        values=share("APPS, automatic rate"),
    ),
    Quote(
        page=YUAN_PAGE,
        text="brings 34 %",
        report=YUAN,
        table="random_targets",
        values=share(PAPER),
    ),
    Quote(
        page="README.md",
        text="reaches 34 % of random targets",
        report=YUAN,
        table="random_targets",
        values=share(PAPER),
    ),
    share_quote("(the paper's) | 34 % | 19 % |", PAPER),
    share_quote("(the best fixed one) | 51 % | 33 % |", "APPS, η = 0.15"),
    share_quote("| 26 % | 17 % |", "APPS, η = 0.05"),
    share_quote("| **85 %** | **59 %** |", "APPS, automatic rate"),
    share_quote("| Jacobian transpose | 64 % | 30 % |", "Jacobian transpose"),
    share_quote("| Newton-Raphson | 99 % | 14 % |", "Newton-Raphson"),
    share_quote("| Levenberg-Marquardt, one start | 88 % | 41 % |", "Levenberg-Marquardt, one start"),
    share_quote("| APPS from many starts | 97 % | 96 % |", "APPS from many starts"),
    share_quote("library's default | 100 % | 100 % |", "Levenberg-Marquardt from many starts (the default)"),
    Quote(
        page="docs/papers/apps.md",
        text="20 000 iterations the best fixed rate converges on 76 % of 500, the automatic one on 84 %",
        report=YUAN,
        table="random_targets",
        values=lambda table: [
            20_000,
            *share("APPS, η = 0.15", SHARES[2:])(table),
            500,
            *share("APPS, automatic rate", SHARES[2:])(table),
        ],
    ),
]

# --- Khan et al. 2022 ---------------------------------------------------------------------------

KHAN, KHAN_PAGE = "khan2022", "docs/papers/khan2022.md"


def cells(*places: tuple[int, str], scale: float = 1.0) -> Callable[[Rows], list[float]]:
    """Of rows, the numbers in columns."""
    return lambda table: [scale * float(table[row][column]) for row, column in places]


def khan_quote(text: str, table: str, values: Callable[[Rows], Iterable[float]], page: str = KHAN_PAGE) -> Quote:
    return Quote(page=page, text=text, report=KHAN, table=table, values=values)


ARRIVAL, SOONER = "below 10⁻³ [s]", "h below 10⁻² [s]"
AT_STATE, WHERE_SENT = "h(θ), 40 to 50 s [m²]", "h(θ′), where the arm is [m²]"
OFF, CIRCLE = "joints off, last round [rad]", "circle [mm]"
ZNNBAS_OFF, BROYDEN_OFF = "ZNNBAS, eq. (16) [mm]", "BroydenBAS [mm]"
NOISY_OFF = "ZNNBAS, eq. (16), k = 100 [mm]"
FREE_OFF, FREE_TURNED = "orientation free: off [mm]", "orientation free: turned [mrad]"
HELD_OFF, HELD_TURNED = "orientation held: off [mm]", "orientation held: turned [mrad]"


def beside_a_ball(row: int) -> Callable[[Rows], list[float]]:
    return cells(
        (row, "evaluations a point (mean)"), (row, "tool off (rms) [mm]"), (row, "points nearer than the margin")
    )


def in_method(row: int) -> Callable[[Rows], list[float]]:
    return cells((row, CIRCLE))


def after_ten_rounds(row: int) -> Callable[[Rows], list[float]]:
    return cells((row, OFF))


def held(row: int) -> Callable[[Rows], list[float]]:
    return cells((row, HELD_OFF), (row, HELD_TURNED))


KHAN_QUOTES = [
    khan_quote("after 5.6 s without limits, 11.9 s", "figures_2_and_3", cells((0, ARRIVAL), (1, ARRIVAL))),
    khan_quote("after 4.8 s and 6.4 s", "figures_2_and_3", cells((0, SOONER), (1, SOONER))),
    khan_quote("is 8.7e-5 m", "figures_2_and_3", cells((0, f"{AT_STATE} mean"))),
    khan_quote("3.9e-3 m", "figures_2_and_3", cells((0, f"{WHERE_SENT} mean"))),
    khan_quote("3.0 s with ticks of 10 ms, 4.7 s with ticks of 1 ms", "figures_2_and_3",
               lambda table: [float(table[i][c]) for i in (3, 4) for c in (ARRIVAL, "tick [ms]")]),
    khan_quote("rises in 30 % of", "theorem_1", cells((0, "ticks in which h(θ) rises, still target [%]"))),
    khan_quote("is 2.4e-3 m", "definition_2", cells((1, "to 50 s [m²]"))),
    khan_quote("2.1e-3 m", "definition_2", cells((1, "to 200 s [m²]"))),
    khan_quote("is 3.5e-5 and 3.1e-5 m", "definition_2", cells((0, "to 50 s [m²]"), (0, "to 200 s [m²]"))),
    khan_quote("h is 7.5e-6 m", "both_antennae", cells((10, AT_STATE))),
    khan_quote("leaves 10.0e-4 m", "both_antennae", cells((6, AT_STATE))),
    khan_quote("the constant antenna 0.9e-4 m", "both_antennae", cells((3, AT_STATE))),
    khan_quote("0.56 to 3.05 mm", "rounds", cells((0, "tool off, first round [mm]"), (0, "tool off, last round [mm]"))),
    khan_quote("0.62 rad off after ten rounds", "rounds", after_ten_rounds(0)),
    khan_quote("| 0.16 mm |", "methods", in_method(0)),
    khan_quote("| 0.0012 mm |", "methods", in_method(1)),
    khan_quote("| 0.0028 mm |", "methods", in_method(2)),
    khan_quote("| 64 mm |", "methods", in_method(3)),
    khan_quote("| 2.8 mm |", "methods", in_method(4)),
    khan_quote("| 0.00051 rad |", "rounds", after_ten_rounds(5)),
    khan_quote("| 0.78 rad |", "rounds", after_ten_rounds(6)),
    khan_quote("| 0.63 rad |", "rounds", after_ten_rounds(7)),
    khan_quote("with 1 mm on each axis it is 2.7 mm off, ZNNBAS with eq. (16) 8.9 mm", "sensor_errors",
               lambda table: [1.0, float(table[3][BROYDEN_OFF]), 16, float(table[3][NOISY_OFF])]),
    khan_quote("with 3 mm it is 16.8 mm off, ZNNBAS 14.0 mm", "sensor_errors",
               lambda table: [3.0, float(table[4][BROYDEN_OFF]), float(table[4][NOISY_OFF])]),
    khan_quote("is 1.9e-6 mm and 3.2e-6 mrad off", "orientation", held(2)),
    khan_quote("is 21 mm and 13 mrad off", "orientation", held(1)),
    khan_quote("free 1.7 mm, and its tool turns by 142 mrad", "orientation", cells((1, FREE_OFF), (1, FREE_TURNED))),
    khan_quote("it is 87 mm and 155 mrad off", "orientation", held(0)),
    khan_quote("is 0.27 mm and 0.24 mrad off", "orientation", held(3)),
    khan_quote("it is 26 mm and 4.5 mrad off", "orientation", held(4)),
    khan_quote("stays within 2.5 mm", "servos", cells((3, ZNNBAS_OFF))),
    khan_quote("0.14 mm there, 0.0003 mm at 50 ms", "servos",
               cells((2, BROYDEN_OFF), (4, BROYDEN_OFF), (4, "tick [ms]"))),
    khan_quote("| beetle, as many evaluations | 4.2 | 49 mm | 49 |", "beside_a_ball", beside_a_ball(2)),
    khan_quote("| 42 | 13 mm | 41 |", "beside_a_ball", beside_a_ball(3)),
    khan_quote("| 235 | 0.88 mm | 30 |", "beside_a_ball", beside_a_ball(4)),
    khan_quote("| 554 | 0.078 mm | 7 |", "beside_a_ball", beside_a_ball(5)),
    khan_quote("steps aside by up to 0.3 rad", "beside_a_ball", cells((1, "largest joint step [rad]"))),
    khan_quote("its tool shakes by 6 cm", "figures_2_and_3",
               lambda table: [100 * float(table[0][f"{WHERE_SENT} mean"]) ** 0.5], "README.md"),
]  # fmt: skip


# --- Trajectory tracking by PSO -----------------------------------------------------------------

PSO, PSO_PAGE = "pso-tracking", "docs/papers/pso_tracking.md"
IN_PATH = "in 2 s [rad] measured"


def pso_quote(text: str, table: str, values: Callable[[Rows], Iterable[float]], page: str = PSO_PAGE) -> Quote:
    return Quote(page=page, text=text, report=PSO, table=table, values=values)


def milliradians(row: int) -> Callable[[Rows], list[float]]:
    return cells((row, IN_PATH), scale=1e3)


def found_in(*chosen: int) -> Callable[[Rows], list[float]]:
    return lambda table: [float(n) for row in chosen for n in table[row]["found, random poses"].split(" of ")]


PSO_QUOTES = [
    pso_quote("0.83e-4 m at 10 ms, 0.08e-4 m at 1 ms", "pseudo_inverse", lambda table: [
        float(table[3]["largest tip error [m] measured"]), 10, float(table[4]["largest tip error [m] measured"]), 1]),
    pso_quote("46 of 50 pictures; a plain threshold 50 of 50", "contours", found_in(0, 1)),
    pso_quote("46 of 50 pictures (a threshold in 50 of 50)", "contours", found_in(0, 1), "README.md"),
    pso_quote("by hand | 32 mrad", "controllers", milliradians(0)),
    pso_quote("on a grid | 6.70 mrad", "controllers", milliradians(1)),
    pso_quote("fed forward | 1.51 mrad", "controllers", milliradians(2)),
    pso_quote("bee colony | 6.71 mrad", "controllers", milliradians(3)),
    pso_quote("GA-RBF | 2.20 mrad", "controllers", milliradians(4)),
    pso_quote("without a servo | 0.24 mrad", "controllers", milliradians(5)),
    pso_quote("on the same servos | 3.97 mrad", "controllers", milliradians(6)),
]  # fmt: skip

# --- Wang et al. 2019 ---------------------------------------------------------------------------

WANG, WANG_PAGE = "wang2019", "docs/papers/wang2019.md"
FREE, AS_PUBLISHED = "chosen by all", "both positive"


def wang_quote(text: str, table: str, values: Callable[[Rows], Iterable[float]]) -> Quote:
    return Quote(page=WANG_PAGE, text=text, report=WANG, table=table, values=values)


def elbow_quote(text: str, elbows: str) -> Quote:
    """A row of the page: number of links, bound, our plan, mean of TPBSO, mean of the best search."""
    columns = ("links", "bound [s]", "ours [s]", "TPBSO [s] mean", "its mean [s] mean")
    links = re.findall(r"\d+", text)[0]

    def values(table: Rows) -> Iterable[float]:
        row = next(row for row in table if (row["links"], row["elbows"]) == (links, elbows))
        return [float(row[column]) for column in columns]

    return wang_quote(text, "nearest", values)


def tuned_quote(text: str) -> Quote:
    """A row of the page: number of links, then the mean times of the tuned searches."""
    links = re.findall(r"\d+", text)[0]

    def values(table: Rows) -> Iterable[float]:
        asked = ("equal evaluations, equal tuning", "least time", links)
        means = {
            row["search"]: float(row["cost [s, rad] measured mean"])
            for row in table
            if (row["contest"], row["objective"], row["links"]) == asked
        }
        return [int(links), *(means[search] for search in ("TPBSO", "PSO", "GA", "DE"))]

    return wang_quote(text, "point_to_point", values)


def gain(path: str) -> Callable[[Rows], Iterable[float]]:
    """How many times as fast the motion is whose redundancy and timing are found together."""

    def values(table: Rows) -> Iterable[float]:
        costs = {
            row["search"]: float(row["cost [s, rad] mean"])
            for row in table
            if (row["path"], row["objective"]) == (path, "least time")
        }
        together = costs["redundancy and timing together"]
        return [min(costs[search] for search in ("TPBSO", "PSO", "GA", "DE")) / together]

    return values


WANG_QUOTES = [
    elbow_quote("| 2 links, elbows free | 0.740 s | 0.889 s | 0.882 s | 0.876 s |", FREE),
    elbow_quote("| 3 links | 0.591 s | 0.710 s | 0.954 s | 0.731 s |", FREE),
    elbow_quote("| 4 links | 0.520 s | 0.625 s | 0.947 s | 0.750 s |", FREE),
    elbow_quote("| 5 links | 0.470 s | 0.565 s | 0.971 s | 0.880 s |", FREE),
    elbow_quote("| 2 links, elbows as in the paper | 1.021 s | 1.227 s | 1.259 s | 1.207 s |", AS_PUBLISHED),
    elbow_quote("| 3 links | 0.696 s | 0.837 s | 1.167 s | 0.913 s |", AS_PUBLISHED),
    elbow_quote("| 4 links | 0.564 s | 0.678 s | 1.210 s | 0.901 s |", AS_PUBLISHED),
    elbow_quote("| 5 links | 0.486 s | 0.584 s | 1.282 s | 1.038 s |", AS_PUBLISHED),
    tuned_quote("| 2 links | 1.259 | 1.234 | 1.228 | 1.207 |"),
    tuned_quote("| 3 links | 1.167 | 1.139 | 1.191 | 0.913 |"),
    tuned_quote("| 4 links | 1.210 | 1.138 | 1.087 | 0.901 |"),
    tuned_quote("| 5 links | 1.282 | 1.183 | 1.194 | 1.038 |"),
    wang_quote("2.7 times (pentagram", "along_path", gain("pentagram")),
    wang_quote("2.1 times (closed curve", "along_path", gain("closed curve")),
]

QUOTES = CHENG_QUOTES + YUAN_QUOTES + KHAN_QUOTES + PSO_QUOTES + WANG_QUOTES


@pytest.mark.parametrize("quote", QUOTES, ids=lambda quote: f"{Path(quote.page).stem}: {quote.text}")
def test_a_page_quotes_its_report(quote: Quote) -> None:
    assert wrong(quote) is None


PAGES = {CHENG: CHENG_PAGE, YUAN: YUAN_PAGE, KHAN: KHAN_PAGE, PSO: PSO_PAGE, WANG: WANG_PAGE}


@pytest.mark.parametrize("report", PAGES)
def test_a_page_counts_the_verdicts_of_its_report(report: str) -> None:
    with (ROOT / "docs" / "papers" / "claims" / f"{report}.csv").open(encoding="utf-8", newline="") as file:
        verdicts = [row["verdict"] for row in csv.DictReader(file)]
    reproduced = sum(verdict.startswith("reproduced") for verdict in verdicts)
    contradicted, open_, untested = map(verdicts.count, ("contradicted", "not identifiable", "not tested"))
    sentence = (
        f"Of {len(verdicts)} claims {reproduced} are reproduced, {contradicted} contradicted, {open_} not identifiable "
        f"and {untested} not tested"
    )
    assert sentence in (ROOT / PAGES[report]).read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("quoted", "value", "right"),
    [("2.6", 2.64, True), ("2.6", 2.66, False), ("3e-6", 3.2e-6, True), ("3e-6", 3.6e-6, False), ("20 000", 2e4, True)],
)
def test_rounding(quoted: str, value: float, right: bool) -> None:
    assert is_rounded(quoted, value) is right


def test_a_wrong_digit_and_a_missing_sentence_are_found() -> None:
    quote = QUOTES[0]
    changed = Quote(
        page=quote.page, text=quote.text, report=CHENG, table=quote.table, values=span("trust box", "0.001")
    )
    assert (wrong(changed) or "").startswith("docs/papers/cheng2020.md, '2.6 (FA) to 6.3 (QPSO)': 2.6 for 1.18")
    lost = Quote(page=quote.page, text="9.9 times", report=CHENG, table=quote.table, values=quote.values)
    assert wrong(lost) == "docs/papers/cheng2020.md does not say '9.9 times'"
