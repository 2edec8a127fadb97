"""Checks of a new cloud: units are metres, and stray points are removed."""

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from lifelore.core.errors import InputError
from lifelore.perception.clouds.point_cloud import PointCloud, finite_rows

UNITS = {"m": 1.0, "cm": 0.01, "mm": 0.001, "inch": 0.0254}
"""Metres of a unit."""
MAX_SPAN = 20.0
"""Metres. No table-top scene, and no room a depth camera sees, is wider; 20 mm in millimetres is."""
USUAL_SPAN = 1.0
"""Metres: width of a table that a depth camera sees; the unit that comes nearest to it is the likely one."""
MIN_SPAN = 0.002
"""Metres. A cloud narrower than this after ``units=mm`` was in metres before."""
STRAY = 50.0
"""Metres from the median point; points beyond it are faults of the sensor or the file."""
FAR = 1e8
"""Metres from the origin of the frame; double numbers resolve a voxel up to here, and no map is larger."""
_SAMPLE = 100_000


def in_metres(cloud: PointCloud, units: str = "m") -> PointCloud:
    """The cloud in metres, without points that are not finite or stray.

    Rule: the widest axis, measured over the middle 98 % of the points, must not pass `MAX_SPAN`; under
    ``units="mm"`` it must reach `MIN_SPAN` unless all points agree. Points that are dropped become NaN, so
    that an organised cloud stays organised.

    Raises
    ------
    InputError
        Unknown units, no finite point, a width that suggests other units, or beyond `FAR`.
    """
    check_units(units)
    points = cloud.points if units == "m" else cloud.points * cloud.points.dtype.type(UNITS[units])
    measured = finite_rows(points)
    if not measured.any():
        raise InputError(f"holds no finite point among {len(points)}")
    sample = points[measured] if len(points) <= _SAMPLE else _sample(points, measured)
    low, middle, high = np.percentile(sample, (1, 50, 99), axis=0)
    _check_span(float(np.max(high - low)), units)
    if np.abs(middle).max() > FAR:
        raise InputError(
            f"lies {np.abs(middle).max():.3g} m from its origin, too far to resolve millimetres; move it there"
        )
    if points is cloud.points:
        points = points.copy()
    for axis in range(3):
        measured &= np.abs(points[:, axis] - middle[axis].astype(points.dtype)) <= STRAY
    points[~measured] = np.nan
    camera = None if cloud.camera is None else cloud.camera * UNITS[units]
    return replace(cloud, points=points, camera=camera)


def check_units(units: str) -> None:
    """Raise InputError for unknown units."""
    if units not in UNITS:
        raise InputError(f"units must be m, cm, mm or inch, got {units!r}")


def unit_hint(span: float) -> str:
    """What to do about a scene whose width, `span` metres, makes other units likely."""
    if span > USUAL_SPAN:
        return f"if its numbers are inches, pass --units inch ({span * UNITS['inch']:.2g} m wide)"
    cm, inch = (span * UNITS[unit] / UNITS["mm"] for unit in ("cm", "inch"))
    choice = f"--units cm ({cm:.2g} m wide) or --units inch ({inch:.2g} m)"
    return f"if numbers in cm or inch were read as mm, pass {choice}"


def _sample(points: NDArray[np.floating], measured: NDArray[np.bool_]) -> NDArray[np.floating]:
    places = np.flatnonzero(measured)
    return points[places[:: max(1, len(places) // _SAMPLE)]]


def _check_span(span: float, units: str) -> None:
    if span > MAX_SPAN and units == "m":
        widths = {unit: span * size for unit, size in UNITS.items() if unit != "m"}
        likely = min(widths, key=lambda unit: abs(np.log(widths[unit] / USUAL_SPAN)))
        each = ", ".join(f"{width:.2g} m in {unit}" for unit, width in widths.items())
        raise InputError(
            f"looks like {likely}: the cloud spans {span:,.0f} m where at most {MAX_SPAN:.0f} m are read (it would"
            f" be {each}); pass units={likely} (--units {likely}), or crop the cloud"
        )
    if span > MAX_SPAN:
        raise InputError(f"spans {span:,.0f} m in {units} where at most {MAX_SPAN:.0f} m are read; crop the cloud")
    if units == "mm" and 0 < span < MIN_SPAN:
        raise InputError(f"spans {span * 1000:.3g} mm in mm, so it is in metres already; pass units=m (--units m)")
