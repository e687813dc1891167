#!/usr/bin/env python3
"""Checks certificates of Maximin by substitution; written from docs/certificate-format.md and from nothing else.

    check_certificate.py CERT.json...

prints each claim with its verdict and exits 0 (all hold), 1 (a claim is violated, which is proved), 3 (one is undetermined)
or 2 (not a certificate: one line on standard error says where and why). Of several files the worst code: 2, 1, 3, 0.
Python 3.9 or later, standard library only. Exact: a table is integers over one common denominator, nothing is rounded.
"""

import json
import math
import operator
import re
import sys
from collections import namedtuple
from fractions import Fraction

MAX_FILE = 256 << 20  # bytes
MAX_DIGITS = 100_000  # of a numerator or denominator
TWO64 = 2**64
CODES_FROM_BEST = [0, 3, 1, 2]
NUMBER = re.compile(r"(-?)(0|[1-9][0-9]*)(?:/([1-9][0-9]*))?")
CLAIMS = {  # which members `at` has
    "lemma-1": ("n", "states", "action"), "lemma-1-iterates": ("n", "states", "action"), "lemma-2": ("n", "states", "action"),
    "lemma-3": ("n",), "theorem-1": ("n", "states", "action"), "A": ("n", "states", "action"), "B": ("n", "states", "action"),
    "C": ("n", "states", "action"), "D": ("n", "states", "action"), "E": ("states", "action"), "F": ("states",)}

Table = namedtuple("Table", "rows over")  # the number in row i, column j is rows[i][j] / over; a list of values has rows of one
# Some instances of one claim: (states, left by action, right) with lefts over `over`, rights over `right_over`.
# `proves`: whether left > right in one of them proves the claim violated.
Family = namedtuple("Family", "n proves over right_over instances")


class NotACertificate(Exception):
    def __init__(self, path, message):
        super().__init__(f"{path}: {message}")


# ---- Numbers and form --------------------------------------------------------------------------------------------------


class Refused:
    """Stands for JSON that is refused wherever it occurs, until it is known where that is."""

    def __init__(self, what):
        self.what = what


class Node:
    """A JSON value and its place. Every method refuses what is not of the form it names."""

    def __init__(self, value, path="$"):
        self.value, self.path = value, path

    def wrong(self, message):
        raise NotACertificate(self.path, message)

    def require(self, condition, message):
        if not condition:
            self.wrong(message)

    def shown(self):
        if isinstance(self.value, Refused):
            return self.value.what
        if isinstance(self.value, (dict, list)):
            return "an object" if isinstance(self.value, dict) else "an array"
        shown = json.dumps(self.value)
        return shown if len(shown) <= 40 else shown[:40] + "..."

    def expect(self, kind, what):
        if type(self.value) is not kind:  # `is`: a bool is no int here
            self.wrong(f"{self.shown()}, expected {what}")

    def members(self, *names):
        """The members of an object that has exactly these."""
        self.expect(dict, "an object")
        for name in self.value:
            self.require(name in names, f"unknown member {json.dumps(name)[:40]}, expected {', '.join(names) or 'none'}")
        for name in names:
            self.require(name in self.value, f"no member {name}, expected {', '.join(names)}")
        return [Node(self.value[name], f"{self.path}.{name}") for name in names]

    def array(self, length=None):
        self.expect(list, "an array")
        self.require(length in (None, len(self.value)), f"{len(self.value)} entries, expected {length}")
        return [Node(value, f"{self.path}[{i}]") for i, value in enumerate(self.value)]

    def index(self, below):
        if type(self.value) is not int or not 0 <= self.value < below:
            self.wrong(f"{self.shown()}, expected an integer from 0 to {below - 1}")
        return self.value

    def indices(self, below, length=None):
        return [node.index(below) for node in self.array(length)]

    def word(self, *words):
        self.require(type(self.value) is str and self.value in words, f"{self.shown()}, expected {' or '.join(words)}")
        return self.value

    def number(self):
        self.expect(str, 'a number as a string, "-12" or "1/3"')
        match = len(self.value) <= 2 * MAX_DIGITS + 2 and NUMBER.fullmatch(self.value)
        if not match or self.value == "-0":
            self.wrong(f'{self.shown()}, expected an integer "-12" or a fraction "1/3"')
        sign, above, below = match.groups("1")
        self.require(max(len(above), len(below)) <= MAX_DIGITS, f"a number of over {MAX_DIGITS} digits, expected fewer")
        x = Fraction(int(sign + above), int(below))
        if match.group(3) == "1" or x.denominator != int(below):
            self.wrong(f"{self.shown()}, expected a fraction in lowest terms")
        return x

    def numbers(self, length):
        return [node.number() for node in self.array(length)]

    def values(self, length):
        """A table of values: a Table with one column."""
        return common([[x] for x in self.numbers(length)])

    def equals(self, value, meaning):
        if self.number() != value:
            self.wrong(f"{self.shown()}, expected {brief(value)}, {meaning}")


def unique_members(pairs):
    members = dict(pairs)
    return members if len(members) == len(pairs) else Refused("an object with a repeated name")


def read_json(file):
    """The whole file as a Node."""
    try:
        with open(file, "rb") as stream:
            contents = stream.read(MAX_FILE + 1)
        if len(contents) > MAX_FILE:
            raise NotACertificate("$", f"a file over {MAX_FILE >> 20} MiB, expected a smaller one")
        return Node(json.loads(contents.decode("utf-8"), object_pairs_hook=unique_members,
                               parse_float=lambda text: Refused(f"{text[:40]}, a number that is no integer"),
                               parse_int=lambda text: int(text) if len(text) < 19 and text[0] != "-" else Refused(text[:40]),
                               parse_constant=Refused))
    except OSError as error:
        raise NotACertificate("$", f"cannot be read: {error.strerror}, expected a file") from None
    except RecursionError:
        raise NotACertificate("$", "nested too deeply, expected a certificate") from None
    except ValueError as error:  # neither JSON nor UTF-8
        raise NotACertificate("$", f"not JSON: {error}, expected an object".replace("\n", " ")) from None


def brief(x):
    """A number as text, shortened: for people only."""
    if max(abs(x.numerator), x.denominator) < 10**9:
        return str(x)
    try:
        return f"~{float(x):.6g}"
    except OverflowError:
        return "a large number"


# ---- Exact tables ------------------------------------------------------------------------------------------------------


def common(rows):
    """The Table of rows of Fractions."""
    over = math.lcm(*(x.denominator for row in rows for x in row))
    return Table([[x.numerator * (over // x.denominator) for x in row] for row in rows], over)


def scaled(X, over):
    """X over another denominator, a multiple of its own."""
    return X if X.over == over else Table([[x * (over // X.over) for x in row] for row in X.rows], over)


def difference(X, Y):
    """X - Y."""
    if X.over == Y.over:
        return Table([[x - y for x, y in zip(row, other)] for row, other in zip(X.rows, Y.rows)], X.over)
    return Table([[x * Y.over - y * X.over for x, y in zip(row, other)] for row, other in zip(X.rows, Y.rows)], X.over * Y.over)


def absolute(X):
    return Table([[abs(x) for x in row] for row in X.rows], X.over)


def largest(X):
    return Fraction(max(map(max, X.rows)), X.over)


def choose(X, choice):
    """The values s -> X(s, choice[s])."""
    return Table([[row[a]] for row, a in zip(X.rows, choice)], X.over)


def best_values(X):
    return Table([[max(row)] for row in X.rows], X.over)


def same(X, Y):
    """The first row in which X and Y differ, or None."""
    return next((s for s, (x, y) in enumerate(zip(X.rows, Y.rows)) if [v * Y.over for v in x] != [v * X.over for v in y]), None)


# ---- The model ---------------------------------------------------------------------------------------------------------


class Model:
    """States 0..n-1, actions 0..m-1, rewards, transitions, balls, and the bounds d- and d+ on finite distances."""

    def __init__(self, node):
        places = "points norm" if isinstance(node.value, dict) and "points" in node.value else "distances"
        form, version, states, actions, discount, eps, *distances, rewards, transitions = node.members(
            *f"format version states actions discount eps {places} rewards transitions".split())
        form.word("maximin-mdp")
        version.require(version.index(2) == 1, f"{version.value}, expected 1")
        rows = rewards.array()
        self.n, self.m = len(rows), len(rows[0].array()) if rows else 0
        for count, size in ((states, self.n), (actions, self.m)):
            count.require(type(count.value) is int and count.value == size > 0, f"{count.shown()}, expected {size}, as of rewards")
        self.g, self.eps = discount.number(), eps.number()
        discount.require(0 <= self.g < 1, f"{brief(self.g)}, expected a number from 0 to below 1")
        eps.require(self.eps >= 0, f"{brief(self.eps)}, expected at least 0")
        self.R = common([row.numbers(self.m) for row in rows])
        self.read_transitions(transitions)
        if len(distances) == 2:
            self.read_points(*distances)
        else:
            self.l2 = False
            self.set_distances(self.read_distances(*distances))

    def read_transitions(self, node):
        """P[s][a] = {s': integer}, over the common denominator P_over; and ({s': small integer}, factor) of each row for `back`."""
        found, previous = [[{} for _ in range(self.m)] for _ in range(self.n)], None
        for entry in node.array():
            s, a, t, p = entry.array(4)
            place = (s.index(self.n), a.index(self.m), t.index(self.n))
            entry.require(previous is None or previous < place, "out of order, expected ascending (s, a, s'), none twice")
            previous, probability = place, p.number()
            p.require(probability > 0, f"{brief(probability)}, expected more than 0")
            found[place[0]][place[1]][place[2]] = probability
        for s, row in enumerate(found):
            for a, cell in enumerate(row):
                total = sum(cell.values())
                node.require(total == 1, f"state {s}, action {a}: probabilities sum to {brief(Fraction(total))}, expected 1")
        self.P_over = over = math.lcm(*(p.denominator for row in found for cell in row for p in cell.values()))
        self.P = [[{t: p.numerator * (over // p.denominator) for t, p in cell.items()} for cell in row] for row in found]
        factors = [[math.gcd(*cell.values()) for cell in row] for row in self.P]
        self.reduced = [[({t: p // f for t, p in cell.items()}, f) for cell, f in zip(*rows)] for rows in zip(self.P, factors)]

    def read_points(self, points, norm):
        rows = points.array()
        points.require(len(rows) == self.n, f"{len(rows)} points, expected {self.n}")
        points.require(rows[0].array(), "no coordinates, expected at least one")
        points = common([row.numbers(len(rows[0].array())) for row in rows])
        kind = norm.word("l1", "l2", "linf")
        self.l2 = kind == "l2"
        total = {"l1": sum, "linf": lambda x: max(x, default=0), "l2": lambda x: sum(y * y for y in x)}[kind]
        self.set_distances([[Fraction(total([abs(x - y) for x, y in zip(p, q)]), points.over**(2 if self.l2 else 1))
                             for q in points.rows] for p in points.rows])

    def read_distances(self, node):
        d = [[None if x.value is None else x.number() for x in row.array(self.n)] for row in node.array(self.n)]
        over = math.lcm(*(x.denominator for row in d for x in row if x is not None))
        whole = [[None if x is None else x.numerator * (over // x.denominator) for x in row] for row in d]
        infinite = 1 + 2 * max((x for row in whole for x in row if x is not None), default=0)  # above the sum of any two
        scaled = [[infinite if x is None else x for x in row] for row in whole]
        for s in range(self.n):
            node.require(d[s][s] == 0, f"[{s}][{s}] is not 0, expected zeros on the diagonal")
            for t in range(self.n):
                node.require(d[s][t] == d[t][s], f"[{s}][{t}] and [{t}][{s}] differ, expected a symmetric matrix")
                node.require(d[s][t] is None or d[s][t] >= 0, f"[{s}][{t}] is negative, expected at least 0")
        for s, row in enumerate(scaled):
            for t, other in enumerate(scaled):
                if max(map(operator.sub, row, other)) > row[t]:
                    node.wrong(f"[{s}][u] is above [{s}][{t}] + [{t}][u] for some u, expected the triangle inequality")
        return d

    def set_distances(self, d):
        """Balls, d-, d+ from distances, or from their squares under l2."""
        reach = self.eps**2 if self.l2 else self.eps
        self.ball = [[t for t, x in enumerate(row) if x is not None and x <= reach] for row in d]
        self.low, self.high = d, d
        if self.l2:
            roots = [[Fraction(math.isqrt(q.numerator * TWO64**2 // q.denominator), TWO64) for q in row] for row in d]
            self.low = roots
            self.high = [[x if x * x == q else x + Fraction(1, TWO64) for x, q in zip(*rows)] for rows in zip(roots, d)]
        self.pairs = [(s, t) for s in range(self.n) for t in range(s + 1, self.n) if d[s][t] is not None]
        # How much two states differ at most in a reward, in a probability; and in all probabilities together, by action.
        self.reward_gap = {(s, t): max([abs(x - y) for x, y in zip(self.R.rows[s], self.R.rows[t])]) for s, t in self.pairs}
        self.jump, self.moved = {}, {}
        for s, t in self.pairs:
            jumps = [[abs(p.get(u, 0) - q.get(u, 0)) for u in p.keys() | q.keys()] for p, q in zip(self.P[s], self.P[t])]
            self.jump[s, t], self.moved[s, t] = max(map(max, jumps)), [sum(x) for x in jumps]

    def back(self, V):
        """back(V)(s,a) = R(s,a) + g sum_s' P(s'|s,a) V(s')"""
        below = self.g.denominator * self.P_over * V.over
        over = math.lcm(self.R.over, below)
        scale, r_scale = self.g.numerator * (over // below), over // self.R.over
        v = [row[0] for row in V.rows]
        return Table([[r * r_scale + scale * factor * sum([p * v[t] for t, p in p_row.items()])
                       for r, (p_row, factor) in zip(*rows)] for rows in zip(self.R.rows, self.reduced)], over)

    def maximin(self, Q, states, tie):
        """argmax_a min_{m in states} Q(m,a)"""
        return max(in_order(range(self.m), tie), key=lambda a: min([Q.rows[m][a] for m in states]))  # the first of equals

    def attack(self, Q, policy, tie):
        """argmin_{t in B(s)} Q(s,policy(t)) for every s"""
        return [min(in_order(ball, tie), key=lambda t: row[policy[t]]) for ball, row in zip(self.ball, Q.rows)]

    def worst(self, Q, allowed):
        """min_{t in B(s)} min_{a in allowed[t]} Q(s,a) for every s"""
        return Table([[min([row[a] for t in ball for a in allowed[t]])] for ball, row in zip(self.ball, Q.rows)], Q.over)

    def check_robust(self, node, policy):
        """The value against the optimal attacker of a policy, as the node must state it."""
        V = node.values(self.n)
        check_same(node, V, self.worst(self.back(V), [[a] for a in policy]), "min_{t in B(s)} back(V)(s, pi(t))")
        return V


def check_same(node, V, expected, meaning):
    s = same(V, expected)
    node.require(s is None, f"[{s}] is not the value, expected {meaning}")


# ---- Constants, optimal values, policy pairs and rounds ----------------------------------------------------------------


def check_constants(node, model, reading, Qstar):
    """Each Lipschitz constant is attained where it says, and exceeded nowhere. Returns their values by name."""
    r_min, r_max = (Fraction(best(map(best, model.R.rows)), model.R.over) for best in (min, max))

    def star_gap(s, t):
        return max([abs(x - y) for x, y in zip(Qstar.rows[s], Qstar.rows[t])])

    # Of two states the difference whose quotient by d+ is meant, over a common denominator; and the same at one place.
    meant = {
        "l_r": (lambda s, t: model.reward_gap[s, t], lambda s, t, a: abs(model.R.rows[s][a] - model.R.rows[t][a]), model.R.over),
        "l_p": (lambda s, t: model.jump[s, t], lambda s, t, a, u: abs(model.P[s][a].get(u, 0) - model.P[t][a].get(u, 0)), model.P_over),
        "k": (lambda s, t: max(model.moved[s, t]), lambda s, t, a: model.moved[s, t][a], 2 * model.P_over),
        "l_star": (star_gap, lambda s, t, a: abs(Qstar.rows[s][a] - Qstar.rows[t][a]), Qstar.over)}
    names = ("l_r", "l_p", "k", "l_star")
    nodes = dict(zip(names + ("r_min", "r_max"), node.members(*names, "r_min", "r_max")))
    nodes["r_min"].equals(r_min, "the least reward")
    nodes["r_max"].equals(r_max, "the largest reward")
    result = {"size": max(abs(r_min), abs(r_max)), "span": r_max - r_min}
    result["print"] = result["size"] if reading == "corrected" else max(Fraction(0), r_max)
    for name in names:
        value_node, at = nodes[name].members("value", "at")
        value = result[name] = value_node.number()
        value_node.require(value >= 0, "negative, expected a Lipschitz constant")
        largest_of, at_place, over = meant[name]
        for s, t in model.pairs:
            if largest_of(s, t) > value * model.high[s][t] * over:
                nodes[name].wrong(f"exceeded at states {s}, {t}, expected the largest quotient")
        if value == 0:
            at.require(at.value is None, f"{at.shown()}, expected null where the value is 0")
            continue
        place = at.array(4 if name == "l_p" else 3)
        s, t = (x.index(model.n) for x in place[:2])
        rest = [place[2].index(model.m)] + [x.index(model.n) for x in place[3:]]
        at.require(s < t and model.high[s][t], "expected two states s < t at a finite distance above 0")
        at.require(at_place(s, t, *rest) == value * model.high[s][t] * over, "does not attain the value, expected a place that does")
    return result


class Rounds:
    """Q_0 ... Q_N and the policy pairs, whose values are checked."""

    def __init__(self, pairs_node, rounds_node, model, tie):
        self.pairs, pair_nodes = [], pairs_node.array()
        for node in pair_nodes:
            policy, attack, fixed, robust = node.members("policy", "attack", "fixed", "robust")
            self.pairs.append((policy.indices(model.m, model.n), attack.indices(model.n, model.n), fixed, robust))
        self.index = rounds_node.indices(len(pair_nodes))
        rounds_node.require(self.index, "no rounds, expected at least one")
        self.tables, self.first = [Table([[0] * model.m] * model.n, 1)], []
        for n, i in enumerate(self.index):
            Q, (policy, attack, _, _) = self.tables[-1], self.pairs[i]
            if i == len(self.first):
                self.first.append(n)
            if i >= len(self.first):
                rounds_node.wrong(f"[{n}] is {i}, expected pairs in the order in which they first occur")
            truth = [model.maximin(Q, ball, tie) for ball in model.ball]
            for name, stated, computed in (("policy", policy, truth), ("attack", attack, model.attack(Q, truth, tie))):
                if stated != computed:
                    rounds_node.wrong(f"[{n}] is pair {i}, expected one with the {name} of round {n}, {brief_list(computed)}")
            self.tables.append(model.back(choose(Q, self.played(i))))
        pairs_node.require(len(self.first) == len(self.pairs), f"pair {len(self.first)} is of no round, expected only pairs of rounds")
        distinct = {(tuple(pair[0]), tuple(pair[1])) for pair in self.pairs}
        pairs_node.require(len(distinct) == len(self.pairs), "a pair occurs twice, expected no repetition")
        self.fixed, self.robust = [], []
        for i, (policy, _, fixed, robust) in enumerate(self.pairs):
            V = fixed.values(model.n)
            check_same(fixed, V, choose(model.back(V), self.played(i)), "back(V)(s, pi(om(s)))")
            self.fixed.append(V)
            self.robust.append(model.check_robust(robust, policy))

    def played(self, i):
        policy, attack = self.pairs[i][:2]
        return [policy[t] for t in attack]


def brief_list(numbers):
    return str(numbers) if len(numbers) <= 8 else str(numbers[:8])[:-1] + ", ...]"


# ---- The limit ---------------------------------------------------------------------------------------------------------


class Limit:
    """Conditions 1 to 4, and the values that follow."""

    def __init__(self, node, model, last, tie):
        period, radius, classes, orbit, low, fixed = node.members("period", "radius", "classes", "orbit", "low", "fixed")
        self.k, self.r, self.tie = len(orbit.array()), radius.number(), tie
        period.require(type(period.value) is int and period.value == self.k > 0, f"{period.shown()}, expected {self.k}, as of orbit")
        radius.require(self.r > 0, f"{brief(self.r)}, expected more than 0")
        phases = orbit.array()
        U = [phase.values(model.n) for phase in phases]
        self.Q = [model.back(U[j - 1]) for j in range(self.k)]
        self.delta = largest(absolute(difference(last, self.Q[0])))
        radius.require(self.delta <= self.r, f"{brief(self.r)}, Q_N is {brief(self.delta)} from Q^0, expected at most r (condition 3)")
        self.read_classes(classes, model, last)
        self.low, self.fixed, self.single = [], [], []
        for j, (low_node, fixed_node) in enumerate(zip(low.array(self.k), fixed.array(self.k))):
            wide = math.floor(2 * self.r * self.Q[j].over)  # 2r in units of Q^j: a gap is at most 2r if it is at most this
            C = self.candidates(model, self.Q[j], wide)
            A = self.provoked(model, self.Q[j], U[j], C, wide, phases[j])
            settled = [all(len(C[t]) == 1 for t in ball) for ball in model.ball]
            self.check_moves(classes, model, settled, A, j)
            V = low_node.values(model.n)
            check_same(low_node, V, model.worst(model.back(V), C), "min_{t in B(s)} min_{a in C_j(t)} back(V)(s,a)")
            self.low.append(V)
            self.single.append(self.k == 1 or all(len(c) == 1 for c in C))
            actions = [self.action(s, ball, C, A[s], settled[s]) for s, ball in enumerate(model.ball)]
            known = None not in actions
            if not known and self.k > 1:
                fixed_node.require(fixed_node.value is None, f"{fixed_node.shown()}, expected null: an action is not known")
                self.fixed.append(None)
                continue
            V = fixed_node.values(model.n)
            expected = choose(model.back(V), actions) if known else U[0]
            check_same(fixed_node, V, expected, "back(V)(s, a_j(s))" if known else "U_0")
            self.fixed.append(V)

    def read_classes(self, node, model, last):
        """The class of every entry; condition 4, what it says of Q_N and rewards."""
        self.of, count, first = [row.indices(model.n * model.m, model.m) for row in node.array(model.n)], 0, {}
        for s, row in enumerate(self.of):
            for a, c in enumerate(row):
                node.require(c <= count, f"[{s}][{a}] is {c}, expected numbers from 0 in the order in which they first occur")
                count = max(count, c + 1)
                q, reward = first.setdefault(c, (last.rows[s][a], model.R.rows[s][a]))
                node.require(last.rows[s][a] == q, f"[{s}][{a}] differs in Q_N from others of class {c}, expected equals (condition 4)")
                node.require(model.R.rows[s][a] == reward, f"[{s}][{a}] differs in reward from others of class {c}, "
                                                           "expected equals (condition 4)")

    def candidates(self, model, Q, wide):
        """C_j(t) for every t."""
        order, result = in_order(range(model.m), self.tie), []
        for ball in model.ball:
            v = [min([Q.rows[m][a] for m in ball]) for a in range(model.m)]
            top, kept = max(v), []
            M = [{self.of[m][a] for m in ball if Q.rows[m][a] <= v[a] + wide} for a in range(model.m)]
            near = [a for a in order if v[a] >= top - wide]
            for i, b in enumerate(near):
                if not any(M[a] <= M[b] for a in near[:i]):
                    kept.append(b)
            result.append(kept)
        return result

    def provoked(self, model, Q, U, C, wide, node):
        """A_j(s) for every s; conditions 1 and 2."""
        check_same(node, U, model.worst(Q, C), "min_{t in B(s)} min_{a in C_j(t)} Q^j(s,a) (condition 1)")
        best = Table([[min([max([row[a] for a in C[t]]) for t in ball])] for ball, row in zip(model.ball, Q.rows)], Q.over)
        check_same(node, U, best, "min_{t in B(s)} max_{a in C_j(t)} Q^j(s,a) (condition 1)")
        result = []
        for s, (ball, row, [u]) in enumerate(zip(model.ball, Q.rows, best.rows)):  # best is U, over the denominator of Q
            near = {a for t in ball for a in C[t] if row[a] <= u + wide}
            result.append({a for a in near if row[a] == u})
            node.require(near == result[s], f"[{s}]: an action is within 2r above, expected none (condition 2)")
        return result

    def check_moves(self, node, model, settled, A, j):
        """Condition 4, what it says of probabilities in phase j."""
        group = [frozenset(self.of[s][a] for a in A[s]) if settled[s] else s for s in range(model.n)]  # equal where equivalent
        first = {}
        for s, row in enumerate(self.of):
            for a, c in enumerate(row):
                moves = {}
                for t, p in model.P[s][a].items():
                    moves[group[t]] = moves.get(group[t], 0) + p
                node.require(moves == first.setdefault(c, moves), f"[{s}][{a}] differs in moves of phase {j} from others of class "
                                                                  f"{c}, expected equals (condition 4)")

    def action(self, s, ball, C, provoked, settled):
        """a_j(s), the action that every pair of this phase takes in s; None where that is not known."""
        if len(provoked) == 1:
            return min(provoked)
        if not settled or len({self.of[s][a] for a in provoked}) > 1:
            return None
        return next(C[t][0] for t in in_order(ball, self.tie) if C[t][0] in provoked)


def in_order(indices, tie):
    """Ascending indices in the order in which they win ties."""
    return indices if tie == "lowest" else indices[::-1]


# ---- Pessimism at test time, and beliefs -------------------------------------------------------------------------------


def check_test_time(node, model, Qstar, tie):
    policy, robust = node.members("policy", "robust")
    truth = [model.maximin(Qstar, ball, tie) for ball in model.ball]
    policy.require(policy.indices(model.m, model.n) == truth, f"expected the maximin policy of Q*, {brief_list(truth)}")
    return model.check_robust(robust, policy.value)


class BeliefGame:
    """Exactly the positions that are reached, and values that obey the equation."""

    def __init__(self, node, model, Qstar, tie):
        positions_node, values, reach, exact = node.members("positions", "values", "reach", "exact")
        exact.require(type(exact.value) is bool, f"{exact.shown()}, expected true or false")
        self.exact, positions = exact.value, []
        for entry in positions_node.array():
            s, M = entry.array(2)
            positions.append((s.index(model.n), tuple(M.indices(model.n))))
            M.require(list(M.value) == sorted(set(M.value)), "expected ascending states")
            entry.require(len(positions) < 2 or positions[-2] < positions[-1], "out of order, expected ascending, none twice")
        W = values.values(len(positions))
        self.value = {position: w for position, [w] in zip(positions, W.rows)}
        self.over, action, sights = W.over, {}, {}
        balls = [tuple(ball) for ball in model.ball]
        start = [(s, balls[t]) for s in range(model.n) for t in model.ball[s]]
        todo, reached = list(start), set(start)
        while todo:
            s, M = position = todo.pop()
            if position not in self.value:
                positions_node.wrong(f"no [{s}, {brief_list(list(M))}], expected every position that is reached")
            if M not in action:
                action[M] = model.maximin(Qstar, M, tie)
                possible = {u for m in M for u in model.P[m][action[M]]}
                sights[M] = {}  # shown t -> the next belief
                for t in {t for u in possible for t in model.ball[u]}:
                    sights[M][t] = tuple(u for u in model.ball[t] if u in possible)
            total = 0
            for u, p in model.P[s][action[M]].items():
                following = [(u, sights[M][t]) for t in model.ball[u]]
                todo += [x for x in following if x not in reached]
                reached.update(following)
                if not all(x in self.value for x in following):
                    positions_node.wrong(f"not all that follows [{s}, {brief_list(list(M))}], expected every position that is reached")
                total += p * min([self.value[x] for x in following])
            below = model.P_over * model.g.denominator * self.over
            backup = model.R.rows[s][action[M]] * below + model.g.numerator * total * model.R.over  # over below * R.over
            stated = self.value[position] * model.P_over * model.g.denominator * model.R.over
            if stated > backup or (stated < backup and self.exact):
                values.wrong(f"[{positions.index(position)}] is not the value, expected {'' if self.exact else 'at most '}its backup")
        extra = next((x for x in positions if x not in reached), None)
        positions_node.require(extra is None, f"{extra} is not reached, expected only positions that are"[:120])
        self.rho = max(model.low[s][m] for s, M in positions for m in M)
        reach.equals(self.rho, "the largest distance within a belief")


# ---- Claims ------------------------------------------------------------------------------------------------------------


class Instances:
    """The families of instances of every claim, None where it can only be undetermined."""

    def __init__(self, model, constants, Vstar, Qstar, rounds, limit, test_value, game):
        self.model, self.Qstar, self.rounds, self.limit, self.N = model, Qstar, rounds, limit, len(rounds.index)
        g, n = model.g, model.n
        l_r, l_p, size = constants["l_r"], constants["l_p"], constants["size"]
        L_print, L_sound = (l_r + n * l_p * x / (1 - g) for x in (constants["print"], size))
        print_rights = self.lipschitz_rights(constants, n * constants["print"] / (1 - g))
        rep_rights = self.lipschitz_rights(constants, g * n * size / (1 - g))
        L_rep, L_tv = l_r + g * n * l_p * size / (1 - g), l_r + g * constants["k"] * constants["span"] / (1 - g)
        D_print, D_sound, D_rep, D_tv = (2 * model.eps * g * L for L in (L_print, L_sound, L_rep, L_tv))
        least = Fraction(min(map(min, Qstar.rows)), Qstar.over)
        start = max(Fraction(0), largest(Qstar)) + max(Fraction(0), -least)  # d0 + u0

        def F(m, D):
            """The finite-n bound; m None: its limit."""
            power = Fraction(0) if m is None else g**m
            return (g * (power * start + D * (1 - power) / (1 - g)) + D) / (1 - g)

        backs = [[model.back(V) for V in values] for values in (rounds.fixed, rounds.robust)]
        self.of = dict.fromkeys(CLAIMS)
        self.of["lemma-3"] = self.lemma_3()
        self.of["E"] = [self.gap(None, model.back(test_value), 2 * model.eps * g * constants["l_star"] / (1 - g), True)]
        if game:
            self.of["F"] = [self.beliefs(game, Vstar, constants["l_star"])]
        if limit:
            phases = range(limit.k)
            low = [model.back(V) for V in limit.low]
            fixed = [V and model.back(V) for V in limit.fixed]
            if all(fixed) and all(limit.single):
                tables = [(m, X) for both in backs for m, X in zip(rounds.first, both)]
                tables += [(self.N + j, X) for both in (low, fixed) for j, X in enumerate(both)]
                self.of["lemma-1"] = [self.lipschitz(m, X, print_rights) for m, X in tables]
            self.of["lemma-1-iterates"] = [self.lipschitz(m, X, rep_rights) for m, X in enumerate(rounds.tables)]
            self.of["lemma-1-iterates"] += [self.lipschitz(self.N + j, limit.Q[j], rep_rights, limit.delta) for j in phases]
            self.of["lemma-2"] = self.lemma_2(D_print)
            factor, sharp = (1 + g) / (1 - g)**2, 1 / (1 - g)**2
            self.of["theorem-1"] = [self.gap(self.N + j, fixed[j] or low[j], factor * D_print, bool(fixed[j])) for j in phases]
            self.of["A"] = [self.gap(self.N + j, low[j], factor * D_sound, limit.single[j]) for j in phases]
            self.of["B"] = [self.gap(self.N + j, low[j], sharp * D_sound, limit.single[j]) for j in phases]
            for name, D in (("C", D_rep), ("D", D_tv)):
                self.of[name] = [self.gap(m, backs[1][i], F(m, D), True) for m, i in enumerate(rounds.index)]
                self.of[name] += [self.gap(self.N + j, low[j], min(F(self.N + j, D), F(None, D)), limit.single[j])
                                  for j in phases]

    def lipschitz_rights(self, constants, factor):
        """r(s,t) + factor p(s,t) for all pairs of states, as a list of values."""
        m, l_r, l_p = self.model, constants["l_r"], constants["l_p"]
        return common([[max(l_r * m.low[s][t], Fraction(m.reward_gap[s, t], m.R.over))
                        + factor * max(l_p * m.low[s][t], Fraction(m.jump[s, t], m.P_over))] for s, t in m.pairs])

    def lipschitz(self, n, X, rights, delta=Fraction(0)):
        """abs(X(s,a)-X(t,a)) + 2 g delta TV(s,t,a) <= right for all pairs of states.

        Where nothing is added though g delta > 0, TV = 0, X differs as R does and left <= r(s,t) <= right: no such instance
        can prove a violation, and it is left out with the others of its table.
        """
        m = self.model
        if not m.pairs:
            return Family(None, True, 1, 1, [((), [0], 0)])
        extra = m.g * delta / m.P_over  # times the sum of all differences of probabilities, 2 P_over TV
        X = scaled(X, math.lcm(X.over, extra.denominator))
        added = int(extra * X.over)
        return Family(n, added == 0, X.over, rights.over,
                      (((s, t), [abs(x - y) + added * z for x, y, z in zip(X.rows[s], X.rows[t], m.moved[s, t])], right)
                       for (s, t), [right] in zip(m.pairs, rights.rows)))

    def gap(self, n, X, right, proves):
        """Q*(s,a) - X(s,a) <= right"""
        lefts = difference(self.Qstar, X)
        return Family(n, proves, lefts.over, right.denominator,
                      [((s,), row, right.numerator) for s, row in enumerate(lefts.rows)])

    def lemma_2(self, right):
        limit, added = self.limit, 2 * self.model.g * self.limit.delta
        steps = [(n, Q, self.rounds.tables[n + 1], Fraction(0), True) for n, Q in enumerate(self.rounds.tables[:-1])]
        steps += [(self.N + j, Q, limit.Q[(j + 1) % limit.k], added, limit.delta == 0) for j, Q in enumerate(limit.Q)]
        for n, Q, following, extra, proves in steps:
            lefts = absolute(difference(self.model.back(best_values(Q)), following))
            scale, more = extra.denominator, extra.numerator * lefts.over
            yield Family(n, proves, lefts.over * scale, right.denominator,
                         [((s,), [x * scale + more for x in row], right.numerator) for s, row in enumerate(lefts.rows)])

    def lemma_3(self):
        for n, i in enumerate(self.rounds.index):
            step = self.model.back(choose(self.Qstar, self.rounds.played(i)))
            left = largest(absolute(difference(self.rounds.tables[n + 1], step)))
            right = self.model.g * largest(absolute(difference(self.rounds.tables[n], self.Qstar)))
            yield Family(n, True, left.denominator, right.denominator, [((), [left.numerator], right.numerator)])

    def beliefs(self, game, Vstar, l_star):
        right = game.rho * l_star / (1 - self.model.g)
        balls = [tuple(ball) for ball in self.model.ball]
        worst = Table([[min(game.value[s, balls[t]] for t in ball)] for s, ball in enumerate(balls)], game.over)
        lefts = difference(Vstar, worst)
        return Family(None, game.exact, lefts.over, right.denominator,
                      [((s,), row, right.numerator) for s, row in enumerate(lefts.rows)])


def check_claim(node, names_left, instances, model):
    """One entry of `claims`. Returns what is printed of it."""
    node.expect(dict, "an object")
    undetermined = node.value.get("verdict") == "undetermined"
    claim, verdict, *sides = node.members("claim", "verdict", *(() if undetermined else ("left", "right", "at")))
    name, said = claim.word(*CLAIMS), verdict.word("holds", "violated", "undetermined")
    claim.require(name in names_left, f"{name}, expected the order of the table, each at most once")
    if said == "undetermined":
        return name, said, "", "", ""
    families = instances.of[name]
    verdict.require(families is not None, f"{said}, expected undetermined: limit or belief_game does not decide it")
    verdict.require(said == "holds" or not model.l2, "violated, expected undetermined: distances are l2")
    left, right = sides[0].number(), sides[1].number()
    verdict.require((left <= right) == (said == "holds"), f"{said}, expected what left and right say")

    names = () if name.startswith("lemma-1") and not model.pairs else CLAIMS[name]
    at = dict(zip(names, sides[2].members(*names)))
    round_at = at["n"].index(instances.N + (instances.limit.k if instances.limit else 0)) if "n" in at else None
    states_at = tuple(at["states"].indices(model.n)) if "states" in at else ()
    action = at["action"].index(model.m) if "action" in at else 0
    slack, found = right - left, []
    for n, proves, over, right_over, rows in families:
        if said == "violated" and not proves:
            continue
        least = None
        for states, lefts, bound in rows:
            here = bound * over - max(lefts) * right_over
            if least is None or here < least:
                least, where = here, states
            if n == round_at and states == states_at:
                found.append((Fraction(lefts[action], over), Fraction(bound, right_over)))
        node.require(least * slack.denominator >= slack.numerator * over * right_over,
                     f"right - left is less at {place_text(n, where, None)}, expected the least")
    sides[2].require(found, f"no instance that can show {said}, expected one")
    if (left, right) not in found:
        node.wrong(f"left and right are not those of `at`, expected {brief(found[0][0])} and {brief(found[0][1])}")
    return name, said, brief(left), brief(right), place_text(round_at, states_at, action if "action" in at else None)


def place_text(n, states, action):
    parts = ([] if n is None else [f"n {n}"]) + ([f"states {list(states)}"] if states else [])
    return ", ".join(parts + ([] if action is None else [f"action {action}"]))


# ---- What a checker says -----------------------------------------------------------------------------------------------


def check_certificate(root):
    """Checks everything; returns the rows that are printed."""
    form, version, model_node, reading, tie, constants, optimal, pairs, rounds, limit, test_time, game, claims = root.members(
        *"format version model reading tie constants optimal pairs rounds limit test_time belief_game claims".split())
    form.word("maximin-certificate")
    version.require(version.index(2) == 1, f"{version.value}, expected 1")
    reading, tie = reading.word("corrected", "paper"), tie.word("lowest", "highest")
    model = Model(model_node)
    Vstar = optimal.values(model.n)
    Qstar = model.back(Vstar)
    check_same(optimal, Vstar, best_values(Qstar), "max_a back(V)(s,a)")
    known = check_constants(constants, model, reading, Qstar)
    run = Rounds(pairs, rounds, model, tie)
    the_limit = None if limit.value is None else Limit(limit, model, run.tables[-1], tie)
    test_value = check_test_time(test_time, model, Qstar, tie)
    the_game = None if game.value is None else BeliefGame(game, model, Qstar, tie)
    instances = Instances(model, known, Vstar, Qstar, run, the_limit, test_value, the_game)
    claims.require(claims.array(), "no claims, expected at least one")
    names = iter(CLAIMS)  # searched onwards only: in the order of the table, each at most once
    return [check_claim(entry, names, instances, model) for entry in claims.array()]


def report(file):
    """Checks one file and prints; returns its exit code."""
    shown = file if file.isprintable() else ascii(file)
    try:
        rows = check_certificate(read_json(file))
    except NotACertificate as error:
        print(f"{shown}: {error}", file=sys.stderr)
        return 2
    except MemoryError:
        print(f"{shown}: $: numbers too large for the memory, expected smaller ones", file=sys.stderr)
        return 2
    rows = [("claim", "verdict", "left", "right", "tightest at")] + rows
    widths = [max(len(row[i]) for row in rows) for i in range(5)]
    verdicts = {row[1] for row in rows[1:]}
    code = 1 if "violated" in verdicts else 3 if "undetermined" in verdicts else 0
    print(f"{shown}: {({0: 'HOLDS', 1: 'VIOLATED', 3: 'UNDETERMINED'})[code]}")
    for row in rows:
        print("  " + "  ".join(cell.ljust(width) for cell, width in zip(row, widths)).rstrip())
    return code


def main(arguments):
    if not arguments or arguments[0] in ("-h", "--help"):
        print(__doc__.strip(), file=sys.stdout if arguments else sys.stderr)
        return 0 if arguments else 2
    for stream in (sys.stdout, sys.stderr):
        stream.reconfigure(errors="backslashreplace")
    if hasattr(sys, "set_int_max_str_digits"):
        sys.set_int_max_str_digits(0)  # the limit is MAX_DIGITS
    return max(map(report, arguments), key=CODES_FROM_BEST.index)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
