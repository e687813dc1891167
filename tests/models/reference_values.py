#!/usr/bin/env python3
"""Computes reference_values.json: Q* and V* of real model files, by a way that shares nothing with the C++ code.

    python3 reference_values.py MODELS_FOLDER > reference_values.json

Only Python's standard library is used. The files are parsed here, by readers written for this purpose alone; Q* comes
from Howard's policy iteration in exact rational arithmetic (fractions.Fraction), every policy evaluated by Gaussian
elimination, until no action improves. The numbers are then rounded once, to the nearest double.

Conventions: gymnasium's `terminated` ends the episode (no bootstrap); a POMDP stands for the MDP under it; a row of a
Cassandra file that misses 1 by at most 1e-5 is scaled; a discount that is missing or 1 is replaced by 0.95.
"""
import json
import re
import sys
from fractions import Fraction
from pathlib import Path

DEFAULT_DISCOUNT = Fraction(19, 20)


class Mdp:
    """rewards[s][a], transitions[s][a] = {target: probability}, all Fractions."""

    def __init__(self, states, actions, discount):
        self.states, self.actions, self.discount = states, actions, discount
        self.rewards = [[Fraction(0)] * actions for _ in range(states)]
        self.transitions = [[{} for _ in range(actions)] for _ in range(states)]


def read_gymnasium(path):
    table = json.loads(path.read_text(), parse_float=Fraction)
    mdp = Mdp(table["nS"], table["nA"], DEFAULT_DISCOUNT)
    for s, actions in enumerate(table["P"]):
        for a, entries in enumerate(actions):
            for probability, target, reward, terminated in entries:
                mdp.rewards[s][a] += Fraction(probability) * Fraction(reward)
                if not terminated:
                    row = mdp.transitions[s][a]
                    row[target] = row.get(target, 0) + Fraction(probability)
    return mdp


class Cassandra:
    """A reader for Cassandra's format that keeps dense tables, as the format describes them."""

    RESERVED = {"discount", "values", "states", "actions", "observations", "T", "O", "R", "uniform", "identity",
                "reward", "cost", "start", "include", "exclude", "reset"}

    def __init__(self, text):
        text = re.sub(r"#.*", "", text)
        self.tokens = re.findall(r"[A-Za-z][\w-]*|\d+\.?\d*(?:[eE][+-]?\d+)?|[:*+-]", text)
        self.i = 0
        self.discount, self.sign = None, 1
        self.sizes, self.names = {"observations": 1}, {}
        self.start = []
        while self.peek() not in ("T", "O", "R"):
            self.preamble(self.take())
        n, m, k = (self.sizes[x] for x in ("states", "actions", "observations"))
        self.T = [[[Fraction(0)] * n for _ in range(n)] for _ in range(m)]      # a, s, s'
        self.O = [[[Fraction(1 if k == 1 else 0)] * k for _ in range(n)] for _ in range(m)]  # a, s', o
        self.R = {}                                                             # (a, s, s', o), last write wins
        while self.peek() is not None:
            getattr(self, "entry_" + self.take())()

    def peek(self):
        return self.tokens[self.i] if self.i < len(self.tokens) else None

    def take(self):
        self.i += 1
        return self.tokens[self.i - 1]

    def expect(self, token):
        assert self.take() == token

    def number(self):
        sign = {"-": -1, "+": 1}.get(self.peek())
        if sign is not None:
            self.take()
        return (sign or 1) * Fraction(self.take())

    def preamble(self, key):
        if key == "start":
            while self.peek() not in ("T", "O", "R", "discount", "values", "states", "actions", "observations"):
                self.start.append(self.take())  # irrelevant to Q* unless `reset` is used, which no file here does
            return
        self.expect(":")
        if key == "discount":
            self.discount = self.number()
        elif key == "values":
            self.sign = -1 if self.take().startswith("cost") else 1
        elif self.peek()[0].isdigit():
            self.sizes[key] = int(self.take())
        else:
            names = []
            while self.peek() not in self.RESERVED:
                names.append(self.take())
            self.names[key] = {name: i for i, name in enumerate(names)}
            self.sizes[key] = len(names)

    def reference(self, kind):
        self.expect(":")
        token = self.take()
        if token == "*":
            return range(self.sizes[kind])
        names = self.names.get(kind, {})
        return [names[token] if token in names else int(token)]

    def row(self, width):
        if self.peek() == "uniform":
            self.take()
            return [Fraction(1, width)] * width
        return [self.number() for _ in range(width)]

    def table_entry(self, table, kind):
        n, width = self.sizes["states"], self.sizes[kind]
        actions = self.reference("actions")
        if self.peek() != ":":
            if self.peek() == "identity":
                self.take()
                rows = [[Fraction(int(i == j)) for j in range(width)] for i in range(n)]
            elif self.peek() == "uniform":
                rows = [self.row(width)] * n
            else:
                rows = [self.row(width) for _ in range(n)]
            for a in actions:
                for s in range(n):
                    table[a][s] = list(rows[s])
            return
        states = self.reference("states")
        if self.peek() != ":":
            row = self.row(width)
            for a in actions:
                for s in states:
                    table[a][s] = list(row)
            return
        columns = self.reference(kind)
        value = self.number()
        for a in actions:
            for s in states:
                for c in columns:
                    table[a][s][c] = value

    def entry_T(self):
        self.table_entry(self.T, "states")

    def entry_O(self):
        self.table_entry(self.O, "observations")

    def entry_R(self):
        kinds = ["actions", "states", "states", "observations"]
        ranges = []
        for kind in kinds:
            if self.peek() != ":":
                break
            ranges.append(self.reference(kind))
        missing = [range(self.sizes[kind]) for kind in kinds[len(ranges):]]

        def fill(prefix, rest):
            if not rest:
                value = self.sign * self.number()
                for a in prefix[0]:
                    for s in prefix[1]:
                        for t in prefix[2]:
                            for o in prefix[3]:
                                self.R[a, s, t, o] = value
                return
            for i in rest[0]:
                fill(prefix + [[i]], rest[1:])

        fill(ranges, missing)

    def mdp(self):
        discount = self.discount if self.discount not in (None, 1) else DEFAULT_DISCOUNT
        n, m = self.sizes["states"], self.sizes["actions"]
        mdp = Mdp(n, m, discount)
        for a in range(m):
            for s in range(n):
                total = sum(self.T[a][s])
                assert abs(total - 1) <= Fraction(1, 100000)
                for t, p in enumerate(self.T[a][s]):
                    if p == 0:
                        continue
                    mdp.transitions[s][a][t] = p / total
                    seen = sum(self.O[a][t])
                    mean = sum(q * self.R.get((a, s, t, o), 0) for o, q in enumerate(self.O[a][t])) / seen
                    mdp.rewards[s][a] += p / total * mean
        return mdp


def read_cassandra(path):
    return Cassandra(path.read_text()).mdp()


def evaluate(mdp, policy):
    """Solves V = R_pi + discount P_pi V by Gaussian elimination."""
    n = mdp.states
    rows = []
    for s in range(n):
        row = {s: Fraction(1)}
        for t, p in mdp.transitions[s][policy[s]].items():
            row[t] = row.get(t, 0) - mdp.discount * p
        rows.append((row, mdp.rewards[s][policy[s]]))
    for k in range(n):
        pivot_row, pivot_value = rows[k]
        for i in range(k + 1, n):
            row, value = rows[i]
            factor = row.pop(k, 0) / pivot_row[k]
            if factor == 0:
                continue
            for j, x in pivot_row.items():
                if j > k:
                    row[j] = row.get(j, 0) - factor * x
            rows[i] = (row, value - factor * pivot_value)
    values = [Fraction(0)] * n
    for k in reversed(range(n)):
        row, value = rows[k]
        values[k] = (value - sum(x * values[j] for j, x in row.items() if j > k)) / row[k]
    return values


def q_values(mdp, values):
    return [[mdp.rewards[s][a] + mdp.discount * sum(p * values[t] for t, p in mdp.transitions[s][a].items())
             for a in range(mdp.actions)] for s in range(mdp.states)]


def policy_iteration(mdp):
    policy = [max(range(mdp.actions), key=lambda a, s=s: mdp.rewards[s][a]) for s in range(mdp.states)]
    while True:
        values = evaluate(mdp, policy)
        q = q_values(mdp, values)
        improved = [max(range(mdp.actions), key=lambda a, s=s: (q[s][a], a == policy[s])) for s in range(mdp.states)]
        if improved == policy:
            assert all(max(q[s]) == values[s] for s in range(mdp.states))  # V* = T* V*, exactly
            return q
        policy = improved


def main():
    folder = Path(sys.argv[1])
    files = ["gymnasium/FrozenLake-v1_4x4_slippery.json", "gymnasium/FrozenLake-v1_8x8_slippery.json",
             "gymnasium/CliffWalking-v1.json"]
    files += sorted(str(p.relative_to(folder)) for p in (folder / "cassandra").iterdir())
    models = []
    for file in files:
        read = read_gymnasium if file.endswith(".json") else read_cassandra
        mdp = read(folder / file)
        q = policy_iteration(mdp)
        models.append({"file": file, "discount": float(mdp.discount), "V": [float(max(row)) for row in q],
                       "Q": [[float(x) for x in row] for row in q]})
        print(file, file=sys.stderr)
    origin = ("Written by reference_values.py: exact policy iteration in rational arithmetic (Python's fractions), "
              "independent of the C++ code; rounded once, to the nearest double.")
    lines = ",\n".join("    " + json.dumps(model) for model in models)
    print('{\n  "origin": %s,\n  "models": [\n%s\n  ]\n}' % (json.dumps(origin), lines))


if __name__ == "__main__":
    main()
