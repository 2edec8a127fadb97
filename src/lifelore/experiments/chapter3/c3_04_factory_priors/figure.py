"""Figure of claim C3.4."""

from collections.abc import Mapping


def draw(result: Mapping):
    from lifelore.experiments.chapter3.figure_factory_priors import draw_factory_priors

    return draw_factory_priors(result)
