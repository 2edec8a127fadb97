"""An agent lives through tasks on three lakes that look alike, and learns to tell them apart.

For reinforcement-learning researchers. Which lake a task is on stays hidden: the agent sees the day, and what its
moves do. It expects the lake that the day usually has, runs the policy that it knows for it, notices a new lake,
and learns a policy for it then.
"""

import gymnasium as gym
import numpy as np
from gymnasium.envs.toy_text.frozen_lake import generate_random_map

from lifelore import LongLivedAgent

LAKES = [generate_random_map(5, seed=seed) for seed in (1, 2, 5)]
DAYS = ("monday", "tuesday", "wednesday")
random = np.random.default_rng(0)
tasks = [(day, day if random.random() < 0.8 else random.integers(3)) for day in random.integers(3, size=24)]

lives = {}
for name in ("full", "textbook"):
    agent = LongLivedAgent(key="lakes", agent=name, episodes=40, max_steps=60)
    lives[name] = []
    for day, lake in tasks:
        env = gym.make("FrozenLake-v1", desc=LAKES[lake], success_rate=0.9)
        lives[name].append(agent.live(env, context=DAYS[day]))
    if name == "full":
        print(agent.explain(lives[name][-1]))
        print(f"knows {len(agent.types)} types; would rather meet {agent.curiosity()[0].context} again")

for name, results in lives.items():
    first, mean = (np.mean([part(one.returns) for one in results[12:]]) for part in (lambda r: r[0], np.mean))
    print(f"{name:8} first episodes {first:.2f}, all episodes {mean:.2f}")
