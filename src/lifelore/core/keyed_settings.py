"""Arguments of settings classes and functions from flat keys, as users write them.

The keys are the names of the parameters. A parameter whose type is a dataclass is a group, whose fields are keys
too.
"""

from collections.abc import Callable, Iterator, Mapping
from dataclasses import is_dataclass
from inspect import Parameter, signature
from typing import Any, get_type_hints


def arguments_by_key(source: Callable, values: Mapping[str, Any], names: Mapping[str, str]) -> dict[str, Any]:
    """The arguments of a source, with its groups, that values by key give; other keys are left out.

    `names` has the key of each parameter whose key is not its name.
    """
    given = {}
    for part, hint in typed_parameters(source):
        if is_dataclass(hint):
            given[part.name] = hint(**arguments_by_key(hint, values, names))  # type: ignore[operator]
        elif (key := names.get(part.name, part.name)) in values:
            given[part.name] = values[key]
    return given


def keys_of(source: Callable, names: Mapping[str, str]) -> Iterator[str]:
    """The keys of a source and its groups."""
    for part, hint in typed_parameters(source):
        if is_dataclass(hint):
            yield from keys_of(hint, names)  # type: ignore[arg-type]
        else:
            yield names.get(part.name, part.name)


def typed_parameters(source: Callable) -> Iterator[tuple[Parameter, Any]]:
    """The parameters of a source, each with its type."""
    hints = get_type_hints(source)
    for part in signature(source).parameters.values():
        yield part, hints.get(part.name)
