"""`lifelore reuse …`: from a log of choices and outcomes to a choice for each user."""

from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Annotated, Any

import typer

if TYPE_CHECKING:
    from lifelore.agent.reuse.study import Study
    from lifelore.memory import Memory

reuse = typer.Typer(
    help="Choose for each user what served users of their kind: fit a log, choose, update, report.",
    no_args_is_help=True,
)

Option = typer.Option
Name = Annotated[str, Option(help="Of the study.")]
Where = Annotated[str | None, Option("--memory", metavar="FILE|URL", help="Which memory; default: your own.")]
Seed = Annotated[int, Option(help="For whatever is drawn at random.")]
Unused = Annotated[int, Option("--seed", help="Taken for likeness: nothing is drawn here.")]
AsJson = Annotated[bool, Option("--json", help="One JSON document on stdout and nothing else.")]


@reuse.command()
def fit(
    logs: Annotated[list[str], typer.Argument(metavar="LOG.csv…", help="user,policy,outcome[,type,context].")],
    name: Name = "default",
    model: Annotated[str, Option(help="auto, gaussian, student-t or categorical outcomes.")] = "auto",
    types: Annotated[
        int | None, Option(help="Types to look for; default: as many as the outcomes call for.")
    ] = None,
    control: Annotated[float, Option(help="Share of users held out.")] = 0.1,
    incumbent: Annotated[
        str | None, Option(metavar="POLICY", help="What the held out get; default: each policy alike.")
    ] = None,
    rule: Annotated[
        str, Option(help="Selection rule, such as sampling or expected-improvement.")
    ] = "information-directed",
    explore: Annotated[float, Option(help="Share of the other choices that are any policy.")] = 0.0,
    change: Annotated[float, Option(help="Probability that a user's type is another next time.")] = 0.0,
    where: Where = None,
    seed: Seed = 0,
    as_json: AsJson = False,
) -> None:
    """Learn types of users and what each policy achieves on them from a log."""
    from lifelore.agent.reuse.fit import FitSettings
    from lifelore.agent.reuse.fit import fit as fitted
    from lifelore.app.console import print_json
    from lifelore.memory import open_memory

    settings = FitSettings(name, model, types, control, incumbent, rule, explore, change, seed)
    with open_memory(where, durable=True) as memory:
        document = fitted(logs, memory, settings)
    print_json(document) if as_json else _print_fit(document)


@reuse.command()
def choose(
    user: Annotated[str, Option(help="Whom to choose for.")],
    context: Annotated[
        str | None, Option(help="What is known of the user beforehand: a context of the log.")
    ] = None,
    name: Name = "default",
    where: Where = None,
    seed: Seed = 0,
    as_json: AsJson = False,
) -> None:
    """Choose a policy for a user, and remember the choice."""
    from lifelore.agent.reuse.one_user import choose as chosen

    with _opened(name, where) as (memory, study):
        document = chosen(memory, study, user, context=context, seed=seed)
    held = ", held out" if document["control"] else ""
    new = f"\ncontext {context} is not in the logs: everybody's prior counts"
    _say(
        document,
        f"{document['policy']}\ndecision {document['decision']} (probability {document['probability']:.3g}{held})"
        + (new if context not in (None, document["context"]) else ""),
        as_json,
    )


@reuse.command()
def update(
    decision: Annotated[str, Option(metavar="ID", help="What `choose` printed.")],
    outcome: Annotated[str, Option(help="How well it went, a number; larger is better.")],
    name: Name = "default",
    where: Where = None,
    seed: Unused = 0,
    as_json: AsJson = False,
) -> None:
    """Take in how a decision ended: once, however late."""
    from lifelore.agent.reuse.log import read_outcome
    from lifelore.agent.reuse.one_user import update as updated

    value = read_outcome(outcome)
    with _opened(name, where) as (memory, study):
        document = updated(memory, study, decision, value)
    likely = max(document["belief"], key=document["belief"].get)
    said = "taken" if document["taken"] else "was there already, nothing changed"
    _say(
        document,
        f"outcome {document['outcome']:g} of {document['policy']} {said}; "
        f"{document['user']} is most likely {likely} ({document['belief'][likely]:.3g})",
        as_json,
    )


@reuse.command()
def report(
    out: Annotated[str | None, Option(metavar="FOLDER", help="Gets report.json and report.png.")] = None,
    log: Annotated[str | None, Option(metavar="FILE", help="Gets every decision as CSV.")] = None,
    name: Name = "default",
    where: Where = None,
    seed: Unused = 0,
    as_json: AsJson = False,
) -> None:
    """Uplift and regret against the users held out, with 95 % intervals."""
    from lifelore.agent.reuse.report import report as reported
    from lifelore.app.console import print_json

    with _opened(name, where) as (memory, study):
        document = reported(memory, study, out, log)
    if as_json:
        print_json(document)
        return
    _print_report(document)
    for what, place in (("report.json and report.png", out), ("every decision", log)):
        if place is not None:
            print(f"  {what} written to {place}")


@reuse.command()
def retire(
    policy: Annotated[str, typer.Argument()],
    name: Name = "default",
    where: Where = None,
    as_json: AsJson = False,
) -> None:
    """Give a policy to nobody from now on."""
    from lifelore.agent.reuse.one_user import retire as retired

    with _opened(name, where) as (memory, study):
        study = retired(memory, study, policy)
    _say({"policy": policy, "state": study.states[policy]}, f"{policy} is retired", as_json)


@reuse.command()
def add(
    policy: Annotated[str, typer.Argument()],
    name: Name = "default",
    where: Where = None,
    as_json: AsJson = False,
) -> None:
    """Bring a policy in: a retired one as it was, a new one to the held out first."""
    from lifelore.agent.reuse.one_user import add as added

    with _opened(name, where) as (memory, study):
        study = added(memory, study, policy)
    state = study.states[policy]
    said = "in use again" if state == "active" else "given to the held-out users, till a fit knows its outcomes"
    _say({"policy": policy, "state": state}, f"{policy} is {said}", as_json)


@reuse.command()
def forget(
    user: Annotated[str, typer.Argument()],
    name: Name = "default",
    where: Where = None,
    as_json: AsJson = False,
) -> None:
    """Forget one user's decisions, outcomes and belief for good."""
    from lifelore.agent.reuse.one_user import forget as forgot

    with _opened(name, where) as (memory, study):
        count = forgot(memory, study, user)
    _say({"user": user, "forgotten": count}, f"{count} contributions of {user} forgotten", as_json)


@contextmanager
def _opened(name: str, where: str | None) -> "Iterator[tuple[Memory, Study]]":
    from lifelore.agent.reuse.study import open_study
    from lifelore.memory import open_memory

    with open_memory(where, durable=True) as memory:
        yield memory, open_study(memory, name)


def _say(document: dict[str, Any], line: str, as_json: bool) -> None:
    from lifelore.app.console import print_json

    print_json(document) if as_json else print(line)


def _print_fit(document: dict[str, Any]) -> None:
    found = "found" if document["types_found"] else "named in the log"
    policies = _count(document["policies"], "policy", "policies")
    print(
        f"study {document['study']}: {document['rows']} outcomes of {document['users']} users, "
        f"{policies}, {_count(document['types'], 'type', 'types')} {found}, "
        f"{document['model']} outcomes"
    )
    for one in document["types"]:
        print(f"  {one['name']}: {one['users']} users, best served by {one['best']}")
    for what, count in (
        ("of users of no named type taken in: their outcomes tell it", document["guessed"]),
        ("without an outcome yet left out", document["pending"]),
        ("of unknown type left out", document["left_out"]),
    ):
        if count:
            print(f"  {count} lines {what}")
    if document["borrowed"]:
        print(
            f"  {document['borrowed']} pairs of type and policy have no outcome; expected is what everybody gets"
        )
    for name, before in document["changed"].items():
        keep = "" if before is None else f" (--{name} {before} keeps it)"
        print(f"  {name} is {document[name]}, was {before} until now{keep}")


def _count(things: list[Any], one: str, many: str) -> str:
    return f"{len(things)} {one if len(things) == 1 else many}"


def _print_report(document: dict[str, Any]) -> None:
    pending = f"{document['pending']} without an outcome yet"
    print(f"study {document['study']}: {document['decisions']} decisions, {pending}")
    for label, one in (
        ("chosen by belief", document["personal"]),
        ("held out", document["control"]),
        ("uplift", document["uplift"]),
        ("regret by the library, chosen by belief", document["regret"]["personal"]),
        ("regret by the library, held out", document["regret"]["control"]),
    ):
        print(f"  {label}: {_estimate(one)}")


def _estimate(one: dict[str, Any] | None) -> str:
    if one is None:
        return "no outcome yet"
    users = " and ".join(map(str, one["n"])) if isinstance(one["n"], list) else one["n"]
    interval = f" ({one['ci95'][0]:.4g} to {one['ci95'][1]:.4g})" if one["ci95"] else ""
    return f"{one['value']:.4g}{interval}, {users} users"
