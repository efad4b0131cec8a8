"""Master curves: shift factors of moduli that were made with known ones."""

import dataclasses
import itertools
import json

import numpy as np
import pytest
from conftest import EVERYTHING, long_tests

import vcor
from vcor import _command
from vcor.materials import master
from vcor.materials.data import read_moduli
from vcor.materials.shifting import Curve, laws_of

C1, C2, REFERENCE = 12.0, 80.0, 293.15


def moduli(at, temperature, dynamic):
    """Moduli of a fractional solid whose times follow WLF."""
    shift = 10 ** (-C1 * (temperature - REFERENCE) / (C2 + temperature - REFERENCE))
    if not dynamic:
        return 1e6 + 1e9 / (1 + (at / shift) ** 0.4)
    p = (1j * at * shift) ** 0.4
    found = 1e6 + 1e9 * p / (1 + p)
    return found.real, found.imag


def file_of(path, temperatures, dynamic=True, noise=0.0):
    """A file of moduli in the raw format of pyvisco."""
    rng = np.random.default_rng(5)
    at = np.geomspace(0.1, 100, 10)
    lines = ["f,E_stor,E_loss,T,Set", "Hz,MPa,MPa,C,-"] if dynamic else [
        "t,E_relax,T,Set", "s,MPa,°C,-"]  # fmt: skip
    for i, t in enumerate(temperatures):
        for one in at if dynamic else at[::-1]:
            row = moduli(2 * np.pi * one if dynamic else one, t + 273.15, dynamic)
            row = np.atleast_1d(row) * (1 + noise * rng.normal(size=np.size(row))) / 1e6
            lines.append(",".join(map(str, [one, *row, t, i])))
    path.write_text("\n".join(lines) + "\n", encoding="utf-8-sig")
    return path


@pytest.mark.parametrize("dynamic", [True, False])
def test_shift_factors_and_constants_are_found_again(tmp_path, dynamic):
    temperatures = np.arange(0, 60, 5)
    path = file_of(tmp_path / "raw.csv", temperatures, dynamic)
    found = vcor.master(path, reference_temperature=REFERENCE)
    wanted = -C1 * (temperatures - 20) / (C2 + temperatures - 20)
    assert np.allclose(found.temperatures, temperatures + 273.15)
    assert np.allclose(found.log_shift, wanted, atol=0.01)
    wlf = found.laws[0]
    assert wlf.values["wlf_c1"] == pytest.approx(C1, rel=0.02)
    assert wlf.values["wlf_c2"] == pytest.approx(C2, rel=0.02)
    at, *rest = found.curve()
    assert (np.diff(at) >= 0).all()
    wanted = moduli(at, REFERENCE, dynamic)
    assert np.allclose(rest[0], wanted[0] if dynamic else wanted, rtol=0.01)


def test_errors_are_those_of_the_noise(tmp_path):
    temperatures = np.arange(0, 60, 5)
    path = file_of(tmp_path / "raw.csv", temperatures, noise=0.01)
    found = vcor.master(path, reference_temperature=REFERENCE)
    wanted = -C1 * (temperatures - 20) / (C2 + temperatures - 20)
    away = found.log_error > 0
    ratio = (found.log_shift - wanted)[away] / found.log_error[away]
    assert np.abs(ratio).max() < 4
    assert found.log_error[away].max() < 0.5


def test_points_are_shifted_by_the_law(tmp_path):
    # the storage moduli at -4 C hardly tell their shift to those at 0 C: the loss moduli do
    path = file_of(tmp_path / "raw.csv", [-4, *range(0, 60, 5)], noise=0.01)
    found = vcor.master(path, reference_temperature=REFERENCE)
    assert found.law.name == "WLF" and 0 < found.log_error[0] < 0.05
    at, *rest = found.curve()
    coldest = slice(-10, None)
    assert np.allclose(rest[1][coldest], moduli(at[coldest], REFERENCE, True)[1], rtol=0.1)


def test_one_file_per_temperature(tmp_path):
    names = []
    for t in (10, 20, 30):
        at = np.geomspace(1, 1000, 12)
        storage, loss = moduli(at, t + 273.15, True)
        path = tmp_path / f"at{t}.csv"
        rows = "".join(f"{a},{s},{b}\n" for a, s, b in zip(at, storage, loss, strict=True))
        path.write_text("omega [rad/s],E_stor [Pa],E_loss [Pa]\n" + rows)
        names.append(f"{path}@{t}C")
    found = vcor.master(names)
    assert found.reference_temperature == pytest.approx(293.15)
    assert found.log_shift[0] == pytest.approx(C1 * 10 / (C2 - 10), abs=0.02)


def test_a_file_with_a_temperature_in_its_name(tmp_path):
    path = tmp_path / "epdm@20C.csv"
    path.write_text(table(f"T [C],{HEAD}", [10, 20]))
    assert len(vcor.master(path).temperatures) == 2
    cold = read_moduli(f"{file_of(tmp_path / 'a@b.csv', [5])}@-20C")
    assert [curve.attrs["temperature"] for curve in cold] == [pytest.approx(253.15)]


def test_command_goes_on_into_fit_and_shift_file(tmp_path, capsys, program):
    path = file_of(tmp_path / "raw.csv", np.arange(0, 60, 5))
    _command.call("master", [str(path), "--reference", "20C", "--output", str(tmp_path)])
    assert "wlf_c1" in capsys.readouterr().out
    assert (tmp_path / "raw_master.svg").exists()
    written = json.loads((tmp_path / "raw_master.json").read_text())
    assert written["laws"][0]["law"] == "WLF"
    fit = vcor.fit(tmp_path / "raw_master.csv", model="prony", name="rubber")
    assert fit.rms < 0.02
    # the shift goes on into the material, and into an impact at another temperature
    program("fit", "raw_master.csv", "--name", "rubber", "--quiet", "--output", "rubber.nml")
    (tmp_path / "drop.nml").write_text(
        "&impact velocity = 2, temperature = 303.15 /\n"
        "&sphere radius = 0.01, material = 'steel' /\n"
        "&plate material = 'rubber', waves = 'none' /\n"
        "&material name = 'steel', model = 'rigid', density = 7800 /\n"
    )
    cor = program("run", "drop.nml", "rubber.nml", "--print", "cor", "--quiet")
    assert "shift = 'wlf'" in (tmp_path / "rubber.nml").read_text()
    drop = vcor.Case((tmp_path / "drop.nml").read_text() + fit.group)
    assert drop.solve()["cor"] == pytest.approx(float(cor.split()[-1]), abs=1e-6)
    found = vcor.master(path, reference_temperature=293.15)
    assert drop["rubber.wlf_c1"] == pytest.approx(found.laws[0].values["wlf_c1"], rel=1e-6)
    without = dataclasses.replace(found, laws=())
    assert without.keys("raw.csv")["shift_file"] == "raw.csv"
    case = vcor.Case(
        "&impact velocity = 2, temperature = 303.15 /\n"
        "&sphere radius = 0.01, material = 'steel' /\n"
        "&plate material = 'rubber', waves = 'none' /\n"
        "&material name = 'steel', model = 'rigid', density = 7800 /\n"
        "&material name = 'rubber', model = 'power_law', poisson_ratio = 0.5,"
        " coefficient = 1e6, exponent = 0.3,"
        " equilibrium_modulus = 1e6, reference_temperature = 293.15,"
        " shift = 'table',"
        " shift_file = 'raw_master_shift.csv' /\n",
        name=str(tmp_path / "case.nml"),
    )
    by_table = case.solve()["cor"]
    text = str(case).replace("shift = 'table'", f"shift = 'wlf'\n wlf_c1 = {C1}\n wlf_c2 = {C2}")
    lines = [line for line in text.splitlines() if "shift_file" not in line]
    by_law = vcor.Case("\n".join(lines) + "\n").solve()["cor"]
    assert by_table == pytest.approx(by_law, abs=2e-3)


@pytest.mark.usefixtures("no_figures")
def test_a_fit_shifts_by_the_same_code(tmp_path, capsys, program):
    path = file_of(tmp_path / "raw.csv", np.arange(0, 60, 5), noise=0.01)
    model = {"model": "mittag_leffler", "name": "rubber"}
    fit = vcor.fit(path, **model)
    _command.call("master", [str(path), "--output", str(tmp_path)])
    other = vcor.fit(tmp_path / "raw_master.csv", **model)
    assert fit.group.count("\n   wlf_c1 = ") == 1
    assert fit.group == other.group or fit["exponent"] == pytest.approx(other["exponent"], rel=1e-6)
    assert fit["exponent"] == pytest.approx(0.4, abs=0.02)
    text = program("fit", path, "--model", "sls", "--fix", "glassy_modulus=1e9")
    assert "12 curves from 0 to 55 C are shifted to 30 C by WLF" in text
    assert "identify fits moduli and shift at once" in text
    capsys.readouterr()


@pytest.mark.usefixtures("no_figures")
def test_misfits_of_a_broken_master_curve_are_not_noise(tmp_path, capsys):
    """Each temperature has its own misfit; neighbouring points are of several temperatures."""

    def broken(at, t):
        size = 1.1 if t % 10 else 1 / 1.1
        return tuple(size * one for one in moduli(at, t + 273.15, True))

    temperatures = np.arange(0, 60, 5)
    model = {"model": "mittag_leffler", "name": "rubber"}
    for made in (moduli, broken):
        path = tmp_path / "raw.csv"
        if made is broken:
            path.write_text(table(f"T [C],{HEAD}", temperatures, made))
        else:
            file_of(path, temperatures, noise=0.01)
        _command.call("master", [str(path), "--vertical-shift", "no", "--output", str(tmp_path)])
        later = vcor.fit(tmp_path / "raw_master.csv", **model)
        assert later.follows == (made is moduli)
        if later.follows:
            assert vcor.fit(path, **model).follows
    capsys.readouterr()


def test_a_reference_between_the_data_is_said(tmp_path):
    path = file_of(tmp_path / "raw.csv", np.arange(0, 60, 10), noise=0.0)
    with pytest.warns(
        UserWarning, match="the reference is 20.00 C, where data are, in place of 22 C"
    ):
        assert vcor.master(path, reference_temperature=295.15).reference_temperature == 293.15
    with pytest.raises(
        vcor.InputError, match=r"298.15 K \(25 C\), .* \(20 C\): take these, or none"
    ):
        vcor.master(path, reference_temperature=298.15)


def test_a_fit_of_shifts_without_a_law_names_master(tmp_path):
    shifts = {0: 2.0, 10: 0.3, 20: 0.2, 30: -2.0, 40: -2.2, 50: -4.0}

    def odd(at, t):
        p = (1j * at * 10 ** shifts[t]) ** 0.4
        return (1e6 + 1e9 * p / (1 + p)).real, (1e9 * p / (1 + p)).imag

    path = tmp_path / "odd.csv"
    path.write_text(table(f"T [C],{HEAD}", shifts, odd))
    with pytest.raises(vcor.InputError, match=r"no law; vcor.master gives them as a table"):
        vcor.fit(path)


@pytest.mark.usefixtures("no_figures")
def test_columns_and_units_and_what_was_taken(tmp_path, capsys):
    path = tmp_path / "odd.csv"
    path.write_text(table("T [C],rate,a,b\n", [0, 10, 20]))
    words = [str(path), "--output", str(tmp_path), "--reference", "10C", "--units", "rad/s,Pa"]
    with pytest.raises(SystemExit):
        _command.call("master", words)
    assert "--columns" in capsys.readouterr().err
    words += ["--columns", "frequency=rate", "--columns", "storage_modulus=a,loss_modulus=b"]
    _command.call("master", words)
    taken = capsys.readouterr().out.splitlines()[0]
    assert "odd.csv: 36 points: temperature from 'T [C]', frequency from 'rate'" in taken
    plain = tmp_path / "plain.csv"
    plain.write_text(table(f"T [C],{HEAD}", [0, 10, 20]))
    wanted = vcor.master(plain, reference_temperature=283.15)
    found = json.loads((tmp_path / "odd_master.json").read_text())
    assert found["log10_shift"] == wanted.log_shift.tolist()


def test_shift_factors_fall():
    """Neighbours that agree within their scatter give no rising step, which is refused later."""
    at = np.geomspace(1, 1000, 12)
    curves = [
        Curve(273.15 + t, True, at, np.array(moduli(at * shift, REFERENCE, True)))
        for t, shift in ((0, 1.0), (8, 1.02), (16, 0.3), (24, 0.1))
    ]
    found = master.of_curves(curves, "data").log_shift
    assert (np.diff(found) < 0).all()
    assert found[1] - found[0] == pytest.approx(0.0, abs=1e-6)


def test_three_temperatures_fix_the_constants_of_wlf_and_a_fourth_tests_them(tmp_path):
    path = file_of(tmp_path / "raw.csv", [5, 20, 35], noise=0.003)
    found = vcor.master(path, reference_temperature=REFERENCE)
    assert found.law.name == "WLF" and "one more would test" in str(found)
    for key, value in (("wlf_c1", C1), ("wlf_c2", C2)):
        assert abs(found.law.values[key] - value) < 3 * found.law.errors[key]
    assert "WLF: two constants need three" in str(vcor.master(file_of(path, [5, 20])))
    with pytest.raises(vcor.InputError, match="ends in C, as 25C"):
        vcor.master(path, reference_temperature=25)


def table(head, temperatures, modulus=lambda at, t: moduli(at, t + 273.15, True)):
    """A file of storage and loss moduli over rad/s, one row after the other."""
    at = np.geomspace(1, 1000, 12)
    columns = ((t, at, *modulus(at, t)) for t in temperatures)
    rows = (row for column in columns for row in np.column_stack(np.broadcast_arrays(*column)))
    return head + "".join(",".join(map(str, row)) + "\n" for row in rows)


HEAD = "omega [rad/s],E_stor [Pa],E_loss [Pa]\n"


@pytest.mark.parametrize("seed", [2, 3, 4])
def test_curves_that_are_flat_are_not_shifted(tmp_path, seed):
    rng = np.random.default_rng(seed)
    path = tmp_path / "raw.csv"
    text = table(
        f"T [C],{HEAD}",
        [-40, -30],
        lambda at, _: (8e8 * at**0.002 * (1 + 0.01 * rng.normal(size=12)), 1e6),
    )
    path.write_text(text)
    with pytest.raises(vcor.NumericalError, match=r"-40 C and -30 C are too flat"):
        vcor.master(path)


def test_flat_curves_above_others_are_placed_by_their_law(tmp_path):
    """The plateau of a rubber; in the glass no law of warmer curves holds."""
    rng = np.random.default_rng(1)

    def rubber(at, t):
        p = (1j / at * 10 ** (-C1 * (t - 20) / (C2 + t - 20))) ** 0.6
        found = 1e6 * (1 + 30 * p / (1 + p))
        return (found.real * (1 + 0.003 * rng.normal(size=12)),)

    path = tmp_path / "raw.csv"
    path.write_text(table("T [C],t [s],E [Pa]\n", range(20, 120, 10), rubber))
    found = vcor.master(path, reference_temperature=REFERENCE)
    placed = np.isnan(found.log_error)
    assert placed[-1] and not placed[:4].any() and found.law.name == "WLF"
    above = found.temperatures - REFERENCE
    off = found.log_shift + C1 * above / (C2 + above)
    assert np.abs(np.diff(off)[placed[1:]]).max() < 0.1
    assert "100 C and 110 C are too flat" in str(found)
    assert "by law: these steps are those of WLF" in str(found)
    assert found.as_dict()["log10_shift_error"][-1] is None
    last = vcor.master(path, reference_temperature=383.15)
    assert np.isnan(last.log_error[:4]).all() and last.log_error[-1] == 0
    assert np.allclose(last.log_shift - last.log_shift[0], found.log_shift)


@pytest.mark.parametrize("unit", ["degC", "°C", "deg C", "Celsius"])
def test_units_of_temperatures(tmp_path, unit):
    path = tmp_path / "raw.csv"
    path.write_text(table(f"temperature [{unit}],{HEAD}", [0, 10, 20]))
    assert np.allclose(vcor.master(path).temperatures, [273.15, 283.15, 293.15])


@pytest.mark.usefixtures("no_figures")
def test_shear_moduli_become_tensile_ones(tmp_path):
    path = tmp_path / "raw.csv"
    path.write_text(table(f"T [C],{HEAD}", [0, 10, 20]))
    tensile = vcor.master(path)
    shear = table(f"T [C],{HEAD}", [0, 10, 20],
                  lambda at, t: np.array(moduli(at, t + 273.15, True)) / 2.8)  # fmt: skip
    path.write_text(shear.replace("E_", "G_"))
    with pytest.raises(vcor.UsageError, match="expected poisson_ratio"):
        vcor.master(path)
    found = vcor.master(path, poisson_ratio=0.4)
    assert np.allclose(found.curve(), tensile.curve(), rtol=1e-6)
    _command.call(
        "master", [str(path), "--poisson-ratio", "0.4", "--output", str(tmp_path), "--quiet"]
    )
    assert (tmp_path / "raw_master.csv").exists()


@pytest.mark.parametrize(
    ("text", "said"),
    [
        (table(f"T [R],{HEAD}", [0, 10]), "found 'R' as unit of 'T [R]', expected C or K"),
        (table(f"T,{HEAD}", [0, 10]), "expected T [C] for degrees Celsius"),
        (table(f"T [K],{HEAD}", [0, 10]), "above 0 K"),
        (table(f"T [C],{HEAD}", [0, 10, 0, 10]), "two curves at 0 C"),
        (table(f"T [C],{HEAD}", [-40, 90]), "the storage moduli at -40 C and 90 C have none"),
        ("f,E_stor,E_loss\n1,2,3\n2,3,4\n", "no column of temperatures"),
        # steps of temperature, and a ramp whose frequency is measured, too
        ("f,E_stor,E_loss,T\nHz,MPa,MPa,C\n1,3,3,20\n1,2,4,30\n", "one frequency at each temp"),
        ("f,E_stor,E_loss,T\nHz,MPa,MPa,C\n1,3,3,20\n1.001,2,4,20.5\n", "one frequency at each"),
        ("t [s],F [N]\n1,3\n2,2\n", "of a relaxation test F/(A strain) is one"),
        ("f,E_stor,E_loss,T\nHz,MPa,MPa,C\n1,2,3,20\n2,3,4,20\n3,4,5,20\n", "two or more"),
        ("f,E_stor,E_loss,T\nHz,MPa,MPa,R\n1,2,3,20\n2,3,4,20\n", "found 'R' as unit of 'T'"),
    ],
)
def test_bad_files_are_refused_in_one_line(tmp_path, text, said):
    path = tmp_path / "raw.csv"
    path.write_text(text)
    with pytest.raises(vcor.Error) as caught:
        vcor.master(path)
    assert said in str(caught.value)


def rubber_curves(seed, vertical=False, c1=6.0, c2=100.0, kelvin=(-20, 0, 20, 40, 60), **options):
    """Curves of a rubber with a loss tangent of 0.005, and 1 % of noise."""
    rng, curves = np.random.default_rng(seed), []
    for t in kelvin:
        shift = 10 ** (-c1 * (t - 20) / (c2 + t - 20))
        at = 2 * np.pi * np.geomspace(0.1, 50, 12)
        p = (1j * at * shift * 1e-7) ** 0.35
        found = 2e6 + 6e6 * p / (1 + p)
        size = (t + 273.15) / REFERENCE if vertical else 1.0
        noise = 1 + 0.01 * rng.normal(size=(2, 12))
        rows = np.array([found.real, found.imag]) * size * noise
        curves.append(Curve(t + 273.15, True, at, rows, **options))
    return curves


@pytest.mark.parametrize("vertical", [False, True])
def test_a_rubber_of_low_loss(vertical):
    """Its storage modulus alone says nothing; the moduli may be proportional to T as well."""
    for seed in range(3):
        found = master.of_curves(rubber_curves(seed, vertical), "data", REFERENCE)
        assert found.vertical == vertical
        assert ("vertical_shift" in found.keys("t.csv")) == vertical
        for key, value in (("wlf_c1", 6.0), ("wlf_c2", 100.0)):
            assert abs(found.law.values[key] - value) < 4 * found.law.errors[key]
            assert found.law.errors[key] < 0.02 * value
        at, storage, _ = found.curve()
        p = (1j * at * 1e-7) ** 0.35
        assert np.abs(storage / (2e6 + 6e6 * p / (1 + p)).real - 1).max() < 0.05


def test_constants_that_the_data_do_not_determine():
    """Temperatures that are close together fix the ratio of the constants of WLF."""
    curves = rubber_curves(3, kelvin=(17, 18.5, 20, 21.5, 23), celsius=False)
    found = master.of_curves(curves, "data")
    wlf = found.laws[0]
    assert not wlf.determined and (found.law is None or found.law.name == "Arrhenius")
    assert abs(wlf.ratio[0] - 0.06) < 4 * wlf.ratio[1]
    assert f"WLF: wlf_c1/wlf_c2 {wlf.ratio[0]:.4g} +- {wlf.ratio[1]:.2g} 1/K" in str(found)
    assert "all that these data determine of its constants" in str(found)
    assert "wlf_c1 " not in str(found) and "wlf_c1" not in found.keys("t.csv")
    with pytest.raises(vcor.InputError, match=r"two curves at 293.15 K"):
        master.of_curves([curves[2], curves[2]], "data")


@pytest.mark.parametrize(
    ("bend", "kelvin"),
    [
        *itertools.product([-3e-3, -1.2e-3, -1e-5], [(10, 60, 5), (0, 100, 4), (20, 40, 6)]),
        # each of these takes as long as all others
        (0.0, (10, 60, 5)),
        *long_tests((0.0, (0, 100, 4)), (0.0, (20, 40, 6))),
    ],
)
def test_shifts_that_do_not_bend_as_wlf_give_a_ratio_only(bend, kelvin):
    """log10 a_T = -0.07 (T - T0) + bend (T - T0)^2 has its best C2 at infinity."""
    temperatures = np.linspace(*kelvin) + 273.15
    away = temperatures - REFERENCE
    steps = np.diff(-0.07 * away + bend * away**2)
    law = laws_of(temperatures, steps, np.full(len(steps), 0.02), REFERENCE)[0]
    assert law.name == "WLF" and not law.determined
    # the slope of the straight line that fits the steps best
    widths = np.diff(away)
    straight = -(steps @ widths) / (widths @ widths)
    assert law.ratio[0] == pytest.approx(straight, rel=1e-4)
    found = master.Master(REFERENCE, temperatures, away, away, (law,), ())
    assert "e+1" not in str(found)
    (written,) = found.as_dict()["laws"]
    assert written["values"] == {"wlf_c1": None, "wlf_c2": None} == written["errors"]
    assert written["ratio"] == law.ratio[0] and not written["determined"]


def test_errors_of_wlf_are_those_of_noise():
    """Standard errors of the constants and of their ratio, by fits to noise."""
    rng, sigma = np.random.default_rng(3), 0.01
    temperatures = np.arange(0, 60, 5.0) + 273.15
    away = temperatures - REFERENCE
    steps = np.diff(-C1 * away / (C2 + away))
    errors = np.full(len(steps), sigma)
    law = laws_of(temperatures, steps, errors, REFERENCE)[0]
    fits = 100 if EVERYTHING else 50
    laws = [laws_of(temperatures, steps + sigma * rng.normal(size=len(steps)), errors, REFERENCE)[0]
            for _ in range(fits)]  # fmt: skip
    # so many fits have the deviation to 7 or 10 %: four times that
    off = 4 / (2 * fits) ** 0.5
    for name, error in law.errors.items():
        spread = np.std([np.log(one.values[name]) for one in laws]) * law.values[name]
        assert spread == pytest.approx(error, rel=off)
    assert np.std([one.ratio[0] for one in laws]) == pytest.approx(law.ratio[1], rel=off)


def spread_curves(seed, vertical=False, noise=0.01, loss=1.0):
    """Curves of a rubber that disperses, at three temperatures; `loss` is a slope of E''."""
    rng, curves = np.random.default_rng(seed), []
    for t in (0, 23, 50):
        at = 2 * np.pi * np.geomspace(0.1, 100, 13)
        p = (1.5e-7j * at * 10 ** (-9.5 * (t - 23) / (92 + t))) ** 0.55
        found = 2.7e6 + 9e8 * p / (1 + p)
        size = (t + 273.15) / 296.15 if vertical else 1.0
        rows = np.array([found.real, found.imag * loss ** (t / 50)]) * size
        rows *= 1 + noise * np.array([[1.0], [1.5]]) * rng.normal(size=(2, 13))
        curves.append(Curve(t + 273.15, True, at, rows))
    return curves


@pytest.mark.filterwarnings("error")
@pytest.mark.parametrize("vertical", [False, True])
@pytest.mark.parametrize("noise", [0.003, 0.01])
def test_the_moduli_together_tell_whether_there_is_a_vertical_shift(vertical, noise):
    wanted = np.array([9.5 * 23 / 92, 0.0, -9.5 * 27 / 142])
    for seed in (0, 4, 5):
        found = master.of_curves(spread_curves(seed, vertical, noise), "data", 296.15)
        assert found.vertical == vertical and not found.apart
        assert np.abs(found.log_shift - wanted).max() < 0.02
        assert (np.abs(found.log_shift - wanted) <= 4 * found.log_error).all()


def test_moduli_that_contradict_each_other_either_way_are_a_warning():
    curves = spread_curves(0, loss=2.0)
    with pytest.warns(UserWarning, match=r"data: the loss moduli at 0 C and 23 C .* 1 more pairs"):
        found = master.of_curves(curves, "data", 296.15)
    assert len(found.apart) == 2 and all(one in str(found) for one in found.apart)


@pytest.mark.usefixtures("no_figures")
def test_a_vertical_shift_may_be_given(tmp_path, capsys):
    path = tmp_path / "raw.csv"
    path.write_text(table(f"T [C],{HEAD}", [0, 10, 20]))
    words = [str(path), "--output", str(tmp_path), "--vertical-shift"]
    for given in ("yes", "no"):
        _command.call("master", [*words, given])
        assert ("vertical_shift = .true." in capsys.readouterr().out) == (given == "yes")
    with pytest.raises(SystemExit):
        _command.call("master", [*words, "maybe"])
    assert "--vertical-shift" in capsys.readouterr().err
