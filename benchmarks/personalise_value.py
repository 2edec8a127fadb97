"""The value of personal choices on simulated logs, by true expectation: the default of `reuse fit` beside others.

Each round draws a world: people, messages, and a log of messages drawn at random. Strangers of the same world then
get ten messages each. All contenders learn from the log and from the strangers' outcomes, which are common: who
gives a stranger the same message at the same turn sees the same outcome. The score is the mean true expectation of
what was given. Intervals are those of paired differences between rounds: at least two rounds are run.
"""

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from benchmarks.rounds import Part, at_least, counted, joined, row
from lifelore.agent.personalise.fitting.fit import FitSettings, study_of_log
from lifelore.agent.personalise.log.log import read_log
from lifelore.core.protocols import Progress
from lifelore.core.streams import stream

Array = NDArray[Any]
Answer = Callable[[int, Array], Array]
"""The outcomes of strangers at a turn, by the message that each gets."""

USERS, ROWS, STRANGERS, TURNS = 3000, 20_000, 500, 10
CLICKS, MINUTES = "clicks", "minutes"
T_95 = (12.71, 4.30, 3.18, 2.78, 2.57, 2.45, 2.36, 2.31, 2.26)
"""Student's t for 95 % intervals of 2 to 10 rounds; 2 beyond."""


class World(NamedTuple):
    """How people of a world differ.

    outcome : of clicks (a rate) or of minutes
    n_types, n_messages, n_countries : number of each; without types (0) tastes vary along two factors
    focus : share of people whose country follows from their type; the others' country is drawn at random
    shift : deviation of a country's own liking for each message, as a share of the range between messages
    """

    outcome: str
    n_types: int
    n_messages: int
    n_countries: int
    focus: float
    shift: float = 0.0


DEVELOPED = {
    "clicks by 4 types": World(CLICKS, 4, 6, 4, 0.3),
    "minutes by 4 types": World(MINUTES, 4, 6, 4, 0.3),
}
"""Worlds that the default was developed on."""
JUDGED = {
    "clicks by tastes and country": World(CLICKS, 0, 8, 6, 0.0, 0.35),
    "minutes by 5 types, country weak": World(MINUTES, 5, 8, 3, 0.15),
}
"""Worlds that were written down before, and run when the default was fixed."""
RANGES = {CLICKS: (0.08, 0.18, 0.28), MINUTES: (3.0, 5.5, 7.5)}
"""Least and greatest expectation of most messages, and that of a type's own message."""
NOISE = 3.0
"""Deviation of minutes; clicks are 0 or 1."""


class People(NamedTuple):
    """Countries (n,) and expected outcomes of every message (n, n_messages)."""

    country: Array
    expected: Array


def people(world: World, seed: int, part: str, n: int) -> People:
    """People of the world of a seed; parts of it share its types and countries."""
    random, own = stream(seed, "bench", *map(str, world)), stream(seed, "bench", part, *map(str, world))
    least, greatest, best = RANGES[world.outcome]
    n_types = world.n_types or 1
    means = random.uniform(least, greatest, (n_types, world.n_messages))
    own_messages = random.permutation(world.n_messages)
    if world.n_types:
        means[np.arange(n_types), own_messages[:n_types]] = best
    factors = random.normal(size=(2, world.n_messages))
    shifts = random.normal(size=(world.n_countries, world.n_messages))
    types, country = own.integers(n_types, size=n), own.integers(world.n_countries, size=n)
    country = np.where(own.random(n) < world.focus, types % world.n_countries, country)
    expected = means[types] + world.shift * (best - least) * shifts[country]
    if not world.n_types:
        expected += 0.2 * (best - least) * own.normal(size=(n, 2)) @ factors
    return People(country, np.clip(expected, 0.02, 0.6) if world.outcome == CLICKS else expected)


def outcomes(world: World, expected: Array, random: np.random.Generator) -> Array:
    """An outcome of each expectation (...)."""
    if world.outcome == CLICKS:
        return (random.random(expected.shape) < expected).astype(float)
    return expected + NOISE * random.normal(size=expected.shape)


class Log(NamedTuple):
    """Rows (ROWS,) in order of time: user, message, outcome; and the country of each user."""

    user: Array
    message: Array
    outcome: Array
    country: Array
    n_messages: int

    def means(self, country: int | None = None) -> Array:
        """Mean outcome of each message, among all users or those of a country; lowest where it has none."""
        rows = slice(None) if country is None else self.country[self.user] == country
        number, total = (np.bincount(self.message[rows], weights, self.n_messages)
                         for weights in (None, self.outcome[rows]))  # fmt: skip
        return np.where(number > 0, total / np.maximum(number, 1), -np.inf)


def drawn_log(world: World, seed: int) -> Log:
    """A log of messages drawn at random."""
    random, known = stream(seed, "bench", "log", *map(str, world)), people(world, seed, "users", USERS)
    user, message = random.integers(USERS, size=ROWS), random.integers(world.n_messages, size=ROWS)
    return Log(
        user, message, outcomes(world, known.expected[user, message], random), known.country, world.n_messages
    )


# ---- contenders: messages (n_strangers, TURNS) from a log, the strangers' countries, and their answers ---------


def best_single(log: Log, country: Array, answer: Answer) -> Array:
    """The best message of the log for everybody."""
    return np.full((len(country), TURNS), log.means().argmax())


def best_by_country(log: Log, country: Array, answer: Answer) -> Array:
    """The best message of the log in each country."""
    best = np.array([log.means(place).argmax() for place in range(country.max() + 1)])
    return np.repeat(best[country][:, None], TURNS, axis=1)


class LinUCB:
    """Ridge regression of each message on country and own history, and an upper bound (Li and others 2010).

    The history of a user: the mean outcome above average of each message, shrunk as if `KNOWN` average outcomes
    came before, and the number of outcomes of it. All strangers' outcomes are learnt, as the log's are.
    """

    ALPHA, RIDGE, KNOWN = 0.1, 1.0, 3.0

    def __init__(self, log: Log, n_countries: int) -> None:
        self.n, self.middle, self.n_countries = log.n_messages, log.outcome.mean(), n_countries
        self.scale = log.outcome.std()
        size = 1 + n_countries + 2 * self.n
        self.a, self.b = np.tile(self.RIDGE * np.eye(size), (self.n, 1, 1)), np.zeros((self.n, size))
        number, total = np.zeros((2, len(log.country), self.n))
        for user, message, outcome in zip(log.user, log.message, log.outcome, strict=True):
            self._learn(self.features(log.country[[user]], number[[user]], total[[user]]), [message], [outcome])
            number[user, message] += 1
            total[user, message] += outcome - self.middle

    def features(self, country: Array, number: Array, total: Array) -> Array:
        """Features of users, (n, size)."""
        own = total / self.scale / (number + self.KNOWN)
        return np.hstack([np.ones((len(country), 1)), np.eye(self.n_countries)[country], own, np.log1p(number)])

    def _learn(self, features: Array, messages: Any, found: Any) -> None:
        for row_, message, outcome in zip(features, messages, found, strict=True):
            self.a[message] += np.outer(row_, row_)
            self.b[message] += (outcome - self.middle) / self.scale * row_

    def play(self, country: Array, answer: Answer) -> Array:
        """The messages of strangers."""
        number, total = np.zeros((2, len(country), self.n))
        given, users = np.zeros((len(country), TURNS), int), np.arange(len(country))
        for turn in range(TURNS):
            rows, inverse = self.features(country, number, total), np.linalg.inv(self.a)
            mean = rows @ np.einsum("mij,mj->mi", inverse, self.b).T
            bound = np.sqrt(np.einsum("ni,mij,nj->nm", rows, inverse, rows))
            given[:, turn] = (mean + self.ALPHA * bound).argmax(axis=1)
            found = answer(turn, given[:, turn])
            self._learn(rows, given[:, turn], found)
            number[users, given[:, turn]] += 1
            total[users, given[:, turn]] += found - self.middle
        return given


def lin_ucb(log: Log, country: Array, answer: Answer) -> Array:
    """LinUCB with country and history, which learns across users."""
    return LinUCB(log, max(country.max(), log.country.max()) + 1).play(country, answer)


def default(log: Log, country: Array, answer: Answer) -> Array:
    """The default of `reuse fit`, with the users' countries as contexts."""
    table = {
        "user": [f"u{user}" for user in log.user.tolist()],
        "policy": [f"m{message}" for message in log.message.tolist()],
        "outcome": log.outcome,
        "context": [f"c{log.country[user]}" for user in log.user.tolist()],
    }
    study = study_of_log(read_log(table), FitSettings())[0]
    algorithm = study.algorithm.new_rows(len(country))
    for place, own in enumerate(country.tolist()):
        algorithm.log_belief[place] = algorithm.start(study.prior_of(f"c{own}"))
    number = np.array([int(name[1:]) for name in study.library.policies])
    given, users, random = np.zeros((len(country), TURNS), int), np.arange(len(country)), np.random.default_rng(0)
    for turn in range(TURNS):
        chosen, _ = algorithm.select(users, study.selection, random)
        given[:, turn] = number[chosen]
        algorithm.update(users, chosen, answer(turn, given[:, turn]))
    return given


CONTENDERS = {
    "best single message": best_single,
    "best message by country": best_by_country,
    "LinUCB, country and history": lin_ucb,
    "default": default,
}


def bench_personalise_value(repeats: int, progress: Progress) -> dict:
    """Rows and goals; see `benchmarks.bench`."""
    worlds, rounds = DEVELOPED | JUDGED, max(2, repeats)
    after = counted(progress, rounds * len(worlds) * len(CONTENDERS))
    return joined(*(_world(name, world, rounds, after) for name, world in worlds.items()))


def _world(name: str, world: World, rounds: int, after: Callable[[str], None]) -> Part:
    """Mean scores, and how far the default is above each other contender; a goal is missed if clearly below."""
    each = [scores(world, seed, after) for seed in range(rounds)]
    found = {contender: np.array([one[contender] for one in each]) for contender in each[0]}
    rows = [row(f"{name}: {one}", float(value.mean()), world.outcome) for one, value in found.items()]
    goals = []
    for other in list(CONTENDERS)[:-1]:
        label = f"{name}: default over {other}"
        mean, half = paired(found["default"] - found[other])
        rows += [row(label, mean, world.outcome), row(f"{label}, half the 95 % interval", half, world.outcome)]
        goals.append(at_least(f"{label}, upper end", 0.0, mean + half))
    return rows, goals


def scores(world: World, seed: int, after: Callable[[str], None]) -> dict[str, float]:
    """Mean true expectation of what each contender gives strangers, and of their own best message."""
    log, strangers = drawn_log(world, seed), people(world, seed, "strangers", STRANGERS)
    random = stream(seed, "bench", "answers", *map(str, world))
    every = np.stack([outcomes(world, strangers.expected, random) for _ in range(TURNS)])
    users, found = np.arange(STRANGERS), {}
    for name, contender in CONTENDERS.items():
        given = contender(log, strangers.country, lambda turn, messages: every[turn, users, messages])
        found[name] = float(strangers.expected[users[:, None], given].mean())
        after(name)
    return found | {"own best message, known": float(strangers.expected.max(axis=1).mean())}


def paired(differences: Array) -> tuple[float, float]:
    """Mean and half the 95 % interval of differences between two rounds or more."""
    n = len(differences)
    t = T_95[n - 2] if n - 2 < len(T_95) else 2.0
    return float(differences.mean()), float(t * differences.std(ddof=1) / np.sqrt(n))
