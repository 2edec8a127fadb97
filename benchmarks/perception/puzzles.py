"""`bench puzzles`: block puzzles solved from a depth camera's cloud by a planner and carried out in physics.

Thesis: §2.5, spatial puzzles. A puzzle counts as solved where forces and gaps say after the last step that every
relation of the goal holds.
"""

from collections.abc import Sequence
from pathlib import Path

from benchmarks.perception.solved_puzzle import (
    NO_BLOCK,
    NO_PLAN,
    NOT_FOUND,
    NOT_REACHED,
    SOLVED,
    Ending,
    solved_puzzle,
)
from benchmarks.rounds import at_least, estimated_row, row
from lifelore.bridges.planner import Step
from lifelore.core.metrics import Estimate, mean_estimate
from lifelore.core.protocols import Progress
from lifelore.domains.tabletop.pick_and_place import COVERED, FELL, NO_ROOM
from reproduction.engine.estimates import exact_share

PUZZLES = 20
"""Puzzles a round, each once with labels and once without."""
WAYS = {"labels given": True, "without labels": False}
GOALS = {"labels given": 0.95, "without labels": 0.8}
REASONS = (NOT_FOUND, NO_PLAN, NO_BLOCK, COVERED, FELL, NO_ROOM, NOT_REACHED)
DRAWN_STEPS = 6
"""Steps of the puzzle that is drawn: a picture before, and one after each block that is put down."""
OUT = Path("benchmarks/results")


def bench_puzzles(repeats: int, progress: Progress, out: Path = OUT) -> dict:
    """Rows and goals; see `benchmarks.bench`. Rows also have ``ci95`` and ``n``.

    With two rounds or more, the figure ``bench_puzzles.png`` shows the first puzzle that was solved without labels
    in `DRAWN_STEPS` steps.
    """
    n = PUZZLES * repeats
    endings: dict[str, list[Ending]] = {way: [] for way in WAYS}
    for number in range(n):
        for way, labels in WAYS.items():
            endings[way].append(solved_puzzle(number, labels))
        progress(number + 1, n, f"puzzle {number + 1}")
    if repeats > 1:
        _draw(endings["without labels"], out)
    rows = [line for way, found in endings.items() for line in _rows(way, found)]
    shares = {way: _solved(found).value for way, found in endings.items()}
    return {
        "rows": rows,
        "goals": [at_least(f"{way}: solved", GOALS[way], share) for way, share in shares.items()],
    }


def _solved(found: Sequence[Ending], looks: int | None = None) -> Estimate:
    """Share of puzzles that are solved, with at most so many looks."""
    return exact_share(end.outcome == SOLVED and (looks is None or end.looks <= looks) for end in found)


def _rows(way: str, found: Sequence[Ending]) -> list[dict]:
    planned = [end for end in found if end.steps or end.outcome == SOLVED]
    reasons = [end.outcome for end in found]
    lines = [
        estimated_row(f"{way}: solved", _solved(found), "share"),
        estimated_row(f"{way}: solved at the first look", _solved(found, 1), "share"),
        row(f"{way}: puzzles with a plan", len(planned), "puzzles"),
    ]
    steps = [float(len(end.steps)) for end in found if end.outcome == SOLVED]
    if steps:
        lines.append(estimated_row(f"{way}: steps of a solved puzzle", mean_estimate(steps), "steps"))
    return lines + [row(f"{way}: not solved, {reason}", reasons.count(reason), "puzzles") for reason in REASONS]


def _draw(found: Sequence[Ending], out: Path) -> None:
    from lifelore.figures.scenes.cloud_sequence import draw_cloud_sequence
    from lifelore.figures.style import save_figure

    fit = (n for n, end in enumerate(found) if end.outcome == SOLVED and len(end.steps) == DRAWN_STEPS)
    number = next(fit, None)
    if number is None:
        return
    shown = solved_puzzle(number, labels=True, pictures=True)
    out.mkdir(parents=True, exist_ok=True)
    captions = ["before", *map(_caption, shown.steps[1::2])]
    save_figure(draw_cloud_sequence(shown.clouds, captions), out / "bench_puzzles.png")


def _caption(step: Step) -> str:
    """A step that puts an object down, in words."""
    name, *others = (argument.removeprefix("o") for argument in step.arguments)
    where = {"put-on": "on", "put-beside": "beside", "put-on-table": "on the table"}[step.action]
    return " ".join((name, where, *others))
