"""The simulated player of the ball game: which way she steers.

At every step she commands the direction whose end point, at the distance of the speed she reckons with, has the
lowest cost. The thesis says no more of the cost, and "toward the location, at distance z", taken literally, aims
through walls thinner than z, again and again. So the end point here is the one that the ball reaches, which is
where it stands if a ball that is blocked stays; being stopped costs `STOPPED` units, and ways near walls cost
more than their length (`paths`), since collisions are part of her loss. She knows her own size.
Thesis: §4.8.5.1.
"""

import numpy as np

from lifelore.core.compiled.jit import kernel
from lifelore.domains.ball_game.ball_game import MOVES, crosses, travel
from lifelore.domains.ball_game.paths import CELL

STOPPED = 30.0
"""Length of path, in units, that the player accepts to avoid being stopped."""


@kernel
def choose_heading(field, kind, x, y, distance):
    """The heading that the player commands at a place; of equals the first."""
    clearance, cost_to_go, radii, _, _, goal, _, stays = field
    best, least = 0, np.inf
    for heading in range(4):
        dx, dy = MOVES[heading, 0], MOVES[heading, 1]
        x1, y1, stopped = travel(clearance, goal, stays, radii[kind], x, y, dx, dy, distance)
        cost = cost_to_go[kind, (y1 + CELL // 2) // CELL, (x1 + CELL // 2) // CELL] + STOPPED * stopped
        if crosses(goal, x, y, x1, y1):
            cost = -np.inf
        if cost < least:
            best, least = heading, cost
    return best
