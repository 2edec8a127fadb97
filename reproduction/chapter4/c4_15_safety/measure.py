"""C4.15: BEAT's losses as ratios to the static speed's and EXP-3's, its regret, and the steps to name the type.

The default game comes first. In every other game and normalisation of the loss, the same conditions are asked.
"""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lifelore.core.metrics import Estimate, mean_estimate, ratio_estimate
from lifelore.domains.ball_game.ball_game import SIZES
from reproduction.chapter4.ball_game.games import Setting
from reproduction.chapter4.ball_game.methods import BEATS, ORACLE, PRINTED_EXP3, STATIC, TUNED_EXP3
from reproduction.chapter4.c4_15_safety.run import LAGGING
from reproduction.chapter4.reuse.many_tasks import plain
from reproduction.engine.estimates import exact_share, share_of
from reproduction.engine.predicate import Condition
from reproduction.engine.registry import claim_of
from reproduction.engine.results_table import computed_once
from reproduction.engine.second_reading import HEADLINE, YES, ReadCondition

KEYS = {"BEAT": "", "BEAT, ε as printed": "_printed"}
GRID = "grid_"
"""How names of measures begin that are shares of the games."""
STEPS = [1, 2, 3, 5, 8, 12, 20, 30, 45, 65, 100, 150, 220, 330, 500]


def joined(results: Sequence[Mapping], key: str) -> NDArray:
    """A number of every player, of all lots, (n_types, players)."""
    return np.concatenate([np.array(result[key]) for result in results], axis=1)


def losses_of(results: Sequence[Mapping], method: str) -> NDArray[np.float64]:
    """Losses (n_types, players, episodes) of all lots."""
    return joined([result["losses"] for result in results], method)


def worst_ratio(mine: NDArray[np.float64], theirs: NDArray[np.float64]) -> tuple[Estimate, list[int]]:
    """The largest ratio of mean losses over types and episodes, and which type and episode it is."""
    ratios = mine.mean(axis=1) / theirs.mean(axis=1)
    type_, episode = np.unravel_index(ratios.argmax(), ratios.shape)
    return ratio_estimate(mine[type_, :, episode], theirs[type_, :, episode]), [int(type_), int(episode)]


def by_game(results: Sequence[Mapping]) -> dict[tuple, list[Mapping]]:
    """The lots of each game under each normalisation, in order."""
    games: dict[tuple, list[Mapping]] = {}
    for result in results:
        games.setdefault(tuple(result["game"]), []).append(result)
    return games


def asked_of_every_game() -> list[Condition]:
    """The conditions of ``claim.toml`` on a single game; the others ask for a share of the games."""
    return [c for c in claim_of("C4.15").predicate.conditions if not c.measure.startswith(GRID)]


def answers(found: Mapping[str, Estimate]) -> dict[str, bool]:
    """Whether each condition on a single game is met, by its measure; False where its number is missing."""
    numbers = {name: {"value": one.value, "ci95": one.ci95} for name, one in found.items()}
    return {c.measure: bool(c.met(numbers)) for c in asked_of_every_game()}


def sentence() -> list[ReadCondition]:
    """The headlines of the second reading: what the thesis says of BEAT with ε as printed, of a single game."""
    second = claim_of("C4.15").second
    return [one for one in second.conditions if one.role == HEADLINE] if second else []


def sentence_holds(found: Mapping[str, Estimate]) -> bool:
    """Whether every headline holds by its whole interval."""
    numbers = {name: {"value": one.value, "ci95": one.ci95} for name, one in found.items()}
    return all(one.answer(numbers) == YES for one in sentence())


def measure(settings: Mapping, results: Sequence[Mapping]) -> dict[str, Estimate]:
    """The numbers of the default game, and the share of games that meet each condition."""
    games = list(numbers_by_game(settings, results).values())
    met = [answers(found) for found in games]
    shares = {GRID + name: share_of([one[name] for one in met]) for name in met[0]}
    return games[0] | shares | {f"{GRID}sentence": share_of([sentence_holds(found) for found in games])}


@computed_once
def numbers_by_game(settings: Mapping, results: Sequence[Mapping]) -> dict[tuple, dict[str, Estimate]]:
    """`measure_game` of each game under each normalisation, in order."""
    return {game: measure_game(lots) for game, lots in by_game(results).items()}


def measure_game(results: Sequence[Mapping]) -> dict[str, Estimate]:
    """The numbers of a single game, from its lots."""
    others = {"static": losses_of(results, STATIC), "exp3": losses_of(results, PRINTED_EXP3)}
    static = others["static"]
    found: dict[str, Estimate] = {}
    for method, key in KEYS.items():
        mine = losses_of(results, method)
        for name, other in others.items():
            found[f"to_{name}_first{key}"] = ratio_estimate(mine[:, :, 0], other[:, :, 0])
            found[f"to_{name}_last{key}"] = ratio_estimate(mine[:, :, -1], other[:, :, -1])
        found[f"worst_to_static{key}"] = worst_ratio(mine, static)[0]
        found[f"worst_to_static_last{key}"] = worst_ratio(mine[:, :, -1:], static[:, :, -1:])[0]
    oracle = losses_of(results, ORACLE)

    def regret(losses: NDArray[np.float64]) -> NDArray[np.float64]:
        return (losses - oracle).mean(axis=2).ravel()

    for method, key in KEYS.items():
        own = regret(losses_of(results, method))
        found[f"regret{key}"] = mean_estimate(own)
        found |= {f"regret_to_{name}{key}": ratio_estimate(own, regret(other)) for name, other in others.items()}
    lagging = losses_of(results, LAGGING).mean(axis=2)
    found["to_static_with_lag"] = ratio_estimate(lagging, static.mean(axis=2))
    needed = joined(results, "needed")
    found |= {f"steps_needed_b{b}": median_steps(steps) for b, steps in zip(SIZES, needed, strict=True)}
    within = (needed >= 0) & (needed <= joined(results, "lengths"))
    found["named_within_first_episode"] = mean_estimate(within)
    for key in KEYS.values():
        half = joined(results, f"half{key}")
        found[f"right_half{key}"] = exact_share(half.ravel().tolist())
        by_type = [exact_share(right.tolist()) for right in half[1:]]
        found[f"least_right_half_but_smallest{key}"] = min(by_type, key=lambda number: number.value)
    found["right_speed_at_end"] = mean_estimate(joined(results, "right_speed"))
    return found


def median_steps(steps: NDArray[np.int64]) -> Estimate:
    """Median steps until the named type stays right, with a distribution-free 95 % interval.

    A player never named right (-1) counts as infinite; there is no interval where an end is infinite.
    """
    from scipy.stats import binom

    ordered = np.sort(np.where(steps < 0, np.inf, steps.astype(float)))
    low, high = binom.ppf([0.025, 0.975], len(ordered), 0.5).astype(int)
    ends = float(ordered[max(low - 1, 0)]), float(ordered[min(high, len(ordered) - 1)])
    median = float(np.median(ordered))
    return Estimate(median, median, ends if np.isfinite(ends).all() else None, len(steps))


def rows(settings: Mapping, results: Sequence[Mapping]) -> list[dict]:
    """By game, the conditions' numbers and whether each is met; then, of the default game, mean loss by type and
    episode of each method, and the share of players named right by each step."""
    games = by_game(results)
    found = [_game_row(game, numbers) for game, numbers in numbers_by_game(settings, results).items()]
    default = next(iter(games.values()))
    methods = (STATIC, ORACLE, *BEATS, LAGGING, PRINTED_EXP3, TUNED_EXP3)
    losses = {method: losses_of(default, method).mean(axis=1) for method in methods}
    found += [{"method": m, "loss": np.round(mean, 4).tolist()} for m, mean in losses.items()]
    naming: dict[str, Any] = {"steps": STEPS}
    for key in KEYS.values():
        shares = [
            [float(((row >= 0) & (row < s)).mean()) for s in STEPS] for row in joined(default, f"needed{key}")
        ]
        naming[f"named{key}"] = np.round(shares, 3).tolist()
        naming[f"length{key}"] = float(joined(default, f"lengths{key}").mean())
    return [*found, naming]


def _game_row(game: tuple, found: Mapping[str, Estimate]) -> dict:
    met, words = answers(found), Setting(*game).words
    asked = {*met, *(one.condition.measure for one in sentence())}
    numbers = plain({name: number for name, number in found.items() if name in asked})
    yes = {one.condition.measure: one.answer(numbers) == YES for one in sentence()}
    return {"game": list(game), "words": words, "met": met, "sentence": yes} | numbers
