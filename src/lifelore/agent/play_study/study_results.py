"""Numbers of Figures 4.18-4.20 from recorded rounds, people and scripted players apart.

    Figure 4.18   loss by speed and size, in training
    Figure 4.19   loss of BEAT and of the best static speed by the number of types in the population
    Figure 4.20   most likely size / true size by move, in the first round of each BEAT block

In Figure 4.19 the best static speed of a population knows the population and is chosen on the training rounds by
which it is judged; both favour it. BEAT starts from all sizes. The blocks compare BEAT with the best static speed
of the other players, in rounds that the players could not tell apart. Thesis: §4.8.5.2.
"""

from collections import defaultdict
from collections.abc import Sequence
from itertools import combinations
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lifelore.agent.play_study.round_result import RoundResult
from lifelore.agent.play_study.study_plan import BEAT, STATIC, TEST, TRAINING
from lifelore.agent.play_study.study_records import ROUND, SESSION, stored_result
from lifelore.agent.play_study.study_settings import PERSON, StudySettings
from lifelore.core.metrics import mean_estimate
from lifelore.domains.ball_game.ball_game import SIZES, SPEEDS
from lifelore.memory import Memory

STEPS = 100
"""Moves of a round that Figure 4.20 shows; shorter rounds stay at their last value."""
Rows = Sequence[dict[str, Any]]


def study_results(memory: Memory) -> dict[str, Any]:
    """The results of all recorded sessions.

    Returns
    -------
    dict
        ``people_untested`` (no person has played a size with both methods) and ``groups``, one for each pace and
        kind of player: ``pace``, ``player``, ``sessions``, ``finished``, ``rounds``, ``sizes``, ``speeds``,
        ``losses`` (see `losses_by_speed`), ``diversity`` (see `losses_by_diversity`), ``named`` (see
        `named_sizes`) and ``blocks`` (see `block_differences`).
    """
    grouped: dict[tuple[str, str], dict[str, list[dict[str, Any]]]] = defaultdict(lambda: defaultdict(list))
    for key, _, about in memory.keys(ROUND):
        grouped[about["player"], about["pace"]][key.split("/")[0]].append({**about, "key": key})
    planned = {
        name: StudySettings.from_document(about["settings"]).rounds for name, _, about in memory.keys(SESSION)
    }
    groups = [_group(memory, *names, sessions, planned) for names, sessions in sorted(grouped.items())]
    tested = any(group["player"] == PERSON and group["blocks"]["pairs"] for group in groups)
    return {"people_untested": not tested, "groups": groups}


def _group(
    memory: Memory, player: str, pace: str, sessions: dict[str, list[dict[str, Any]]], planned: dict[str, int]
) -> dict[str, Any]:
    rows = [row for own in sessions.values() for row in own]
    training = [row for row in rows if row["phase"] == TRAINING]
    test = [row for row in rows if row["phase"] == TEST]
    firsts = [
        min((row for row in own if row["block"] == block), key=lambda row: row["number"])["key"]
        for own in sessions.values()
        for block in sorted({row["block"] for row in own if row["method"] == BEAT})
    ]
    sizes = [size for size in SIZES if any(row["size"] == size for row in rows)]
    losses = losses_by_speed(training)
    return {
        "pace": pace,
        "player": player,
        "sessions": len(sessions),
        "finished": sum(len(own) == planned.get(name) for name, own in sessions.items()),
        "rounds": len(rows),
        "sizes": sizes,
        "speeds": list(SPEEDS),
        "losses": losses,
        "diversity": losses_by_diversity(training, test),
        "named": named_sizes([stored_result(memory, key) for key in firsts]),
        "blocks": block_differences(sessions),
    }


def losses_by_speed(training: Rows) -> list[dict[str, Any]]:
    """Figure 4.18: for each size and speed ``loss``, half of its 95 % ``interval`` and ``rounds``."""
    found = []
    for size in SIZES:
        for speed in SPEEDS:
            losses = [row["loss"] for row in training if (row["size"], row["speed"]) == (size, speed)]
            if losses:
                half = 1.96 * float(np.std(losses, ddof=1)) / len(losses) ** 0.5 if len(losses) > 1 else None
                found.append(
                    {
                        "size": size,
                        "speed": speed,
                        "loss": float(np.mean(losses)),
                        "interval": half,
                        "rounds": len(losses),
                    }
                )
    return found


def losses_by_diversity(training: Rows, test: Rows) -> list[dict[str, Any]]:
    """Figure 4.19: mean loss of ``static`` and ``beat`` over all populations of ``types`` sizes.

    Only sizes that were played with BEAT and at every speed of the training take part.
    """
    speeds = sorted({row["speed"] for row in training})
    table = {
        size: [
            _mean([row["loss"] for row in training if (row["size"], row["speed"]) == (size, speed)])
            for speed in speeds
        ]
        for size in sorted({row["size"] for row in training})
    }
    beat = {
        size: _mean([row["loss"] for row in test if row["method"] == BEAT and row["size"] == size])
        for size in table
    }
    sizes = [size for size, losses in table.items() if np.isfinite([*losses, beat[size]]).all()]
    found = []
    for types in range(1, len(sizes) + 1):
        populations = list(combinations(sizes, types))
        static = [np.mean([table[size] for size in population], axis=0).min() for population in populations]
        own = [np.mean([beat[size] for size in population]) for population in populations]
        found.append(
            {
                "types": types,
                "static": float(np.mean(static)),
                "beat": float(np.mean(own)),
                "populations": len(populations),
            }
        )
    return found


def named_sizes(firsts: Sequence[RoundResult]) -> list[dict[str, Any]]:
    """Figure 4.20: for each ``size`` the mean ``ratio``, most likely / true size, by move, (`STEPS`,)."""
    found = []
    for size in SIZES:
        ratios = [ratio_by_move(result) for result in firsts if result.planned.size == size]
        if ratios:
            mean = np.mean(ratios, axis=0)
            found.append({"size": size, "ratio": np.round(mean, 4).tolist(), "rounds": len(ratios)})
    return found


def ratio_by_move(result: RoundResult) -> NDArray[np.float64]:
    """Most likely size / true size after each of the first `STEPS` moves of a BEAT round, (`STEPS`,)."""
    named = np.array(SIZES)[result.column("named")][:STEPS] / result.planned.size
    return np.concatenate([named, np.full(STEPS - len(named), named[-1])])


def block_differences(sessions: dict[str, list[dict[str, Any]]]) -> dict[str, Any]:
    """The blinded comparison: loss with BEAT minus loss at the static speed, of each player and size.

    Returns
    -------
    dict
        ``pairs`` (player, size), ``beat`` and ``static`` (mean losses), ``difference`` and its 95 % ``interval``
        (low, high), None with fewer than three pairs.
    """
    means = []
    for own in sessions.values():
        for size in SIZES:
            beat, static = (
                _mean([row["loss"] for row in own if row["method"] == method and row["size"] == size])
                for method in (BEAT, STATIC)
            )
            if np.isfinite([beat, static]).all():
                means.append((beat, static))
    if not means:
        return {"pairs": 0, "beat": None, "static": None, "difference": None, "interval": None}
    beat, static = np.array(means).T
    interval = mean_estimate(beat - static).ci95
    return {
        "pairs": len(means),
        "beat": float(beat.mean()),
        "static": float(static.mean()),
        "difference": float((beat - static).mean()),
        "interval": None if interval is None else list(interval),
    }


def _mean(losses: Sequence[float]) -> float:
    return float(np.mean(losses)) if losses else float("nan")
