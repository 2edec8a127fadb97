"""Arguments with groups from flat keys."""

from dataclasses import dataclass, field

from lifelore.core.keyed_settings import arguments_by_key, keys_of


@dataclass(frozen=True)
class Engine:
    """A group."""

    power: float = 1.0
    kind: str = "petrol"


@dataclass(frozen=True)
class Car:
    """A group in a group's owner."""

    seats: int = 4
    engine: Engine = field(default_factory=Engine)


NAMES = {"kind": "fuel"}


def test_groups_take_their_keys():
    assert list(keys_of(Car, NAMES)) == ["seats", "power", "fuel"]
    car = Car(**arguments_by_key(Car, {"seats": 2, "fuel": "none", "colour": "red"}, NAMES))
    assert car == Car(2, Engine(1.0, "none"))
