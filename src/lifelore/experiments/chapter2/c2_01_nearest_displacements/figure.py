"""Figure of claim C2.1."""

from collections.abc import Mapping

from lifelore.core.relations import CORE_RELATIONS

PRINTED = [[64, 6, 13, 0], [2, 20, 5, 0], [4, 5, 12, 0], [0, 1, 0, 0]]
"""Figure 2.5: predicted by actual, in the order of `CORE_RELATIONS`."""


def draw(result: Mapping):
    from lifelore.experiments.chapter2.relation_comparison import draw_relation_comparison

    return draw_relation_comparison(result["rows"], PRINTED, CORE_RELATIONS)
