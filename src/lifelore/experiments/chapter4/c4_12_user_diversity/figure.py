"""Figure of claim C4.12."""

from collections.abc import Mapping


def draw(result: Mapping):
    from lifelore.experiments.chapter4.population_diversity import draw_population_diversity

    return draw_population_diversity(result)
