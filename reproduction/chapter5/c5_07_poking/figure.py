"""A scene of each kind: true objects, segments before the pushes, and objects after them."""

from collections.abc import Mapping

from lifelore.figures.scenes.segmentation_panels import draw_segmentations
from reproduction.chapter5.c5_07_poking.run import unpacked

COLUMNS = ("true objects", "local convexity", "after pushes")


def draw(result: Mapping):
    """The figure from the result."""
    pictures = []
    for row in result["rows"]:
        truth, clouds = unpacked(row)
        name = f"{row['example']}\n{_gain(result['measured'], row['example'])}"
        pictures.append((name, truth, dict(zip(COLUMNS, clouds, strict=True))))
    return draw_segmentations(pictures)


def _gain(measured: Mapping, kind: str) -> str:
    """Shares of objects found, such as ``found 45 → 68 %``."""
    before, after = (measured[f"found_{when}_{kind}"]["value"] for when in ("before", "after"))
    return f"found {100 * before:.0f} → {100 * after:.0f} %"
