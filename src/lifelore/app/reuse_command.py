"""`lifelore reuse …`: choose a policy for each user, from a log of choices and outcomes."""

import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import wraps
from inspect import signature
from typing import TYPE_CHECKING, Annotated, Any

import typer

from lifelore.app.console import print_json, say
from lifelore.app.options import AsJson, Where

if TYPE_CHECKING:
    from lifelore.agent.personalise.log.log_format import LogFormat
    from lifelore.agent.personalise.study import Study
    from lifelore.memory import Memory

reuse = typer.Typer(
    help="Choose for each user a policy that served similar users.",
    no_args_is_help=True,
)

Option = typer.Option
Name = Annotated[str, Option(help="Name of the study.")]
Seed = Annotated[int, Option(help="Draws all random numbers.")]
Unused = Annotated[int, Option("--seed", help="Without effect: this verb draws no random numbers.")]


Logs = Annotated[
    list[str], typer.Argument(metavar="LOG.csv…", help="Logs with columns user,policy,outcome[,type,context].")
]


def _log_options(
    columns: Annotated[
        list[str] | None,
        Option(
            metavar="OURS=THEIRS,…",
            help="Names of the log's columns, such as user=household,policy=brand,weight=ipw.",
        ),
    ] = None,
    separator: Annotated[
        str | None, Option(help="Between columns: comma, semicolon or tab; default: the one in the header.")
    ] = None,
    decimal_comma: Annotated[
        bool, Option("--decimal-comma", help="Outcomes have a comma before their decimals.")
    ] = False,
    encoding: Annotated[str, Option(help="Encoding of the logs, such as latin-1.")] = "utf-8",
    missing: Annotated[
        list[str] | None,
        Option(metavar="WORD", help="Word that means a missing value, beside the empty field; may be repeated."),
    ] = None,
    missing_outcome: Annotated[
        str,
        Option(
            metavar="leave-out|refuse|NUMBER",
            help="Leave lines without an outcome out, refuse them, or use NUMBER.",
        ),
    ] = "leave-out",
    missing_policy: Annotated[
        str,
        Option(
            metavar="refuse|leave-out|NAME",
            help="Refuse lines without a policy, leave them out, or use policy NAME.",
        ),
    ] = "refuse",
    features: Annotated[
        list[str] | None,
        Option(
            metavar="NAME,…", help="Columns of numbers that are known of a user beforehand, such as age,visits."
        ),
    ] = None,
) -> "LogFormat":
    """The format that the options of a log make."""
    from lifelore.agent.personalise.log.log_format import LogFormat, parse_columns

    columns_of_numbers = tuple(name.strip() for word in features or () for name in word.split(","))
    return LogFormat(
        parse_columns(columns or []), separator, decimal_comma, encoding, tuple(missing or ()), missing_outcome,
        missing_policy, features=columns_of_numbers,
    )  # fmt: skip


def reads_logs(verb: Callable[..., None]) -> Callable[..., None]:
    """The verb with the options of a log in place of its parameter `form`, which gets their format."""
    options = signature(_log_options).parameters

    @wraps(verb)
    def reading(**given: Any) -> None:
        form = _log_options(**{name: given.pop(name) for name in options})
        verb(**given, form=form)

    own = signature(verb)
    parts = [
        part for one in own.parameters.values() for part in (options.values() if one.name == "form" else [one])
    ]
    reading.__signature__ = own.replace(parameters=parts)  # pyright: ignore[reportAttributeAccessIssue]
    reading.__annotations__ = {part.name: part.annotation for part in parts}
    return reading


@reuse.command()
@reads_logs
def fit(
    logs: Logs,
    name: Name = "default",
    model: Annotated[
        str, Option(help="Model: auto (by users held out), gaussian, student-t, categorical or joint-normal.")
    ] = "auto",
    types: Annotated[int | None, Option(help="Number of types; default: selected by the outcomes.")] = None,
    control: Annotated[float, Option(help="Share of users in the control group.")] = 0.1,
    incumbent: Annotated[
        str | None,
        Option(metavar="POLICY", help="Policy of the control group; default: each policy with equal probability."),
    ] = None,
    rule: Annotated[
        str | None,
        Option(help="Selection rule, such as sampling or expected-improvement; default: information-directed."),
    ] = None,
    explore: Annotated[float, Option(help="Share of the other choices that are drawn from all policies.")] = 0.0,
    change: Annotated[
        str, Option(help="Probability that a user's type changes between two choices; learnt: from each user.")
    ] = "learnt",
    models: Annotated[
        str,
        Option(help="uncertain: models of few runs learn from each user too. plug-in: estimates are the truth."),
    ] = "uncertain",
    variant: Annotated[
        str,
        Option(help="thesis: the rule as printed [expected-improvement], plug-in models, and types that stay."),
    ] = "standard",
    form: Any = None,
    where: Where = None,
    seed: Seed = 0,
    as_json: AsJson = False,
) -> None:
    """Learn types of users and outcomes of policies from logs.

    Use it first, and again when there are more outcomes.
    """
    from lifelore.agent.personalise.fitting.fit import FitSettings
    from lifelore.agent.personalise.fitting.fit import fit as fitted
    from lifelore.core.errors import InputError
    from lifelore.interaction.selection import DEFAULT_RULE
    from lifelore.memory import open_memory

    if variant == "thesis":
        if change not in ("learnt", "0"):
            raise InputError(f"change must be 0 with --variant thesis, where types stay, got {change}")
        rule, change, models = rule or "expected-improvement", "0", "plug-in"
    chosen = rule or DEFAULT_RULE, explore, _change(change), models
    settings = FitSettings(name, model, types, control, incumbent, *chosen, seed, variant)
    with open_memory(where, durable=True) as memory:
        document = fitted(logs, memory, settings, form)
    print_json(document) if as_json else _print_fit(document)


@reuse.command()
@reads_logs
def warm(
    logs: Logs,
    form: Any = None,
    name: Name = "default",
    where: Where = None,
    seed: Unused = 0,
    as_json: AsJson = False,
) -> None:
    """Store the past of users who came after the fit.

    The library stays as it is. Use it so that users of another system do not start as strangers. The same log
    again changes nothing.
    """
    from lifelore.agent.personalise.past import warm as warmed

    with _opened(name, where) as (memory, study):
        document = warmed(logs, memory, study, form)
    print_json(document) if as_json else _print_warm(document)


@reuse.command()
def choose(
    user: Annotated[str, Option(help="User to choose for.")],
    context: Annotated[str | None, Option(help="Context of the user, as in the log.")] = None,
    features: Annotated[
        list[str] | None,
        Option(metavar="NAME=NUMBER,…", help="Numbers known of the user, such as age=31,visits=4."),
    ] = None,
    available: Annotated[
        list[str] | None,
        Option(metavar="POLICY,…", help="Policies that the user can get now; default: all. May be repeated."),
    ] = None,
    novelty: Annotated[
        bool, Option("--novelty", help="Compute the probability that no type of the library fits the user.")
    ] = False,
    name: Name = "default",
    where: Where = None,
    seed: Seed = 0,
    as_json: AsJson = False,
) -> None:
    """Choose a policy for a user, and store the decision."""
    from lifelore.agent.personalise.decisions import choose as chosen
    from lifelore.agent.personalise.log.log_format import parse_features
    from lifelore.agent.personalise.registration import listed_policies

    numbers = parse_features(features) if features else None
    with _opened(name, where) as (memory, study):
        among = listed_policies(study, available) if available else None
        document = chosen(
            memory, study, user, context=context, features=numbers, available=among, seed=seed, novelty=novelty
        )
    held = ", control group" if document["control"] else ""
    unknown = f"\nno known type fits: probability {document['novelty']:.3g}" if novelty else ""
    new = f"\ncontext {context} is not in the logs: the prior of all users is used"
    say(
        document,
        f"{document['policy']}\ndecision {document['decision']} (probability {document['probability']:.3g}{held})"
        + (new if context not in (None, document["context"]) and not document["features"] else "")
        + unknown,
        as_json,
    )


@reuse.command()
def update(
    decision: Annotated[str, Option(metavar="ID", help="The decision that `choose` printed.")],
    outcome: Annotated[str, Option(help="Outcome, a number; larger is better.")],
    name: Name = "default",
    where: Where = None,
    seed: Unused = 0,
    as_json: AsJson = False,
) -> None:
    """Store the outcome of a decision, once, at any later time."""
    from lifelore.agent.personalise.decisions import update as updated
    from lifelore.agent.personalise.log.log_format import read_outcome

    value = read_outcome(outcome)
    with _opened(name, where) as (memory, study):
        document = updated(memory, study, decision, value)
    likely = max(document["belief"], key=document["belief"].get)
    status = "stored" if document["taken"] else "was stored already, nothing changed"
    say(
        document,
        f"outcome {document['outcome']:g} of {document['policy']} {status}; "
        f"{document['user']} is most likely {likely} ({document['belief'][likely]:.3g})",
        as_json,
    )


@reuse.command()
def report(
    out: Annotated[str | None, Option(metavar="FOLDER", help="Folder for report.json and the pictures.")] = None,
    log: Annotated[str | None, Option(metavar="FILE", help="CSV file for all decisions.")] = None,
    incumbent: Annotated[
        str | None, Option(metavar="POLICY", help="Policy in place until now; default: that of the fit, if any.")
    ] = None,
    split: Annotated[
        str | None,
        Option(
            metavar="user|time|both", help="Count only users that the fit did not know, later decisions, or both."
        ),
    ] = None,
    by: Annotated[
        str | None, Option(metavar="day|week", help="Also compare in each day or week of decisions (UTC).")
    ] = None,
    name: Name = "default",
    where: Where = None,
    seed: Unused = 0,
    as_json: AsJson = False,
) -> None:
    """Report the uplift with 95 % intervals.

    It compares with the control group, with the best single policy and with the incumbent.
    """
    from lifelore.agent.personalise.study_report import report as reported

    with _opened(name, where) as (memory, study):
        document = reported(memory, study, out, log, incumbent=incumbent, split=split, by=by)
    if as_json:
        print_json(document)
        return
    _print_report(document)
    pictures = "report.json, report.png" + " and calibration.png" * bool(document["calibration"]["outcomes"])
    for content, path in ((pictures, out), ("every decision", log)):
        if path is not None:
            print(f"  {content} written to {path}")


@reuse.command()
def retire(
    policy: Annotated[str, typer.Argument()],
    name: Name = "default",
    where: Where = None,
    as_json: AsJson = False,
) -> None:
    """Stop choosing a policy."""
    from lifelore.agent.personalise.registration import retire as retired

    with _opened(name, where) as (memory, study):
        study = retired(memory, study, policy)
    say({"policy": policy, "state": study.states[policy]}, f"{policy} is retired", as_json)


@reuse.command()
def add(
    policy: Annotated[str, typer.Argument()],
    name: Name = "default",
    where: Where = None,
    as_json: AsJson = False,
) -> None:
    """Add a new policy, or use a retired policy again.

    A new policy is first given to the control group only.
    """
    from lifelore.agent.personalise.registration import add as added

    with _opened(name, where) as (memory, study):
        study = added(memory, study, policy)
    state = study.states[policy]
    use = "in use again" if state == "active" else "given to the control group until a fit has outcomes of it"
    say({"policy": policy, "state": state}, f"{policy} is {use}", as_json)


@reuse.command()
def forget(
    user: Annotated[str, typer.Argument()],
    name: Name = "default",
    where: Where = None,
    as_json: AsJson = False,
) -> None:
    """Delete the decisions, outcomes and belief of a user for ever."""
    from lifelore.agent.personalise.decisions import forget as forgot

    with _opened(name, where) as (memory, study):
        count = forgot(memory, study, user)
    say(
        {"user": user, "forgotten": count},
        f"{user} and {_count(count, 'decision or line', 'decisions and lines')} of the past forgotten",
        as_json,
    )


@reuse.command()
def studies(
    archive: Annotated[str | None, Option(metavar="NAME", help="Archive a study: it takes no decisions.")] = None,
    activate: Annotated[str | None, Option(metavar="NAME", help="Make an archived study active again.")] = None,
    delete: Annotated[
        str | None, Option(metavar="NAME", help="Delete a study with all its users, for ever.")
    ] = None,
    where: Where = None,
    as_json: AsJson = False,
) -> None:
    """List the studies in memory, archive or delete one."""
    from lifelore.agent.personalise.study import open_study, study_states
    from lifelore.memory import open_memory

    with open_memory(where, durable=True, create=False) as memory:
        for name, state in ((archive, "archived"), (activate, "active")):
            if name is not None:
                open_study(memory, name)
                memory.studies.set_state(name, state)
        if delete is not None:
            open_study(memory, delete)
            memory.studies.delete(delete)
        listed = study_states(memory)
    lines = [f"{name} ({state})" for name, state in sorted(listed.items())]
    say({"studies": listed}, "\n".join(lines) or "no study; begin with 'lifelore reuse fit'", as_json)


@reuse.command()
def adapt(
    library: Annotated[
        str,
        typer.Argument(metavar="LIBRARY", help="Action sets by types: a JSON file, or one of PolicyLibrary.save."),
    ],
    watch: Annotated[
        str,
        Option(
            metavar="FILE",
            help='JSON lines {"user", "action_set", "signal"}; {"user"} alone asks before the first move; '
            "- is stdin.",
        ),
    ] = "-",
    epsilon: Annotated[
        str, Option(metavar="NUMBER|1/n|by episode", help="Share of exploration; the words are the thesis's.")
    ] = "0",
    name: Annotated[str, Option(help="Name of the adaptation in memory.")] = "default",
    where: Where = None,
    seed: Seed = 0,
    as_json: AsJson = False,
) -> None:
    """Adapt an interface to each user, step by step (BEAT).

    Each JSON line of input, a move of a user, gives one JSON line with the action set for the next step. Use it
    where each step shows the user's type. Memory stores the beliefs; with another library they start again. The
    line {"user": "ada", "forget": true} deletes what is stored of a user.
    """
    from lifelore.agent.personalise import adaptation
    from lifelore.app.console import print_json_line
    from lifelore.core.json_lines import lines_of
    from lifelore.memory import open_memory

    with open_memory(where, durable=True) as memory:
        registered = adaptation.register_adaptation(
            memory, name, adaptation.read_library(library), _number_or_name(epsilon)
        )
        lines = lines_of(watch)
        chosen = adaptation.adapt(memory, registered, lines, "stdin" if watch == "-" else watch, seed)
        if as_json:
            print_json({"adaptation": name, "steps": list(chosen)})
            return
        for one in chosen:
            print_json_line(one)  # The caller waits for this line before the user's next step.


@contextmanager
def _opened(name: str, where: str | None) -> "Iterator[tuple[Memory, Study]]":
    from lifelore.agent.personalise.study import open_study
    from lifelore.memory import open_memory

    with open_memory(where, durable=True, create=False) as memory:
        yield memory, open_study(memory, name)


def _change(given: str) -> Any:
    """A probability, or the word for dynamics that are learnt."""
    from lifelore.core.errors import InputError

    if given == "learnt":
        return given
    try:
        return float(given)
    except ValueError:
        raise InputError(f"--change must be a probability or 'learnt', got {given!r}") from None


def _number_or_name(given: str) -> float | str:
    try:
        return float(given)
    except ValueError:
        return given


def _print_fit(document: dict[str, Any]) -> None:
    found = "found" if document["types_found"] else "named in the log"
    if document["context"] and document["context"]["types_of"]:
        found = "by context"
    read = f"{_count(document['rows'], 'outcome')} of {_count(document['users'], 'user')}"
    policies = _count(len(document["policies"]), "policy", "policies")
    types = f"{_count(len(document['types']), 'type')} {found}"
    print(f"study {document['study']}: {read}, {policies}, {types}, {document['model']} outcomes")
    for kind in document["types"]:
        print(f"  {kind['name']}: {_count(kind['users'], 'user')}, best served by {kind['best']}")
    _print_counts(
        document,
        *LEFT_OUT,
        ("of unknown type left out", "left_out"),
    )
    for note in document["notes"]:
        print(f"  {note}")
    if document["features"]:
        print(_features_line(document["features"]))
    if document["borrowed"]:
        pairs = _count(document["borrowed"], "pair")
        print(f"  {pairs} of type and policy without an outcome; the mean of all types is expected")
    if kept := document["kept"]:
        print(
            f"  memory keeps {_count(kept['decisions'], 'decision')} for {_count(kept['users'], 'user')}, "
            f"{kept['pending']} without an outcome yet; {kept['in_log']} of them in the log, too, which count once"
        )
    for name, before in document["changed"].items():
        keep = "" if before is None else f" (--{name} {before} keeps it)"
        print(f"  {name} is {document[name]}, was {before} until now{keep}")


def _features_line(features: dict[str, Any]) -> str:
    names = ", ".join(features["names"])
    if not features["strength"]:
        return f"  {names} of {features['users']} users tell nothing about types; every user gets the same prior"
    return (
        f"  the prior follows from {names}, by {features['users']} users: {features['gain']:.2g} nats a user "
        "better than without, on users held out"
    )


def _print_warm(document: dict[str, Any]) -> None:
    print(
        f"study {document['study']}: {_count(document['rows'], 'outcome')} of "
        f"{_count(document['users'], 'user')} added to the past"
    )
    _print_counts(
        document,
        ("read before, not counted again", "known"),
        ("of decisions in memory, not counted again", "decisions"),
        *LEFT_OUT,
        ("with a policy that the study does not know: no evidence", "unknown_policies"),
        ("with a time that cannot be read and only tells lines apart (write ISO dates)", "unread_times"),
    )
    if not document["by_time"]:
        print("  lines have no time: equal lines of a user count as often as one log has them (add a column time)")
    if document["unknown_types"]:
        print(f"  types that the study does not know are ignored: {', '.join(document['unknown_types'])}")


LEFT_OUT = (
    ("without an outcome yet left out", "pending"),
    ("without a policy left out", "without_policy"),
    ("of an earlier log, too, left out", "repeated"),
    ("without an outcome used as --missing-outcome says", "filled_outcomes"),
    ("without a policy used as --missing-policy says", "filled_policies"),
)


def _print_counts(document: dict[str, Any], *notes: tuple[str, str]) -> None:
    for note, name in notes:
        if document[name]:
            print(f"  {_count(document[name], 'line')} {note}")


def _count(number: int, singular: str, plural: str = "") -> str:
    return f"{number} {singular if number == 1 else plural or singular + 's'}"


def _print_report(document: dict[str, Any]) -> None:
    pending = f"{document['pending']} without an outcome yet"
    print(f"study {document['study']}: {_count(document['decisions'], 'decision')}, {pending}")
    single, incumbent = document["best_single"], document["incumbent"]
    for label, estimate in (
        ("chosen by belief", document["personal"]),
        ("control group", document["control"]),
        ("uplift", document["uplift"]),
        (f"uplift over the best single policy, {single['name']}", single["uplift"]),
        *([(f"uplift over the incumbent, {incumbent['name']}", incumbent["uplift"])] if incumbent else []),
        ("regret by the library, chosen by belief", document["regret"]["personal"]),
        ("regret by the library, control group", document["regret"]["control"]),
    ):
        print(f"  {label}: {_estimate(estimate)}")
    if found := document["calibration"]["outcomes"]:
        print(f"  calibration, quantiles of outcomes: mean distance {found['error']:.3f}, {found['groups']} users")
    if strangers := document["strangers"]:
        print(
            f"  users whom probably no known type fits: {strangers['users']} of {strangers['n']} with an outcome"
        )
    rows = [row for row in document["policies"] if row["outcome"]]
    if rows:
        print("  each policy in the control group:")
    width = max((len(row["name"]) for row in rows), default=0)
    for row in sorted(rows, key=lambda row: -row["outcome"]["value"]):
        retired = "" if row["state"] == "active" else f" ({row['state']})"
        print(f"    {row['name']:{width}}  {_estimate(row['outcome'])}{retired}")
    for period in document["by_time"] or ():
        day = time.strftime("%Y-%m-%d", time.gmtime(period["time"]))
        print(f"  from {day}: {period['decisions']} decisions, uplift {_estimate(period['uplift'])}")


def _estimate(estimate: dict[str, Any] | None) -> str:
    if estimate is None:
        return "not measured, no outcome yet"
    users = " and ".join(map(str, estimate["n"])) if isinstance(estimate["n"], list) else estimate["n"]
    interval = f" ({estimate['ci95'][0]:.4g} to {estimate['ci95'][1]:.4g})" if estimate["ci95"] else ""
    return f"{estimate['value']:.4g}{interval}, {users} users"
