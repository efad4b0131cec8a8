"""Keys that an impact does not read: refused where they are set or swept, never run in silence."""

import re

import pytest
from cases import SLS
from program import ALL, INPUT, PAPER, ROOT

BODIES = "&impact velocity = 5 /\n&sphere radius = 0.01, material = {} /\n&plate material = {}"
PLATE = ", half_thickness = 0.02"
PRONY = """
&material name = 'ball', model = 'prony', density = 1200, poisson_ratio = 0.45,
   equilibrium_modulus = 4e6, moduli = 6e6, times = 2e-4, viscosity = 20 /
"""
POWER = """
&material name = 'sheet', model = 'power_law', density = 1100, poisson_ratio = 0.4,
   equilibrium_modulus = 2e6, coefficient = 1e6, exponent = 0.3 /
"""
STEEL = "&material name = 'steel', model = 'rigid', density = 7800 /\n"
ELASTIC = "&material name = 'glass', model = 'elastic', density = 2500, poisson_ratio = 0.2, modulus = 7e10 /\n"
SOLID = "&material name = 'sheet', model = 'sls', density = 1100, poisson_ratio = 0.4, "
SOLID += "glassy_modulus = 15e6, alpha = 300, beta = 1200 /\n"
MARCH = "&solver method = 'direct', scheme = 'adams_bashforth', time_step = 4e-6, volterra_order = 2 /\n"

CASES = {
    "sls": SLS,
    "half space": BODIES.format("'ball'", "'glass', waves = 'none' /") + PRONY + POWER + ELASTIC
    + "&contact pair = 'series' /\n",
    "one material": BODIES.format("'ball', mass = 0.02", f"'ball'{PLATE} /") + PRONY
    + "&solver volterra_order = 1 /\n",
    "mass": BODIES.format("'sheet', mass = 0.02", "'steel' /") + POWER + STEEL,
    "scheme": BODIES.format("'steel'", f"'sheet'{PLATE} /") + SOLID + STEEL + MARCH,
    "step": BODIES.format("'steel'", f"'sheet'{PLATE} /") + SOLID + STEEL
    + "&solver method = 'direct', time_step = 1e-5 /\n",
    "fractional": BODIES.format("'steel'", f"'sheet'{PLATE}, waves = 'hereditary' /") + STEEL
    + "&contact law = 'receding' /\n&material name = 'sheet', model = 'mittag_leffler', density = 1100,\n"
    "   poisson_ratio = 0.4, equilibrium_modulus = 2e6, relaxing_modulus = 7e7, exponent = 0.6,\n"
    "   time = 2e-5 /\n",
    "cerf": BODIES.format("'steel'", f"'sheet'{PLATE} /") + STEEL + "&material name = 'sheet',\n"
    "   model = 'cerf', density = 1100, poisson_ratio = 0.4, equilibrium_modulus = 4e5,\n"
    "   relaxing_modulus = 6e8, beta = 700 /\n",
    # a block of a material that does not relax may rattle until end_time
    "block": BODIES.format("'steel'", "'sheet' /") + SOLID + STEEL
    + "&target body = 'block', mass = 0.3, stiffness = 1e6, damping = 20 /\n&solver end_time = 0.01 /\n",
    "panel": BODIES.format("'steel'", f"'glass'{PLATE} /") + ELASTIC.replace("7e10", "5e8") + STEEL
    + "&target body = 'plate', support = 'supported', length = 0.3, width = 0.2, thickness = 0.03,\n"
    "   damping_ratio = 0.01, position = 0.14, 0.1 /\n",
}

# Values, two for a sweep, that must change an impact that reads them; others are multiples
VALUES = {
    "velocity": ("3", "7"),
    "poisson_ratio": ("0.1", "0.3"),
    "diameter": ("0.018", "0.022"),
    "surface_radius": ("0.3", "0.5"),
    "half_thickness": ("0.015", "0.03"),
    "mass": ("0.01", "0.03"),
    "density": ("1000", "3000"),
    "exponent": ("0.45", "0.55"),
    "time_step": ("2e-6", "3e-6"),
    "end_time": ("1e-4", "1"),
    "accuracy": ("1e-6", "1e-10"),
    "volterra_order": ("2", None),
    "bounces": ("3", None),
    "alpha": ("200", "250"),
    "extent": ("1e-9", "1e3"),
    "yield_strength": ("1.0", "1e20"),
    "valid_from": ("1e-3", "2e-3"),
    "valid_to": ("1e-6", "2e-6"),
}
LISTS = {"moduli": "7e6", "times": "1e-4", "rates": "3e3", "position": "0.13,0.1"}


def numbers_of_the_catalogue():
    """Group, name, whether it is a list, and models of every key that is a number."""
    group, found = "", []
    for line in (ROOT / "docs" / "input.md").read_text(encoding="utf-8").splitlines():
        group = line[4:] if line.startswith("## &") else group
        row = [cell.strip() for cell in re.split(r"(?<!\\)\|", line)[1:-1]]
        if len(row) < 5 or not re.match("a number|a whole|numbers", row[3]):
            continue
        models = re.findall(r"`(\w+)`", row[5]) if len(row) > 5 else []
        found.append((group, row[0].strip("`"), row[3].startswith("numbers"), models))
    return found


KEYS = [key for key in numbers_of_the_catalogue() if key[0] != "sweep"]


def test_the_catalogue_is_read():
    assert len(KEYS) > 25
    assert {group for group, *_ in KEYS} == {"impact", "sphere", "plate", "target", "material", "solver"}


def addresses(text, group, key, models):
    """Where a case may have the key: in a material of such a model, by its name; all have spheres."""
    if group == "sphere" and models and "sphere" not in models:
        return []
    if group == "target" and models and re.search(r"body = '(\w+)'", text + "body = 'none'")[1] not in models:
        return []
    if group != "material":
        return [f"{group}.{key}"]
    materials = re.findall(r"name\s*=\s*'(\w+)',?\s+model\s*=\s*'(\w+)'", text)
    return [f"{name}.{key}" for name, model in materials if model in models or not models]


@pytest.mark.parametrize("kind", CASES)
def test_every_number_counts_or_is_refused(vcor, kind):
    """Whatever is set or swept changes something that can be seen, or the run is refused."""
    text = CASES[kind]
    vcor.write(text)
    words = ["run", "case.nml", "--print", ALL]
    plain = vcor(*words)
    for group, key, is_list, models in KEYS:
        first, second = VALUES.get(key, ("1.2", "1.4"))
        if key in LISTS:
            first = LISTS[key]
        elif key not in VALUES:
            found = re.search(rf"\b{key}\s*=\s*([0-9.e+-]+)", text)
            size = float(found[1]) if found else 1.0
            first, second = (repr(factor * size) for factor in (1.2, 1.4))
        if key == "drop_height" or key == "rates" and "times" in text or f"{key} = {first}" in text:
            continue
        if key == "accuracy" and "time_step" in text:
            # the step is given, and what it gives is held against the accuracy
            first, second = "1e-9", "1e-2"
        for address in addresses(text, group, key, models):
            done = vcor(*words, "--set", f"{address}={first}")
            if done.code == INPUT:
                assert f"--set {address}: the impact does not read it: " in done.err \
                    or re.search("Volterra|bounces = 1", done.err), done.err
                set_is_read = False
            else:
                assert (done.out, done.err) != (plain.out, plain.err), address
                set_is_read = True
            if is_list or second is None:
                continue
            vcor.write(f"{text}&sweep parameter = '{address}', values = {first}, {second} /\n", "s.nml")
            done = vcor("run", "s.nml", "--print", ALL)
            if done.code == INPUT:
                assert f"found '{address}', which the impact does not read: " in done.err, done.err
                # the band of the data brings a warning, and no number
                assert not set_is_read or key in ("valid_from", "valid_to")
            else:
                assert set_is_read
                one, other = done.out.splitlines()
                assert one != other, address


REFUSED = [
    ("sls", "solver.volterra_coefficient=2", "volterra_order = 2"),
    ("sls", "solver.time_step=1e-6", "method ive takes its own steps"),
    ("sls", "solver.form=b", "adams_bashforth"),
    ("sls", "solver.quadrature=rectangle", "adams_bashforth"),
    ("sls", "steel.poisson_ratio=0.3", "rigid"),
    ("sls", "contact.pair=series", "sphere is rigid"),
    ("mass", "contact.pair=series", "plate is rigid"),
    ("one material", "contact.pair=series", "one material"),
    ("mass", "plate.waves=constant", "plate is rigid"),
    ("mass", "plate.half_thickness=0.01", "plate is rigid"),
    ("mass", "sheet.density=900", "sphere.mass"),
    ("fractional", "contact.mechanics=exact", "or have no effect"),
    ("half space", "plate.extent=0.01", "plate.waves = 'none'"),
    ("half space", "sheet.exponent=0.4", "neither the sphere nor the plate"),
    ("half space", "sheet.valid_from=1e-3", "neither the sphere nor the plate"),
]


@pytest.mark.parametrize("command", ["run", "check", "verify"])
@pytest.mark.parametrize("kind, setting, reason", REFUSED)
def test_reasons(vcor, command, kind, setting, reason):
    vcor.write(CASES[kind])
    path = setting.partition("=")[0]
    vcor.refuses(command, "case.nml", "--set", setting, code=INPUT, at=f"--set {path}", says=reason)


def test_an_impossible_first_point(vcor):
    """What the impact leaves out for a reason is refused even if the first point cannot be built."""
    text = re.sub(r"(&plate\b)", r"\1 surface_radius = -0.02, ", CASES["sls"])
    vcor.write(text + "&sweep parameter = 'sphere.radius', values = 0.03, 0.01 /\n")
    assert vcor("run", "case.nml", "--print", "status").out.split() == ["invalid", "separated"]
    says = "adams_bashforth"
    vcor.refuses("run", "case.nml", "--set", "solver.form=b", code=INPUT, at="--set solver.form", says=says)


def test_what_stands_in_the_file_may_stay(vcor):
    """A switch is turned in the command line, and what belongs to the other way stays behind."""
    vcor.write(CASES["step"])
    out = vcor.succeeds("run", "case.nml", "--set", "solver.method=ive")
    assert "note: solver.time_step is without effect" in out
    path = PAPER / "sls_printed.nml"
    sets = ["--set", "solver.method=ive", "--set", "solver.scheme=product"]
    assert "note: solver.time_step is without effect" in vcor.succeeds("run", path, *sets)


def test_material_reads_every_material(vcor):
    """vcor material shows those that are in no body, too."""
    vcor.write(CASES["half space"])
    first = vcor.succeeds("material", "case.nml")
    assert vcor.succeeds("material", "case.nml", "--set", "sheet.exponent=0.4") != first

