"""Plain data in, matplotlib out: the pictures of `lives`, `scenes` and policy reuse."""

from typing import TYPE_CHECKING

from lifelore.core.lazy_exports import lazy_exports

if TYPE_CHECKING:
    from lifelore.figures.lives.prior_table import plot_prior as plot_prior
    from lifelore.figures.style import house_style as house_style
    from lifelore.figures.style import new_figure as new_figure
    from lifelore.figures.style import save_figure as save_figure

__all__, __getattr__, __dir__ = lazy_exports(__name__)  # pyright: ignore[reportUnsupportedDunderAll]
