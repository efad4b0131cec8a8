"""Mixtures: all pairs of beads of several materials and sizes, and walls, in one input.

Types of bodies are numbered, beads first. A program takes the law of each pair, or e of each pair
with a modulus of each type, or a table. Every pair of two beads, of a bead and itself, and of a
bead and a wall has to be there.
"""

from __future__ import annotations

import itertools
import math
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike
from scipy.optimize import lsq_linear

from .. import _library
from .._library import Floats, InputError, NumericalError, UsageError, whole
from ..case import Case, number
from .codes import (
    MEANING,
    OF_WALLS,
    RUNS,
    STEPS,
    FileTemplate,
    Fit,
    base_of,
    checked,
    comment,
    fits,
    not_judged,
    pair_of,
    radii_of,
    rank,
    refuse_shapes,
    rows_of,
    solved,
)
from .contact_laws import Twin
from .targets import TARGETS, TEMPLATES, Target

#: Relative error of masses: reduced masses are often given with few digits
ROUNDING = 1e-3
#: Most bodies, so that a matrix can be read
MOST = 40
#: Keys that all pairs must have in common, and their values where they are not given
COMMON = {"impact.temperature": None, "impact.gravity": 0.0, "contact.law": None}
#: Compliance of a body that a fit makes rigid, relative to that of a contact
RIGID = 1e-3


@dataclass(frozen=True)
class Body:
    """A type of beads, or a wall, whose radius is infinite."""

    material: str
    radius: float
    #: How a wall is a layer or a plate, empty for a half space
    layer: str = ""

    def __str__(self) -> str:
        """Material and size, as a comment of a file has them."""
        if self.radius < math.inf:
            return f"{self.material}, radius {self.radius:.6g} m"
        return f"wall of {self.material}{self.layer}"

    @property
    def short(self) -> str:
        """A name for a legend."""
        if self.radius < math.inf:
            return f"{self.material} {1e3 * self.radius:.4g} mm"
        return f"wall of {self.material}"


@dataclass(frozen=True)
class Mixture:
    """Input of a program for a mixture; `str` is the first of its files."""

    target: str
    #: Types in the order of their numbers, which begin with 1; beads first
    bodies: Sequence[Body]
    #: Results over `velocity` by the numbers of a pair, with e_law and contact_time_law if the
    #: program has a law of its own
    pairs: Mapping[tuple[int, int], xr.Dataset]
    #: Files by the ends of their names
    texts: Mapping[str, str]
    header: Sequence[str]
    #: Largest misfit of e of the program to that of vcor among all pairs
    misfit: float

    def __str__(self) -> str:
        return next(iter(self.texts.values()))

    def figure(self) -> Any:
        """Figure (matplotlib) of e of all pairs against the velocity, and of the program's law."""
        from ..plot import HEIGHT, PAGE, drawn

        kinds = dict.fromkeys(self.bodies[j - 1].material for _, j in self.pairs)
        panels = [[at for at in self.pairs if self.bodies[at[1] - 1].material == one]
                  for one in kinds]  # fmt: skip
        rows = max(map(len, panels))
        with drawn(PAGE, len(panels) * max(HEIGHT - 1.5, 0.5 * rows + 2), len(panels), 1,
                   squeeze=False, sharex=True) as (made, axes):  # fmt: skip
            for pairs, axis in zip(panels, axes.flat, strict=True):
                for n, (i, j) in enumerate(pairs):
                    curve = self.pairs[i, j]
                    names = f"{i}-{j}: {self.bodies[i - 1].short}, {self.bodies[j - 1].short}"
                    # beyond the styles of the cycle a marker tells
                    marker = ["", ".", "x", "+"][n // 8 % 4]
                    (line,) = axis.plot(curve.velocity, curve[curve.attrs["e"]], marker=marker,
                                        label=names)  # fmt: skip
                    if "e_law" in curve:
                        axis.plot(curve.velocity, curve.e_law, ls="", marker="s", ms=2.5,
                                  color=line.get_color(), mfc="none")  # fmt: skip
                if any("e_law" in self.pairs[at] for at in pairs):
                    axis.plot([], [], ls="", marker="s", ms=2.5, color="0.3", mfc="none",
                              label=f"law for {self.target}")  # fmt: skip
                middle, half = np.mean(axis.get_ylim()), np.ptp(axis.get_ylim()) / 2
                axis.set_ylim(middle - max(half, 0.01), middle + max(half, 0.01))
                axis.set(xscale="log", ylabel="coefficient of restitution")
                axis.legend(loc="center left", bbox_to_anchor=(1.01, 0.5))
            axes.flat[-1].set_xlabel("velocity [m/s]")
        return made


def mixture(
    beads: Sequence[tuple[Mapping[str, Any], float]],
    walls: Sequence[Mapping[str, Any] | tuple[Mapping[str, Any], float]] = (),
    **groups: Mapping[str, Any],
) -> list[Case]:
    """Cases of all pairs of a mixture, for `export`.

    Parameters
    ----------
    beads
        Keys of the group &material and radius [m] of each type of beads.
    walls
        Keys of the group &material of each wall, or these and its thickness [m].
    groups
        More of the cases by the names of their groups, as for `pair`; thickness, base and waves of
        `plate` are those of all walls.

    Returns
    -------
    list of Case
        Every type with itself and with each other, and each with every wall.
    """
    try:
        known = [(dict(material), float(radius)) for material, radius in beads]
        pairs = [(one, {}) if isinstance(one, Mapping) else (one[0], {"thickness": float(one[1])})
                 for one in walls]  # fmt: skip
        flat = [(dict(material), math.inf) for material, _ in pairs]
        plate = dict(groups.get("plate", {}))
    except (TypeError, ValueError, IndexError, KeyError):
        raise InputError("expected beads such as (material, radius in m), and walls such as "
                         "material or (material, thickness in m), each material by the keys of its "
                         "group") from None  # fmt: skip
    if not known:
        raise InputError("expected one type of beads or more")
    if "target" in groups:
        raise InputError("found the group target, expected none: the bodies of a mixture have no "
                         "structure behind them")  # fmt: skip
    bodies = list(enumerate([*known, *flat], 1))
    couples = [two for two in itertools.combinations_with_replacement(bodies, 2)
               if two[0][0] <= len(known)]  # fmt: skip
    of_beads = {key: value for key, value in plate.items() if key not in OF_WALLS}
    plates = [*[of_beads] * len(known), *(plate | own for _, own in pairs)]
    return [
        pair_of([one, other], (radius, second), 1.0, None, {**groups, "plate": plates[j - 1]},
                f"pair_{i}-{j}")
        for (i, (one, radius)), (j, (other, second)) in couples
    ]  # fmt: skip


def export_mixture(
    cases: Sequence[Case],
    target: str,
    velocities: ArrayLike,
    *,
    quantity: str = "cor_sphere",
    law: int = 1,
    threads: int | None = None,
) -> Mixture:
    """Input of a program for all pairs of a mixture; parameters as for `export`."""
    given = checked(target, velocities, quantity)
    program = TARGETS[target]
    if program.mixture not in WRITERS:
        able = ", ".join(name for name, one in TARGETS.items() if one.mixture in WRITERS)
        raise UsageError(f"{target}: {program.mixture}: expected one of {able}, or one pair of "
                         "bodies")  # fmt: skip
    bodies, table = _matrix(cases)
    _refuse_contradictions(cases)
    curves = {at: solved(case, given, quantity, threads) for at, case in table.items()}
    masses = _masses(bodies, table, curves)
    lines = _header(program, bodies, table, curves, masses)
    middle = float(np.sqrt(given[0] * given[-1]))
    values = {"velocity": f"{middle:.6g}", "n": len(bodies), "beads": len(masses)}
    write = WRITERS[program.mixture]
    return write(program, bodies, table, curves, masses, law, lines, values)


def _matrix(cases: Sequence[Case]) -> tuple[list[Body], dict[tuple[int, int], Case]]:
    """Bodies, beads first, and the case of each pair of their numbers; complete or refused."""
    both = [_bodies(case) for case in cases]
    found = list(dict.fromkeys(body for two in both for body in two))
    bodies = sorted(found, key=lambda body: body.radius == math.inf)
    if len(bodies) > MOST:
        raise UsageError(f"found {len(bodies)} types of bodies, expected at most {MOST}")
    table: dict[tuple[int, int], Case] = {}
    for case, two in zip(cases, both, strict=True):
        i, j = sorted(bodies.index(body) + 1 for body in two)
        if (i, j) in table:
            raise InputError(f"{case.name}: found '{bodies[i - 1]}' with '{bodies[j - 1]}' as in "
                             f"{table[i, j].name}, expected each pair once")  # fmt: skip
        table[i, j] = case
    for i, one in enumerate(bodies, 1):
        for j, other in enumerate(bodies[i - 1 :], i):
            if (i, j) not in table and one.radius < math.inf:
                raise InputError(f"found no case of '{one}' with '{other}', expected every pair of "
                                 "the mixture; a table of sizes makes them all, and so does "
                                 "vcor.mixture in Python")  # fmt: skip
    return bodies, dict(sorted(table.items()))


def _bodies(case: Case) -> list[Body]:
    """The two bodies of a case."""
    radius, other = radii_of(case)
    layer = ""
    thickness = number(case, "plate.thickness", 2 * number(case, "plate.half_thickness", 0.0))
    if other == 0 and (base_of(case) or (thickness and case["plate.waves"] != "none")):
        layer = f", {thickness:.6g} m thick{', ' * bool(base_of(case))}{base_of(case)}"
    ends = (radius, other or math.inf)
    names = (case["sphere.material"], case["plate.material"])
    first, second = (
        # radii of one type may be written with different digits
        Body(str(name), float(f"{end:.9g}"), layer if end == math.inf else "")
        for name, end in zip(names, ends, strict=True)
    )
    return [first, second]


def _refuse_contradictions(cases: Sequence[Case]) -> None:
    """Refuse materials of one name that differ, and impacts under different conditions."""
    known: dict[str, tuple[str, str]] = {}
    for case in cases:
        text = case.text(complete=True)
        for found in re.finditer(r"(?ms)^&material\n   name = ('(?:[^']|'')*')\n.*?^/$", text):
            group, name = known.setdefault(found[1], (found[0], case.name))
            if group != found[0]:
                raise InputError(f"{case.name}: found another material {found[1]} than in {name}, "
                                 "expected one material of each name")  # fmt: skip
        for address, default in COMMON.items():
            value, other = (one[address] or default for one in (case, cases[0]))
            if value != other and None not in (value, other):
                raise InputError(f"{case.name}: found {address} = {value}, and {other} in "
                                 f"{cases[0].name}; expected the same in all pairs")  # fmt: skip


def _masses(
    bodies: Sequence[Body],
    table: Mapping[tuple[int, int], Case],
    curves: Mapping[tuple[int, int], xr.Dataset],
) -> list[float]:
    """Mass of each type of beads [kg], with which all reduced masses agree."""
    n = sum(body.radius < math.inf for body in bodies)
    masses = [2 * float(curves[i, i].attrs["mass"]) for i in range(1, n + 1)]
    for (i, j), curve in curves.items():
        wanted = 1 / (1 / masses[i - 1] + (1 / masses[j - 1] if j <= n else 0))
        if not abs(curve.attrs["mass"] / wanted - 1) <= ROUNDING:
            raise InputError(
                f"{table[i, j].name}: found sphere.mass = {curve.attrs['mass']:.6g} kg, expected "
                f"{wanted:.6g} kg, the reduced mass by {table[i, i].name}"
                + (f" and {table[j, j].name}" if j <= n else "")
            )
    return masses


def _header(
    program: Target,
    bodies: Sequence[Body],
    table: Mapping[tuple[int, int], Case],
    curves: Mapping[tuple[int, int], xr.Dataset],
    masses: Sequence[float],
) -> list[str]:
    """Validity and conditions of the numbers, as lines of a head."""
    case, curve = next(iter(table.values())), next(iter(curves.values()))
    temperature, gravity = case["impact.temperature"], case["impact.gravity"]
    v = curve.velocity.values
    lines = [
        f"vcor {_library.__version__}, for {program.name}: a mixture of {len(bodies)} types",
        f"e: {MEANING[curve.attrs['quantity']]} ({curve.attrs['quantity']}); contact ends where "
        "the force returns to zero",
        *(f"type {i}: {body}" + (f", mass {masses[i - 1]:.6g} kg" if i <= len(masses) else "")
          for i, body in enumerate(bodies, 1)),
        f"contact law {case['contact.law'] or 'boltzmann'}, temperature "
        + (f"{temperature:g} K" if temperature else "not given")
        + (f", gravity {gravity:g} m/s2" if gravity else ""),
        f"velocities: {v[0]:g} to {v[-1]:g} m/s",
        *not_judged(list(table.values())),
        "pair    e at the first and last velocity, validity",
    ]  # fmt: skip
    for (i, j), one in curves.items():
        e = one[one.attrs["e"]].values
        exact = f"; exact mechanics: {one.attrs['exact']}" if "exact" in one.attrs else ""
        lines.append(f"{i}-{j}:  {e[0]:.5f}  {e[-1]:.5f}  {one.attrs['validity']}{exact}")
    return lines


def _tabulated(
    program: Target,
    bodies: Sequence[Body],
    table: Mapping[tuple[int, int], Case],
    curves: Mapping[tuple[int, int], xr.Dataset],
    masses: Sequence[float],
    law: int,
    lines: list[str],
    values: dict[str, Any],
) -> Mixture:
    """e(v) of all pairs in one table."""
    rows, shown = [], {}
    for (i, j), curve in curves.items():
        one = shown[i, j] = curve.isel(velocity=slice(None, None, 2))
        columns = [one[name].values for name in ("e", "e_sphere", "contact_time", "max_force")]
        text = rows_of(one.velocity.values, *columns)
        rows += [f"{i},{j},{line}" for line in text.splitlines()]
    lines = [*lines, "numbers of the two types, v [m/s], e, e_sphere [1], t_c [s], F_max [N]"]
    values |= {"rows": "\n".join(rows)}
    return Mixture(program.name, bodies, shown, _files(program, lines, values), lines, 0.0)


def _by_laws(
    program: Target,
    bodies: Sequence[Body],
    table: Mapping[tuple[int, int], Case],
    curves: Mapping[tuple[int, int], xr.Dataset],
    masses: Sequence[float],
    law: int,
    lines: list[str],
    values: dict[str, Any],
) -> Mixture:
    """A law of the program for all pairs, with the numbers of each."""
    found = {at: fits(case, program, curves[at]) for at, case in table.items()}
    for case in table.values():
        refuse_shapes(case, program)
    choices = []
    for k, entry in enumerate(program.laws):
        some = {at: fit for at, laws in found.items() if (fit := laws[k])}
        if len(some) == len(found) and (program.mixture == "pairs" or entry["law"] == "hertz"):
            scale, modulus = _moduli(program, bodies, table, curves, some)
            times = [
                np.abs(fit[1].time * scale[at] / curves[at].contact_time.values - 1).max()
                for at, fit in some.items()
            ]
            worst = max(fit[1].misfit for fit in some.values())
            choices.append((worst, max(times), k, some, scale, modulus))
    if not choices:
        raise NumericalError(f"{program.name} has no law for all pairs of this mixture")
    choices.sort(key=lambda one: rank(one[0], one[1]))
    misfit, time_misfit, _, some, scale, modulus = choices[
        whole(law, "law", 1, len(choices)) - 1
    ]  # fmt: skip
    twin: Twin = next(iter(some.values()))[1]
    durations = {at: fit[1].time * scale[at] for at, fit in some.items()}
    step = min(float(time.min()) for time in durations.values()) / STEPS
    kept = slice(None, None, 2)
    shown = {at: curve.assign(e_law=("velocity", some[at][1].cor),
                              contact_time_law=("velocity", durations[at])).isel(velocity=kept)
             for at, curve in curves.items()}  # fmt: skip
    lines = [
        *lines,
        f"law: {twin.law.name}; {twin.law.end}",
        f"largest misfit of that law to vcor in all pairs: {misfit:.2g} in e, "
        f"{100 * time_misfit:.2g} % in the contact time",
        "misfit in e by pair: "
        + ", ".join(f"{i}-{j} {fit[1].misfit:.1g}" for (i, j), fit in some.items()),
        *(["one modulus of each type: the contact times of its pairs are a compromise"]
          if program.mixture == "types" else []),
        f"time step: {STEPS} in the shortest contact, {step:.3g} s, for e to 0.001; 50 for 0.01",
        "laws by their misfits in e and contact time:",
        *(f"  {n}. {one.law.name}, {one.law.end}: {worst:.2g}, {100 * time:.2g} %"
          for n, (worst, time, _, every, _, _) in enumerate(choices, 1)
          for one in [next(iter(every.values()))[1]]),
        *program.notes,
    ]  # fmt: skip
    beads = len(masses)
    radii = [body.radius for body in bodies[:beads]]
    values |= {
        "step": f"{step:.6g}",
        "duration": f"{RUNS * max(float(time.max()) for time in durations.values()):.6g}",
        "size": f"{8 * max(radii):g}",
        "radius": f"{min(radii):.9g}",
        **PARTS[program.name](bodies, table, some, masses, modulus),
    }
    return Mixture(program.name, bodies, shown, _files(program, lines, values), lines, misfit)


WRITERS = {"table": _tabulated, "pairs": _by_laws, "types": _by_laws}


def _moduli(
    program: Target,
    bodies: Sequence[Body],
    table: Mapping[tuple[int, int], Case],
    curves: Mapping[tuple[int, int], xr.Dataset],
    laws: Mapping[tuple[int, int], Fit],
) -> tuple[dict[tuple[int, int], float], Floats]:
    """Factor of the contact times, and a modulus of each type where a pair has none of its own.

    A pair is as compliant as both of its bodies, 1/E*_ij = c_i + c_j: the least squares of
    (c_i + c_j) E*_ij = 1. Young's modulus of a type is (1 - nu^2)/c_i; e does not depend on it.
    """
    if program.mixture == "pairs":
        return dict.fromkeys(laws, 1.0), np.empty(0)
    rows = np.zeros((len(laws), len(bodies)))
    for row, ((i, j), (_, twin, _)) in zip(rows, laws.items(), strict=True):
        wanted = 0.75 * twin.stiffness / math.sqrt(curves[i, j].attrs["radius"])
        if program.name == "yade" and bodies[j - 1].radius == math.inf:
            # it takes half of the bead's radius on a wall
            wanted *= math.sqrt(2)
        row[i - 1] += wanted
        row[j - 1] += wanted
    least = RIGID / rows.max(axis=0)
    compliance = lsq_linear(rows, np.ones(len(rows)), bounds=(least, np.inf)).x
    # contact times go with E*^(-2/5)
    stretched = (rows @ compliance) ** 0.4
    poisson = np.zeros(len(bodies))
    for (i, j), case in table.items():
        for at, body in ((i, "sphere"), (j, "plate")):
            poisson[at - 1] = number(case, f"{case[f'{body}.material']}.poisson_ratio", 0.0)
    young = (1 - poisson**2) / compliance
    return dict(zip(laws, stretched, strict=True)), np.array([young, poisson])


def _files(program: Target, lines: Sequence[str], values: Mapping[str, Any]) -> dict[str, str]:
    """The files of a program from its templates."""
    texts = {}
    for path in sorted(TEMPLATES.glob(f"{program.name}_mixture.*.txt")):
        ending = Path(path.stem).suffix
        head = "\n".join(comment(line, ending) for line in lines)
        template = FileTemplate(path.read_text(encoding="utf-8"))
        texts[ending] = template.substitute(values, header=head)
    return texts


# ------------------------------------------------------------------- what is written, by program


Parts = dict[str, str]
_Laws = Mapping[tuple[int, int], Fit]
_Cases = Mapping[tuple[int, int], Case]


def _lammps(bodies: Sequence[Body], table: _Cases, laws: _Laws, masses: Sequence[float],
            modulus: Floats) -> Parts:  # fmt: skip
    """Parts of the LAMMPS template: groups, pair_coeff lines, walls, radii and masses."""
    n, law = len(masses), {at: f"{fit[0]} tangential linear_nohistory 0 0"
                           for at, fit in laws.items()}  # fmt: skip
    return {
        "groups": "\n".join(f"group       type{i} type {i}" for i in range(1, n + 1)),
        "pairs": "\n".join(f"pair_coeff  {i} {j} {law[i, j]}" for i, j in law if j <= n),
        "walls": "\n".join(
            f'if "$b == {j}" then "fix wall{j}_{i} type{i} wall/gran granular {law[i, j]} '
            'zplane 0 NULL"'
            for i, j in law if j > n
        ),
        "types": "\n".join(
            f"variable    r{i} equal {body.radius:.9g}\nvariable    m{i} equal {mass:.9g}"
            for i, (body, mass) in enumerate(zip(bodies, masses, strict=False), 1)
        ),
    }  # fmt: skip


def _symmetric(laws: _Laws, n: int, key: str, nothing: str = "1") -> list[list[str]]:
    """A number of all pairs as a full matrix; walls, which never meet, have `nothing`."""
    return [[laws[min(i, j), max(i, j)][2][key] if (min(i, j), max(i, j)) in laws else nothing
             for j in range(1, n + 1)] for i in range(1, n + 1)]  # fmt: skip


def _liggghts(bodies: Sequence[Body], table: _Cases, laws: _Laws, masses: Sequence[float],
              modulus: Floats) -> Parts:  # fmt: skip
    """Parts of the LIGGGHTS template: moduli, matrix of e, sizes and walls by type."""
    n, beads = len(bodies), len(masses)
    largest = max(body.radius for body in bodies[:beads])
    rows = [" ".join(row) for row in _symmetric(laws, n, "e")]
    limit = next(iter(laws.values()))[2]["limit"]
    return {
        "young": " ".join(f"{one:.6g}" for one in modulus[0]),
        "poisson": " ".join(f"{one:.6g}" for one in modulus[1]),
        "cor": " &\n            ".join(rows),
        "zeros": " ".join(["0"] * n**2),
        "limit": limit,
        "parked": "\n".join(f"create_atoms {i} single {2.5 * i * largest:g} 0 {6 * largest:g} "
                            "units box" for i in range(1, beads + 1)),
        "sizes": "\n".join(
            f"set         type {i} diameter {2 * body.radius:.9g} mass {mass:.9g}"
            for i, (body, mass) in enumerate(zip(bodies, masses, strict=False), 1)
        ),
        "end": f"{(8 + 2.5 * beads) * largest:g}",
        "first": str(beads + 1),
        "second": str(beads + 2),
        "walls": "\n".join(
            f'if "$b == {j}" then "fix wall{j} all wall/gran model hertz tangential history '
            f'primitive type {j} zplane 0{limit}"'
            for j in range(beads + 1, n + 1)
        ),
        "types": "\n".join(f"variable    r{i} equal {body.radius:.9g}"
                           for i, body in enumerate(bodies[:beads], 1)),
    }  # fmt: skip


def _yade(bodies: Sequence[Body], table: _Cases, laws: _Laws, masses: Sequence[float],
          modulus: Floats) -> Parts:  # fmt: skip
    """Parts of the YADE template: matches of e by pair of materials, radii and masses."""
    # en is that of the law without the clipping, which YADE allows for by itself
    matches = ", ".join(f"({i - 1}, {j - 1}, {float(fit[1].cor[0]):.9g})"
                        for (i, j), fit in laws.items())  # fmt: skip
    return {
        "matches": matches,
        "young": ", ".join(f"{one:.6g}" for one in modulus[0]),
        "poisson": ", ".join(f"{one:.6g}" for one in modulus[1]),
        "radii": ", ".join(f"{body.radius:.9g}" for body in bodies[: len(masses)]),
        "masses": ", ".join(f"{mass:.9g}" for mass in masses),
    }


def _mercurydpm(bodies: Sequence[Body], table: _Cases, laws: _Laws, masses: Sequence[float],
                modulus: Floats) -> Parts:  # fmt: skip
    """Parts of the MercuryDPM template: a species by type, and those of the pairs."""
    species = next(iter(laws.values()))[2]["species"]
    n = len(masses)
    density = [mass / (4 / 3 * math.pi * body.radius**3)
               for body, mass in zip(bodies, masses, strict=False)]  # fmt: skip
    lines = []
    for i in range(1, len(bodies) + 1):
        # of a wall any density will do
        lines += [f"    species.setDensity({density[i - 1] if i <= n else density[0]:.9g});",
                  f"    species.{laws[min(i, n), i][0]};",
                  f"    auto type{i} = dpm.speciesHandler.copyAndAddObject(species);"]  # fmt: skip
    lines += [f"    dynamic_cast<{species}MixedSpecies *>("
              f"dpm.speciesHandler.getMixedObject(type{i}, type{j}))->{fit[0]};"
              for (i, j), fit in laws.items() if i < j]  # fmt: skip
    return {
        "species": species,
        "lines": "\n".join(lines),
        "radii": ", ".join(f"{body.radius:.9g}" for body in bodies[:n]),
        "all": ", ".join(f"type{i}" for i in range(1, len(bodies) + 1)),
    }


def _mfix(bodies: Sequence[Body], table: _Cases, laws: _Laws, masses: Sequence[float],
          modulus: Floats) -> Parts:  # fmt: skip
    """Lines of the MFIX template: diameters, moduli, e of pairs and of the wall.

    UsageError: more than one kind of walls.
    """
    n = len(masses)
    if len(bodies) > n + 1:
        raise UsageError(f"mfix has one kind of walls, found {len(bodies) - n}")
    couples = [(i, j) for i in range(1, n + 1) for j in range(i, n + 1)]
    lines = [f"  d_p0({i}) = {2 * bodies[i - 1].radius:.9g}\n  e_young({i}) = "
             f"{modulus[0, i - 1]:.6g}\n  v_poisson({i}) = {modulus[1, i - 1]:.6g}"
             for i in range(1, n + 1)]  # fmt: skip
    if len(bodies) > n:
        lines.append(f"  ew_young = {modulus[0, n]:.6g}\n  vw_poisson = {modulus[1, n]:.6g}")
    lines.append("  ! pairs 1-1, 1-2, ...")
    lines += [f"  des_en_input({k}) = {laws[at][2]['e_mfix']}  ! {at[0]}-{at[1]}\n"
              f"  des_et_input({k}) = 1.0" for k, at in enumerate(couples, 1)]  # fmt: skip
    if len(bodies) > n:
        lines += [f"  des_en_wall_input({i}) = {laws[i, n + 1][2]['e_mfix']}\n"
                  f"  des_et_wall_input({i}) = 1.0" for i in range(1, n + 1)]  # fmt: skip
    return {"lines": "\n".join(lines)}


PARTS = {"lammps": _lammps, "liggghts": _liggghts, "yade": _yade, "mercurydpm": _mercurydpm,
         "mfix": _mfix}  # fmt: skip
