"""Relations of the two parts of an object that was cut, by the tilt of the cut, with a picture of each kind."""

from collections import Counter
from collections.abc import Mapping

from lifelore.figures.gallery import gallery_above
from lifelore.figures.stacked_bars import draw_stacked_bars
from lifelore.figures.style import BLUE, GREY, LIGHT, ORANGE, PURPLE, VERMILION, house_style
from reproduction.chapter2.scenes.scene_example import examples_of

COLOURS = {"on": BLUE, "both": PURPLE, "adjacent": ORANGE, "none": GREY, "turned": VERMILION}
"""Colour by relation; *turned*, the lower part on the upper, is shown where it occurs."""
CAPTIONS = {kind: f"{kind} cut" for kind in ("level", "oblique", "upright")}


def draw(result: Mapping):
    counts = [row for row in result["rows"] if "cut" in row]
    cuts = sorted({row["cut"] for row in counts}, key=_tilt)
    sets = [name for name in ("simulated", "real") if any(row["set"] == name for row in counts)]
    examples = examples_of(result, CAPTIONS)
    figure, below = gallery_above(examples, 0.3 * len(cuts) + 1.0, layers=("cloud", "relations"))
    with house_style():
        turned = any(row["said"].endswith("turned") and row["cuts"] for row in counts)
        colours = {name: colour for name, colour in COLOURS.items() if turned or name != "turned"}
        every = below.subplots(1, len(sets), squeeze=False, sharey=True)[0]
        for axes, name in zip(every, sets, strict=True):
            found = Counter()
            for row in counts:
                relation = "turned" if row["said"].endswith("turned") else row["said"]
                found[row["set"], row["cut"], relation] += row["cuts"]
            parts = {relation: [found[name, cut, relation] for cut in cuts] for relation in colours}
            n = sum(map(sum, parts.values()))
            draw_stacked_bars(
                axes, cuts, parts, colours, shares=True, totals=True, title=f"{name} ({n:,} cuts)",
                label="share of cuts (%)",
            )  # fmt: skip
            axes.grid(axis="x", color=LIGHT)
        below.legend(*every[0].get_legend_handles_labels(), loc="outside lower center", ncols=len(colours))
    return figure


def _tilt(cut: str) -> float:
    """Order of the cuts: level, oblique by tilt, upright."""
    named = {"level": 0.0, "upright": 90.0}
    return named[cut] if cut in named else float(cut.partition("°")[0])
