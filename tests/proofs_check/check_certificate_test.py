"""Tests proofs_check/check_certificate.py: it accepts what is true, and nothing that is false.

The certificates come from reference_certificates.py. Every leaf of each is changed in several ways; a mutant that is accepted
must be true, which is decided by making the certificate of the mutant's own model anew (`why_true`), and for one of the few
reasons that are listed in ALLOWED.

    check_certificate_test.py [unittest arguments]     MUTANTS=all tries all changes of every place (minutes), not one
"""

import contextlib
import io
import itertools
import json
import os
import random
import re
import subprocess
import sys
import tempfile
import unittest
from fractions import Fraction

HERE = os.path.dirname(os.path.abspath(__file__))
CHECKER = os.path.join(HERE, "..", "..", "proofs_check", "check_certificate.py")
sys.path[:0] = [HERE, os.path.dirname(CHECKER)]
import check_certificate as checker  # noqa: E402
import reference_certificates as reference  # noqa: E402

# The verdicts in the order of the table: lemma-1, lemma-1-iterates, lemma-2, lemma-3 (not by bounds), theorem-1, A, B, C, D, E, F.
EXPECTED = {
    "one_sided_corrected": "hhhhhhhhhhh", "one_sided_paper": "vhvhvhhhhhh", "cycle": "hhhhhhhhhhh", "cycle_ties": "hhhhhhhhhhh",
    "cycle_ties_highest": "hhhhhhhhhhh", "cycle_ties_apart": "uhhhhhhhhhh", "chain_l1": "hhhhhhhhhhh", "plane_l2": "hhhhhhhhhhh",
    "islands": "hhhhhhhhhhh",
    "eps_zero": "hhhhhhhhhhh", "one_state": "hhhhhhhhhhh", "tied_lowest": "hhhhhhhhhhh", "tied_highest": "hhhhhhhhhhh",
    "negative": "hhhhhhhhhhh", "negative_paper": "vhhhhhhhhhh", "mirror": "hhhhhhhhhhh", "twins": "hhhhhhhhhhh",
    "twins_tie": "hhhhhhhhhhh", "discount_zero": "hhhhhhhhhhh", "pit": "hhhhhhhhhhh", "pit_highest": "hhhhhhhhhhh",
    "rows": "hhhhhhhhhhh", "rows_highest": "hhhhhhhhhhh", "detour": "hhhhhhhhhhh", "late": "hhhhhhhhhhh", "undecided": "uuuhuuuuuhu",
    "lower_bound": "hhhhhhhhhhh", "random_six": "hhhhhhhhhhh", "hops": "hhhhhhhhhhh", "discrete": "hhhhhhhhhhh",
    "some_positions": "hhhhhhhhhhh", "some_starts": "hhhhhhhhhhh", "boxes_cycle": "hhhhhhhhhhh", "boxes_cycle_one": "hhhhhhhhhhh",
    "boxes_paper": "vhvhuhhhhhh",
    "boxes_plane_l2": "hhhhhhhhhhh", "boxes_single": "hhhhuuuuuhh", "boxes_random": "hhhhhhhhhhh", "boxes_wide": "hhhhhhhhhhh",
    "bounds_chain": "hhhhhhhhhh", "bounds_cycle": "hhhhhhhhhh", "bounds_cycle_paper": "hhhhhhhhhh", "bounds_plane_l2": "hhhhhhhhhh",
    "bounds_twins": "hhhhhhhhhh", "bounds_islands": "hhhhhhhhhu", "bounds_blind": "hhhuuuuuuu", "bounds_single": "hhhuuuuuuu",
    "bounds_hops": "hhhhhhhhhh", "bounds_negative": "uhuhhhhhhh", "bounds_random": "hhhhhhhhhh", "bounds_undecided": "uuuuuuuuhu",
    "bounds_pit": "hhhhhhhhhh"}

CLAIMS = ["lemma-1", "lemma-1-iterates", "lemma-2", "lemma-3", "theorem-1", "A", "B", "C", "D", "E", "F"]
WORDS = ["l1", "l2", "linf", "hops", "discrete", "maximin-bounds", "corrected", "paper", "lowest", "highest", "holds", "violated",
         "undetermined", "lemma-1", "A", "F"]

# Why an accepted mutant may be true.
ALLOWED = {
    "another place that attains the same constant",
    "another instance of the same sides",
    "another radius, other classes or number of rounds for which everything else is the same",
    "other lower bounds of the belief game",
    "other boxes or bounds that are as true",
    "less is claimed",
    "of another model, reading or tie, with the same consequences",
}

REFERENCE = reference.reference()

if hasattr(sys, "set_int_max_str_digits"):
    sys.set_int_max_str_digits(0)


def check(document):
    """The rows that the checker prints, or the text of its refusal."""
    try:
        return checker.check_certificate(checker.Node(document))
    except checker.NotACertificate as error:
        return str(error)


def model_of(document):
    """The reference model of a certificate that the checker accepted."""
    d = document["model"]
    rows = [[{} for _ in range(d["actions"])] for _ in range(d["states"])]
    for s, a, t, p in d["transitions"]:
        rows[s][a][t] = Fraction(p)
    return reference.Model(d["discount"], d["eps"], d["rewards"], rows, d.get("points"), d.get("norm"), d.get("distances"),
                           d.get("metric"))


def attains(document, name):
    """Whether constants.NAME.at is a place of the stated value."""
    model, entry = model_of(document), document["constants"][name]
    s, t, a, *u = entry["at"]
    jumps = [abs(model.P[s][a].get(x, 0) - model.P[t][a].get(x, 0)) for x in model.S]
    Q = model.back([Fraction(x) for x in document["optimal"]])
    found = {"l_r": abs(model.R[s][a] - model.R[t][a]), "l_star": abs(Q[s][a] - Q[t][a]), "k": Fraction(sum(jumps)) / 2,
             "l_p": jumps[u[0]] if u else None}[name]
    return s < t and found / model.high[s][t] == Fraction(entry["value"])


def numbers(texts):
    return [Fraction(x) for x in texts]


def boxes_of(document):
    limit = document["limit"]
    return limit and "boxes" in limit and [{name: numbers(table) for name, table in box.items()} for box in limit["boxes"]]


def game_of(document):
    """Positions and values."""
    game = document["belief_game"]
    return game and ([(s, tuple(M)) for s, M in game["positions"]], numbers(game["values"]))


def truth_of(document):
    """The certificate with the free choices of this one, and its instances."""
    model, limit, game = model_of(document), document["limit"], document["belief_game"]
    if document["format"] == "maximin-bounds":
        free = {"constants": {name: (Fraction(entry["value"]), entry["at"]) for name, entry in document["constants"].items()
                              if isinstance(entry, dict)},
                "low": numbers(document["optimal"]["low"]), "high": numbers(document["optimal"]["high"]), "bits": document["bits"],
                "rounds": len(document["rounds"]),
                "pairs": [(numbers(pair["below"]), numbers(pair["above"])) for pair in document["pairs"]],
                "boxes": boxes_of(document), "test": numbers(document["test_time"]["below"]), "game": game_of(document)}
        return reference.examine_bounds(model, document["reading"], document["tie"], free)
    options = {"reading": document["reading"], "tie": document["tie"], "rounds": len(document["rounds"]), "with_beliefs": bool(game),
               "with_limit": bool(limit)}
    if boxes_of(document):
        options["boxes"] = boxes_of(document)
    elif limit:
        options.update(radius=Fraction(limit["radius"]), classes=limit["classes"])
    if game and not game["exact"]:
        options["game"] = game_of(document)
    return reference.examine(model, **options)


def why_claims_are_true(stated, expected, instances):
    """The reasons why claims that may differ from those expected are true; raises ValueError where they are not."""
    order, reasons = [claim["claim"] for claim in expected], set()
    names = [claim["claim"] for claim in stated]
    if not names or names != [name for name in order if name in names]:
        raise ValueError("claims")
    if names != order:
        reasons.add("less is claimed")
    for claim in stated:
        truth = expected[order.index(claim["claim"])]
        if claim == truth:
            continue
        if claim["verdict"] == "undetermined":
            reasons.add("less is claimed")
            continue
        sides = (Fraction(claim["left"]), Fraction(claim["right"]))
        least = instances[claim["claim"]][0]
        found = [x for x in instances[claim["claim"]] if x[0] == claim["at"] and x[1:3] == sides]
        if claim["verdict"] != truth["verdict"] or not found or sides[1] - sides[0] != least[2] - least[1]:
            raise ValueError(f"claim {claim['claim']}")
        reasons.add("another instance of the same sides")
    return reasons


def why_true(document, original):
    """The reason, one of ALLOWED, why an accepted mutant is true; else what is false."""
    try:
        truth, instances = truth_of(document)
        reasons = why_claims_are_true(document["claims"], truth["claims"], instances)
    except ValueError as error:
        return f"FALSE: {error}"
    exact = document["format"] == "maximin-certificate"
    for name in document:
        if name == "constants" and exact:
            for key, entry in document[name].items():
                expected = truth[name][key]
                if entry != expected:
                    if entry["value"] != expected["value"] or not attains(document, key):
                        return f"FALSE: constants.{key}"
                    reasons.add("another place that attains the same constant")
        elif name != "claims" and document[name] != truth[name]:
            return f"FALSE: {name}"
    if document["model"] != original["model"] or any(document[x] != original[x] for x in ("reading", "tie")):
        reasons.add("of another model, reading or tie, with the same consequences")
    if document["belief_game"] != original["belief_game"]:
        reasons.add("other lower bounds of the belief game")
    if document["limit"] and "radius" in document["limit"]:
        if document["rounds"] != original["rounds"] or any(document["limit"][x] != original["limit"][x] for x in ("radius", "classes")):
            reasons.add("another radius, other classes or number of rounds for which everything else is the same")
    elif any(document[x] != original[x] for x in document if x not in ("claims", "belief_game") and (x != "constants" or not exact)):
        reasons.add("other boxes or bounds that are as true")
    return min(reasons) if reasons else "FALSE: nothing was changed"


def number_mutants(text, rng):
    x = Fraction(text)
    yield from (str(x + 1), str(-x), str(x / 2), str(x + Fraction(1, 10**6)))
    digits = [i for i, character in enumerate(text) if character.isdigit()]
    at = rng.choice(digits)
    yield text[:at] + str((int(text[at]) + rng.randrange(1, 10)) % 10) + text[at + 1:]
    yield rng.choice([text + "0", text + "/1", "+" + text, " " + text, text + ".0", text + "e0", "0" + text, "-0", "", "1/0", "2/4", "NaN",
                      "1e999", "\u0661", text + "\n"])
    yield rng.choice([None, True, 0, 1.5, [text], {}])


def leaf_mutants(value, rng):
    if isinstance(value, str):
        yield from number_mutants(value, rng) if re.fullmatch("-?[0-9]+(/[0-9]+)?", value) else WORDS
        yield value + "x"
    elif isinstance(value, bool):
        yield from (not value, int(value), str(value))
    elif isinstance(value, int):
        yield from (value + 1, value - 1, -value - 1, value + 10**18, float(value), str(value), bool(value))
    elif value is None:
        yield from ("0", [], {}, False)


def container_mutants(value):
    if isinstance(value, dict):
        yield dict(value, extra=1)
        for name in value:
            yield {key: item for key, item in value.items() if key != name}
        yield list(value.values())
    elif isinstance(value, list) and value:
        yield value[:-1]
        yield value + [value[-1]]
        if value[::-1] != value:
            yield value[::-1]
            yield value[1:2] + value[:1] + value[2:]
        yield {}
    yield None


def canonical(classes):
    """The same partition, numbered as they first occur."""
    numbers = {}
    return [[numbers.setdefault(c, len(numbers)) for c in row] for row in classes]


def class_mutants(classes):
    """All merges of two classes, all splits of one entry from its class, all pairs of numbers exchanged; all apart, all one."""
    count = max(map(max, classes)) + 1
    for c in range(count):
        for d in range(c):
            yield "merged", canonical([[d if x == c else x for x in row] for row in classes])
            yield "renumbered", [[d if x == c else c if x == d else x for x in row] for row in classes]
    for s, row in enumerate(classes):
        for a, c in enumerate(row):
            if sum(other.count(c) for other in classes) > 1:
                yield "split", canonical(classes[:s] + [row[:a] + [count] + row[a + 1:]] + classes[s + 1:])
    yield "split", [[s * len(row) + a for a in range(len(row))] for s, row in enumerate(classes)]
    yield "merged", [[0] * len(row) for row in classes]
    yield "renumbered", [[c + 1 for c in row] for row in classes]


def mutants(document, rng, most):
    """(place, change, mutant) for at most so many changes of every leaf, object and array; undone when the next is asked for."""
    # The holder stands for what contains the certificate, so that it is changed as a whole as well.
    holder = [document]
    todo = [(holder, 0, "$")]
    while todo:
        parent, key, place = todo.pop()
        value = parent[key]
        if isinstance(value, (dict, list)):
            items = value.items() if isinstance(value, dict) else enumerate(value)
            todo += [(value, name, f"{place}.{name}" if isinstance(value, dict) else f"{place}[{name}]") for name, _ in items]
            changes = container_mutants(value)
        else:
            changes = leaf_mutants(value, rng)
        if place.startswith("$.claims[") and place.count("[") == place.count(".") == 1 and value["verdict"] != "undetermined":
            changes = [*changes, {"claim": value["claim"], "verdict": "undetermined"}]
        changes = [change for change in changes if type(change) is not type(value) or change != value]
        for change in rng.sample(changes, min(most, len(changes))):
            parent[key] = change
            yield place, change, holder[0]
        parent[key] = value


def quiet(document):
    """A certificate that claims nothing: what is refused of it is not refused for its claims."""
    return dict(document, claims=[{"claim": "E", "verdict": "undetermined"}])


def find(document, path):
    """The container and the key of a place such as limit.boxes[0].low[2]."""
    keys = [int(key) if key.isdigit() else key for key in re.findall(r"\w+", path)]
    for key in keys[:-1]:
        document = document[key]
    return document, keys[-1]


def free_numbers(document):
    """(path, sign) of the numbers that may be chosen; sign: in which direction they can be wrong."""
    tables = [("optimal.low", 1), ("optimal.high", -1), ("test_time.below", 1)] if document["format"] == "maximin-bounds" else []
    if tables:
        yield from ((f"constants.{name}.value", 1) for name in ("l_r", "l_p", "k", "l_star") if document["constants"][name]["at"])
        tables += [(f"pairs[{i}].{name}", sign) for i in range(len(document["pairs"])) for name, sign in (("below", 1), ("above", -1))]
    if document["limit"] and "boxes" in document["limit"]:
        tables += [(f"limit.boxes[{j}].{name}", sign) for j in range(len(document["limit"]["boxes"]))
                   for name, sign in (("low", 1), ("high", -1), ("below", 1), ("above", -1))]
    if document["belief_game"] and not document["belief_game"].get("exact"):
        tables.append(("belief_game.values", 1))
    for path, sign in tables:
        parent, key = find(document, path)
        yield from ((f"{path}[{i}]", sign) for i in range(len(parent[key])))


def tight(document):
    """A certificate by bounds of the same model, all of whose bounds are attained, but for the last box."""
    model, tie = model_of(document), document["tie"]
    V = model.extreme_value([list(model.A)] * model.n, max)
    Q = model.back(V)
    steps, between = reference.bounded_rounds(model, tie, len(document["rounds"]), document["bits"])
    keys = [(step.C, step.provoked(x)) for step, (_, x) in zip(steps, between)]

    def enclose(C, A):
        return model.extreme_value(reference.all_shown(model, C), min), model.extreme_value(A, max)

    boxes = boxes_of(document)
    for j, box in enumerate(boxes):
        step = reference.Step(model, model.back(boxes[j - 1]["low"]), model.back(boxes[j - 1]["high"]), tie)
        if j + 1 < len(boxes):
            box.update(low=step.low, high=step.high)
        box["below"], box["above"] = enclose(step.C, step.provoked(box["high"]))
    C = reference.Step(model, Q, Q, tie).C
    free = {"constants": reference.constants_of(model, Q)[0], "low": V, "high": V, "bits": document["bits"], "rounds": len(keys),
            "pairs": [enclose(*key) for n, key in enumerate(keys) if key not in keys[:n]], "boxes": boxes,
            "test": enclose(C, C)[0], "game": reference.belief_game(model, lambda M: reference.surviving(model, Q, Q, M, tie))}
    # l_star is an increase from one state to the other
    value, at = free["constants"]["l_star"]
    if at and Q[at[0]][at[2]] < Q[at[1]][at[2]]:
        free["constants"]["l_star"] = value, [at[1], at[0], at[2]]
    return reference.examine_bounds(model, document["reading"], tie, free)[0]


def bounds_with(model, rounds, boxes):
    """A certificate by bounds with a limit by these boxes."""
    document = reference.bounds_certificate(model, rounds=rounds)[0]
    document["limit"] = {"boxes": [{name: reference.text(V) for name, V in box.items()} for box in boxes]}
    return truth_of(document)[0]


def all_instances(name, families):
    """(at, left, right, proves) of the checker's families."""
    for n, proves, over, right_over, rows in families:
        for states, lefts, right in rows:
            for a, left in enumerate(lefts):
                at = {} if n is None else {"n": n}
                if states:
                    at["states"] = list(states)
                    if name != "F":
                        at["action"] = a
                if left is not None:
                    yield at, Fraction(left, over), Fraction(right, right_over), proves


class AcceptsWhatIsTrue(unittest.TestCase):
    def test_reference_certificates_with_the_expected_verdicts(self):
        self.assertEqual(sorted(EXPECTED), sorted(REFERENCE))
        for name, document in REFERENCE.items():
            rows = check(document)
            self.assertIsInstance(rows, list, f"{name}: {rows}")
            names = [name for name in CLAIMS if name != "lemma-3" or document["format"] == "maximin-certificate"]
            self.assertEqual([row[0] for row in rows], names)
            self.assertEqual("".join(row[1][0] for row in rows), EXPECTED[name], name)

    def test_all_instances(self):
        """Of every claim exactly those of the reference, not only the one that is stated."""
        for name, document in REFERENCE.items():
            by_bounds = document["format"] == "maximin-bounds"
            found, _ = (checker.check_bounds if by_bounds else checker.check_exact)(checker.Node(document))
            expected = truth_of(document)[1]
            for claim in document["claims"]:
                families = found.of(claim["claim"])
                self.assertEqual(families is None, claim["claim"] not in expected, (name, claim))
                if families is None:
                    continue
                seen = {(json.dumps(at), left, right) for at, left, right, proves in all_instances(claim["claim"], families)
                        if proves or claim["verdict"] != "violated"}
                self.assertEqual(seen, {(json.dumps(x[0]), *x[1:3]) for x in expected[claim["claim"]]}, (name, claim))

    def test_printed_bound_of_the_one_sided_model_is_violated(self):
        theorem = check(REFERENCE["one_sided_paper"])[4]
        self.assertEqual(theorem[:4], ("theorem-1", "violated", "10", "6"))

    def test_cycle_has_period_three(self):
        self.assertEqual(REFERENCE["cycle"]["limit"]["period"], 3)

    def test_other_witnesses_of_the_same_limit(self):
        for name, document in REFERENCE.items():
            if not document["limit"] or "boxes" in document["limit"]:
                continue
            model, N = model_of(document), len(document["rounds"])
            options = {"reading": document["reading"], "tie": document["tie"]}
            period = document["limit"]["period"]
            variants = [{"rounds": N + period}, {"rounds": N + 1, "repeat": 1} if period == 1 else {}, {"repeat": 2},
                        {"rounds": N + 6, "radius": Fraction(document["limit"]["radius"]) * Fraction(99, 100)}, {"with_limit": False},
                        {"with_beliefs": False}, {"belief_slack": Fraction(1, 100)}]
            for variant in variants:
                other = reference.certificate(model, **options, **variant)
                self.assertIsInstance(check(other), list, f"{name} {variant}: {check(other)}")


class RefusesWhatIsFalse(unittest.TestCase):
    def test_mutants(self):
        rng, counts, wrong = random.Random(7), {"refused": 0}, []
        for name, original in REFERENCE.items():
            document = json.loads(json.dumps(original))
            most = 99 if os.environ.get("MUTANTS") == "all" else 1
            for place, change, mutant in mutants(document, rng, most):
                answer = check(mutant)
                if isinstance(answer, str):
                    counts["refused"] += 1
                    self.assertTrue(answer.startswith("$") and "expected" in answer and "\n" not in answer, answer)
                    continue
                reason = why_true(mutant, original)
                if reason not in ALLOWED:
                    wrong.append(f"{name}: {place} -> {change!r} is accepted: {reason}")
                counts[reason] = counts.get(reason, 0) + 1
            self.assertEqual(document, original)
        print(counts, file=sys.stderr)
        self.assertEqual(wrong, [])
        self.assertGreater(counts["refused"], 4000)

    def test_classes(self):
        """Of the coarsest classes no two may be merged, and no numbers exchanged; finer ones may be as true."""
        counts = {}
        for name, original in REFERENCE.items():
            if not original["limit"] or "boxes" in original["limit"] or name == "cycle_ties_apart":  # its classes are not the coarsest
                continue
            document = json.loads(json.dumps(original))
            for kind, classes in class_mutants(original["limit"]["classes"]):
                if classes == original["limit"]["classes"]:
                    continue
                document["limit"]["classes"] = classes
                answer = check(document)
                if isinstance(answer, str):
                    self.assertIn("$.limit", answer)
                    reason = "refused"
                else:
                    reason = why_true(document, original)
                    self.assertTrue(kind == "split" and "other classes" in reason, f"{name}: {kind} {classes} is accepted: {reason}")
                counts[kind, reason] = counts.get((kind, reason), 0) + 1
        print(counts, file=sys.stderr)
        self.assertGreater(counts["merged", "refused"], 100)
        self.assertGreater(counts["split", "refused"], 10)

    def test_classes_decide(self):
        """With all entries apart, nothing of this is decided: the index of an action is, which radius and values do not show."""
        for name in ("pit", "twins_tie", "cycle_ties"):
            document = REFERENCE[name]
            apart = [[s * len(row) + a for a in range(len(row))] for s, row in enumerate(document["limit"]["classes"])]
            self.assertIn("$.limit", check(dict(document, limit=dict(document["limit"], classes=apart))), name)

    def test_which_classes_count(self):
        """States 2 and 3 are pits in every ball; an action is dropped for another that has fewer classes within 2r of the least."""
        half = Fraction(1, 2)

        def split(of_reward, tie, *actions):
            """The certificate with entries of state 3 taken from their class."""
            rows = [[{0: half, 1: half}, {0: 1}], [{0: 1}, {1: half, 2: half}], [{2: 1}] * 2, [{2: 1}] * 2]
            model = reference.Model("9/10", 2, [[1, 2], [2, "1/2"], [-5, -5], [of_reward] * 2], rows,
                                    points=[[0, 0], [1, 0], [2, 0], [2, 1]], norm="linf")
            document = reference.certificate(model, tie=tie)
            classes = document["limit"]["classes"]
            for a in actions:
                classes[3][a] = len(classes) * 2 + a
            document["limit"]["classes"] = canonical(classes)
            return document

        for tie, first in (("lowest", 0), ("highest", 1)):
            for a in (0, 1):
                answer = check(split(-5, tie, a))
                self.assertEqual(isinstance(answer, str), a == first, answer)
        near = split("-49/10", "lowest", 0, 1)
        self.assertIsInstance(check(near), list)
        near["limit"]["radius"] = "1/20"
        self.assertIn("condition 1", check(near))

    def test_triangle_inequality(self):
        """Of all matrices of three states those are refused that disobey it as the page states it."""
        model = REFERENCE["tied_lowest"]["model"]
        infinity = float("inf")
        for x, y, z in itertools.product(("0", "1/2", "1", "3/2", "3", None), repeat=3):
            d = [["0", x, y], [x, "0", z], [y, z, "0"]]
            value = [[infinity if cell is None else Fraction(cell) for cell in row] for row in d]
            obeys = all(value[s][u] <= value[s][t] + value[t][u] for s in range(3) for t in range(3) for u in range(3))
            try:
                checker.Model(checker.Node(dict(model, distances=d)))
                self.assertTrue(obeys, d)
            except checker.NotACertificate as error:
                self.assertFalse(obeys, d)
                self.assertRegex(str(error), "[.]distances: .*triangle inequality")

    def test_violation_by_values_that_nobody_has(self):
        """In period 2 the attacker of theorem-1 is indifferent somewhere, so `fixed` is null; elsewhere it is not the optimal attacker.

        The gap of `low` is above the printed bound, that of the pairs (pi_n, om_n) is not: *violated* would be false.
        """
        rewards = [[0, 0], [0, 0], [0, 0], [-7, -8], [-4, 0], [-2, -4], [-8, -5],  # a cycle in which om_n is not optimal
                   [0, 0], [0, 0], [0, 0], [0, -1], [-1, -2], [-2, -3],            # 7 prefers 0, 9 prefers 1, 8 does not care
                   [0, -1], ["-17/200", "-217/200"]]                               # these set l_r
        targets = [[6, 3], [4, 3], [5, 1], [5, 4], [2, 0], [1, 4], [1, 0], [10, 11], [10, 10], [12, 10], [10, 10], [11, 11], [12, 12],
                   [13, 13], [13, 13]]
        distances = [[0 if s == t else None for t in range(15)] for s in range(15)]
        for s, t, d in ((0, 1, 1), (1, 2, 1), (0, 2, 2), (7, 8, 1), (8, 9, 1), (7, 9, 2), (13, 14, 2)):
            distances[s][t] = distances[t][s] = d
        model = reference.Model("9/10", 1, rewards, reference.sure(*targets), distances=distances)
        apart = [[2 * s, 2 * s + 1] for s in range(15)]
        document, instances = reference.examine(model, reading="paper", with_beliefs=False, classes=apart)
        self.assertEqual((document["limit"]["period"], document["limit"]["fixed"]), (2, [None, None]))
        self.assertEqual(check(document)[4][1], "undetermined")
        at, left, right, _ = min(instances["theorem-1"], key=lambda x: x[2] - x[1])
        self.assertGreater(left, right)
        Q = model.back(model.extreme_value([[0, 1]] * model.n, max))
        N = len(document["rounds"])
        for policy, attack in reference.run(model, "lowest", N + 4)[1][N:]:
            self.assertLess(reference.far(Q, model.back(model.value([policy[t] for t in attack]))), right)
        document["claims"][4] = {"claim": "theorem-1", "verdict": "violated", "left": str(left), "right": str(right), "at": at}
        self.assertIn("$.claims[4].at", check(document))

    def test_values_above_the_game_and_violations_that_are_none(self):
        document = json.loads(json.dumps(REFERENCE["lower_bound"]))
        document["belief_game"]["values"][0] = "1000"
        self.assertIn("$.belief_game.values", check(document))
        document = json.loads(json.dumps(REFERENCE["one_sided_paper"]))
        document["reading"] = "corrected"
        self.assertIn("$.claims[0]", check(document))


class Rules(unittest.TestCase):
    """Each rule of boxes, bounds, metrics and missing positions, broken alone: refused, at the place of what is false."""

    TINY = Fraction(1, 10**9)

    def accepted(self, document):
        answer = check(quiet(document))
        self.assertIsInstance(answer, list, answer)

    def refused(self, name, changes, place):
        """The certificate with these changes, {path: value or function of the old value}; it claims nothing."""
        document = json.loads(json.dumps(quiet(REFERENCE[name] if isinstance(name, str) else name)))
        self.accepted(document)
        for path, change in changes.items():
            parent, key = find(document, path)
            parent[key] = change(parent[key]) if callable(change) else change
        answer = check(document)
        self.assertRegex(str(answer), r"\A" + re.escape(place), f"{name} {changes}")

    def test_every_free_number_of_tight_certificates(self):
        """All bounds are attained: an entry that is a little too large or too small is refused where it is."""
        count = 0
        for name in ("bounds_chain", "bounds_cycle", "bounds_islands", "bounds_hops", "bounds_random", "bounds_pit", "bounds_plane_l2",
                     "some_positions", "some_starts"):
            document = tight(REFERENCE[name]) if name.startswith("bounds") else REFERENCE[name]  # whose game is tight
            self.accepted(document)
            on_a_grid = f"limit.boxes[{len(document['limit'].get('boxes', [])) - 1}]"
            for path, sign in free_numbers(document):
                table = re.sub(r"(\.value|\[[0-9]+\])$", "", path)
                if table.startswith(on_a_grid) and table.endswith(("low", "high")):
                    continue
                self.refused(document, {path: lambda x, sign=sign: str(Fraction(x) + sign * self.TINY)}, f"$.{table}")
                count += 1
        self.assertGreater(count, 300)

    def test_free_numbers_are_accepted_if_and_only_if_they_are_true(self):
        rng, counts = random.Random(3), {False: 0, True: 0}
        for name, original in REFERENCE.items():
            if not name.startswith(("boxes", "bounds", "some")):
                continue
            document = json.loads(json.dumps(quiet(original)))
            for path, _ in free_numbers(document):
                parent, key = find(document, path)
                old = parent[key]
                changes = [rng.choice([-1, 1]) * rng.choice([Fraction(1, 2**14), Fraction(1, 3)])]
                for change in changes + [5] * (".high" in path):  # a box that is so much higher may provoke more
                    parent[key] = str(Fraction(old) + change)
                    try:
                        truth_of(document)
                        true = True
                    except ValueError:
                        true = False
                    self.assertEqual(isinstance(check(document), list), true, f"{name} {path} {parent[key]}: {check(document)}")
                    counts[true] += 1
                parent[key] = old
        print(counts, file=sys.stderr)
        self.assertGreater(min(counts.values()), 200)

    def test_boxes_of_one_state(self):
        """x_n rises (or falls) to 15/2 (or -15/2), so that a box from x_1 = 5 to there is tight on all sides."""
        for sign, inner, outer in ((1, "low", "high"), (-1, "high", "low")):
            model = reference.Model("1/3", 2, [[sign * 5, sign * 5]], [[{0: 1}, {0: 1}]], points=[[0]], norm="linf")
            end, box = Fraction(sign * 15, 2), {}
            box = {inner: [Fraction(sign * 5)], outer: [end], "below": [end], "above": [end]}
            for document in (reference.certificate(model, rounds=2, boxes=[box]), bounds_with(model, 2, [box])):
                for name, direction, condition in ((inner, sign, 1), (outer, -sign, 2), ("below", 1, None), ("above", -1, None)):
                    self.refused(document, {f"limit.boxes[0].{name}[0]": str(box[name][0] + direction * self.TINY)},
                                 f"$.limit.boxes[0].{name}: [0] is too")
                    if condition:
                        changed = json.loads(json.dumps(quiet(document)))
                        changed["limit"]["boxes"][0][name][0] = str(box[name][0] + direction * self.TINY)
                        self.assertIn(f"condition {condition}", check(changed))

    def test_what_is_provoked_depends_on_the_box(self):
        """In state 0 the attacker provokes action 0 for 0; but in a box up to 10 action 1 as well, which is worth 20."""
        model = reference.Model("1/2", 1, [[0, 10], [1, -1], [-9, 3]], reference.sure(*[[s, s] for s in range(3)]),
                                points=[[0], [1], [2]], norm="l1")
        box = dict(zip(("low", "high", "below", "above"), map(numbers, ([0, -2, 3], [9, -1, 6], [0, -2, 6], [0, -2, 6]))))
        for document in (reference.certificate(model, rounds=2, boxes=[box]), bounds_with(model, 2, [box])):
            self.refused(document, {"limit.boxes[0].high[0]": "10"}, "$.limit.boxes[0].above: [0] is too small")
            document["limit"]["boxes"][0]["high"][0], document["limit"]["boxes"][0]["above"][0] = "10", "20"
            self.accepted(document)
            self.refused(document, {"limit.boxes[0].above[0]": str(20 - self.TINY)}, "$.limit.boxes[0].above: [0] is too small")

    def test_the_last_box_is_around_the_last_round(self):
        apart = 0
        for name, original in REFERENCE.items():
            if not name.startswith("bounds") or not original["limit"]:
                continue
            x = reference.bounded_rounds(model_of(original), original["tie"], len(original["rounds"]), original["bits"])[1][-1]
            apart += x[0] != x[1]
            last = f"limit.boxes[{len(original['limit']['boxes']) - 1}]"
            for s in range(original["model"]["states"]):
                for end, value, says in (("low", x[0][s] + self.TINY, "is too large, expected at most"),
                                         ("high", x[1][s] - self.TINY, "is too small, expected at least")):
                    self.refused(name, {f"{last}.{end}[{s}]": str(value)}, f"$.{last}.{end}: [{s}] {says} x_{{N-1}} (condition 1)")
        self.assertGreater(apart, 4)

    def test_form_of_boxes(self):
        for name in ("boxes_cycle", "bounds_cycle"):
            self.refused(name, {"limit.boxes": []}, "$.limit.boxes: no boxes")
            self.refused(name, {"limit.period": 3}, "$.limit: unknown member")
            self.refused(name, {"limit.boxes[1].radius": "1"}, "$.limit.boxes[1]: unknown member")
            self.refused(name, {"limit.boxes[1].above": None}, "$.limit.boxes[1].above: null")
            self.refused(name, {"limit.boxes": lambda boxes: boxes[1:] + boxes[:1]}, "$.limit.boxes[2]")
        self.refused("bounds_cycle", {"limit": REFERENCE["cycle"]["limit"]}, "$.limit: unknown member")

    def test_nothing_of_boxes_or_bounds_proves_a_violation(self):
        model = model_of(REFERENCE["chain_l1"])
        ends = [[Fraction(sign * 1000)] * model.n for sign in (-1, 1)]
        wide = dict(zip(("low", "high", "below", "above"), ends * 2))  # so wide that the phase has the least right - left
        document, instances = reference.examine(model, rounds=2, boxes=[wide])
        for name in CLAIMS[:3] + CLAIMS[4:9]:
            at, left, right, _ = min(instances[name], key=lambda x: x[2] - x[1])
            self.assertTrue(left > right and at["n"] == 2)
            document["claims"] = [{"claim": name, "verdict": "violated", "left": str(left), "right": str(right), "at": at}]
            self.assertIn("$.claims[0].at: no instance", check(document))
        document = json.loads(json.dumps(REFERENCE["bounds_negative"]))
        instances = truth_of(document)[1]
        at, left, right, _ = min(instances["lemma-1"], key=lambda x: x[2] - x[1])
        self.assertGreater(left, right)
        document["claims"] = [{"claim": "lemma-1", "verdict": "violated", "left": str(left), "right": str(right), "at": at}]
        self.assertIn("$.claims[0].verdict", check(document))
        document["claims"] = [{"claim": "lemma-3", "verdict": "undetermined"}]
        self.assertIn("$.claims[0].claim", check(document))

    def test_claims_that_need_what_is_null(self):
        document = json.loads(json.dumps(REFERENCE["bounds_pit"]))
        for member, names in (("limit", CLAIMS[:3] + CLAIMS[4:9]), ("belief_game", ["F"])):
            for claim in document["claims"]:
                answer = check({**document, member: None, "claims": [claim]})
                self.assertEqual(isinstance(answer, str), claim["claim"] in names, answer)
                self.assertIn("expected undetermined" if isinstance(answer, str) else "holds", str(answer))

    def test_metrics(self):
        for name in ("hops", "discrete", "bounds_hops"):
            self.refused(name, {"model.metric": "steps"}, "$.model.metric")
            self.refused(name, {"model.norm": "l1"}, "$.model: unknown member")
            self.refused(name, {"model.distances": []}, "$.model: unknown member")
            # written as a matrix they say the same
            document = json.loads(json.dumps(REFERENCE[name]))
            document["model"]["distances"] = reference.text(model_of(document).low)
            del document["model"]["metric"]
            self.assertEqual(check(document), check(REFERENCE[name]))
        model = checker.Model(checker.Node(REFERENCE["hops"]["model"]))
        self.assertEqual(model.d, [[0, 1, 2, None], [1, 0, 1, None], [2, 1, 0, None], [None, None, None, 0]])

    def test_positions_that_are_missing(self):
        document = REFERENCE["some_positions"]
        listed = document["belief_game"]["positions"]
        every = REFERENCE["chain_l1"]["belief_game"]["positions"]
        starts = [[s, list(M)] for s, M in sorted(reference.starts(model_of(document)))]
        self.assertTrue(len(starts) < len(listed) < len(every))
        later = next(position for position in listed if position not in starts)

        def without(position):
            def change(game):
                kept = [i for i, other in enumerate(game["positions"]) if other != position]
                return dict(game, positions=[game["positions"][i] for i in kept], values=[game["values"][i] for i in kept])
            return change

        for name in ("some_positions", "bounds_chain"):
            self.refused(name, {"belief_game": without(starts[0])}, "$.belief_game.positions: no [0, [0, 1]], expected every start")
        self.refused("chain_l1", {"belief_game": without(later)}, "$.belief_game.positions: not all that follows")
        self.refused("some_positions", {"belief_game.exact": True}, "$.belief_game.positions: not all that follows")
        self.refused("bounds_chain", {"belief_game.exact": False}, "$.belief_game: unknown member")
        self.refused("chain_l1", {"belief_game.values": lambda W: [str(Fraction(x) - 1) for x in W]}, "$.belief_game.values")
        for name in ("chain_l1", "some_positions", "bounds_chain"):
            self.refused(name, {"belief_game.reach": "3"}, "$.belief_game.reach")
        # what is reached only by way of positions that are missing is not to be listed
        model = model_of(REFERENCE["rows"])
        for document in (REFERENCE["rows"], reference.bounds_certificate(model, rounds=1, period=0)[0]):
            far = [0, [0]]
            self.assertIn(far, document["belief_game"]["positions"])
            starts = [[s, list(M)] for s, M in reference.starts(model)]
            game = dict(document["belief_game"], positions=sorted(starts + [far]), values=["-1000"] * (len(starts) + 1))
            if "exact" in game:
                game["exact"] = False
            self.refused(document, {"belief_game": game}, "$.belief_game.positions: (0, (0,)) is not reached")

    def test_constants_by_bounds(self):
        for name in ("l_r", "l_p", "k", "l_star"):
            path = f"constants.{name}"
            self.assertTrue(REFERENCE["bounds_islands"]["constants"][name]["at"])
            self.refused("bounds_islands", {f"{path}.at": None}, f"$.{path}.at: null")
            self.refused("bounds_islands", {f"{path}.value": "0"}, f"$.{path}.at: an array, expected null")
            self.refused("bounds_islands", {f"{path}.value": "-1", f"{path}.at": None}, f"$.{path}.value: negative")
            self.refused("bounds_islands", {f"{path}.at[1]": REFERENCE["bounds_islands"]["constants"][name]["at"][0]}, f"$.{path}.at: ")
            self.refused("bounds_islands", {f"{path}.at[0]": 0, f"{path}.at[1]": 2}, f"$.{path}.at: expected two states at a finite")
            self.refused("bounds_twins", {f"{path}.at": [0, 1, 0] + [0] * (name == "l_p"), f"{path}.value": "1/10"}, f"$.{path}.at: ")
        at = REFERENCE["bounds_islands"]["constants"]["l_star"]["at"]
        self.refused("bounds_islands", {"constants.l_star.at": [at[1], at[0], at[2]]}, "$.constants.l_star.at: the quotient is less")
        for name in ("l_r", "l_p", "k"):  # of these the order of the states does not matter
            document = quiet(json.loads(json.dumps(REFERENCE["bounds_islands"])))
            at = document["constants"][name]["at"]
            at[:2] = at[1::-1]
            self.accepted(document)
            document["constants"][name].update(value="0", at=None)
            self.accepted(document)
        at = REFERENCE["islands"]["constants"]["l_r"]["at"]  # in an exact certificate it does
        self.refused("islands", {"constants.l_r.at": [at[1], at[0], at[2]]}, "$.constants.l_r.at: expected two states")
        for name in ("r_min", "r_max"):
            for sign in (1, -1):
                self.refused("bounds_islands", {f"constants.{name}": lambda x, sign=sign: str(Fraction(x) + sign * self.TINY)},
                             f"$.constants.{name}")

    def test_states_at_distance_0_that_differ(self):
        """No constant exists; by bounds the claims may be proved all the same."""
        half = Fraction(1, 2)
        model = reference.Model(half, 1, [[1, 0], [2, 0], [0, 3]], [[{2: 1}, {0: half, 1: half}]] * 2 + [[{0: 1}, {2: 1}]],
                                points=[[0], [0], [1]], norm="l1")
        document = reference.bounds_certificate(model)[0]
        self.assertIsInstance(check(document), list, check(document))

    def test_each_format_has_its_own_members(self):
        self.refused("bounds_chain", {"format": "maximin-certificate"}, "$: unknown member")
        self.refused("chain_l1", {"format": "maximin-bounds"}, "$: no member")
        for member in ("bits", "optimal"):
            document = json.loads(json.dumps(REFERENCE["bounds_chain"]))
            del document[member]
            self.assertIn(f"$: no member {member}", check(document))

    def test_rounds_by_bounds(self):
        name = "bounds_cycle"
        for bits in (-1, 100001, "12", 12.0, True, None):
            self.refused(name, {"bits": bits}, "$.bits")
        self.refused(name, {"rounds": []}, "$.rounds: no rounds")
        self.refused(name, {"rounds[0]": 1}, "$.rounds: [0] is 1, expected pairs in the order")
        self.refused(name, {"rounds[3]": lambda i: 1 - i}, "$.rounds: [3] is pair")
        self.refused(name, {"pairs": lambda pairs: pairs + pairs[:1], "rounds": lambda rounds: rounds[:-1] + [2]},
                     "$.pairs: a pair occurs twice")
        self.refused(name, {"pairs": lambda pairs: pairs + [dict(pairs[0], choices=[[1], [1]])]}, "$.pairs: pair 2 is of no round")
        self.refused("bounds_random", {"rounds": [0]}, "$.pairs: pair 1 is of no round")
        for member in ("choices", "provoked"):
            for change in ([], [0], [1], [0, 1], [1, 0], [0, 0, 1]):
                if change != REFERENCE["bounds_negative"]["pairs"][1][member][2]:
                    self.refused("bounds_negative", {f"pairs[1].{member}[2]": change},
                                 f"$.rounds: [1] is pair 1, whose {member} of state 2")
            self.refused("bounds_negative", {f"pairs[1].{member}[2]": [2]}, f"$.pairs[1].{member}[2][0]")
            self.refused("bounds_negative", {f"pairs[1].{member}": lambda x: x[:-1]}, f"$.pairs[1].{member}")

    def test_candidates(self):
        """Against the definition, with intervals of few values, so that ends often meet."""
        rng = random.Random(5)
        for _ in range(3000):
            count = rng.randrange(1, 5)
            lo = [[rng.randrange(4) for _ in range(count)] for _ in range(2)]
            hi = [[x + rng.choice([0, 0, 1, 2]) for x in row] for row in lo]
            tie = rng.choice(["lowest", "highest"])
            model = checker.Model.__new__(checker.Model)
            model.m = count
            tiny = type("Tiny", (), {"A": range(count)})
            self.assertEqual(model.candidates(checker.Table(lo, 1), checker.Table(hi, 1), (0, 1), tie),
                             reference.surviving(tiny, lo, hi, (0, 1), tie))

    def test_random_models(self):
        """Both producers of one model, in all options; what they claim is accepted with the same verdicts."""
        for seed in range(24):
            rng = random.Random(seed)
            size = rng.randrange(2, 5), rng.randrange(1, 4)
            model = reference.random_model(100 + seed, *size, Fraction(rng.randrange(4), 5), rng.randrange(3))
            kind = rng.choice(["hops", "discrete", "points"])
            if kind != "points":
                model = reference.Model(model.g, model.eps, model.R, model.P, metric=kind)
            options = {"reading": rng.choice(["paper", "corrected"]), "tie": rng.choice(["lowest", "highest"]),
                       "rounds": rng.randrange(1, 7), "period": rng.randrange(1, 4), "bits": rng.randrange(8),
                       "listed": lambda position: sum(position[1]) % 3 > 0}
            for document in (reference.certificate(model, **options), reference.bounds_certificate(model, **options)[0]):
                rows = check(document)
                self.assertIsInstance(rows, list, f"{seed} {document['format']}: {rows}")
                self.assertEqual([row[1] for row in rows], [claim["verdict"] for claim in document["claims"]])


class Program(unittest.TestCase):
    def run_on(self, *contents):
        """Exit code, standard output and standard error for files with these contents."""
        with tempfile.TemporaryDirectory() as folder:
            files = []
            for i, content in enumerate(contents):
                files.append(os.path.join(folder, f"{i}.json"))
                with open(files[-1], "wb") as file:
                    file.write(content if isinstance(content, bytes) else json.dumps(content).encode())
            done = subprocess.run([sys.executable, CHECKER] + files, capture_output=True, text=True, check=False, timeout=60)
            return done.returncode, done.stdout, done.stderr

    def refused(self, content, *says):
        with contextlib.ExitStack() as stack:
            folder = stack.enter_context(tempfile.TemporaryDirectory())
            path = os.path.join(folder, "c.json")
            with open(path, "wb") as file:
                file.write(content)
            out, err = io.StringIO(), io.StringIO()
            with contextlib.redirect_stdout(out), contextlib.redirect_stderr(err):
                code = checker.report(path)
        self.assertEqual((code, out.getvalue()), (2, ""), content[:80])
        self.assertRegex(err.getvalue(), r"\A.*c\.json: \$[^:\n]*: .*expected.*\n\Z")
        self.assertLess(len(err.getvalue()), 600)
        for word in says:
            self.assertIn(word, err.getvalue())

    def test_exit_codes(self):
        holds, violated, undetermined = (REFERENCE[name] for name in ("chain_l1", "one_sided_paper", "undecided"))
        for contents, code in (([holds], 0), ([violated], 1), ([undetermined], 3), ([b"{}"], 2), ([holds, undetermined], 3),
                               ([undetermined, violated, holds], 1), ([violated, b"[", undetermined], 2)):
            self.assertEqual(self.run_on(*contents)[0], code)
        self.assertEqual(self.run_on()[0], 2)

    def test_claims_without_an_entry_are_named(self):
        certificate = dict(REFERENCE["chain_l1"])
        certificate["claims"] = certificate["claims"][:-2]
        self.assertIn("not in this certificate: E, F", self.run_on(certificate)[1])
        self.assertNotIn("not in this certificate", self.run_on(REFERENCE["chain_l1"])[1])

    def test_white_space_is_allowed_around_a_certificate(self):
        text = json.dumps(REFERENCE["chain_l1"]).encode()
        self.assertEqual(self.run_on(b" \t\r\n" + text + b" \t\r\n")[0], 0)

    def test_table_is_aligned(self):
        _, out, err = self.run_on(REFERENCE["one_sided_paper"])
        lines = out.splitlines()
        self.assertEqual(err, "")
        self.assertTrue(lines[0].endswith(": VIOLATED"))
        self.assertEqual(len({line.index(word) for line, word in ((lines[1], "verdict"), (lines[2], "violated"), (lines[3], "holds"))}), 1)

    def test_hostile_files(self):
        text = json.dumps(REFERENCE["one_sided_paper"]).encode()

        def instead(old, new):
            self.assertIn(old, text)
            return text.replace(old, new, 1)

        for nest in (b"[", b'{"a":', b'{"format": ['):
            self.refused(nest * 200000, "$")
        self.refused(b"[" * 200000 + b"]" * 200000)
        self.refused(b"")
        self.refused(b"null", "an object")
        self.refused(b"\xff\xfe{}", "not JSON")
        for other in (b"x", b"\0", b"\0x", b"\n\0", b"\f", b"\v", b"\xc2\xa0", b"\xef\xbb\xbf", b"\x1a"):
            self.refused(text + other, "not JSON")
            self.refused(other + text, "not JSON")
        self.refused(text[:-10])
        self.refused(instead(b'"states": 3', b'"states": 1000000000000000000'), "$.model.states")
        self.refused(instead(b'"states": 3', b'"states": 1' + b"0" * 1000000), "$.model.states")
        self.refused(instead(b'"states": 3', b'"states": 3.0'), "$.model.states")
        self.refused(instead(b'"states": 3', b'"states": 3e0'), "$.model.states")
        self.refused(instead(b'"states": 3', b'"states": -0'), "$.model.states")
        self.refused(instead(b'"states": 3', b'"states": NaN'), "$.model.states")
        self.refused(instead(b'"states": 3', b'"states": -Infinity'), "$.model.states")
        self.refused(instead(b'"states": 3', b'"states": true'), "$.model.states")
        self.refused(instead(b'"discount": "1/2"', b'"discount": 0.5'), "$.model.discount")
        self.refused(instead(b'"discount": "1/2"', b'"discount": "1e999"'), "$.model.discount")
        self.refused(instead(b'"discount": "1/2"', b'"discount": "1/' + b"7" * 1000000 + b'"'), "$.model.discount")
        self.refused(instead(b'"eps": "1"', b'"eps": "' + b"9" * 1000000 + b'"'), "$.model.eps")
        self.refused(instead(b'"eps": "1"', b'"eps": "1/0"'), "$.model.eps")
        self.refused(instead(b'"eps": "1"', b'"eps": "\\ud800"'), "$.model.eps")
        self.refused(instead(b'"eps": "1"', b'"eps": "1", "eps": "1"'), "$.model:", "repeated")
        self.refused(instead(b'"eps": "1"', b'"eps": "1", "\\u0065ps": "1"'), "$.model:", "repeated")
        self.refused(instead(b'"eps": "1"', b'"eps": "1", "a\\nb": "1"'), "$.model:", "unknown")
        self.refused(instead(b'"reading"', b'"tie": "lowest", "reading"'), "$:", "repeated")
        self.refused(instead(b'"verdict": "violated"', b'"verdict": ["violated"]'), "$.claims[0]")
        self.refused(instead(b'"rewards": [[', b'"rewards": [[[], '), "$.model.actions")
        self.refused(instead(b'"rewards": [[', b'"rewards": [], "x": [['), "$.model")
        self.refused(b'{"format": "maximin-certificate", "version": 1, "model": {"states": 1000000000000000000}}')

    def test_repeated_members_everywhere(self):
        def texts(value):
            """The JSON text of a value, once for each object in it that has a member twice."""
            items = list(value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ())
            plain = [(json.dumps(key) + ": " if isinstance(value, dict) else "") + json.dumps(item) for key, item in items]
            left, right = "{}" if isinstance(value, dict) else "[]"
            if isinstance(value, dict) and items:
                yield left + ", ".join(plain + plain[:1]) + right
            for i, (key, item) in enumerate(items):
                for text in texts(item):
                    name = json.dumps(key) + ": " if isinstance(value, dict) else ""
                    yield left + ", ".join(plain[:i] + [name + text] + plain[i + 1:]) + right

        count = 0
        for text in texts(REFERENCE["one_sided_paper"]):
            self.refused(text.encode(), "repeated name")
            count += 1
        self.assertGreater(count, 20)

    def test_files_that_cannot_be_read(self):
        done = subprocess.run([sys.executable, CHECKER, "/nowhere/c.json"], capture_output=True, text=True, check=False)
        self.assertEqual((done.returncode, done.stdout, done.stderr.count("\n")), (2, "", 1))
        self.assertEqual(subprocess.run([sys.executable, CHECKER, HERE], capture_output=True, check=False).returncode, 2)


if __name__ == "__main__":
    unittest.main()
