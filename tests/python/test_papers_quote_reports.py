"""README and the papers' pages quote what the reports say.

The tables in `docs/papers/tables/` are those of full runs: `make papers` writes them anew. To guard a number of a page,
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

QUOTES = CHENG_QUOTES + YUAN_QUOTES


@pytest.mark.parametrize("quote", QUOTES, ids=lambda quote: f"{Path(quote.page).stem}: {quote.text}")
def test_a_page_quotes_its_report(quote: Quote) -> None:
    assert wrong(quote) is None


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
