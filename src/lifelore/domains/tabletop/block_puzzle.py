"""Puzzles of blocks: towers on a table that must become other towers, as goals over spatial relations.

Thesis: §2.5 names spatial puzzles as a use of the relations. Those that it cites have rings, holes and strings;
these have blocks.
"""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from lifelore.core.relations import ADJACENT, ON
from lifelore.domains.tabletop.layout import Group, stand, top
from lifelore.domains.tabletop.pick_and_place import ON_TABLE
from lifelore.domains.tabletop.pose import about
from lifelore.domains.tabletop.shapes import Shape, box

HIGHEST = 3
"""Number of blocks of the highest tower."""
SIZES = (0.07, 0.1)
"""Edges of the cubes, metres."""
APART = 0.2
"""Metres between the middles of neighbouring towers at the start."""

Towers = tuple[tuple[int, ...], ...]
"""Numbers of blocks, each tower from below."""
Wish = tuple[str, tuple[int, ...]]
"""A relation that shall hold, and the numbers of its blocks."""


@dataclass(frozen=True, eq=False)
class BlockPuzzle:
    """Cubes, the towers that they form, and those that they shall form.

    `beside`, if given, are the lowest blocks of two towers of the goal that shall stand side by side.
    """

    cubes: tuple[Shape, ...]
    start: Towers
    goal: Towers
    beside: tuple[int, int] | None

    def wishes(self) -> tuple[Wish, ...]:
        """The relations of the goal: what each block shall rest on, and which towers are neighbours.

        Examples
        --------
        >>> BlockPuzzle((), ((0,), (1,), (2,)), ((0, 2), (1,)), (0, 1)).wishes()
        (('on-table', (0,)), ('on', (2, 0)), ('on-table', (1,)), ('adjacent', (0, 1)))
        """
        found: list[Wish] = []
        for tower in self.goal:
            found.append((ON_TABLE, tower[:1]))
            found += [(ON, (above, below)) for below, above in pairwise(tower)]
        return (*found, (ADJACENT, self.beside)) if self.beside else tuple(found)

    def placed(self, generator: np.random.Generator) -> Group:
        """The start on a table: towers in two rows, each turned at random; blocks by number."""
        groups: dict[int, Group] = {}
        for number, tower in enumerate(self.start):
            spot = APART * (np.array([number % 2, number // 2]) - 0.5) + generator.uniform(-0.015, 0.015, 2)
            group: Group = []
            for block in tower:
                turn, height = about(2, generator.uniform(0, np.pi / 2)), top(group) if group else 0.0
                group.append(stand(self.cubes[block], turn, height).moved(*map(float, spot)))
            groups |= {block: [item] for block, item in zip(tower, group, strict=True)}
        return [groups[block][0] for block in range(len(self.cubes))]


def block_puzzle(generator: np.random.Generator, fewest: int = 4, most: int = 6) -> BlockPuzzle:
    """A random puzzle of `fewest` to `most` cubes; at least two rest on something else in its goal.

    Half of the puzzles whose goal has two towers or more ask for two of them side by side.
    """
    n = int(generator.integers(fewest, most + 1))
    cubes = tuple(box(edge, edge, edge) for edge in generator.uniform(*SIZES, n))
    start = goal = _towers(generator, n)
    while len(set(_supports(start).items()) - set(_supports(goal).items())) < 2:
        goal = _towers(generator, n)
    bottoms = [tower[0] for tower in goal]
    asked = len(goal) > 1 and generator.random() < 0.5
    return BlockPuzzle(cubes, start, goal, (bottoms[0], bottoms[1]) if asked else None)


def _towers(generator: np.random.Generator, n: int) -> Towers:
    """A random order, cut at random into towers of at most `HIGHEST`."""
    order, towers = generator.permutation(n).tolist(), []
    while order:
        height = min(len(order), int(generator.integers(1, HIGHEST + 1)))
        towers.append(tuple(order[:height]))
        order = order[height:]
    return tuple(towers)


def _supports(towers: Towers) -> dict[int, int]:
    """What each block rests on; −1 for the table."""
    return {block: ((-1, *tower)[place]) for tower in towers for place, block in enumerate(tower)}
