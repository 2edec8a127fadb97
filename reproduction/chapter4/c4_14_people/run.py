"""C4.14: recorded sessions of people, and of scripted players. Thesis: §4.8.5.2, Figures 4.18 to 4.20.

`python -m examples.pages.play.serve --out FILE` records people, `--set people=FILE` reads them (see `records`).
Fewer than three people, the thesis's number, are not measured. Read in this order: `study_plan`, `ball_round`,
`training_models`, `study_session`, `scripted_player`, `records`, `losses`.
"""

from collections.abc import Mapping, Sequence
from itertools import combinations
from pathlib import Path

import numpy as np

from lifelore.core.errors import InputError, NotFoundError
from lifelore.core.metrics import Estimate, mean_estimate
from lifelore.domains.ball_game.ball_game import SIZES
from reproduction.chapter4.c4_14_people.ball_round import column
from reproduction.chapter4.c4_14_people.losses import (
    losses_by_diversity,
    losses_by_speed,
    mean_losses,
    ratio_by_move,
)
from reproduction.chapter4.c4_14_people.records import recorded_sessions
from reproduction.chapter4.c4_14_people.scripted_player import play_session, scripted_others
from reproduction.chapter4.c4_14_people.study_plan import (
    BEAT,
    METHODS,
    PERSON,
    PLAYERS,
    SCRIPTED,
    STATIC,
    TEST,
    TRAINING,
    StudySettings,
)
from reproduction.chapter4.c4_14_people.study_session import StudySession
from reproduction.engine.estimates import exact_value

COLUMNS = ("phase", "size", "speed", "method", "loss")
"""Columns of a round that the measures read."""
LEAST = 3
"""People with whom the thesis measures."""


def cells(settings: Mapping) -> list[dict]:
    """One cell for each scripted session, and one for the file of people, if the settings name it."""
    found: list[dict] = [{"player": SCRIPTED, "session": k} for k in range(settings["sessions"])]
    if settings["people"]:
        found.append({"player": PERSON, "changed": Path(settings["people"]).stat().st_mtime_ns})
    return found


def check(settings: Mapping) -> None:
    """Refuse settings of no session, and people in no file."""
    study_settings(settings, SCRIPTED)
    if len(settings["sizes"]) < 2 or len(settings["speeds"]) < 2:
        raise InputError(
            f"sizes and speeds must be at least two each, got {settings['sizes']} and {settings['speeds']}"
        )
    if settings["people"] and not Path(settings["people"]).is_file():
        raise NotFoundError(
            f"people '{settings['people']}' is not a file; name one in which people's rounds are recorded"
        )


def study_settings(settings: Mapping, player: str) -> StudySettings:
    """The settings of a session."""
    sizes, speeds = tuple(settings["sizes"]), tuple(settings["speeds"])
    rounds = (settings[name] for name in ("practice", "training", "test", "frames_per_move", "layout"))
    return StudySettings(player, sizes, speeds, *rounds)


def run_cell(settings: Mapping, cell: Mapping, seed: int) -> dict:
    """The rounds of the sessions of a cell, and the types that BEAT named in the first round of each block."""
    if cell["player"] == PERSON:
        return {"player": PERSON, "sessions": _recorded(settings)}
    number, own = cell["session"], study_settings(settings, SCRIPTED)
    others, first = scripted_others(settings["layout"]), number % len(METHODS)
    session = play_session(StudySession(f"C4.14 {number}", own, others, first=first, seed=seed))
    return {"player": SCRIPTED, "sessions": [_summary(session.done)]}


def _recorded(settings: Mapping) -> list[dict]:
    """The finished sessions of people at the pace, with the sizes and the speeds of the settings."""
    own = _design(study_settings(settings, PERSON))
    sessions = recorded_sessions(settings["people"])
    return [_summary(one.rows) for one in sessions if one.finished and _design(one.settings) == own]


def _design(settings: StudySettings) -> tuple:
    return settings.player, settings.pace, sorted(settings.sizes), sorted(settings.speeds)


def _summary(done: Sequence[dict]) -> dict:
    firsts: dict[int, dict] = {}
    for row in done:
        if row["method"] == BEAT:
            firsts.setdefault(row["block"], row)
    return {
        "rounds": [[row[name] for name in COLUMNS] for row in done],
        "named": [
            {
                "size": row["size"],
                "last": SIZES[int(column(row, "named")[-1])],
                "ratio": ratio_by_move(row).round(3).tolist(),
            }
            for row in firsts.values()
        ],
    }


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """Numbers of people, none of fewer than three; and how many scripted sessions stand in for them."""
    people, scripted = (_sessions(results, player) for player in PLAYERS)
    numbers = _numbers(settings, people) if len(people) >= LEAST else {}
    found = {f"people_{name}": number for name, number in numbers.items()}
    return found | {"scripted_sessions": exact_value(len(scripted), len(scripted))}


def _sessions(results: Sequence[Mapping], player: str) -> list[dict]:
    """Each session of a kind of player: its rounds as rows, and the types that BEAT named."""
    sessions = [session for result in results if result["player"] == player for session in result["sessions"]]
    rounds = [[dict(zip(COLUMNS, row, strict=True)) for row in session["rounds"]] for session in sessions]
    return [{"rounds": rows, "named": one["named"]} for rows, one in zip(rounds, sessions, strict=True)]


def _numbers(settings: Mapping, sessions: Sequence[Mapping]) -> dict[str, Estimate]:
    sizes, speeds = sorted(settings["sizes"]), sorted(settings["speeds"])
    half = len(speeds) // 2
    slow, fast = speeds[:half], speeds[-half:]
    gains = [
        [row["static"] - row["beat"] for row in losses_by_diversity(*_phases(one["rounds"]))] for one in sessions
    ]
    ends = [(one["size"], one["last"]) for session in sessions for one in session["named"]]
    mixed = {pair: sum(set(end) == set(pair) for end in ends) for pair in combinations(sizes, 2)}
    more = sum(n > mixed[sizes[0], sizes[1]] for n in mixed.values())
    return {
        "small_gains_by_fast": mean_estimate([_gain(one["rounds"], sizes[0], slow, fast) for one in sessions]),
        "large_gains_by_slow": mean_estimate([_gain(one["rounds"], sizes[-1], fast, slow) for one in sessions]),
        "least_gain_of_diversities": mean_estimate(min(zip(*gains, strict=True), key=sum)),
        "beat_less_static": mean_estimate([_beat_less_static(one["rounds"]) for one in sessions]),
        "pairs_confused_more_often": exact_value(more, len(mixed)),
    }


def _gain(rounds: Sequence[Mapping], size: int, some: Sequence[int], others: Sequence[int]) -> float:
    """Mean loss of a size in training at some speeds, less that at others."""
    table = mean_losses(_phases(rounds)[0])
    mean, other = (np.mean([table[size, speed] for speed in speeds]) for speeds in (some, others))
    return float(mean - other)


def _beat_less_static(rounds: Sequence[Mapping]) -> float:
    """Mean loss in the blinded blocks with BEAT, less that at the best static speed of other players."""
    beat, static = (np.mean([r["loss"] for r in rounds if r["method"] == method]) for method in (BEAT, STATIC))
    return float(beat - static)


def _phases(rounds: Sequence[Mapping]) -> tuple[list, list]:
    return [r for r in rounds if r["phase"] == TRAINING], [r for r in rounds if r["phase"] == TEST]


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """For each kind of player that played, people first: the numbers of Figures 4.18, 4.19 and 4.20."""
    return [_row(settings, player, own) for player in PLAYERS if (own := _sessions(results, player))]


def _row(settings: Mapping, player: str, sessions: Sequence[Mapping]) -> dict:
    phases = _phases([row for one in sessions for row in one["rounds"]])
    named = [one for session in sessions for one in session["named"]]
    ratios = {size: [one["ratio"] for one in named if one["size"] == size] for size in settings["sizes"]}
    return {
        "player": player,
        "sessions": len(sessions),
        "losses": losses_by_speed(phases[0]),
        "diversity": losses_by_diversity(*phases),
        "named": [
            {"size": size, "ratio": np.mean(own, axis=0).round(3).tolist()} for size, own in ratios.items() if own
        ],
    }
