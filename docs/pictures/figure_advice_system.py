"""The system that gives advice, as blocks and the messages between them (thesis Fig 3.19)."""

from lifelore.figures.style import BLUE, GREY, INK, LIGHT, PAPER, VERMILION, Axes, Figure, house_style, new_figure

BLOCKS = {
    "environment": ((1.3, 4.4), (2.0, 1.0), "Environment", "the maze, the building", LIGHT),
    "explorer": ((1.3, 1.4), (2.0, 1.0), "Explorer", "unknown policy, unknown goal", LIGHT),
    "assessment": ((5.3, 2.9), (2.5, 1.2), "Assessment", "P(M₁ | H), P(M₂ | H):\nexpert or lost?", PAPER),
    "condition": ((8.6, 2.9), (1.9, 1.2), "Condition 3.16", "does advice gain\nmore than κ?", PAPER),
    "prior": ((5.3, 5.3), (2.5, 1.0), "Action prior θ", "how experts move at s", PAPER),
    "database": ((8.6, 5.3), (1.9, 1.0), "Behaviours", "earlier agents,\nother tasks", PAPER),
}  # fmt: skip
"""Centre, size, name, words and colour of each block."""
ADVISOR = (3.75, 1.75, 6.1, 4.3)
"""Left, bottom, width and height of the frame around the advisor's blocks."""


def draw_advice_system() -> Figure:
    """Explorer and environment to the left; the advisor watches both, and answers with θ where it pays."""
    from matplotlib.patches import FancyBboxPatch

    with house_style():
        figure = new_figure(9.4, 5.3)
        axes = figure.subplots()
        axes.set(xlim=(0.1, 10.1), ylim=(0.55, 6.2), aspect="equal")
        axes.axis("off")
        left, bottom, width, height = ADVISOR
        frame = {"boxstyle": "round,pad=0,rounding_size=0.15", "fc": "#f4f7fa", "ec": GREY, "lw": 1.0}
        axes.add_patch(FancyBboxPatch((left, bottom), width, height, zorder=0, **frame))
        axes.text(left + 0.15, bottom + 0.14, "Advisor", color=GREY, weight="bold", fontsize=10, va="bottom")
        for place, size, name, words, colour in BLOCKS.values():
            _block(axes, place, size, name, words, colour)
        _message(axes, (0.85, 1.95), (0.85, 3.85), "action a", INK, (-0.12, 0), "right")
        _message(axes, (1.6, 3.85), (1.6, 1.95), "state s, reward r", INK, (0.12, 0.45), "left")
        _message(axes, (1.6, 2.9), (4.0, 2.9), "sees s and a", GREY, (0.35, 0.18), "center", dotted=True)
        _message(axes, (5.3, 4.75), (5.3, 3.55), "θ at s", BLUE, (0.12, 0), "left")
        _message(axes, (7.6, 5.3), (6.6, 5.3), "", BLUE)
        _message(axes, (6.6, 2.9), (7.6, 2.9), "", INK)
        _advice(axes)
    return figure


def _block(axes: Axes, place, size, name: str, words: str, colour: str) -> None:
    from matplotlib.patches import FancyBboxPatch

    (x, y), (width, height) = place, size
    look = {"boxstyle": "round,pad=0,rounding_size=0.12", "fc": colour, "ec": INK, "lw": 1.3, "zorder": 2}
    axes.add_patch(FancyBboxPatch((x - width / 2, y - height / 2), width, height, **look))
    lines = 1 + words.count("\n")
    axes.text(x, y + 0.13 * lines, name, ha="center", va="center", weight="bold", fontsize=10, zorder=3)
    axes.text(x, y + 0.13 * lines - 0.24, words, ha="center", va="top", fontsize=7.5, zorder=3, linespacing=1.35)


def _message(
    axes: Axes, start, end, words: str, colour: str, beside=(0.0, 0.0), ha="center", dotted=False
) -> None:
    """An arrow, and words beside its middle."""
    look = {"arrowstyle": "-|>", "color": colour, "lw": 1.4, "shrinkA": 0, "shrinkB": 0}
    look["linestyle"] = (0, (2, 1.5)) if dotted else "-"
    axes.annotate("", end, start, arrowprops=look, zorder=4)
    x, y = (start[0] + end[0]) / 2 + beside[0], (start[1] + end[1]) / 2 + beside[1]
    axes.text(x, y, words, color=colour, ha=ha, va="center", fontsize=8.5, zorder=5)


def _advice(axes: Axes) -> None:
    """The way back: from the condition, under the advisor, to the explorer."""
    axes.plot([8.6, 8.6, 2.6], [2.3, 1.1, 1.1], color=VERMILION, lw=2.0, zorder=3, solid_joinstyle="round")
    look = {"arrowstyle": "-|>", "color": VERMILION, "lw": 2.0, "shrinkA": 0, "shrinkB": 0}
    axes.annotate("", (2.3, 1.1), (2.7, 1.1), arrowprops=look, zorder=4)
    axes.text(
        5.6,
        0.98,
        "advice: the distribution θ over actions at s",
        color=VERMILION,
        ha="center",
        va="top",
        fontsize=9,
    )
