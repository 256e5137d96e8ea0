"""Claims of a paper with their verdicts, and checks of the library itself.

A verdict is never written down: it follows from data by a rule that the report prints beside it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from enum import Enum, StrEnum
from typing import TypeAlias


class Verdict(StrEnum):
    """Outcome of a paper's claim."""

    REPRODUCED = "reproduced"
    WITH_READING = "reproduced with a stated reading"
    CONTRADICTED = "contradicted"
    NOT_IDENTIFIABLE = "not identifiable"
    NOT_TESTED = "not tested"

    @property
    def meaning(self) -> str:
        """Explanation of the verdict, in one line."""
        return _MEANINGS[self]


_MEANINGS = {
    Verdict.REPRODUCED: "The rule is met, and nothing had to be chosen.",
    Verdict.WITH_READING: "The rule is met once a gap or ambiguity of the paper is filled as stated.",
    Verdict.CONTRADICTED: "The rule is not met under any reading of the text, and nothing else had to be chosen.",
    Verdict.NOT_IDENTIFIABLE: "The paper omits what would decide, its possible readings disagree, or the rule is not "
    "met with what we chose where the paper leaves a choice.",
    Verdict.NOT_TESTED: "Nothing was run that could decide; the report says why.",
}


class Printed(Enum):
    """Reason for a missing printed value."""

    NOT_IN_COPY = "not in our copy"  # the paper prints the value; the text that we have lost it
    NOT_STATED = "not stated"  # the paper does not give the value


# Labels of the readings, if they differ and if all agree.
_HOLDS = ("Holds", "Holds under each reading")
_FAILS = ("Does not hold", "Holds under no reading")

Readings: TypeAlias = Mapping[str, bool]
"""Whether a claim holds under each reading that the text leaves open."""


@dataclass(frozen=True, kw_only=True)
class Claim:
    """A statement of a paper beside the measured result. Made by `Claim.judged`."""

    statement: str
    """Statement of the paper, in our words or, in quotes, in its own."""
    source: str
    """Place of the statement in the paper, for example "Section IV-A, Figure 2"."""
    rule: str
    """The criterion, as a sentence."""
    measured: str
    """Result of the run, with units."""
    holds: bool | Readings | None
    """Whether the rule is met, for all readings alike or for each; None if nothing was run."""
    reading: str = ""
    """Our choice where the paper leaves one open. Another choice might do better: with a reading, nothing fails."""
    missing: tuple[str, ...] = ()
    """Quantities that the claim depends on and that the paper does not give."""
    reason: str = ""
    """Reason for the result, or for not running anything."""
    section: str | None = None
    """Title of the section that shows it."""

    @classmethod
    def judged(
        cls,
        statement: str,
        *,
        source: str,
        rule: str,
        measured: str,
        holds: bool | Readings | None,
        reading: str = "",
        missing: Sequence[str] = (),
        reason: str = "",
        section: str | None = None,
    ) -> Claim:
        """Makes a claim whose verdict follows from the data.

        - `missing` quantities (see `not_given`): not identifiable, whatever `holds` is.
        - `holds` is True: reproduced; with a `reading`: reproduced with a stated reading.
        - `holds` is False: contradicted; with a `reading`: not identifiable, since another choice might meet the rule.
        - `holds` maps the readings that the text leaves open to True or False. All True: reproduced with a stated
          reading; all False: as False above; mixed: not identifiable. The report lists which of them hold.
        - `holds` is None: not tested, for the `reason` given.

        Raises:
            ValueError: the statement has no rule, or was not tested for no reason, or `holds` has no readings.
        """
        return cls(
            statement=statement,
            source=source,
            rule=rule,
            measured=measured,
            holds={name: bool(met) for name, met in holds.items()} if isinstance(holds, Mapping) else holds,
            reading=reading,
            missing=tuple(missing),
            reason=reason,
            section=section,
        )

    def __post_init__(self) -> None:
        """Refuses a verdict without support."""
        if not self.rule:
            raise ValueError(f"claim '{self.statement}': state the rule by which it is judged")
        if self.holds is None and not self.missing and not self.reason:
            raise ValueError(f"claim '{self.statement}': '{Verdict.NOT_TESTED}' needs a reason")
        if isinstance(self.holds, Mapping) and not self.holds:
            raise ValueError(f"claim '{self.statement}': `holds` names no reading")

    @property
    def verdict(self) -> Verdict:
        """Verdict by the rules of `judged`."""
        if self.missing:
            return Verdict.NOT_IDENTIFIABLE
        if self.holds is None:
            return Verdict.NOT_TESTED
        met = list(self.holds.values()) if isinstance(self.holds, Mapping) else [self.holds]
        if not all(met):
            return Verdict.NOT_IDENTIFIABLE if any(met) or self.reading else Verdict.CONTRADICTED
        return Verdict.WITH_READING if self.reading or isinstance(self.holds, Mapping) else Verdict.REPRODUCED

    @property
    def notes(self) -> list[str]:
        """Lines below the measured values: readings, missing quantities, the reason."""
        notes = [f"Reading: {self.reading}"] if self.reading else []
        if isinstance(self.holds, Mapping):
            for words, met in ((_HOLDS, True), (_FAILS, False)):
                names = [name for name, holds in self.holds.items() if holds is met]
                notes += [f"{words[len(names) == len(self.holds)]}: {'; '.join(names)}."] if names else []
        notes += [f"Not given: {', '.join(self.missing)}."] if self.missing else []
        return notes + ([self.reason] if self.reason else [])


@dataclass(frozen=True, kw_only=True)
class Check:
    """A statement of the library about itself that a run can refute.

    A failed check fails the run; a contradicted claim of a paper is a finding and does not.
    """

    statement: str
    rule: str
    """The criterion, as a sentence."""
    measured: str
    """Result of the run, with units."""
    holds: bool
    section: str | None = None
    """Title of the section that shows it."""


def not_given(quantities: Mapping[str, object]) -> tuple[str, ...]:
    """Returns the names of the quantities whose value is `Printed`, for `missing` of `Claim.judged`.

    The names carry the reason: "link length (not stated)".
    """
    return tuple(f"{name} ({value.value})" for name, value in quantities.items() if isinstance(value, Printed))
