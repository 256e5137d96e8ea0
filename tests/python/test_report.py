"""Reports: refused parts, formats of numbers and text, and the files written."""

import csv
import json
from pathlib import Path

import numpy as np
import pytest
from PIL import Image, ImageSequence

import beetle_ik as bik
from beetle_ik import experiments
from beetle_ik.experiments import Context, Experiment
from beetle_ik.figures.frames import Frames
from beetle_ik.report import (
    CarriedOver,
    Check,
    Claim,
    Column,
    Figure,
    Printed,
    Report,
    Section,
    Spread,
    Table,
    Verdict,
    drawing,
    not_given,
    number,
)
from beetle_ik.report.markup import inline, paragraphs
from beetle_ik.report.numbers import spread
from beetle_ik.report.tables import shown_rows, to_csv
from beetle_ik.report.write import _picture

NBSP = "\u00a0"


def table(**changes: object) -> Table:
    options: dict[str, object] = {
        "name": "table_2",
        "title": "Times",
        "columns": [Column(name="method"), Column(name="time", unit="s", compared=True), Column(name="evaluations")],
        "rows": [
            ["BAS", (Spread(0.53, 0.04), Spread(1.234e-6, 3e-8)), 12345],
            ["GA", (Printed.NOT_IN_COPY, Spread(25.0, 10.2)), None],
        ],
    }
    return Table(**(options | changes))  # type: ignore[arg-type]


def claim(**changes: object) -> Claim:
    options: dict[str, object] = {
        "statement": "It is fast.",
        "source": "Table 2",
        "rule": "At most 2 s.",
        "measured": "1 s",
        "holds": True,
        "section": "Times",
    }
    options |= changes
    return Claim.judged(options.pop("statement"), **options)  # type: ignore[arg-type]


def check(holds: bool = True) -> Check:
    return Check(
        statement="It is ours.", rule="No step misses.", measured="0 steps missed", holds=holds, section="Times"
    )


def report(holds: bool = True) -> Report:
    with drawing(2.0) as figure:
        figure.subplots().plot([0.0, 1.0])
    blocks = ["Text with <marks>.", table(), Figure(name="figure_1", title="A line", drawing=figure)]
    return Report(
        summary="All of *it*.", sections=[Section("Times", blocks)], claims=[claim(holds=holds)], checks=[check(holds)]
    )


@pytest.fixture
def registered(monkeypatch: pytest.MonkeyPatch) -> list[Context]:
    """Experiments "first" and "second" in place of the real ones; the list receives the contexts of their runs."""
    contexts: list[Context] = []

    def run(context: Context) -> Report:
        contexts.append(context)
        for _ in context.each("counting", range(2)):
            pass
        return report(holds=context.seed == 0)

    made = {
        name: Experiment(name=name, title=name.title(), paper="A. Author, 2020", run=run)
        for name in ("first", "second")
    }
    monkeypatch.setattr("beetle_ik.experiments.reproduction.names", lambda: list(made))
    monkeypatch.setattr("beetle_ik.experiments.reproduction.experiment", made.__getitem__)
    return contexts


@pytest.mark.parametrize(
    ("value", "digits", "text"),
    [
        (0.0, 3, "0.00"),
        (1.97e-5, 3, f"1.97{NBSP}×{NBSP}10⁻⁵"),
        (9.999e-4, 3, "0.00100"),
        (0.5, 2, "0.50"),
        (-12.34, 3, "\u221212.3"),
        (123456.0, 3, "123\u202f456"),
        (12345678.0, 3, f"1.23{NBSP}×{NBSP}10⁷"),
        (123456, 3, "123\u202f456"),
        (float("nan"), 3, "–"),
        (float("-inf"), 3, "\u2212∞"),
    ],
)
def test_numbers_read_well(value: float, digits: int, text: str) -> None:
    assert number(value, digits) == text


def test_a_spread_shares_its_power_of_ten() -> None:
    assert spread(1.97e-5, 1.1e-6) == f"(1.97{NBSP}±{NBSP}0.11){NBSP}×{NBSP}10⁻⁵"
    assert spread(25.0, 10.2) == f"25.0{NBSP}±{NBSP}10.2"
    assert spread(25.0, float("nan")) == "25.0"


def test_spread_is_that_of_a_sample() -> None:
    assert Spread.of([1.0, 2.0, 3.0]) == Spread(2.0, 1.0)
    assert Spread.of([4.0]).std != Spread.of([4.0]).std  # one run has no spread


def test_text_is_escaped_and_marked() -> None:
    assert inline("a < b, `c*d*e`, *so* **it** is") == (
        "a &lt; b, <code>c*d*e</code>, <em>so</em> <strong>it</strong> is"
    )
    assert inline("[here](https://example.org/a)") == '<a href="https://example.org/a">here</a>'
    assert inline("[no](javascript:alert)") == "[no](javascript:alert)"
    assert paragraphs("one\ntwo\n\n- a\n- b\n  c") == "<p>one two</p>\n<ul><li>a</li><li>b c</li></ul>"


def test_a_table_keeps_all_digits_in_its_csv() -> None:
    assert list(csv.reader(to_csv(table()).splitlines())) == [
        [
            "method",
            *(f"time [s] {part} {s}" for part in ("printed", "measured") for s in ("mean", "std")),
            "evaluations",
        ],
        ["BAS", "0.53", "0.04", "1.234e-06", "3e-08", "12345"],
        ["GA", "not in our copy", "", "25.0", "10.2", ""],
    ]
    assert to_csv(table(rows=[])) == "method,time [s] printed,time [s] measured,evaluations\n"


def test_printed_numbers_are_shown_as_they_are_printed() -> None:
    bas, ga = shown_rows(table())
    assert [cell.text for cell in bas][:2] == ["BAS", f"0.53{NBSP}±{NBSP}0.04"]
    assert [(cell.text, cell.kind) for cell in ga] == [
        ("GA", "text"),
        ("not in our copy", "absent"),
        (f"25.00{NBSP}±{NBSP}10.20", "number measured"),
        ("–", "number"),
    ]


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"name": "Table 2"}, "'Table 2' is no name for a file: use lower-case letters, digits and '_'"),
        ({"rows": [["BAS", 1.0, 2]]}, "table 'table_2', row 0, column 'time': expected a pair (printed, measured)"),
        (
            {"rows": [["BAS", (1.0, 1.0), (1, 2)]]},
            "table 'table_2', row 0, column 'evaluations': expected a single value",
        ),
        ({"rows": [["BAS"]]}, "table 'table_2', row 0: 1 cells for 3 columns"),
    ],
)
def test_a_wrong_table_is_refused_where_it_is_made(changes: dict[str, object], message: str) -> None:
    with pytest.raises(ValueError) as refused:  # noqa: PT011  # the message is compared in full
        table(**changes)
    assert str(refused.value) == message


@pytest.mark.parametrize(
    ("data", "verdict"),
    [
        ({"holds": 1.0 <= 2.0}, Verdict.REPRODUCED),
        ({"holds": 3.0 <= 2.0}, Verdict.CONTRADICTED),
        ({"holds": True, "reading": "the band is 1 mm"}, Verdict.WITH_READING),
        ({"holds": False, "reading": "the band is 1 mm"}, Verdict.NOT_IDENTIFIABLE),
        ({"holds": {"star": False, "chain": False}, "reading": "the band is 1 mm"}, Verdict.NOT_IDENTIFIABLE),
        ({"holds": {"star": True, "chain": True}}, Verdict.WITH_READING),
        ({"holds": {"star": False, "chain": False}}, Verdict.CONTRADICTED),
        ({"holds": {"star": True, "chain": False}}, Verdict.NOT_IDENTIFIABLE),
        ({"holds": True, "missing": not_given({"band": 1e-3})}, Verdict.REPRODUCED),
        ({"holds": True, "missing": not_given({"band": Printed.NOT_STATED})}, Verdict.NOT_IDENTIFIABLE),
        ({"holds": False, "missing": not_given({"band": Printed.NOT_IN_COPY})}, Verdict.NOT_IDENTIFIABLE),
        ({"holds": None, "reason": "It needs a robot."}, Verdict.NOT_TESTED),
        ({"holds": np.float64(1.0) <= 2.0}, Verdict.REPRODUCED),
        ({"holds": np.float64("nan") <= 2.0}, Verdict.CONTRADICTED),
    ],
)
def test_a_verdict_follows_from_data(data: dict[str, object], verdict: Verdict) -> None:
    assert claim(**data).verdict is verdict


def test_a_verdict_cannot_be_written_down() -> None:
    with pytest.raises(TypeError, match="unexpected keyword argument 'verdict'"):
        claim(verdict=Verdict.REPRODUCED)
    with pytest.raises(AttributeError):
        claim().verdict = Verdict.REPRODUCED  # type: ignore[misc]


@pytest.mark.parametrize(
    ("data", "message"),
    [
        ({"rule": ""}, "claim 'It is fast.': state the rule by which it is judged"),
        ({"holds": None}, "claim 'It is fast.': 'not tested' needs a reason"),
        ({"holds": {}}, "claim 'It is fast.': `holds` names no reading"),
    ],
)
def test_a_verdict_that_nothing_supports_is_refused(data: dict[str, object], message: str) -> None:
    with pytest.raises(ValueError) as refused:  # noqa: PT011  # the message is compared in full
        claim(**data)
    assert str(refused.value) == message


def test_a_claim_tells_what_was_chosen_what_is_missing_and_why() -> None:
    assert claim().notes == []
    assert claim(reading="a band of 1 mm", reason="It is slow.").notes == ["Reading: a band of 1 mm", "It is slow."]
    mixed = claim(holds={"star": True, "chain": False, "greedy": False})
    assert mixed.notes == ["Holds: star.", "Does not hold: chain; greedy."]
    lacking = claim(missing=not_given({"band": Printed.NOT_STATED, "n": 20, "c": Printed.NOT_IN_COPY}))
    assert lacking.notes == ["Not given: band (not stated), c (not in our copy)."]


def test_a_failed_check_is_no_claim() -> None:
    section = Section("Times", [])
    made = Report.of("", [(section, [claim(holds=False), check(holds=True), check(holds=False)])])
    assert [one.verdict for one in made.claims] == [Verdict.CONTRADICTED]
    assert made.failed == [check(holds=False)]


def test_a_report_says_what_it_did_not_compute() -> None:
    carried = [
        CarriedOver(text="It was 3.", command="tune"),
        table(carried_over="tune"),
        CarriedOver(text="", command="x"),
    ]
    assert Report(summary="", sections=[Section("Times", carried)]).carried_over == ["tune", "x"]
    assert report().carried_over == []


def test_a_report_refuses_what_does_not_hang_together() -> None:
    with pytest.raises(ValueError, match=r"^'It is fast.': there is no section 'Times'$"):
        Report(summary="", sections=[], claims=[claim()])
    with pytest.raises(ValueError, match=r"^'It is ours.': there is no section 'Times'$"):
        Report(summary="", sections=[], checks=[check()])
    with pytest.raises(ValueError, match=r"^two tables or figures are named 'table_2'$"):
        Report(summary="", sections=[Section("Times", [table(), table()])])


def test_a_report_and_its_files(tmp_path: Path, registered: list[Context]) -> None:
    experiments.reproduce("first", tmp_path / "out", short=True)
    out = tmp_path / "out"
    found = {file.relative_to(out).as_posix() for file in out.rglob("*") if file.is_file()}
    assert found == {
        *("report.html", "report.json", "claims.csv", "checks.csv"),
        *("tables/table_2.csv", "figures/figure_1.png"),
    }
    page = (out / "report.html").read_text(encoding="utf-8")
    assert "Text with &lt;marks&gt;." in page
    assert "All of <em>it</em>." in page
    assert "a quick pass" in page
    assert 'src="data:image/png;base64,' in page
    assert 'src="h' not in page  # nothing is fetched
    told = json.loads((out / "report.json").read_text(encoding="utf-8"))
    assert (told["name"], told["short"], told["success"]) == ("first", True, True)
    assert set(told["files"]) == found
    assert told["claims"][0]["verdict"] == "reproduced"
    assert told["checks"][0]["holds"] is True
    assert all(verdict.value in page and verdict.meaning in page for verdict in Verdict)
    assert "everything on this page was computed in that run" in page
    (row,) = csv.DictReader((out / "claims.csv").read_text(encoding="utf-8").splitlines())
    assert (row["rule"], row["verdict"]) == ("At most 2 s.", "reproduced")
    assert [context.short for context in registered] == [True]


def test_a_figure_may_move(tmp_path: Path) -> None:
    with drawing(2.0, 2.0) as figure:
        (dot,) = figure.subplots().plot([0.0], [0.0], marker="o")
    frames = Frames(moving=dot, show=lambda i: dot.set_data([i], [0.0]), count=2, rate=10)
    address = _picture(Figure(name="moving", title="A dot", drawing=figure, frames=frames), tmp_path, 50)
    assert address.startswith("data:image/gif;base64,")
    with Image.open(tmp_path / "moving.gif") as gif:
        assert (gif.format, gif.n_frames, gif.info["duration"], gif.info["loop"]) == ("GIF", 2, 100, 0)  # type: ignore[attr-defined]
        first, second = (np.asarray(frame.convert("RGB")) for frame in ImageSequence.Iterator(gif))
    changed = np.argwhere((first != second).any(axis=2))
    assert len(changed) > 0
    assert np.ptp(changed[:, 0]) < 12  # pixels: the dot, here and there, and nothing else


def test_logarithmic_axes_are_labelled_in_plain_text() -> None:
    ranges = {"wide": (2e-7, 3.0), "between": (20.0, 3000.0), "narrow": (4.0, 150.0), "by hand": (1.0, 1e6)}
    with drawing(3.0) as figure:
        panels = dict(zip(ranges, figure.subplots(1, len(ranges)), strict=True))
        for name, axes in panels.items():
            axes.set(yscale="log", ylim=ranges[name])
        panels["by hand"].yaxis.set_major_formatter("{x:g}")
    figure.draw_without_rendering()

    def labels(name: str) -> list[str]:
        low, high = ranges[name]
        ticks = panels[name].yaxis.get_major_ticks()
        return [tick.label1.get_text() for tick in ticks if low <= tick.get_loc() <= high]

    assert labels("wide")[-1] == "10⁰"
    assert labels("wide")[0] in ("10⁻⁶", "10⁻⁵")  # as there is room
    assert labels("between") == ["10²", "10³"]
    assert labels("narrow") == ["5", "10", "20", "50", "100"]
    assert "10000" in labels("by hand")
    marked = {name: len(axes.yaxis.get_minorticklocs()) > 0 for name, axes in panels.items()}
    assert marked == {"wide": False, "between": True, "narrow": False, "by hand": True}


def test_all_reports_have_a_page_over_them(tmp_path: Path, registered: list[Context]) -> None:
    done = experiments.reproduce("all", tmp_path)
    assert [made.name for _, made in done] == ["first", "second"]
    page = (tmp_path / "index.html").read_text(encoding="utf-8")
    assert 'href="second/report.html#times"' in page
    assert all(verdict.value in page and verdict.meaning in page for verdict in Verdict)
    assert (tmp_path / "second" / "figures" / "figure_1.png").is_file()
    assert len(registered) == 2


def test_a_new_report_takes_the_place_of_the_old_one(tmp_path: Path, registered: list[Context]) -> None:
    experiments.reproduce("all", tmp_path)
    experiments.reproduce("first", tmp_path)
    assert sorted(entry.name for entry in tmp_path.iterdir()) == [
        "checks.csv",
        "claims.csv",
        "figures",
        "report.html",
        "report.json",
        "tables",
    ]
    assert len(registered) == 3  # run again, not taken from the earlier report


def test_files_of_others_are_not_touched(tmp_path: Path, registered: list[Context]) -> None:
    (tmp_path / "notes.txt").touch()
    with pytest.raises(bik.InvalidInputError) as refused:
        experiments.reproduce("first", tmp_path)
    assert str(refused.value) == (
        f"out: folder '{tmp_path}' holds 'notes.txt', which no earlier report put there; "
        "name an empty folder or a new one"
    )
    assert not registered


def interrupt(what: str, _done: int, _total: int) -> None:
    if "writing" in what:
        raise KeyboardInterrupt


@pytest.mark.usefixtures("registered")
def test_ctrl_c_leaves_the_earlier_report_or_none(tmp_path: Path) -> None:
    old, new = tmp_path / "old", tmp_path / "new" / "one"
    experiments.reproduce("first", old)
    before = (old / "report.html").read_bytes()
    for folder in (old, new):
        with pytest.raises(KeyboardInterrupt):
            experiments.reproduce("all", folder, progress=interrupt)
    assert (old / "report.html").read_bytes() == before
    assert [entry.name for entry in tmp_path.iterdir()] == ["old"]


@pytest.mark.usefixtures("registered")
def test_progress_is_told(tmp_path: Path) -> None:
    told: list[tuple[str, int, int]] = []
    experiments.reproduce("first", tmp_path, progress=lambda *what: told.append(what))
    assert told[:3] == [("counting", 0, 2), ("counting", 1, 2), ("counting", 2, 2)]


def test_an_unknown_experiment_lists_those_there_are() -> None:
    with pytest.raises(bik.UnknownNameError) as refused:
        experiments.experiment("cheng2021")
    known = ", ".join(experiments.names())
    assert str(refused.value) == f"no experiment is named 'cheng2021'; known experiments: {known}, or all"


def test_what_the_extra_brings_is_asked_for_before_any_work(
    tmp_path: Path, registered: list[Context], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("beetle_ik.report.needs.find_spec", lambda name: None if name == "jinja2" else object())
    with pytest.raises(bik.BeetleIkError) as refused:
        experiments.reproduce("first", tmp_path)
    assert str(refused.value) == "reports need jinja2, which is not installed: pip install 'beetle-ik[report]'"
    assert not registered


def test_all_asks_for_every_extra_at_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    lacking = ("matplotlib", "skimage")
    monkeypatch.setattr("beetle_ik.report.needs.find_spec", lambda name: None if name in lacking else object())
    with pytest.raises(bik.BeetleIkError) as refused:
        experiments.reproduce("all", tmp_path / "out")
    assert str(refused.value) == (
        "reports need matplotlib and scikit-image, which are not installed: pip install 'beetle-ik[report,vision]'"
    )
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("name", ["cheng2020", "khan2022"])
def test_experiments_on_simulated_arms_ask_for_mujoco(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("beetle_ik.report.needs.find_spec", lambda library: None if library == "mujoco" else object())
    with pytest.raises(bik.BeetleIkError) as refused:
        experiments.reproduce(name, tmp_path / "out", short=True)
    assert str(refused.value) == "reports need mujoco, which is not installed: pip install 'beetle-ik[sim]'"


@pytest.mark.parametrize("name", experiments.names())
def test_every_experiment_is_registered_under_its_name(name: str) -> None:
    assert experiments.experiment(name).name == name
