"""Small signs on a map: a person, a robot, and a word beside them."""

from lifelore.figures.style import INK, PAPER, Axes


def draw_person(axes: Axes, at: tuple[float, float], colour: str, size: float = 1.0) -> None:
    """Head and shoulders at (x, y) on axes whose y grows downwards; `size` is the height in units of the axes."""
    from matplotlib.patches import Circle, Wedge

    x, y = at
    look = {"fc": colour, "ec": PAPER, "lw": 0.8, "zorder": 9}
    axes.add_patch(Wedge((x, y + 0.5 * size), 0.42 * size, 180, 360, **look))
    axes.add_patch(Circle((x, y - 0.16 * size), 0.24 * size, **look))


def draw_robot(axes: Axes, at: tuple[float, float], colour: str, size: float = 1.0) -> None:
    """A head with two eyes and an aerial at (x, y); `size` is the height in units of the axes."""
    from matplotlib.patches import Circle, FancyBboxPatch

    x, y = at
    side = 0.62 * size
    box = {"boxstyle": f"round,pad=0,rounding_size={0.14 * size}", "fc": colour, "ec": PAPER, "lw": 0.8}
    axes.plot([x, x], [y - side / 2, y - 0.55 * size], color=INK, lw=1.2, zorder=8)
    axes.add_patch(Circle((x, y - 0.58 * size), 0.07 * size, fc=INK, ec="none", zorder=9))
    axes.add_patch(FancyBboxPatch((x - side / 2, y - side / 2), side, side, zorder=9, **box))
    for eye in (-0.15, 0.15):
        axes.add_patch(Circle((x + eye * size, y - 0.06 * size), 0.07 * size, fc=PAPER, ec="none", zorder=10))
    axes.plot([x - 0.13 * size, x + 0.13 * size], [y + 0.15 * size] * 2, color=PAPER, lw=1.2, zorder=10)


def draw_note(axes: Axes, at: tuple[float, float], to: tuple[float, float], words: str, colour: str = INK) -> None:
    """Words in a box at `at`, with a line to the place `to` that they are about."""
    line = {"arrowstyle": "-", "color": colour, "lw": 0.9, "shrinkA": 0, "shrinkB": 3}
    box = {"boxstyle": "round,pad=0.35", "fc": PAPER, "ec": colour, "lw": 0.9, "alpha": 0.95}
    axes.annotate(
        words, to, at, ha="center", va="center", fontsize=8, color=INK, arrowprops=line, bbox=box, zorder=11,
        linespacing=1.3,
    )  # fmt: skip
