"""Optuna: E1max under a limit on the stroke, then E1max against the stroke."""

import optuna

import retune as rt

optuna.logging.set_verbosity(optuna.logging.WARNING)
problem = rt.Problem(
    rt.Structure(m1=1000, c1=452, k1=3.95e4),
    rt.SSVI(60, k2=215, c2=232, D=0.06, C=0.36),
    P=800,
    window=(50, 100),
    omega=6.28,
    vary=["k2", "c2", "D", "C"],
    bounds={"k2": (10, 600), "c2": (1, 1000), "D": (0, 1), "C": (0, 2)},
    limits={"stroke": 0.4},
)


def design(trial: optuna.Trial) -> list[float]:
    return [trial.suggest_float(name, low, high) for name, (low, high) in zip(problem.names, problem.bounds)]


def energy(trial: optuna.Trial) -> float:
    found = problem.evaluate(design(trial))
    trial.set_user_attr("violation", found.violation)
    return found.largest


def violation(trial: optuna.trial.FrozenTrial) -> list[float]:
    return [trial.user_attrs["violation"]]


sampler = optuna.samplers.TPESampler(seed=1, constraints_func=violation)
constrained = optuna.create_study(sampler=sampler)
constrained.optimize(energy, n_trials=150)
best = min((t for t in constrained.trials if t.user_attrs["violation"] <= 0), key=lambda t: t.values[0])
print(f"with a stroke of at most 0.4 m: {best.values[0]:.1f} J at {best.params}")


def both(trial: optuna.Trial) -> tuple[float, float]:
    found = problem.evaluate(design(trial))
    return found.largest, found.stroke


pareto = optuna.create_study(directions=["minimize", "minimize"], sampler=optuna.samplers.NSGAIISampler(seed=1, population_size=30))
pareto.optimize(both, n_trials=240)
print("E1max, J   stroke, m")
for trial in sorted(pareto.best_trials, key=lambda trial: trial.values[0]):
    print(f"{trial.values[0]:8.1f}   {trial.values[1]:.3f}")
assert len(pareto.best_trials) > 1
