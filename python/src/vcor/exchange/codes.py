"""e(v) for other programs: input for discrete elements and physics engines, and what it costs.

`export_pair` solves a case at velocities and fits the contact law of a program to e and contact
times. A program is an entry of templates/programs.toml and the templates of its files.
"""

from __future__ import annotations

import contextlib
import math
import os
import re
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from string import Template
from typing import Any

import numpy as np
import xarray as xr
from numpy.typing import ArrayLike
from scipy.interpolate import PchipInterpolator

from .. import _library, _text
from .._coverage import unwarned
from .._library import (
    Floats,
    InputError,
    NoResultWarning,
    NumericalError,
    UsageError,
    ValidityWarning,
    numbers,
    whole,
)
from ..case import Case, as_case, number, radius_of
from .contact_laws import ACCURACY, LAWS, Twin
from .targets import TARGETS, TEMPLATES, Target

#: Shapes with a radius
SPHERES = ("sphere", "true_sphere")
#: Columns that an export needs
COLUMNS = ("cor", "cor_sphere", "cor_error", "cor_sphere_error", "contact_time", "max_force",
           "initial_energy", "validity", "validity_cause")  # fmt: skip
#: Meaning of e, and where its end of contact is
MEANING = {
    "cor_sphere": "speed of the sphere away from the plate at rest, divided by that towards it",
    "cor": "relative speed of the bodies after the impact, divided by that before",
}
#: Steps of a contact that are advised, and contacts that an input runs
STEPS, RUNS = 400, 3


#: How lines of a comment begin, by the end of the file's name; others: with #
COMMENTS = {".c": "// ", ".cpp": "// ", ".dat": "! ", ".xml": ""}


#: Text of a law, its parameters, and numbers for the templates
Fit = tuple[str, Twin, dict[str, str]]


@dataclass(frozen=True)
class Export:
    """Input for a program; `str` is the first of its files."""

    target: str
    #: Over `velocity`: e, e_sphere, contact_time, max_force; e_law and contact_time_law if the
    #: program has a law of its own
    table: xr.Dataset
    #: Files by the ends of their names
    texts: Mapping[str, str]
    header: Sequence[str]
    #: Largest misfit of the program's law or interpolation to e
    misfit: float
    #: Text of each law of the program and its end of contact, the best one first
    options: Mapping[str, Twin]

    def __str__(self) -> str:
        return next(iter(self.texts.values()))

    def figure(self) -> Any:
        """Figure (matplotlib) of e of vcor, and of the law of the program over it."""
        from ..plot import COLUMN, HEIGHT, _label_decades, drawn

        with drawn(COLUMN, HEIGHT) as (made, axis):
            name = str(next(iter(self.table.dims)))
            x, e = self.table[name].values, self.table[self.table.attrs["e"]].values
            fine = np.geomspace(x[0], x[-1], 200)
            axis.plot(fine, PchipInterpolator(np.log(x), e)(np.log(fine)), label="vcor", marker="")
            if "e_law" in self.table:
                axis.plot(x, self.table.e_law.values, label=f"law for {self.target}", ls="",
                          marker="s")  # fmt: skip
            what = "{long_name} [{units}]".format(**self.table[name].attrs)
            axis.set(xscale="log", xlabel=what, ylabel="coefficient of restitution")
            _label_decades(axis.xaxis)
            axis.legend()
        return made


def pair(
    materials: Mapping[str, Any] | Sequence[Mapping[str, Any]],
    radii: ArrayLike,
    *,
    velocity: float = 1.0,
    masses: Sequence[float] | None = None,
    **groups: Mapping[str, Any],
) -> Case:
    """Two beads, or a bead and a wall, as a case: reduced mass and curvature.

    Parameters
    ----------
    materials
        Keys of the group &material of both bodies, or of each.
    radii
        Radius of each bead [m]; one alone, or `math.inf` for the second: a wall.
    velocity
        Relative velocity of approach [m/s].
    masses
        Mass of each bead [kg]; None: of full spheres of the density of their material.
    groups
        More of the case by the names of its groups, such as `contact={"mechanics": "exact"}`.

    Returns
    -------
    Case
        The case, without waves.
    """
    both = [materials] * 2 if isinstance(materials, Mapping) else list(materials)
    return pair_of(both, radii, velocity, masses, groups, "pair.nml")


#: Keys of &plate that only a wall has
OF_WALLS = ("thickness", "half_thickness", "waves", "base", "extent")


def pair_of(
    both: Sequence[Mapping[str, Any]],
    radii: ArrayLike,
    velocity: float,
    masses: Sequence[float] | None,
    groups: Mapping[str, Any],
    title: str,
) -> Case:
    """A pair as `pair` makes it, with a name for messages."""
    try:
        first, second = np.append(np.asarray(radii, dtype=float), math.inf)[:2]
        beads = [(r, one) for r, one in zip((first, second), both, strict=True) if r < math.inf]
        weights = np.array([4 / 3 * math.pi * r**3 * float(one["density"]) for r, one in beads]
                           if masses is None else masses, dtype=float)  # fmt: skip
        known = {str(one["name"]): one for one in both}
    except KeyError as error:
        raise InputError(f"expected the {error.args[0]} of the material of each bead"
                         f"{', or masses' * (error.args[0] == 'density')}") from None  # fmt: skip
    except (TypeError, ValueError):
        first = math.nan
    if not (
        0 < first < math.inf
        and second > 0
        and np.size(radii) < 3
        and weights.shape == (len(beads),)
        and all((weights > 0) & (weights < math.inf))
    ):
        raise InputError("expected two radii > 0 [m], of which the second may be infinite, one or "
                         "two materials, and masses > 0, one of each bead")  # fmt: skip
    reduced = 1 / sum(1 / weights)
    if len(known) == 1 and dict(both[0]) != dict(both[1]):
        raise InputError(f"found two different materials of the name '{both[0]['name']}'")
    given: dict[str, Any] = {
        "impact": {"velocity": velocity},
        "sphere": {"radius": first, "mass": reduced, "material": both[0]["name"]},
        "plate": {"material": both[1]["name"], "waves": "none"},
    }
    plate = groups.get("plate")
    of_wall = [key for key in (plate if isinstance(plate, Mapping) else ()) if key in OF_WALLS]
    if second < math.inf:
        if of_wall:
            raise InputError(f"{title}: found plate.{of_wall[0]} for two beads, which only a wall "
                             "has")  # fmt: skip
        given["plate"]["surface_radius"] = second
    elif of_wall:
        # what the case says of waves, or their default
        del given["plate"]["waves"]
    for name, keys in groups.items():
        # what is no group is refused by Case
        given[name] = (
            {**given[name], **keys} if name in given and isinstance(keys, Mapping) else keys
        )
    return Case({**given, "material": list(known.values())}, name=title)


def checked(target: str, velocities: ArrayLike, quantity: str) -> Floats:
    """The velocities; refused with what there is not."""
    given = numbers(velocities, "velocities")
    if target not in list(TARGETS):
        raise UsageError(f"unknown program '{target}', known: {', '.join(TARGETS)}"
                         f"{_text.near(str(target), TARGETS)}")  # fmt: skip
    if quantity not in MEANING:
        raise UsageError(f"unknown quantity '{quantity}', known: {', '.join(MEANING)}")
    if given.size < 2 or not (np.diff(given, prepend=0) > 0).all():
        raise UsageError("expected two or more velocities > 0 that rise")
    return given


def export_pair(
    case: Case | str | os.PathLike[str],
    target: str,
    velocities: ArrayLike,
    *,
    quantity: str = "cor_sphere",
    master: bool = False,
    law: int = 1,
    threads: int | None = None,
) -> Export:
    """Input of another program for the impacts of a case, as `export` describes it."""
    case, given = as_case(case), checked(target, velocities, quantity)
    curve = solved(case, given, quantity, threads)
    if master:
        return _master(case, target, curve)
    chosen = TARGETS[target]
    if not chosen.laws:
        return _tabulated(case, chosen, curve)
    return _fitted(case, chosen, curve, law)


def solved(case: Case, given: Floats, quantity: str, threads: int | None) -> xr.Dataset:
    """Results at the velocities and between them, every second one."""
    if case["target.body"]:
        raise InputError(f"{case.name}: found &target, expected a case without: a law of two "
                         "bodies has no structure behind one")  # fmt: skip
    velocity = np.empty(2 * len(given) - 1)
    velocity[::2], velocity[1::2] = given, np.sqrt(given[1:] * given[:-1])
    with warnings.catch_warnings(), unwarned(ValidityWarning):
        warnings.simplefilter("ignore", NoResultWarning)
        found = case.points({"impact.velocity": velocity}, (*COLUMNS, "status"), threads=threads)
    lost = ~np.isfinite(found[quantity].values)
    if lost.any():
        worst = found.isel(point=int(np.argmax(lost)))
        raise NumericalError(
            f"{case.name}: {lost.sum()} of {lost.size} velocities have no result, the first one is "
            f"{float(worst['impact.velocity']):.4g} m/s ({worst.status.item()})"
        )
    for name in MEANING:
        # of an elastic pair it is 1 up to the error of the solution
        excess = found[name].values - 1
        within = excess <= np.fmax(found[f"{name}_error"].values, ACCURACY)
        if name == quantity and not within.all():
            raise NumericalError(
                f"{case.name}: found {name} = {1 + excess.max():.6g} at "
                f"{velocity[np.argmax(excess)]:.4g} m/s, expected at most 1: no program takes it"
            )
        found[name] = found[name].copy(
            data=np.where(within, np.fmin(1.0, found[name]), found[name])
        )
    columns = {
        "e": found.cor, "e_sphere": found.cor_sphere,
        "contact_time": found.contact_time, "max_force": found.max_force,
    }  # fmt: skip
    table = xr.Dataset(
        {name: ("velocity", one.values, one.attrs) for name, one in columns.items()},
        coords={"velocity": ("velocity", velocity, {"units": "m/s", "long_name": "velocity"})},
        attrs=found.attrs | {"e": "e" if quantity == "cor" else "e_sphere", "quantity": quantity},
    )
    first = found.isel(point=0)
    table.attrs["mass"] = float(2 * first.initial_energy / velocity[0] ** 2)
    radius, other = radii_of(case)
    if other and case["sphere.mass"] is None:
        warnings.warn(
            f"{case.name}: the second body is a sphere, and sphere.mass is not given: this bead of "
            f"{table.attrs['mass']:.6g} kg meets one that cannot move; two free beads need their "
            "reduced mass, m1 m2/(m1 + m2)",
            stacklevel=3,
        )
    table.attrs["radius"] = radius / (1 + radius / other) if other else radius
    judged, cause = found.validity.values, found.validity_cause.values
    parts = [f"good at {(judged == 'good').sum()} of {len(velocity)} velocities"]
    for level in ("caution", "outside"):
        if (judged == level).any():
            causes = ", ".join(sorted(set(map(str, cause[judged == level]))))
            parts.append(f"{level} at {(judged == level).sum()} ({causes})")
    table.attrs["validity"] = ", ".join(parts)
    if case["contact.mechanics"] == "paper":
        exact, middle = case.copy(), float(velocity[len(velocity) // 2])
        # a case that gives law, pair and waves leaves mechanics nothing to say
        with contextlib.suppress(NumericalError, InputError), unwarned():
            exact["contact.mechanics"] = "exact"
            there = float(exact.solve({"impact.velocity": middle}, [quantity])[quantity])
            here = float(found[quantity][len(velocity) // 2])
            if abs(there - here) >= 5e-5:
                table.attrs["exact"] = f"e {there:.4f} at {middle:.4g} m/s, here {here:.4f}"
    return table


def not_judged(cases: Sequence[Case]) -> list[str]:
    """Measures that the validity of cases leaves out, as a material has no yield strength."""
    names = {str(case[f"{body}.material"]): case for case in cases for body in ("sphere", "plate")}
    bare = [name for name, case in names.items()
            if case[f"{name.strip().replace(' ', '_')}.yield_strength"] is None]  # fmt: skip
    return [f"plastic deformation is not judged: no yield_strength of {', '.join(bare)}"
            ] if len(bare) == len(names) else []  # fmt: skip


def _header(case: Case, target: Target, curve: xr.Dataset) -> list[str]:
    """Validity and conditions of the numbers, as lines of a head."""
    temperature = case["impact.temperature"]
    end = case["contact.law"] or "boltzmann"
    waves = case["plate.waves"] or "none"
    name = f"{case['sphere.material']} on {case['plate.material']}"
    meaning = MEANING[curve.attrs["quantity"]] if waves != "none" else MEANING["cor"]
    body, gravity = f"Hertz radius {curve.attrs['radius']:.6g} m", case["impact.gravity"]
    if case["sphere.shape"] not in SPHERES:
        body = f"shape {case['sphere.shape']}"
    if case["sphere.shape"] == "true_sphere":
        body += ", true sphere"
    if base := base_of(case):
        thickness = number(case, "plate.thickness", 2 * number(case, "plate.half_thickness", 0.0))
        body += f", layer of {thickness:.6g} m, {base} on a rigid floor"
    return [
        # Python reads an encoding from its first two lines: nothing of the case is in them
        f"vcor {_library.__version__}, for {target.name}",
        f"e: {meaning} ({curve.attrs['quantity']}); contact ends where the force returns to zero",
        f"case: {case['case.title'] or case.name}",
        f"pair: {name}, reduced mass {curve.attrs['mass']:.6g} kg, {body}",
        f"contact law {end}, waves {waves}, temperature "
        + (f"{temperature:g} K" if temperature else "not given")
        + (f", gravity {gravity:g} m/s2" if gravity else ""),
        f"velocities: {curve.velocity.values[0]:g} to {curve.velocity.values[-1]:g} m/s, validity "
        + curve.attrs["validity"],
        *not_judged([case]),
        *(f"with contact.mechanics = 'exact': {words}" for words in [curve.attrs.get("exact")]
          if words),
    ]  # fmt: skip


def _finished(
    case: Case, target: Target, curve: xr.Dataset, lines: list[str], values: Mapping[str, Any],
    misfit: float, options: Mapping[str, Twin] | None = None,
) -> Export:  # fmt: skip
    """The files of a program from its templates: lines of [pair] or [wall] as the case is."""
    kind, other_kind = "[wall] ", "[pair] "
    if case["plate.surface_radius"]:
        kind, other_kind = other_kind, kind
    lines = [*_header(case, target, curve), *lines, *target.notes]
    if target.laws:
        run = f"was run in {target.run}" if target.run else "was not run"
        lines.append(f"input of this kind {run}")
    radius, other = radii_of(case)
    mass = curve.attrs["mass"] * (2 if other else 1)
    middle = float(np.sqrt(curve.velocity.values[0] * curve.velocity.values[-1]))
    known = {
        "velocity": f"{middle:.6g}", "radius": radius, "radius2": other,
        "diameter": f"{2 * radius:.12g}", "diameter2": f"{2 * other:.12g}",
        "density": f"{_density(mass, radius):.12g}", "density2": f"{_density(mass, other):.12g}",
        "mass": f"{curve.attrs['mass']:.12g}", "mass2": f"{2 * curve.attrs['mass']:.12g}",
        "hertz_radius": f"{curve.attrs['radius']:.12g}",
    }  # fmt: skip
    texts = {}
    for ending in target.files:
        said = [comment(line, ending) for line in lines]
        template = (TEMPLATES / f"{target.name}{ending}.txt").read_text(encoding="utf-8")
        kept = [line.removeprefix(kind) for line in template.splitlines()
                if not line.startswith(other_kind)]  # fmt: skip
        text = FileTemplate("\n".join(kept) + "\n")
        texts[ending] = text.substitute(known, **values, header="\n".join(said))
    return Export(target.name, curve, texts, lines, misfit, options or {})


def comment(line: str, ending: str) -> str:
    """A line of a comment that ends with it, whatever stands in it."""
    line = COMMENTS.get(ending, "# ") + _library.printable(line).rstrip()
    # a comment of XML has no --; elsewhere the next line would belong to this one
    line = re.sub("-(?=-)", "- ", line) if ending == ".xml" else line
    return line + "." if line.endswith(("\\", "??/", "&")) else line


def radii_of(case: Case) -> tuple[float, float]:
    """Radii of the sphere and of the other body [m], 0 for a wall."""
    return radius_of(case, 0.0), number(case, "plate.surface_radius", 0.0)


def base_of(case: Case) -> str:
    """How a layer lies on a floor; empty for a plate or a half space."""
    base = str(case["plate.base"] or "free")
    return "" if base == "free" else base


def _density(mass: float, radius: float) -> float:
    return mass / (4 / 3 * math.pi * radius**3) if radius else 0.0


class FileTemplate(Template):
    """A file with names such as @mass in it."""

    delimiter = "@"


def _tabulated(case: Case, target: Target, curve: xr.Dataset) -> Export:
    """A program that takes e(v) as it is."""
    shown = curve.isel(velocity=slice(None, None, 2))
    v, e = shown.velocity.values, shown[curve.attrs["e"]].values
    spline = PchipInterpolator(np.log(v), e)
    between = spline(np.log(curve.velocity.values))
    misfit = float(np.abs(between - curve[curve.attrs["e"]].values).max())
    columns = ("e", "e_sphere", "contact_time", "max_force")
    nodes = [f"{x:.17g}" for x in v]
    coefficients = [[f"{c:.17g}" for c in row] for row in spline.c.T[:, ::-1]]
    values = {
        "rows": rows_of(v, *(shown[name].values for name in columns)),
        "nodes": "(" + ", ".join(nodes) + ")",
        "coefficients": "(\n" + "".join(f"    ({', '.join(c)}),\n" for c in coefficients) + ")",
        "c_nodes": "{" + ", ".join(nodes) + "}",
        "c_coefficients": "{\n" + "".join(f"    {{{', '.join(c)}}},\n" for c in coefficients) + "}",
    }
    lines = [f"monotone cubic interpolation over ln v: largest misfit {misfit:.2g} in e"]
    if target.name == "table":
        flat = ", ".join(f"{a:.9g}, {b:.9g}" for a, b in zip(v, e, strict=True))
        lines += ["v [m/s], e, e_sphere [1], t_c [s], F_max [N]", f"flat list v, e, ...: {flat}"]
    return _finished(case, target, shown, lines, values, misfit)


def refuse_shapes(case: Case, target: Target) -> None:
    """Refuse contacts that programs with laws of their own do not have."""
    if case["sphere.shape"] not in SPHERES or radii_of(case)[1] < 0:
        raise InputError(f"{case.name}: {target.name} has contacts of spheres and flat walls only, "
                         "expected table or rebound in its place")  # fmt: skip


def rank(misfit: float, time_misfit: float) -> tuple[float, float]:
    """Place of a law: those that fit alike to these digits stay in the order of the program."""
    return round(misfit, 6), round(time_misfit, 4)


def fits(case: Case, target: Target, curve: xr.Dataset) -> list[Fit | None]:
    """Text, parameters and numbers of each law of a program; None for those that it cannot take."""
    velocity, time = curve.velocity.values, curve.contact_time.values
    found: list[Fit | None] = []
    for entry in target.laws:
        form = replace(LAWS[entry["law"]], clipped=entry.get("clipped", False))
        twin = form.fit(velocity, curve[curve.attrs["e"]].values, time, curve.attrs["mass"])
        numbers = _numbers(case, curve, twin)
        filled = {key: one.format(**numbers) for key, one in entry.items() if key != "clipped"}
        # a program that takes e has no damping beyond the critical one
        beyond = "nan" in filled["text"]
        found.append(None if beyond else (filled["text"], twin, numbers | filled))
    return found


def _fitted(case: Case, target: Target, curve: xr.Dataset, law: int) -> Export:
    """A program with laws of its own, in the order of their misfits."""
    refuse_shapes(case, target)
    found = [fit for fit in fits(case, target, curve) if fit]
    found.sort(key=lambda one: rank(one[1].misfit, one[1].time_misfit))
    text, twin, filled = found[whole(law, "law", 1, len(found)) - 1]
    columns = {"e_law": twin.cor, "contact_time_law": twin.time}
    shown = curve.assign({name: ("velocity", one) for name, one in columns.items()})
    shown = shown.isel(velocity=slice(None, None, 2))
    step = float(twin.time.min()) / STEPS
    rows = shown.isel(velocity=slice(None, None, max(1, len(shown.velocity) // 10)))
    quantities = (rows.velocity, rows[curve.attrs["e"]], *(
        rows[name] for name in ("e_law", "contact_time", "contact_time_law")))  # fmt: skip
    lines = [
        f"law: {twin.law.name}; {twin.law.end}",
        f"largest misfit of that law to vcor: {twin.misfit:.2g} in e, "
        f"{100 * twin.time_misfit:.2g} % in the contact time",
        f"time step: {STEPS} in the shortest contact, {step:.3g} s, for e to 0.001; 50 for 0.01",
        "   v [m/s]       e  e of law     t_c [s]  t_c of law",
        *(f"{v:10.4g}{a:8.5f}{b:10.5f}{t:12.4g}{u:12.4g}"
          for v, a, b, t, u in zip(*(one.values for one in quantities), strict=True)),
        "what to write, by law and end of contact, with the misfits in e and contact time:",
        *(f"  {i}. {text}  ({one.law.name}, {one.law.end}: {one.misfit:.2g}, "
          f"{100 * one.time_misfit:.2g} %)" for i, (text, one, _) in enumerate(found, 1)),
    ]  # fmt: skip
    values = {
        **filled,
        "law": text,
        "step": f"{step:.6g}",
        "duration": f"{RUNS * twin.time.max():.6g}",
        "size": f"{8 * max(radii_of(case)):g}",
    }
    options = {text: twin for text, twin, _ in found}
    return _finished(case, target, shown, lines, values, twin.misfit, options)


def _numbers(case: Case, curve: xr.Dataset, twin: Twin) -> dict[str, str]:
    """Numbers that programs take for a law."""
    mass, root = curve.attrs["mass"], math.sqrt(curve.attrs["radius"])
    poisson = number(case, f"{case['sphere.material']}.poisson_ratio", 0.0)
    contact_modulus = 0.75 * twin.stiffness / root
    found = {
        "K": twin.stiffness,
        "gamma": twin.damping / mass,
        "omega2": twin.stiffness / mass,
        "hertz": twin.stiffness / root,
        "eta": twin.damping / mass / root,
        "e": twin.entered,
        "contact_modulus": contact_modulus,
        "young": (young := 2 * (1 - poisson**2) * contact_modulus),
        "young_half": young * (1 if case["plate.surface_radius"] else math.sqrt(2)),
        "level": twin.cor[0],
        "e_mfix": _entered_in_mfix(twin.entered),
        "kn": twin.stiffness / curve.attrs["radius"],
        "gn": twin.damping / mass / curve.attrs["radius"],
        "K_twice": 2 * twin.stiffness,
        "C_twice": 2 * twin.damping,
        "mass_twice": 2 * mass,
        "poisson": poisson,
        "time": math.sqrt(twin.time.min() * twin.time.max()),
    }
    return {name: f"{value:.9g}" for name, value in found.items()}


def _entered_in_mfix(e: float) -> float:
    """Restitution to give to HERTZIAN, whose factor is 2, of a linear dashpot, not sqrt(5)."""
    share = math.sqrt(5) / 2 * math.log(e) / math.hypot(math.pi, math.log(e)) if e > 0 else math.nan
    return math.exp(math.pi * share / math.sqrt(1 - share**2)) if share > -1 else math.nan


def _master(case: Case, target: str, curve: xr.Dataset) -> Export:
    """Table of e against (m/sqrt(R v))^(2/5), where it depends on nothing else."""
    reasons = {
        "waves in the plate": case["plate.waves"] not in (None, "none"),
        "gravity": bool(case["impact.gravity"]),
        "a layer on a base": bool(base_of(case)),
        "a body that is not a sphere": case["sphere.shape"] not in SPHERES,
        "a sphere that is not a paraboloid": case["sphere.shape"] == "true_sphere",
        "the second Volterra term": case["solver.volterra_order"] == 2,
    }
    for reason, holds in reasons.items():
        if holds:
            raise InputError(f"{case.name}: a master curve of e does not exist with {reason}")
    if target != "table":
        raise UsageError(f"a master curve is a table, found {target}")
    shown = curve.isel(velocity=slice(None, None, 2))
    mass, radius = curve.attrs["mass"], curve.attrs["radius"]
    x = (mass / np.sqrt(radius * shown.velocity.values)) ** 0.4
    attrs = {"units": "kg^0.4 s^0.2 m^-0.4", "long_name": "(m/sqrt(R v))^(2/5)"}
    shown = shown.assign_coords(x=("velocity", x, attrs)).swap_dims(velocity="x").isel(
        x=slice(None, None, -1))  # fmt: skip
    ratio = shown.contact_time.values / shown.x.values
    lines = _header(case, TARGETS["table"], curve) + [
        "x = (m/sqrt(R v))^(2/5), with the reduced mass m and Hertz radius R of any two spheres of",
        "these materials: e and t_c/x depend on x alone",
        f"x [{attrs['units']}], e [1], t_c/x [s per unit of x]",
    ]
    rows = rows_of(shown.x.values, shown[curve.attrs["e"]].values, ratio)
    head = "".join(comment(line, ".csv") + "\n" for line in lines)
    return Export("master", shown, {".csv": f"{head}x,e,t_c/x\n{rows}\n"}, lines, 0.0, {})


def rows_of(*columns: Floats) -> str:
    """Columns as rows of CSV."""
    return "\n".join(",".join(f"{x:.17g}" for x in row) for row in zip(*columns, strict=True))
