"""Figure of claim C3.2: learning curves under each schedule of ε, and the grid of choices left open."""

from collections.abc import Mapping, Sequence

from lifelore.figures.style import GREY, Figure, SubFigure, colour_of, house_style, new_figure, two_rows
from reproduction.chapter3.c3_02_lattice_prior.run import KEYS
from reproduction.chapter3.figures.choice_grid import RATIO, draw_choice_grid
from reproduction.chapter3.figures.reward_curves import MethodCurve, draw_return_curves
from reproduction.engine.results_table import ResultsTable

LABELS = {
    None: ("Q-learning", "q-learning"),
    "uniform": ("ε-QSAP, ties uniform", "eps-QSAP"),
    "prior": ("ε-QSAP, ties by prior", "eps-QSAP, ties by prior"),
}
"""Label and style of a learner by its ties."""
MEASURES = {"first": "annealed_first_eps_qsap", "to_80_ratio": "annealed_to_80_ratio"}
"""What the tables show, and its name among the measures."""


@house_style()
def draw(result: Mapping) -> Figure:
    """The figure from the result."""
    figure = new_figure(10.4, 9.4)
    upper, lower = two_rows(figure, (1.0, 1.22))
    draw_return_curves(upper, result, lambda schedule: _methods(result, schedule), bars=0.26, ncols=4)
    _draw_grids(lower, result)
    lower.supxlabel(
        f"Shaded and thin lines: 95 % interval over {result['settings']['runs']} runs, α constant. Columns: ε, "
        "and how ties are broken. Bold: the interval excludes 0, or 1.\n"
        "Bars and ratios: runs that never arrive count as all episodes. Last rows: the default's prior under "
        f"other caps of an episode, and with α annealed ({result['settings']['crossed_runs']} runs).\n"
        "Framed: the cells that the verdict reads, α annealed as in the thesis "
        f"({result['settings']['runs']} runs).",
        fontsize=8, color=GREY,
    )  # fmt: skip
    return figure


def _methods(result: Mapping, schedule: Sequence[float]) -> list[MethodCurve]:
    cells = ResultsTable([row for row in result["rows"] if "to_50" in row], ("schedule", *KEYS))
    found = []
    for row in result["rows"]:
        if "curve_of" in row and row["schedule"] == schedule:
            label, style = LABELS[row["curve_of"]["ties"]]
            to_80 = cells.record(schedule=schedule, **row["curve_of"])["to_80"]
            found.append(MethodCurve(label, colour_of(style), row, to_80))
    return found


def _draw_grids(figure: SubFigure, result: Mapping) -> None:
    settings, side = result["settings"], ("form", "alpha0", "annealed", "max_steps")
    usual = {"annealed": False, "max_steps": settings["max_steps"]}
    cells = [{**row, **usual} for row in result["rows"] if row.get("form") and "to_50" in row]
    prior = {key: settings["default"][key] for key in ("form", "alpha0")}
    crossed = [row for row in result["rows"] if "learning_rate" in row]
    cells += [{**row, **prior, "annealed": row["learning_rate"][1] < 1} for row in crossed]
    judged = {**settings["default"], **usual, "annealed": True}
    at = [place for place, row in enumerate(cells) if all(row[key] == judged[key] for key in judged)]
    for place in at:
        of_all_runs = {key: result["measured"][name] for key, name in MEASURES.items()}
        cells[place] = cells[place] | of_all_runs
    settings = {**settings, "default": judged if at else {**settings["default"], **usual}}

    def name(form: str, alpha0: float | None, annealed: bool, max_steps: int) -> str:
        if annealed or max_steps != usual["max_steps"]:
            return f"cap {max_steps:,}{', α annealed' * annealed}"
        return form if alpha0 is None else f"{form}, α⁰ {alpha0:g}"

    first, ratio = figure.subplots(1, 2, sharey=True)
    look = {"neutral": 0.0, "spread": 40.0, "words": "{:+.1f}".format}
    draw_choice_grid(first, settings, cells, "first", side, name, **look)
    draw_choice_grid(ratio, settings, cells, "to_80_ratio", side, name, **RATIO)
    first.set_title("Return of the first episode")
    ratio.set_title("Episodes to 80 % of optimal, as a ratio to Q-learning")
