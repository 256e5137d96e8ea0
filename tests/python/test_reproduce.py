"""`beetle-ik reproduce`: exit codes, output, and the papers themselves in their short mode."""

import csv
import json
from collections.abc import Callable, Iterator
from functools import cache
from pathlib import Path

import pytest
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure
from typer.testing import CliRunner, Result

from beetle_ik import experiments
from beetle_ik.cli.app import app
from beetle_ik.experiments import Context, Experiment
from beetle_ik.report import Check, Claim, Report, Section, Verdict

PAPERS = Path(__file__).parents[2] / "docs" / "papers"


def run(*arguments: str) -> Result:
    return CliRunner().invoke(app, ["reproduce", *arguments])


@pytest.fixture
def registered(monkeypatch: pytest.MonkeyPatch) -> None:
    """An experiment "paper" whose claim holds for seed 0 only, and whose check does for seeds 0 and 1."""

    def report(context: Context) -> Report:
        claim = Claim.judged(
            "It holds.", source="Table 1", rule="At most 2 m.", measured="1.5 m", holds=context.seed == 0
        )
        check = Check(
            statement="No limit is broken.", rule="Excess 0.", measured="0.1 rad/s", holds=context.seed in (0, 1)
        )
        return Report(summary="It was run.", sections=[Section("Runs", ["One."])], claims=[claim], checks=[check])

    paper = Experiment(name="paper", title="A paper", paper="A. Author, 2020", run=report)
    monkeypatch.setattr("beetle_ik.experiments.reproduction.experiment", lambda _: paper)
    monkeypatch.setattr("beetle_ik.experiments.reproduction.names", lambda: ["paper"])


@pytest.mark.usefixtures("registered")
def test_a_report_is_written_and_named(tmp_path: Path) -> None:
    result = run("paper", "--out", str(tmp_path / "out"))
    assert (result.exit_code, result.stderr) == (0, "")
    assert f"1 report: {tmp_path / 'out' / 'report.html'}" in result.stdout
    assert (tmp_path / "out" / "report.html").is_file()


@pytest.mark.usefixtures("registered")
def test_a_contradicted_claim_is_a_finding_and_no_failure(tmp_path: Path) -> None:
    result = run("paper", "--seed", "1", "--out", str(tmp_path))
    assert result.exit_code == 0
    assert json.loads((tmp_path / "report.json").read_text(encoding="utf-8"))["claims"][0]["verdict"] == "contradicted"


@pytest.mark.usefixtures("registered")
def test_a_failed_check_exits_with_1(tmp_path: Path) -> None:
    result = run("paper", "--seed", "2", "--out", str(tmp_path))
    assert result.exit_code == 1
    assert "paper: check failed: No limit is broken. Rule: Excess 0. Measured: 0.1 rad/s" in result.stdout
    assert (tmp_path / "report.html").is_file()


@pytest.mark.usefixtures("registered")
def test_json_for_machines(tmp_path: Path) -> None:
    one = json.loads(run("paper", "--short", "--json", "--out", str(tmp_path / "one")).stdout)
    assert (one["name"], one["short"], one["success"]) == ("paper", True, True)
    (each,) = json.loads(run("all", "--json", "--out", str(tmp_path / "all")).stdout)
    assert each["claims"] == one["claims"]
    assert (tmp_path / "all" / "index.html").is_file()


def test_wrong_input_is_told_exactly(tmp_path: Path) -> None:
    known = ", ".join(experiments.names())
    result = run("cheng2021", "--out", str(tmp_path))
    assert (result.exit_code, result.stdout) == (2, "")
    assert result.stderr == f"Error: no experiment is named 'cheng2021'; known experiments: {known}, or all\n"
    (tmp_path / "notes.txt").touch()
    assert run("cheng2020", "--out", str(tmp_path)).stderr == (
        f"Error: --out: folder '{tmp_path}' holds 'notes.txt', which no earlier report put there; "
        "name an empty folder or a new one\n"
    )


def coarse(drawing: Figure, _: int) -> FigureCanvasAgg:
    """A canvas of few pixels, on which nothing is laid out: that would take half the time of a short report."""
    drawing.set_layout_engine("none")
    drawing.set_dpi(20)
    return FigureCanvasAgg(drawing)


@pytest.fixture(scope="module")
def short_reports(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Callable[[str], Path]]:
    """The folder of a paper's short report, made when it is first asked for."""

    @cache
    def made(name: str) -> Path:
        folder = tmp_path_factory.mktemp("reports") / name
        result = run(name, "--short", "--out", str(folder))
        assert result.exit_code == 0, result.output
        return folder

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("beetle_ik.report.picture._canvas", coarse)
        yield made


@pytest.mark.parametrize("name", experiments.names())
def test_each_paper_in_short(name: str, short_reports: Callable[[str], Path]) -> None:
    assert json.loads((short_reports(name) / "report.json").read_text(encoding="utf-8"))["success"]


def read(file: Path) -> list[dict[str, str]]:
    with file.open(encoding="utf-8", newline="") as stream:
        return list(csv.DictReader(stream))


def test_tables_of_cheng2020_stand_beside_the_printed_ones(short_reports: Callable[[str], Path]) -> None:
    tables = short_reports("cheng2020") / "tables"
    errors, times = read(tables / "table_1.csv"), read(tables / "table_2.csv")
    assert [row["method"] for row in errors] == [row["method"] for row in times] == ["BAS", "GA", "PSO", "FA", "QPSO"]
    assert {row[f"along {axis} [m] printed"] for row in errors for axis in "xyz"} == {"not in our copy"}
    assert [row["time [s] printed mean"] for row in times] == ["0.53", "25.0", "5.0", "6.9", "6.1"]
    assert float(times[0]["evaluations a step mean"]) < 100
    assert float(errors[0]["mean error [m] measured mean"]) < 1e-9


def test_figures_of_cheng2020_are_all_there(short_reports: Callable[[str], Path]) -> None:
    figures = {file.stem for file in (short_reports("cheng2020") / "figures").iterdir()}
    assert {f"figure_{i}" for i in range(2, 9)} | {"figure_2_without_limit", "search_box", "accuracy"} <= figures


@pytest.mark.parametrize("table", ["learning_rates", "iterations_of_all"])
def test_the_kept_tables_are_those_of_this_version(table: str, short_reports: Callable[[str], Path]) -> None:
    """Tables of yuan2016 that a quick pass and a full run have alike; `make papers` writes all of them anew."""
    assert read(PAPERS / "tables" / "yuan2016" / f"{table}.csv") == read(
        short_reports("yuan2016") / "tables" / f"{table}.csv"
    )


@pytest.mark.parametrize("name", experiments.names())
def test_a_quick_pass_gives_no_other_verdict_than_a_full_run(name: str, short_reports: Callable[[str], Path]) -> None:
    """The claims of a full run are kept; `make papers` writes them anew."""
    full = {row["statement"]: row["verdict"] for row in read(PAPERS / "claims" / f"{name}.csv")}
    quick = {row["statement"]: row["verdict"] for row in read(short_reports(name) / "claims.csv")}
    assert quick.keys() == full.keys()
    assert {claim for claim, verdict in quick.items() if verdict not in (full[claim], Verdict.NOT_TESTED)} == set()
