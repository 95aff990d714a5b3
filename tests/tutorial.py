"""Runs every command of docs/tutorial.md in a new directory and compares its output with the page (`just test-tutorial`).

A block of the page that begins with "$ " is a command and its output. A line "..." stands for any number of lines; times of searches
differ from machine to machine and are not compared. What the page shows of files must be in studies/tutorial. A system whose sine and
cosine round differently may search along another path. Usage: tests/tutorial.py PATH_OF_RETUNE
"""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parent.parent


def blocks(page):
    """Commands with the lines of their output."""
    for block in re.findall(r"```text\n(.*?)```", page, re.S):
        for part in re.split(r"(?m)^\$ ", block)[1:]:
            command, _, output = part.partition("\n")
            yield command, output.splitlines()


def comparable(line):
    return re.sub(r"\d+\.\d s", "_ s", line.rstrip())


def matches(expected, lines):
    """Whether the lines are those expected, in order; "..." may skip some."""
    at, skipping = 0, False
    for want in map(comparable, expected):
        if want == "...":
            skipping = True
            continue
        rest = lines[at:] if skipping else lines[at : at + 1]
        if want not in rest:
            return want
        at += rest.index(want) + 1
        skipping = False
    return None


def shown_files(page):
    """Files, or parts of them, that the page shows."""
    return re.findall(r"```(?:json|python)\n(.*?)```", page, re.S)


def main():
    program = pathlib.Path(sys.argv[1]).resolve()
    page = (ROOT / "docs/tutorial.md").read_text()
    environment = os.environ | {"PATH": f"{program.parent}{os.pathsep}{os.environ['PATH']}"}
    environment.pop("RETUNE_RUN_AS", None)  # set by `just`: the page is for those who call the program
    texts = [file.read_text() for file in (ROOT / "studies/tutorial").iterdir()]
    for shown in shown_files(page):
        if not any(shown.strip("\n") in text for text in texts):
            sys.exit(f"not in studies/tutorial:\n{shown}")
    count, wrong = 0, 0
    with tempfile.TemporaryDirectory() as desk:
        shutil.copytree(ROOT / "studies", pathlib.Path(desk) / "studies")
        place = pathlib.Path(desk) / "studies/tutorial"
        for command, expected in blocks(page):
            ran = subprocess.run(command, shell=True, cwd=place, env=environment, text=True,
                                 stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
            wanted = matches(expected, [comparable(line) for line in ran.stdout.splitlines()])
            if ran.returncode != 0 or wanted is not None:
                print(f"$ {command}\n{ran.stdout}\nexit code {ran.returncode}; the page has: {wanted}")
                wrong += 1
            else:
                print(f"as on the page: {command}")
            count += 1
    if wrong > 0:
        sys.exit(f"{wrong} of {count} commands print something else than the page")
    if count < 10:
        sys.exit(f"only {count} commands found on the page")


if __name__ == "__main__":
    main()
