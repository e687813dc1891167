"""Runs programs as a shell would and compares what they print with what is kept. Needs nothing but Python 3.

A test file lists its cases and hands them to main():

    Golden(name, arguments)        standard output must be as in golden/NAME.txt (or .json: equal to 1e-9)
    Refusal(arguments, code, says) exit code, nothing on standard output, one line on standard error that contains `says`

`FILE.py --program PATH --regenerate` writes the golden files anew; read the difference before committing it.
"""

import argparse
import difflib
import glob
import json
import math
import os
import re
import subprocess
import sys
import tempfile
from dataclasses import dataclass, field

HERE = os.path.dirname(os.path.abspath(__file__))
GOLDEN = os.path.join(HERE, "golden")

# What may differ between compilers and processors: certified errors and how many sweeps they took.
UNSTABLE_KEYS = {"certified_error", "sweeps", "version"}


@dataclass
class Golden:
    name: str
    arguments: list
    stderr: str = ""  # all of it
    code: int = 0

    def path(self):
        return os.path.join(GOLDEN, self.name)


@dataclass
class Refusal:
    arguments: list
    code: int
    says: str
    files: dict = field(default_factory=dict)  # written into the working folder first


def run(program, arguments, **options):
    """Runs the program in tests/apps/models, so that messages name files as given there."""
    options.setdefault("cwd", os.path.join(HERE, "models"))
    return subprocess.run([program] + arguments, capture_output=True, timeout=300, **options)


def stable(text):
    """The text without the figures that compilers may differ in."""
    return re.sub(r"certified to [-+0-9.e]+", "certified to E", text)


def differences(expected, actual, where="$"):
    """Where two JSON values differ by more than rounding."""
    if isinstance(expected, bool) or isinstance(actual, bool) or expected is None or actual is None:
        return [] if expected is actual else ["%s: %r, expected %r" % (where, actual, expected)]
    if isinstance(expected, (int, float)) and isinstance(actual, (int, float)):
        close = math.isclose(expected, actual, rel_tol=1e-9, abs_tol=1e-9)
        return [] if close else ["%s: %r, expected %r" % (where, actual, expected)]
    if type(expected) is not type(actual):
        return ["%s: %r, expected %r" % (where, actual, expected)]
    if isinstance(expected, dict):
        if list(expected) != list(actual):
            return ["%s: keys %s, expected %s" % (where, list(actual), list(expected))]
        return [d for k in expected if k not in UNSTABLE_KEYS for d in differences(expected[k], actual[k], where + "." + k)]
    if isinstance(expected, list):
        if len(expected) != len(actual):
            return ["%s: %d entries, expected %d" % (where, len(actual), len(expected))]
        return [d for i, e in enumerate(expected) for d in differences(e, actual[i], "%s[%d]" % (where, i))]
    return [] if expected == actual else ["%s: %r, expected %r" % (where, actual, expected)]


def no_constants(name):
    raise ValueError("%s in JSON output" % name)


def check_golden(program, case, regenerate):
    result = run(program, case.arguments)
    out, err = result.stdout.decode(), result.stderr.decode()
    problems = []
    if result.returncode != case.code:
        problems.append("exit code %d, expected %d" % (result.returncode, case.code))
    if err != case.stderr:
        problems.append("standard error %r, expected %r" % (err, case.stderr))
    if problems:
        return problems
    if regenerate:
        with open(case.path(), "w", newline="\n") as f:
            f.write(out)
        return []
    with open(case.path()) as f:
        kept = f.read()
    if case.name.endswith(".json"):
        return differences(json.loads(kept), json.loads(out, parse_constant=no_constants))
    return list(difflib.unified_diff(stable(kept).splitlines(), stable(out).splitlines(), "kept", "printed", lineterm=""))


def check_refusal(program, case, folder):
    for name, content in case.files.items():
        with open(os.path.join(folder, name), "wb") as f:
            f.write(content if isinstance(content, bytes) else content.encode())
    result = run(program, case.arguments, cwd=folder)
    err = result.stderr.decode(errors="replace")
    problems = []
    if result.returncode != case.code:
        problems.append("exit code %d, expected %d" % (result.returncode, case.code))
    if result.stdout:
        problems.append("standard output is not empty: %r" % result.stdout[:200])
    if err.count("\n") != 1 or not err.endswith("\n"):
        problems.append("standard error is not one line: %r" % err)
    if case.says not in err:
        problems.append("standard error %r, expected it to say %r" % (err, case.says))
    return problems


def options():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", required=True, help="path of the program under test")
    parser.add_argument("--regenerate", action="store_true", help="write the golden files anew")
    parser.add_argument("--shared-models", help="folder of further model files")
    return parser.parse_args()


def report(checks):
    """Runs (name, function) pairs; each function returns a list of problems. Exits with 1 if there are any."""
    failed = 0
    for name, check in checks:
        problems = check()
        if problems:
            failed += 1
            print("FAILED %s\n  %s" % (name, "\n  ".join(problems)))
    print("%d checks, %d failed" % (len(checks), failed))
    if not checks:
        sys.exit("no checks")
    sys.exit(1 if failed else 0)


def model(**changes):
    """A small model file, valid but for the changes."""
    m = {"format": "maximin-mdp", "version": 1, "states": 2, "actions": 1, "discount": 0.5,
         "rewards": [[0], [1]], "transitions": [[0, 0, 1, 1], [1, 0, 1, 1]]}
    m.update(changes)
    return json.dumps({k: v for k, v in m.items() if v is not None})


def shared_models(folder):
    suffixes = (".POMDP", ".MDP", ".json", ".tra", ".drn", ".umb", ".csv")
    found = sorted(glob.glob(os.path.join(folder, "**", "*"), recursive=True))
    return [f for f in found if f.endswith(suffixes)]


def main(goldens, refusals, checks, check_shared_model):
    """Tests the program of the command line: on the shared models if they are given, else in all other ways. `checks` are
    functions of the program, and `check_shared_model` one of the program and a file, that return lists of problems."""
    arguments = options()
    program = os.path.abspath(arguments.program)
    if arguments.shared_models:
        report([(path, lambda path=path: check_shared_model(program, path)) for path in shared_models(arguments.shared_models)])
    cases = [(case.name, lambda case=case: check_golden(program, case, arguments.regenerate)) for case in goldens]
    if arguments.regenerate:
        report(cases)
    with tempfile.TemporaryDirectory() as folder:
        cases += [(" ".join(case.arguments), lambda case=case: check_refusal(program, case, folder)) for case in refusals]
        cases += [(check.__name__, lambda check=check: check(program)) for check in checks]
        report(cases)
