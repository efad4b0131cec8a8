"""The reference cases: plain data, SI units, one dictionary per impact."""

STEEL_RIGID = dict(name="rigid steel", model="rigid", density=7800.0)
STEEL = dict(name="steel", model="elastic", density=7800.0, poisson_ratio=0.3, modulus=210e9)
GLASS = dict(name="glass", model="elastic", density=2500.0, poisson_ratio=0.22, modulus=70e9)
ALUMINIUM = dict(name="aluminium", model="elastic", density=2700.0, poisson_ratio=0.33,
                 modulus=70e9)
RIGID_PLATE = dict(name="rigid plate", model="rigid", density=7800.0)


def sls(name="sls rubber", glassy=15e6, beta=1200.0, ratio=0.25, density=1100.0, nu=0.5):
    return dict(name=name, model="sls", density=density, poisson_ratio=nu,
                glassy_modulus=glassy, alpha=beta * ratio, beta=beta)


ELASTIC_RUBBER = dict(name="elastic rubber", model="elastic", density=1100.0, poisson_ratio=0.5,
                      modulus=15e6)
BUTYL_PRONY = dict(name="butyl prony", model="prony", density=1100.0, poisson_ratio=0.5,
                   equilibrium_modulus=10.421e6, moduli=[20.181e6, 38.204e6, 87.344e6],
                   rates=[972.0, 6426.0, 34221.0])
BUTYL_CERF = dict(name="butyl cerf", model="cerf", density=1100.0, poisson_ratio=0.5,
                  equilibrium_modulus=0.442e6, relaxing_modulus=0.6765e9, beta=700.0)
BUTYL_POWER = dict(name="butyl power law", model="power_law", density=1100.0, poisson_ratio=0.5,
                   equilibrium_modulus=2.28e6, coefficient=8.85e5, exponent=0.5)

CASES = []


def add(name, note, velocity, materials, radius=0.01, half_thickness=0.02, waves="relaxing",
        surface_radius=0.0, mass=None, laws=()):
    """Append a case: materials is (sphere, plate), or one material for both."""
    sphere, plate = (materials if isinstance(materials, tuple) else (materials, materials))
    case = dict(
        name=name, note=note, velocity=velocity, laws=laws,
        sphere=dict(radius=radius, material=sphere["name"], **({"mass": mass} if mass else {})),
        plate=dict(half_thickness=half_thickness, material=plate["name"], waves=waves,
                   surface_radius=surface_radius),
        materials=[sphere] if sphere is plate else [sphere, plate])
    assert all(c["name"] != name for c in CASES), name
    CASES.append(case)


# The paper's sphere and plate (Section III, Case 3: the sphere is rigid in contact)
add("elastic_v10", "paper, elastic limit", 10.0, (STEEL_RIGID, ELASTIC_RUBBER),
    laws=("elastic_limits",))
for v in (1, 2, 5, 10, 20, 30):
    add(f"sls_v{v}", "paper, Eq. (14)", float(v), (STEEL_RIGID, sls()))
for beta in (600, 2400, 4800):
    add(f"sls_beta{beta}_v10", "paper, Fig. 4", 10.0, (STEEL_RIGID, sls(beta=float(beta))))
for stem, material, eq in (("butyl_prony", BUTYL_PRONY, "(26)"), ("butyl_cerf", BUTYL_CERF, "(24)"),
                           ("butyl_power_law", BUTYL_POWER, "(23-b)")):
    for v in (1, 10, 20, 50):
        add(f"{stem}_v{v}", f"paper, Eq. {eq}", float(v), (STEEL_RIGID, material))
add("sls_plate_constant_v10", "alpha = alpha(0)", 10.0, (STEEL_RIGID, sls()), waves="constant")
add("butyl_prony_plate_constant_v10", "alpha = alpha(0)", 10.0, (STEEL_RIGID, BUTYL_PRONY),
    waves="constant")
add("sls_plate_none_v10", "no plate motion", 10.0, (STEEL_RIGID, sls()), waves="none",
    laws=("scaling",))
add("butyl_prony_plate_none_v10", "no plate motion", 10.0, (STEEL_RIGID, BUTYL_PRONY),
    waves="none")

# Both bodies elastic (Case 1), with finite moduli
PMMA = dict(name="pmma", model="elastic", density=1180.0, poisson_ratio=0.35, modulus=3.2e9)
SOFT_SPHERE = sls("soft sls", glassy=8e6, beta=900.0, ratio=0.4, density=1250.0, nu=0.45)
add("elastic_steel_on_glass", "both elastic, 5 mm half thickness", 1.0, (STEEL, GLASS),
    half_thickness=0.005)
add("elastic_steel_on_aluminium", "both elastic, 5 mm half thickness", 0.1, (STEEL, ALUMINIUM),
    radius=0.005, half_thickness=0.005)
add("elastic_half_space_v0.001", "Hertz, no plate motion, slow", 1e-3, (STEEL, GLASS),
    waves="none", laws=("hertz",))
add("elastic_convex_v100", "sphere on a convex steel surface, fast", 100.0, (STEEL, STEEL),
    waves="none", surface_radius=0.05, laws=("hertz",))
add("elastic_concave_1mm", "1 mm sphere in a concave glass seat", 0.5, (STEEL, GLASS), radius=0.001,
    half_thickness=0.001, surface_radius=-0.0015)
for lam in (0.05, 0.2, 1.0):
    # A m / T = lambda fixes the half thickness: rigid sphere 10 mm, E' = 20 MPa, v0 = 10 m/s
    m = 4 / 3 * 3.141592653589793 * 0.01 ** 3 * 7800.0
    T = (m / (4 / 3 * 0.01 ** 0.5 * 20e6 * 10.0 ** 0.5)) ** 0.4
    h = ((3 * 1100.0 / 20e6) ** 0.5 / (16 * 1100.0) * m / (lam * T)) ** 0.5
    add(f"elastic_lambda{lam}", f"Zener's lambda = {lam}", 10.0, (STEEL_RIGID, ELASTIC_RUBBER),
        half_thickness=h, laws=("zener",))

# Geometry, mass, speed
add("sls_concave", "concave surface", 3.0, (STEEL_RIGID, sls()), surface_radius=-0.05)
add("sls_convex", "convex surface", 10.0, (STEEL_RIGID, sls()), surface_radius=0.02)
add("sls_heavy", "mass override 0.1 kg", 2.0, (STEEL_RIGID, sls()), mass=0.1)
add("butyl_prony_light", "mass override 2 g", 7.5, (STEEL_RIGID, BUTYL_PRONY), mass=0.002)
add("sls_v0.001", "slow: almost rubbery", 1e-3, (STEEL_RIGID, sls()))
add("sls_v100", "fast: almost glassy", 100.0, (STEEL_RIGID, sls()))
add("sls_1mm", "1 mm sphere, 1 mm half thickness", 15.0, (STEEL_RIGID, sls()), radius=0.001,
    half_thickness=0.001)

# The sphere is the viscoelastic one (Case 4), or both are (Case 2 and the general pair)
add("sls_sphere_rigid_plate", "viscoelastic sphere, no plate motion", 5.0,
    (SOFT_SPHERE, RIGID_PLATE), waves="none", laws=("rigid_plate",))
add("sls_sphere_rigid_plate_relaxing", "the same: a rigid plate has alpha = 0", 5.0,
    (SOFT_SPHERE, RIGID_PLATE), laws=("rigid_plate",))
add("butyl_prony_sphere", "viscoelastic sphere on a rigid half space", 0.5,
    (BUTYL_PRONY, RIGID_PLATE), waves="none")
add("sls_same_both", "Case 2: the same SLS on both", 5.0, sls())
add("butyl_prony_same_both", "Case 2, no plate motion", 1.0, BUTYL_PRONY, waves="none")
add("soft_sphere_on_pmma", "general pair, soft SLS sphere on an elastic plate", 2.0,
    (SOFT_SPHERE, PMMA), half_thickness=0.005)
add("soft_sphere_on_rubber", "general pair, moduli of the same size, alpha constant", 5.0,
    (SOFT_SPHERE, ELASTIC_RUBBER), waves="constant")
add("two_sls", "general pair, two different SLS", 4.0,
    (SOFT_SPHERE, sls(glassy=20e6, beta=5000.0, ratio=0.1)))
add("two_sls_half_space", "general pair, two different SLS, no plate motion", 25.0,
    (sls("hard sls", 60e6, 300.0, 0.6, 1150.0, 0.4), sls("fast sls", 40e6, 2e4, 0.3, 1000.0, 0.48)),
    waves="none", radius=0.02)
add("steel_on_sls", "general pair, elastic steel instead of a rigid sphere", 10.0, (STEEL, sls()))
add("rubber_on_butyl_prony", "general pair, elastic sphere on a Prony plate", 3.0,
    (ELASTIC_RUBBER, BUTYL_PRONY), radius=0.015)

# Wide spectra
WIDE = dict(name="wide prony", model="prony", density=1050.0, poisson_ratio=0.49,
            equilibrium_modulus=0.2e6,
            moduli=[120e6, 60e6, 25e6, 10e6, 4e6, 1.5e6, 0.8e6, 0.4e6],
            times=[1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1, 1.0])
FAST_SLOW = dict(name="fast and slow", model="prony", density=1100.0, poisson_ratio=0.5,
                 equilibrium_modulus=3e6, moduli=[40e6, 9e6, 5e6, 4e6],
                 rates=[1e7, 2.5e6, 800.0, 1.0])
add("prony8", "8 terms over 1e-7..1 s", 3.0, (STEEL_RIGID, WIDE))
add("prony8_half_space", "8 terms, no plate motion, slow", 0.05, (STEEL_RIGID, WIDE), waves="none")
add("prony8_v100", "8 terms, fast", 100.0, (STEEL_RIGID, WIDE))
add("prony_fast_slow", "rates 1e7 to 1 1/s", 10.0, (STEEL_RIGID, FAST_SLOW))
add("prony_fast_slow_half_space", "rates 1e7 to 1 1/s, no plate motion", 0.3,
    (STEEL_RIGID, FAST_SLOW), waves="none")
for beta in (1, 10, 50):
    add(f"sls_beta{beta}", "nearly elastic: F vanishes just before s does", 10.0,
        (STEEL_RIGID, sls(beta=float(beta))))
add("sls_beta10_half_space", "nearly elastic, no plate motion", 1.0,
    (STEEL_RIGID, sls(beta=10.0)), waves="none")
add("sls_beta1e5", "rubbery limit", 10.0, (STEEL_RIGID, sls(beta=1e5)))
add("sls_beta1e5_half_space", "rubbery limit, no plate motion", 1.0, (STEEL_RIGID, sls(beta=1e5)),
    waves="none")
add("sls_beta0.001", "beta -> 0: elastic COR with E_g", 10.0, (STEEL_RIGID, sls(beta=1e-3)),
    laws=("elastic_limits",))
add("sls_beta1e8", "beta -> infinity: elastic COR with E_r", 10.0, (STEEL_RIGID, sls(beta=1e8)),
    laws=("elastic_limits",))
add("elastic_rubbery_v10", "elastic with the rubbery modulus of the SLS", 10.0,
    (STEEL_RIGID, dict(ELASTIC_RUBBER, modulus=3.75e6)), laws=("elastic_limits",))

# Dashpots
VOIGT = dict(name="kelvin voigt", model="prony", density=1100.0, poisson_ratio=0.5,
             equilibrium_modulus=2e6, viscosity=400.0)
VISCOUS_PRONY = dict(name="viscous prony", model="prony", density=1100.0, poisson_ratio=0.5,
                     equilibrium_modulus=3e6, moduli=[6e6, 4e6], rates=[700.0, 9000.0],
                     viscosity=150.0)
add("kelvin_voigt_sphere", "Kelvin-Voigt sphere on a rigid half space", 2.0, (VOIGT, RIGID_PLATE),
    waves="none")
add("kelvin_voigt_sphere_1mm", "overdamped: 1 mm sphere, slow", 0.01, (VOIGT, RIGID_PLATE),
    waves="none", radius=0.001)
add("viscous_prony", "Prony with a dashpot, no plate motion", 6.0, (STEEL_RIGID, VISCOUS_PRONY),
    waves="none")
add("viscous_prony_same_both", "Prony with a dashpot on both, no plate motion", 1.0, VISCOUS_PRONY,
    waves="none")


def power(exponent, coefficient, equilibrium=0.0):
    return dict(name="power law", model="power_law", density=1100.0, poisson_ratio=0.5,
                equilibrium_modulus=equilibrium, coefficient=coefficient, exponent=exponent)


# Fractional kernels
add("power_law_a0.25", "pure power law, no plate motion", 10.0, (STEEL_RIGID, power(0.25, 5e6)),
    waves="none", laws=("power_law",))
add("power_law_a0.5", "pure power law, no plate motion", 1.0, (STEEL_RIGID, power(0.5, 5e5)),
    waves="none", laws=("power_law",))
add("power_law_a0.75", "pure power law, no plate motion", 10.0, (STEEL_RIGID, power(0.75, 5e4)),
    waves="none")
add("power_law_a0.25_other", "another mass, radius and speed: the same COR", 0.2,
    (STEEL_RIGID, power(0.25, 8e5)), waves="none", radius=0.003, mass=0.002, laws=("power_law",))
add("power_law_a0.25_plate", "power law with an equilibrium modulus, relaxing plate", 10.0,
    (STEEL_RIGID, power(0.25, 3e6, 4e6)))
add("power_law_a0.75_plate", "power law with an equilibrium modulus, relaxing plate", 5.0,
    (STEEL_RIGID, power(0.75, 3e4, 5e6)))
add("power_law_sphere_on_rubber", "general pair, power law sphere on an elastic plate", 3.0,
    (power(0.5, 3e5, 2e6), ELASTIC_RUBBER))
CERF50 = dict(name="cerf", model="cerf", density=1100.0, poisson_ratio=0.5,
              equilibrium_modulus=2e6, relaxing_modulus=40e6, beta=50.0)
add("cerf_beta50", "CERF in its transition, relaxing plate", 10.0, (STEEL_RIGID, CERF50))
add("cerf_beta50_half_space", "CERF, no plate motion", 0.1, (STEEL_RIGID, CERF50), waves="none")
add("cerf_sphere_on_sls", "general pair, CERF sphere on an SLS plate", 5.0, (CERF50, sls()))
add("butyl_cerf_1mm", "1 mm sphere, fast", 40.0, (STEEL_RIGID, BUTYL_CERF), radius=0.001,
    half_thickness=0.002)

# Laws without a reference
MAXWELL = dict(name="maxwell", model="prony", density=1100.0, poisson_ratio=0.5,
               equilibrium_modulus=0.0, moduli=[15e6], rates=[1.0])
add("maxwell_weak", "weak Maxwell solid: COR -> 1 - (5/9) t_c/tau", 10.0, (STEEL_RIGID, MAXWELL),
    waves="none", laws=("maxwell",))
add("maxwell_weak_faster", "weak Maxwell solid, ten times faster", 10.0,
    (STEEL_RIGID, dict(MAXWELL, rates=[10.0])), waves="none", laws=("maxwell",))
# T = (m/(k(0) sqrt(v0)))^(2/5) as in sls_plate_none_v10: mass x 6, sqrt(R) x 2, v0 x 9
add("sls_scaled", "same T as sls_plate_none_v10, other mass, radius and speed", 90.0,
    (STEEL_RIGID, sls()), waves="none", radius=0.04,
    mass=6 * 4 / 3 * 3.141592653589793 * 0.01 ** 3 * 7800.0, laws=("scaling",))
