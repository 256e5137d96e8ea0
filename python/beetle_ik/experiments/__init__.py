"""Reproduction of papers: `beetle-ik reproduce NAME --out DIR`, or `reproduce(name, out)`.

How to write an experiment. Make one module here (or a small folder, whose `__init__` combines its parts), and add its
name to `registry.py`. The module contains settings with their sources, functions that run, functions that draw, and

    EXPERIMENT = Experiment(
        name="cheng2020",
        title="Beetle antennae search plans the motion of a redundant arm",
        paper="Y. Cheng et al., *Motion Planning ...*, IEEE Access 8, 2020",
        run=run,
    )

where `run` takes a `Context` and returns a `Report`:

    def run(context: Context) -> Report:
        seeds = context.seeds(context.pick(full=25, short=3))
        runs = [one_run(seed) for seed in context.each("cheng2020: Table 2", seeds)]      # moves the progress bar
        with drawing(height=3.0) as figure:           # inches; the style of all our figures
            axes = figure.subplots()
            axes.semilogy(runs[0].time, runs[0].position_error, label="BAS", **line(0))
            axes.set(xlabel="time [s]", ylabel="position error [m]")
            axes.legend()
        time = Table(
            name="table_2",                           # also the name of its CSV file
            title="Table 2: time to the same precision, mean and standard deviation over 25 runs",
            columns=[Column(name="method"), Column(name="time", unit="s", compared=True)],
            rows=[["BAS", (Spread(0.53, 0.04), Spread.of([run.elapsed for run in runs]))]],
        )
        error = max(run.position_error[-1] for run in runs)
        return Report(
            summary="The findings, for readers who read nothing else.",
            sections=[
                Section(
                    "Equal precision",
                    [
                        "Text: paragraphs, `code`, *emphasis*, lists.",
                        Figure(name="figure_8", title="Figure 8", drawing=figure, caption="What to look at."),
                        time,
                    ],
                )
            ],
            claims=[
                Claim.judged(
                    "The error is around 1e-5 m.",
                    source="Section IV-A",
                    rule="The largest final error is at most 2e-5 m.",      # the page prints it beside the verdict
                    measured=f"{number(error)} m",
                    holds=error <= 2e-5,
                    reading="The error band is 1.7e-5 m; the paper names none.",    # leave out where nothing was chosen
                    section="Equal precision",
                )
            ],
        )

Rules for an experiment:

- An experiment of several parts is a folder with one module per part, whose function returns a `Part`: a section, and
  the claims and checks that it decides. `Report.of(summary, parts)` puts them together.
- A compared cell is `(printed, measured)`. A value that the paper prints but our copy lacks is
  `Printed.NOT_IN_COPY`; a value that it does not give is `Printed.NOT_STATED`. Nothing is invented.
- Every claim of the paper has a row, including unwelcome ones. `Claim.judged` derives the verdict from data by the
  rule printed beside it; verdicts are never written by hand. A claim that does not hold is "contradicted": a finding.
- A statement about the library is a `Check`. One that fails makes the command exit with 1; one that cannot fail is
  no check.
- A table or text with numbers of an earlier run says so: `Table(carried_over=...)`, `CarriedOver`.
- All randomness comes from `context.seeds` and the `seed=` of calls; no result is kept from one run to the next.
- matplotlib is imported by `drawing` alone. Units in labels, a legend where there is more than one line, colours from
  `beetle_ik.report` (they are safe for colour-blind readers), captions that say what to see.
- The short mode takes seconds, runs in the tests, and decides the same claims with fewer runs.
"""

from .experiment import Context, Experiment
from .registry import experiment, names
from .reproduction import ALL, reproduce

__all__ = ["ALL", "Context", "Experiment", "experiment", "names", "reproduce"]
