"""`lifelore`: the command line; each verb calls one function of a lower room.

Exit status: 0 done, 2 mistake of the user (with one line that names the next step), 130 stopped by Ctrl-C, 1
defect of Lifelore. Heavy imports happen inside the verbs, so that ``--help`` is fast.
"""

import errno
import gc
import os
import sys

import typer

from lifelore.app.console import INTERRUPTED, print_json
from lifelore.app.options import AsJson
from lifelore.core.errors import LifeloreError

DISK_FULL = (errno.ENOSPC, errno.EDQUOT, errno.EFBIG)
NEW_OBJECTS = 100_000
"""Objects created between two runs of the garbage collector; a smaller number delays every start by 0.1 s."""
UsageError: type[Exception] = next(kind for kind in typer.BadParameter.__mro__ if kind.__name__ == "UsageError")
"""Click's class for wrong options, which newer versions of Typer include."""

app = typer.Typer(
    name="lifelore",
    no_args_is_help=True,
    add_completion=False,
    rich_markup_mode=None,
    pretty_exceptions_enable=False,
)


def _register() -> None:
    from lifelore.app import (
        advise_command,
        doctor_command,
        learn_from_command,
        learn_relations_command,
        live_command,
        long_life_command,
        memory_commands,
        perceive_command,
        recognise_command,
        reproduce_command,
        reuse_command,
        reuse_evaluate_command,
        scenes_command,
        serve_command,
        teach_command,
        way_command,
    )

    app.command("live")(live_command.live)
    app.command("explain")(long_life_command.explain)
    app.command("way")(way_command.way)
    app.command("recognise")(recognise_command.recognise)
    app.command("perceive")(perceive_command.perceive)
    app.command("learn-relations")(learn_relations_command.learn_relations)
    app.command("scenes")(scenes_command.scenes)
    app.command("teach")(teach_command.teach)
    app.command("learn-from")(learn_from_command.learn_from)
    app.command("advise")(advise_command.advise)
    reuse_command.reuse.command("evaluate")(reuse_evaluate_command.evaluate)
    app.add_typer(reuse_command.reuse, name="reuse")
    app.add_typer(memory_commands.memory, name="memory")
    app.command("serve")(serve_command.serve)
    reproduce_command.add_reproduce(app)
    app.command("doctor")(doctor_command.doctor)


def _print_version(chosen: bool) -> None:
    if chosen:
        from lifelore import __version__

        print(__version__)
        raise typer.Exit


@app.callback()
def lifelore(
    version: bool = typer.Option(
        False, "--version", is_eager=True, callback=_print_version, help="Print the version."
    ),
) -> None:
    """An agent that lives long in one kind of world and becomes good at that world."""


@app.command()
def version(as_json: AsJson = False) -> None:
    """Print the version."""
    from lifelore import __version__

    if as_json:
        print_json({"version": __version__})
    else:
        print(__version__)


_register()


def main(arguments: list[str] | None = None) -> None:
    """Run the command line and exit the process."""
    # Imports create some hundred thousand objects that all stay, so the collector would find no garbage.
    gc.set_threshold(NEW_OBJECTS)
    status = run(sys.argv[1:] if arguments is None else arguments)
    # The interpreter's last collection would visit every imported object.
    gc.freeze()
    sys.exit(status)


def run(arguments: list[str]) -> int:
    """Run the command line and return the exit status; a mistake of the user is one line on stderr."""
    command = typer.main.get_command(app)
    try:
        status = command.main(arguments, prog_name="lifelore", standalone_mode=False)
        print(end="", flush=True)
    except UsageError as error:
        return _usage(error)
    except LifeloreError as error:
        return _mistake(str(error))
    except (typer.Abort, KeyboardInterrupt):
        print("lifelore: stopped", file=sys.stderr)
        return INTERRUPTED
    except (BrokenPipeError, SystemExit):
        # The reader of the output has closed the pipe (`lifelore … | head`); Typer then exits by itself.
        _drop_output()
        return 0
    except OSError as error:
        if error.errno not in DISK_FULL:
            raise
        _drop_output()
        return _mistake(f"the output cannot be written: {error.strerror}; free space, finished work is stored")
    return status if isinstance(status, int) else 0


def _usage(error) -> int:
    if type(error).__name__ == "NoArgsIsHelpError":
        print(error.format_message(), file=sys.stderr)
        return 2
    where = f" (see: {error.ctx.command_path} --help)" if error.ctx else ""
    return _mistake(f"{error.format_message()}{where}")


def _drop_output() -> None:
    """Discard buffered output; otherwise the interpreter would write it again at exit and report an error."""
    nowhere = os.open(os.devnull, os.O_WRONLY)
    os.dup2(nowhere, 1)
    os.close(nowhere)


def _mistake(message: str) -> int:
    print(f"lifelore: {' '.join(message.split())}", file=sys.stderr)
    return 2


if __name__ == "__main__":
    main()
