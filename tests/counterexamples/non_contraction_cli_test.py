"""What non_contraction prints and how it ends. Usage: non_contraction_cli_test.py PROGRAM. Needs nothing but Python 3."""

import json
import subprocess
import sys
import unittest

PROGRAM = sys.argv.pop(1)


def run(*arguments):
    return subprocess.run([PROGRAM, *arguments], capture_output=True, text=True, timeout=60)


def document(*arguments):
    done = run("--json", *arguments)
    assert done.returncode == 0 and done.stderr == "", done

    def refuse(name):
        raise ValueError(name + " in JSON output")

    return json.loads(done.stdout, parse_constant=refuse)


class Text(unittest.TestCase):
    def test_default_tells_the_numbers_of_the_paper(self):
        done = run()
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        for line in ["|Q1 - Q2|   = 10", "|TQ1 - TQ2| = 11 gamma = 10.45",
                     "s2           11        10         8         2         0         1",
                     "gamma = 19/20 > 10/11: the backup drives Q1 and Q2 further apart. It is not a contraction."]:
            self.assertIn(line, done.stdout.splitlines())

    def test_verdict_at_and_around_the_threshold(self):
        for gamma, relation in [("10/11", "="), ("0.909090909090909", "<"), ("0.90909090909091", ">"), (".5", "<"),
                                ("0", "<"), ("0/7", "<"), ("30/33", "=")]:
            done = run("--gamma", gamma)
            self.assertEqual(done.returncode, 0)
            self.assertIn(" %s 10/11: " % relation, done.stdout)
            self.assertEqual("It is not a contraction" in done.stdout, relation == ">")

    def test_help_has_examples(self):
        done = run("--help")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertIn("Examples:\n  non_contraction ", done.stdout)


class Json(unittest.TestCase):
    def test_numbers(self):
        d = document("--gamma", "0.95")
        self.assertEqual((d["distance_before"], d["distance_after_per_gamma"]), (10, 11))
        self.assertEqual((d["distance_after_exact"], d["threshold_exact"], d["expands"]), ("209/20", "10/11", True))
        self.assertEqual(d["q1"]["q"], [[12, 12, 12], [11, 10, 8], [3, 2, 1]])
        self.assertEqual(d["q2"]["q"], [[4, 4, 4], [2, 0, 1], [-2, -1, -3]])
        self.assertEqual((d["q1"]["policy"], d["q2"]["policy"]), ([0, 0, 0], [1, 1, 1]))
        self.assertEqual((d["q1"]["values"], d["q2"]["values"]), ([12, 11, 3], [4, 0, -1]))

    def test_the_document_agrees_with_itself(self):
        for gamma in ["0", "0.5", "10/11", "0.99"]:
            d = document("--gamma", gamma)
            before = [abs(x - y) for r, t in zip(d["q1"]["q"], d["q2"]["q"]) for x, y in zip(r, t)]
            self.assertEqual(max(before), d["distance_before"])
            after = [abs(x - y) for r, t in zip(d["q1"]["backup"], d["q2"]["backup"]) for x, y in zip(r, t)]
            self.assertAlmostEqual(max(after), d["distance_after"], delta=1e-13)

    def test_the_sweep_turns_at_the_threshold(self):
        sweep = document()["sweep"]
        self.assertIn(10, [e["distance_after"] for e in sweep if e["gamma_exact"] == "10/11"])
        self.assertEqual([e["expands"] for e in sweep], [e["gamma"] > 10 / 11 for e in sweep])
        self.assertEqual({e["expands"] for e in sweep}, {True, False})


class Refusals(unittest.TestCase):
    def test_bad_input_is_one_line_and_exit_code_2(self):
        for gamma in ["1", "-1", "11/10", "1/0", "0.5x", "x", "", "1e-3", "nan", "0.1234567890123456", "1.5", "0.",
                      "/2", "0.5\n"]:
            done = run("--gamma", gamma)
            self.assertEqual((done.returncode, done.stdout), (2, ""), gamma)
            self.assertEqual(done.stderr.count("\n"), 1, gamma)
            self.assertIn("expected a decimal or a fraction" if gamma else "--gamma: empty, expected a value", done.stderr)

    def test_bad_usage(self):
        for arguments, says in [(["--gama", "0.5"], "--gamma"), (["--gamma"], "--gamma"), (["extra"], "extra")]:
            done = run(*arguments)
            self.assertEqual((done.returncode, done.stdout), (2, ""), arguments)
            self.assertEqual(done.stderr.count("\n"), 1, arguments)
            self.assertIn(says, done.stderr)


if __name__ == "__main__":
    unittest.main()
