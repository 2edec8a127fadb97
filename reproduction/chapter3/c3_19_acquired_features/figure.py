"""Figure of claim C3.19: the features that are acquired, and learning with them."""

from collections.abc import Mapping

from lifelore.figures.style import BLUE, GREEN, GREY, VERMILION, Axes
from reproduction.chapter3.figures.feature_words import features_in_words
from reproduction.figures.curves import draw_curves
from reproduction.figures.interval_bars import draw_interval_bars
from reproduction.figures.panels import panels

LABELS = {
    "uniform": ("no prior", GREY),
    "start": ("features at the start", VERMILION),
    "all": ("all ten features", GREEN),
    "acquired": ("features acquired", BLUE),
}


@panels(9.2, 3.8, 1, 2, width_ratios=(0.8, 1), grid="")
def draw(result: Mapping, left: Axes, right: Axes) -> None:
    """Shares of runs by feature, and mean rewards by episode, one standard deviation of the acquired shaded."""
    features = [row for row in result["rows"] if "feature" in row]
    curves = {row["curve_of"]: row for row in result["rows"] if "curve_of" in row}
    names = features_in_words([row["feature"] for row in features])
    title = "Runs in which a feature is acquired (%)"
    draw_interval_bars(left, names, {"": features}, scale=100, words=None, title=title)
    left.set_xlim(0, 100)
    left.grid(axis="x")
    series = {label: {"mean": curves[name]["mean"]} for name, (label, _) in LABELS.items()}
    series[LABELS["acquired"][0]]["deviation"] = curves["acquired"]["deviation"]
    draw_curves(
        right, None, series,
        looks={label: {"color": colour, "linewidth": 1.5} for label, colour in LABELS.values()},
        title="Learning in new factories", xlabel="episode", ylabel="reward of an episode",
        level=(result["measured"]["optimal_reward"]["value"], "optimal"), legend=False,
    )  # fmt: skip
    right.legend(loc="lower right")
    lowest = min(min(row["mean"]) for row in curves.values())
    right.set(xlim=(1, result["settings"]["episodes"]), ylim=(1.1 * lowest, -0.06 * lowest))
    right.yaxis.set_major_formatter(lambda value, _: f"{value:,.0f}".replace("-", "−"))
