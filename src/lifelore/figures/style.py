"""The house style: one look for every figure, one colour for every agent and method, wherever it appears.

Figures are made without pyplot, so nothing global is left behind and any thread may draw:

    with house_style():
        figure = new_figure(6, 4)
        axes = figure.subplots()
        …
    save_figure(figure, "figure.png")
"""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, Any

from lifelore.core.atomic_write import refused_writes, write_file
from lifelore.core.errors import NotFoundError, StoreError

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure, SubFigure
else:
    # Annotations of modules that draw: matplotlib is loaded when something is drawn, and not before.
    Axes = Figure = SubFigure = Any

MAX_BYTES = 300_000
"""Largest PNG that `save_figure` writes: figures are committed."""
_DPI = (180, 140, 100, 70)

INK, GREY, LIGHT, PAPER = "#22262b", "#7a828c", "#dfe3e8", "#ffffff"
WALL = "#59616b"
BLUE, ORANGE, GREEN, VERMILION = "#0072b2", "#e69f00", "#009e73", "#d55e00"
PURPLE, SKY, YELLOW = "#a3478a", "#56b4e9", "#d9c400"

COLOURS = {
    # agents of a life
    "lore": BLUE,
    "prior": ORANGE,
    "model": GREEN,
    "scratch": GREY,
    "undirected": VERMILION,
    "rmax": PURPLE,
    "frontier": SKY,
    "map only": GREY,
    # learners of the thesis
    "q-learning": GREY,
    "eps-QSAP": BLUE,
    "eps-QSAP, ties by prior": VERMILION,
    "eps-QPAP": GREEN,
    "optimal": INK,
    # makes of a prior in the factory
    "expert": GREEN,
    "incorrect": VERMILION,
    "global": BLUE,
    "left": SKY,
    "listed": PURPLE,
    "phase": ORANGE,
    # sets of features in the modified factory
    "phi1": ORANGE,
    "phi2": GREEN,
    "phi3": BLUE,
    "phi4": PURPLE,
}
"""Colour by agent or method, distinguishable with every common colour blindness (after Okabe and Ito)."""

_PARAMETERS = {
    "figure.facecolor": PAPER,
    "figure.titlesize": 12,
    "figure.titleweight": "bold",
    "font.family": "DejaVu Sans",
    "font.size": 9,
    "text.color": INK,
    "axes.edgecolor": GREY,
    "axes.labelcolor": INK,
    "axes.labelsize": 9,
    "axes.linewidth": 0.8,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.titlesize": 10,
    "axes.titleweight": "bold",
    "axes.titlelocation": "left",
    "axes.titlepad": 8,
    "axes.axisbelow": True,
    "axes.grid": False,
    "grid.color": LIGHT,
    "grid.linewidth": 0.7,
    "xtick.color": GREY,
    "ytick.color": GREY,
    "xtick.labelcolor": INK,
    "ytick.labelcolor": INK,
    "xtick.labelsize": 8,
    "ytick.labelsize": 8,
    "lines.linewidth": 1.8,
    "lines.solid_capstyle": "round",
    "legend.frameon": False,
    "legend.fontsize": 8,
    "savefig.facecolor": PAPER,
}


WIDTHS = {"scratch": 3.6, "lore": 2.4, "map only": 3.0, "listed": 3.0}


def colour_of(name: str) -> str:
    """The fixed colour of an agent or method."""
    if name not in COLOURS:
        raise NotFoundError(f"no colour for '{name}'; add it to figures/style.py, beside {', '.join(COLOURS)}")
    return COLOURS[name]


def width_of(name: str) -> float:
    """The fixed width of an agent's line, in points; drawn thick below thin, lines that coincide are all seen."""
    return WIDTHS.get(name, 1.5)


@contextmanager
def house_style() -> Iterator[None]:
    """Context in which figures have the house style; the former settings return at its end.

    Examples
    --------
    >>> with house_style():
    ...     figure = new_figure(4, 2)
    """
    import matplotlib

    with matplotlib.rc_context(_PARAMETERS):  # type: ignore[arg-type]
        yield


def new_figure(width: float, height: float) -> Figure:
    """An empty figure, `width` × `height` inches, whose parts arrange themselves.

    Examples
    --------
    >>> figure = new_figure(4, 2)
    >>> figure.subplots().set_title("steps by task").get_text()
    'steps by task'
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure(figsize=(width, height), layout="constrained")
    FigureCanvasAgg(figure)
    return figure


def save_figure(figure: Figure, path: str | Path) -> Path:
    """Write a PNG of at most `MAX_BYTES` in one step, in fewer colours or coarser if need be; returns its path.

    Raises
    ------
    StoreError
        The disk refuses, or the picture is too rich for the limit at any resolution.

    Examples
    --------
    >>> from tempfile import TemporaryDirectory
    >>> with TemporaryDirectory() as folder:
    ...     save_figure(new_figure(2, 1), f"{folder}/empty.png").name
    'empty.png'
    """
    path = Path(path)
    image = _small_enough(figure, path)
    with refused_writes(path, "the picture"):
        path.parent.mkdir(parents=True, exist_ok=True)
        write_file(path, image, "the picture")
    return path


def _small_enough(figure: Figure, path: Path) -> bytes:
    """The PNG in full colour if the limit allows, else in 256 colours, else coarser."""
    from io import BytesIO

    from PIL import Image

    for dpi in _DPI:
        full = BytesIO()
        with house_style():
            # No software name inside: the same figure gives the same bytes.
            figure.savefig(full, format="png", dpi=dpi, metadata={"Software": None})
        if full.tell() <= MAX_BYTES:
            return full.getvalue()
        few = BytesIO()
        Image.open(full).convert("RGB").quantize(256).save(few, format="png", optimize=True)
        if few.tell() <= MAX_BYTES:
            return few.getvalue()
    raise StoreError(f"{path.name} exceeds {MAX_BYTES} bytes at {_DPI[-1]} dots per inch; draw a smaller figure")
