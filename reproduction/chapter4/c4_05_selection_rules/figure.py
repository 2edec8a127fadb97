"""Six ways to select among 68 policies: entropy of the belief and regret after each episode (Figure 4.10)."""

from collections.abc import Mapping

from lifelore.figures.style import Axes
from reproduction.chapter4.reuse.looks import draw_linear
from reproduction.figures.panels import panels


@panels(9.2, 3.8, 1, 2, grid="")
def draw(result: Mapping, left: Axes, right: Axes) -> None:
    """The thesis's panels (a) and (b): means of ten tasks."""
    rows, settings = result["rows"], result["settings"]
    draw_linear(left, {row["method"]: row["entropy"] for row in rows}, 0, title="(a) Entropy of the belief (nats)")
    draw_linear(right, {row["method"]: row["regret"] for row in rows}, 1, title="(b) Regret")
    for axes in (left, right):
        axes.set_xlabel("episode")
    left.figure.legend(*left.get_legend_handles_labels(), loc="outside lower center", ncols=len(rows))
    left.figure.suptitle(f"Surveillance, {settings['tasks']} random tasks, learnt models", x=0.01, ha="left")
