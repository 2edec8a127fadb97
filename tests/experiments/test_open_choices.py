"""Cells of a grid of open choices, by hand."""

from lifelore.experiments.engine.open_choices import default_of, how_key, is_default_but_for_schedule, plain_how

KEYS = ("schedule", "ties", "max_steps")
SETTINGS = {"default": {"schedule": [1.0, 0.9, 0.1], "ties": "uniform", "max_steps": 9, "else": 1}}


def test_the_default_has_the_keys_and_no_other():
    assert default_of(SETTINGS, KEYS) == {"schedule": [1.0, 0.9, 0.1], "ties": "uniform", "max_steps": 9}


def test_without_a_prior_only_schedule_and_cap_are_read():
    how = {"schedule": [0.1, 1.0, 0.1], "ties": "prior", "max_steps": 7}
    assert plain_how(how, KEYS) == {"schedule": [0.1, 1.0, 0.1], "ties": None, "max_steps": 7}
    assert how_key(how, KEYS) == ((0.1, 1.0, 0.1), "prior", 7)


def test_the_default_under_any_schedule_and_what_learners_without_a_prior_meet_there():
    other = {**default_of(SETTINGS, KEYS), "schedule": [0.1, 1.0, 0.1]}
    assert is_default_but_for_schedule(other, SETTINGS, KEYS)
    assert is_default_but_for_schedule(plain_how(other, KEYS), SETTINGS, KEYS)
    assert not is_default_but_for_schedule({**other, "ties": "prior"}, SETTINGS, KEYS)
    assert not is_default_but_for_schedule({**plain_how(other, KEYS), "max_steps": 7}, SETTINGS, KEYS)
