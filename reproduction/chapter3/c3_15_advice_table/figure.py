"""Figure of claim C3.15: rewards with and without advice, the printed ones, and the grid of open choices."""

from collections.abc import Mapping

import numpy as np

from lifelore.figures.interval_bars import draw_interval_bars
from lifelore.figures.style import GREY, INK, LIGHT, Axes, Figure, house_style, new_figure, two_rows
from reproduction.chapter3.advice import figures
from reproduction.chapter3.advice.buildings import other_choices
from reproduction.chapter3.advice.figures import ADVISORS, AGENTS, EXPLORERS
from reproduction.chapter3.advice.mazes import grid_of
from reproduction.engine.results_table import ResultsTable

PRINTED = {
    "random": (50, 900),
    "avoid": (50, 750),
    "left": (150, 750),
    "bug": (100, 800),
    "q-learning": (150, 1000),
    "optimal": (1000, 1000),
}
"""Table 3.1: without and with advice."""


@house_style()
def draw(result: Mapping) -> Figure:
    """Bars at the default above, the grid of loop densities and experts below."""
    settings = result["settings"]
    table = ResultsTable((row for row in result["rows"] if "way" in row), ("loops", "experts", "way", "agent"))
    figure = new_figure(10.4, 10.6)
    upper, lower = two_rows(figure, (1, 1.65))
    axes = upper.subplots()
    _draw_bars(axes, table.select(**settings["default"]))
    upper.legend(*axes.get_legend_handles_labels(), loc="outside upper left", ncols=5)
    above, below, beside = lower.subplots(3, 1, height_ratios=(1, 1.6, 1))
    _draw_grid(above, result, table, {"thesis": AGENTS}, 0.0, "Gain by the thesis's advisor")
    above.set_xlabel("")
    better = {"better": [*EXPLORERS, "optimal"], "uniform only": EXPLORERS}
    title = "Reward with the better advisor (goal: 700), and where Uniform is its only other model (*)"
    _draw_grid(below, result, table, better, 700.0, title)
    _draw_buildings(beside, result)
    lower.supxlabel(
        f"{settings['mazes']} mazes × {settings['tasks']} tasks a cell. Thin lines: 95 % interval over mazes; "
        "brackets: advised steps in 100. Bold: the gain's interval excludes 0 (above), at least 700 (below).\n"
        "Last table: without → with the thesis's advice; all agents start a task in one cell.",
        fontsize=8, color=GREY,
    )  # fmt: skip
    return figure


def _draw_bars(axes: Axes, table: ResultsTable) -> None:
    def number(way: str, agent: str) -> Mapping | None:
        rows = table.select(way=way, agent=agent).records
        if not rows:
            return None
        words = f"{rows[0]['reward']:.0f}"
        if rows[0].get("advised") and way != "none":
            words += f"\n({rows[0]['advised']:.0f})"
        return {"value": rows[0]["reward"], "ci95": rows[0]["ci95"], "words": words}

    groups = {label: [number(way, agent) for agent in AGENTS] for way, label in ADVISORS.items()}
    colours = {label: figures.ADVISOR_COLOURS[way] for way, label in ADVISORS.items()}
    look = {"horizontal": False, "label": "reward, of 1000", "legend": False, "words": None}
    draw_interval_bars(axes, list(AGENTS.values()), groups, colours=colours, **look)
    places, printed = np.arange(len(AGENTS))[:, None] + [-0.3, -0.1], [PRINTED[agent] for agent in AGENTS]
    axes.hlines(np.ravel(printed), np.ravel(places) - 0.09, np.ravel(places) + 0.09, color=INK, lw=2, zorder=6)
    axes.plot(np.ravel(places), np.ravel(printed), "D", ms=4, color=INK, label="printed in Table 3.1", zorder=6)
    _write_numbers(axes, groups)
    axes.set(ylim=(0, 1150), yticks=range(0, 1001, 250))
    axes.grid(axis="y", color=LIGHT)


def _write_numbers(axes: Axes, groups: Mapping) -> None:
    """Each bar's reward above its interval, and above the printed number where this is near."""
    for g, numbers in enumerate(groups.values()):
        for place, (agent, number) in enumerate(zip(AGENTS, numbers, strict=True)):
            if number is None:
                continue
            end = max(number["value"], (number["ci95"] or [0])[-1])
            printed = PRINTED[agent][g] if g < 2 else -1
            height = printed if end - 25 < printed < end + 90 else end
            axes.text(place + 0.2 * g - 0.3, height + 16, number["words"], ha="center", va="bottom", fontsize=7,
                      linespacing=0.95)  # fmt: skip


def _draw_buildings(axes: Axes, result: Mapping) -> None:
    settings = result["settings"]
    rewards = {
        (row["building"]["name"], row["alpha0"], row["walker"]): row["reward"]
        for row in result["rows"]
        if "walker" in row
    }
    walkers = [agent for agent in AGENTS if agent != "optimal"]
    choices = [(settings["buildings"][place]["name"], a) for place, a in [(0, 0.0), *other_choices(settings)]]
    pairs = [[(rewards[name, None, agent], rewards[name, a, agent]) for name, a in choices] for agent in walkers]
    sides = [AGENTS[agent] for agent in walkers]
    figures.draw_buildings(axes, settings, pairs, sides, neutral=0.0, spread=500.0)
    axes.set_title("Reward in other buildings, and with α⁰ in the advice")


def _draw_grid(axes: Axes, result: Mapping, table: ResultsTable, lines: Mapping, neutral: float, title: str):
    columns = grid_of(result["settings"])
    key, certain = ("gain", "gain_is_certain") if neutral == 0 else ("reward", None)
    sides, values, bold = [], [], []
    for way, agents in lines.items():
        for agent in agents:
            found = [table.record(loops=n, experts=e, way=way, agent=agent) for n, e in columns]
            values.append([row[key] for row in found])
            bold.append([row[certain] if certain else row[key] >= neutral for row in found])
            sides.append(AGENTS[agent] + (" *" if way == "uniform only" else ""))
    look = {"title": title, "neutral": neutral, "spread": 500.0 if neutral == 0 else 450.0}

    def words(value: float) -> str:
        return f"{value:+.0f}" if neutral == 0 and abs(value) >= 0.5 else f"{value:.0f}"

    figures.draw_maze_grid(axes, result, values, bold, sides, words=words, **look)
