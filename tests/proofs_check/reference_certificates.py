"""Writes certificates (docs/certificate-format.md) of tiny models: slow, and so plain that it is seen to be right.

    reference_certificates.py OUTDIR

All arithmetic is on Fractions, every linear system is solved by Gaussian elimination, nothing is clever. It shares no line
with the checker that it tests, and none with the library.
"""

import json
import math
import os
import random
import sys
from fractions import Fraction

UNIT = Fraction(1, 2**64)  # of the bounds on an l2 distance
CLAIMS = ("lemma-1", "lemma-1-iterates", "lemma-2", "lemma-3", "theorem-1", "A", "B", "C", "D", "E", "F")


def solve_linear(matrix, right):
    """The x with matrix x = right; the matrix is regular."""
    size = len(matrix)
    rows = [list(row) + [value] for row, value in zip(matrix, right)]
    for column in range(size):
        pivot = next(i for i in range(column, size) if rows[i][column] != 0)
        rows[column], rows[pivot] = rows[pivot], rows[column]
        rows[column] = [x / rows[column][column] for x in rows[column]]
        for i in range(size):
            if i != column and rows[i][column] != 0:
                factor = rows[i][column]
                rows[i] = [x - factor * y if y else x for x, y in zip(rows[i], rows[column])]
    return [row[size] for row in rows]


class Model:
    """A finite MDP with distances. `rows[s][a]` is {next: probability}; a distance None is infinite."""

    def __init__(self, discount, eps, rewards, rows, points=None, norm=None, distances=None, metric=None):
        self.g, self.eps = Fraction(discount), Fraction(eps)
        self.R = [[Fraction(x) for x in row] for row in rewards]
        self.P = [[{t: Fraction(p) for t, p in sorted(row.items()) if Fraction(p) != 0} for row in state] for state in rows]
        self.n, self.m = len(self.R), len(self.R[0])
        self.points = points and [[Fraction(x) for x in row] for row in points]
        self.norm, self.metric = norm, metric
        self.S, self.A = range(self.n), range(self.m)
        self.distances = distances or (self.hops() if metric == "hops" else None)
        self.low = [[self.distance(s, t)[0] for t in self.S] for s in self.S]
        self.high = [[self.distance(s, t)[1] for t in self.S] for s in self.S]
        self.ball = [[t for t in self.S if self.near(s, t)] for s in self.S]

    def differences(self, s, t):
        return [abs(x - y) for x, y in zip(self.points[s], self.points[t])]

    def distance(self, s, t):
        """(d-, d+), or (None, None)."""
        if self.metric == "discrete":
            return Fraction(s != t), Fraction(s != t)
        if self.distances:
            d = self.distances[s][t]
            return (None, None) if d is None else (Fraction(d), Fraction(d))
        if self.norm != "l2":
            d = (sum if self.norm == "l1" else max)(self.differences(s, t))
            return Fraction(d), Fraction(d)
        q = sum((x * x for x in self.differences(s, t)), Fraction(0))
        below = math.isqrt(math.floor(q / UNIT**2)) * UNIT
        return below, below if below**2 == q else below + UNIT

    def hops(self):
        """By the algorithm of Floyd and Warshall."""
        def step(s, t):
            return any(t in row for row in self.P[s]) or any(s in row for row in self.P[t])

        d = [[0 if s == t else 1 if step(s, t) else None for t in self.S] for s in self.S]
        for u in self.S:
            for s in self.S:
                for t in self.S:
                    if d[s][u] is not None and d[u][t] is not None and (d[s][t] is None or d[s][u] + d[u][t] < d[s][t]):
                        d[s][t] = d[s][u] + d[u][t]
        return d

    def near(self, s, t):
        if self.norm == "l2":
            return sum(x * x for x in self.differences(s, t)) <= self.eps**2
        return self.low[s][t] is not None and self.low[s][t] <= self.eps

    def back(self, V):
        return [[self.R[s][a] + self.g * sum(p * V[t] for t, p in self.P[s][a].items()) for a in self.A] for s in self.S]

    def value(self, action):
        """Of always taking action[s] in s."""
        matrix = [[Fraction(s == t) - self.g * self.P[s][action[s]].get(t, 0) for t in self.S] for s in self.S]
        return solve_linear(matrix, [self.R[s][action[s]] for s in self.S])

    def extreme_value(self, choices, best):
        """V with V(s) = best over a in choices[s] of back(V)(s,a), by policy iteration."""
        action = [options[0] for options in choices]
        while True:
            V = self.value(action)
            Q = self.back(V)
            better = [best(choices[s], key=lambda a: Q[s][a]) for s in self.S]
            if all(Q[s][better[s]] == V[s] for s in self.S):
                return V
            action = [action[s] if Q[s][action[s]] == Q[s][better[s]] else better[s] for s in self.S]

    def pairs_of_states(self):
        return [(s, t) for s in self.S for t in self.S if s < t and self.low[s][t] is not None]


def first(candidates, key, best, tie):
    """The best of the candidates; among equals the lowest or the highest."""
    top = best(key(c) for c in candidates)
    return (min if tie == "lowest" else max)(c for c in candidates if key(c) == top)


def policy_of(model, Q, tie):
    return [first(model.A, lambda a: min(Q[m][a] for m in model.ball[t]), max, tie) for t in model.S]


def attack_of(model, Q, policy, tie):
    return [first(model.ball[s], lambda t: Q[s][policy[t]], min, tie) for s in model.S]


def robust_value(model, policy):
    return model.extreme_value([sorted({policy[t] for t in model.ball[s]}) for s in model.S], min)


def run(model, tie, count):
    """Tables Q_0 ... Q_count, and the pair of every round before the last table."""
    tables, pairs = [[[Fraction(0)] * model.m for _ in model.S]], []
    for _ in range(count):
        Q = tables[-1]
        policy = policy_of(model, Q, tie)
        attack = attack_of(model, Q, policy, tie)
        pairs.append((tuple(policy), tuple(attack)))
        tables.append(model.back([Q[s][policy[attack[s]]] for s in model.S]))
    return tables, pairs


def far(Q, X):
    return max(abs(x - y) for row, other in zip(Q, X) for x, y in zip(row, other))


def orbit_values(model, actions):
    """U_j(s) = back(U_{j-1})(s, actions[j][s]), cyclically, as one linear system."""
    k = len(actions)
    matrix = [[Fraction(0)] * (k * model.n) for _ in range(k * model.n)]
    right = []
    for j in range(k):
        for s in model.S:
            row = matrix[j * model.n + s]
            row[j * model.n + s] += 1
            for t, p in model.P[s][actions[j][s]].items():
                row[(j - 1) % k * model.n + t] -= model.g * p
            right.append(model.R[s][actions[j][s]])
    flat = solve_linear(matrix, right)
    return [flat[j * model.n:(j + 1) * model.n] for j in range(k)]


class Limit:
    """The limit as the page defines it, made from a candidate orbit and Q_N; `valid()` asks conditions 1 to 4.

    Classes that are not given are the coarsest that are found by splitting those of equal Q_N and rewards.
    """

    def __init__(self, model, orbit, table, tie, radius=None, classes=None):
        k = self.k = len(orbit)
        self.model, self.orbit, self.table, self.tie = model, orbit, table, tie
        self.Q = [model.back(orbit[j - 1]) for j in range(k)]
        self.v = [[[min(Q[m][a] for m in model.ball[t]) for a in model.A] for t in model.S] for Q in self.Q]
        gaps = [max(row) - x for v in self.v for row in v for x in row]
        gaps += [self.Q[j][s][a] - orbit[j][s] for j in range(k) for s in model.S for a in model.A]
        gaps += [self.Q[j][m][a] - self.v[j][t][a] for j in range(k) for t in model.S for m in model.ball[t] for a in model.A]
        gaps = [gap for gap in gaps if gap > 0]
        self.radius = radius or (min(gaps) / 3 if gaps else Fraction(1))
        self.delta = far(table, self.Q[0])
        self.entries = [(s, a) for s in model.S for a in model.A]
        if classes:
            self.use({(s, a): classes[s][a] for s, a in self.entries})
        else:
            self.use(self.numbered({(s, a): (table[s][a], model.R[s][a]) for s, a in self.entries}))
            while not self.stable():
                self.use(self.numbered({e: (self.klass[e], [self.moves(j, *e) for j in range(k)]) for e in self.entries}))
        self.classes = [[self.klass[s, a] for a in model.A] for s in model.S]
        self.low = [model.extreme_value([sorted({a for t in model.ball[s] for a in C[t]}) for s in model.S], min) for C in self.C]
        self.single = [all(len(c) == 1 for c in C) for C in self.C]
        self.fixed = []
        for j in range(k):
            action = [self.action(j, s) for s in model.S]
            if None not in action:
                self.fixed.append(model.value(action))
            else:
                self.fixed.append(orbit[0] if k == 1 else None)

    def numbered(self, key):
        keys = []
        for e in self.entries:
            if key[e] not in keys:
                keys.append(key[e])
        return {e: keys.index(key[e]) for e in self.entries}

    def use(self, klass):
        """Takes these classes, and finds C_j, A_j and which states are settled."""
        model, self.klass, self.C, self.A, self.settled = self.model, klass, [], [], []
        for Q, v, U in zip(self.Q, self.v, self.orbit):
            C = []
            for t in model.S:
                M = [{klass[m, a] for m in model.ball[t] if Q[m][a] <= v[t][a] + 2 * self.radius} for a in model.A]
                good = [a for a in model.A if v[t][a] >= max(v[t]) - 2 * self.radius]
                C.append([b for b in good if not any(M[a] <= M[b] and (a < b if self.tie == "lowest" else a > b) for a in good)])
            self.C.append(C)
            self.A.append([{a for t in model.ball[s] for a in C[t] if Q[s][a] == U[s]} for s in model.S])
            self.settled.append([all(len(C[t]) == 1 for t in model.ball[s]) for s in model.S])

    def equivalent(self, j, s, t):
        if s == t:
            return True
        both = self.settled[j][s] and self.settled[j][t]
        return both and {self.klass[s, a] for a in self.A[j][s]} == {self.klass[t, a] for a in self.A[j][t]}

    def moves(self, j, s, a):
        """The probability of moving from (s,a) into the states that are equivalent to each state."""
        return [sum(p for u, p in self.model.P[s][a].items() if self.equivalent(j, u, t)) for t in self.model.S]

    def stable(self):
        """Condition 4."""
        return all(self.table[s][a] == self.table[t][b] and self.model.R[s][a] == self.model.R[t][b]
                   and all(self.moves(j, s, a) == self.moves(j, t, b) for j in range(self.k))
                   for s, a in self.entries for t, b in self.entries if self.klass[s, a] == self.klass[t, b])

    def action(self, j, s):
        """a_j(s), or None."""
        played = self.A[j][s]
        if len(played) == 1:
            return min(played)
        if not self.settled[j][s] or len({self.klass[s, a] for a in played}) != 1:
            return None
        options = [(t, self.C[j][t][0]) for t in self.model.ball[s] if self.C[j][t][0] in played]
        return (min if self.tie == "lowest" else max)(options)[1]

    def valid(self):
        m, numbers = self.model, [self.klass[e] for e in self.entries]
        for Q, U, C in zip(self.Q, self.orbit, self.C):
            for s in m.S:
                if not U[s] == min(min(Q[s][a] for a in C[t]) for t in m.ball[s]):
                    return False
                if not U[s] == min(max(Q[s][a] for a in C[t]) for t in m.ball[s]):
                    return False
                if any(U[s] < Q[s][a] <= U[s] + 2 * self.radius for t in m.ball[s] for a in C[t]):
                    return False
        first_occurrences = [c for i, c in enumerate(numbers) if c not in numbers[:i]]
        return self.delta <= self.radius and self.stable() and first_occurrences == sorted(set(numbers)) == list(range(len(set(numbers))))

    def json(self):
        return {"period": self.k, "radius": text(self.radius), "classes": self.classes, "orbit": text(self.orbit), "low": text(self.low),
                "fixed": text(self.fixed)}

    def instances(self, sides, N):
        """Of phases; those of lemma-1 are None where they do not decide it."""
        model, k, found = self.model, self.k, {name: [] for name in CLAIMS}
        low, ours = [model.back(V) for V in self.low], [V and model.back(V) for V in self.fixed]
        real = [k == 1 or self.single[j] for j in range(k)]  # low_j is the value of a pair
        several = [[sum(p for t, p in row.items() if len(model.ball[t]) > 1) for row in state] for state in model.P]
        slack = 2 * model.g * self.delta
        found["lemma-1-iterates"] += sides.lipschitz("lemma-1-iterates", self.table, N)
        for j in range(k):
            found["lemma-1-iterates"] += sides.lipschitz("lemma-1-iterates", self.Q[j], N + j, slack)
            lefts = [[abs(x - y) + slack * m for x, y, m in zip(*rows)]
                     for rows in zip(tstar(model, self.Q[j]), self.Q[(j + 1) % k], several)]
            found["lemma-2"] += sides.each(lefts, N + j, sides.D_print, [[slack * m == 0 for m in row] for row in several])
            found["theorem-1"] += sides.gap(ours[j] or low[j], N + j, sides.bound("theorem-1", N + j, True), bool(ours[j]))
            for name in ("A", "B", "C", "D"):
                found[name] += sides.gap(low[j], N + j, sides.bound(name, N + j, True), real[j])
            for X in (low[j], ours[j] or low[j]):
                found["lemma-1"] += sides.lipschitz("lemma-1", X, N + j)
        if not all(ours) or not all(real):
            found["lemma-1"] = None
        return found


FOUND = {}  # what find_limit found, by model and tie: the test asks for the same models again


def find_limit(model, tie):
    """(N, orbit), or (rounds, None) where none is found."""
    key = json.dumps(model_json(model)), tie
    if key not in FOUND:
        FOUND[key] = search_limit(model, tie)
    return FOUND[key]


def search_limit(model, tie, most=400, longest=6):
    floats = Model.__new__(Model)
    floats.__dict__.update(model.__dict__)
    floats.g = float(model.g)
    floats.R = [[float(x) for x in row] for row in model.R]
    floats.P = [[{t: float(p) for t, p in row.items()} for row in state] for state in model.P]
    tables, _ = run(floats, tie, most)
    period = next((k for k in range(1, longest + 1) if far(tables[most], tables[most - k]) < 1e-9), None)
    if period is None:
        return 3, None
    count = 1
    while count <= 90:
        tables, pairs = run(model, tie, count + period)
        orbit = orbit_values(model, [[policy[t] for t in attack] for policy, attack in pairs[count:]])
        if Limit(model, orbit, tables[count], tie).valid():
            return count, orbit
        count += 1 + count // 6
    return 3, None


def constants_of(model, Qstar):
    """{name: (value, at)} and the extreme rewards."""
    best = {name: (Fraction(0), None) for name in ("l_r", "l_p", "k", "l_star")}
    for s, t in model.pairs_of_states():
        for a in model.A:
            jumps = [abs(model.P[s][a].get(u, 0) - model.P[t][a].get(u, 0)) for u in model.S]
            found = [("l_r", abs(model.R[s][a] - model.R[t][a]), [s, t, a]), ("k", Fraction(sum(jumps)) / 2, [s, t, a]),
                     ("l_star", abs(Qstar[s][a] - Qstar[t][a]), [s, t, a])]
            found += [("l_p", jump, [s, t, a, u]) for u, jump in enumerate(jumps)]
            for name, difference, at in found:
                if difference and difference / model.high[s][t] > best[name][0]:
                    best[name] = (difference / model.high[s][t], at)
    rewards = [x for row in model.R for x in row]
    return best, min(rewards), max(rewards)


def next_positions(model, position, a):
    """For each next state, the positions among which the attacker chooses when a is taken."""
    s, M = position
    seen = {u for m in M for u in model.P[m][a]}
    return {u: [(u, tuple(x for x in model.ball[t] if x in seen)) for t in model.ball[u]] for u in model.P[s][a]}


def starts(model):
    return {(s, tuple(model.ball[t])) for s in model.S for t in model.ball[s]}


def reached_positions(model, choices, listed=lambda position: True):
    """All that are listed and reached by way of others; `choices(M)`: what the agent may take."""
    found = starts(model)
    todo = list(found)
    while todo:
        position = todo.pop()
        for a in choices(position[1]):
            for options in next_positions(model, position, a).values():
                for option in options:
                    if option not in found and listed(option):
                        found.add(option)
                        todo.append(option)
    return sorted(found)


def belief_game(model, choices, listed=lambda position: True):
    """Positions and values, by policy iteration for the attacker, who minimizes; and chooses what the agent takes of `choices`.

    Positions that are not listed have the value r_min/(1-g).
    """
    least = min(x for row in model.R for x in row) / (1 - model.g)
    positions = reached_positions(model, choices, listed)
    index = {position: i for i, position in enumerate(positions)}
    moves = [{a: next_positions(model, position, a) for a in choices(position[1])} for position in positions]
    plan = [next((a, {u: options[0] for u, options in following.items()}) for a, following in move.items()) for move in moves]
    while True:
        matrix = [[Fraction(i == j) for j in range(len(positions))] for i in range(len(positions))]
        right = []
        for i, ((s, _), (a, chosen)) in enumerate(zip(positions, plan)):
            right.append(model.R[s][a])
            for u, p in model.P[s][a].items():
                if chosen[u] in index:
                    matrix[i][index[chosen[u]]] -= model.g * p
                else:
                    right[i] += model.g * p * least
        W = dict(zip(positions, solve_linear(matrix, right)))
        better = [best_reply(model, s, move, lambda x: W.get(x, least)) for (s, _), move in zip(positions, moves)]
        if all(value == W[position] for position, (value, _) in zip(positions, better)):
            return positions, [W[position] for position in positions]
        plan = [old if value == W[position] else new for position, old, (value, new) in zip(positions, plan, better)]


def best_reply(model, s, move, value):
    """The least backup, and the action and next positions that have it."""
    replies = []
    for a, following in move.items():
        chosen = {u: min(options, key=value) for u, options in following.items()}
        replies.append((model.R[s][a] + model.g * sum(p * value(chosen[u]) for u, p in model.P[s][a].items()), (a, chosen)))
    return min(replies, key=lambda reply: reply[0])


def check_game(model, choices, positions, values, exact):
    """Raises ValueError where this is no belief game as the page defines it."""
    least = min(x for row in model.R for x in row) / (1 - model.g)
    W = dict(zip(positions, values))
    if any(position not in W for position in starts(model)):
        raise ValueError("a start is missing")
    if positions != reached_positions(model, choices, lambda position: exact or position in W):
        raise ValueError("positions")
    for position in positions:
        move = {a: next_positions(model, position, a) for a in choices(position[1])}
        backup = best_reply(model, position[0], move, lambda x: W.get(x, least))[0]
        if W[position] > backup or (exact and W[position] < backup):
            raise ValueError("values of the belief game")


def game_json(model, positions, values):
    reach = max(model.low[s][m] for s, M in positions for m in M)
    return {"positions": [[s, list(M)] for s, M in positions], "values": text(values), "reach": text(reach)}


def text(x):
    return None if x is None else [text(y) for y in x] if isinstance(x, (list, tuple)) else str(Fraction(x))


def model_json(model):
    result = {"format": "maximin-mdp", "version": 1, "states": model.n, "actions": model.m, "discount": text(model.g),
              "eps": text(model.eps)}
    if model.metric:
        result["metric"] = model.metric
    elif model.distances:
        result["distances"] = text(model.distances)
    else:
        result["points"], result["norm"] = text(model.points), model.norm
    result["rewards"] = text(model.R)
    result["transitions"] = [[s, a, t, text(p)] for s in model.S for a in model.A for t, p in model.P[s][a].items()]
    return result


def surviving(model, lo, hi, states, tie):
    """The candidates for a table between lo and hi, as the page defines them."""
    low = [min(lo[m][a] for m in states) for a in model.A]
    high = [min(hi[m][a] for m in states) for a in model.A]
    return tuple(b for b in model.A if not any(
        a != b and (low[a] > high[b] or (low[a] == high[b] and (a < b if tie == "lowest" else a > b))) for a in model.A))


class Step:
    """A round between lo and hi: candidates C(t), and x_n between low and high."""

    def __init__(self, model, lo, hi, tie):
        self.model, self.lo, self.hi = model, lo, hi
        self.C = [surviving(model, lo, hi, model.ball[t], tie) for t in model.S]
        self.low = [min(min(lo[s][a] for a in self.C[t]) for t in model.ball[s]) for s in model.S]
        self.high = [min(max(hi[s][a] for a in self.C[t]) for t in model.ball[s]) for s in model.S]

    def provoked(self, high):
        return [tuple(sorted({a for t in self.model.ball[s] for a in self.C[t] if self.lo[s][a] <= high[s]})) for s in self.model.S]

    def lost(self, low):
        """The left sides of lemma-2."""
        D = [Fraction(0) if self.model.ball[s] == [s] else max(self.hi[s]) - low[s] for s in self.model.S]
        return [[self.model.g * sum(p * D[t] for t, p in row.items()) for row in state] for state in self.model.P]


def down(V, bits):
    return [Fraction(math.floor(x * 2**bits), 2**bits) for x in V]


def up(V, bits):
    return [Fraction(math.ceil(x * 2**bits), 2**bits) for x in V]


def less(model, V, bits):
    """Values on the grid below V that a backup moves up, as V is a fixed point."""
    return down([x - model.g / (1 - model.g) / 2**bits for x in V], bits)


def more(model, V, bits):
    return up([x + model.g / (1 - model.g) / 2**bits for x in V], bits)


def all_shown(model, C):
    return [sorted({a for t in model.ball[s] for a in C[t]}) for s in model.S]


def enclose(model, C, A, bits):
    """`below` and `above` of rounds with candidates C that provoke A."""
    return less(model, model.extreme_value(all_shown(model, C), min), bits), more(model, model.extreme_value(A, max), bits)


def is_below(model, V, C):
    Q = model.back(V)
    return all(V[s] <= Q[s][a] for s, actions in enumerate(all_shown(model, C)) for a in actions)


def is_above(model, W, A):
    Q = model.back(W)
    return all(W[s] >= Q[s][a] for s in model.S for a in A[s])


def make_boxes(model, tie, period, low, high, bits):
    """Boxes around rounds that follow one between low and high: they grow until they close, on a grid."""
    last = down(low, bits), up(high, bits)
    while True:
        tables = [last]
        for _ in range(period):
            step = Step(model, model.back(tables[-1][0]), model.back(tables[-1][1]), tie)
            tables.append((down(step.low, bits), up(step.high, bits)))
        grown = [min(both) for both in zip(last[0], tables[-1][0])], [max(both) for both in zip(last[1], tables[-1][1])]
        if grown == last:
            break
        last = grown
    tables[-1] = last
    result = []
    for j in range(period):
        step = Step(model, model.back(tables[j][0]), model.back(tables[j][1]), tie)
        below, above = enclose(model, step.C, step.provoked(tables[j + 1][1]), bits)
        result.append({"low": tables[j + 1][0], "high": tables[j + 1][1], "below": below, "above": above})
    return result


class Boxes:
    """The limit by boxes; raises ValueError unless they enclose what follows a round between low and high."""

    def __init__(self, model, boxes, low, high, tie):
        self.model, self.boxes = model, boxes
        if any(u > x for u, x in zip(boxes[-1]["low"], low)) or any(w < x for w, x in zip(boxes[-1]["high"], high)):
            raise ValueError("condition 1 of boxes")
        self.steps = [Step(model, model.back(boxes[j - 1]["low"]), model.back(boxes[j - 1]["high"]), tie) for j in range(len(boxes))]
        for step, box in zip(self.steps, boxes):
            if any(u > x for u, x in zip(box["low"], step.low)) or any(w < x for w, x in zip(box["high"], step.high)):
                raise ValueError("condition 2 of boxes")
            if not is_below(model, box["below"], step.C) or not is_above(model, box["above"], step.provoked(box["high"])):
                raise ValueError("condition 3 of boxes")

    def instances(self, sides, N):
        """Those of each claim in phases."""
        found = {name: [] for name in CLAIMS}
        for j, (box, step) in enumerate(zip(self.boxes, self.steps)):
            before = self.boxes[j - 1]
            found["lemma-1"] += sides.spread("lemma-1", box["below"], box["above"], N + j)
            found["lemma-1-iterates"] += sides.spread("lemma-1-iterates", before["low"], before["high"], N + j)
            found["lemma-2"] += sides.each(step.lost(box["low"]), N + j, sides.D_print, False)
            X = self.model.back(box["below"])
            for name in ("theorem-1", "A", "B", "C", "D"):
                found[name] += sides.gap(X, N + j, sides.bound(name, N + j, True), False)
        return found

    def json(self):
        return {"boxes": [{name: text(V) for name, V in box.items()} for box in self.boxes]}


class Sides:
    """The right sides, and instances (at, left, right, whether it can prove a violation).

    `constants`: their values by name; Q* (and V*) is between the tables low and high (and at most top).
    """

    def __init__(self, model, reading, constants, low, high, top):
        self.model, self.high, self.top = model, high, top
        g, n = model.g, model.n
        rewards = [x for row in model.R for x in row]
        self.l_r, self.l_p, tv, self.l_star = (constants[name] for name in ("l_r", "l_p", "k", "l_star"))
        size, span = max(abs(x) for x in rewards), max(rewards) - min(rewards)
        r_paper = size if reading == "corrected" else max(Fraction(0), max(rewards))
        L_print, L_sound = (self.l_r + n * self.l_p * x / (1 - g) for x in (r_paper, size))
        L_rep, L_tv = self.l_r + g * n * self.l_p * size / (1 - g), self.l_r + g * tv * span / (1 - g)
        self.D_print, self.D_sound, self.D_rep, self.D_tv = (2 * model.eps * g * L for L in (L_print, L_sound, L_rep, L_tv))
        self.factor = {"lemma-1": n * r_paper / (1 - g), "lemma-1-iterates": g * n * size / (1 - g)}
        d0 = max([Fraction(0)] + [x for row in low for x in row])
        u0 = max([Fraction(0)] + [-x for row in high for x in row])
        self.start = d0 + u0
        self.jumps = {(s, t, a): [abs(model.P[s][a].get(u, 0) - model.P[t][a].get(u, 0)) for u in model.S]
                      for s, t in model.pairs_of_states() for a in model.A}

    def lipschitz(self, name, X, n, slack=Fraction(0)):
        model, found = self.model, []
        for s, t in model.pairs_of_states():
            r = max([self.l_r * model.low[s][t]] + [abs(model.R[s][a] - model.R[t][a]) for a in model.A])
            p = max([self.l_p * model.low[s][t]] + [jump for a in model.A for jump in self.jumps[s, t, a]])
            for a in model.A:
                added = slack * sum(self.jumps[s, t, a]) / 2 if slack else 0
                found.append(({"n": n, "states": [s, t], "action": a}, abs(X[s][a] - X[t][a]) + added,
                              r + self.factor[name] * p, added == 0))
        return found

    def spread(self, name, V, W, n):
        middle = [(x + y) / 2 for x, y in zip(V, W)]
        half = max(y - x for x, y in zip(V, W)) / 2
        return [(*x[:3], False) for x in self.lipschitz(name, self.model.back(middle), n, 2 * self.model.g * half)]

    def each(self, lefts, n, right, counts):
        """One instance for each state and action; counts as a whole or each."""
        return [({**({} if n is None else {"n": n}), "states": [s], "action": a}, lefts[s][a], right,
                 counts if isinstance(counts, bool) else counts[s][a]) for s in self.model.S for a in self.model.A]

    def gap(self, X, n, right, counts):
        return self.each([[x - y for x, y in zip(*rows)] for rows in zip(self.high, X)], n, right, counts)

    def bound(self, name, n, phase):
        """The right side of theorem-1, A, B, C or D."""
        g = self.model.g
        if name in ("theorem-1", "A", "B"):
            return {"theorem-1": (1 + g) * self.D_print, "A": (1 + g) * self.D_sound, "B": self.D_sound}[name] / (1 - g)**2
        D = self.D_rep if name == "C" else self.D_tv
        now = (g * (g**n * self.start + D * (1 - g**n) / (1 - g)) + D) / (1 - g)
        return min(now, (g * D / (1 - g) + D) / (1 - g)) if phase else now


def tstar(model, Q):
    return model.back([max(row) for row in Q])


def round_instances(sides, tables, all_pairs, pairs, fixed, robust):
    """Of rounds n < N; tables has Q_N as well."""
    model, found = sides.model, {name: [] for name in CLAIMS}
    for i, pair in enumerate(pairs):
        for V in (fixed[i], robust[i]):
            found["lemma-1"] += sides.lipschitz("lemma-1", model.back(V), all_pairs.index(pair))
    for n, pair in enumerate(all_pairs):
        found["lemma-1-iterates"] += sides.lipschitz("lemma-1-iterates", tables[n], n)
        lefts = [[abs(x - y) for x, y in zip(*rows)] for rows in zip(tstar(model, tables[n]), tables[n + 1])]
        found["lemma-2"] += sides.each(lefts, n, sides.D_print, True)
        policy, attack = pair
        step = model.back([sides.high[s][policy[attack[s]]] for s in model.S])
        found["lemma-3"].append(({"n": n}, far(tables[n + 1], step), model.g * far(tables[n], sides.high), True))
        for name in ("C", "D"):
            found[name] += sides.gap(model.back(robust[pairs.index(pair)]), n, sides.bound(name, n, False), True)
    return found


def collect(model, early, late, others):
    """{claim: instances}, without those that can only be undetermined. `late`: of phases, or None."""
    found = dict(others)
    for name in CLAIMS[:9]:
        if name == "lemma-3":
            found[name] = early[name]
        elif late and late[name] is not None:
            found[name] = early[name] + late[name]
            if name in CLAIMS[:2] and not model.pairs_of_states():
                found[name] = [({}, Fraction(0), Fraction(0), True)]
    return {name: found[name] for name in CLAIMS if found.get(name)}


def claims_of(model, instances, names, exact=True):
    """The entries of `claims`; sorts the instances, the least first, and leaves those that count."""
    claims = []
    for name in names:
        found = instances.get(name, [])
        proofs = [x for x in found if x[3] and model.norm != "l2" and exact]
        if found and all(x[1] <= x[2] for x in found):
            verdict = "holds"
        elif any(x[1] > x[2] for x in proofs):
            verdict, found = "violated", proofs
        else:
            claims.append({"claim": name, "verdict": "undetermined"})
            continue
        instances[name] = found = sorted(found, key=lambda x: x[2] - x[1])
        at, left, right, _ = found[0]
        claims.append({"claim": name, "verdict": verdict, "left": text(left), "right": text(right), "at": at})
    return claims


def certificate(model, **options):
    return examine(model, **options)[0]


def examine(model, reading="corrected", tie="lowest", rounds=None, radius=None, repeat=1, classes=None, with_limit=True, with_beliefs=True,
            belief_slack=Fraction(0), period=None, bits=12, boxes=None, listed=None, game=None):
    """The certificate of a model, and all instances of each claim, the least first.

    `rounds`, `radius`, `repeat` (the orbit, that many times), `classes` and `belief_slack` ask for others that are as true.
    `period` asks for a limit by so many boxes, on a grid of 2^-bits, `boxes` for these; `listed` tells which positions to list
    of a belief game that is not exact, `game` is (positions, values) of such a one.
    """
    Vstar = model.extreme_value([list(model.A)] * model.n, max)
    Qstar = model.back(Vstar)
    constants, r_min, r_max = constants_of(model, Qstar)
    sides = Sides(model, reading, {name: value for name, (value, _) in constants.items()}, Qstar, Qstar, Vstar)
    rounds = rounds or find_limit(model, tie)[0]
    tables, all_pairs = run(model, tie, rounds)
    limit = None
    if period or boxes:
        policy, attack = all_pairs[-1]
        x = [tables[-2][s][policy[attack[s]]] for s in model.S]
        limit = Boxes(model, boxes or make_boxes(model, tie, period, x, x, bits), x, x, tie)
    elif with_limit and find_limit(model, tie)[1]:
        limit = Limit(model, find_limit(model, tie)[1] * repeat, tables[rounds], tie, radius, classes)
        if not limit.valid():
            raise ValueError("not a limit after so many rounds, or with this radius")
    pairs = sorted(set(all_pairs), key=all_pairs.index)
    fixed = [model.value([policy[t] for t in attack]) for policy, attack in pairs]
    robust = [robust_value(model, policy) for policy, _ in pairs]
    test_policy = policy_of(model, Qstar, tie)
    test_value = robust_value(model, test_policy)

    def choices(M):
        return [first(model.A, lambda a: min(Qstar[m][a] for m in M), max, tie)]

    others = {"E": sides.gap(model.back(test_value), None, 2 * model.eps * model.g * sides.l_star / (1 - model.g), True)}
    the_game = None
    if with_beliefs:
        exact = not (belief_slack or listed or game)
        positions, W = game or belief_game(model, choices, listed or (lambda position: True))
        W = [w - belief_slack for w in W]
        check_game(model, choices, positions, W, exact)
        the_game = {**game_json(model, positions, W), "exact": exact}
        others["F"] = belief_instances(sides, positions, W, exact)
    early = round_instances(sides, tables, all_pairs, pairs, fixed, robust)
    instances = collect(model, early, limit and limit.instances(sides, rounds), others)
    result = {"format": "maximin-certificate", "version": 1, "model": model_json(model), "reading": reading, "tie": tie,
              "constants": constants_json(constants, r_min, r_max), "optimal": text(Vstar),
              "pairs": [{"policy": list(policy), "attack": list(attack), "fixed": text(f), "robust": text(w)}
                        for (policy, attack), f, w in zip(pairs, fixed, robust)],
              "rounds": [pairs.index(pair) for pair in all_pairs], "limit": limit and limit.json(),
              "test_time": {"policy": test_policy, "robust": text(test_value)}, "belief_game": the_game,
              "claims": claims_of(model, instances, CLAIMS)}
    return result, instances


def constants_json(constants, r_min, r_max):
    return {**{name: {"value": text(x), "at": at} for name, (x, at) in constants.items()}, "r_min": text(r_min), "r_max": text(r_max)}


def belief_instances(sides, positions, values, exact):
    model, at = sides.model, dict(zip(positions, values))
    reach = max(model.low[s][m] for s, M in positions for m in M)
    return [({"states": [s]}, sides.top[s] - min(at[s, tuple(model.ball[t])] for t in model.ball[s]),
             reach * sides.l_star / (1 - model.g), exact) for s in model.S]


def bounded_rounds(model, tie, count, bits):
    """Steps of the rounds n < count, and what their x_n are between."""
    lo = hi = [[Fraction(0)] * model.m for _ in model.S]
    steps, between = [], []
    for _ in range(count):
        steps.append(Step(model, lo, hi, tie))
        between.append((down(steps[-1].low, bits), up(steps[-1].high, bits)))
        lo, hi = map(model.back, between[-1])
    return steps, between


def lower_constants(model, low, high, bits):
    """The largest quotients, with states in either order, rounded down."""
    best = {name: (Fraction(0), None) for name in ("l_r", "l_p", "k", "l_star")}
    for s in model.S:
        for t in model.S:
            if not model.high[s][t]:
                continue
            for a in model.A:
                jumps = [abs(model.P[s][a].get(u, 0) - model.P[t][a].get(u, 0)) for u in model.S]
                found = [("l_r", abs(model.R[s][a] - model.R[t][a]), [s, t, a]), ("k", Fraction(sum(jumps)) / 2, [s, t, a]),
                         ("l_star", low[s][a] - high[t][a], [s, t, a])] + [("l_p", jump, [s, t, a, u]) for u, jump in enumerate(jumps)]
                for name, difference, at in found:
                    [value] = down([difference / model.high[s][t]], bits)
                    if value > 0 and value >= best[name][0]:  # of equals the last: with t < s
                        best[name] = (value, at)
    return best


def bounds_certificate(model, reading="corrected", tie="lowest", rounds=8, bits=12, period=1, with_beliefs=True,
                       listed=lambda position: True):
    """A certificate by bounds, and its instances; all tables on a grid of 2^-bits. `period` 0: no limit."""
    Vstar = model.extreme_value([list(model.A)] * model.n, max)
    V, W = less(model, Vstar, bits), more(model, Vstar, bits)
    low, high = model.back(V), model.back(W)
    steps, between = bounded_rounds(model, tie, rounds, bits)
    pairs = []
    for step, (_, x) in zip(steps, between):
        if (step.C, step.provoked(x)) not in pairs:
            pairs.append((step.C, step.provoked(x)))
    free = {"constants": lower_constants(model, low, high, bits), "low": V, "high": W, "bits": bits, "rounds": rounds,
            "pairs": [enclose(model, C, A, bits) for C, A in pairs],
            "boxes": make_boxes(model, tie, period, *between[-1], bits) if period else None,
            "test": less(model, model.extreme_value(all_shown(model, Step(model, low, high, tie).C), min), bits), "game": None}
    if with_beliefs:
        positions, values = belief_game(model, lambda M: surviving(model, low, high, M, tie), listed)
        free["game"] = positions, less(model, values, bits)
    return examine_bounds(model, reading, tie, free)


def check_free(model, tie, free, low, high):
    """Raises ValueError where constants or optimal values of `free` are not bounds."""
    for name, (value, at) in free["constants"].items():
        if value == 0 and at is None:
            continue
        s, t, a, *u = at
        jumps = [abs(model.P[s][a].get(u, 0) - model.P[t][a].get(u, 0)) for u in model.S]
        difference = {"l_r": abs(model.R[s][a] - model.R[t][a]), "k": Fraction(sum(jumps)) / 2, "l_star": low[s][a] - high[t][a],
                      "l_p": jumps[u[0]] if u else None}[name]
        if value <= 0 or not model.high[s][t] or difference / model.high[s][t] < value:
            raise ValueError(f"constant {name}")
    if any(x > max(row) for x, row in zip(free["low"], low)) or any(x < max(row) for x, row in zip(free["high"], high)):
        raise ValueError("optimal")
    if not is_below(model, free["test"], Step(model, low, high, tie).C):
        raise ValueError("test_time")


def examine_bounds(model, reading, tie, free):
    """The certificate by bounds with these freely chosen numbers, and its instances; raises ValueError where they are wrong."""
    low, high = model.back(free["low"]), model.back(free["high"])
    check_free(model, tie, free, low, high)
    sides = Sides(model, reading, {name: value for name, (value, _) in free["constants"].items()}, low, high, free["high"])
    N, early = free["rounds"], {name: [] for name in CLAIMS}
    steps, between = bounded_rounds(model, tie, N, free["bits"])
    keys = [(step.C, step.provoked(x)) for step, (_, x) in zip(steps, between)]
    pairs = [key for n, key in enumerate(keys) if key not in keys[:n]]
    if len(pairs) != len(free["pairs"]):
        raise ValueError("number of pairs")
    for n, (step, key) in enumerate(zip(steps, keys)):
        V, W = free["pairs"][pairs.index(key)]
        if not is_below(model, V, step.C) or not is_above(model, W, key[1]):
            raise ValueError("values of a pair")
        if key not in keys[:n]:
            early["lemma-1"] += sides.spread("lemma-1", V, W, n)
        if n:
            early["lemma-1-iterates"] += sides.spread("lemma-1-iterates", *between[n - 1], n)
        early["lemma-2"] += sides.each(step.lost(between[n][0]), n, sides.D_print, False)
        for name in ("C", "D"):
            early[name] += sides.gap(model.back(V), n, sides.bound(name, n, False), False)
    limit = free["boxes"] and Boxes(model, free["boxes"], *between[-1], tie)
    others = {"E": sides.gap(model.back(free["test"]), None, 2 * model.eps * model.g * sides.l_star / (1 - model.g), False)}
    if free["game"]:
        positions, values = free["game"]
        check_game(model, lambda M: surviving(model, low, high, M, tie), positions, values, False)
        others["F"] = belief_instances(sides, positions, values, False)
    instances = collect(model, early, limit and limit.instances(sides, N), others)
    rewards = [x for row in model.R for x in row]
    result = {"format": "maximin-bounds", "version": 1, "model": model_json(model), "reading": reading, "tie": tie,
              "constants": constants_json(free["constants"], min(rewards), max(rewards)),
              "optimal": {"low": text(free["low"]), "high": text(free["high"])}, "bits": free["bits"],
              "pairs": [{"choices": [list(x) for x in C], "provoked": [list(x) for x in A], "below": text(V), "above": text(W)}
                        for (C, A), (V, W) in zip(pairs, free["pairs"])],
              "rounds": [pairs.index(key) for key in keys], "limit": limit and limit.json(), "test_time": {"below": text(free["test"])},
              "belief_game": game_json(model, *free["game"]) if free["game"] else None,
              "claims": claims_of(model, instances, [name for name in CLAIMS if name != "lemma-3"], exact=False)}
    return result, instances


def sure(*targets):
    """Rows of a model where action a surely leads to targets[s][a]."""
    return [[{t: 1} for t in row] for row in targets]


def random_model(seed, n, m, discount, eps):
    rng = random.Random(seed)
    rows = []
    for _ in range(n):
        rows.append([])
        for _ in range(m):
            weights = [rng.choice([0, 1, 1, 2, 3]) for _ in range(n)]
            weights[rng.randrange(n)] += 1
            rows[-1].append({t: Fraction(w, sum(weights)) for t, w in enumerate(weights)})
    rewards = [[Fraction(rng.randrange(-6, 7), rng.choice([1, 2, 3])) for _ in range(m)] for _ in range(n)]
    return Model(discount, eps, rewards, rows, points=[[i, Fraction(i * i, 3)] for i in range(n)], norm="linf")


def reference():
    """{name: certificate}"""
    half = Fraction(1, 2)
    one_sided = Model(half, 1, [[0, 0], [-1, -1], [-20, -20]], sure([0, 2], [2, 1], [2, 2]), points=[[0], [1], [20]], norm="l1")
    cycle = Model("9/10", 1, [[0, 2], [3, 0]], sure([0, 0], [0, 1]), points=[[0], [1]], norm="l1")
    cycle_ties = Model("9/10", 1, [[0, 2, 0], [3, 0, 3]], sure([0, 0, 0], [0, 1, 0]), points=[[0], [1]], norm="linf")
    chain = Model("2/3", 1, [["1/2", 0], [0, 0], [0, "1/4"], [0, 0], [0, 2]],
                  [[{max(s - 1, 0): Fraction(3, 4), s: Fraction(1, 4)} if s else {0: 1},
                    {min(s + 1, 4): Fraction(3, 4), s: Fraction(1, 4)} if s < 4 else {4: 1}] for s in range(5)],
                  points=[[i] for i in range(5)], norm="l1")
    plane = Model(half, "3/2", [[1, 0], [0, "1/3"], ["-1/2", 1], [0, 0]],
                  [[{0: half, 1: half}, {2: 1}], [{3: 1}, {0: "1/3", 1: "2/3"}], [{1: "1/5", 3: "4/5"}, {2: 1}], [{3: 1}, {0: 1}]],
                  points=[[0, 0], [1, 1], [2, 0], ["1/3", 2]], norm="l2")
    islands = Model("3/4", 1, [[1, 0], ["1/2", "1/3"], [-2, 5], [0, 4]],
                    [[{0: half, 2: half}, {1: 1}], [{0: 1}, {3: 1}], [{2: 1}, {0: "1/7", 3: "6/7"}], [{1: 1}, {2: "2/3", 3: "1/3"}]],
                    distances=[[0, 1, None, None], [1, 0, None, None], [None, None, 0, "1/2"], [None, None, "1/2", 0]])
    blind = Model(half, 0, [[1, 0], [0, 2], ["1/3", 0]], [[{1: 1}, {0: half, 2: half}], [{2: 1}, {0: 1}], [{0: "1/3", 1: "2/3"}, {2: 1}]],
                  points=[[0, 1], [1, 0], [3, 3]], norm="l1")
    single = Model("1/3", 2, [["-1/2", 5]], [[{0: 1}, {0: 1}]], points=[[0]], norm="linf")
    tied = Model(half, 1, [[1, 1, 0], [1, 1, 0], [0, 1, 1]], sure([0, 1, 2], [1, 0, 2], [2, 1, 0]),
                 distances=[[0, 1, 2], [1, 0, 1], [2, 1, 0]])
    negative = Model("4/5", 1, [[-3, -1], [-2, "-5/2"], [-1, -4]],
                     [[{0: half, 1: half}, {2: 1}], [{1: 1}, {0: "1/4", 2: "3/4"}], [{2: half, 0: half}, {1: 1}]],
                     points=[[0, 0], [1, "1/2"], [2, 2]], norm="linf")
    mirror = Model(half, 1, [[1, 1], [0, 0], [1, 1]], [[{0: half, 1: half}] * 2, [{0: 1}, {2: 1}], [{2: half, 1: half}] * 2],
                   points=[[-1], [0], [1]], norm="l1")
    # With x = 0 the limit ties: min Q(.,0) = min Q(.,1) = 2/3, and the two actions lead to different backups; classes decide.
    twins, twins_tie = (Model(half, 1, [[1, x], [1, x], [0, 3]],
                              [[{2: 1}, {0: half, 1: half}], [{2: 1}, {0: half, 1: half}], [{0: 1}, {2: 1}]],
                              points=[[0], [0], [1]], norm="l2") for x in ("-1/5", 0))
    # State 2 is absorbing, its actions are alike and it is in every ball: the least over a ball ties for all actions for ever.
    # In 0 action 1 is better, but the index decides; with tie = highest it is the other way round.
    pit = Model("9/10", 2, [[1, 2], [2, "1/2"], [-5, -5]], [[{0: half, 1: half}, {0: 1}], [{0: 1}, {1: half, 2: half}], [{2: 1}, {2: 1}]],
                points=[[0], [1], [2]], norm="l1")
    # Two rows of three cells, alike; actions: stay, change the row, right, left. Which row is shown makes no difference.
    cells = [(row, column) for row in range(2) for column in range(3)]
    place = {cell: i for i, cell in enumerate(cells)}
    rows = Model("4/5", 1, [[x] * 4 for x in (0, -1, 2) * 2],
                 [[{place[to]: Fraction(3, 4), place[0, 0]: Fraction(1, 8), place[1, 0]: Fraction(1, 8)} if to[1] else {place[to]: 1}
                   for to in ((i, j), (1 - i, j), (i, min(j + 1, 2)), (i, max(j - 1, 0)))] for i, j in cells],
                 points=cells, norm="l1")
    # Both actions of 0 are worth 1/2 from Q_3 on, one step and two steps from a reward: that no classes show, and none need to.
    detour = Model(half, 1, [[0, 0], [1, 1], [0, 0], [2, 2], [0, 0]], sure([1, 2], [4, 4], [3, 3], [4, 4], [4, 4]),
                   distances=[[0 if s == t else None for t in range(5)] for s in range(5)])
    # (0,0) and (1,0) have the same reward and stay where they are, but in round 0 action 1 is better in 0: no one class for ever.
    late = Model(half, 0, [[1, "3/2"], [1, 0], [0, 0]], sure([0, 2], [1, 2], [2, 2]), points=[[0], [1], [2]], norm="l1")
    # Hops are of both directions, and do not lead everywhere; in the ball of 1 are 0 and 2, which it cannot reach and can.
    hops = Model("3/4", 1, [[1, 0], ["1/2", 2], [0, "-1/3"], [3, 1]],
                 [[{1: 1}, {0: half, 1: half}], [{2: "1/3", 1: "2/3"}, {1: 1}], [{2: 1}, {2: 1}], [{3: 1}, {3: 1}]], metric="hops")
    discrete = Model("2/3", 1, [[1, 0], [0, 2], ["-1/2", "1/3"]],
                     [[{0: half, 1: half}, {2: 1}], [{1: 1}, {0: "1/4", 2: "3/4"}], [{2: 1}, {0: 1}]], metric="discrete")
    random_six = random_model(1, 6, 2, Fraction(1, 2), 1)
    greedy = Model(0, 1, [[1, 2], [2, 0]], sure([0, 1], [1, 0]), points=[[0], [1]], norm="l1")
    return {
        "one_sided_corrected": certificate(one_sided),
        "one_sided_paper": certificate(one_sided, reading="paper"),
        "cycle": certificate(cycle),
        "cycle_ties": certificate(cycle_ties),
        "cycle_ties_highest": certificate(cycle_ties, tie="highest"),
        "cycle_ties_apart": certificate(cycle_ties, classes=[[0, 1, 2], [3, 4, 5]]),
        "chain_l1": certificate(chain),
        "plane_l2": certificate(plane),
        "islands": certificate(islands),
        "eps_zero": certificate(blind),
        "one_state": certificate(single),
        "tied_lowest": certificate(tied),
        "tied_highest": certificate(tied, tie="highest"),
        "negative": certificate(negative),
        "negative_paper": certificate(negative, reading="paper"),
        "mirror": certificate(mirror),
        "twins": certificate(twins),
        "twins_tie": certificate(twins_tie),
        "discount_zero": certificate(greedy),
        "pit": certificate(pit),
        "pit_highest": certificate(pit, tie="highest"),
        "rows": certificate(rows),
        "rows_highest": certificate(rows, tie="highest"),
        "detour": certificate(detour),
        "late": certificate(late),
        "undecided": certificate(chain, rounds=2, with_limit=False, with_beliefs=False),
        "lower_bound": certificate(one_sided, belief_slack=Fraction(1, 8)),
        "random_six": certificate(random_six),
        "hops": certificate(hops),
        "discrete": certificate(discrete),
        "some_positions": certificate(chain, listed=lambda position: sum(position[1]) % 2 == 0),
        "some_starts": certificate(random_six, listed=lambda position: False),
        "boxes_cycle": certificate(cycle, rounds=31, period=3),
        "boxes_cycle_one": certificate(cycle, rounds=20, period=1, tie="highest"),
        "boxes_paper": certificate(one_sided, reading="paper", rounds=6, period=1, belief_slack=Fraction(1, 8)),
        "boxes_plane_l2": certificate(plane, rounds=9, period=2, bits=6),
        "boxes_single": certificate(single, rounds=2, period=1),
        "boxes_random": certificate(random_six, rounds=12, period=1),
        "boxes_wide": certificate(random_six, rounds=2, period=1, bits=1),
        "bounds_chain": bounds_certificate(chain)[0],
        "bounds_cycle": bounds_certificate(cycle, rounds=31, period=3)[0],
        "bounds_cycle_paper": bounds_certificate(cycle, rounds=9, reading="paper", tie="highest")[0],
        "bounds_plane_l2": bounds_certificate(plane, rounds=5, period=2)[0],
        "bounds_twins": bounds_certificate(twins, rounds=4)[0],
        "bounds_islands": bounds_certificate(islands, listed=lambda position: position[0] != 3)[0],
        "bounds_blind": bounds_certificate(blind, rounds=3)[0],
        "bounds_single": bounds_certificate(single, rounds=1, bits=0)[0],
        "bounds_hops": bounds_certificate(hops, rounds=4, bits=20)[0],
        "bounds_negative": bounds_certificate(negative, reading="paper", rounds=2, bits=3)[0],
        "bounds_random": bounds_certificate(random_six, rounds=6, bits=4)[0],
        "bounds_undecided": bounds_certificate(pit, period=0, with_beliefs=False)[0],
        "bounds_pit": bounds_certificate(pit, rounds=12)[0],
    }


def main():
    if len(sys.argv) != 2 or sys.argv[1].startswith("-"):
        sys.exit("usage: reference_certificates.py OUTDIR")
    os.makedirs(sys.argv[1], exist_ok=True)
    for name, contents in reference().items():
        with open(os.path.join(sys.argv[1], name + ".json"), "w", encoding="utf-8") as file:
            json.dump(contents, file)
            file.write("\n")


if __name__ == "__main__":
    main()
