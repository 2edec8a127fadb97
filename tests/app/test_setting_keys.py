"""Settings by key: what classes say of their fields, what a text becomes, and which line refuses it."""

from collections.abc import Callable
from dataclasses import dataclass, field

import pytest

from lifelore.app.setting_keys import Setting, SettingKeys
from lifelore.core.errors import InputError


@dataclass(frozen=True)
class Wheels:
    """The wheels.

    Parameters
    ----------
    number : int
        Number of wheels. More cost more.
    radius : float, optional
        Radius in metres; 0.5 where there are three. It is measured
        with the tyre.
    """

    number: int = 4
    radius: float | None = None


@dataclass(frozen=True)
class Cart:
    """A cart.

    Parameters
    ----------
    owner : str
        Name of the owner.
    kind : {"hand", "horse"}
        What draws it, see
        `Horse`.
    wheels : Wheels
    open : bool
        Whether it has no roof.

    Raises
    ------
    InputError
        open : never.
    """

    owner: str
    kind: str = "hand"
    wheels: Wheels = field(default_factory=Wheels)
    open: bool = True


KEYS = SettingKeys(Cart, {"kind": "drawn_by"}, {"owner": "is an option: --owner"})


def test_classes_name_keys_types_defaults_and_meanings():
    assert list(KEYS.settings.values()) == [
        Setting("drawn_by", str, "What draws it, see Horse.", "hand", ("hand", "horse")),
        Setting("number", int, "Number of wheels.", 4),
        Setting("radius", float, "Radius in metres; 0.5 where there are three."),
        Setting("open", bool, "Whether it has no roof.", True),
    ]


def test_values_become_an_object_with_its_groups():
    texts = ["radius=0.25", "open=false", "drawn_by=a = b", "number=3", "number=2"]
    values = KEYS.read(texts)
    assert values == {"radius": 0.25, "open": False, "drawn_by": "a = b", "number": 2}
    built = Cart(**KEYS.arguments({"owner": "eve"} | values))
    assert built == Cart("eve", "a = b", Wheels(2, 0.25), False)
    assert Cart(**KEYS.arguments({"owner": "eve"})) == Cart("eve")


def test_a_function_has_settings_too():
    def drive(cart: Cart | str, *, miles: float = 1, wheels: Wheels, watch: Callable[[int], None] | None = None):
        """Drive.

        Parameters
        ----------
        cart : Cart or str
            The cart, or a name.
        miles : float
            Way in miles.
        watch : callable, optional
            Called after each mile.
        """

    keys = SettingKeys(drive, {"cart": "name"})
    assert list(keys.settings.values()) == [
        Setting("name", str, "The cart, or a name."),
        Setting("miles", float, "Way in miles.", 1),
        Setting("number", int, "Number of wheels.", 4),
        Setting("radius", float, "Radius in metres; 0.5 where there are three."),
    ]
    values = keys.read(["name=red", "number=3"])
    assert keys.arguments(values) == {"cart": "red", "wheels": Wheels(3)}


@pytest.mark.parametrize(
    ("text", "line"),
    [
        ("number", "--set takes KEY=VALUE, got 'number'; --settings lists the keys"),
        ("nubmer=1", "no setting has the key 'nubmer'; near: number; --settings lists all"),
        ("=1", "no setting has the key ''; --settings lists all"),
        ("zzz=1", "no setting has the key 'zzz'; --settings lists all"),
        ("kind=hand", "no setting has the key 'kind'; --settings lists all"),
        ("owner=bob", "owner is an option: --owner"),
        ("number=1.5", "number must be a whole number, got '1.5'"),
        ("radius=wide", "radius must be a number, got 'wide'"),
        ("open=yes", "open must be true or false, got 'yes'"),
    ],
)
def test_a_wrong_key_or_value_is_one_line(text, line):
    with pytest.raises(InputError) as refused:
        KEYS.read(["radius=1", text])
    assert str(refused.value) == line


def test_they_are_listed_for_a_person(capsys):
    KEYS.show(as_json=False)
    assert capsys.readouterr().out.splitlines() == [
        "KEY            TYPE         DEFAULT      MEANING",
        "drawn_by       text         hand         What draws it, see Horse. (hand|horse)",
        "number         whole number 4            Number of wheels.",
        "radius         number                    Radius in metres; 0.5 where there are three.",
        "open           true/false   true         Whether it has no roof.",
    ]
