"""A frequency response of one's own, with pandas and matplotlib."""

import matplotlib.pyplot as plt
import numpy as np

import retune as rt

damper = rt.SSVI(60, k2=584, c2=95, D=0.029, C=1.1)
problem = rt.Problem(rt.Structure(m1=1000, c1=452, k1=3.95e4), damper, P=800, window=(50, 100))
response = problem.sweep(omega=np.linspace(5, 8, 151)).to_pandas()
ax = response.plot(x="f_Hz", y=["E1max", "E1max_none"], logy=True, ylabel="largest E1, J", xlabel="frequency, Hz")
ax.legend(["with the damper", "without"])
plt.savefig("response.svg")

worst = response.iloc[int(response.E1max.argmax())]
print(f"worst with the damper: {worst.E1max:.1f} J at {worst.f_Hz:.3f} Hz, {worst.impacts:.0f} impacts; without it {response.E1max_none.max():.0f} J")
assert worst.E1max < 0.5 * response.E1max_none.max()
