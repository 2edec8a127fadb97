"""Arrangements of books, boxes and cartons: staggered piles, ramps, rows of books, cartons on cartons.

They are the everyday scenes in which *on* and *both* look alike: an overhanging book hides the side of the book
below it, and a board against a pile touches it in one edge. Each is set down beside a single object now and then.
"""

from collections.abc import Callable

import numpy as np

from lifelore.domains.tabletop.groups import single
from lifelore.domains.tabletop.kits import Kit
from lifelore.domains.tabletop.layout import Group, Placed, middle, put_beside, stand, top
from lifelore.domains.tabletop.pose import about
from lifelore.domains.tabletop.settings import TabletopSettings
from lifelore.domains.tabletop.shapes import Shape

Generator = np.random.Generator
CLOSE = ((0.0005, 0.003), (0.003, 0.02), (0.02, 0.035))
"""Bands of gaps between neighbours, metres: touching, near, where *adjacent* ends."""


def place_pile(rng: Generator, kit: Kit, settings: TabletopSettings, wanted: str) -> Group:
    """A staggered pile of two to five books or boxes, and sometimes a second pile or an object beside it."""
    pile = _pile(rng, kit, int(rng.integers(2, 6)))
    if rng.random() < 0.3:
        return _turned(rng, [*pile, *_beside(rng, pile, _pile(rng, kit, int(rng.integers(1, 3))))])
    return _turned(rng, _with_single(rng, kit, pile))


def place_ramp(rng: Generator, kit: Kit, settings: TabletopSettings, wanted: str) -> Group:
    """A board from the table, or from a lower book, up to the edge of a pile; sometimes an object on the pile."""
    pile = _pile(rng, kit, int(rng.integers(2, 4)), offset=0.15)
    edge, height = float(pile[-1].outline()[:, 0].max()), top(pile)
    base, lower = 0.0, None
    if rng.random() < 0.3 and height > 0.06:
        lower = stand(_block(kit, rng.uniform((0.1, 0.1, 0.015), (0.16, 0.18, 0.03))))
        base = top([lower])
    length = (height - base) / np.sin(rng.uniform(np.radians(15), np.radians(65))) + rng.uniform(0.02, 0.08)
    length = float(np.clip(length, 0.12, 0.34))
    angle = float(np.arcsin(min((height - base) / length, 0.95)))
    board = _block(kit, np.array([length, rng.uniform(0.06, 0.2), rng.uniform(0.01, 0.035)]))
    ramp = stand(board, about(2, rng.normal(0, 0.1)) @ about(1, angle), base)
    points = ramp.outline()
    foot = float(points[points[:, 2].argmin(), 0])
    shift = edge + (height - base) / np.tan(angle) - foot + 0.002
    ramp = ramp.moved(shift, float(rng.uniform(-0.4, 0.4) * np.ptp(pile[-1].outline()[:, 1])))
    group = [*pile, ramp]
    if lower is not None:
        group.append(lower.moved(float(ramp.outline()[:, 0].max()) - 0.03, 0.0))
    if rng.random() < 0.3:
        x, y = middle(pile[-1:]) - [0.02, 0.0]
        group.append(stand(_small(rng, kit), about(2, rng.uniform(0, 6)), height).moved(float(x), float(y)))
    return _turned(rng, group)


def place_books(rng: Generator, kit: Kit, settings: TabletopSettings, wanted: str) -> Group:
    """A row of upright books whose last ones lean on it, perhaps one flat across the top."""
    count = int(rng.integers(1, 4))
    height, depth = rng.uniform((0.16, 0.11), (0.24, 0.18))
    row: Group = []
    for _ in range(count):
        thick = rng.uniform(0.025, 0.06)
        book = stand(_block(kit, np.array([thick, depth * rng.uniform(0.8, 1.0), height * rng.uniform(0.8, 1.0)])))
        row = [*row, *(put_beside(row, [book], float(rng.normal(0, 0.05)), _gap(rng, 0.7)) if row else [book])]
    flat = rng.random() < 0.35
    if flat:
        cover = _block(kit, np.array([rng.uniform(0.15, 0.22), rng.uniform(0.1, 0.16), rng.uniform(0.015, 0.05)]))
        x, y = middle(row) + rng.uniform(-0.02, 0.02, 2)
        row.append(stand(cover, about(2, rng.normal(0, 0.1)), top(row)).moved(float(x), float(y)))
    if not flat or rng.random() < 0.5:
        side = -1 if rng.random() < 0.5 else 1
        angle = rng.uniform(np.radians(8), np.radians(35))
        lean = stand(
            _block(
                kit, np.array([rng.uniform(0.012, 0.04), depth * rng.uniform(0.7, 1.0), rng.uniform(0.14, 0.24)])
            ),
            about(1, -side * angle),
        )
        row += _against(row, lean, side)
    return _turned(rng, _with_single(rng, kit, row, 0.2))


def place_cartons(rng: Generator, kit: Kit, settings: TabletopSettings, wanted: str) -> Group:
    """Two or three cartons side by side, and one or two more on them, often across the gap between two."""
    height = rng.uniform(0.05, 0.14)
    ground: Group = []
    for _ in range(int(rng.integers(2, 4))):
        level = height if rng.random() < 0.6 else height * rng.uniform(0.5, 1.2)
        carton = [stand(_block(kit, np.array([*rng.uniform((0.08, 0.07), (0.18, 0.15)), level])))]
        way = float(rng.normal(0, 0.1) + np.pi / 2 * rng.integers(2))
        ground = [*ground, *(put_beside(ground[-1:], carton, way, _gap(rng)) if ground else carton)]
    upper: Group = []
    for _ in range(int(rng.integers(1, 3))):
        size = rng.uniform((0.08, 0.06, 0.03), (0.18, 0.14, 0.1))
        across = rng.random() < 0.5
        pick = int(rng.integers(len(ground) - 1))
        below = ground[pick : pick + 2] if across else ground[pick : pick + 1]
        half = np.ptp(np.concatenate([item.outline()[:, :2] for item in below]), axis=0) / 2
        x, y = middle(below) + rng.uniform(-0.5, 0.5, 2) * half * (0.3 if across else 1.0)
        on = top([*below, *upper]) if upper else top(below)
        yaw = about(2, rng.normal(0, 0.15) + np.pi / 2 * rng.integers(2))
        upper.append(stand(_block(kit, size), yaw, on).moved(float(x), float(y)))
    return _turned(rng, [*ground, *upper])


Place = Callable[[Generator, Kit, TabletopSettings, str], Group]
"""Places objects by a kit, the settings and the wanted relation."""

PILES: dict[str, Place] = {
    "pile": place_pile,
    "ramp": place_ramp,
    "books": place_books,
    "cartons": place_cartons,
}
"""The arrangements by name."""


def _pile(rng: Generator, kit: Kit, count: int, offset: float = 0.4) -> Group:
    """Flat pieces on one another, each off the middle of the piece below by up to `offset` of its half sizes."""
    length, width = rng.uniform((0.13, 0.09), (0.26, 0.18))
    thick = rng.uniform(0.015, 0.09)
    pile: Group = []
    for _ in range(count):
        size = np.array([length, width, thick]) * rng.uniform((0.6, 0.6, 0.5), (1.1, 1.1, 1.4))
        piece = _block(kit, size)
        yaw = rng.normal(0, 0.2) if rng.random() < 0.7 else rng.uniform(0, np.pi)
        placed = stand(piece, about(2, yaw), top(pile[-1:]) if pile else 0.0)
        if pile:
            half = np.ptp(pile[-1].outline(), axis=0)[:2] / 2
            x, y = middle(pile[-1:]) + rng.uniform(-offset, offset, 2) * half * 1.6
            placed = placed.moved(float(x), float(y))
        pile.append(placed)
    return pile


def _against(row: Group, leaner: Placed, side: int) -> Group:
    """`leaner`, whose upper end points to the row, moved along x until its upper edge meets the row's end."""
    ends = np.concatenate([item.outline()[:, 0] for item in row])
    own = leaner.outline()
    shift = ends.max() - own[:, 0].min() if side > 0 else ends.min() - own[:, 0].max()
    return [leaner.moved(float(shift + side * 0.002), 0.0)]


def _with_single(rng: Generator, kit: Kit, group: Group, chance: float = 0.4) -> Group:
    return [*group, *_beside(rng, group, single(rng, kit))] if rng.random() < chance else group


def _beside(rng: Generator, group: Group, other: Group) -> Group:
    return put_beside(group, other, float(rng.uniform(0, 2 * np.pi)), _gap(rng))


def _gap(rng: Generator, touching: float = 0.4) -> float:
    """Metres between neighbours; `touching` is the chance of the closest band."""
    rest = (1 - touching) / 2
    return float(rng.uniform(*CLOSE[int(rng.choice(3, p=[touching, rest, rest]))]))


def _block(kit: Kit, size: np.ndarray) -> Shape:
    length, width, height = map(float, size)
    return kit.block(length, width, height).centred()


def _small(rng: Generator, kit: Kit) -> Shape:
    return _block(kit, rng.uniform((0.04, 0.04, 0.03), (0.09, 0.07, 0.08)))


def _turned(rng: Generator, group: Group) -> Group:
    yaw = float(rng.uniform(0, 2 * np.pi))
    return [item.turned(yaw) for item in group]
