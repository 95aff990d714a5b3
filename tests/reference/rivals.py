"""SciPy's global optimisers beside Retune's own searches, on the same objective: evaluations until 1 % and 0.1 % of the best.

Needs numpy, SciPy and a built program. From the root of the repository (`just lab rivals` builds first; named problems only, if any):

    python3 tests/reference/rivals.py target/release/retune tmd-free ssvi-global

The rivals ask `retune evaluate STUDY`. Retune's own searches run as `retune optimize STUDY --threads 1`, on one thread so that
the order of their evaluations is one; they are counted in the journal, where every evaluation is written as it is made (what follows
them is of descents and the certificate). No study has a coarse stage here: its values are of another objective. Every
search is deterministic for its seed, so another run writes the same files (with another SciPy the last digits may differ).
"""

import concurrent.futures
import json
import math
import pathlib
import struct
import subprocess
import sys
import tempfile
import time

import numpy
import scipy
from scipy.optimize import differential_evolution, dual_annealing, minimize

ROOT = pathlib.Path(__file__).resolve().parents[2]
RESULTS = ROOT / "results" / "rivals"
NAMES = ["k2", "c2", "D", "C"]
# What stands for a design without a value (a TMD that reaches a wall), J; no objective here comes near it.
NO_VALUE = 1e6
LEVELS = [("1 %", 1.01), ("0.1 %", 1.001)]
# Each box with the sides that are searched in their logarithm, as Retune's global search does for a decade or more.
PROBLEMS = {
    "tmd-free": {
        "title": "TMD over 5 … 8 rad/s, steady",
        "box": {"k2": (200, 6400, True), "c2": (2, 640, True)},
        "budget": 1500,
        "seeds": range(1, 11),
        "change": {},
    },
    "ssvi-global": {
        "title": "SSVI NES over 5 … 8 rad/s, k2 at most 600 N/m",
        "box": {"k2": (10, 600, True), "c2": (1, 1000, True), "D": (0, 1, False), "C": (0, 2, False)},
        "budget": 2500,
        "seeds": range(1, 4),
        "change": {"samples": 16},
    },
}
# Retune's own searches: the fields of `optimize.global`, or None for the study as it is (with its grid, if it has one).
OWN = {
    "Retune, its study": None,
    "Retune, global {}": {},
    "Retune, global, 64 designs": {"samples": 64, "searches": 4},
}


class Spent(Exception):
    """The budget of evaluations is spent."""


class Objective:
    """The objective of a study in coordinates from 0 to 1, counted."""

    def __init__(self, program, study, box, budget):
        self.process = subprocess.Popen(
            [program, "evaluate", study, "--threads", "1"], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True
        )
        self.box, self.budget, self.values, self.best = box, budget, [], (math.inf, None)

    def design(self, u):
        def side(part, low, high, ratios):
            part = min(max(float(part), 0.0), 1.0)
            return low * (high / low) ** part if ratios else low + part * (high - low)

        return [side(part, *ends) for part, ends in zip(u, self.box.values())]

    def __call__(self, u):
        if len(self.values) >= self.budget:
            raise Spent
        design = self.design(u)
        self.process.stdin.write(" ".join(map(repr, design)) + "\n")
        self.process.stdin.flush()
        answer = self.process.stdout.readline().strip()
        value = NO_VALUE if answer.startswith("error: ") else float(answer)
        if value < self.best[0]:
            self.best = value, design
        self.values.append(value)
        return value


def evolve(objective, bounds, seed):
    differential_evolution(objective, bounds, rng=seed)


def anneal(objective, bounds, seed):
    dual_annealing(objective, bounds, rng=seed)


def nelder_mead(objective, bounds, seed):
    """From random starts, one after the other, until the budget is spent."""
    random = numpy.random.default_rng(seed)
    while True:
        start = random.random(len(bounds))
        minimize(objective, start, method="Nelder-Mead", bounds=bounds, options={"xatol": 1e-4, "fatol": 1e-3})


RIVALS = {
    "SciPy differential_evolution": evolve,
    "SciPy dual_annealing": anneal,
    "SciPy Nelder-Mead, many starts": nelder_mead,
}


def run_rival(program, folder, name, method, seed):
    problem = PROBLEMS[name]
    objective = Objective(program, write_study(folder, name, None, None), problem["box"], problem["budget"])
    try:
        RIVALS[method](objective, [(0.0, 1.0)] * len(problem["box"]), seed)
    except Spent:
        pass
    objective.process.stdin.close()
    objective.process.wait()
    return name, method, seed, objective.values, dict(zip(problem["box"], objective.best[1]))


def write_study(folder, name, own, seed):
    """The committed study, with fewer samples of its band and another search; its path."""
    study = json.loads((ROOT / "studies" / f"{name}.json").read_text())
    study.pop("$schema", None)
    optimize = study["optimize"]
    optimize["objective"]["omega"].update(PROBLEMS[name]["change"])
    optimize.pop("coarse", None)
    if own is not None:
        optimize.pop("surf", None)
        sides = {side: {"from": low, "to": high, "scale": "log" if ratios else "linear"}
                 for side, (low, high, ratios) in PROBLEMS[name]["box"].items()}
        optimize["global"] = {**own, "box": sides, "seed": seed}
    elif "global" in optimize and seed is not None:
        optimize["global"]["seed"] = seed
    path = folder / f"{name}-{len(list(folder.iterdir()))}-{seed}-{time.monotonic_ns()}.json"
    path.write_text(json.dumps(study))
    return path


def run_own(program, folder, name, method, seed):
    out = folder / f"{name}-{method}-{seed}".replace(" ", "_").replace("{}", "default").replace(",", "")
    study = write_study(folder, name, OWN[method], seed)
    process = subprocess.Popen([program, "optimize", study, "--out", out, "--threads", "1", "--quiet"],
                               stdout=subprocess.DEVNULL)
    path = out / "unfinished" / "journal"
    while True:
        # The journal goes when the results are whole: hold it open before that. The certificate alone takes longer than this.
        try:
            journal = path.open()
            break
        except FileNotFoundError:
            if process.poll() is not None:
                raise SystemExit(f"{name}, {method}: no journal was seen")
            time.sleep(0.001)
    if process.wait() != 0:
        raise SystemExit(f"{name}, {method}: failed")
    optimum = json.loads((out / "optimum.json").read_text())
    runs = optimum["refine"]["runs"]
    searched = (optimum["surf"] or {}).get("points", 0) + (optimum.get("global") or {}).get("evaluations", 0)
    searched += sum(run["func_count"] for run in runs)
    lines = [line for line in map(str.split, journal) if line[0] in "ge"][:searched]
    values = [struct.unpack(">d", bytes.fromhex(line[2]))[0] for line in lines]
    values = [value if math.isfinite(value) else NO_VALUE for value in values]
    # The optimum itself is computed to a tighter tolerance than its search.
    if min(values) < 0.999 * optimum["E1max"]:
        raise SystemExit(f"{name}, {method}: {min(values)} J is below the optimum, {optimum['E1max']} J")
    # Of the descents that finish a search only the end is known.
    values += [NO_VALUE] * (sum(run.get("descent", {}).get("evaluations", 0) for run in runs) - 1) + [optimum["E1max"]]
    return name, method, seed, values, {side: optimum[side] for side in PROBLEMS[name]["box"]}


def until(values, level):
    """Evaluations made when the first value at most `level` was there; None if none was."""
    return next((i + 1 for i, value in enumerate(values) if value <= level), None)


def median(counts):
    """The middle one, None (never) counting as the largest; of two middles the larger."""
    counts = sorted(counts, key=lambda count: math.inf if count is None else count)
    return counts[len(counts) // 2]


def page(rows, best, version):
    text = ["# Retune's searches beside SciPy's", "",
            "Made by `just lab rivals` (`tests/reference/rivals.py`); do not edit. Each row of `rivals.csv` is one search with one seed. All",
            "make the same objective small: SciPy's methods ask `retune evaluate`, in the coordinates of Retune's global search (logarithms of",
            f"k2 and c2), with SciPy's own settings ({version}). Counted are evaluations of a design, not time.", ""]
    for name, problem in PROBLEMS.items():
        own = [row for row in rows if row[0] == name]
        samples = problem["change"].get("samples")
        of = f" ({samples} samples of the band instead of the study's)" if samples else ""
        value, who = best[name]
        text += [f"## {problem['title']}", "",
                 f"`studies/{name}.json`{of}. Best of all searches: {value:.6f} J ({who}). A rival stops after "
                 f"{problem['budget']} evaluations.", "",
                 "| search | within 1 %: seeds | evaluations, median (range) | within 0.1 %: seeds | evaluations, median (range) | "
                 "evaluations in all, median | best of the seeds, J | worst of the seeds, J |",
                 "| --- | --- | --- | --- | --- | --- | --- | --- |"]
        for method in dict.fromkeys(row[1] for row in own):
            runs = [row for row in own if row[1] == method]
            cells = []
            for i in (4, 5):
                counts = [row[i] for row in runs]
                met = [count for count in counts if count is not None]
                middle = median(counts)
                cells += [f"{len(met)} of {len(counts)}",
                          f"{'never' if middle is None else middle} ({min(met)} … {max(met)})" if met else "never"]
            ends = [row[6] for row in runs]
            text.append(f"| {method} | {' | '.join(cells)} | {median([row[3] for row in runs])} | {min(ends):.4f} | {max(ends):.4f} |")
        text.append("")
    return "\n".join(text)


def main():
    program = str(pathlib.Path(sys.argv[1]).resolve())
    for name in set(PROBLEMS) - set(sys.argv[2:] or PROBLEMS):
        del PROBLEMS[name]
    with tempfile.TemporaryDirectory() as place, concurrent.futures.ThreadPoolExecutor(2) as pool:
        folder = pathlib.Path(place)
        tasks = []
        for name, problem in PROBLEMS.items():
            for method in RIVALS:
                tasks += [pool.submit(run_rival, program, folder, name, method, seed) for seed in problem["seeds"]]
            for method, own in OWN.items():
                grid = name == "tmd-free" and own is None
                if name == "ssvi-global" and own == {}:
                    continue  # that is its study
                seeds = [1] if grid else problem["seeds"]
                tasks += [pool.submit(run_own, program, folder, name, method, seed) for seed in seeds]
        found = []
        for task in tasks:
            found.append(task.result())
            name, method, seed, values, _ = found[-1]
            print(f"{name}, {method}, seed {seed}: {min(values):.6f} J in {len(values)}", file=sys.stderr, flush=True)
    best = {name: min((min(values), method) for other, method, _, values, _ in found if other == name) for name in PROBLEMS}
    rows, csv = [], ["problem,search,seed,evaluations,until_1_percent,until_0.1_percent,E1max,k2,c2,D,C"]
    for name, method, seed, values, design in found:
        counts = [until(values, factor * best[name][0]) for _, factor in LEVELS]
        rows.append((name, method, seed, len(values), *counts, min(values)))
        cells = [name, f'"{method}"', seed, len(values), *counts, min(values), *[design.get(side) for side in NAMES]]
        csv.append(",".join("" if cell is None else str(cell) for cell in cells))
    RESULTS.mkdir(parents=True, exist_ok=True)
    (RESULTS / "rivals.csv").write_text("\n".join(csv) + "\n")
    version = f"SciPy {scipy.__version__}, numpy {numpy.__version__}"
    (RESULTS / "README.md").write_text(page(rows, best, version))


main()
