"""`lifelore reuse evaluate`: what other policies would have achieved, from a log with probabilities."""

from typing import Annotated, Any

import typer

from lifelore.app.options import AsJson, Where
from lifelore.app.reuse_command import Option, Seed, reads_logs

Logs = Annotated[
    list[str], typer.Argument(metavar="LOG.csv…", help="Logs with columns user,policy,outcome,probability[,…].")
]


@reads_logs
def evaluate(
    logs: Logs,
    policy: Annotated[
        list[str] | None, Option(help="Policy to evaluate; may be repeated. Default: each policy of the log.")
    ] = None,
    target: Annotated[
        list[str] | None,
        Option(metavar="FILE.csv", help="Probabilities to evaluate, with columns policy,probability[,context]."),
    ] = None,
    rule: Annotated[
        list[str] | None,
        Option(help="Selection rule to evaluate, with libraries learnt from the other users of the log."),
    ] = None,
    study: Annotated[
        str | None, Option(metavar="NAME", help="Study in memory to evaluate, on users whom it does not know.")
    ] = None,
    first: Annotated[
        int | None,
        Option(
            metavar="N",
            help="Evaluate the first N decisions of each user, all made by the target. Default: a rule makes each "
            "decision after the outcomes of the log.",
        ),
    ] = None,
    estimator: Annotated[
        str, Option(help="Estimator to print: doubly-robust, self-normalised, ips or all.")
    ] = "doubly-robust",
    model: Annotated[
        str, Option(help="Model of outcomes of the doubly robust estimate: means or library.")
    ] = "means",
    types: Annotated[
        int | None, Option(help="Number of types of the libraries; default: selected by the outcomes.")
    ] = None,
    explore: Annotated[float, Option(help="Share of a rule's choices that are drawn from all policies.")] = 0.0,
    group: Annotated[
        str | None,
        Option(
            help="Read this group of the column 'group', or all. Default: control, where the other choices had no "
            "alternative."
        ),
    ] = None,
    out: Annotated[
        str | None, Option(metavar="FOLDER", help="Folder for evaluation.json and evaluation.png.")
    ] = None,
    form: Any = None,
    where: Where = None,
    seed: Seed = 0,
    as_json: AsJson = False,
) -> None:
    """Estimate the mean outcome of other policies from a log.

    The log needs the probability of every choice. Use it before you change a policy.
    """
    from contextlib import nullcontext

    from lifelore.agent.personalise.evaluate.evaluate import EvaluateSettings
    from lifelore.agent.personalise.evaluate.evaluate import evaluate as evaluated
    from lifelore.agent.personalise.evaluate.target_estimates import ESTIMATORS
    from lifelore.app.console import print_json
    from lifelore.core.errors import NotFoundError
    from lifelore.memory import open_memory

    if estimator not in (*ESTIMATORS, "all"):
        raise NotFoundError(f"estimator must be one of {', '.join(ESTIMATORS)}, all, got '{estimator}'")
    policies, tables, rules = (tuple(names or ()) for names in (policy, target, rule))
    settings = EvaluateSettings(policies, tables, rules, study, first, model, types, explore, group, seed)
    with open_memory(where, create=False) if study is not None else nullcontext() as memory:
        document = evaluated(logs, settings, form, memory, out=out)
    if as_json:
        print_json(document)
        return
    _print(document, ESTIMATORS if estimator == "all" else (estimator,))
    if out is not None:
        print(f"evaluation.json and evaluation.png written to {out}")


LEFT_OUT = {
    "pending": "lines without an outcome",
    "without_policy": "lines without a policy",
    "repeated": "lines that an earlier log has, too",
    "other_groups": "decisions of other groups",
    "known_to_the_study": "decisions for users whom the study knows",
    "later_decisions": "later decisions of users",
}


def _print(document: dict[str, Any], estimators: tuple[str, ...]) -> None:
    group = f" of the group {document['group']}" if document["group"] else ""
    print(
        f"{document['decisions']} decisions{group} for {document['users']} users; mean outcome of the log "
        f"{_estimate(document['logged'])}"
    )
    for reason, words in LEFT_OUT.items():
        if document["left_out"][reason]:
            print(f"  {document['left_out'][reason]} {words} left out")
    rows = _rows(document, estimators)
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    for row in rows:
        print("  " + "  ".join(map(str.ljust, row, widths)).rstrip())
    for one in document["targets"]:
        for warning in one["warnings"]:
            print(f"  {one['name']}: {warning}")


def _rows(document: dict[str, Any], estimators: tuple[str, ...]) -> list[list[str]]:
    """Header and one row a target, the best first."""
    alone = len(estimators) == 1
    header = ["target", *estimators, *(["gain over the log"] if alone else [])]
    header += ["effective users", "largest weight", "support"]

    def value(target: dict[str, Any]) -> float:
        found = target["estimates"][estimators[-1]]
        return -found["value"] if found else float("inf")

    rows = [header]
    for target in sorted(document["targets"], key=value):
        found = [target["estimates"][name] for name in estimators]
        cells = [_name(target, document), *map(_estimate, found)]
        cells += [_estimate(found[0] and found[0]["gain"])] if alone else []
        weights = target["weights"]
        cells += [f"{weights['effective_users']:.1f}", f"{weights['largest']:.3g}", f"{target['support']:.0%}"]
        rows.append(cells)
    return rows


def _name(target: dict[str, Any], document: dict[str, Any]) -> str:
    if target["kind"] not in ("rule", "study"):
        return target["name"]
    when = f"first {document['first']} decisions" if target["decision"] == "all" else "next decision"
    return f"{target['name']}, {when}"


def _estimate(estimate: dict[str, Any] | None) -> str:
    if estimate is None:
        return "–"
    interval = f" ({estimate['ci95'][0]:.3g} to {estimate['ci95'][1]:.3g})" if estimate["ci95"] else ""
    return f"{estimate['value']:.3g}{interval}"
