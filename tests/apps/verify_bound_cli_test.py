"""What verify_bound prints, refuses, writes, resumes and survives."""

import glob
import json
import os
import pty
import re
import select
import signal
import subprocess
import tempfile
import time

from cli import Golden, Refusal, main, model, no_constants, run

GOLDEN = [
    Golden("verify_bound_help.txt", ["--help"]),
    Golden("verify_bound_version.txt", ["--version"]),
    Golden("verify_bound_one_sided.json", ["--model", "one_sided.json", "--json"]),
    Golden("verify_bound_one_sided_paper.json", ["--model", "one_sided.json", "--reading", "paper", "--json"], code=1),
    Golden("verify_bound_one_sided_paper.txt", ["--model", "one_sided.json", "--reading", "paper"], code=1),
    Golden("verify_bound_cycling.txt", ["--example", "cycling"]),
    Golden("verify_bound_named.txt", ["slippery_grid.json"]),
    Golden("verify_bound_tight_e.txt", ["tight_e.json", "--exact", "--claims", "E"]),
    Golden("verify_bound_explain.txt", ["--explain"]),
    *[Golden("verify_bound_help_%s.txt" % c, [c, "--help"]) for c in ("certify", "check", "falsify")],
]

# Options of the one kind of run that would be ignored in the other.
IGNORED = [
    *[Refusal([*given, "--trials", "1"], 2, "%s: has no effect on random models" % given[0])
      for given in (["--metric", "hops"], ["--discount", "0.5"], ["--reward-model", "r"], ["--intervals", "nominal"])],
    Refusal(["--discount", "0.5", "--replay", "1"], 2, "expected --gamma"),
    *[Refusal(["--example", "one-sided", *given], 2, "%s: has no effect beside --example" % given[0])
      for given in (["--trials", "5"], ["--seed", "1"], ["--threads", "1"], ["--states", "3"], ["--actions", "2"],
                    ["--gamma", "0.5"], ["--l-r", "1"], ["--l-p", "1"], ["--dimension", "1"], ["--successors", "1"],
                    ["--family", "broad"], ["--save-model", "m.json"], ["--trials-out", "t.jsonl"], ["--resume"],
                    ["--violation-dir", "."])],
    Refusal(["--model", "m.json", "--seed", "1"], 2, "--seed: has no effect beside --model", {"m.json": model()}),
]

REFUSALS = [
    *IGNORED,
    *[Refusal([option, "", "--trials", "1"], 2, "%s: empty, expected a value" % option)
      for option in ("--model", "--example", "--trials-out", "--report", "--save-model", "--states", "--gamma", "--claims")],
    Refusal(["--violation-dir", "", "--trials", "1"], 2, "--violation-dir: "),
    *[Refusal(["--trials", "1", "--seed", seed], 2, "--seed: %s, expected a whole number" % seed)
      for seed in ("010", "0x10", "+1", "-1", "1e3", "18446744073709551616")],
    Refusal(["--trials", "010"], 2, "--trials: 010, expected a whole number without leading zeros"),
    Refusal(["--trials", "1", "--trials", "2"], 2, "--trials: given more than once, expected once"),
    Refusal(["--bogus"], 2, "--bogus"),
    Refusal(["--trials", "0"], 2, "--trials"),
    Refusal(["--trials", "1e3"], 2, "--trials"),
    Refusal(["--reading", "printed"], 2, "paper"),
    Refusal(["--claims", "theorem-2"], 2, "theorem-1"),
    Refusal(["--family", "smooth"], 2, "informative"),
    Refusal(["--states", "9:3"], 2, "LOW:HIGH"),
    Refusal(["--states", "many"], 2, "LOW:HIGH"),
    Refusal(["--gamma", "0.5:1"], 2, "--gamma"),
    Refusal(["--gamma", "nan"], 2, "--gamma"),
    Refusal(["--eps", "-1"], 2, "--eps"),
    *[Refusal(["--eps", eps], 2, "--eps: %s, expected a finite number >= 0 or a fraction such as 1/3" % eps)
      for eps in ("1/0", "1/3/5", "0.5/2", "nan", "1e999")],
    Refusal(["--example", "grid", "--discount", "3/3"], 2, "--discount: 3/3, expected a finite number >= 0 and < 1"),
    Refusal(["--resume"], 2, "--trials-out"),
    Refusal(["--save-model", "m.json"], 2, "--replay"),
    *[Refusal(["--replay", "1", *given], 2, "%s: has no effect beside --replay" % given[0])
      for given in (["--trials-out", "t.jsonl"], ["--trials", "5"], ["--threads", "1"], ["--resume"], ["--violation-dir", "."])],
    Refusal(["m.json"], 2, "m.json: $.epsilon: unknown name, expected 'eps'?", {"m.json": model(epsilon=1)}),
    Refusal(["certify", "--example", "cycling"], 2, "--output"),
    Refusal(["certify", "--example", "cycling", "-o", "there.json"], 2, "there.json exists", {"there.json": "kept"}),
    Refusal(["certify", "--example", "cycling", "-o", "-", "--json"], 2, "--json: standard output takes the certificate"),
    Refusal(["certify", "m.json", "-o", "c.json"], 4, "Assumption 1", {"m.json": model(points=[[0], [0]], norm="l1", eps=1)}),
    *[Refusal([*given, *command], 2, "%s: has no effect before %s" % (given[0], command[0]))
      for given, command in ((["--reading", "paper"], ["certify", "--example", "one-sided", "-o", "z.json"]),
                             (["--json"], ["check", "m.json"]), (["--seed", "3"], ["falsify", "--seconds", "1"]))],
    Refusal(["check", "absent.json"], 2, "absent.json: cannot be read"),
    Refusal(["check", "bad.json"], 2, "bad.json: $", {"bad.json": "{"}),
    Refusal(["check"], 2, "CERTIFICATE"),
    Refusal(["falsify", "--goal", "theorem-2"], 2, "--goal: 'theorem-2' is unknown"),
    Refusal(["falsify", "--resume"], 2, "--trials-out"),
    Refusal(["falsify", "--states", "9:3"], 2, "LOW:HIGH"),
    Refusal(["--arith", "decimal"], 2, "exact"),
    *[Refusal([*given, "--trials", "1"], 2, "--exact: given beside --arith double, expected one of the two")
      for given in (["--exact", "--arith", "double"], ["--arith", "double", "--exact"])],
    Refusal(["m.json", "--model", "m.json"], 2, "given more than once", {"m.json": model()}),
    Refusal(["--trials", "1", "--trials-out", "no-such-folder/t.jsonl"], 2, "no-such-folder/t.jsonl"),
    Refusal(["--trials", "1", "--violation-dir", "no-such-folder"], 2,
            "--violation-dir: no-such-folder: no such folder, expected one that exists"),
    Refusal(["--model", "absent.json"], 2, "absent.json"),
    Refusal(["--model", "m.json", "--replay", "1"], 2, "--replay", {"m.json": model()}),
    Refusal(["--model", "m.json", "--example", "grid"], 2, "--example", {"m.json": model()}),
    Refusal(["--model", "m.json"], 2, "m.json", {"m.json": model(discount=1)}),
    Refusal(["--model", "m.json", "--norm", "l1"], 2, "norm", {"m.json": model()}),
    Refusal(["--trials", "2", "--trials-out", "other.jsonl", "--resume"], 2, "other.jsonl:1", {"other.jsonl": "{}\n"}),
    Refusal(["--trials", "2", "--trials-out", "torn.jsonl", "--resume"], 2, "torn.jsonl:1", {"torn.jsonl": "not JSON\n"}),
    Refusal(["--trials", "2", "--trials-out", "old.jsonl"], 2, "--resume", {"old.jsonl": "kept"}),
]

TRIALS = "120"


def campaign(program, folder, *more):
    return run(program, ["--trials", TRIALS, "--quiet", *more], cwd=folder)


def read(folder, name):
    with open(os.path.join(folder, name), "rb") as f:
        return f.read()


def check_default_family(program):
    """Informative bounds, cycles, no violation; one JSON object on standard output, nothing on standard error."""
    with tempfile.TemporaryDirectory() as folder:
        result = run(program, ["--trials", "400", "--json"], cwd=folder)
        summary = json.loads(result.stdout, parse_constant=no_constants)["summary"]
        theorem = next(c for c in summary["claims"] if c["name"] == "theorem-1")
        problems = []
        if result.returncode != 0 or result.stderr:
            problems.append("exit code %d, %r" % (result.returncode, result.stderr))
        if summary["violations"] != 0 or summary["fates"]["cycles"] == 0 or theorem["informative"] * 3 < 400:
            problems.append("not what the default campaign promises: %s" % summary)
        return problems


def check_threads(program):
    """The same bytes on 1, 2 and 4 threads."""
    with tempfile.TemporaryDirectory() as folder:
        out = {}
        for threads in ("1", "2", "4"):
            name = "t%s.jsonl" % threads
            out[threads] = campaign(program, folder, "--threads", threads, "--trials-out", name, "--json").stdout
            out[threads] += read(folder, name)
        return [] if out["1"] == out["2"] == out["4"] and out["1"] else ["the bytes depend on the threads"]


def whole_run(program, folder):
    out = campaign(program, folder, "--trials-out", "whole.jsonl", "--json").stdout
    return out, read(folder, "whole.jsonl")


def check_resume(program):
    """A file cut anywhere is completed to the same bytes, and so is the summary."""
    with tempfile.TemporaryDirectory() as folder:
        out, whole = whole_run(program, folder)
        problems = []
        for keep in (0, 1, len(whole) // 3, len(whole) // 2 + 7, len(whole) - 1, len(whole)):
            with open(os.path.join(folder, "cut.jsonl"), "wb") as f:
                f.write(whole[:keep])
            resumed = campaign(program, folder, "--trials-out", "cut.jsonl", "--resume", "--json")
            if resumed.stdout != out or read(folder, "cut.jsonl") != whole:
                problems.append("cut to %d of %d bytes: differs, %r" % (keep, len(whole), resumed.stderr))
        return problems


def check_kill(program, how, code):
    """A run that is stopped leaves only whole lines, or a last one cut short; resumed, it ends as if never stopped."""
    with tempfile.TemporaryDirectory() as folder:
        arguments = ["--trials", "1000", "--family", "broad", "--quiet", "--json", "--threads", "2"]
        path = os.path.join(folder, "killed.jsonl")
        process = subprocess.Popen([program, *arguments, "--trials-out", path], cwd=folder, stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE)
        deadline = time.time() + 60
        while (not os.path.exists(path) or os.path.getsize(path) < 20000) and time.time() < deadline:
            time.sleep(0.01)
        process.send_signal(how)
        out, _ = process.communicate(timeout=120)
        if process.returncode != code:
            return ["exit code %d, expected %d" % (process.returncode, code)]
        if how == signal.SIGINT and json.loads(out, parse_constant=no_constants)["complete"]:
            return ["an interrupted run calls itself complete"]
        before = read(folder, "killed.jsonl")
        finished = before[: before.rfind(b"\n") + 1]
        resumed = run(program, [*arguments, "--trials-out", path, "--resume"], cwd=folder)
        fresh = run(program, [*arguments, "--trials-out", "fresh.jsonl"], cwd=folder)
        after = read(folder, "killed.jsonl")
        ok = after.startswith(finished) and after == read(folder, "fresh.jsonl") and resumed.stdout == fresh.stdout
        return [] if ok and finished.count(b"\n") > 2 else ["the resumed run differs from one that was not stopped"]


def check_violation(program):
    """Theorem 1 as printed fails on costs; the violating model is shrunk, written, and violates again when read."""
    with tempfile.TemporaryDirectory() as folder:
        result = run(program, ["--family", "costs", "--reading", "paper", "--trials", "60", "--claims", "theorem-1",
                               "--quiet"], cwd=folder)
        files = glob.glob(os.path.join(folder, "violation-*-theorem-1.json"))
        if result.returncode != 1 or len(files) != 1:
            return ["exit code %d and files %s, expected 1 and one file" % (result.returncode, files)]
        with open(files[0]) as f:
            states = json.load(f)["states"]
        again = run(program, ["--model", files[0], "--reading", "paper", "--claims", "theorem-1"])
        corrected = run(program, ["--model", files[0]])
        ok = states <= 4 and again.returncode == 1 and corrected.returncode == 0
        return [] if ok else ["%d states, exit codes %d and %d" % (states, again.returncode, corrected.returncode)]


def check_violations_kept(program):
    """Another campaign with the same seed does not overwrite what the first found; the same one adds nothing."""
    with tempfile.TemporaryDirectory() as folder:
        def found(*more):
            run(program, ["--family", "costs", "--reading", "paper", "--trials", "60", "--claims", "theorem-1", "--quiet",
                          *more], cwd=folder)
            return {f: read(folder, f) for f in sorted(os.listdir(folder))}
        first, again, other = found(), found(), found("--gamma", "0.4")
        problems = []
        if len(first) != 1 or again != first:
            problems.append("files %s, then %s, expected the same one" % (list(first), list(again)))
        if not other.items() > first.items():
            problems.append("files %s, expected one more than %s" % (list(other), list(first)))
        return problems


def check_replay_hint(program):
    """The command that the verdict names shows the violation again."""
    with tempfile.TemporaryDirectory() as folder:
        result = run(program, ["--family", "costs", "--reading", "paper", "--trials", "60", "--claims", "theorem-1",
                               "--gamma", "0.3:0.6", "--max-period", "32", "--quiet"], cwd=folder)
        hint = re.search(r"the first: verify_bound (.*)\n", result.stdout.decode())
        if not hint:
            return ["no hint in %r" % result.stdout]
        again = run(program, hint.group(1).split() + ["--claims", "theorem-1"], cwd=folder)
        return [] if again.returncode == 1 else ["%r: exit code %d" % (hint.group(1), again.returncode)]


def check_explain(program):
    """Each name that --claims takes is explained."""
    text = run(program, ["--explain"]).stdout.decode()
    names = "lemma-1 lemma-1-iterates lemma-2 lemma-3 theorem-1 A B C D E F".split()
    return ["%s is not explained" % n for n in names if not re.search(r"^%s: " % n, text, re.M)]


def check_theory_page(program):
    """docs/theory.md names every claim as the program does, and theorems as Coq does; its prose is wrapped."""
    root = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
    with open(os.path.join(root, "docs", "theory.md")) as f:
        page = f.read()
    coq = "".join(open(file).read() for file in glob.glob(os.path.join(root, "proofs_check", "coq", "*.v")))
    names = re.findall(r"^(\S+): ", run(program, ["--explain"]).stdout.decode(), re.M)
    problems = ["%s is not on the page" % n for n in names if "`%s`" % n not in page]
    theorems = re.findall(r"`([a-z]\w*_\w+)`", page)
    problems += ["%s is not in Coq" % t for t in theorems if not re.search(r"\b(Theorem|Lemma|Example) %s\b" % t, coq)
                 and t not in ("non_contraction", "verify_bound")]
    lines = page.split("\n")
    prose = [line for line in lines if not line.startswith(("    ", "|"))]
    return problems + ["longer than 120: %s" % line for line in prose if len(line) > 120] + ([] if names and theorems else ["no names"])


def check_replay(program):
    """A trial by itself gives the record of the campaign; its model, saved, gives the same verdict."""
    with tempfile.TemporaryDirectory() as folder:
        campaign(program, folder, "--trials-out", "t.jsonl")
        line = json.loads(read(folder, "t.jsonl").split(b"\n")[1 + 17])
        one = run(program, ["--replay", "17", "--json", "--save-model", "m.json"], cwd=folder)
        saved = run(program, ["--model", "m.json", "--json"], cwd=folder)
        problems = []
        if json.loads(one.stdout)["record"] != line:
            problems.append("the replayed record differs from the campaign's")
        if json.loads(saved.stdout)["record"]["claims"] != line["claims"]:
            problems.append("the saved model gives another verdict")
        return problems


def check_vacuous(program):
    """A campaign whose bounds all say nothing does not say that anything holds."""
    result = run(program, ["--trials", "30", "--family", "cycling", "--claims", "theorem-1", "--quiet"])
    says = b"UNDETERMINED" in result.stdout and b"vacuous" in result.stdout
    return [] if result.returncode == 3 and says else ["exit code %d, %r" % (result.returncode, result.stdout)]


def check_assumption(program):
    """Two states at one point that differ: no Lipschitz constant exists, and the verdict names the assumption."""
    with tempfile.TemporaryDirectory() as folder:
        with open(os.path.join(folder, "m.json"), "w") as f:
            f.write(model(points=[[0], [0]], norm="l1", eps=1))
        result = run(program, ["--model", "m.json"], cwd=folder)
        ok = result.returncode == 4 and b"Assumption 1" in result.stdout
        return [] if ok else ["exit code %d, %r" % (result.returncode, result.stdout)]


def check_terminal(program):
    """What a file is called does not drive the terminal that the verdict is printed on."""
    with tempfile.TemporaryDirectory() as folder:
        name = "e\x1b[31m.json"
        with open(os.path.join(folder, name), "w") as f:
            f.write(model(points=[[0], [1]], norm="l1", eps=1))
        result = run(program, ["--model", name], cwd=folder)
        ok = result.returncode in (0, 3) and b"\x1b" not in result.stdout + result.stderr and b"e?[31m.json" in result.stdout
        return [] if ok else ["exit code %d, %r" % (result.returncode, result.stdout)]


def check_report(program):
    with tempfile.TemporaryDirectory() as folder:
        campaign(program, folder, "--report", "r.html")
        page = read(folder, "r.html").decode()
        ok = page.startswith("<!DOCTYPE html>") and page.rstrip().endswith("</html>") and "<svg" in page
        return [] if ok and "http://" not in page.replace("http://www.w3.org/", "") else ["not a self-contained page"]


def check_shared_model(program, path):
    """Every real model is verified: each claim holds or a budget ran out, and none is violated."""
    result = run(program, ["--model", path, "--discount", "0.9", "--intervals", "nominal", "--json"])
    if result.returncode not in (0, 3):
        return ["exit code %d, %r" % (result.returncode, result.stderr)]
    claims = json.loads(result.stdout, parse_constant=no_constants)["record"]["claims"]
    undetermined = [n for n, c in claims.items() if c["verdict"] != "holds"]
    return [] if set(undetermined) <= {"F"} else ["undetermined: %s" % undetermined]


def check_sigkill(program):
    return check_kill(program, signal.SIGKILL, -signal.SIGKILL)


def check_sigint(program):
    return check_kill(program, signal.SIGINT, 3)


def certified(program, folder, *arguments):
    """The exit codes of certify and of check, and the certificate."""
    made = run(program, ["certify", *arguments, "-o", "c.json", "--force"], cwd=folder)
    verified = run(program, ["check", "c.json"], cwd=folder)
    with open(os.path.join(folder, "c.json")) as f:
        return made.returncode, verified.returncode, json.load(f)


def check_certify(program):
    """What certify proves, check verifies: a theorem that holds, one that is refuted, a cycle."""
    problems = []
    with tempfile.TemporaryDirectory() as folder:
        for arguments, code, period in ((["--example", "one-sided"], 0, 1), (["--example", "one-sided", "--reading", "paper"], 1, 1),
                                        (["--example", "cycling"], 0, 3), (["--example", "chain"], 0, None)):
            made, verified, certificate = certified(program, folder, *arguments)
            if (made, verified) != (code, code) or period not in (None, certificate["limit"]["period"]):
                problems.append("%s: exit codes %d and %d" % (arguments, made, verified))
    return problems


def check_certify_by_bounds(program):
    """By bounds what holds is proved, what is false stays open, lemma-3 is left out; campaigns and models take it too."""
    problems = []
    with tempfile.TemporaryDirectory() as folder:
        for arguments, code in ((["--example", "garnet"], 0), (["--example", "grid", "--tie", "highest"], 0),
                                (["--example", "one-sided", "--reading", "paper"], 3)):
            made, verified, certificate = certified(program, folder, "--arith", "certified", *arguments)
            names = [c["claim"] for c in certificate["claims"]]
            if (made, verified) != (code, code) or certificate["format"] != "maximin-bounds" or "lemma-3" in names:
                problems.append("%s: exit codes %d and %d, %s" % (arguments, made, verified, names))
        campaign = run(program, ["--arith", "certified", "--trials", "30", "--states", "3:12", "--certificates", "."], cwd=folder)
        if campaign.returncode != 0 or b"proved in exact arithmetic, for each model" not in campaign.stdout:
            problems.append("campaign: exit code %d, %r" % (campaign.returncode, campaign.stdout[-300:]))
        trials = ["trial-%d.json" % k for k in range(30)]
        if run(program, ["check", *trials], cwd=folder).returncode not in (0, 3):
            problems.append("a certificate of the campaign is refused")
        one = run(program, ["--example", "garnet", "--arith", "certified"], cwd=folder)
        if one.returncode != 0 or b"enclosed from n" not in one.stdout or b"proved in exact arithmetic" not in one.stdout:
            problems.append("one model: exit code %d, %r" % (one.returncode, one.stdout[-300:]))
    return problems


def check_tampered(program):
    """A certificate with a digit changed is refused in one line with the place, and so is what is no certificate."""
    problems = []
    with tempfile.TemporaryDirectory() as folder:
        certificate = certified(program, folder, "--example", "one-sided", "--reading", "paper")[2]
        for change in (lambda c: c["claims"][4].update(right="7"), lambda c: c["optimal"].__setitem__(0, "1"),
                       lambda c: c["claims"][4].update(verdict="holds"), lambda c: c.pop("limit")):
            changed = json.loads(json.dumps(certificate))
            change(changed)
            with open(os.path.join(folder, "t.json"), "w") as f:
                json.dump(changed, f)
            result = run(program, ["check", "t.json"], cwd=folder)
            if result.returncode != 2 or result.stdout or result.stderr.count(b"\n") != 1 or b"t.json: $" not in result.stderr:
                problems.append("exit code %d, %r" % (result.returncode, result.stderr))
    return problems


def check_exact_campaign(program):
    """Every verdict proved, the same bytes on any thread count, and the same claims as in floating point."""
    with tempfile.TemporaryDirectory() as folder:
        arguments = ["--exact", "--trials", "30", "--states", "3:12", "--json", "--quiet"]
        one = run(program, [*arguments, "--threads", "1", "--trials-out", "1.jsonl"], cwd=folder)
        two = run(program, [*arguments, "--threads", "2", "--trials-out", "2.jsonl"], cwd=folder)
        same = one.stdout == two.stdout and read(folder, "1.jsonl") == read(folder, "2.jsonl")
        summary = json.loads(one.stdout, parse_constant=no_constants)["summary"]
        ok = one.returncode == 0 and summary["violations"] == 0 and summary["undetermined"] == 0
        return [] if same and ok else ["exit code %d, same bytes %s, %s" % (one.returncode, same, summary)]


def check_falsify(program):
    """The printed theorem falls, a cycle is found and a sharper belief hurts, within seconds; models are written."""
    with tempfile.TemporaryDirectory() as folder:
        arguments = ["falsify", "--restarts", "60", "--steps", "150", "--seconds", "100", "--json", "--threads", "2"]
        printed = run(program, [*arguments, "--goal", "theorem-1", "--reading", "paper"], cwd=folder)
        others = run(program, [*arguments, "--goal", "settling,sharper-belief,E"], cwd=folder)
        found = {g["goal"]: g for out in (printed, others) for g in json.loads(out.stdout)["goals"]}
        problems = ["%s: %s" % (n, found[n]) for n in ("theorem-1", "settling", "sharper-belief") if not found[n]["hit"]]
        if any(found[n]["proved"] != "refuted, proved exactly" for n in ("theorem-1", "settling", "sharper-belief")):
            problems.append("not proved: %s" % found)
        if printed.returncode != 1 or others.returncode != 0 or found["E"]["hit"]:
            problems.append("exit codes %d and %d, %s" % (printed.returncode, others.returncode, found["E"]))
        again = run(program, [found["theorem-1"]["file"], "--reading", "paper", "--claims", "theorem-1"], cwd=folder)
        return problems if again.returncode == 1 else problems + ["the model does not violate Theorem 1 when read"]


def check_falsify_shares(program):
    """A goal takes over a better model of another one; the last lines are a verdict for each goal."""
    with tempfile.TemporaryDirectory() as folder:
        arguments = ["falsify", "--restarts", "1", "--states", "2:3", "--seed", "2", "--steps", "20", "--seconds", "100", "--quiet"]
        alone = {}
        for goal in ("theorem-1", "E"):
            out = run(program, [*arguments, "--goal", goal, "--json"], cwd=folder).stdout
            alone[goal] = json.loads(out)["goals"][0]
        both = json.loads(run(program, [*arguments, "--goal", "theorem-1,E", "--json"], cwd=folder).stdout)["goals"]
        text = run(program, [*arguments, "--goal", "theorem-1,E"], cwd=folder).stdout.decode()
        problems = [] if [g["found_for"] for g in both] == ["E", "E"] else ["nothing was taken over: %s" % both]
        for g in both:
            if g["score"] < alone[g["goal"]]["score"] or (g["found_for"] != g["goal"]) != (g["score"] > alone[g["goal"]]["score"]):
                problems.append("%s: %s, alone %s" % (g["goal"], g, alone[g["goal"]]))
        last = text.rstrip("\n").split("\n")[-2:]
        if [line.split(" ")[0] for line in last] != ["theorem-1", "E"] or any("not refuted in 1 restart;" not in line for line in last):
            problems.append("last lines %r" % last)
        return problems


def check_huge(program):
    """Numbers beyond floating point: certify and --exact agree, and floating point refuses them."""
    with tempfile.TemporaryDirectory() as folder:
        with open(os.path.join(folder, "huge.json"), "w") as f:
            f.write(model(rewards=[["0"], ["1e400"]], points=[[0], [1]], norm="l1", eps=1))
        made = run(program, ["certify", "huge.json", "-o", "c.json"], cwd=folder)
        exact = run(program, ["huge.json", "--exact"], cwd=folder)
        bounded = run(program, ["huge.json", "--arith", "certified"], cwd=folder)
        rounded = run(program, ["huge.json"], cwd=folder)
        ok = (made.returncode, exact.returncode, bounded.returncode, rounded.returncode) == (0, 0, 2, 2)
        says = b".00000e+400" in made.stdout and b"inf: beyond floating point" in exact.stdout
        return [] if ok and says else ["%r" % [made, exact, bounded, rounded]]


def check_notes_once(program):
    """A model read for exact work is read once: what is assumed of it is told once, by --exact as by certify."""
    with tempfile.TemporaryDirectory() as folder:
        with open(os.path.join(folder, "m.json"), "w") as f:
            f.write(model(notes=["told once"]))
        results = [run(program, a, cwd=folder) for a in (["m.json"], ["m.json", "--exact"], ["certify", "m.json", "-o", "c.json"])]
        problems = []
        for result in results:
            if result.stderr.count(b"told once") != 1 or result.stderr.count(b"says nothing of distances") != 1:
                problems.append("standard error %r" % result.stderr)
        return problems


def check_exact_legend(program):
    """An exact table says which instance it shows; one in floating point shows the largest ratio and says no such thing."""
    exact = run(program, ["--example", "cycling", "--exact"]).stdout
    floating = run(program, ["--example", "cycling"]).stdout
    says = b"least right - left" in exact and b"left is an upper bound for all rounds of one phase" in exact
    return [] if says and b"right - left" not in floating else ["%r" % exact]


def check_left_out(program):
    """Claims that a certificate says nothing of are named."""
    with tempfile.TemporaryDirectory() as folder:
        certified(program, folder, "--example", "one-sided", "--claims", "E,lemma-2")
        some = run(program, ["check", "c.json"], cwd=folder).stdout
        listed = json.loads(run(program, ["check", "c.json", "--json"], cwd=folder).stdout)["certificates"][0]["left_out"]
        certified(program, folder, "--example", "one-sided")
        every = run(program, ["check", "c.json"], cwd=folder).stdout
        line = b"not in this certificate: lemma-1, lemma-1-iterates, lemma-3, theorem-1, A, B, C, D, F\n"
        ok = line in some and len(listed) == 9 and b"not in this certificate" not in every
        return [] if ok else ["%r, %r, %r" % (some, listed, every)]


def check_goes_on(program):
    """A bad file does not keep the others from being checked, and the exit code is that of the worst."""
    problems = []
    with tempfile.TemporaryDirectory() as folder:
        certified(program, folder, "--example", "one-sided", "--reading", "paper")
        os.rename(os.path.join(folder, "c.json"), os.path.join(folder, "violated.json"))
        certified(program, folder, "--example", "one-sided")
        with open(os.path.join(folder, "bad.json"), "w") as f:
            f.write("{")
        for files, code in ((["bad.json", "violated.json", "c.json"], 2), (["c.json", "violated.json"], 1), (["c.json"], 0)):
            text = run(program, ["check", *files], cwd=folder)
            listed = json.loads(run(program, ["check", *files, "--json"], cwd=folder).stdout)["certificates"]
            codes = {"bad.json": 2, "violated.json": 1, "c.json": 0}
            if text.returncode != code or text.stdout.count(b"a valid certificate") != len(files) - ("bad.json" in files):
                problems.append("%s: exit code %d, %r" % (files, text.returncode, text.stdout))
            if text.stderr.count(b"\n") != ("bad.json" in files) or [c["exit_code"] for c in listed] != [codes[f] for f in files]:
                problems.append("%s: %r, %s" % (files, text.stderr, listed))
    return problems


def check_pipe(program):
    """certify -o - writes the certificate to standard output and nothing else; check - reads it from standard input."""
    with tempfile.TemporaryDirectory() as folder:
        certificate = certified(program, folder, "--example", "one-sided", "--reading", "paper")[2]
        piped = run(program, ["certify", "--example", "one-sided", "--reading", "paper", "-o", "-"], cwd=folder)
        checked = run(program, ["check", "-"], cwd=folder, input=piped.stdout)
        tampered = run(program, ["check", "-"], cwd=folder, input=piped.stdout.replace(b'"right":"6"', b'"right":"7"'))
        ok = json.loads(piped.stdout) == certificate and os.listdir(folder) == ["c.json"]
        empty = run(program, ["check", "-"], cwd=folder, input=b"")
        codes = [r.returncode for r in (piped, checked, tampered, empty)]
        return [] if ok and codes == [1, 1, 2, 2] else ["exit codes %s, %r, %r" % (codes, piped.stderr, tampered.stderr)]


def check_pedantic(program):
    """What holds in floating point alone is undetermined; what is proved or violated stays; trials files are the same."""
    problems = []
    with tempfile.TemporaryDirectory() as folder:
        def claims(out):
            return {c["verdict"] for c in json.loads(out)["record"]["claims"].values()}
        for arguments, code, verdicts in (
                ([], 3, {"undetermined"}), (["--exact"], 0, {"holds"}), (["--reading", "paper"], 1, {"undetermined", "violated"})):
            given = ["--example", "one-sided", "--pedantic", *arguments]
            text, listed = run(program, given, cwd=folder), run(program, [*given, "--json"], cwd=folder)
            if (text.returncode, listed.returncode) != (code, code) or claims(listed.stdout) != verdicts:
                problems.append("%s: exit codes %d, %d, %s" % (arguments, text.returncode, listed.returncode, claims(listed.stdout)))
            if (b"held within rounding, not certified" in text.stdout) != (code == 3):
                problems.append("%s: %r" % (arguments, text.stdout))
        for name, more, code in (("plain", [], 0), ("pedantic", ["--pedantic"], 3), ("exact", ["--pedantic", "--exact", "--states", "3:5"], 0)):
            result = campaign(program, folder, "--family", "informative", *more, "--trials-out", name + ".jsonl", "--report", "r.html")
            doubts = b"held within rounding, not certified"
            if result.returncode != code or (doubts in result.stdout) != (code == 3) or (doubts in read(folder, "r.html")) != (code == 3):
                problems.append("%s: exit code %d, %r" % (name, result.returncode, result.stdout))
        if read(folder, "plain.jsonl") != read(folder, "pedantic.jsonl"):
            problems.append("--pedantic changes the trials file")
    return problems


def check_fractions(program):
    """--eps 1/3 and --discount 1/3 are exact in exact work, and the nearest double in floating point."""
    problems = []
    with tempfile.TemporaryDirectory() as folder:
        with open(os.path.join(folder, "m.json"), "w") as f:
            f.write(model(points=[[0], ["1/3"]], norm="l1"))
        exact = ["m.json", "--eps", "1/3", "--discount", "1/3"]
        certificate = certified(program, folder, *exact)[2]["model"]
        if (certificate["eps"], certificate["discount"]) != ("1/3", "1/3"):
            problems.append("the certificate has eps %s, discount %s" % (certificate["eps"], certificate["discount"]))
        for eps, ball in (("1/3", 2), ("0.3333333333333333", 1)):
            found = json.loads(run(program, ["m.json", "--eps", eps, "--exact", "--json"], cwd=folder).stdout)["record"]
            if found["largest_ball"] != ball:
                problems.append("--eps %s --exact: largest ball %d" % (eps, found["largest_ball"]))
        rounded = json.loads(run(program, [*exact, "--json"], cwd=folder).stdout)["record"]
        if (rounded["eps"], rounded["discount"]) != (1 / 3, 1 / 3):
            problems.append("in floating point: %s" % rounded)
    return problems


def check_killed_certificates(program):
    """A kill leaves whole certificates and partial files, if any, named so; the resumed run removes these, and only these."""
    with tempfile.TemporaryDirectory() as folder:
        trials = 150
        arguments = ["--exact", "--trials", str(trials), "--states", "3:6", "--quiet", "--threads", "2", "--trials-out", "t.jsonl",
                     "--resume", "--certificates", "c"]
        os.mkdir(os.path.join(folder, "c"))
        process = subprocess.Popen([program, *arguments], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        deadline = time.time() + 60
        while len(os.listdir(os.path.join(folder, "c"))) < 20 and time.time() < deadline:
            time.sleep(0.001)
        process.kill()
        process.communicate(timeout=120)
        left = [f for f in os.listdir(os.path.join(folder, "c")) if not f.endswith(".json")]
        # Where the kill came between two files, one as it would have left.
        for name in ("trial-3.json.Ab3dEf.partial", "kept.partial"):
            with open(os.path.join(folder, "c", name), "w") as f:
                f.write("{")
        resumed = run(program, arguments, cwd=folder)
        problems = ["left %s" % f for f in left if not re.fullmatch(r"trial-\d+\.json\.\w{6}\.partial", f)]
        files = sorted(os.listdir(os.path.join(folder, "c")))
        if resumed.returncode not in (0, 3) or files != sorted(["kept.partial"] + ["trial-%d.json" % k for k in range(trials)]):
            problems.append("exit code %d, files %s, %r" % (resumed.returncode, files, resumed.stderr))
        checked = run(program, ["check", *(f for f in files if f.endswith(".json"))], cwd=os.path.join(folder, "c"))
        return problems if checked.returncode in (0, 3) else problems + ["check: %r" % checked.stderr[:300]]


def check_progress(program):
    """Exact work that takes long says on a terminal what it does and for how long, and nothing where there is none."""
    problems = []
    with tempfile.TemporaryDirectory() as folder:
        for command in (["certify", "--example", "gridworld", "-o", "c.json"], ["--example", "gridworld", "--exact"]):
            for quiet in ([], ["--quiet"]):
                terminal, stderr = pty.openpty()
                process = subprocess.Popen([program, *command, *quiet], cwd=folder, stdout=subprocess.DEVNULL, stderr=stderr,
                                           env={**os.environ, "TERM": "xterm"})
                os.close(stderr)
                shown, deadline = b"", time.time() + (3 if quiet else 30)
                while not re.search(rb"so far.*so far", shown, re.S) and time.time() < deadline:
                    if select.select([terminal], [], [], 0.1)[0]:
                        shown += os.read(terminal, 1000)
                process.kill()
                process.wait()
                os.close(terminal)
                if bool(shown) == bool(quiet) or not quiet and not re.search(rb"(optimal values|round \d+), \d+ s so far", shown):
                    problems.append("%s: %r" % (command + quiet, shown))
            process = subprocess.Popen([program, *command], cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
            time.sleep(2)
            process.kill()
            if process.communicate()[1]:
                problems.append("%s: progress where there is no terminal" % command)
    return problems


CHECKS = [check_default_family, check_threads, check_resume, check_violation, check_violations_kept, check_replay_hint,
          check_explain, check_theory_page, check_replay, check_vacuous, check_assumption, check_terminal,
          check_report, check_sigkill, check_sigint, check_certify, check_certify_by_bounds, check_tampered, check_exact_campaign,
          check_falsify, check_falsify_shares, check_huge, check_notes_once, check_exact_legend, check_left_out,
          check_goes_on, check_pipe, check_pedantic, check_fractions, check_killed_certificates, check_progress]


if __name__ == "__main__":
    main(GOLDEN, REFUSALS, CHECKS, check_shared_model)
