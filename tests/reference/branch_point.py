"""Where the force of a contact with one restitution e at every speed has its branch point once the contact is disturbed.

The force depends on h(S, z'), with S = v^2 G(h), z' = v h (docs/theory.md, "One restitution at every speed"): D = 0 at h* > 1, where S < 0. The
undisturbed collision passes there at complex times: with z and t on the ray e^(2 pi i/5) it is a real motion whose force pulls,
dt = dh / (5/4 (2 |G|)^(3/5) (1 + chi h)) in units of depth over speed. Prints e, the branch point on the clock t/T = u^2 (3 - 2u), and the
rate rho at which an interpolant on n nodes converges, rho^-n.
"""

import mpmath as mp

mp.mp.dps = 30


def branch_point(e):
    ratio = (1 - e) / (1 + e)
    guess = ratio * (3 - ratio**2) / (1 - ratio**2)
    chi = 2 * mp.findroot(lambda a: mp.coth(a) - 1 / a - ratio, guess) / (1 + e)
    G = lambda h: (chi * (1 - h) - mp.log((1 + chi) / (1 + chi * h))) / chi**2
    D = lambda h: 2 * (1 + chi * h) * G(h) + h**2
    last = mp.findroot(D, (mp.mpf(1), mp.mpf(4)), solver="bisect", tol=1e-25)
    pace = lambda h: 1 / (mp.mpf(5) / 4 * (2 * abs(G(h))) ** 0.6 * (1 + chi * h))
    near = mp.mpf(10) ** -20  # both ends of a collision are integrable singularities
    # With h = 1 + g^(5/2) the first is none.
    along = mp.quad(lambda g: mp.mpf(5) / 2 * g**1.5 * pace(1 + g**2.5), [mp.mpf(10) ** -9, (last - 1) ** 0.4])
    duration = mp.quad(pace, [-e + near, -e / 2, 0, 0.5, 1 - near])
    time = along / duration * mp.exp(2j * mp.pi / 5)
    u = mp.findroot(lambda u: u * u * (3 - 2 * u) - time, mp.mpc(0.2, 0.2))
    z = 2 * u - 1
    return u, max(abs(z + root) for root in (mp.sqrt(z * z - 1), -mp.sqrt(z * z - 1)))


for e in ("0.3", "0.5", "0.7", "0.9"):
    u, rho = branch_point(mp.mpf(e))
    print(e, mp.nstr(u, 4), mp.nstr(rho, 4))
