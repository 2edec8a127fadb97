"""The gripper's scripted skills: pick, put aside, push apart, hand over; each moves bodies in the simulator.

A skill knows the true shapes and places, as a robot's own motion controller would. It asks no relation: it does
what was asked, and the physics decides what becomes of the other objects.
"""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lifelore.domains.tabletop.pose import Pose, about
from lifelore.domains.tabletop_job.gripper_tray import CHECK, CLEARANCE, EDGE, FINGER_LENGTH, STEP, GripperTray

APPROACH = 2.0
"""Seconds that the arm needs to come to the tray for a skill; no object moves meanwhile."""
CARRY_HEIGHT = 0.4
"""Metres to which the lowest point of a picked object is lifted."""
FOLD, FOLD_SECONDS = np.pi / 3, 0.7
"""The arm folds back with what it holds: radians by which the object turns about the line through the fingers."""
USER_SIDE = np.array([1.0, 0.0])
"""Where the user takes objects, metres from the tray's middle."""
PUSH_DISTANCE, PUSH_SPEED = 0.06, 0.04
"""Metres, m/s."""
PUSH_SECONDS = PUSH_DISTANCE / PUSH_SPEED
_DESCENT, _LIFT, _CARRY = (0.4, 3.0), (0.4, 1.0), (0.6, 3.0)
"""Speed (m/s) and acceleration (m/s²) of the fingers ; of objects lifted or lowered; of objects put aside."""
MANNERS = {"gentle": (0.4, 1.5), "brisk": (1.2, 10.0)}
"""Speed (m/s) and acceleration (m/s²) of a hand-over."""


@dataclass(frozen=True)
class Outcome:
    """What a skill reports: seconds of the arm's motion, whether the fingers got around the object, whether the
    object slipped out of them, and the object handed over."""

    seconds: float
    reached: bool = True
    slipped: bool = False
    handed: int | None = None


def pick(tray: GripperTray, number: int) -> Outcome:
    """Descend with both fingers beside an object, lift it and fold back; the object stays in the hand."""
    began = tray.time
    centres, rotation = finger_places(tray, number)
    tray.spare(number)
    if not _descend(tray, centres, rotation):
        tray.spare(None)
        seconds = APPROACH + tray.time - began
        tray.withdraw()
        tray.rest()
        return Outcome(seconds, reached=False)
    tray.grasp(number, centres, rotation)
    start = tray.hand()
    rise = max(0.0, CARRY_HEIGHT - float(tray.outline(number)[:, 2].min()))
    held = tray.follow(*_straight(start, np.array([0.0, 0.0, rise]), *_LIFT))
    held = held and tray.follow(*_turning(tray, rotation[:, 0], FOLD))
    return _finish(tray, began, held)


def put_aside(tray: GripperTray) -> Outcome:
    """Set the held object down on a free place of the table, the way it stood."""
    assert tray.grip is not None
    began, number = tray.time, tray.grip.object
    hand = tray.hand()
    way = np.append(free_place(tray, number) - hand.position[:2], 0.0)
    held = tray.follow(*_straight(hand, way, *_CARRY))
    if held:
        axis = tray.hand().rotation @ tray.grip.rotation[:, 0]
        held = tray.follow(*_turning(tray, axis, -FOLD))
    if held:
        fall = 0.001 - float(tray.outline(number)[:, 2].min())
        held = tray.follow(*_straight(tray.hand(), np.array([0.0, 0.0, fall]), *_LIFT))
    if held:
        tray.release()
    return _finish(tray, began, held)


def hand_over(tray: GripperTray, manner: str) -> Outcome:
    """Carry the held object to the user, ``"gentle"`` or ``"brisk"``."""
    assert tray.grip is not None
    began, number = tray.time, tray.grip.object
    hand = tray.hand()
    held = tray.follow(*_straight(hand, np.append(USER_SIDE - hand.position[:2], 0.0), *MANNERS[manner]))
    if held:
        tray.remove(number)
    return _finish(tray, began, held, number if held else None)


def push_apart(tray: GripperTray, number: int) -> Outcome:
    """Push an object along the table away from its nearest neighbour, by `PUSH_DISTANCE` at most.

    The push is a force on the object's middle of at most the gripper's strength; no finger is simulated.
    """
    began = tray.time
    way, mass = away_from_neighbour(tray, number), tray.weights[number] / 9.81
    start = tray.centres[number]
    steps = round(PUSH_SECONDS / STEP)
    for k in range(steps):
        wanted = start + way * PUSH_SPEED * STEP * (k + 1)
        error = (wanted - tray.centres[number]) * [1, 1, 0]
        lag = (PUSH_SPEED * way - tray.velocity(number)) * [1, 1, 0]
        # A spring of 5 Hz, critically damped, and the friction that it has to overcome.
        force = mass * (1000 * error + 63 * lag + 0.7 * 9.81 * way)
        tray.push(number, force * min(1.0, tray.gripper.strength / max(float(np.linalg.norm(force)), 1e-9)))
        tray.step()
    tray.push(number, np.zeros(3))
    return _finish(tray, began, True)


def _finish(tray: GripperTray, began: float, held: bool, handed: int | None = None) -> Outcome:
    """Seconds of motion, then rest; the fingers go where nothing is held."""
    seconds = APPROACH + tray.time - began
    if tray.grip is None:
        tray.withdraw()
    tray.rest()
    return Outcome(seconds, True, not held, handed)


def finger_places(tray: GripperTray, number: int) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Middles of the fingers ``(2, 3)`` at an object's narrowest side, and their rotation; x joins them.

    The tips are 1 cm above the object's lowest point, or 6 cm below its highest, whichever is higher.
    """
    outline = tray.outline(number)
    angles = np.linspace(0, np.pi, 36, endpoint=False)
    spans = outline[:, :2] @ np.stack([np.cos(angles), np.sin(angles)])
    best = int(np.ptp(spans, axis=0).argmin())
    rotation = about(2, float(angles[best]))
    across = (outline @ rotation[:, 1]).min() / 2 + (outline @ rotation[:, 1]).max() / 2
    tip = max(outline[:, 2].min() + 0.01, outline[:, 2].max() - 0.06)
    beyond = CLEARANCE + tray.gripper.thickness / 2
    along = np.array([spans[:, best].min() - beyond, spans[:, best].max() + beyond])
    height = tip + FINGER_LENGTH / 2
    places = along[:, None] * rotation[:, 0] + across * rotation[:, 1] + [0, 0, height]
    return places, rotation


def _descend(tray: GripperTray, centres: NDArray[np.float64], rotation: NDArray[np.float64]) -> bool:
    """Lower the fingers from above all objects; False where something stops them."""
    top = max(float(tray.outline(k)[:, 2].max()) for k in tray.here)
    height = max(0.01, top + 0.01 - float(centres[0, 2] - FINGER_LENGTH / 2))
    fall, seconds = _profile(height, *_DESCENT)
    for k in range(1, round(seconds / STEP) + 1):
        tray.place_fingers(centres + np.array([0, 0, height - fall(k * STEP)]), rotation)
        tray.step()
        if k % CHECK == 0 and tray.blocked():
            return False
    tray.place_fingers(centres, rotation)
    return True


def free_place(tray: GripperTray, number: int) -> NDArray[np.float64]:
    """Where the middle (x, y) of a held object finds room on the table, nearest to the tray's middle first."""
    hand = tray.hand()
    reach = _radius(tray.outline(number), hand.position[:2]) + 0.04
    others = [k for k in tray.here if k != number]
    centres = np.array([tray.outline(k)[:, :2].mean(axis=0) for k in others]).reshape(-1, 2)
    radii = np.array([_radius(tray.outline(k), c) for k, c in zip(others, centres, strict=True)])
    best, best_room = np.zeros(2), -np.inf
    for distance in np.arange(0.1, EDGE - 0.1, 0.05):
        for angle in np.linspace(0, 2 * np.pi, 24, endpoint=False):
            place = distance * np.array([np.cos(angle), np.sin(angle)])
            room = float((np.linalg.norm(centres - place, axis=1) - radii - reach).min(initial=1.0))
            if room > 0:
                return place
            if room > best_room:
                best, best_room = place, room
    return best


def _radius(outline: NDArray[np.float64], middle: NDArray[np.float64]) -> float:
    return float(np.linalg.norm(outline[:, :2] - middle, axis=1).max())


def away_from_neighbour(tray: GripperTray, number: int) -> NDArray[np.float64]:
    """Horizontal unit vector ``(3,)`` from the nearest other object that is not straight above or below."""
    nearest, way = 0.5, np.zeros(3)
    for other in tray.here:
        if other != number:
            distance, along = tray.distance(other, number, nearest)
            if distance >= nearest or abs(along[2]) > np.hypot(along[0], along[1]):
                continue
            nearest, way = distance, along
    if np.hypot(way[0], way[1]) < 1e-6:
        others = [k for k in tray.here if k != number]
        centres = tray.centres
        way = centres[number] - (centres[others].mean(axis=0) if others else 0.0)
    way = way * [1, 1, 0]
    length = float(np.linalg.norm(way))
    return way / length if length > 1e-9 else np.array([1.0, 0.0, 0.0])


def _straight(start: Pose, way: NDArray[np.float64], speed: float, acceleration: float):
    """A straight path and its duration."""
    length = float(np.linalg.norm(way))
    along, seconds = _profile(length, speed, acceleration)
    unit = way / max(length, 1e-9)
    return (lambda t: start.moved(unit * along(t))), seconds


def _turning(tray: GripperTray, axis: NDArray[np.float64], angle: float):
    """A turn of the hand about its own middle, smooth at both ends."""
    start = tray.hand()

    def path(t: float) -> Pose:
        s = t / FOLD_SECONDS
        turn = _about(axis, angle * s**3 * (10 - 15 * s + 6 * s**2))
        return Pose(start.position, turn @ start.rotation)

    return path, FOLD_SECONDS


def _profile(length: float, speed: float, acceleration: float):
    """Distance as a function of time under limits of speed and acceleration, and the duration."""
    speed = min(speed, float(np.sqrt(length * acceleration)))
    ramp = speed / acceleration
    seconds = length / speed + ramp if length > 0 else 0.0

    def distance(t: float) -> float:
        if t < ramp:
            return acceleration * t**2 / 2
        if t < seconds - ramp:
            return speed * (t - ramp / 2)
        return length - acceleration * max(seconds - t, 0.0) ** 2 / 2

    return distance, seconds


def least_seconds(tray: GripperTray, number: int, manner: str) -> tuple[float, float]:
    """Least seconds to pick an object from where it is, and to hand it over after that."""
    rise = max(0.0, CARRY_HEIGHT - float(tray.outline(number)[:, 2].min()))
    far = max(0.0, float(np.linalg.norm(USER_SIDE - tray.centres[number, :2])))
    lift, carry = _profile(rise, *_LIFT)[1], _profile(far, *MANNERS[manner])[1]
    return APPROACH + lift + FOLD_SECONDS, APPROACH + carry


def slips_in(tray: GripperTray, manner: str) -> bool:
    """Whether the gripper cannot accelerate any object as a manner of handing over asks for."""
    return float(np.hypot(1.0, MANNERS[manner][1] / 9.81)) > tray.gripper.grip


def _about(axis: NDArray[np.float64], angle: float) -> NDArray[np.float64]:
    """Rotation about a unit vector (Rodrigues)."""
    x, y, z = axis / np.linalg.norm(axis)
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross
