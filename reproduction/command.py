"""`lifelore reproduce`: run claims of the thesis as experiments."""

from typing import Annotated

import typer


def reproduce(
    claims: Annotated[
        list[str] | None, typer.Argument(metavar="[CLAIM]...", help="Claims, such as C3.2; default: all.")
    ] = None,
    quick: Annotated[
        bool, typer.Option("--quick", help="Run at a small size, for tests only (the default).")
    ] = False,
    full: Annotated[bool, typer.Option("--full", help="Run at the thesis's size or larger.")] = False,
    list_all: Annotated[bool, typer.Option("--list", help="List every claim.")] = False,
    verify: Annotated[
        bool, typer.Option("--verify", help="Run stored results again and compare them to the last digit.")
    ] = False,
    settings: Annotated[
        list[str] | None, typer.Option("--set", metavar="KEY=VALUE", help="Change a setting of the claims.")
    ] = None,
    jobs: Annotated[int | None, typer.Option(help="Parts that run at once; results do not depend on it.")] = None,
    engine: Annotated[
        str,
        typer.Option(help="Where parts run: local (here) or dask (a cluster; extra cluster); same results."),
    ] = "local",
    scheduler: Annotated[
        str | None, typer.Option(metavar="ADDRESS", help="dask: the cluster's scheduler, such as tcp://host:8786.")
    ] = None,
    out: Annotated[str, typer.Option(metavar="DIR", help="Folder for the results.")] = "results",
    seed: Annotated[int, typer.Option(help="Draws all random numbers.")] = 0,
    seeds: Annotated[
        int | None,
        typer.Option(metavar="N", help="Run under N seeds and pool them: for verdicts near a bound."),
    ] = None,
    as_json: Annotated[bool, typer.Option("--json", help="One JSON document on stdout and nothing else.")] = False,
) -> None:
    """Run claims of the thesis and compare the results.

    Use it to check a claim yourself. You can stop it and start it again: finished parts are stored.
    """
    from lifelore.app.console import print_json, progress_bar
    from lifelore.core.errors import InputError
    from reproduction.engine.registry import list_claims
    from reproduction.engine.reproduce import reproduce as run

    if list_all:
        entries = list_claims()
        print_json(entries) if as_json else _print_list(entries)
        return
    if quick and full:
        raise InputError("quick and full exclude each other: choose one")
    if verify:
        if quick or full or settings or seed or seeds:
            raise InputError(
                "verify takes mode, settings and seed from the stored result; leave out --quick, --full, --set, "
                "--seed and --seeds"
            )
        from reproduction.engine.verify import verify as run_again

        with progress_bar("verifying") as progress:
            found = run_again(claims or [], jobs, out, progress, engine, scheduler)
        print_json(found) if as_json else _print_verified(found)
        if any(one["equal"] is False for one in found):
            raise typer.Exit(1)
        return
    if seeds is not None and engine != "local":
        raise InputError(
            f"seeds run on this machine, got engine '{engine}'; run each --seed on the cluster instead"
        )
    with progress_bar("reproducing") as progress:
        mode, overrides = "full" if full else "quick", _pairs(settings or [])
        if seeds is not None:
            from reproduction.engine.more_seeds import run_seeds

            pools = run_seeds(claims or [], seeds, mode, overrides, jobs, out, seed, progress)
            print_json(pools) if as_json else _print_pools(pools)
            return
        results = run(claims or [], mode, overrides, jobs, out, seed, progress, engine, scheduler)
    if as_json:
        print_json(results)
    else:
        from reproduction.claim_table import print_claims

        print_claims(results, out)


def _print_pools(pools: list[dict]) -> None:
    for pool in pools:
        own = ", ".join(f"{one['seed']}: {one['verdict']}" for one in pool["by_seed"])
        print(f"{pool['claim']} ({pool['mode']}, {len(pool['seeds'])} seeds): {pool['verdict']}. {pool['why']}")
        print(f"  by seed: {own}")


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


def _print_list(entries: list[dict]) -> None:
    from rich.console import Console
    from rich.table import Table

    table = Table("claim", "where", "built", "what the thesis reports")
    for entry in entries:
        table.add_row(entry["claim"], entry["where"], "yes" if entry["built"] else "not yet", entry["reports"])
    Console().print(table)
