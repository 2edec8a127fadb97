"""`lifelore reproduce`: run claims of the thesis, and print their marks, numbers and picture."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Annotated

import typer


def reproduce(
    claims: Annotated[
        list[str] | None,
        typer.Argument(metavar="[CLAIM|FIGURE]...", help="Claims (C3.4) or figures (3.7); default: all."),
    ] = None,
    full: Annotated[
        bool, typer.Option("--full", help="Run at the thesis's size or larger; default: a small size, for tests.")
    ] = False,
    list_all: Annotated[bool, typer.Option("--list", help="List every claim with its figure.")] = False,
    verify: Annotated[
        bool, typer.Option("--verify", help="Run stored results again and compare them to the last digit.")
    ] = False,
    settings: Annotated[
        list[str] | None, typer.Option("--set", metavar="KEY=VALUE", help="Change a setting of the claims.")
    ] = None,
    jobs: Annotated[
        int | None, typer.Option(help="Parts of a full run that run at once; results do not depend on it.")
    ] = None,
    scheduler: Annotated[
        str | None,
        typer.Option(metavar="ADDRESS", help="Run on a dask cluster, such as tcp://host:8786 (extra cluster)."),
    ] = None,
    out: Annotated[
        str | None, typer.Option(metavar="DIR", help="Folder for the results; default: that of the checkout.")
    ] = None,
    seed: Annotated[int, typer.Option(help="Draws all random numbers.")] = 0,
    as_json: Annotated[bool, typer.Option("--json", help="One JSON document on stdout and nothing else.")] = False,
) -> None:
    """Run claims of the thesis and compare the results.

    Use it to check a claim yourself. You can stop it and start it again: finished parts are stored.
    """
    from lifelore.app.console import print_json, progress_bar
    from lifelore.core.errors import InputError
    from reproduction.engine.registry import RESULTS, found_ids, list_claims
    from reproduction.engine.reproduce import reproduce as run

    if list_all:
        found = list_claims()
        print_json(found) if as_json else _print_list(found)
        return
    ids = [claim_id for name in claims or [] for claim_id in found_ids(name)]
    folder = Path(out) if out else RESULTS
    if verify:
        if full or settings or seed:
            raise InputError(
                "verify takes mode, settings and seed from the stored result; leave out --full, --set and --seed"
            )
        from reproduction.engine.verify import verify as run_again

        with progress_bar("verifying") as progress:
            found = run_again(ids, jobs, folder, progress, scheduler)
        print_json(found) if as_json else _print_verified(found)
        if any(one["equal"] is False for one in found):
            raise typer.Exit(1)
        return
    with progress_bar("reproducing") as progress:
        mode = "full" if full else "quick"
        results = run(ids, mode, _pairs(settings or []), jobs, folder, seed, progress, scheduler)
    print_json(results) if as_json else print_results(results, folder)


def print_results(results: Sequence[Mapping], folder: Path) -> None:
    """Print each result's word, its statements with marks and numbers, and where its picture is."""
    from rich.console import Console
    from rich.table import Table
    from rich.text import Text

    from reproduction.engine.registry import claim_of
    from reproduction.engine.reproduce import result_folder
    from reproduction.engine.statement import number_in_words

    console = Console()
    for result in results:
        claim, table = claim_of(result["claim"]), Table.grid(padding=(0, 2))
        small = "; a small run, no evidence" if result["mode"] == "quick" else ""
        console.print(
            Text.assemble(f"{claim.id} {claim.title}: ", (result["verdict"], "bold"), small), highlight=False
        )
        for one in claim.statements:
            number = result["measured"].get(one.measure)
            shown = number_in_words(number) if number else "not measured"
            table.add_row("  " + "".join(result["marks"][one.says]), Text(f"{one.says}: {shown}"))
        console.print(table, highlight=False)
        picture = result_folder(folder / claim.id, result["mode"]) / "figure.png"
        console.print(f"{picture}\n", soft_wrap=True, highlight=False)
    console.print(
        "Marks: at the default, under some reasonable reading, under most readings; ½: in part or on average"
    )


def _print_verified(found: list[dict]) -> None:
    for one in found:
        if one["missing"]:
            names = ", ".join(one["missing"])
            print(
                f"{one['claim']}: not compared, as it was made with outside data ({names}) that are not here; set "
                "LIFELORE_DATA, or run its public part with `--full --set real=false`"
            )
            continue
        n = one["n_differences"]
        print(f"{one['claim']}: " + ("equal to the last digit" if one["equal"] else f"{n} numbers differ"))
        for difference in one["differences"]:
            print(f"  {_difference(difference)}")
        if n > len(one["differences"]):
            print(f"  … and {n - len(one['differences'])} more")
        if not one["equal"] and one["changed"]:
            print("  made with: " + "; ".join(_difference(difference) for difference in one["changed"]))


def _difference(difference: dict) -> str:
    return f"{difference['where']}: {difference['stored']} stored, {difference['now']} now"


def _pairs(settings: list[str]) -> dict[str, str]:
    from lifelore.core.errors import InputError

    for setting in settings:
        if "=" not in setting:
            raise InputError(f"--set takes KEY=VALUE, got '{setting}'")
    return dict(setting.split("=", 1) for setting in settings)


def _print_list(found: Sequence[Mapping]) -> None:
    from rich.console import Console
    from rich.table import Table

    table = Table("claim", "figure", "what the thesis says")
    for one in found:
        table.add_row(one["claim"], ", ".join(one["figure"]), one["sentence"])
    Console().print(table)
