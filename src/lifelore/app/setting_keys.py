"""Settings by key, for ``--set KEY=VALUE`` and ``--settings``.

The keys, types and defaults are those of the parameters of settings classes, or of functions; a key's meaning is
the first sentence on its parameter in their docstrings. A parameter whose type is a dataclass is a group, whose
fields are keys too. A parameter that is no text, number or truth value, such as a callback, is no setting.
"""

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, is_dataclass
from difflib import get_close_matches
from functools import cached_property
from inspect import Parameter, getdoc
from typing import Any, get_args

from lifelore.app.console import print_json
from lifelore.core.errors import InputError
from lifelore.core.keyed_settings import arguments_by_key, typed_parameters

TYPES = {bool: "true/false", int: "whole number", float: "number", str: "text"}
MOST_NEAR = 3
"""Number of keys, at most, that are proposed for a wrong one."""


@dataclass(frozen=True)
class Setting:
    """A setting by its key.

    kind : the type of its value, a key of `TYPES`
    meaning : a sentence
    default : None where the default depends on other settings
    choices : the values that its class names, if it names them
    """

    key: str
    kind: type
    meaning: str
    default: Any = None
    choices: tuple[str, ...] = ()

    def value(self, text: str) -> Any:
        """The value that a user wrote.

        Raises
        ------
        InputError
            The text is no such value.
        """
        rule = {bool: "true or false", int: "a whole number", float: "a number"}.get(self.kind, "")
        try:
            return {"true": True, "false": False}[text] if self.kind is bool else self.kind(text)
        except (KeyError, ValueError):
            raise InputError(f"{self.key} must be {rule}, got '{text}'") from None


@dataclass(frozen=True)
class SettingKeys:
    """The settings of a verb by key.

    Parameters
    ----------
    source : callable
        A frozen dataclass, or a function.
    names : mapping
        Name of a parameter to its key, where they differ.
    elsewhere : mapping
        Key to the words that follow it in a refusal: settings that the verb does not take by ``--set``.
    """

    source: Callable
    names: Mapping[str, str] = field(default_factory=dict)
    elsewhere: Mapping[str, str] = field(default_factory=dict)

    @cached_property
    def settings(self) -> dict[str, Setting]:
        """The settings that ``--set`` takes, by key."""
        return {one.key: one for one in self._settings_of(self.source) if one.key not in self.elsewhere}

    def read(self, texts: Sequence[str]) -> dict[str, Any]:
        """The values of texts ``KEY=VALUE`` by key; of one key, the last.

        Raises
        ------
        InputError
            A text has no ``=``, a key is unknown, or a value is not of its type.
        """
        return dict(self._pair(text) for text in texts)

    def arguments(self, values: Mapping[str, Any]) -> dict[str, Any]:
        """The arguments of the source, with its groups, that values by key give; other keys are left out."""
        return arguments_by_key(self.source, values, self.names)

    def show(self, as_json: bool) -> None:
        """Print each setting with its type, default and meaning."""
        rows = [
            {
                "key": one.key,
                "type": TYPES[one.kind],
                "default": one.default,
                "meaning": one.meaning,
                "choices": one.choices,
            }
            for one in self.settings.values()
        ]
        if as_json:
            print_json({"settings": rows})
            return
        print(f"{'KEY':<14} {'TYPE':<12} {'DEFAULT':<12} MEANING")
        for row in rows:
            default = "" if row["default"] is None else str(row["default"]).lower()
            choices = f" ({'|'.join(row['choices'])})" if row["choices"] else ""
            print(f"{row['key']:<14} {row['type']:<12} {default:<12} {row['meaning']}{choices}")

    def _key(self, part: Parameter) -> str:
        return self.names.get(part.name, part.name)

    def _settings_of(self, source: Callable) -> Iterator[Setting]:
        entries = _documented(source)
        for part, hint in typed_parameters(source):
            kind = next((one for one in TYPES if one in (hint, *get_args(hint))), None)
            if is_dataclass(hint):
                yield from self._settings_of(hint)  # type: ignore[arg-type]
            elif kind is not None:
                types, meaning = entries.get(part.name, ("", ""))
                choices = tuple(re.findall(r'"([\w-]+)"', types))
                default = None if part.default is Parameter.empty else part.default
                yield Setting(self._key(part), kind, meaning, default, choices)

    def _pair(self, text: str) -> tuple[str, Any]:
        key, equals, value = text.partition("=")
        if not equals:
            raise InputError(f"--set takes KEY=VALUE, got '{text}'; --settings lists the keys")
        if key in self.elsewhere:
            raise InputError(f"{key} {self.elsewhere[key]}")
        if key not in self.settings:
            near = get_close_matches(key, self.settings, MOST_NEAR)
            hint = f"; near: {', '.join(near)}" if near else ""
            raise InputError(f"no setting has the key '{key}'{hint}; --settings lists all")
        return key, self.settings[key].value(value)


def _documented(source: Callable) -> dict[str, tuple[str, str]]:
    """Type and first sentence of each entry below *Parameters* in a docstring."""
    section = (getdoc(source) or "").partition("Parameters\n----------\n")[2].partition("\n\n")[0]
    entries = re.findall(r"^(\w+) : (.*)\n((?:    .*\n?)*)", section, re.MULTILINE)
    return {name: (types, _first_sentence(" ".join(text.split()))) for name, types, text in entries}


def _first_sentence(text: str) -> str:
    return re.split(r"(?<=\.) ", text.replace("`", ""), maxsplit=1)[0]
