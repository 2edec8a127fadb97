"""Figure of claim C3.2."""

from collections.abc import Mapping


def draw(result: Mapping):
    from lifelore.figures.prior_grid import draw_prior_grid

    return draw_prior_grid(result)
