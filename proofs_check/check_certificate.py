#!/usr/bin/env python3
"""Checks certificates of Maximin, exact ones and those by bounds, by substitution; written from docs/certificate-format.md
and from nothing else.

    check_certificate.py CERT.json...

prints each claim with its verdict and exits 0 (all hold), 1 (a claim is violated, which is proved), 3 (one is undetermined)
or 2 (not a certificate: one line on standard error says where and why). Of several files the worst code: 2, 1, 3, 0.
Python 3.9 or later, standard library only. Exact: a table is integers over one common denominator, and nothing is rounded
but as the page says.
"""

import functools
import itertools
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
MAX_BITS = 100_000  # to which rounds by bounds are rounded
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


def aligned(X, Y):
    """X and Y over one denominator."""
    over = math.lcm(X.over, Y.over)
    return tuple(Table([[x * (over // T.over) for x in row] for row in T.rows], over) for T in (X, Y))


def absolute(X):
    return Table([[abs(x) for x in row] for row in X.rows], X.over)


def largest(X):
    return Fraction(max(map(max, X.rows)), X.over)


def choose(X, choice):
    """The values s -> X(s, choice[s])."""
    return Table([[row[a]] for row, a in zip(X.rows, choice)], X.over)


def best_values(X):
    return Table([[max(row)] for row in X.rows], X.over)


def rounded_down(X, bits):
    """To multiples of 2^-bits."""
    return Table([[(x << bits) // X.over for x in row] for row in X.rows], 1 << bits)


def rounded_up(X, bits):
    return Table([[-((-x << bits) // X.over) for x in row] for row in X.rows], 1 << bits)


def exceeds(X, Y):
    """The first row in which X is above Y, values both, or None."""
    return next((s for s, ([x], [y]) in enumerate(zip(X.rows, Y.rows)) if x * Y.over > y * X.over), None)


def same(X, Y):
    """The first row in which X and Y differ, or None."""
    return next((s for s, (x, y) in enumerate(zip(X.rows, Y.rows)) if [v * Y.over for v in x] != [v * X.over for v in y]), None)


# ---- The model ---------------------------------------------------------------------------------------------------------


class Model:
    """States 0..n-1, actions 0..m-1, rewards, transitions, balls, and the bounds d- and d+ on finite distances."""

    def __init__(self, node):
        given = node.value if isinstance(node.value, dict) else {}
        places = "points norm" if "points" in given else "metric" if "metric" in given else "distances"
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
        self.l2 = False
        if len(distances) == 2:
            self.read_points(*distances)
        elif places == "metric":
            self.set_distances(self.hops() if distances[0].word("hops", "discrete") == "hops" else self.discrete())
        else:
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

    def discrete(self):
        return [[int(s != t) for t in range(self.n)] for s in range(self.n)]

    def hops(self):
        """The fewest steps between states; a step goes where some action leads, or back."""
        near = [{t for row, _ in cells for t in row} for cells in self.P]
        for s, cells in enumerate(self.P):
            for t in {t for row, _ in cells for t in row}:
                near[t].add(s)
        result = []
        for s in range(self.n):
            distance, last = [None] * self.n, [s]
            distance[s] = steps = 0
            while last:
                steps += 1
                last = {t for u in last for t in near[u] if distance[t] is None}
                for t in last:
                    distance[t] = steps
            result.append(distance)
        return result

    def set_distances(self, d):
        """Distances, or their squares under l2, and balls."""
        self.d, reach = d, self.eps**2 if self.l2 else self.eps
        self.ball = [tuple(t for t, x in enumerate(row) if x is not None and x <= reach) for row in d]
        self.balls = set(self.ball)
        self.blurred = [len(ball) > 1 for ball in self.ball]  # the states whose balls have several members

    def low(self, s, t):
        """d-(s,t)"""
        return roots(self.d[s][t])[0] if self.l2 else self.d[s][t]

    def high(self, s, t):
        """d+(s,t), None where it is infinite"""
        return roots(self.d[s][t])[1] if self.l2 else self.d[s][t]

    @functools.cached_property
    def pairs(self):
        return [(s, t) for s in range(self.n) for t in range(s + 1, self.n) if self.d[s][t] is not None]

    @functools.cached_property
    def jump(self):
        """`probability_jump` of all pairs of states and actions."""
        return {(s, t, a): self.probability_jump(s, t, a) for s, t in self.pairs for a in range(self.m)}

    def back(self, V):
        """back(V)(s,a) = R(s,a) + g sum_s' P(s'|s,a) V(s')"""
        below = self.g.denominator * self.P_over * V.over
        over = math.lcm(self.R.over, below)
        scale, r_scale = self.g.numerator * (over // below), over // self.R.over
        v = [row[0] for row in V.rows]
        return Table([[r * r_scale + scale * (self.P_over // p_over) * sum([p * v[t] for t, p in p_row.items()])
                       for r, (p_row, p_over) in zip(*rows)] for rows in zip(self.R.rows, self.P)], over)

    def expected(self, V):
        """g sum_s' P(s'|s,a) V(s')"""
        return difference(self.back(V), self.R)

    @functools.cached_property
    def into_blurred(self):
        """m(s,a) P_over: of moving into a state whose ball has several members."""
        return [[sum([p for t, p in row.items() if self.blurred[t]]) * (self.P_over // over) for row, over in cells] for cells in self.P]

    def maximin(self, Q, states, tie):
        """argmax_a min_{m in states} Q(m,a)"""
        order = range(self.m) if tie == "lowest" else range(self.m - 1, -1, -1)
        return max(order, key=lambda a: min([Q.rows[m][a] for m in states]))  # the first of equals

    def attack(self, Q, policy, tie):
        """argmin_{t in B(s)} Q(s,policy(t)) for every s"""
        return [min(ball if tie == "lowest" else ball[::-1], key=lambda t: row[policy[t]]) for ball, row in zip(self.ball, Q.rows)]

    def candidates(self, low, high, states, tie):
        """The actions that may be argmax_a min_{m in states} Q(m,a) of a Q between low and high; ascending."""
        low = [min(column) for column in zip(*[low.rows[m] for m in states])]
        high = [min(column) for column in zip(*[high.rows[m] for m in states])]
        top, order = max(low), range(self.m) if tie == "lowest" else range(self.m - 1, -1, -1)
        first = next(i for i, a in enumerate(order) if low[a] == top)  # it wins where another is at most equal
        return tuple(sorted([b for i, b in enumerate(order) if high[b] > top or (high[b] == top and i <= first)]))

    def shown(self, choices):
        """The sets of choices[t], t in B(s), for every s."""
        return [{choices[t] for t in ball} for ball in self.ball]

    def worst(self, Q, shown):
        """min_{t in B(s)} min_{a in choices[t]} Q(s,a) for every s"""
        return Table([[min([row[a] for choice in sets for a in choice])] for sets, row in zip(shown, Q.rows)], Q.over)

    def best_shown(self, Q, shown):
        """min_{t in B(s)} max_{a in choices[t]} Q(s,a) for every s"""
        return Table([[min([max([row[a] for a in choice]) for choice in sets])] for sets, row in zip(shown, Q.rows)], Q.over)

    def check_below(self, node, shown):
        """V <= min_{t in B(s)} min_{a in choices[t]} back(V)(s,a). Returns back(V)."""
        V = node.values(self.n)
        Q = self.back(V)
        check_at_most(node, V, self.worst(Q, shown), "min_{t in B(s)} min_{a in C(t)} back(V)(s,a)")
        return V, Q

    def check_above(self, node, provoked):
        """W >= max_{a in provoked[s]} back(W)(s,a)."""
        W = node.values(self.n)
        Q = self.back(W)
        top = Table([[max([row[a] for a in actions])] for actions, row in zip(provoked, Q.rows)], Q.over)
        check_at_least(node, W, top, "max_{a in A(s)} back(W)(s,a)")
        return W

    def check_robust(self, node, policy):
        """The value against the optimal attacker of a policy, as the node must state it."""
        V = node.values(self.n)
        check_same(node, V, self.worst(self.back(V), self.shown([(a,) for a in policy])), "min_{t in B(s)} back(V)(s, pi(t))")
        return V


@functools.cache
def roots(q):
    """d- and d+ of a distance whose square is q."""
    d = Fraction(math.isqrt(q.numerator * TWO64**2 // q.denominator), TWO64)
    return d, d if d * d == q else d + Fraction(1, TWO64)


def check_at_most(node, V, bound, meaning):
    s = exceeds(V, bound)
    node.require(s is None, f"[{s}] is too large, expected at most {meaning}")


def check_at_least(node, V, bound, meaning):
    s = exceeds(bound, V)
    node.require(s is None, f"[{s}] is too small, expected at least {meaning}")


def check_same(node, V, expected, meaning):
    s = same(V, expected)
    node.require(s is None, f"[{s}] is not the value, expected {meaning}")


# ---- Constants, optimal values, policy pairs and rounds ----------------------------------------------------------------


class Constants:
    """The Lipschitz constants and what follows from the rewards, checked. Q* is between the tables low and high.

    Exact: each constant is attained where it says, and exceeded nowhere. By bounds: each is nowhere too large.
    """

    def __init__(self, node, model, reading, low, high, exact):
        self.model, self.low, self.high = model, low, high
        names = ("l_r", "l_p", "k", "l_star")
        nodes = dict(zip(names + ("r_min", "r_max"), node.members(*names, "r_min", "r_max")))
        r_min, r_max = (Fraction(best(map(best, model.R.rows)), model.R.over) for best in (min, max))
        nodes["r_min"].equals(r_min, "the least reward")
        nodes["r_max"].equals(r_max, "the largest reward")
        self.r_min, self.size, self.span = r_min, max(abs(r_min), abs(r_max)), r_max - r_min
        self.print = self.size if reading == "corrected" else max(Fraction(0), r_max)
        self.l_r, self.l_p, self.k, self.l_star = (self.check_constant(nodes[name], name, exact) for name in names)

    def difference(self, name, s, t, a, u=None):
        """Whose quotient by d+(s,t) is meant; the largest over u where none is given. Never too large."""
        m = self.model
        if name == "l_r":
            return Fraction(abs(m.R.rows[s][a] - m.R.rows[t][a]), m.R.over)
        if name == "l_star":
            return Fraction(self.low.rows[s][a], self.low.over) - Fraction(self.high.rows[t][a], self.high.over)
        if u is not None:
            return abs(m.probability(s, a, u) - m.probability(t, a, u))
        return m.probability_jump(s, t, a)[1] if name == "k" else m.jump[s, t, a][0]

    def check_constant(self, node, name, exact):
        m, (value_node, at) = self.model, node.members("value", "at")
        value = value_node.number()
        value_node.require(value >= 0, "negative, expected a Lipschitz constant")
        if exact:
            self.check_nowhere_exceeded(node, name, value)
        if value == 0:
            at.require(at.value is None, f"{at.shown()}, expected null where the value is 0")
            return value
        place = at.array(4 if name == "l_p" else 3)
        s, t = (x.index(m.n) for x in place[:2])
        rest = [place[2].index(m.m)] + [x.index(m.n) for x in place[3:]]
        at.require((s < t or not exact) and m.high(s, t), "expected two states at a finite distance above 0" + ", s < t" * exact)
        there = self.difference(name, s, t, *rest)
        if exact:
            at.require(abs(there) == value * m.high(s, t), "does not attain the value, expected a place that does")
        else:
            at.require(there >= value * m.high(s, t), "the quotient is less than the value, expected at least that")
        return value

    def check_nowhere_exceeded(self, node, name, value):
        for s, t in self.model.pairs:
            limit = value * self.model.high(s, t)
            for a in range(self.model.m):
                there = self.model.jump[s, t, a][1] if name == "k" else abs(self.difference(name, s, t, a))
                if there > limit:
                    node.wrong(f"exceeded at states {s}, {t}, action {a}, expected the largest quotient")


class Rounds:
    """Q_0 ... Q_N and the policy pairs, whose values are checked."""

    exact = True

    def __init__(self, pairs_node, rounds_node, model, tie):
        self.pairs, pair_nodes = [], pairs_node.array()
        for node in pair_nodes:
            policy, attack, fixed, robust = node.members("policy", "attack", "fixed", "robust")
            self.pairs.append((policy.indices(model.m, model.n), attack.indices(model.n, model.n), fixed, robust))
        self.index, self.first = read_rounds(rounds_node, pairs_node, [pair[:2] for pair in self.pairs])
        self.N, self.tables = len(self.index), [Table([[0] * model.m] * model.n, 1)]
        for n, i in enumerate(self.index):
            Q, (policy, attack, _, _) = self.tables[-1], self.pairs[i]
            truth = [model.maximin(Q, ball, tie) for ball in model.ball]
            for name, stated, computed in (("policy", policy, truth), ("attack", attack, model.attack(Q, truth, tie))):
                if stated != computed:
                    rounds_node.wrong(f"[{n}] is pair {i}, expected one with the {name} of round {n}, {brief_list(computed)}")
            x = choose(Q, self.played(i))
            self.tables.append(model.back(x))
        self.last = x, x  # what x_{N-1} is between
        self.fixed, self.below = [], []  # back(fixed) and back(robust) of each pair
        for i, (policy, _, fixed, robust) in enumerate(self.pairs):
            V = fixed.values(model.n)
            self.fixed.append(model.back(V))
            check_same(fixed, V, choose(self.fixed[i], self.played(i)), "back(V)(s, pi(om(s)))")
            self.below.append(model.back(model.check_robust(robust, policy)))

    def played(self, i):
        policy, attack = self.pairs[i][:2]
        return [policy[t] for t in attack]

    def lemma_1(self, sides):
        for n, fixed, robust in zip(self.first, self.fixed, self.below):
            yield sides.lipschitz(n, fixed, sides.lemma_1_rights)
            yield sides.lipschitz(n, robust, sides.lemma_1_rights)

    def iterates(self, sides):
        for n, Q in enumerate(self.tables[:-1]):
            yield sides.lipschitz(n, Q, sides.iterates_rights)

    def lemma_2(self, sides):
        for n, (Q, following) in enumerate(zip(self.tables, self.tables[1:])):
            yield sides.lost(n, absolute(difference(sides.model.back(best_values(Q)), following)))

    def lemma_3(self, sides):
        for n, i in enumerate(self.index):
            step = sides.model.back(choose(sides.Qstar, self.played(i)))
            left = largest(absolute(difference(self.tables[n + 1], step)))
            right = sides.model.g * largest(absolute(difference(self.tables[n], sides.Qstar)))
            yield Family(n, True, left.denominator, right.denominator, [((), [left.numerator], right.numerator)])


def read_rounds(rounds_node, pairs_node, pairs):
    """The pair of each round, and the first round of each pair; the pairs are distinct, each occurs, in this order."""
    index, first = rounds_node.indices(len(pairs)), []
    rounds_node.require(index, "no rounds, expected at least one")
    for n, i in enumerate(index):
        if i == len(first):
            first.append(n)
        if i >= len(first):
            rounds_node.wrong(f"[{n}] is {i}, expected pairs in the order in which they first occur")
    pairs_node.require(len(first) == len(pairs), f"pair {len(first)} is of no round, expected only pairs of rounds")
    pairs_node.require(len(set(map(repr, pairs))) == len(pairs), "a pair occurs twice, expected no repetition")
    return index, first


def brief_list(numbers):
    return str(numbers) if len(numbers) <= 8 else str(numbers[:8])[:-1] + ", ...]"


# ---- The limit ---------------------------------------------------------------------------------------------------------


class Orbit:
    """Conditions 1 to 4 of a limit with an orbit, and the values that follow."""

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
        self.low, self.fixed, self.attained = [], [], []  # back(low_j), back(fixed_j) or None
        for low_node, fixed_node, phase, Q, values in zip(low.array(self.k), fixed.array(self.k), phases, self.Q, U):
            C = [tuple(self.candidates(Q, ball)) for ball in model.ball]
            played = self.check_phase(model, Q, values, C, phase)
            settled = [all(len(C[t]) == 1 for t in ball) for ball in model.ball]
            self.check_classes(classes, model, last, played, settled)
            V = low_node.values(model.n)
            X = model.back(V)
            check_same(low_node, V, model.worst(X, model.shown(C)), "min_{t in B(s)} min_{a in C_j(t)} back(V)(s,a)")
            self.low.append(X)
            self.attained.append(self.k == 1 or all(len(c) == 1 for c in C))
            action = [self.action(s, ball, C, played[s], settled[s]) for s, ball in enumerate(model.ball)]
            if None in action and self.k > 1:
                fixed_node.require(fixed_node.value is None, f"{fixed_node.shown()}, expected null: an action is not unique")
                self.fixed.append(None)
                continue
            V = fixed_node.values(model.n)
            X = model.back(V)
            check_same(fixed_node, V, values if None in action else choose(X, action), "that of (pi_n, om_n)")
            self.fixed.append(X)
        self.last, self.delta = last, largest(absolute(difference(last, self.Q[0])))
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
        check_same(node, U, model.worst(Q, model.shown(C)), "min_{t in B(s)} min_{a in C_j(t)} Q^j(s,a) (condition 1)")
        best = model.best_shown(Q, model.shown(C))
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

    def lemma_1(self, sides, N):
        if not all(self.fixed) or not all(self.attained):
            return None
        return [sides.lipschitz(N + j, X, sides.lemma_1_rights) for both in (self.low, self.fixed) for j, X in enumerate(both)]

    def iterates(self, sides, N):
        yield sides.lipschitz(N, self.last, sides.iterates_rights)
        slack = 2 * sides.model.g * self.delta
        for j, Q in enumerate(self.Q):
            for added in (False, True):
                yield sides.lipschitz(N + j, Q, sides.iterates_rights, slack, added)

    def lemma_2(self, sides, N):
        m = sides.model
        slack = 2 * m.g * self.delta / m.P_over
        for j, Q in enumerate(self.Q):
            lefts = absolute(difference(m.back(best_values(Q)), self.Q[(j + 1) % self.k]))
            over = math.lcm(lefts.over, slack.denominator)
            each = slack.numerator * (over // slack.denominator)
            more = [[each * x for x in row] for row in m.into_blurred]
            for added in (False, True):
                rows = [[x * (over // lefts.over) + y if bool(y) == added else None for x, y in zip(*both)]
                        for both in zip(lefts.rows, more)]
                yield sides.lost(N + j, Table(rows, over), not added)

    def below(self):
        """Of each phase: a table below all values, and whether it is attained."""
        return list(zip(self.low, self.attained))

    def theorem_1(self):
        return [(X or low, bool(X)) for X, low in zip(self.fixed, self.low)]


class Step:
    """A round whose Q_n is between lo and hi (lo <= hi): the candidates, and what x_n(s) = Q_n(s,c_n(s)) is between."""

    def __init__(self, model, lo, hi, tie):
        self.lo, self.hi = aligned(lo, hi)
        found = {ball: model.candidates(self.lo, self.hi, ball, tie) for ball in model.balls}
        self.choices = [found[ball] for ball in model.ball]
        self.shown = model.shown(self.choices)
        self.low, self.high = model.worst(self.lo, self.shown), model.best_shown(self.hi, self.shown)

    def provoked(self, high):
        """A(s): the candidates shown with lo(s,a) <= high(s), ascending."""
        return [tuple(sorted({a for choice in sets for a in choice if row[a] * high.over <= x * self.lo.over}))
                for sets, row, [x] in zip(self.shown, self.lo.rows, high.rows)]

    def loss(self, model, low):
        """D(s') = max_a hi(s',a) - low(s'), 0 where the agent sees the state; low is at most x_n."""
        lost = difference(best_values(self.hi), low)
        return Table([[x if blurred else 0] for [x], blurred in zip(lost.rows, model.blurred)], lost.over)


class Boxes:
    """Conditions 1 to 3 of a limit by boxes. `last` is what x_{N-1} is between."""

    def __init__(self, node, model, last, tie):
        [boxes] = node.members("boxes")
        nodes = [box.members("low", "high", "below", "above") for box in boxes.array()]
        self.k = len(nodes)
        boxes.require(nodes, "no boxes, expected at least one")
        self.u, self.w = ([box[i].values(model.n) for box in nodes] for i in (0, 1))
        check_at_most(nodes[-1][0], self.u[-1], last[0], "x_{N-1} (condition 1)")
        check_at_least(nodes[-1][1], self.w[-1], last[1], "x_{N-1} (condition 1)")
        self.loss, self.V, self.W, self.low = [], [], [], []  # low: back(V_j)
        for j, (low, high, below, above) in enumerate(nodes):
            step = Step(model, model.back(self.u[j - 1]), model.back(self.w[j - 1]), tie)
            check_at_most(low, self.u[j], step.low, "min_{t in B(s)} min_{a in C_j(t)} Lo^j(s,a) (condition 2)")
            check_at_least(high, self.w[j], step.high, "min_{t in B(s)} max_{a in C_j(t)} Hi^j(s,a) (condition 2)")
            V, X = model.check_below(below, step.shown)
            self.V.append(V)
            self.low.append(X)
            self.W.append(model.check_above(above, step.provoked(self.w[j])))
            self.loss.append(step.loss(model, self.u[j]))

    def lemma_1(self, sides, N):
        return [sides.spread(N + j, V, W, sides.lemma_1_rights) for j, (V, W) in enumerate(zip(self.V, self.W))]

    def iterates(self, sides, N):
        return [sides.spread(N + j, self.u[j - 1], self.w[j - 1], sides.iterates_rights) for j in range(self.k)]

    def lemma_2(self, sides, N):
        return [sides.lost(N + j, sides.model.expected(D), False) for j, D in enumerate(self.loss)]

    def below(self):
        return [(X, False) for X in self.low]

    theorem_1 = below


class BoundedRounds:
    """Rounds of a certificate by bounds: x_n is between low[n] and high[n], and the values of each pair between V and W."""

    exact = False

    def __init__(self, bits_node, pairs_node, rounds_node, model, tie):
        bits = bits_node.index(MAX_BITS + 1)
        nodes = [node.members("choices", "provoked", "below", "above") for node in pairs_node.array()]
        pairs = [[[tuple(actions.indices(model.m)) for actions in node.array(model.n)] for node in pair[:2]] for pair in nodes]
        self.index, self.first = read_rounds(rounds_node, pairs_node, pairs)
        self.N = len(self.index)
        lo = hi = Table([[0] * model.m] * model.n, 1)
        self.low, self.high, self.loss = [], [], []
        for n, i in enumerate(self.index):
            step = Step(model, lo, hi, tie)
            low, high = rounded_down(step.low, bits), rounded_up(step.high, bits)
            for name, stated, computed in zip(("choices", "provoked"), pairs[i], (step.choices, step.provoked(high))):
                if stated != computed:
                    s = next(s for s, both in enumerate(zip(stated, computed)) if both[0] != both[1])
                    rounds_node.wrong(f"[{n}] is pair {i}, whose {name} of state {s} are {brief_list(list(stated[s]))}, "
                                      f"expected {brief_list(list(computed[s]))}")
            self.low.append(low)
            self.high.append(high)
            self.loss.append(step.loss(model, low))
            lo, hi = model.back(low), model.back(high)
        self.last = low, high
        self.V, self.W, self.below = [], [], []  # below: back(V) of each pair
        for (choices, provoked), (_, _, below, above) in zip(pairs, nodes):
            V, X = model.check_below(below, model.shown(choices))
            self.V.append(V)
            self.below.append(X)
            self.W.append(model.check_above(above, provoked))

    def lemma_1(self, sides):
        for n, V, W in zip(self.first, self.V, self.W):
            yield sides.spread(n, V, W, sides.lemma_1_rights)

    def iterates(self, sides):
        for n, (low, high) in enumerate(zip(self.low[:-1], self.high[:-1]), 1):
            yield sides.spread(n, low, high, sides.iterates_rights)

    def lemma_2(self, sides):
        for n, D in enumerate(self.loss):
            yield sides.lost(n, sides.model.expected(D), False)

    lemma_3 = None


# ---- Pessimism at test time, and beliefs -------------------------------------------------------------------------------


def check_test_time(node, model, Qstar, tie):
    policy, robust = node.members("policy", "robust")
    truth = [model.maximin(Qstar, ball, tie) for ball in model.ball]
    policy.require(policy.indices(model.m, model.n) == truth, f"expected the maximin policy of Q*, {brief_list(truth)}")
    return model.check_robust(robust, policy.value)


def check_test_time_by_bounds(node, model, low, high, tie):
    """Returns back(V) of values V below those of the maximin policy of a Q* between the tables low and high."""
    [below] = node.members("below")
    return model.check_below(below, Step(model, low, high, tie).shown)[1]


class BeliefGame:
    """Positions, all that are reached if `exact`, and values that obey the equation. `choices(M)`: what a(M) may be."""

    def __init__(self, node, model, choices, exact, least):
        """`exact` None: as the node says. `least` stands for the values of positions that are missing."""
        positions, values, reach, *stated = node.members(*["positions", "values", "reach"] + ["exact"] * (exact is None))
        for said in stated:
            said.require(type(said.value) is bool, f"{said.shown()}, expected true or false")
        self.exact = exact if exact is not None else stated[0].value
        self.model, self.choices, self.node, self.sights = model, choices, positions, {}
        listed = self.read_positions(positions)
        W = common([[w] for w in values.numbers(len(listed)) + [least]])
        self.value, self.over = {position: w for position, [w] in zip(listed, W.rows)}, W.over
        [self.least] = W.rows[-1]
        reached = self.walk(values)
        extra = next((x for x in listed if x not in reached), None)
        positions.require(extra is None, f"{extra} is not reached, expected only positions that are"[:120])
        self.rho = max(model.low(s, m) for s, m in {(s, m) for s, M in listed for m in M})
        reach.equals(self.rho, "the largest distance within a belief")

    def read_positions(self, node):
        listed = []
        for entry in node.array():
            s, M = entry.array(2)
            listed.append((s.index(self.model.n), tuple(M.indices(self.model.n))))
            M.require(list(M.value) == sorted(set(M.value)), "expected ascending states")
            entry.require(len(listed) < 2 or listed[-2] < listed[-1], "out of order, expected ascending, none twice")
        return listed

    def walk(self, values_node):
        """Checks every position that is listed and reached by way of others; returns them."""
        ball = self.model.ball
        reached = {(s, ball[t]) for s in range(self.model.n) for t in ball[s]}
        todo = list(reached)
        for position in todo:
            self.node.require(position in self.value, f"no {brief_position(position)}, expected every start (s, B(t))")
        while todo:
            position = todo.pop()
            following = self.check_position(position, values_node)
            todo += following - reached
            reached |= following
        return reached

    def views(self, M):
        """For each action that may be taken: the next belief by what is shown."""
        if M not in self.sights:
            self.sights[M] = {}
            for a in self.choices(M):
                possible = {u for m in M for u in self.model.P[m][a][0]}
                shown = {t for u in possible for t in self.model.ball[u]}
                self.sights[M][a] = {t: tuple(u for u in self.model.ball[t] if u in possible) for t in shown}
        return self.sights[M]

    def check_position(self, position, values_node):
        """Its value is the backup, or at most that. Returns what follows and is listed."""
        m, (s, M), listed, backups = self.model, position, set(), []
        for a, next_belief in self.views(M).items():
            row, row_over = m.P[s][a]
            total = 0
            for u, p in row.items():
                following = {(u, next_belief[t]) for t in m.ball[u]}
                known = {x for x in following if x in self.value}
                if self.exact and len(known) < len(following):
                    self.node.wrong(f"not all that follows {brief_position(position)}, expected every position that is reached")
                total += p * min([self.value.get(x, self.least) for x in following])
                listed |= known
            backups.append(m.R.rows[s][a] * m.P_over * m.g.denominator * self.over
                           + m.g.numerator * total * (m.P_over // row_over) * m.R.over)
        stated, backup = self.value[position] * m.P_over * m.g.denominator * m.R.over, min(backups)
        if stated > backup or (stated < backup and self.exact):
            i = list(self.value).index(position)
            values_node.wrong(f"[{i}] is not the value, expected {'' if self.exact else 'at most '}its backup")
        return listed


def brief_position(position):
    return f"[{position[0]}, {brief_list(list(position[1]))}]"


# ---- Claims ------------------------------------------------------------------------------------------------------------


class Instances:
    """The families of instances of every claim. `high`: V*, or values above it; `start`: d0 + u0."""

    def __init__(self, model, constants, high, start, rounds, limit, test_back, game):
        self.model, self.constants, self.Vstar, self.Qstar, self.start = model, constants, high, model.back(high), start
        self.rounds, self.limit, self.test_back, self.game, self.N = rounds, limit, test_back, game, rounds.N
        self.names = [name for name in CLAIMS if rounds.exact or name != "lemma-3"]
        c, g, n = constants, model.g, model.n
        L_print, L_sound = (c.l_r + n * c.l_p * x / (1 - g) for x in (c.print, c.size))
        L_rep, L_tv = c.l_r + g * n * c.l_p * c.size / (1 - g), c.l_r + g * c.k * c.span / (1 - g)
        self.D_print, self.D_sound, self.D_rep, self.D_tv = (2 * model.eps * g * L for L in (L_print, L_sound, L_rep, L_tv))

    def of(self, name):
        """The families of a claim, or None where it can only be undetermined."""
        g, limit, rounds = self.model.g, self.limit, self.rounds
        if name == "lemma-3":
            return rounds.lemma_3(self)
        if name == "E":
            return [self.gap(None, self.test_back, 2 * self.model.eps * g * self.constants.l_star / (1 - g))]
        if name == "F":
            return self.game and [self.beliefs()]
        if limit is None:
            return None
        if name == "lemma-1":
            phases = limit.lemma_1(self, self.N)
            return phases and itertools.chain(rounds.lemma_1(self), phases)
        if name == "lemma-1-iterates":
            return itertools.chain(rounds.iterates(self), limit.iterates(self, self.N))
        if name == "lemma-2":
            return itertools.chain(rounds.lemma_2(self), limit.lemma_2(self, self.N))
        if name in ("C", "D"):
            return self.finite(self.D_rep if name == "C" else self.D_tv)
        factor, D = {"theorem-1": (1 + g, self.D_print), "A": (1 + g, self.D_sound), "B": (1, self.D_sound)}[name]
        tables = limit.theorem_1() if name == "theorem-1" else limit.below()
        return [self.gap(self.N + j, X, factor * D / (1 - g)**2, proves) for j, (X, proves) in enumerate(tables)]

    def finite(self, D):
        """Claim C, and D: their bound falls or rises with n to its limit."""
        g, N = self.model.g, self.N

        def F(power):  # of g
            return (g * (power * self.start + D * (1 - power) / (1 - g)) + D) / (1 - g)

        for n, i in enumerate(self.rounds.index):
            yield self.gap(n, self.rounds.below[i], F(g**n))
        for j, (X, proves) in enumerate(self.limit.below()):
            yield self.gap(N + j, X, min(F(g**(N + j)), F(Fraction(0))), proves)

    @functools.cached_property
    def lemma_1_rights(self):
        return self.lipschitz_rights(self.constants.print / (1 - self.model.g))

    @functools.cached_property
    def iterates_rights(self):
        return self.lipschitz_rights(self.model.g * self.constants.size / (1 - self.model.g))

    def lipschitz_rights(self, factor):
        """r(s,t) + n factor p(s,t) for all pairs of states."""
        m, c, result = self.model, self.constants, []
        for s, t in m.pairs:
            r = max(abs(x - y) for x, y in zip(m.R.rows[s], m.R.rows[t]))
            p = max(m.jump[s, t, a][0] for a in range(m.m))
            d = m.low(s, t)
            result.append([max(c.l_r * d, Fraction(r, m.R.over)) + m.n * factor * max(c.l_p * d, p)])
        return common(result)

    @functools.cached_property
    def tv(self):
        return common([[self.model.jump[s, t, a][1] for a in range(self.model.m)] for s, t in self.model.pairs])

    def lipschitz(self, n, X, rights, slack=Fraction(0), only=None):
        """abs(X(s,a)-X(t,a)) + slack TV(s,t,a) <= the right side of s and t; only where that adds something, or does not."""
        m = self.model
        if not m.pairs:
            return Family(None, not only, 1, 1, [((), [0], 0)])
        each = slack / self.tv.over  # what a unit of self.tv adds
        over = math.lcm(X.over, each.denominator)
        scale, more = over // X.over, int(each * over)
        values = [[x * scale for x in row] for row in X.rows]

        def instances():
            for (s, t), tv, (right,) in zip(m.pairs, self.tv.rows, rights.rows):
                yield (s, t), [abs(x - y) + z * more if only is None or bool(slack and z) == only else None
                               for x, y, z in zip(values[s], values[t], tv)], right

        return Family(n, not only, over, rights.over, instances())

    def spread(self, n, V, W, rights):
        """spread(V,W)(s,t,a) <= the right side of s and t"""
        V, W = aligned(V, W)
        middle = Table([[x + y] for [x], [y] in zip(V.rows, W.rows)], 2 * V.over)
        return self.lipschitz(n, self.model.back(middle), rights, self.model.g * largest(difference(W, V)))._replace(proves=False)

    def gap(self, n, X, right, proves=True):
        """Q*(s,a) - X(s,a) <= right"""
        return self.family(n, difference(self.Qstar, X), right, proves)

    def lost(self, n, lefts, proves=True):
        """Of lemma-2."""
        return self.family(n, lefts, self.D_print, proves)

    def beliefs(self):
        ball = self.model.ball
        worst = Table([[min(self.game.value[s, ball[t]] for t in ball[s])] for s in range(self.model.n)], self.game.over)
        right = self.game.rho * self.constants.l_star / (1 - self.model.g)
        return self.family(None, difference(self.Vstar, worst), right, self.game.exact)

    def family(self, n, lefts, right, proves):
        """One instance for each entry of the table of lefts."""
        return Family(n, proves, lefts.over, right.denominator,
                      [((s,), row, right.numerator) for s, row in enumerate(lefts.rows)])


def check_claim(node, names_left, instances):
    """One entry of `claims`. Returns what is printed of it."""
    model, exact = instances.model, instances.rounds.exact
    node.expect(dict, "an object")
    undetermined = node.value.get("verdict") == "undetermined"
    claim, verdict, *sides = node.members("claim", "verdict", *(() if undetermined else ("left", "right", "at")))
    name, said = claim.word(*instances.names), verdict.word("holds", *["violated"] * exact, "undetermined")
    claim.require(name in names_left, f"{name}, expected the order of the table, each at most once")
    if said == "undetermined":
        return name, said, "", "", ""
    families = instances.of(name)
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
    by_bounds = isinstance(root.value, dict) and root.value.get("format") == "maximin-bounds"
    instances, claims = (check_bounds if by_bounds else check_exact)(root)
    claims.require(claims.array(), "no claims, expected at least one")
    names = iter(instances.names)  # searched onwards only: in the order of the table, each at most once
    return [check_claim(entry, names, instances) for entry in claims.array()]


def read_head(form, version, model_node, reading, tie):
    form.word("maximin-certificate", "maximin-bounds")
    version.require(version.index(2) == 1, f"{version.value}, expected 1")
    return Model(model_node), reading.word("corrected", "paper"), tie.word("lowest", "highest")


def check_exact(root):
    """All but the claims of an exact certificate. Returns their instances and their node."""
    *head, constants, optimal, pairs, rounds, limit, test_time, game, claims = root.members(
        *"format version model reading tie constants optimal pairs rounds limit test_time belief_game claims".split())
    model, reading, tie = read_head(*head)
    Vstar = optimal.values(model.n)
    Qstar = model.back(Vstar)
    check_same(optimal, Vstar, best_values(Qstar), "max_a back(V)(s,a)")
    known = Constants(constants, model, reading, Qstar, Qstar, True)
    run = Rounds(pairs, rounds, model, tie)
    the_limit = None
    if isinstance(limit.value, dict) and "boxes" in limit.value:
        the_limit = Boxes(limit, model, run.last, tie)
    elif limit.value is not None:
        the_limit = Orbit(limit, model, run.tables[-1], tie)
    test_back = model.back(check_test_time(test_time, model, Qstar, tie))
    the_game = None
    if game.value is not None:
        the_game = BeliefGame(game, model, lambda M: [model.maximin(Qstar, M, tie)], None, known.r_min / (1 - model.g))
    return Instances(model, known, Vstar, start(Qstar, Qstar), run, the_limit, test_back, the_game), claims


def check_bounds(root):
    """The same of a certificate by bounds."""
    *head, constants, optimal, bits, pairs, rounds, limit, test_time, game, claims = root.members(
        *"format version model reading tie constants optimal bits pairs rounds limit test_time belief_game claims".split())
    model, reading, tie = read_head(*head)
    low_node, high_node = optimal.members("low", "high")
    V, W = low_node.values(model.n), high_node.values(model.n)
    low, high = aligned(model.back(V), model.back(W))  # what Q* is between
    check_at_most(low_node, V, best_values(low), "max_a back(V)(s,a)")
    check_at_least(high_node, W, best_values(high), "max_a back(W)(s,a)")
    known = Constants(constants, model, reading, low, high, False)
    run = BoundedRounds(bits, pairs, rounds, model, tie)
    the_limit = None if limit.value is None else Boxes(limit, model, run.last, tie)
    test_back = check_test_time_by_bounds(test_time, model, low, high, tie)
    the_game = None
    if game.value is not None:
        the_game = BeliefGame(game, model, lambda M: model.candidates(low, high, M, tie), False, known.r_min / (1 - model.g))
    return Instances(model, known, W, start(low, high), run, the_limit, test_back, the_game), claims


def start(low, high):
    """d0 + u0, or less: Q* is between low and high."""
    least = Fraction(min(map(min, high.rows)), high.over)
    return max(Fraction(0), largest(low)) + max(Fraction(0), -least)


def complain(line):
    try:
        print(line, file=sys.stderr, flush=True)
    except OSError:  # the exit code still counts
        pass


def report(file):
    """Checks one file and prints; returns its exit code."""
    shown = file if file.isprintable() else ascii(file)
    try:
        rows = check_certificate(read_json(file))
    except NotACertificate as error:
        complain(f"{shown}: {error}")
        return 2
    except Exception as error:  # such as MemoryError: without this Python would exit 1, which says "violated"
        complain(f"{shown}: $: not checked, {type(error).__name__}, expected a certificate that can be")
        return 2
    rows = [("claim", "verdict", "left", "right", "tightest at")] + rows
    widths = [max(len(row[i]) for row in rows) for i in range(5)]
    verdicts = {row[1] for row in rows[1:]}
    code = 1 if "violated" in verdicts else 3 if "undetermined" in verdicts else 0
    lines = ["  " + "  ".join(cell.ljust(width) for cell, width in zip(row, widths)).rstrip() for row in rows]
    left_out = [name for name in CLAIMS if name not in {row[0] for row in rows}]
    if left_out:
        lines.append("  not in this certificate: " + ", ".join(left_out))
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


def run(arguments):
    """The exit code of main, and 74 where standard output cannot be written: 1 says "violated"."""
    sys.stderr = sys.stderr or open(os.devnull, "w", encoding="utf-8")
    try:
        if sys.stdout is None:
            return 74
        code = main(arguments)
        sys.stdout.flush()
        return code
    except OSError:
        return 74


if __name__ == "__main__":
    os._exit(run(sys.argv[1:]))  # nothing is flushed again, which could fail again
