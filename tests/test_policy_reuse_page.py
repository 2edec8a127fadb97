"""docs/policy_reuse.md: its Python runs as it stands, its commands as told, its numbers are what they print."""

import json
import re
import shlex
from pathlib import Path

import numpy as np
import pytest

from benchmarks.interaction.reuse import EI
from lifelore.app.command_line import run as run_command
from lifelore.interaction.library.policy_library import PolicyLibrary
from lifelore.interaction.outcomes.categorical_outcomes import CategoricalOutcomes
from lifelore.interaction.selection import RULES, ExpectedImprovement, Greedy
from reproduction.engine.claim_section import verdict_now
from reproduction.engine.report import read_results

RESULTS = Path(__file__).parents[1] / "results"
PAGE = (Path(__file__).parents[1] / "docs" / "policy_reuse.md").read_text(encoding="utf-8")
BLOCKS = re.findall(r"^```(python|sh)\n(.*?)^```", PAGE, flags=re.S | re.M)
ALONE, TUTORIAL = BLOCKS[:5], BLOCKS[5:]


@pytest.fixture
def run(tmp_path, monkeypatch, capsys):
    """Run a block here, in an empty folder with a memory of its own; what it prints."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path / "data"))

    def run(kind: str, text: str) -> str:
        if kind == "python":
            exec(compile(text, "policy_reuse.md", "exec"), {"__name__": "page"})
        else:
            for line in text.splitlines():
                assert run_command(shlex.split(line)[1:]) == 0, capsys.readouterr().err
        return capsys.readouterr().out

    return run


@pytest.mark.parametrize(
    ("place", "said"),
    [
        (0, r"C \[0\. 0\. 1\.\]\n"),
        (1, r"\[0\.\d+ 0\.\d+\] \[.*\]\n(left|right) \d+\.\d+\n"),
        (2, r"\[0 1\] 3 \[\[0\. 1\.\]\]\n\[1 1\]\n\[\[0 1\]\]\n"),
        (3, r"\[0\.\d+ 0\.\d+\] 1\n"),
        (4, r"\[0\.\d+ 0\.\d+\]\n"),
    ],
)
def test_each_piece_alone(place, said, run):
    assert re.fullmatch(said, run(*ALONE[place]))


@pytest.mark.slow
def test_the_tutorial_from_a_log_to_its_end(run, tmp_path):
    kinds = [kind for kind, _ in TUTORIAL]
    assert kinds == ["python", "sh", "python", "sh"]
    assert run(*TUTORIAL[0]) == ""
    fitted, *_, policy, decision = run(*TUTORIAL[1]).splitlines()
    assert re.match(r"study default: 720 outcomes of 60 users, 6 policies, 10 types named", fitted)
    assert policy in ("top", "bottom", "left", "right", "rows", "columns")
    assert decision.startswith("decision ")
    for line in run(*TUTORIAL[2]).splitlines():
        assert line in PAGE
    assert (tmp_path / "report" / "report.png").exists()
    told = run(*TUTORIAL[3])
    assert "columns is retired" in told
    assert "whole is given to the control group" in told
    assert "contributions of new 3 forgotten" in told


def test_where_outcomes_are_0_or_1_expected_improvement_is_greedy():
    probs = np.random.default_rng(0).random((4, 5))
    performance = CategoricalOutcomes([0, 1], np.stack([1 - probs, probs], axis=2))
    library = PolicyLibrary(performance)
    for belief in np.random.default_rng(1).dirichlet(np.ones(4), 20):
        greedy, improving = (
            rule.scores(library, belief) for rule in (Greedy(), ExpectedImprovement(of="outcome"))
        )
        assert np.argsort(greedy).tolist() == np.argsort(improving).tolist()


def test_every_rule_is_told():
    named = set(re.findall(r"`([A-Z]\w+)\(", PAGE.split("## Choosing")[1].split("## Beliefs")[0]))
    assert {rule.__name__ for rule in RULES.values()} <= named


def test_verdicts_are_those_of_the_results():
    told = re.findall(
        r"^\| \[(C4\.\d+)\]\(.*?\) \|[^|]*\| (holds in part|holds|does not hold|undecided): ", PAGE, flags=re.M
    )
    assert [claim for claim, _ in told] == [f"C4.{number}" for number in (*range(1, 14), 15, 16, 17)]
    now = {result["claim"]: verdict_now(result) for result in read_results(RESULTS)}
    assert dict(told) == {claim: now[claim] for claim, _ in told}


def test_speeds_are_those_of_the_benchmark():
    found = json.loads((RESULTS / "bench_reuse.json").read_text(encoding="utf-8"))
    values = {line["name"]: line["value"] for line in found["rows"]}
    ratios = [goal["measured"] for goal in found["goals"] if goal["name"].endswith((" / Lifelore", " / " + EI))]
    told = re.findall(r"^\| [a-z][^|]*\| (?:[\d.,]+ µs)? ?\| ([\d.,]+) \| [\d,]+ \|$", PAGE, flags=re.M)
    assert [float(number.replace(",", "")) for number in told] == pytest.approx(ratios, rel=0.02)
    for name in ("expected improvement, flat", "belief entropy, flat", "knowledge gradient, settled"):
        assert f"{values[f'{name} belief, 1000 x 1000 x 100'] / 1e3:.1f} ms" in PAGE
    learnt = re.findall(r"^\| ([a-z][a-z -]*) \| ([\d.]+) µs[^|]*\| ([\d.]+) (µs|ms)", PAGE, flags=re.M)
    assert len(learnt) == 5
    for name, small, large, unit in learnt:
        belief = "" if name == "update" else ", flat belief"
        of_large = values[f"{name}{belief}, 1000 x 1000 x 100, learnt models"]
        assert float(small) == pytest.approx(values[f"{name}, 68 x 68 x 50, learnt models"], rel=0.02)
        assert float(large) == pytest.approx(of_large / (1e3 if unit == "ms" else 1), rel=0.02)
    screened = "knowledge gradient, 1000 x 1000 x 100, learnt models, screened"
    for said in (
        f"{values['knowledge gradient, settled belief, 1000 x 1000 x 100, learnt models'] / 1e3:.0f} ms",
        f"{values[f'{screened}: decisions compared']:.0f} decisions",
        f"{100 * values[f'{screened}: share with the best policy']:.0f} %",
        f"{100 * values[f'{screened}: mean loss of score']:.2g} %",
        f"{100 * values[f'{screened}: largest loss of score']:.2g} %",
        *(
            f"{values[f'select and learn, {rule}, {models} models']:.0f} µs"
            for rule in ("expected improvement", "sampling")
            for models in ("plug-in", "uncertain")
        ),
    ):
        assert said in PAGE, said


def test_the_hazards_are_those_of_the_benchmark():
    found = json.loads((RESULTS / "bench_changing_types.json").read_text(encoding="utf-8"))
    value = {row["name"]: row["value"] for row in found["rows"]}
    told = re.findall(
        r"^\| (exact|learnt), ([\d.]+) \| ([\d,]+) \| ([\d.]+) % \| ([\d,]+) \| ([+−][\d.]+)?", PAGE, flags=re.M
    )
    assert len(told) == 10
    for models, hazard, changed, stuck, stayed, more in told:
        once, never = (
            f"{models} models, type {kind}, hazard {hazard}" for kind in ("changes once", "never changes")
        )
        assert float(changed.replace(",", "")) == pytest.approx(value[f"regret of 100 episodes, {once}"], abs=0.51)
        assert float(stayed.replace(",", "")) == pytest.approx(value[f"regret of 100 episodes, {never}"], abs=0.51)
        assert float(stuck) == pytest.approx(100 * value[f"stuck in the end, {once}"], abs=0.06)
        if hazard != "0":
            assert float(more.replace("−", "-")) == pytest.approx(
                value[f"regret more than static types, {never}"], abs=0.06
            )


def test_the_regrets_of_perfect_information_are_those_of_the_benchmark():
    found = json.loads((RESULTS / "bench_perfect_information.json").read_text(encoding="utf-8"))
    rows = {row["name"]: row for row in found["rows"]}

    def cell(name):
        if name not in rows:
            return "–"
        low, high = rows[name]["ci95"]
        return f"{rows[name]['value']:.2f} [{low:.2f} {high:.2f}]"

    told = PAGE.split("| rule | exact models | ten runs, plug-in |")[1].splitlines()[2:7]
    for line in told:
        rule, *cells, stuck = (part.strip() for part in line.strip("|").split("|"))
        names = [f"{rule}, {models} models" for models in ("exact", "learnt", "uncertain")]
        assert cells == [cell(f"relative regret, {name}") for name in names]
        most = max(rows.get(f"stuck above the least, at most, {name}", {"value": 0})["value"] for name in names)
        assert float(stuck.strip(" %")) == pytest.approx(100 * most, abs=0.51)
    exact, learnt = (
        cell(f"regret of perfect information / knowledge gradient, {models} models")
        for models in ("exact", "learnt")
    )
    assert f"it has {exact} times the regret with exact models (goal: at most 1.1, **missed**)" in PAGE
    assert f"{learnt} times with models of ten runs (met)" in PAGE
    assert [goal["met"] for goal in found["goals"]] == [False, True]


def test_the_losses_of_models_of_categories_are_those_of_the_benchmark():
    found = json.loads((RESULTS / "bench_bands.json").read_text(encoding="utf-8"))
    values = [row["value"] for row in found["rows"]]
    told = [line.split("|")[2:-1] for line in PAGE.split("| runs a pair | 1 |")[1].splitlines()[2:6]]
    # Rows of the file are by number of runs, then by model; those of the page by model.
    assert np.array(told, float).T.ravel() == pytest.approx(np.array(values), abs=0.0006)


def test_what_ten_runs_a_pair_give_is_what_the_claims_measured():
    rules, bandits = (
        json.loads((RESULTS / claim / "result.json").read_text(encoding="utf-8"))["measured"]
        for claim in ("C4.5", "C4.7")
    )
    names = ("expected improvement", "information-directed", "knowledge gradient", "sampling")
    short = dict(zip(names, ("EI", "IDS", "KG", "sampling"), strict=True))
    told = PAGE.split("| rule | plug-in, seen |")[1].splitlines()[2:6]
    for line in told:
        name, *cells = (cell.strip() for cell in line.strip("|").split("|"))
        ways = [(case, word) for word in ("seen", "unseen") for case in ("headline", "uncertain_with_unseen")]
        for cell, (case, word) in zip(cells, ways, strict=True):
            regret, stuck = (float(number.strip(" %").replace(",", "")) for number in cell.rsplit(", ", 1))
            found = {key: rules[f"{key}_{word}_{short[name]}_{case}"]["value"] for key in ("cumulative", "stuck")}
            assert (regret, stuck) == pytest.approx((found["cumulative"], 100 * found["stuck"]), abs=0.51)
    best = bandits["cumulative_best_GP_UCB_unseen"]["value"]
    assert f"a regret of {best:,.0f} on unseen tasks" in PAGE
    ratio = bandits["IDS_doubting_over_best_GP_UCB_unseen"]
    low, high = ratio["ci95"]
    assert f"{ratio['value']:.2f} [{low:.2f} {high:.2f}] of that regret" in PAGE.replace("\n", " ")


def test_what_ten_runs_a_pair_give_in_other_worlds_is_what_the_claims_measured():
    golf, phone, pacman = (
        json.loads((RESULTS / claim / "result.json").read_text(encoding="utf-8"))["measured"]
        for claim in ("C4.2", "C4.3", "C4.4")
    )
    measured = [
        (golf["error_shot_2_learnt"], golf["error_shot_2_uncertain"], 1, 0.051),
        (pacman["reached_bpr"], pacman["reached_bpr_doubting"], 100, 0.51),
        (pacman["median_needed_bpr"], pacman["median_needed_bpr_doubting"], 1, 0.01),
        (pacman["regret_bpr"], pacman["regret_bpr_doubting"], 1, 0.51),
        *(
            (phone[f"zero_at_end_{signal}_learnt"], phone[f"zero_at_end_{signal}_uncertain"], 100, 0.051)
            for signal in ("u", "sar", "sas")
        ),
    ]
    told = PAGE.split("| world | plug-in | uncertain | goal |")[1].splitlines()[2:9]
    for line, (plug_in, uncertain, factor, near) in zip(told, measured, strict=True):
        numbers = [float(cell.strip(" %").replace(",", "")) for cell in line.strip("|").split("|")[1:3]]
        found = [factor * measure["value"] for measure in (plug_in, uncertain)]
        assert numbers == pytest.approx(found, abs=near), line
    assert f"{100 * pacman['reached_stretch_bpr']['value']:.0f} % too" in PAGE
    assert f"as with exact ones ({golf['error_shot_2_exact']['value']:.1f})" in PAGE


def test_the_default_rule_with_uncertain_models_is_as_the_claim_measured():
    found = json.loads((RESULTS / "O1" / "result.json").read_text(encoding="utf-8"))["measured"]
    text = " ".join(PAGE.split("- **With uncertain models**")[1].split("The decision stands")[0].split())

    def told(name: str, sign: int = 1) -> str:
        low, high = sorted(sign * end for end in found[name]["ci95"])
        return f"{sign * found[name]['value']:.2f} [{low:.2f} {high:.2f}]"

    assert told("regret_IDS_uncertain") in text
    assert told("regret_EI_pay_uncertain") in text
    assert told("regret_IDS_uncertain_minus_plug_in", -1) in text
    for rule in ("IDS", "EI_pay"):
        assert f"{100 * found[f'stuck_above_least_{rule}_uncertain']['value']:.0f} %" in text
