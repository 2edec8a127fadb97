"""Options of the command line for settings by key."""


def changed(**settings: object) -> list[str]:
    """The options that change these settings by key."""
    return [part for key, value in settings.items() for part in ("--set", f"{key}={value}")]
