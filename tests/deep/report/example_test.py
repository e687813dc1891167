"""example_test.py PROGRAM: what the example writes is well-formed to a parser that shares nothing with the writer, and
the JSON says the means that its own returns have."""

import json
import pathlib
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as xml


def wellformed(text):
    try:
        xml.fromstring(text)
    except xml.ParseError:
        return False
    return True


def mean(values):
    return sum(values) / len(values)


def means_agree(table):
    done = [c for b in table["blocks"] for c in b["cells"] if c["runs"]]
    return len(done) > 5 and all(
        abs(c["summary"]["mean"] - mean([mean(r["returns"]) for r in c["runs"]])) < 1e-9 for c in done)


with tempfile.TemporaryDirectory() as folder:
    subprocess.run([sys.argv[1], folder], check=True)
    for name in ("table.html", "episode.svg", "particles.svg", "path.svg"):
        text = (pathlib.Path(folder) / name).read_text(encoding="utf-8")
        assert wellformed(text), name
        assert not wellformed(text.replace("</svg>", "", 1)), "a parser that sees nothing"
    table = json.loads((pathlib.Path(folder) / "table.json").read_text(encoding="utf-8"))
    assert means_agree(table)
    table["blocks"][0]["cells"][0]["runs"][0]["returns"][0] += 1
    assert not means_agree(table), "a check that sees nothing"
    assert json.loads((pathlib.Path(folder) / "episode.json").read_text(encoding="utf-8"))["steps"]
