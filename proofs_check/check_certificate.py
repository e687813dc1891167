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
import os
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
# Some instances of one claim: (states, left by action or None, right) with lefts over `over`, rights over `right_over`.
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
        """P[s][a] = ({s': integer}, their denominator); P_over is a common denominator."""
        found, previous = [[{} for _ in range(self.m)] for _ in range(self.n)], None
        for entry in node.array():
            s, a, t, p = entry.array(4)
            place = (s.index(self.n), a.index(self.m), t.index(self.n))
            entry.require(previous is None or previous < place, "out of order, expected ascending (s, a, s'), none twice")
            previous, probability = place, p.number()
            p.require(probability > 0, f"{brief(probability)}, expected more than 0")
            found[place[0]][place[1]][place[2]] = probability
        self.P = []
        for s, row in enumerate(found):
            for a, cell in enumerate(row):
                total = sum(cell.values())
                node.require(total == 1, f"state {s}, action {a}: probabilities sum to {brief(Fraction(total))}, expected 1")
            self.P.append([])
            for cell in row:
                over = math.lcm(*(p.denominator for p in cell.values()))
                self.P[s].append(({t: p.numerator * (over // p.denominator) for t, p in cell.items()}, over))
        self.P_over = math.lcm(*(over for row in self.P for _, over in row))

    def probability(self, s, a, u):
        return Fraction(self.P[s][a][0].get(u, 0), self.P[s][a][1])

    def probability_jump(self, s, t, a):
        """The largest |P(s'|s,a)-P(s'|t,a)| and TV(s,t,a)."""
        (p, p_over), (q, q_over) = self.P[s][a], self.P[t][a]
        over = math.lcm(p_over, q_over)
        p_scale, q_scale = over // p_over, over // q_over
        jumps = [abs(p.get(u, 0) * p_scale - q.get(u, 0) * q_scale) for u in p.keys() | q.keys()]
        return Fraction(max(jumps), over), Fraction(sum(jumps), 2 * over)

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
                excess = list(map(operator.sub, row, other))
                if max(excess) > row[t]:
                    u = excess.index(max(excess))
                    node.wrong(f"[{s}][{u}] is above [{s}][{t}] + [{t}][{u}], expected the triangle inequality")
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
        self.jump = {(s, t, a): self.probability_jump(s, t, a) for s, t in self.pairs for a in range(self.m)}

    def back(self, V):
        """back(V)(s,a) = R(s,a) + g sum_s' P(s'|s,a) V(s')"""
        below = self.g.denominator * self.P_over * V.over
        over = math.lcm(self.R.over, below)
        scale, r_scale = self.g.numerator * (over // below), over // self.R.over
        v = [row[0] for row in V.rows]
        return Table([[r * r_scale + scale * (self.P_over // p_over) * sum([p * v[t] for t, p in p_row.items()])
                       for r, (p_row, p_over) in zip(*rows)] for rows in zip(self.R.rows, self.P)], over)

    def maximin(self, Q, states, tie):
        """argmax_a min_{m in states} Q(m,a)"""
        order = range(self.m) if tie == "lowest" else range(self.m - 1, -1, -1)
        return max(order, key=lambda a: min([Q.rows[m][a] for m in states]))  # the first of equals

    def attack(self, Q, policy, tie):
        """argmin_{t in B(s)} Q(s,policy(t)) for every s"""
        return [min(ball if tie == "lowest" else ball[::-1], key=lambda t: row[policy[t]]) for ball, row in zip(self.ball, Q.rows)]

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

    def most(s, t, name, a, u=None):
        """The difference whose quotient by d+(s,t) is meant."""
        if name in ("l_r", "l_star"):
            X = model.R if name == "l_r" else Qstar
            return Fraction(abs(X.rows[s][a] - X.rows[t][a]), X.over)
        if u is not None:
            return abs(model.probability(s, a, u) - model.probability(t, a, u))
        return model.jump[s, t, a][name == "k"]

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
        for s, t in model.pairs:
            limit = value * model.high[s][t]
            for a in range(model.m):
                if most(s, t, name, a) > limit:
                    nodes[name].wrong(f"exceeded at states {s}, {t}, action {a}, expected the largest quotient")
        if value == 0:
            at.require(at.value is None, f"{at.shown()}, expected null where the value is 0")
            continue
        place = at.array(4 if name == "l_p" else 3)
        s, t = (x.index(model.n) for x in place[:2])
        rest = [place[2].index(model.m)] + [x.index(model.n) for x in place[3:]]
        at.require(s < t and model.high[s][t], "expected two states s < t at a finite distance above 0")
        at.require(most(s, t, name, *rest) == value * model.high[s][t], "does not attain the value, expected a place that does")
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
        phases = orbit.array()
        self.k, self.r, self.tie = len(phases), radius.number(), tie
        period.require(type(period.value) is int and period.value == self.k > 0, f"{period.shown()}, expected {self.k}, as of orbit")
        radius.require(self.r > 0, f"{brief(self.r)}, expected more than 0")
        self.classes = [row.indices(model.n * model.m, model.m) for row in classes.array(model.n)]
        flat = [c for row in self.classes for c in row]
        in_order = all(c <= max(flat[:i], default=-1) + 1 for i, c in enumerate(flat))
        classes.require(in_order, "numbers are skipped, expected classes in the order in which they first occur")
        U = [phase.values(model.n) for phase in phases]
        self.Q = [model.back(U[j - 1]) for j in range(self.k)]
        self.low, self.fixed, self.attained = [], [], []
        for low_node, fixed_node, phase, Q, values in zip(low.array(self.k), fixed.array(self.k), phases, self.Q, U):
            C = [self.candidates(Q, ball) for ball in model.ball]
            played = self.check_phase(model, Q, values, C, phase)
            settled = [all(len(C[t]) == 1 for t in ball) for ball in model.ball]
            self.check_classes(classes, model, last, played, settled)
            V = low_node.values(model.n)
            check_same(low_node, V, model.worst(model.back(V), C), "min_{t in B(s)} min_{a in C_j(t)} back(V)(s,a)")
            self.low.append(V)
            self.attained.append(self.k == 1 or all(len(c) == 1 for c in C))
            action = [self.action(s, ball, C, played[s], settled[s]) for s, ball in enumerate(model.ball)]
            if None in action and self.k > 1:
                fixed_node.require(fixed_node.value is None, f"{fixed_node.shown()}, expected null: an action is not unique")
                self.fixed.append(None)
                continue
            V = fixed_node.values(model.n)
            check_same(fixed_node, V, values if None in action else choose(model.back(V), action), "that of (pi_n, om_n)")
            self.fixed.append(V)
        self.delta = largest(absolute(difference(last, self.Q[0])))
        radius.require(self.delta <= self.r, f"{brief(self.r)}, Q_N is {brief(self.delta)} from Q^0, expected at most r (condition 3)")

    def within(self, x, over):
        """x / over <= 2r"""
        return x * self.r.denominator <= 2 * self.r.numerator * over

    def candidates(self, Q, ball):
        """C_j(t), where B(t) is the ball."""
        v = [min([Q.rows[m][a] for m in ball]) for a in range(len(Q.rows[0]))]
        good = [a for a, x in enumerate(v) if self.within(max(v) - x, Q.over)]
        if self.tie == "highest":
            good.reverse()
        M = {a: {self.classes[m][a] for m in ball if self.within(Q.rows[m][a] - v[a], Q.over)} for a in good}
        return [b for i, b in enumerate(good) if not any(M[a] <= M[b] for a in good[:i])]

    def check_phase(self, model, Q, U, C, node):
        """Conditions 1 and 2. Returns A_j(s) for every s."""
        check_same(node, U, model.worst(Q, C), "min_{t in B(s)} min_{a in C_j(t)} Q^j(s,a) (condition 1)")
        best = Table([[min([max([row[a] for a in C[t]]) for t in ball])] for ball, row in zip(model.ball, Q.rows)], Q.over)
        check_same(node, U, best, "min_{t in B(s)} max_{a in C_j(t)} Q^j(s,a) (condition 1)")
        played = []
        for s, (ball, row, [u]) in enumerate(zip(model.ball, Q.rows, best.rows)):  # best is U, over the denominator of Q
            near = {a for t in ball for a in C[t] if self.within(row[a] - u, Q.over)}
            played.append({a for a in near if row[a] == u})
            node.require(near == played[s], f"[{s}]: an action is within 2r above, expected none (condition 2)")
        return played

    def check_classes(self, node, model, last, played, settled):
        """Condition 4 in a phase: what one class has in common."""
        group = [frozenset(self.classes[s][a] for a in actions) if fixed else s for s, (actions, fixed) in enumerate(zip(played, settled))]
        common_to = {}
        for s, row in enumerate(self.classes):
            for a, c in enumerate(row):
                moves, (p_row, p_over) = {}, model.P[s][a]
                for t, p in p_row.items():
                    moves[group[t]] = moves.get(group[t], 0) + p * (model.P_over // p_over)
                entry = (last.rows[s][a], model.R.rows[s][a], moves)
                node.require(common_to.setdefault(c, entry) == entry, f"[{s}][{a}] is {c}, expected another class (condition 4)")

    def action(self, s, ball, C, played, settled):
        """a_j(s), or None."""
        if len(played) == 1:
            return min(played)
        if not settled or len({self.classes[s][a] for a in played}) > 1:
            return None
        return next(C[t][0] for t in (ball if self.tie == "lowest" else ball[::-1]) if C[t][0] in played)


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
                possible = {u for m in M for u in model.P[m][action[M]][0]}
                sights[M] = {}  # shown t -> the next belief
                for t in {t for u in possible for t in model.ball[u]}:
                    sights[M][t] = tuple(u for u in model.ball[t] if u in possible)
            row, row_over = model.P[s][action[M]]
            total = 0
            for u, p in row.items():
                following = [(u, sights[M][t]) for t in model.ball[u]]
                todo += [x for x in following if x not in reached]
                reached.update(following)
                if not all(x in self.value for x in following):
                    positions_node.wrong(f"not all that follows [{s}, {brief_list(list(M))}], expected every position that is reached")
                total += p * min([self.value[x] for x in following])
            below = row_over * model.g.denominator * self.over
            backup = model.R.rows[s][action[M]] * below + model.g.numerator * total * model.R.over  # over below * R.over
            stated = self.value[position] * row_over * model.g.denominator * model.R.over
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
        self.tv = common([[model.jump[s, t, a][1] for a in range(model.m)] for s, t in model.pairs])
        g, n = model.g, model.n
        l_r, l_p, size = constants["l_r"], constants["l_p"], constants["size"]
        L_print, L_sound = (l_r + n * l_p * x / (1 - g) for x in (constants["print"], size))
        L_rep, L_tv = l_r + g * n * l_p * size / (1 - g), l_r + g * constants["k"] * constants["span"] / (1 - g)
        D_print, D_sound, D_rep, D_tv = (2 * model.eps * g * L for L in (L_print, L_sound, L_rep, L_tv))
        least = Fraction(min(map(min, Qstar.rows)), Qstar.over)
        start = max(Fraction(0), largest(Qstar)) + max(Fraction(0), -least)  # d0 + u0

        def lipschitz_sides(factor):
            """r(s,t) + factor p(s,t) for all pairs of states."""
            result = []
            for s, t in model.pairs:
                r = max(abs(x - y) for x, y in zip(model.R.rows[s], model.R.rows[t]))
                p = max(model.jump[s, t, a][0] for a in range(model.m))
                d = model.low[s][t]
                result.append([max(l_r * d, Fraction(r, model.R.over)) + factor * max(l_p * d, p)])
            return common(result)

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
            if all(fixed) and all(limit.attained):
                tables = [(m, X) for both in backs for m, X in zip(rounds.first, both)]
                tables += [(self.N + j, X) for both in (low, fixed) for j, X in enumerate(both)]
                rights = lipschitz_sides(n * constants["print"] / (1 - g))
                self.of["lemma-1"] = [self.lipschitz(m, X, rights) for m, X in tables]
            rights = lipschitz_sides(g * n * size / (1 - g))
            self.of["lemma-1-iterates"] = [self.lipschitz(m, X, rights) for m, X in enumerate(rounds.tables)]  # Q_N too
            for j, added in ((j, added) for j in phases for added in (False, True)):
                self.of["lemma-1-iterates"].append(self.lipschitz(self.N + j, limit.Q[j], rights, 2 * g * limit.delta, added))
            self.of["lemma-2"] = self.lemma_2(D_print)
            factor, sharp = (1 + g) / (1 - g)**2, 1 / (1 - g)**2
            self.of["theorem-1"] = [self.gap(self.N + j, fixed[j] or low[j], factor * D_print, bool(fixed[j])) for j in phases]
            self.of["A"] = [self.gap(self.N + j, low[j], factor * D_sound, limit.attained[j]) for j in phases]
            self.of["B"] = [self.gap(self.N + j, low[j], sharp * D_sound, limit.attained[j]) for j in phases]
            for name, D in (("C", D_rep), ("D", D_tv)):
                self.of[name] = [self.gap(m, backs[1][i], F(m, D), True) for m, i in enumerate(rounds.index)]
                self.of[name] += [self.gap(self.N + j, low[j], min(F(self.N + j, D), F(None, D)), limit.attained[j])
                                  for j in phases]

    def lipschitz(self, n, X, rights, slack=Fraction(0), added=False):
        """abs(X(s,a)-X(t,a)) + slack TV(s,t,a) <= the right side of s and t: where that adds something, or where it does not."""
        m = self.model
        if not m.pairs:
            return Family(None, True, 1, 1, [((), [0], 0)])
        each = slack / self.tv.over  # what a unit of self.tv adds
        over = math.lcm(X.over, each.denominator) if added else X.over
        scale, more = over // X.over, int(each * over) if added else 0
        values = [[x * scale for x in row] for row in X.rows]

        def instances():
            for (s, t), tv, (right,) in zip(m.pairs, self.tv.rows, rights.rows):
                yield (s, t), [abs(x - y) + z * more if bool(slack and z) == added else None
                               for x, y, z in zip(values[s], values[t], tv)], right

        return Family(n, not added, over, rights.over, instances())

    def gap(self, n, X, right, proves):
        """Q*(s,a) - X(s,a) <= right"""
        lefts = difference(self.Qstar, X)
        return Family(n, proves, lefts.over, right.denominator,
                      [((s,), row, right.numerator) for s, row in enumerate(lefts.rows)])

    def lemma_2(self, right):
        limit, added = self.limit, 2 * self.model.g * self.limit.delta
        steps = [(n, Q, self.rounds.tables[n + 1], Fraction(0), True) for n, Q in enumerate(self.rounds.tables[:-1])]
        steps += [(self.N + j, Q, limit.Q[(j + 1) % limit.k], added, added == 0) for j, Q in enumerate(limit.Q)]
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
            known = [x for x in lefts if x is not None]
            if not known:
                continue
            here = bound * over - max(known) * right_over
            if least is None or here < least:
                least, where = here, states
            if n == round_at and states == states_at and lefts[action] is not None:
                found.append((Fraction(lefts[action], over), Fraction(bound, right_over)))
        if least is not None and least * slack.denominator < slack.numerator * over * right_over:
            node.wrong(f"right - left is less at {place_text(n, where, None)}, expected the least")
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
    except Exception as error:  # such as MemoryError: without this Python would exit 1, which says "violated"
        print(f"{shown}: $: not checked, {type(error).__name__}, expected a certificate that can be", file=sys.stderr)
        return 2
    rows = [("claim", "verdict", "left", "right", "tightest at")] + rows
    widths = [max(len(row[i]) for row in rows) for i in range(5)]
    verdicts = {row[1] for row in rows[1:]}
    code = 1 if "violated" in verdicts else 3 if "undetermined" in verdicts else 0
    lines = ["  " + "  ".join(cell.ljust(width) for cell, width in zip(row, widths)).rstrip() for row in rows]
    try:
        print(f"{shown}: {({0: 'HOLDS', 1: 'VIOLATED', 3: 'UNDETERMINED'})[code]}", *lines, sep="\n", flush=True)
    except BrokenPipeError:  # nobody reads on: the exit code still counts
        sys.stdout = open(os.devnull, "w", encoding="utf-8")
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
