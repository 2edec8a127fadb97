"""The worked example of golf: entropy of the belief and error by shot, as printed and as measured (Table 4.2)."""

from collections.abc import Mapping

from lifelore.figures.style import BLUE, GREY, VERMILION, Axes
from reproduction.chapter4.c4_01_golf_example.run import PRINTED_ENTROPY, PRINTED_ERROR
from reproduction.figures.panels import panels


@panels(8.6, 3.2, 1, 2)
def draw(result: Mapping, *every: Axes) -> None:
    """Printed numbers as diamonds beside histograms (median, middle 95 %) and exact models."""
    learnt, exact = result["rows"]
    shots = range(1, result["settings"]["shots"] + 1)
    titles = {
        "entropy": "Entropy of the belief before each shot (nats)",
        "error": "Distance from the hole (yards)",
    }
    for axes, (key, title) in zip(every, titles.items(), strict=True):
        low, middle, high = learnt[key]
        axes.fill_between(shots, low, high, color=BLUE, alpha=0.2, lw=0)
        axes.plot(shots, middle, "o-", color=BLUE, ms=4, label=f"histograms of {learnt['samples']} shots")
        axes.plot(shots, exact[key][1], ls=(0, (3, 2)), color=GREY, label="exact models")
        printed = PRINTED_ENTROPY if key == "entropy" else PRINTED_ERROR
        axes.plot(shots, printed[: len(shots)], "D", color=VERMILION, ms=5, label="printed (one round)")
        axes.set(title=title, xlabel="shot", ylim=(0, None), xticks=list(shots))
    every[0].legend()
