"""Our relations less those of the best peer on the same pairs, with intervals, for `bench relations`."""

from collections.abc import Mapping, Sequence

from benchmarks.perception.relation_learners import LOGIC, OURS, SHIPPED
from benchmarks.rounds import estimated_row
from reproduction.chapter2.scoring.relation_scoring import JudgedPair, difference

PEER = "orientation histogram"
"""The peer that is right most often."""
MEASURES = {"exact": lambda pair: pair.exact, "on": lambda pair: pair.on_right}


def difference_rows(where: str, answers: Mapping[str, Sequence[JudgedPair]]) -> list[dict]:
    """A row for each of our methods and measures: its share less the peer's; scenes resampled together.

    `answers` are those of each method to the same labelled pairs in the same order.
    """
    rows = []
    for who in (OURS + LOGIC, SHIPPED + LOGIC):
        if not answers.get(who) or not answers.get(PEER):
            continue
        for name, right in MEASURES.items():
            found = difference(answers[who], answers[PEER], right)
            rows.append(estimated_row(f"{who}, {where}, {name} less that of the {PEER}", found, "share"))
    return rows
