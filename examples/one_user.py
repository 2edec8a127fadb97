"""Bayesian policy reuse finds which configuration suits a new user, in a few tries.

For people who personalise interactive systems. Thesis: Algorithm 7.
"""

import numpy as np

from lifelore import BayesianPolicyReuse, PolicyLibrary

random = np.random.default_rng(0)
mean_score = np.array([[200, 80, 120], [60, 210, 110], [90, 100, 220]])  # types of user × configurations
runs = random.normal(mean_score[:, :, None], 20, size=(3, 3, 10))  # ten runs of each pair, made beforehand
library = PolicyLibrary.from_samples(runs, types=["slow", "quick", "bold"], policies=["A", "B", "C"])

agent = BayesianPolicyReuse(library, seed=1)
for attempt in range(4):  # a new user arrives, whose type ("bold") the agent does not know
    choice = agent.select()
    score = random.normal(mean_score[2, choice], 20)
    agent.update(choice, score)
    belief = dict(zip(library.types, agent.belief.round(2).tolist(), strict=True))
    print(f"attempt {attempt}: configuration {library.policies[choice]}, score {score:.0f}, belief {belief}")
