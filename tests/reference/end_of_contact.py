"""End of the contact of a body by waves: g(nu, s, n) of `advance` in src/vcor/solver/coupled/end.f90.

A body, whose profile is h = C x^n in the coordinate of the springs, is withdrawn from an elastic half space, on which
it has rested, at the speed V. Without waves its contact would end when its approach z is 0, at the time t_s; it ends
g L/c before, where L^(n-1) = V/(C c) (of a paraboloid r^2/(2 R) L = R V/c), and s is the part of the body in the local
compliance. Here C = V = c = 1, the motion is z = (2 T/pi) cos(pi t/(2 T)) with T = 8, and the same row of springs and
hats as in the solver is marched by convolution quadrature. Springs come into contact and leave it one by one; what
they miss at the edge is not added, so that there must be many.

    python end_of_contact.py [nu s n]        # one body, or the table below; half a minute each

Of a paraboloid the compression on the axis ends as the power 3/2 of the time left, or as a line before that. The end by
a parabola through u^(2/3) and by one through u, both of values up to 0.08 before it, and `advance`. Under a blunter
body the pressure on the axis ends before that around it; there it is the end of the force, as the power 2 of the time
left or, under a soft body, 3/2, by parabolas through F^(1/2) and F^(2/3):

    nu 0.3, s 0.0, n 2     0.0619  0.0642     0.061
    nu 0.3, s 0.3, n 2     0.1428  0.1514     0.141
    nu 0.3, s 0.6, n 2     0.1681  0.1772     0.171
    nu 0.3, s 0.9, n 2     0.0579  0.0666     0.063
    nu 0.0, s 0.3, n 2     0.1673  0.1749     0.161
    nu 0.3, s 0.0, n 2.5   0.1773  0.1814     0.181
    nu 0.3, s 0.0, n 4     0.3602  0.3671     0.362
    nu 0.3, s 0.5, n 4     0.3049  0.3130     0.320
    nu 0.5, s 0.0, n 4     0.2784  0.2932     0.294
    nu 0.0, s 0.3, n 3     0.3632  0.3700     0.374
    nu 0.3, s 0.0, n 6     0.4492  0.4687     0.462
"""

import sys

import numpy as np
from numpy.polynomial.legendre import leggauss

BETA = 1.5
DIFFERENCES = 2 * BETA * np.array([BETA + 2, -4, 2 - BETA])
INTEGRALS = np.array([(BETA + 1) ** 2, 2 * (BETA**2 - 1), (BETA - 1) ** 2])
WRAP = 1e-7
T = 8.0
STEPS, PARTS = 3200, 40
BODIES = (
    *((0.3, 0.0, 2.0), (0.3, 0.3, 2.0), (0.3, 0.6, 2.0), (0.3, 0.9, 2.0), (0.0, 0.3, 2.0)),
    *((0.3, 0.0, 2.5), (0.3, 0.0, 4.0), (0.3, 0.5, 4.0), (0.5, 0.0, 4.0), (0.0, 0.3, 3.0), (0.3, 0.0, 6.0)),
)


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
    """Cosine transforms of the functions dual to the hats, shape (hats, size of k)."""
    hats = len(node)
    mass, dual = np.zeros((hats, hats)), np.zeros((hats, len(k)))
    for i in range(hats - 1):
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


def advance(nu: float, share: float, power: float) -> tuple[float, float]:
    """The time between the end and t_s by both laws of the compression."""
    # the end of a blunt body depends on more of them
    hats = 32 if power <= 2 else 48
    step = 2 * T * 1.02 / STEPS
    radius = 1.2 * (2 * T / np.pi) ** (1 / power)
    node = radius * (np.arange(hats) / (hats - 1)) ** 1.5
    part = np.repeat(np.diff(node) / PARTS, 2 * PARTS)
    inside = (np.repeat(np.arange(PARTS) + 0.5, 2) + np.tile([-0.5, 0.5], PARTS) / np.sqrt(3)) / PARTS
    x = (node[:-1, None] + np.outer(np.diff(node), inside)).ravel()
    values = np.zeros((len(x), hats))
    element = np.repeat(np.arange(hats - 1), 2 * PARTS)
    values[np.arange(len(x)), element] = 1 - np.tile(inside, hats - 1)
    values[np.arange(len(x)), element + 1] = np.tile(inside, hats - 1)

    p = laplace_variables(step)
    k, weight = wavenumbers(p, radius, 5 / node[1])
    dual = duals(node, k)
    response = np.empty((hats * hats, len(p)), complex)
    products = (dual[:, None] * dual[None]).reshape(hats * hats, -1) * (weight / np.pi)
    for first in range(0, len(p), 100):
        response[:, first : first + 100] = products @ excess(nu, k[:, None], p[None, first : first + 100])
    weights = np.fft.irfft(np.conj(response), n=STEPS, axis=1) * WRAP ** (-np.arange(STEPS) / STEPS)
    weights = weights.reshape(hats, hats, STEPS)
    now = weights[:, :, 0]
    later = weights[:, :, ::-1].transpose(0, 2, 1).reshape(hats, -1)

    local = 1 / (1 - share)
    forces, axis = np.zeros((STEPS, hats)), np.zeros(STEPS)
    pushes = np.zeros(len(x), bool)
    for n in range(1, STEPS):
        past = later[:, hats * (STEPS - 1 - n) : hats * (STEPS - 1)] @ forces[:n].ravel()
        gap = 2 * T / np.pi * np.sin(np.pi * n * step / (2 * T)) - x**power - values @ past
        for _ in range(100):
            own = values * (part * pushes)[:, None]
            force = np.linalg.solve(np.eye(hats) + own.T @ values @ now / local, own.T @ gap / local)
            u = gap - values @ (now @ force)
            if ((u > 0) == pushes).all():
                break
            pushes = u > 0
        forces[n] = force
        axis[n] = u[0] + (u[0] - u[1]) * x[0] ** power / (x[1] ** power - x[0] ** power)
        if n > STEPS // 2 and not pushes.any():
            break
    last = n - 1
    series, laws = (axis, (2 / 3, 1.0)) if power <= 2 else (forces.sum(axis=1), (1 / 2, 2 / 3))
    ends = []
    for law in laws:
        places = np.array([last - 3, last - 9, last - 15])
        line = np.polyfit((2 * T - places * step), series[places] ** law, 2)
        roots = np.roots(line)
        ends.append(float(min(roots.real, key=lambda root: abs(root - (2 * T - last * step)))))
    return ends[0], ends[1]


def main() -> None:
    """Print both times."""
    bodies = BODIES if len(sys.argv) < 4 else (tuple(map(float, sys.argv[1:4])),)
    for nu, share, power in bodies:
        print(f"nu {nu:3.1f}, s {share:3.1f}, n {power:3.1f}: %.4f %.4f" % advance(nu, share, power), flush=True)


if __name__ == "__main__":
    main()
