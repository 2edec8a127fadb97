"""Pure Python as fast as it goes by hand: tables and Q as lists, names bound outside the loop."""

import random
import time

from benchmarks.lattice import ALPHA, DISCOUNT, EPSILON, MAX_STEPS, lattice_task
from lifelore.core.mdp import Tables

STEPS = 200_000


def _prepared(tables: Tables):
    """Moves as ``moves[state][action] = (following, reward, event)``, Q, the starts, and random numbers."""
    columns = [array[:, :, 0].tolist() for array in tables[:3]]
    moves = [list(zip(*rows, strict=True)) for rows in zip(*columns, strict=True)]
    q = [[0.0] * tables.n_actions for _ in range(tables.n_states)]
    return moves, q, tables.starts.tolist(), random.Random(0).random


def tuned_rate(steps: int = STEPS) -> float:
    """Million steps a second on the lattice, doing the work that all do."""
    moves, q, starts, draw = _prepared(lattice_task().tables())
    n_starts, n_actions, largest, every = len(starts), len(q[0]), max, range(len(q[0]))
    visits = [[0] * n_actions for _ in q]
    curve, done = [], 0
    started = time.perf_counter()
    while done < steps:
        state = starts[int(draw() * n_starts)]
        row = q[state]
        best = largest(row)
        discounted, total, reach, collisions, step, event = 0.0, 0.0, 1.0, 0, 0, 0
        while not event & 1 and step < MAX_STEPS:
            if draw() < EPSILON:
                action = int(draw() * n_actions)
            elif row.count(best) == 1:
                action = row.index(best)
            else:
                tied = [a for a in every if row[a] == best]
                action = tied[int(draw() * len(tied))]
            following, reward, event = moves[state][action]
            visits[state][action] += 1
            after = q[following]
            # The best of the next row is needed again to choose there, unless this update changes it.
            best = largest(after)
            target = reward if event & 1 else reward + DISCOUNT * best
            row[action] += ALPHA * (target - row[action])
            if following == state:
                best = largest(row)
            if reward:
                discounted += reach * reward
                total += reward
            reach *= DISCOUNT
            if event & 2:
                collisions += 1
            state, row = following, after
            step += 1
        curve.append((discounted, total, step, collisions, event & 1))
        done += step
    return done / (time.perf_counter() - started) / 1e6


def short_tuned_rate(steps: int = STEPS) -> float:
    """The same, but ties go to the first best action, and neither visits nor curves are kept."""
    moves, q, starts, draw = _prepared(lattice_task().tables())
    n_starts, n_actions, largest = len(starts), len(q[0]), max
    done, step = 0, 0
    started = time.perf_counter()
    while done < steps:
        state = starts[int(draw() * n_starts)]
        row = q[state]
        best = largest(row)
        for step in range(1, MAX_STEPS + 1):  # noqa: B007 — its last value is read after the loop
            action = int(draw() * n_actions) if draw() < EPSILON else row.index(best)
            following, reward, event = moves[state][action]
            if event & 1:
                row[action] += ALPHA * (reward - row[action])
                break
            after = q[following]
            best = largest(after)
            row[action] += ALPHA * (reward + DISCOUNT * best - row[action])
            if following == state:
                best = largest(row)
            state, row = following, after
        done += step
    return done / (time.perf_counter() - started) / 1e6
