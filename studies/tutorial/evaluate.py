"""Minimise a Retune objective with SciPy: one process answers all designs."""
import subprocess
from scipy.optimize import minimize

retune = subprocess.Popen(["retune", "evaluate", "floor-tmd.json"], text=True,
                          stdin=subprocess.PIPE, stdout=subprocess.PIPE, bufsize=1)

def e1_max(design):
    print(*design, file=retune.stdin)          # one line: k2 c2
    answer = retune.stdout.readline()
    return float(answer) if not answer.startswith("error") else float("inf")

found = minimize(e1_max, x0=[1974, 40], method="Nelder-Mead", options={"xatol": 1e-3, "fatol": 1e-9})
print(f"k2 = {found.x[0]:.2f} N/m, c2 = {found.x[1]:.3f} N s/m, "
      f"E1max = {found.fun:.6f} J, {found.nfev} evaluations")
retune.stdin.close()
retune.wait()
