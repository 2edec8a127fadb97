"""Measures and rows of claim C4.14 from sessions of people and of scripted players, apart.

Numbers of people are unmeasured where fewer than three people have finished a session.
"""

from collections.abc import Mapping, Sequence
from itertools import combinations

import numpy as np

from lifelore.agent.play_study.study_plan import BEAT, STATIC, TEST, TRAINING
from lifelore.agent.play_study.study_results import losses_by_diversity, losses_by_speed
from lifelore.agent.play_study.study_settings import PLAYERS
from lifelore.core.metrics import Estimate, mean_estimate
from reproduction.chapter4.c4_14_people.run import COLUMNS
from reproduction.engine.estimates import UNMEASURED, exact_value, is_above, share_of

LEAST = 3
"""People with whom the thesis measures; fewer give no interval."""
WORDS = {"person": "people", "scripted": "scripted"}
NAMES = (
    "small_gains_by_fast", "large_gains_by_slow", "diversities_won", "beat_less_static",
    "pairs_confused_more_often",
)  # fmt: skip


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """The numbers of `NAMES` for people and for scripted players."""
    return {
        f"{WORDS[player]}_{name}": number
        for player in PLAYERS
        for name, number in _numbers(settings, _sessions(results, player)).items()
    }


def _sessions(results: Sequence[Mapping], player: str) -> list[dict]:
    """Each session of a kind of player: its rounds as rows, and what BEAT named."""
    sessions = [session for result in results if result["player"] == player for session in result["sessions"]]
    rounds = [[dict(zip(COLUMNS, row, strict=True)) for row in session["rounds"]] for session in sessions]
    return [{"rounds": rows, "named": one["named"]} for rows, one in zip(rounds, sessions, strict=True)]


def _numbers(settings: Mapping, sessions: Sequence[Mapping]) -> dict[str, Estimate]:
    if len(sessions) < LEAST:
        return dict.fromkeys(NAMES, UNMEASURED)
    sizes, speeds = sorted(settings["sizes"]), sorted(settings["speeds"])
    half = len(speeds) // 2
    slow, fast = speeds[:half], speeds[-half:]
    return {
        "small_gains_by_fast": mean_estimate([_gain(one["rounds"], sizes[0], slow, fast) for one in sessions]),
        "large_gains_by_slow": mean_estimate([_gain(one["rounds"], sizes[-1], fast, slow) for one in sessions]),
        "diversities_won": _diversities_won(sessions),
        "beat_less_static": mean_estimate([_beat_less_static(one["rounds"]) for one in sessions]),
        "pairs_confused_more_often": _pairs_confused_more_often(sizes, sessions),
    }


def _gain(rounds: Sequence[Mapping], size: int, some: Sequence[int], others: Sequence[int]) -> float:
    """Mean loss of a size in training at some speeds, less that at others."""

    def mean(speeds: Sequence[int]) -> float:
        own = [r["loss"] for r in rounds if (r["phase"], r["size"]) == (TRAINING, size) and r["speed"] in speeds]
        return float(np.mean(own))

    return mean(some) - mean(others)


def _beat_less_static(rounds: Sequence[Mapping]) -> float:
    beat, static = (np.mean([r["loss"] for r in rounds if r["method"] == method]) for method in (BEAT, STATIC))
    return float(beat - static)


def _diversities_won(sessions: Sequence[Mapping]) -> Estimate:
    """Share of diversities at which each player's static loss less the loss with BEAT is above 0 on average."""
    gaps = [
        [row["static"] - row["beat"] for row in losses_by_diversity(*_phases(one["rounds"]))] for one in sessions
    ]
    return share_of([is_above(mean_estimate(list(gap)), 0.0) for gap in zip(*gaps, strict=True)])


def _phases(rounds: Sequence[Mapping]) -> tuple[list, list]:
    return [r for r in rounds if r["phase"] == TRAINING], [r for r in rounds if r["phase"] == TEST]


def _pairs_confused_more_often(sizes: Sequence[int], sessions: Sequence[Mapping]) -> Estimate:
    """Number of pairs of sizes that are taken for each other more often than the two smallest."""
    ends = [(one["size"], one["last"]) for session in sessions for one in session["named"]]
    mixed = {pair: sum(set(end) == set(pair) for end in ends) for pair in combinations(sizes, 2)}
    return exact_value(sum(n > mixed[sizes[0], sizes[1]] for n in mixed.values()), len(mixed))


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """For each kind of player that played: the numbers of Figures 4.18, 4.19 and 4.20."""
    found = []
    for player in PLAYERS:
        sessions = _sessions(results, player)
        if not sessions:
            continue
        rounds = [row for one in sessions for row in one["rounds"]]
        named = [one for session in sessions for one in session["named"]]
        found.append(
            {
                "player": player,
                "sessions": len(sessions),
                "losses": _rounded(losses_by_speed(_phases(rounds)[0])),
                "diversity": _rounded(losses_by_diversity(*_phases(rounds))),
                "named": [
                    {
                        "size": size,
                        "ratio": np.mean([one["ratio"] for one in named if one["size"] == size], 0)
                        .round(3)
                        .tolist(),
                    }
                    for size in settings["sizes"]
                ],
            }
        )
    return found


def _rounded(rows: Sequence[Mapping]) -> list[dict]:
    return [{key: round(v, 4) if isinstance(v, float) else v for key, v in row.items()} for row in rows]
