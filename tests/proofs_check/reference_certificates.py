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

    def __init__(self, discount, eps, rewards, rows, points=None, norm=None, distances=None):
        self.g, self.eps = Fraction(discount), Fraction(eps)
        self.R = [[Fraction(x) for x in row] for row in rewards]
        self.P = [[{t: Fraction(p) for t, p in sorted(row.items()) if Fraction(p) != 0} for row in state] for state in rows]
        self.n, self.m = len(self.R), len(self.R[0])
        self.points = points and [[Fraction(x) for x in row] for row in points]
        self.norm, self.distances = norm, distances
        self.S, self.A = range(self.n), range(self.m)
        self.low = [[self.distance(s, t)[0] for t in self.S] for s in self.S]
        self.high = [[self.distance(s, t)[1] for t in self.S] for s in self.S]
        self.ball = [[t for t in self.S if self.near(s, t)] for s in self.S]

    def differences(self, s, t):
        return [abs(x - y) for x, y in zip(self.points[s], self.points[t])]

    def distance(self, s, t):
        """(d-, d+), or (None, None)."""
        if self.distances:
            d = self.distances[s][t]
            return (None, None) if d is None else (Fraction(d), Fraction(d))
        if self.norm != "l2":
            d = (sum if self.norm == "l1" else max)(self.differences(s, t))
            return Fraction(d), Fraction(d)
        q = sum((x * x for x in self.differences(s, t)), Fraction(0))
        below = math.isqrt(math.floor(q / UNIT**2)) * UNIT
        return below, below if below**2 == q else below + UNIT

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


def belief_game(model, Qstar, tie, slack=Fraction(0)):
    """Positions, values (less `slack`) and reach."""
    action = {}

    def moves(s, M):
        if M not in action:
            action[M] = first(model.A, lambda a: min(Qstar[m][a] for m in M), max, tie)
        a = action[M]
        seen = {u for m in M for u in model.P[m][a]}
        return a, {u: [(u, tuple(x for x in model.ball[t] if x in seen)) for t in model.ball[u]] for u in model.P[s][a]}

    todo = [(s, tuple(model.ball[t])) for s in model.S for t in model.ball[s]]
    found = set(todo)
    while todo:
        for options in moves(*todo.pop())[1].values():
            for position in options:
                if position not in found:
                    found.add(position)
                    todo.append(position)
    positions = sorted(found)
    index = {position: i for i, position in enumerate(positions)}
    choice = {i: {u: 0 for u in moves(*position)[1]} for i, position in enumerate(positions)}
    while True:  # policy iteration for the attacker, who minimizes
        matrix = [[Fraction(i == j) for j in range(len(positions))] for i in range(len(positions))]
        right = []
        for i, (s, M) in enumerate(positions):
            a, options = moves(s, M)
            right.append(model.R[s][a])
            for u, p in model.P[s][a].items():
                matrix[i][index[options[u][choice[i][u]]]] -= model.g * p
        W = solve_linear(matrix, right)
        stable = True
        for i, position in enumerate(positions):
            for u, options in moves(*position)[1].items():
                values = [W[index[option]] for option in options]
                if min(values) < values[choice[i][u]]:
                    choice[i][u], stable = values.index(min(values)), False
        if stable:
            break
    reach = max(model.low[s][m] for s, M in positions for m in M)
    return positions, [w - slack for w in W], reach


def text(x):
    return None if x is None else [text(y) for y in x] if isinstance(x, (list, tuple)) else str(Fraction(x))


def model_json(model):
    result = {"format": "maximin-mdp", "version": 1, "states": model.n, "actions": model.m, "discount": text(model.g),
              "eps": text(model.eps)}
    if model.distances:
        result["distances"] = text(model.distances)
    else:
        result["points"], result["norm"] = text(model.points), model.norm
    result["rewards"] = text(model.R)
    result["transitions"] = [[s, a, t, text(p)] for s in model.S for a in model.A for t, p in model.P[s][a].items()]
    return result


def certificate(model, **options):
    return examine(model, **options)[0]


def examine(model, reading="corrected", tie="lowest", rounds=None, radius=None, repeat=1, classes=None, with_limit=True, with_beliefs=True,
            belief_slack=Fraction(0)):
    """The certificate of a model, and all instances of each claim, the least first.

    `rounds`, `radius`, `repeat` (the orbit, that many times), `classes` and `belief_slack` ask for others that are as true.
    """
    S, A, g = model.S, model.A, model.g
    Vstar = model.extreme_value([list(A)] * model.n, max)
    Qstar = model.back(Vstar)
    constants, r_min, r_max = constants_of(model, Qstar)
    l_r, l_p, tv, l_star = (constants[name][0] for name in ("l_r", "l_p", "k", "l_star"))
    size, span = max(abs(r_min), abs(r_max)), r_max - r_min
    r_paper = size if reading == "corrected" else max(Fraction(0), r_max)
    L_print, L_sound = (l_r + model.n * l_p * x / (1 - g) for x in (r_paper, size))
    L_rep, L_tv = l_r + g * model.n * l_p * size / (1 - g), l_r + g * tv * span / (1 - g)
    D_print, D_sound, D_rep, D_tv = (2 * model.eps * g * L for L in (L_print, L_sound, L_rep, L_tv))

    N, orbit = find_limit(model, tie)
    N, limit = rounds or N, None
    tables, all_pairs = run(model, tie, N)
    if orbit and with_limit:
        limit = Limit(model, orbit * repeat, tables[N], tie, radius, classes)
        if not limit.valid():
            raise ValueError("not a limit after so many rounds, or with this radius")
    pairs, indices, first_round = [], [], []
    for n, pair in enumerate(all_pairs):
        if pair not in pairs:
            pairs.append(pair)
            first_round.append(n)
        indices.append(pairs.index(pair))
    fixed = [model.value([policy[t] for t in attack]) for policy, attack in pairs]
    robust = [robust_value(model, policy) for policy, _ in pairs]
    test_policy = policy_of(model, Qstar, tie)
    test_value = robust_value(model, test_policy)

    jumps = {(s, t, a): [abs(model.P[s][a].get(u, 0) - model.P[t][a].get(u, 0)) for u in S]
             for s, t in model.pairs_of_states() for a in A}

    # An instance is (at, left, right, whether it can prove a violation).
    def lipschitz(X, n, factor, slack):
        found = []
        for s, t in model.pairs_of_states():
            r = max([l_r * model.low[s][t]] + [abs(model.R[s][a] - model.R[t][a]) for a in A])
            p = max([l_p * model.low[s][t]] + [jump for a in A for jump in jumps[s, t, a]])
            for a in A:
                added = slack * sum(jumps[s, t, a]) / 2 if slack else 0
                found.append(({"n": n, "states": [s, t], "action": a}, abs(X[s][a] - X[t][a]) + added, r + factor * p, added == 0))
        return found

    def gap(X, n, right, counts):
        return [({"n": n, "states": [s], "action": a}, Qstar[s][a] - X[s][a], right, counts) for s in S for a in A]

    def tstar(Q):
        return model.back([max(row) for row in Q])

    d0 = max([Fraction(0)] + [x for row in Qstar for x in row])
    u0 = max([Fraction(0)] + [-x for row in Qstar for x in row])

    def F(n, D):
        return (g * (g**n * (d0 + u0) + D * (1 - g**n) / (1 - g)) + D) / (1 - g)

    def F_least(n, D):  # over n, n + k, n + 2k, ...
        return min(F(n, D), (g * D / (1 - g) + D) / (1 - g))

    nothing = [({}, Fraction(0), Fraction(0), True)]
    phases = range(limit.k if limit else 0)
    real = [limit.k == 1 or limit.single[j] for j in phases]  # low_j is the value of a pair
    paper_factor, sharp_factor = (1 + g) / (1 - g)**2, 1 / (1 - g)**2
    instances = {}
    if limit:
        delta, k = limit.delta, limit.k
        low, ours = [model.back(V) for V in limit.low], [V and model.back(V) for V in limit.fixed]
        if all(ours) and all(real):
            X = [(back, first_round[i]) for i in range(len(pairs)) for back in (model.back(fixed[i]), model.back(robust[i]))]
            X += [(back, N + j) for j in phases for back in (low[j], ours[j])]
            instances["lemma-1"] = sum((lipschitz(back, n, model.n * r_paper / (1 - g), 0) for back, n in X), []) or nothing
        factor = g * model.n * size / (1 - g)
        iterates = [(tables[n], n, 0) for n in range(N + 1)] + [(limit.Q[j], N + j, 2 * g * delta) for j in phases]
        instances["lemma-1-iterates"] = sum((lipschitz(X, n, factor, slack) for X, n, slack in iterates), []) or nothing
        loss = [(tstar(tables[n]), tables[n + 1], n, Fraction(0), True) for n in range(N)]
        loss += [(tstar(limit.Q[j]), limit.Q[(j + 1) % k], N + j, 2 * g * delta, g * delta == 0) for j in phases]
        instances["lemma-2"] = [({"n": n, "states": [s], "action": a}, abs(X[s][a] - Y[s][a]) + extra, D_print, counts)
                                for X, Y, n, extra, counts in loss for s in S for a in A]
    instances["lemma-3"] = []
    for n in range(N):
        policy, attack = all_pairs[n]
        step = model.back([Qstar[s][policy[attack[s]]] for s in S])
        instances["lemma-3"].append(({"n": n}, far(tables[n + 1], step), g * far(tables[n], Qstar), True))
    if limit:
        instances["theorem-1"] = sum((gap(ours[j] or low[j], N + j, paper_factor * D_print, bool(ours[j])) for j in phases), [])
        instances["A"] = sum((gap(low[j], N + j, paper_factor * D_sound, real[j]) for j in phases), [])
        instances["B"] = sum((gap(low[j], N + j, sharp_factor * D_sound, real[j]) for j in phases), [])
        for name, D in (("C", D_rep), ("D", D_tv)):
            instances[name] = sum((gap(model.back(robust[indices[n]]), n, F(n, D), True) for n in range(N)), [])
            instances[name] += sum((gap(low[j], N + j, F_least(N + j, D), real[j]) for j in phases), [])
    X = model.back(test_value)
    instances["E"] = [({"states": [s], "action": a}, Qstar[s][a] - X[s][a], 2 * model.eps * g * l_star / (1 - g), True)
                      for s in S for a in A]
    game = None
    if with_beliefs:
        positions, W, reach = belief_game(model, Qstar, tie, belief_slack)
        exact = belief_slack == 0
        game = {"positions": [[s, list(M)] for s, M in positions], "values": text(W), "reach": text(reach), "exact": exact}
        at = dict(zip(positions, W))
        instances["F"] = [({"states": [s]}, Vstar[s] - min(at[s, tuple(model.ball[t])] for t in model.ball[s]),
                           reach * l_star / (1 - g), exact) for s in S]

    claims = []
    for name in ("lemma-1", "lemma-1-iterates", "lemma-2", "lemma-3", "theorem-1", "A", "B", "C", "D", "E", "F"):
        found = instances.get(name, [])
        failing = [x for x in found if x[1] > x[2]]
        proofs = [x for x in found if x[3] and model.norm != "l2"]
        if found and not failing:
            verdict = "holds"
        elif any(x[1] > x[2] for x in proofs):
            verdict, found = "violated", proofs
        else:
            claims.append({"claim": name, "verdict": "undetermined"})
            continue
        instances[name] = found = sorted(found, key=lambda x: x[2] - x[1])
        at, left, right, _ = found[0]
        claims.append({"claim": name, "verdict": verdict, "left": text(left), "right": text(right), "at": at})

    result = {"format": "maximin-certificate", "version": 1, "model": model_json(model), "reading": reading, "tie": tie,
              "constants": {**{name: {"value": text(x), "at": at} for name, (x, at) in constants.items()},
                            "r_min": text(r_min), "r_max": text(r_max)},
              "optimal": text(Vstar),
              "pairs": [{"policy": list(policy), "attack": list(attack), "fixed": text(f), "robust": text(w)}
                        for (policy, attack), f, w in zip(pairs, fixed, robust)],
              "rounds": indices,
              "limit": limit and {"period": limit.k, "radius": text(limit.radius), "classes": limit.classes, "orbit": text(limit.orbit),
                                  "low": text(limit.low), "fixed": text(limit.fixed)},
              "test_time": {"policy": test_policy, "robust": text(test_value)}, "belief_game": game, "claims": claims}
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
        "random_six": certificate(random_model(1, 6, 2, Fraction(1, 2), 1)),
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
