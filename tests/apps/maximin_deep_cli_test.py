"""What maximin_deep does when it is killed, interrupted, or given bad usage and bad files. Trainings of a second."""

import json
import os
import random
import signal
import subprocess
import tempfile
import time
import xml.etree.ElementTree

from cli import Refusal, main, no_constants, run

COMMANDS = ["train", "evaluate", "table", "watch"]

ENVIRONMENT = {**os.environ, "OPENBLAS_NUM_THREADS": "1", "OMP_NUM_THREADS": "1"}

TINY = json.dumps({"network": {"hidden": [8]}, "training": {"frames": 3000, "lanes": 8, "stretch_frames": 80, "warm_up": 100}})
# With a particle filter, which is trained first and for longest.
TINY_FILTER = json.dumps({
    "start_from": "", "network": {"hidden": [8]}, "training_belief_states": 2,
    "particle_filter": {"particles": 3, "hidden": 8, "embedding": 8},
    "particle_filter_training": {"updates": 900, "batch": 2, "window": 2, "particles": 3},
    "training": {"frames": 400, "lanes": 8, "stretch_frames": 80, "warm_up": 100}})


def refused(arguments, says, **files):
    return Refusal(arguments, 2, says, {name.replace("_", ".", 1): text for name, text in files.items()})


REFUSALS = [
    refused([], "no command given, expected one of train, evaluate, table, watch"),
    refused(["trian"], "did you mean train?"),
    refused(["train"], "AGENT"),
    refused(["train", "dqm"], "dqm"),
    refused(["train", "dqn", "--frames", "0"], "--frames: 0"),
    refused(["train", "dqn", "--device", "gpu"], "--device: gpu, expected cpu, cuda or cuda:N"),
    refused(["train", "dqn", "--config", "c.json"], "c.json: not JSON", c_json="{"),
    refused(["train", "dqn", "--config", "c.json"], "deeper than 64 levels", c_json="[" * 100000),
    refused(["train", "dqn", "--config", "c.json"], 'c.json: "framse": no such field', c_json='{"framse": 3}'),
    refused(["train", "dqn", "--config", "c.json"], "c.json: kind", c_json='{"kind": "../dqn"}'),
    refused(["train", "dqn", "--config", "c.json", "--folder", "f"], "start_from: dqn", c_json='{"start_from": "dqn"}'),
    refused(["train", "dqn", "--frames", "100", "--folder", "c.json"], "c.json", c_json="{}"),
    refused(["train", "dqn", "--config", "c.json", "--folder", "f"], "start_from: bp-dqn", c_json='{"start_from": "bp-dqn"}'),
    refused(["train", "dqn", "--config", "c.json"], "10^12 at most",
            c_json='{"training": {"stretch_frames": 4000000000000000000}}'),
    refused(["train", "dqn", "--seeds", "2", "--config", "c.json"], "asked for twice", c_json='{"training": {"seed": 5}}'),
    refused(["train", "bp-dqn", "--eps", "0.1", "--config", "c.json"], "c.json: sets eps, which an option sets too",
            c_json='{"eps": 0.5}'),
    refused(["train", "dqn", "--seed", "1", "--config", "c.json"], "c.json: sets training/seed", c_json='{"training": {"seed": 5}}'),
    refused(["train", "dqn", "--seed", "18446744073709551615", "--seeds", "2"], "expected seeds below 2^64"),
    refused(["train", "sa-dqn", "--config", "c.json"], "SA loss: kappa is -1", c_json='{"loss_options": {"kappa": -1}}'),
    refused(["train", "bp-dqn", "--config", "/dev/zero"], "/dev/zero: larger than"),
    refused(["watch", "a.agent", "-o", "b.svg"], "b.svg: exists", a_agent="PK", b_svg="mine"),
    refused(["evaluate", "a.agent", "b.agent", "--attack", "pa-ad", "--attacker", "f"], "--attacker: one file for 1"),
    refused(["evaluate", "a.agent", "--attack", "pgd", "--attacker", "f"], "--attacker: no attack here learns"),
    refused(["watch", "a.agent", "--attack-seed", "2"], "--attack-seed: no attack here learns"),
    refused(["evaluate", "a.agent", "--attack", "pgd", "--judge", "f"], "--judge: no attack here goes by it"),
    refused(["evaluate", "a.agent", "--aggregator", "soft-min:-1"], "--aggregator: soft-min: beta"),
    refused(["watch", "a.agent", "-o", "a.agent", "--force"], "a.agent: named twice", a_agent="PK"),
    refused(["watch", "a.agent", "-o", "b.svg", "--trace", "b.svg"], "b.svg: named twice", a_agent="PK"),
    refused(["evaluate", "/dev/null"], "/dev/null: is a device or a pipe"),
    refused(["evaluate", "none.agent"], "none.agent: No such file or directory, expected a file of kind"),
    refused(["evaluate", "a.agent"], "a.agent: no file of this program", a_agent="PK"),
    refused(["evaluate", "a.agent"], "a.agent: cut off or damaged", a_agent="maximin-tensors 1\n{}\n1234"),
    refused(["evaluate", "a.agent", "--attack", "pdg"], "--attack: pdg"),
    refused(["evaluate", "a.agent", "--eps", "-1"], "--eps: -1"),
    refused(["evaluate", "a.agent", "--belief", "all"], "--belief: all"),
    refused(["watch", "none.agent"], "none.agent: No such file or directory, expected a file of kind"),
    refused(["table", "atari"], "atari"),
    refused(["table", "gridworld", "--only", "dqm"], "dqm"),
    refused(["table", "aggregators", "--only", "dqn"], "--only, --attacks: no such cell"),
    refused(["table", "gridworld", "--output", "c.json", "--folder", "."], "c.json", c_json="{}"),
]


def bytes_of(path):
    with open(path, "rb") as f:
        return f.read()


def deep(program, arguments, **options):
    return run(program, arguments, env=ENVIRONMENT, **options)


def wait_for(path, process, seconds=60):
    """Whether the file appeared while the process ran."""
    end = time.monotonic() + seconds
    while time.monotonic() < end and process.poll() is None:
        if os.path.exists(path):
            return True
        time.sleep(0.005)
    return os.path.exists(path)


def tiny(folder, name="tiny.json", config=TINY):
    path = os.path.join(folder, name)
    with open(path, "w") as f:
        f.write(config)
    return path


def check_help(program):
    """Every help text has an example that names the program."""
    problems = []
    for command in [[]] + [[c] for c in COMMANDS]:
        result = deep(program, command + ["--help"])
        text = result.stdout.decode()
        if result.returncode != 0 or result.stderr or "Example" not in text or "  maximin_deep " not in text:
            problems.append("%s: exit code %d, %r" % (command, result.returncode, text[-200:]))
    return problems


def killed_at_random(program, folder, arguments, checkpoint, rng):
    """Starts the training again and again, killed three times some time after its checkpoint was written anew; then lets
    it end."""
    kills = 0
    while kills < 3:
        if os.path.exists(checkpoint):
            os.utime(checkpoint, (0, 0))
        process = subprocess.Popen([program] + arguments, env=ENVIRONMENT, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        while process.poll() is None and not (os.path.exists(checkpoint) and os.stat(checkpoint).st_mtime > 1):
            time.sleep(0.002)
        time.sleep(rng.uniform(0, 0.05))
        if process.poll() is not None:
            return "ended with %s before it was killed %d times" % (process.returncode, kills + 1)
        process.kill()
        process.wait()
        kills += 1
    result = deep(program, arguments)
    return "" if result.returncode == 0 else "exit code %d, %r" % (result.returncode, result.stderr)


def killed_training(program, agent, name, config):
    """A training killed in the middle three times leaves the same files, byte for byte."""
    problems = []
    with tempfile.TemporaryDirectory() as folder:
        def arguments(where, *more):
            return ["train", agent, "--config", tiny(folder, config=config), "--folder", os.path.join(folder, where), "--json",
                    *more]
        whole = deep(program, arguments("whole"))
        if whole.returncode != 0 or json.loads(whole.stdout)["agents"][0]["training_seconds"] <= 0:
            problems.append("exit code %d, %r" % (whole.returncode, whole.stderr))
        checkpoint = os.path.join(folder, "cut", name + "1.training")
        problem = killed_at_random(program, folder, arguments("cut"), checkpoint, random.Random(4))
        if problem:
            problems.append(problem)
        deep(program, arguments("other", "--seed", "2"))
        for ending in (".agent", ".csv"):
            one, other = (bytes_of(os.path.join(folder, f, name + "1" + ending)) for f in ("whole", "cut"))
            if one != other:
                problems.append("another %s1%s after being killed" % (name, ending))
            if one == bytes_of(os.path.join(folder, "other", name + "2" + ending)):
                problems.append("the comparison does not tell seeds apart")
        left = [f for f in os.listdir(os.path.join(folder, "cut")) if not f.endswith(".partial")]
        if sorted(left) != [name + "1" + ending for ending in (".agent", ".csv", ".times.json")]:
            problems.append("left behind: %s" % left)
    return problems


def check_killed_training(program):
    return killed_training(program, "dqn", "dqn-seed", TINY)


def check_killed_filter_training(program):
    return killed_training(program, "bp-dqn-printed", "bp-dqn-printed-eps0.1-seed", TINY_FILTER)


def check_interrupted_training(program):
    """SIGINT ends with 130 and a state that goes on; a checkpoint that was damaged is refused."""
    problems = []
    with tempfile.TemporaryDirectory() as folder:
        runs = os.path.join(folder, "runs")
        arguments = ["train", "dqn", "--config", tiny(folder), "--folder", runs]
        checkpoint = os.path.join(runs, "dqn-seed1.training")
        process = subprocess.Popen([program] + arguments, env=ENVIRONMENT, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        if not wait_for(checkpoint, process):
            problems.append("no checkpoint")
        process.send_signal(signal.SIGINT)
        out, err = process.communicate(timeout=60)
        if process.returncode != 130 or b"the same command goes on" not in err or not os.path.exists(checkpoint):
            problems.append("exit code %d, %r" % (process.returncode, err))
        good = bytes_of(checkpoint)
        for bad in (good[:-9], good[:40], b"", good[:-1] + bytes([good[-1] ^ 1]), good[:99] + b"?" + good[100:]):
            with open(checkpoint, "wb") as f:
                f.write(bad)
            result = deep(program, arguments)
            if result.returncode != 2 or result.stderr.count(b"\n") != 1 or b"dqn-seed1.training: " not in result.stderr:
                problems.append("damaged checkpoint: exit code %d, %r" % (result.returncode, result.stderr))
        with open(checkpoint, "wb") as f:
            f.write(good)
        if deep(program, arguments).returncode != 0:
            problems.append("the good checkpoint is refused")
        other = deep(program, arguments[:2] + ["--folder", runs])
        if other.returncode != 2 or b"another specification" not in other.stderr:
            problems.append("an agent of another specification: exit code %d, %r" % (other.returncode, other.stderr))
    return problems


def check_agents(program):
    """What is done with a trained agent: numbers that come again, a picture, and nothing overwritten."""
    problems = []
    with tempfile.TemporaryDirectory() as folder:
        def here(*arguments):
            return deep(program, list(arguments), cwd=folder)
        # Two that begin with the same vanilla agent, side by side.
        with open(os.path.join(folder, "c.json"), "w") as f:
            f.write('{"network": {"hidden": [8]}, "random_actions": 0.3}')
        trained = here("train", "bp-dqn", "wocar-dqn", "--frames", "600", "--jobs", "2", "--eps", "0.3", "--folder", ".",
                       "--config", "c.json")
        expected = ["bp-dqn-eps0.3-seed1.agent", "dqn-seed1.agent", "wocar-dqn-eps0.3-seed1.agent"]
        if trained.returncode != 0 or sorted(f for f in os.listdir(folder) if f.endswith(".agent")) != expected:
            return ["training: exit code %d, %r, %s" % (trained.returncode, trained.stderr, os.listdir(folder))]
        evaluate = ["evaluate", *expected[::2], "--attack", "random", "best-response", "--episodes", "4", "--json"]
        first, second = here(*evaluate), here(*evaluate)
        other = here(*evaluate, "--seed", "7")
        if first.returncode != 0:
            return ["evaluate: exit code %d, %r" % (first.returncode, first.stderr)]

        def returns(result):
            return [r["returns"] for r in json.loads(result.stdout, parse_constant=no_constants)["results"]]
        if len(returns(first)) != 4 or any(len(r) != 4 for r in returns(first)):
            problems.append("evaluate: %s" % returns(first))
        if returns(first) != returns(second) or returns(first) == returns(other):
            problems.append("evaluate: the same seed gives other numbers, or another the same")
        # Whose values the attack on the whole defence went by; without one, that agent is not even read.
        judges = [r["judge"] for r in json.loads(first.stdout)["results"]]
        if judges != [None, "dqn-seed1.agent"] * 2:
            problems.append("evaluate: judges %s" % judges)
        os.rename(os.path.join(folder, expected[1]), os.path.join(folder, "aside"))
        own = json.loads(here(*evaluate).stdout)["results"]
        if own[1]["judge"] != "the agent's own values":
            problems.append("evaluate: without a vanilla agent %s" % own[1])
        with open(os.path.join(folder, expected[1]), "w") as f:
            f.write("PK")
        if here(*evaluate).returncode != 2 or here("evaluate", expected[0], "--episodes", "2").returncode != 0:
            problems.append("evaluate: a broken judge counts where there is none, or the other way round")
        os.replace(os.path.join(folder, "aside"), os.path.join(folder, expected[1]))
        if b"of these very networks" not in here(*evaluate[:-1]).stdout:
            problems.append("evaluate: no table")

        watch = ["watch", expected[0], "--attack", "random", "-o", "e.svg", "--trace", "t.json"]
        shown = here(*watch)
        if shown.returncode != 0 or b"episode 0: " not in shown.stdout:
            return problems + ["watch: exit code %d, %r" % (shown.returncode, shown.stderr)]
        if not xml.etree.ElementTree.parse(os.path.join(folder, "e.svg")).getroot().tag.endswith("svg"):
            problems.append("watch: no SVG")
        json.loads(bytes_of(os.path.join(folder, "t.json")), parse_constant=no_constants)
        before = bytes_of(os.path.join(folder, "e.svg"))
        for again, replaced in ((watch[:-2], "e.svg"), (watch[:5] + ["new.svg"] + watch[6:], "t.json")):
            result = here(*again, "--episode", "1")
            if result.returncode != 2 or ("%s: exists" % replaced).encode() not in result.stderr:
                problems.append("watch overwrites %s: exit code %d, %r" % (replaced, result.returncode, result.stderr))
        if bytes_of(os.path.join(folder, "e.svg")) != before or os.path.exists(os.path.join(folder, "new.svg")):
            problems.append("watch wrote what it refused to write")
        if here(*watch, "--episode", "1", "--force").returncode != 0 or bytes_of(os.path.join(folder, "e.svg")) == before:
            problems.append("watch --force leaves the old picture")

        good = bytes_of(os.path.join(folder, expected[1]))
        for bad in (good[:-1], good[:-5] + bytes([good[-5] ^ 4]) + good[-4:]):
            with open(os.path.join(folder, "bad.agent"), "wb") as f:
                f.write(bad)
            result = here("evaluate", "bad.agent")
            if result.returncode != 2 or result.stderr.count(b"\n") != 1 or b"bad.agent: cut off or damaged" not in result.stderr:
                problems.append("damaged agent: exit code %d, %r" % (result.returncode, result.stderr))
    return problems


def without_seconds(value):
    """The JSON without what depends on the clock and on where it was made."""
    if isinstance(value, dict):
        return {k: without_seconds(v) for k, v in value.items() if "seconds" not in k}
    return [without_seconds(v) for v in value] if isinstance(value, list) else value


def check_one_training_at_a_time(program):
    """Two runs never write one training."""
    problems = []
    with tempfile.TemporaryDirectory() as folder:
        command = ["train", "dqn", "--folder", folder]
        first = subprocess.Popen([program] + command, env=ENVIRONMENT, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        while first.poll() is None and not os.path.exists(os.path.join(folder, "dqn-seed1.training")):
            time.sleep(0.01)
        second = deep(program, command)
        if second.returncode != 2 or b"dqn-seed1.agent: another run is writing it" not in second.stderr:
            problems.append("a second run: exit code %d, %r" % (second.returncode, second.stderr))
        first.kill()
        first.wait()
        after = deep(program, ["train", "dqn", "--frames", "600", "--folder", folder])
        if b"another specification" not in after.stderr:  # a lock outlives nobody
            problems.append("after a kill: exit code %d, %r" % (after.returncode, after.stderr))
    return problems


def check_table_in_parts(program):
    """A table made part by part is the table."""
    with tempfile.TemporaryDirectory() as folder:
        def make(name, attacks):
            where = os.path.join(folder, name)
            done = deep(program, ["table", "gridworld", "--only", "dqn", "--frames", "600", "--seeds", "1", "--episodes", "2",
                                  "--folder", where, "--output", where, "--attacks"] + attacks)
            with open(os.path.join(where, "gridworld.json")) as f:
                table = without_seconds(json.load(f, parse_constant=no_constants))
            return done.returncode, table["configuration"], {
                (b["name"], c["agent"], c["attack"], c["eps"]): c["runs"] for b in table["blocks"] for c in b["cells"]}
        whole = make("whole", ["none", "pgd"])
        part = make("parts", ["none"])
        parts = make("parts", ["pgd"])
    if whole != parts or part == parts or whole[0] != 0:
        return ["in parts %r, as a whole %r" % (parts, whole)]
    return []


def check_killed_table(program):
    """A table killed at random, and interrupted, ends as the same table."""
    problems = []
    with tempfile.TemporaryDirectory() as folder:
        def command(name):
            where = os.path.join(folder, name)
            return [program, "table", "gridworld", "--only", "dqn", "sure", "--attacks", "none", "random", "pgd", "--frames", "600",
                    "--seeds", "1", "--episodes", "2", "--folder", where, "--output", where]

        def table(name):
            with open(os.path.join(folder, name, "gridworld.json")) as f:
                return without_seconds(json.load(f, parse_constant=no_constants))
        def done():
            exists = os.path.exists(os.path.join(folder, "cut", "gridworld.json"))
            return sum(len(c["runs"]) for b in table("cut")["blocks"] for c in b["cells"]) if exists else 0
        whole = deep(program, command("whole")[1:])
        if whole.returncode != 0 or b"DQN" not in whole.stdout:
            return ["exit code %d, %r" % (whole.returncode, whole.stderr)]
        rng = random.Random(1)
        json_file = os.path.join(folder, "cut", "gridworld.json")
        for number, code in ((signal.SIGKILL, -signal.SIGKILL), (signal.SIGINT, 130), (signal.SIGKILL, -signal.SIGKILL)):
            before = done()
            process = subprocess.Popen(command("cut"), env=ENVIRONMENT, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
            while process.poll() is None and done() <= before:
                time.sleep(0.005)
            time.sleep(rng.uniform(0, 0.02))
            process.send_signal(number)
            _, err = process.communicate(timeout=60)
            if process.returncode != code:
                problems.append("signal %d: exit code %d, %r" % (number, process.returncode, err))
        done_before_the_end = done()
        if deep(program, command("cut")[1:]).returncode != 0 or table("cut") != table("whole"):
            problems.append("another table after being killed")
        cells = [c for b in table("whole")["blocks"] for c in b["cells"]]
        if not 3 <= done_before_the_end < len(cells) or any(len(c["runs"]) != 1 for c in cells):
            problems.append("%d runs of %d cells before the end" % (done_before_the_end, len(cells)))
        if len({json.dumps(c["runs"][0]["returns"]) for c in cells}) < 3:
            problems.append("all cells alike: the comparison would not tell tables apart")
        with open(json_file, "w") as f:
            f.write("{")
        broken = deep(program, command("cut")[1:])
        foreign = table("whole")
        foreign["blocks"][0]["cells"][0]["runs"][0]["returns"] *= 2  # the same mean, of twice the episodes
        foreign["wall_seconds"] = 1
        for b in foreign["blocks"]:
            for c in b["cells"]:
                for r in c["runs"]:
                    r["wall_seconds"] = 1
        with open(json_file, "w") as f:
            json.dump(foreign, f)
        refused_runs = deep(program, command("cut")[1:])
        if refused_runs.returncode != 2 or b"a run of 4 episodes from seed 1001, expected 2" not in refused_runs.stderr:
            problems.append("runs of another table: exit code %d, %r" % (refused_runs.returncode, refused_runs.stderr))
        if broken.returncode != 2 or broken.stderr.count(b"\n") != 1:
            problems.append("broken table: exit code %d, %r" % (broken.returncode, broken.stderr))
    return problems


CHECKS = [check_help, check_killed_training, check_killed_filter_training, check_interrupted_training, check_agents,
          check_one_training_at_a_time, check_table_in_parts, check_killed_table]


if __name__ == "__main__":
    main([], REFUSALS, CHECKS, None)
