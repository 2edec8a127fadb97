"""Plain data in, matplotlib out: the pictures of `lives`, `scenes` and policy reuse."""

from typing import TYPE_CHECKING

from lifelore.core.lazy_exports import lazy_exports

if TYPE_CHECKING:
    from lifelore.figures.lives.prior_table import plot_prior as plot_prior
    from lifelore.figures.style import house_style as house_style
    from lifelore.figures.style import new_figure as new_figure
    from lifelore.figures.style import save_figure as save_figure

_HOME = {
    "house_style": ".style",
    "new_figure": ".style",
    "plot_prior": ".lives.prior_table",
    "save_figure": ".style",
}

__all__ = [*_HOME]  # pyright: ignore[reportUnsupportedDunderAll]
__getattr__, __dir__ = lazy_exports(__name__, _HOME)
