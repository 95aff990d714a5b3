"""E1max and the largest contact force of dampers with c2 = 1e7 N s/m near their wall, in 6 s: crates/solver/tests/solver/dashpots.rs.

    pip install numpy scipy; python3 tests/reference/held_dashpots.py [RTOL]     (two minutes)

By the integration of `scipy_scenes.py` with Radau, which no stiff rate shortens.
"""

import sys

from scipy_scenes import Method, Radau, Scene, run

rtol = float((sys.argv[1:] or ["3e-13"])[0])
for D in [0.0, 5e-6, 6.5e-6]:
    measured = run(
        Scene(f"D = {D}", 6.0, k2=215.0, c2=1e7, D=D, C=0.36), Method(Radau, rtol=rtol, atol=1e-17, max_step=0.02)
    )
    print(D, *(measured[name] for name in ("E1max", "force_max_primary", "impacts_primary", "longest_contact")))
