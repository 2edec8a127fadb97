"""The tree of errors: each is ours, and the builtin a caller would expect."""

import pytest

from lifelore.core import errors

BUILTINS = {
    "InputError": ValueError,
    "NotFoundError": LookupError,
    "MissingExtraError": ImportError,
    "StoreError": OSError,
}


def test_the_tree_is_complete():
    named = {name for name, value in vars(errors).items() if isinstance(value, type)}
    assert named == {*BUILTINS, "LifeloreError"}


@pytest.mark.parametrize(("name", "builtin"), BUILTINS.items())
def test_an_error_is_ours_and_a_builtin_and_keeps_its_words(name, builtin):
    kind = getattr(errors, name)
    assert issubclass(kind, errors.LifeloreError)
    with pytest.raises(builtin, match=r"^what to do$") as caught:
        raise kind("what to do")
    assert str(caught.value) == "what to do"
