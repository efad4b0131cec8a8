"""Cases to spoil: complete ones, each key in a line of its own."""

HEAD = """\
&case
   title = 'Ball on plate'
/
&impact
   velocity = 10.0
/
&sphere
   radius = 0.01
   material = 'steel'
/
&plate
   half_thickness = 0.02
   material = 'rubber'
/
&material
   name = 'steel'
   model = 'rigid'
   density = 7800.0
/
&solver
/
&output
/
&material
   name = 'rubber'
   density = 1100.0
   poisson_ratio = 0.5
"""

# The lines of the plate's material, by model
MODELS = {
    "elastic": """\
   model = 'elastic'
   modulus = 15.0e6
/
""",
    "sls": """\
   model = 'sls'
   glassy_modulus = 15.0e6
   alpha = 300.0
   beta = 1200.0
/
""",
    "prony": """\
   model = 'prony'
   equilibrium_modulus = 10.421e6
   moduli = 20.181e6, 38.204e6, 87.344e6
   rates = 972.0, 6426.0, 34221.0
   viscosity = 0.0
/
""",
    "prony_times": """\
   model = 'prony'
   equilibrium_modulus = 10.421e6
   moduli = 20.181e6, 38.204e6, 87.344e6
   times = 1.0e-3, 1.5e-4, 3.0e-5
/
""",
    "power_law": """\
   model = 'power_law'
   equilibrium_modulus = 2.28e6
   coefficient = 0.885e6
   exponent = 0.5
/
""",
    "cerf": """\
   model = 'cerf'
   equilibrium_modulus = 0.442e6
   relaxing_modulus = 676.5e6
   beta = 700.0
/
""",
    "mittag_leffler": """\
   model = 'mittag_leffler'
   equilibrium_modulus = 2.0e6
   relaxing_modulus = 70.0e6
   exponent = 0.6
   time = 2.0e-5
/
""",
}


def case_text(model="sls"):
    """A complete case whose plate is of this model."""
    return HEAD + MODELS[model]


SLS = case_text()


def edit(text, group, key, value):
    """Give a key another value; the text and the number of the line.

    In a group that is repeated the last one is meant: the plate's material. A key that is not
    there becomes the first line of its group.
    """
    lines = text.splitlines()
    start = len(lines) - 1 - lines[::-1].index(f"&{group}")
    end = lines.index("/", start)
    new = f"   {key} = {value}"
    for i in range(start, end):
        if lines[i].split("=")[0].strip() == key:
            lines[i] = new
            break
    else:
        i = start + 1
        lines.insert(i, new)
    return "\n".join(lines) + "\n", i + 1


def add_line(text, after, line):
    """Put a line after another; the text and the number of the new line."""
    lines = text.splitlines()
    i = [old.strip() for old in lines].index(after) + 1
    lines.insert(i, line)
    return "\n".join(lines) + "\n", i + 1


def without(text, line):
    """Take a line away; the text and the number it had."""
    lines = text.splitlines()
    i = [old.strip() for old in lines].index(line)
    del lines[i]
    return "\n".join(lines) + "\n", i + 1
