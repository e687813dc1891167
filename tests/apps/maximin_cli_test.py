"""What maximin prints, and what it says to bad usage and bad input."""

import json
import os
import shutil
import signal
import subprocess
import tempfile

from cli import Golden, Refusal, main, model, no_constants, run

COMMANDS = ["solve", "attack", "belief", "simulate", "learn", "convert", "info", "examples", "counterexample"]

HOPS = ("note: the model says nothing of distances: hops in the transition graph are taken, and eps = 1; "
        "--metric and --eps choose otherwise\n")

GOLDEN = [
    Golden("help.txt", ["--help"]),
    Golden("version.txt", ["--version"]),
    *[Golden("help_%s.txt" % c, [c, "--help"]) for c in COMMANDS],
    Golden("examples.txt", ["examples"]),
    Golden("examples.json", ["examples", "--json"]),
    Golden("solve_slippery_grid.txt", ["solve", "slippery_grid.json"]),
    Golden("solve_one_sided.json", ["solve", "one_sided.json", "--json", "--method", "value-iteration"]),
    Golden("solve_one_sided_robust.txt", ["solve", "one_sided.json", "--robust"]),
    Golden("solve_one_sided_robust.json", ["solve", "one_sided.json", "--robust", "--json"]),
    Golden("solve_cycling_robust.txt", ["solve", "cycling.json", "--robust"]),
    Golden("solve_slippery_grid_robust.txt", ["solve", "slippery_grid.json", "--robust"]),
    Golden("solve_no_geometry.txt", ["solve", "no_geometry.json", "--robust"], stderr=HOPS),
    Golden("solve_example_tiger.txt", ["solve", "--example", "tiger", "--discount", "0.5"]),
    Golden("solve_example_gridworld_first_rows.txt", ["solve", "--example", "gridworld", "--method", "value-iteration"]),
    Golden("attack_one_sided.txt", ["attack", "one_sided.json", "--agent", "greedy"]),
    Golden("attack_slippery_grid.txt", ["attack", "slippery_grid.json", "--agent", "greedy"]),
    Golden("attack_slippery_grid_pessimistic.txt", ["attack", "slippery_grid.json", "--agent", "pessimistic"]),
    Golden("attack_policy.json", ["attack", "cycling.json", "--policy", "1 0", "--json"]),
    Golden("attack_far.txt", ["attack", "slippery_grid.json", "--eps", "2", "--norm", "l1"]),
    Golden("belief_default.txt", ["belief"]),
    Golden("belief_slippery_grid_random.txt", ["belief", "slippery_grid.json", "--attack", "random", "--seed", "3"]),
    Golden("belief_slippery_grid_optimal.txt", ["belief", "slippery_grid.json", "--attack", "optimal", "--start", "(2,0)"]),
    Golden("belief_slippery_grid.json", ["belief", "slippery_grid.json", "--steps", "4", "--start", "5", "--json"]),
    Golden("belief_sets.txt", ["belief", "cycling.json", "--steps", "2"]),
    Golden("simulate_slippery_grid.txt", ["simulate", "slippery_grid.json", "--agent", "greedy", "--episodes", "300"]),
    Golden("simulate_belief.json", ["simulate", "slippery_grid.json", "--agent", "belief", "--episodes", "100", "--json"]),
    Golden("learn_one_sided.txt", ["learn", "one_sided.json", "--episodes", "200", "--horizon", "30"]),
    Golden("learn_belief.json", ["learn", "cycling.json", "--uncertainty", "belief", "--episodes", "20", "--horizon", "30",
                                 "--json"]),
    Golden("info_slippery_grid.txt", ["info", "slippery_grid.json"]),
    Golden("info_one_sided.json", ["info", "one_sided.json", "--json"]),
    Golden("convert_cycling.json", ["convert", "cycling.json"]),
    Golden("convert_hops.json", ["convert", "no_geometry.json", "--metric", "hops", "--eps", "2", "--discount", "0.25"],
           stderr="note: discount: 0.25 as asked for, instead of 0.75 in the file\n"),
    *[Golden("help_counterexample_%s.txt" % c, ["counterexample", c, "--help"]) for c in ("list", "show", "run", "draw", "search")],
    Golden("counterexample_list.txt", ["counterexample", "list"]),
    Golden("counterexample_list.json", ["counterexample", "list", "--json"]),
    Golden("counterexample_show.txt", ["counterexample", "show", "sharper-belief"]),
    Golden("counterexample_show.json", ["counterexample", "show", "maximin-deadlock", "--json"]),
    Golden("counterexample_show_model.json", ["counterexample", "show", "sharper-belief", "--model"]),
    Golden("counterexample_run_all.txt", ["counterexample", "run", "--all"]),
    Golden("counterexample_run.json", ["counterexample", "run", "contraction", "--json"]),
    Golden("counterexample_draw.txt", ["counterexample", "draw", "maximin-deadlock", "--dot"]),
    Golden("counterexample_search.txt", ["counterexample", "search", "stationary-optimum"]),
]



def bad(content, says, command="solve", code=2, more=()):
    return Refusal([command, "bad.json", *more], code, says, {"bad.json": content})



def usage(arguments, says, code=2):
    return Refusal(arguments, code, says, {"good.json": model()})


def numerals(policy, says):
    """A policy file for a model whose actions are called as the index of the other."""
    named = model(actions=2, rewards=[[0, 1], [1, 0]], action_names=["1", "0"], state_names=["a", "1"], points=[[0], [1]],
                  norm="l1", eps=1, transitions=[[0, 0, 1, 1], [0, 1, 0, 1], [1, 0, 1, 1], [1, 1, 0, 1]])
    return Refusal(["attack", "named.json", *policy], 2, says,
                   {"named.json": named, "half.json": '{"policy": [0, 0.5]}', "lists.json": "[0, []]",
                    "far.json": "[0, 2]", "less.json": "[-1, 0]", "other.json": '["1", "2"]', "null.json": "[null, 0]",
                    "huge.json": "[0, 18446744073709551616]", "deep.json": '{"policy": [' + "[" * 200000 + "]" * 200000 + "]}",
                    "deep_list.json": "[" * 200000})


REFUSALS = [
    # policies
    numerals(["--policy", "0,1"], "--policy: 0 is the name of action 1 and the index of another"),
    numerals(["--policy-file", "half.json"], "half.json: $.policy[1]: 0.5, expected the index or name"),
    numerals(["--policy-file", "lists.json"], "lists.json: $[1]: a value of type array"),
    numerals(["--policy-file", "null.json"], "null.json: $[0]: a value of type null"),
    numerals(["--policy-file", "far.json"], "far.json: $[1]: 2 is no action, expected an index 0 to 1"),
    numerals(["--policy-file", "less.json"], "less.json: $[0]: -1 is no action"),
    numerals(["--policy-file", "huge.json"], "huge.json: $[1]: "),
    numerals(["--policy-file", "other.json"], 'other.json: $[1]: "2" is no action, expected the name'),
    numerals(["--policy-file", "deep.json"], "deep.json: nested deeper than 32 levels"),
    numerals(["--policy-file", "deep_list.json"], "deep_list.json: nested deeper than 32 levels"),
    # options that would be ignored, empty values, numbers that are read otherwise elsewhere
    usage(["attack", "good.json", "--policy", "0 0", "--agent", "greedy"], "--policy: has no effect beside --agent greedy"),
    usage(["attack", "good.json", "--agent", "maximin", "--policy-file", "p"], "--policy-file: has no effect beside --agent"),
    usage(["simulate", "good.json", "--policy", "0 0", "--agent", "greedy"], "--policy: has no effect beside --agent greedy"),
    *[usage(["solve", "good.json", *given], "%s: has no effect without --robust" % given[0])
      for given in (["--eps", "1"], ["--metric", "hops"], ["--norm", "l1"], ["--max-policies", "9"])],
    *[usage(arguments, "%s: empty, expected a value" % arguments[-2]) for arguments in (
        ["solve", "--model", ""], ["solve", "--example", ""], ["solve", "good.json", "--graph", ""],
        ["solve", "good.json", "--reward-model", ""], ["convert", "good.json", "--output", ""],
        ["belief", "--start", ""], ["attack", "good.json", "--policy", ""], ["attack", "good.json", "--policy-file", ""])],
    usage(["solve", ""], "--model: empty, expected a value"),
    usage(["convert", "good.json", "-o", ""], "--output: empty, expected a value"),
    *[usage([command, "--seed", seed], "--seed: %s, expected a whole number" % seed)
      for command in ("belief", "simulate", "learn")
      for seed in ("010", "0x10", "+1", "-1", " 1", "1e3", "1.0", "18446744073709551616")],
    usage(["simulate", "good.json", "--episodes", "010"], "--episodes: 010, expected a whole number without leading zeros"),
    usage(["simulate", "good.json", "--eps", "1", "--eps", "2"], "--eps: given more than once, expected once"),
    usage(["simulate", "good.json", "--metric", "discrete", "--discount", "0.99999999999"], "expected --horizon N"),
    # usage
    usage([], "no command given"),
    usage(["slove"], "did you mean solve?"),
    usage(["--verison"], "did you mean --version?"),
    usage(["solve", "--jsn", "good.json"], "did you mean --json?"),
    usage(["solve", "--json=1x", "good.json"], "--json"),
    usage(["solve"], "no model given"),
    usage(["solve", "good.json", "another.json"], "another.json: unexpected argument"),
    usage(["solve", "good.json", "--example", "tiger"], "expected one of the two"),
    usage(["solve", "--example", "tigre"], "did you mean tiger?"),
    usage(["solve", "good.json", "--eps"], "--eps: a value is missing"),
    usage(["solve", "good.json", "--eps", "-1"], "--eps: -1, expected a finite number >= 0"),
    usage(["solve", "good.json", "--eps", "nan"], "--eps: nan"),
    usage(["solve", "good.json", "--eps", "inf"], "--eps: inf"),
    usage(["solve", "good.json", "--eps", "1e999"], "--eps: 1e999"),
    usage(["solve", "good.json", "--eps", "1,5"], "--eps: 1,5"),
    usage(["solve", "good.json", "--eps", ""], "--eps: "),
    usage(["solve", "good.json", "--eps", "1", "--eps", "2"], "--eps"),
    usage(["solve", "good.json", "--discount", "1"], "--discount: 1, expected a finite number >= 0 and < 1"),
    usage(["solve", "good.json", "--discount", "-0.1"], "--discount: -0.1"),
    usage(["solve", "good.json", "--metric", "euclid"], "--metric: euclid, expected one of points, hops, discrete"),
    usage(["solve", "good.json", "--norm", "l3", "--robust"], "--norm: l3, expected one of l1, l2, linf"),
    usage(["solve", "good.json", "--norm", "l1", "--robust"], "norm"),
    usage(["solve", "good.json", "--metric", "points", "--robust"], "points"),
    usage(["solve", "good.json", "--method", "magic"], "--method: magic"),
    usage(["solve", "good.json", "--max-sweeps", "0"], "--max-sweeps: 0, expected a whole number >= 1"),
    usage(["solve", "good.json", "--max-sweeps", "1e3"], "--max-sweeps: 1e3"),
    usage(["solve", "good.json", "--max-sweeps", "99999999999999999999"], "--max-sweeps: 99999999999999999999"),
    usage(["solve", "good.json", "--max-sweeps", "1", "--method", "value-iteration"], "certified", 3),
    usage(["solve", "good.json", "--graph", "no/such/folder/g.dot"], "no/such/folder/g.dot"),
    usage(["solve", "good.json", "--graph", "good.json"], "--force"),
    usage(["attack", "good.json", "--agent", "belief"], "--agent: belief, expected one of"),
    usage(["attack", "good.json", "--agent", "policy"], "--policy LIST"),
    usage(["attack", "good.json", "--metric", "discrete", "--policy", "0"], "--policy: 1 actions, expected 2"),
    usage(["attack", "good.json", "--metric", "discrete", "--policy", "0,1"], "--policy: 1 is no action, expected 0 to 0"),
    usage(["attack", "good.json", "--metric", "discrete", "--policy-file", "none.txt"], "none.txt"),
    usage(["attack", "good.json", "--metric", "discrete", "--policy-file", "good.json"], "$.policy"),
    usage(["belief", "good.json", "--metric", "discrete", "--start", "7"], "--start: 7 is no state, expected 0 to 1"),
    usage(["belief", "good.json", "--attack", "strong"], "--attack: strong"),
    usage(["belief", "--steps", "0"], "--steps: 0"),
    usage(["belief", "--seed", "-1"], "--seed: -1"),
    usage(["belief", "--attack", "optimal", "--max-positions", "3"], "belief game", 3),
    usage(["simulate", "good.json", "--episodes", "0"], "--episodes: 0"),
    usage(["simulate", "good.json", "--metric", "discrete", "--start", "x"], "--start: x is no state"),
    usage(["learn", "good.json", "--exploration", "1.5"], "--exploration: 1.5"),
    usage(["learn", "good.json", "--step-exponent", "0"], "--step-exponent: 0, expected a finite number > 0 and <= 1"),
    usage(["convert", "good.json", "-o", "good.json"], "good.json: exists"),
    usage(["convert", "good.json", "-o", "."], "is a folder"),
    usage(["info", "--json"], "no model given"),
    usage(["examples", "extra"], "extra: unexpected argument"),
    usage(["counterexample"], "no command given, expected one of list, show, run, draw, search"),
    usage(["counterexample", "lost"], "lost: no such command, did you mean list?"),
    usage(["counterexample", "list", "settling"], "settling: unexpected argument"),
    usage(["counterexample", "show"], "NAME"),
    usage(["counterexample", "show", "setling"], "did you mean settling?"),
    usage(["counterexample", "show", "settling", "--model", "--json"], "--model"),
    usage(["counterexample", "run"], "expected NAME or --all"),
    usage(["counterexample", "run", "settling", "--all"], "given beside --all"),
    usage(["counterexample", "draw", "settling", "--dot", "-o", "good.json"], "good.json: exists"),
    usage(["counterexample", "search", "settling"], "expected stationary-optimum or sharper-belief"),
    usage(["counterexample", "search", "sharper-belief", "--seconds", "0"], "--seconds: 0, expected a finite number > 0"),
    usage(["counterexample", "search", "sharper-belief", "--seconds", "0.01"], "allow more --seconds", 3),
    usage(["counterexample", "search", "sharper-belief", "--seed", "-1"], "--seed: -1"),
    # input
    usage(["solve", "missing.json"], "missing.json"),
    usage(["solve", "."], "."),
    bad("", "bad.json"),
    bad("{", "bad.json"),
    bad(b"\xff\xfe\x00\x01", "bad.json"),
    bad("[1,2,3]", "bad.json"),
    bad(model()[:-20], "bad.json"),
    bad(model(discount=1), "discount"),
    bad(model(discount=-0.5), "discount"),
    bad(model().replace("0.5", "NaN"), "bad.json"),
    bad(model(states=10**18), "states"),
    bad(model(states=0), "states"),
    bad(model(actions=10**18), "actions"),
    bad(model(transitions=[[0, 0, 1, 0.5], [1, 0, 1, 1]]), "sum to"),
    bad(model(transitions=[[0, 0, 1, -1], [0, 0, 0, 2], [1, 0, 1, 1]]), "transitions"),
    bad(model(transitions=[[0, 0, 1, 1], [0, 0, 1, 1], [1, 0, 1, 1]]), "transitions"),
    bad(model(transitions=[[0, 0, 1, 1]]), "transition"),
    bad(model(transitions=[[0, 0, 5, 1], [1, 0, 1, 1]]), "transitions"),
    bad(model(rewards=[[0]]), "rewards"),
    bad(model(neighbourhoods=[[0], []]), "neighbourhoods", more=["--robust"]),
    bad(model(neighbourhoods=[[0, 1], [1]]), "neighbourhoods", more=["--robust"]),
    bad(model(points=[[0]], eps=1), "points"),
    bad(model(points=[[0], [1]]), "eps", more=["--robust"]),
    bad(model(points=[[0], [1]], eps=-1), "eps", more=["--robust"]),
]


def check_output_failures(program):
    """Standard output that cannot be written is an error; a reader that has had enough is none of ours."""
    problems = []
    with open("/dev/full", "wb") as full:
        result = subprocess.run([program, "examples"], stdout=full, stderr=subprocess.PIPE)
    if result.returncode != 74 or result.stderr.count(b"\n") != 1:
        problems.append("full standard output: exit code %d, %r" % (result.returncode, result.stderr))
    closed = subprocess.run(["sh", "-c", '"$0" examples >&-', program], stderr=subprocess.PIPE)
    if closed.returncode != 74 or closed.stderr.count(b"\n") != 1:
        problems.append("closed standard output: exit code %d, %r" % (closed.returncode, closed.stderr))
    read, write = os.pipe()
    os.close(read)
    gone = subprocess.run([program, "examples"], stdout=write, stderr=subprocess.PIPE)
    os.close(write)
    if gone.returncode != -signal.SIGPIPE or gone.stderr:
        problems.append("reader gone: exit code %d, %r" % (gone.returncode, gone.stderr))
    return problems


def check_convert(program):
    """convert writes whole files, replaces them only when told, and its output is a fixed point."""
    problems = []
    with tempfile.TemporaryDirectory() as folder:
        target = os.path.join(folder, "out.json")
        first = run(program, ["convert", "slippery_grid.json", "-o", target])
        if first.returncode != 0 or first.stdout:
            problems.append("convert -o: exit code %d, %r" % (first.returncode, first.stdout))
        with open(target, "rb") as f:
            written = f.read()
        again = run(program, ["convert", target])
        if again.stdout != written:
            problems.append("converting the converted file changes it")
        if run(program, ["convert", "cycling.json", "-o", target]).returncode != 2 or open(target, "rb").read() != written:
            problems.append("an existing file was replaced without --force")
        if run(program, ["convert", "cycling.json", "-o", target, "--force"]).returncode != 0:
            problems.append("--force did not replace the file")
        if open(target, "rb").read() != run(program, ["convert", "cycling.json"]).stdout:
            problems.append("--force left something else than the new file")
        if os.listdir(folder) != ["out.json"]:
            problems.append("left behind: %s" % os.listdir(folder))
        # A file cannot outgrow the limit: the write fails halfway, and nothing may be seen of it.
        halfway = os.path.join(folder, "halfway.json")
        limited = run("/bin/sh", ["-c", 'ulimit -f 1; trap "" XFSZ; exec "$0" convert slippery_grid.json -o "$1"', program, halfway])
        if limited.returncode != 2 or os.path.exists(halfway) or os.listdir(folder) != ["out.json"]:
            problems.append("half-written file: exit code %d, left %s" % (limited.returncode, os.listdir(folder)))
    return problems


def check_policy_file(program):
    """The JSON of solve is a policy file for attack, and means the same as the list."""
    with tempfile.TemporaryDirectory() as folder:
        solved = os.path.join(folder, "solved.json")
        out = run(program, ["solve", "slippery_grid.json", "--json"]).stdout
        with open(solved, "wb") as f:
            f.write(out)
        policy = json.loads(out)["policy"]
        by_file = run(program, ["attack", "slippery_grid.json", "--policy-file", solved, "--json"]).stdout
        by_list = run(program, ["attack", "slippery_grid.json", "--policy", ",".join(map(str, policy)), "--json"]).stdout
        greedy = json.loads(run(program, ["attack", "slippery_grid.json", "--agent", "greedy", "--json"]).stdout)
        if by_file != by_list or not by_file:
            return ["--policy-file and --policy differ"]
        return [] if json.loads(by_file)["attacks"] == greedy["attacks"] else ["the solved policy is not the greedy agent"]


def check_numerals(program):
    """Where actions are called by numerals, whole numbers are indices and strings are names."""
    found = {}
    with tempfile.TemporaryDirectory() as folder:
        case = numerals([], "")
        for name, text in {**case.files, "indices.json": '{"policy": [0, 1]}', "names.json": '["1", "0"]'}.items():
            with open(os.path.join(folder, name), "w") as f:
                f.write(text)
        for name in ("indices.json", "names.json"):
            out = run(program, ["attack", "named.json", "--policy-file", name, "--json"], cwd=folder).stdout
            found[name] = json.loads(out)["policy"] if out else None
    return [] if found == {"indices.json": [0, 1], "names.json": [0, 1]} else ["read as %s, expected [0, 1]" % found]


def check_largest_seed(program):
    """Every 64-bit seed is one, and another one than its neighbour."""
    last, before = (run(program, ["belief", "--attack", "random", "--json", "--seed", str(2**64 - k)]) for k in (1, 2))
    if last.returncode != 0 or json.loads(last.stdout)["seed"] != 2**64 - 1:
        return ["exit code %d, %r" % (last.returncode, last.stderr)]
    return [] if json.loads(last.stdout)["steps"] != json.loads(before.stdout)["steps"] else ["two seeds, one walk"]


def check_recurring(program):
    """The pairs that recur are as many as the period, and each is one of those met."""
    problems = []
    for example in ("cycling", "one-sided"):
        result = run(program, ["solve", "--example", example, "--robust", "--json"])
        found = json.loads(result.stdout)["robust"]["iteration"]
        recurring = found["recurring"]
        if len(recurring) != found["period"] or not set(recurring) <= set(range(len(found["pairs"]))):
            problems.append("%s: %s recur of %d pairs, period %d" % (example, recurring, len(found["pairs"]), found["period"]))
    short = run(program, ["solve", "--example", "cycling", "--robust", "--json", "--max-iterations", "1"])
    if json.loads(short.stdout)["robust"]["iteration"]["recurring"] is not None:
        problems.append("pairs recur although the fate is undetermined")
    return problems


def check_graph(program):
    with tempfile.TemporaryDirectory() as folder:
        target = os.path.join(folder, "g.dot")
        result = run(program, ["solve", "slippery_grid.json", "--graph", target, "--json"])
        text = open(target).read() if os.path.exists(target) else ""
        ok = result.returncode == 0 and text.startswith("digraph") and "(2,1)" in text and json.loads(result.stdout)
        return [] if ok else ["no drawing: exit code %d, %r" % (result.returncode, text[:100])]


def check_counterexample_model(program):
    """The model that show writes is one that the other commands read, and search finds again."""
    with tempfile.TemporaryDirectory() as folder:
        target = os.path.join(folder, "m.json")
        with open(target, "wb") as f:
            f.write(run(program, ["counterexample", "show", "stationary-optimum", "--model"]).stdout)
        solved = run(program, ["solve", target, "--robust", "--json"])
        shown = json.load(open(target))
    found = json.loads(run(program, ["counterexample", "search", "stationary-optimum", "--model"]).stdout)
    same = all(found[key] == shown[key] for key in ("rewards", "transitions", "discount"))
    return [] if solved.returncode == 0 and json.loads(solved.stdout)["v"] == [2, 0] and same else ["not the same model"]


def check_counterexample_search(program):
    """A seed finds the same model twice, and its check refutes the claim."""
    first, second = (run(program, ["counterexample", "search", "sharper-belief", "--seed", "1"]) for _ in range(2))
    ok = first.returncode == 0 and first.stdout == second.stdout and b"sharper-belief: REFUTED" in first.stdout
    return [] if ok else ["exit code %d, %r" % (first.returncode, first.stdout)]


def check_drawing(program):
    """SVG where dot is installed; without it one line that says what to install, and nothing written."""
    problems = []
    with tempfile.TemporaryDirectory() as folder:
        target = os.path.join(folder, "g.svg")
        draw = ["counterexample", "draw", "settling", "-o", target]
        without = run(program, draw, env={**os.environ, "PATH": folder})
        if without.returncode != 2 or without.stderr.count(b"\n") != 1 or b"apt-get install graphviz" not in without.stderr:
            problems.append("without dot: exit code %d, %r" % (without.returncode, without.stderr))
        for name, script in (("fails", "exit 3"), ("writes", "cat > /dev/null; echo '<svg/>'")):
            other = os.path.join(folder, name)
            os.mkdir(other)
            with open(os.path.join(other, "dot"), "w") as f:
                f.write("#!/bin/sh\n%s\n" % script)
            os.chmod(os.path.join(other, "dot"), 0o755)
        failing = run(program, draw, env={**os.environ, "PATH": os.path.join(folder, "fails")})
        if failing.returncode != 2 or b"dot: failed" not in failing.stderr or os.path.exists(target):
            problems.append("dot fails: exit code %d, %r" % (failing.returncode, failing.stderr))
        drawn = run(program, draw, env={**os.environ, "PATH": os.path.join(folder, "writes") + ":" + os.environ["PATH"]})
        if drawn.returncode != 0 or open(target).read() != "<svg/>\n":
            problems.append("dot draws: exit code %d, %r" % (drawn.returncode, drawn.stderr))
    if shutil.which("dot"):
        svg = run(program, ["counterexample", "draw", "settling"]).stdout
        if b"</svg>" not in svg or b"V* = 20" not in svg:
            problems.append("no SVG: %r" % svg[:200])
    return problems


def check_interrupt(program):
    """SIGINT ends the learning with what is learned so far, as valid JSON."""
    arguments = [program, "learn", "--example", "grid", "--episodes", "100000000", "--json"]
    process = subprocess.Popen(arguments, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
    try:
        process.wait(timeout=2)
        return ["ended by itself with %d" % process.returncode]
    except subprocess.TimeoutExpired:
        process.send_signal(signal.SIGINT)
    out, err = process.communicate(timeout=120)
    result = json.loads(out, parse_constant=no_constants)
    ok = process.returncode == 130 and result["interrupted"] and result["episodes"] > 0
    return [] if ok else ["exit code %d, %r" % (process.returncode, err)]


def check_shared_model(program, path):
    """Every real model file is read, described and solved."""
    problems = []
    more = ["--discount", "0.9", "--intervals", "nominal"]
    for command in (["info"], ["solve"]):
        result = run(program, command + [path, "--json"] + more)
        if result.returncode != 0:
            problems.append("%s: exit code %d, %r" % (command[0], result.returncode, result.stderr))
        elif not json.loads(result.stdout, parse_constant=no_constants):
            problems.append("%s: nothing printed" % command[0])
    return problems


CHECKS = [check_output_failures, check_convert, check_policy_file, check_numerals, check_largest_seed, check_recurring,
          check_graph, check_counterexample_model, check_counterexample_search, check_drawing, check_interrupt]


if __name__ == "__main__":
    main(GOLDEN, REFUSALS, CHECKS, check_shared_model)
