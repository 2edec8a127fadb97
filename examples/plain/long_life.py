"""One long life (thesis ch. 5): recognise, reuse, notice, learn, remember, in plain NumPy.

A robot pours drinks for guests. It sees the hour (the context) and not the taste (the type). It knows a policy for
each type that it has met: which of five drinks to bring. Which types to expect at an hour is an action prior over
policies; Bayesian policy reuse follows the guest's answers; where no known type fits, a new policy is learnt.

    python examples/plain/long_life.py
"""

from dataclasses import dataclass, field

import numpy as np

HOURS, DRINKS, EPISODES = ("morning", "evening"), 5, 12
LIKED, DISLIKED = 0.9, 0.1  # how often a guest is glad of the drink of her taste, and of any other
ALPHA0, DECAY = 0.5, 0.98
ALARM = 0.01  # p-value, looked at after each drink, below which a known type does not fit


@dataclass
class Memory:
    """What stays between tasks.

    glad, poured : (n_types, DRINKS) counts of glad answers, and of drinks brought
    alpha : (hours, n_types) how often each type came at an hour, with decay: an action prior over policies
    """

    glad: np.ndarray = field(default_factory=lambda: np.zeros((0, DRINKS)))
    poured: np.ndarray = field(default_factory=lambda: np.zeros((0, DRINKS)))
    alpha: np.ndarray = field(default_factory=lambda: np.zeros((len(HOURS), 0)))

    @property
    def model(self) -> np.ndarray:
        """P(glad | type, drink), the observation and the performance model in one."""
        return (self.glad + 0.5) / (self.poured + 1.0)

    def add_type(self) -> None:
        """Room for one more type."""
        self.glad, self.poured = (np.vstack([counts, np.zeros(DRINKS)]) for counts in (self.glad, self.poured))
        self.alpha = np.column_stack([self.alpha, np.zeros(len(HOURS))])

    def remember(self, hour: int, kind: int, glad: np.ndarray, poured: np.ndarray) -> None:
        """Count a finished task."""
        self.glad[kind] += glad
        self.poured[kind] += poured
        self.alpha *= DECAY
        self.alpha[hour, kind] += 1


def fits(model: np.ndarray, glad: np.ndarray, poured: np.ndarray, generator: np.random.Generator) -> float:
    """Share of simulated tasks of a type that are as unlikely as this one, (0, 1]: a p-value."""

    def log_likelihood(answers: np.ndarray) -> np.ndarray:
        return (answers * np.log(model) + (poured - answers) * np.log(1 - model)).sum(axis=-1)

    simulated = log_likelihood(generator.binomial(poured.astype(int), model, size=(400, DRINKS)))
    return float((1 + (simulated <= log_likelihood(glad) + 1e-9).sum()) / 401)


def live_task(memory: Memory, hour: int, taste: int, generator: np.random.Generator) -> tuple[float, bool]:
    """One task of `EPISODES` drinks: the share of glad answers, and whether a new type was learnt."""
    n_types = len(memory.glad)
    weight = memory.alpha[hour] + ALPHA0
    beta = weight / weight.sum()  # recognise: the prior over types given the hour
    glad, poured, alarm = np.zeros(DRINKS), np.zeros(DRINKS), n_types == 0
    for _ in range(EPISODES):
        if alarm:  # learn: a bandit over drinks, by sampling from Beta posteriors
            drink = int(generator.beta(glad + 0.5, poured - glad + 0.5).argmax())
        else:  # reuse: the drink that is best under the belief (Eq. 4.5)
            drink = int((beta @ memory.model).argmax())
        answer = generator.random() < (LIKED if drink == taste else DISLIKED)
        glad[drink] += answer
        poured[drink] += 1
        if not alarm:
            likelihood = memory.model[:, drink] if answer else 1 - memory.model[:, drink]
            beta = beta * likelihood / (beta @ likelihood)  # Eq. 4.1
            # notice: does any type fit that is still believed?
            most = max(fits(model, glad, poured, generator) for model in memory.model[beta > 1e-3])
            alarm = most < ALARM
    if alarm:
        memory.add_type()
    memory.remember(hour, n_types if alarm else int(beta.argmax()), glad, poured)  # remember
    return float(glad.sum() / EPISODES), alarm


def main() -> None:
    generator, memory = np.random.default_rng(4), Memory()
    usual = {0: (1, 3), 1: (0, 4)}  # tastes that come in the morning, and in the evening
    glad, new = [], []
    for _ in range(120):
        hour = int(generator.integers(len(HOURS)))
        taste = usual[hour][int(generator.random() < 0.3)]
        share, alarm = live_task(memory, hour, taste, generator)
        glad.append(share)
        new.append(alarm)
    for first in (0, 40, 80):
        part = slice(first, first + 40)
        print(f"tasks {first:3} to {first + 39:3}: glad {np.mean(glad[part]):.2f}, new types {sum(new[part])}")


if __name__ == "__main__":
    main()
