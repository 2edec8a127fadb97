"""A prior over the cells of a factory, drawn on its points and routes in the colours of Figure 3.6."""

from collections.abc import Sequence

import numpy as np

from lifelore.domains.factory.factory import PROCURE, Factory
from lifelore.domains.factory.picture import ASSEMBLE_COLOUR, EXPRESS_COLOUR, PROCURE_COLOUR
from lifelore.figures.lives.prior_arrows import draw_prior
from lifelore.figures.style import INK, Axes


def draw_factory_prior(
    axes: Axes, factory: Factory, probs: Sequence[Sequence[float] | None], components: Sequence[int]
) -> None:
    """Draw a prior over the cells of one configuration.

    `probs` has six numbers for each cell, or None where the prior has no counts: such cells are shaded. Points of
    the task's `components` are drawn in full colour, the others pale. A dot on a point grows with the mass of the
    use that belongs there.
    """
    counted = np.array([row is not None for row in probs])
    mass = np.array([row if row is not None else [0.0] * 6 for row in probs])
    draw_prior(axes, factory.floor.shape, factory.floor.cells, mass[:, :PROCURE], counted)
    for cell in np.flatnonzero(factory.express):
        _fill(axes, factory, int(cell), EXPRESS_COLOUR, 0.45)
    uses = ((factory.procure_at, PROCURE_COLOUR), (factory.assemble_at, ASSEMBLE_COLOUR))
    for use, (points, colour) in enumerate(uses):
        for component, cell in enumerate(points):
            _fill(axes, factory, int(cell), colour, 0.6 if component in components else 0.22)
            row, column = factory.floor.cells[cell]
            area = 26 * mass[cell, PROCURE + use]
            axes.scatter(column, row, s=area, color=INK, linewidths=0, zorder=4)


def _fill(axes: Axes, factory: Factory, cell: int, colour: tuple[int, int, int], alpha: float) -> None:
    from matplotlib.patches import Rectangle

    row, column = factory.floor.cells[cell]
    shade = tuple(part / 255 for part in colour)
    square = Rectangle((column - 0.5, row - 0.5), 1, 1, facecolor=shade, alpha=alpha, linewidth=0, zorder=1)
    axes.add_patch(square)
