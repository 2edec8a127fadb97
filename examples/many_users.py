"""Ten thousand users, five noisy outcomes each: choosing for each user, compared with one choice for all.

For people who personalise interactive systems.
"""

import numpy as np

from lifelore import PolicyLibrary, UserBeliefs

n_users, random = 10_000, np.random.default_rng(0)
means = random.normal(5, 2, size=(8, 6))  # mean outcome of 8 types of user under 6 configurations
library = PolicyLibrary.from_means(means, 1.0)
types = random.integers(8, size=n_users)  # hidden from the beliefs
users, everybody = UserBeliefs(library, n_users), np.arange(n_users)

for interaction in range(1, 6):
    choices = users.select(everybody, "information-directed")
    outcomes = random.normal(means[types, choices], 1.0)
    users.update(everybody, choices, outcomes)
    print(f"interaction {interaction}: mean outcome {outcomes.mean():.2f}")
print(f"best single configuration for all: {means[types].mean(axis=0).max():.2f}")
print(f"best configuration of each user:   {means[types].max(axis=1).mean():.2f}")
