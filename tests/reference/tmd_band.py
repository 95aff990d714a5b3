"""The TMD whose worst steady E1max over omega = 5 to 8 rad/s is least, by golden sections: needs nothing but Python.

At the optimum the two peaks of E1max are level. For each c2 the k2 that levels them is found by halving, and of those the best c2.
Prints k2 (N/m), c2 (N s/m), E1max (J) and both peaks (rad/s), which crates/optim/tests/band.rs compares with.
"""

from decimal import Decimal, getcontext

getcontext().prec = 50
M1, C1, K1, P, M2 = map(Decimal, ("1000", "452", "39500", "800", "60"))


def energy(k2, c2, omega):
    u = omega * omega
    s, d = K1 - M1 * u, k2 - M2 * u
    real = s * d - u * C1 * c2 - M2 * u * k2
    imaginary = s * c2 + d * C1 - M2 * u * c2
    return P * P * (d * d + u * c2 * c2) / (real * real + u * imaginary * imaginary) * max(K1, M1 * u) / 2


def golden(f, a, b, steps):
    share = (Decimal(5).sqrt() - 1) / 2
    c, d = b - share * (b - a), a + share * (b - a)
    fc, fd = f(c), f(d)
    for _ in range(steps):
        if fc < fd:
            b, d, fd = d, c, fc
            c = b - share * (b - a)
            fc = f(c)
        else:
            a, c, fc = c, d, fd
            d = a + share * (b - a)
            fd = f(d)
    return (a + b) / 2


def peaks(k2, c2):
    places = [golden(lambda w: -energy(k2, c2, w), Decimal(a), Decimal(b), 50) for a, b in (("5", "6.1"), ("6.2", "7.5"))]
    return [(energy(k2, c2, w), w) for w in places]


def level(c2):
    low, high = Decimal(1900), Decimal(2300)
    for _ in range(50):
        k2 = (low + high) / 2
        lower, upper = peaks(k2, c2)
        if lower[0] > upper[0]:
            high = k2
        else:
            low = k2
    return k2


c2 = golden(lambda c2: peaks(level(c2), c2)[0][0], Decimal(110), Decimal(114), 32)
k2 = level(c2)
(value, lower), (_, upper) = peaks(k2, c2)
print(f"{k2:.6f} {c2:.5f} {value:.9f} {lower:.7f} {upper:.7f}")
