"""End of the contact of a round body by waves: g(nu, s) of `advance` in src/vcor/solver/coupled/end.f90.

A paraboloid r^2/(2 R) is withdrawn from an elastic half space, on which it has rested, at the speed V. Without waves
its contact would end when its approach z is 0, at the time t_s; it ends g R V/c^2 before, where s is the part of the
body in the local compliance. Here R = V = c = 1, the motion is z = (2 T/pi) cos(pi t/(2 T)) with T = 8, and
the same row of springs and hats as in the solver is marched by convolution quadrature. Springs come into contact and
leave it one by one; what they miss at the edge is not added, so that there must be many.

    python end_of_contact.py [nu s]        # one pair, or the table below; half a minute each

The compression on the axis ends as the power 3/2 of the time left, or as a line before that. The end by a parabola
through u^(2/3) and by one through u, both of values up to 0.08 before it, and `advance`:

    nu 0.3, s 0.0     0.0619  0.0642     0.061
    nu 0.3, s 0.3     0.1428  0.1514     0.141
    nu 0.3, s 0.6     0.1681  0.1772     0.171
    nu 0.3, s 0.9     0.0579  0.0666     0.063
    nu 0.0, s 0.3     0.1673  0.1749     0.161
"""

import sys

import numpy as np
from numpy.polynomial.legendre import leggauss

BETA = 1.5
DIFFERENCES = 2 * BETA * np.array([BETA + 2, -4, 2 - BETA])
INTEGRALS = np.array([(BETA + 1) ** 2, 2 * (BETA**2 - 1), (BETA - 1) ** 2])
WRAP = 1e-7
T = 8.0
STEPS, HATS, PARTS = 3200, 32, 40
PAIRS = ((0.3, 0.0), (0.3, 0.3), (0.3, 0.6), (0.3, 0.9), (0.0, 0.3))


def laplace_variables(step: float) -> np.ndarray:
    """Laplace variables of the steps, shape (STEPS/2 + 1)."""
    z = WRAP ** (1 / STEPS) * np.exp(2j * np.pi * np.arange(STEPS // 2 + 1) / STEPS)
    return np.polyval(DIFFERENCES[::-1], z) / (np.polyval(INTEGRALS[::-1], z) * step)


def excess(nu: float, k: np.ndarray, p: np.ndarray) -> np.ndarray:
    """Response L - 1 of a half space (see src/vcor/impact/response.f90)."""
    q = (1 - 2 * nu) / (2 * (1 - nu))
    y = (p / k) ** 2
    a, b = np.sqrt(1 + q * y), np.sqrt(1 + y)
    poly = 16 * (1 - q) + y * (24 - 16 * q + y * (8 + y))
    return 2 * (1 - q) * a * ((2 + y) ** 2 + 4 * a * b) / poly - 1


def wavenumbers(p: np.ndarray, radius: float, last: float) -> tuple[np.ndarray, np.ndarray]:
    """Nodes and weights of Gauss panels, short next to the poles."""
    start, length, k = [], [], 0.0
    least = abs(p).min()
    while k < last:
        near = (abs(p) > 0.8 * k) & (abs(p) < 2.2 * k)
        clear = (p.real * np.minimum(1, k / abs(p)))[near].min(initial=np.inf)
        panel = 0.5 * least if k == 0 else min(0.7 * max(k, least), 0.77 * clear, 6 / radius)
        start.append(k)
        length.append(panel)
        k += panel
    node, weight = leggauss(10)
    nodes = np.array(start)[:, None] + np.outer(length, (node + 1) / 2)
    return nodes.ravel(), np.outer(length, weight / 2).ravel()


def duals(node: np.ndarray, k: np.ndarray) -> np.ndarray:
    """Cosine transforms of the functions dual to the hats, shape (HATS, size of k)."""
    mass, dual = np.zeros((HATS, HATS)), np.zeros((HATS, len(k)))
    for i in range(HATS - 1):
        length = node[i + 1] - node[i]
        z = k * length / 2
        middle = k * (node[i] + length / 2)
        even = np.sinc(z / np.pi)
        odd = np.where(z < 0.05, z / 3 * (1 - z**2 / 10), (even - np.cos(z)) / np.maximum(z, 1e-300))
        even, odd = length * even * np.cos(middle), -length * odd * np.sin(middle)
        dual[i] += even - odd
        dual[i + 1] += even + odd
        mass[i : i + 2, i : i + 2] += length / 3 * np.array([[2, 1], [1, 2]])
    return np.linalg.solve(mass, dual)


def advance(nu: float, share: float) -> tuple[float, float]:
    """The time between the end and t_s by both laws of the compression."""
    step = 2 * T * 1.02 / STEPS
    radius = 1.2 * np.sqrt(2 * T / np.pi)
    node = radius * (np.arange(HATS) / (HATS - 1)) ** 1.5
    part = np.repeat(np.diff(node) / PARTS, 2 * PARTS)
    inside = (np.repeat(np.arange(PARTS) + 0.5, 2) + np.tile([-0.5, 0.5], PARTS) / np.sqrt(3)) / PARTS
    x = (node[:-1, None] + np.outer(np.diff(node), inside)).ravel()
    hats = np.zeros((len(x), HATS))
    element = np.repeat(np.arange(HATS - 1), 2 * PARTS)
    hats[np.arange(len(x)), element] = 1 - np.tile(inside, HATS - 1)
    hats[np.arange(len(x)), element + 1] = np.tile(inside, HATS - 1)

    p = laplace_variables(step)
    k, weight = wavenumbers(p, radius, 5 / node[1])
    dual = duals(node, k)
    response = np.empty((HATS * HATS, len(p)), complex)
    products = (dual[:, None] * dual[None]).reshape(HATS * HATS, -1) * (weight / np.pi)
    for first in range(0, len(p), 100):
        response[:, first : first + 100] = products @ excess(nu, k[:, None], p[None, first : first + 100])
    weights = np.fft.irfft(np.conj(response), n=STEPS, axis=1) * WRAP ** (-np.arange(STEPS) / STEPS)
    weights = weights.reshape(HATS, HATS, STEPS)
    now = weights[:, :, 0]
    later = weights[:, :, ::-1].transpose(0, 2, 1).reshape(HATS, -1)

    local = 1 / (1 - share)
    forces, axis = np.zeros((STEPS, HATS)), np.zeros(STEPS)
    pushes = np.zeros(len(x), bool)
    for n in range(1, STEPS):
        past = later[:, HATS * (STEPS - 1 - n) : HATS * (STEPS - 1)] @ forces[:n].ravel()
        gap = 2 * T / np.pi * np.sin(np.pi * n * step / (2 * T)) - x**2 - hats @ past
        for _ in range(100):
            own = hats * (part * pushes)[:, None]
            force = np.linalg.solve(np.eye(HATS) + own.T @ hats @ now / local, own.T @ gap / local)
            u = gap - hats @ (now @ force)
            if ((u > 0) == pushes).all():
                break
            pushes = u > 0
        forces[n] = force
        axis[n] = u[0] + (u[0] - u[1]) * x[0] ** 2 / (x[1] ** 2 - x[0] ** 2)
        if n > STEPS // 2 and not pushes.any():
            break
    last = n - 1
    ends = []
    for power in (2 / 3, 1.0):
        places = np.array([last - 3, last - 9, last - 15])
        line = np.polyfit((2 * T - places * step), axis[places] ** power, 2)
        roots = np.roots(line)
        ends.append(float(min(roots.real, key=lambda root: abs(root - (2 * T - last * step)))))
    return ends[0], ends[1]


def main() -> None:
    """Print both times."""
    pairs = PAIRS if len(sys.argv) < 3 else ((float(sys.argv[1]), float(sys.argv[2])),)
    for nu, share in pairs:
        print(f"nu {nu:4.2f}, s {share:4.2f}: %.4f %.4f" % advance(nu, share), flush=True)


if __name__ == "__main__":
    main()
