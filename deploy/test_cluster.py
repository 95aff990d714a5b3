#!/usr/bin/env python3
"""Tries deploy/on_hyperqueue.py for real, with two HyperQueue workers on this machine, against a single process.

    python3 deploy/test_cluster.py target/release/retune

Each line that begins with "ok" was checked; the first that does not hold ends the script with an error.
"""

import json
import os
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent
RETUNE = str(Path(sys.argv[1]).resolve())
SHARDS = 8


def study(points, k1):
    """The paper's study with a grid of points⁴ runs."""
    study = json.loads((HERE.parent / "studies" / "ssvi.json").read_text())
    study["scene"]["primary"]["k1"] = k1
    study["name"] = "cluster"
    study.pop("$schema", None)
    for axis in study["optimize"]["surf"].values():
        axis["points"] = points
    return json.dumps(study)


def run(*arguments, expect=0):
    done = subprocess.run([RETUNE, *map(str, arguments)], capture_output=True, text=True)
    assert done.returncode == expect, f"{arguments}: {done.returncode}\n{done.stdout}{done.stderr}"
    return done.stdout, done.stderr.strip()


def cluster(out, study_file="study.json"):
    """The command that a person types, with two workers."""
    return subprocess.Popen(
        [sys.executable, HERE / "on_hyperqueue.py", study_file, "--shards", str(SHARDS), "--out", out, "--local", "2",
         "--retune", RETUNE],
        stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, start_new_session=True,
    )


def results(place):
    return {path.name: path.read_bytes() for path in Path(place).iterdir() if path.is_file()}


def same(out):
    found, expected = results(out), results("whole")
    assert found.keys() == expected.keys(), (sorted(found), sorted(expected))
    for name, content in expected.items():
        assert found[name] == content, f"{out}/{name} has other bytes"
    return len(expected)


def parts(out):
    return sorted(Path(out, "parts").glob("*.part"))


def tasks(out):
    """The processes that work on shares of this directory: this test's own, by their command line."""
    found = []
    for entry in Path("/proc").iterdir():
        if entry.name.isdigit():
            try:
                words = (entry / "cmdline").read_bytes().split(b"\0")
                here = os.readlink(entry / "cwd") == os.getcwd()
            except OSError:
                continue
            if here and words[0] == RETUNE.encode() and b"--shard" in words and out.encode() in words:
                found.append(int(entry.name))
    return found


def wait_until(condition, what):
    begun = time.monotonic()
    while not condition():
        assert time.monotonic() - begun < 120, f"waited in vain for {what}"
        time.sleep(0.005)


def main():
    Path("study.json").write_text(study(8, 39500))
    Path("other.json").write_text(study(8, 30000))
    begun = time.monotonic()
    run("optimize", "study.json", "--out", "whole", "--quiet")
    print(f"a grid of {8 ** 4} runs and its refinement, one process: {time.monotonic() - begun:.1f} s", flush=True)

    begun = time.monotonic()
    process = cluster("out")
    assert process.wait() == 0, process.stderr.read()
    print(f"ok: {SHARDS} shards on two workers, {time.monotonic() - begun:.1f} s: "
          f"{same('out')} files have the bytes of the single process", flush=True)

    process = cluster("killed")
    wait_until(lambda: len(parts("killed")) >= 2 and tasks("killed"), "a task to kill")
    victim = tasks("killed")[0]
    os.kill(victim, signal.SIGKILL)
    process.wait()
    said = process.stderr.read()
    assert process.returncode == 2 and "no part holds points" in said, said
    print("ok: a task was killed (SIGKILL) half-way; the merge refuses: " + said.strip().splitlines()[-1], flush=True)
    process = cluster("killed")
    assert process.wait() == 0, process.stderr.read()
    print(f"ok: the same command again goes on: {same('killed')} files have the bytes of the single process", flush=True)

    process = cluster("crash")
    wait_until(lambda: len(parts("crash")) >= 3 and tasks("crash"), "a cluster to kill")
    os.killpg(process.pid, signal.SIGKILL)
    for task in tasks("crash"):
        os.kill(task, signal.SIGKILL)
    process.wait()
    kept = len(parts("crash"))
    assert kept < SHARDS, "all parts were made before the kill"
    process = cluster("crash")
    assert process.wait() == 0, process.stderr.read()
    print(f"ok: server, both workers and their tasks were killed with {kept} of {SHARDS} parts there; the same command "
          f"again: {same('crash')} files have the bytes of the single process", flush=True)

    lost = parts("out")[3]
    content = lost.read_bytes()
    lost.rename("lost.part")
    _, said = run("merge", "study.json", "--out", "out", "--quiet", expect=2)
    assert "i/N = 4/8" in said, said
    print(f"ok: a part is lost: {said}", flush=True)
    Path("lost.part").rename(lost)

    double = lost.with_name("00009-of-00008-" + lost.name.rsplit("-", 1)[1])
    double.write_bytes(content)
    _, said = run("merge", "study.json", "--out", "out", "--quiet", expect=2)
    assert "keep one of the two" in said, said
    print(f"ok: a part is there twice: {said}", flush=True)
    double.unlink()

    run("optimize", "other.json", "--out", "foreign", "--shard", "4/8", "--quiet")
    lost.rename("lost.part")
    foreign = parts("foreign")[0]
    foreign.rename(lost.with_name(foreign.name))
    _, said = run("merge", "study.json", "--out", "out", "--quiet", expect=2)
    assert "of another study" in said, said
    print(f"ok: a part of another study: {said}", flush=True)
    lost.with_name(foreign.name).unlink()
    Path("lost.part").rename(lost)

    run("merge", "study.json", "--out", "out", "--quiet")
    print(f"ok: with all parts back: {same('out')} files have the bytes of the single process", flush=True)
    text, _ = run("verify", "out")
    print("ok: retune verify says: " + " | ".join(line.strip() for line in text.splitlines()), flush=True)


if __name__ == "__main__":
    with tempfile.TemporaryDirectory() as directory:
        os.chdir(directory)
        main()
