"""`ContactSettings`: lengths and costs of the search for contacts, in metres and independent of resolution."""

from dataclasses import dataclass

from lifelore.core.errors import InputError


@dataclass(frozen=True)
class ContactSettings:
    """Settings of near pairs, separators and contact points.

    Parameters
    ----------
    voxel : float
        Side of the voxels that the cloud is thinned to, metres; 0 does not thin. Thinning makes a cost per point
        independent of the sensor's resolution.
    near : float
        Largest visible gap of a near pair, metres. True contacts can look 36 mm apart
        (95th percentile; 72 mm where one object leans), because hidden faces have no points.
    length, cost : float
        Kernel length (metres) and cost per point at 3 mm spacing of the separator that contact points come from.
    wide_length, wide_cost : float
        The same for the second, wider separator, which adds features.
    linkage : float
        Support vectors closer than this belong to one contact, metres.
    min_support : float
        Smaller contacts are dropped, in support vectors at 3 mm spacing (thesis §2.3.4 drops below 7); the
        largest contact is never dropped.
    table_margin : float
        Width of the strip of table around an object in the pair (object, table), metres.
    as_printed : bool
        Contact points as the thesis prints them, see `of_thesis`.

    Raises
    ------
    InputError
        A length or cost that is not positive (`voxel` and `min_support` may be 0).

    Examples
    --------
    >>> ContactSettings().min_support, ContactSettings.of_thesis().as_printed
    (7.0, True)
    """

    voxel: float = 0.003
    near: float = 0.08
    length: float = 0.06
    cost: float = 10.0
    wide_length: float = 0.12
    wide_cost: float = 1.0
    linkage: float = 0.025
    min_support: float = 7.0
    table_margin: float = 0.04
    as_printed: bool = False

    @classmethod
    def of_thesis(cls) -> "ContactSettings":
        """The settings of the thesis's own form (§2.3.4).

        All points count (``voxel`` is 0). The support vectors of each object are clustered alone, every cluster of
        fewer than 7 is discarded, and a contact point is the plain mean of its support vectors.

        The default differs in five ways: the cloud is thinned to 3 mm; the support vectors of both objects take
        part in clustering; the threshold is scaled to the density of points; the strongest contact always stays;
        and support vectors are weighted by their multipliers α. The thesis gives no kernel length, no cost and no
        clustering method: these are the same in both.
        """
        return cls(voxel=0.0, as_printed=True)

    def __post_init__(self) -> None:
        for name, value in vars(self).items():
            if name != "as_printed" and not (value > 0 or (value == 0 and name in ("voxel", "min_support"))):
                raise InputError(f"{name} must be above 0, got {value!r}")

    @property
    def scales(self) -> tuple[tuple[float, float], ...]:
        """(length, cost) of each separator, the one of the contact points first."""
        return (self.length, self.cost), (self.wide_length, self.wide_cost)
