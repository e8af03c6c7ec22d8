"""Stretch, bend and twist of strands, what damps them, and what pulls at them from outside."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray
from ringlet.validate import bounce, cantilever, hanging_chain, love, plucked_coil
from ringlet.validate.rods import gravity_for, line_density, rod_material, straight_rod, strand
from scipy.integrate import solve_bvp
from scipy.special import jn_zeros

from theory.answer import Answer, Panel

Array = NDArray[np.float64]
LENGTH = 0.1  # [m]


def stretch() -> Answer:
    """A strand pulled by its tip, and one that hangs under its own weight; both along themselves."""
    material = rod_material().model_copy(update={"stretch_scale": 1e-4, "bend_scale": 0.0})
    stiffness = 1e-4 * material.youngs_modulus * np.pi * material.radius**2  # EA [N]
    s = LENGTH * np.arange(26) / 25
    points = np.c_[0 * s, -s, 0 * s]

    def sunk(gravity: float = 0.0, force: float = 0.0) -> Array:
        rod, forces = strand(points, material, 1), np.zeros_like(points)
        forces[-1, 1] = -force
        rod.settle(gravity=(0.0, -gravity, 0.0), forces=forces)
        return points[:, 1] - rod.positions[:, 1]

    pulls = np.linspace(0.0, 0.2, 6)
    strains = np.array([sunk(force=pull * stiffness)[-1] / LENGTH for pull in pulls])
    heavy = {ratio: sunk(gravity=ratio * stiffness / (line_density(material) * LENGTH)) for ratio in (0.05, 0.1, 0.2)}
    exact = {ratio: ratio * (s / LENGTH - 0.5 * (s / LENGTH) ** 2) for ratio in heavy}
    return Answer(
        [
            Panel("pull / EA", "strain", {"F / EA": (pulls, pulls)}, {"F / EA": (pulls, strains)}),
            Panel(
                "s / L",
                "sunk / L",
                {f"wL / EA = {ratio}": (s / LENGTH, y) for ratio, y in exact.items()},
                {f"wL / EA = {ratio}": (s / LENGTH, y / LENGTH) for ratio, y in heavy.items()},
            ),
        ],
        [("strain under F = 0.2 EA", 0.2, strains[-1])]
        + [(f"its tip sinks by / L, wL / EA = {r}", 0.5 * r, y[-1] / LENGTH) for r, y in heavy.items()],
    )


def elastica(gamma: float) -> tuple[Array, Array]:
    """Shape of a clamped rod under its weight, by its length: θ'' = −Γ (1 − s) cos θ, θ the angle below level."""
    s = np.linspace(0.0, 1.0, 401)
    angle = np.zeros((2, len(s)))
    for part in np.geomspace(1.0, max(gamma, 1.0), 10):  # along the branch that begins level
        solved = solve_bvp(
            lambda s, y, load=part: np.stack([y[1], -load * (1.0 - s) * np.cos(y[0])]),
            lambda clamp, tip: np.array([clamp[0], tip[1]]),
            s,
            angle,
            tol=1e-7,
            max_nodes=20000,
        )
        angle = solved.sol(s)
    turned = solved.sol(0.5 * (s[1:] + s[:-1]))[0]
    return np.append(0.0, np.cumsum(np.cos(turned)) * s[1]), np.append(0.0, -np.cumsum(np.sin(turned)) * s[1])


def bend() -> Answer:
    """A clamped rod that sags under its own weight."""
    material, shown, edges = rod_material(), (1, 4, 20, 100), 25
    shapes = {}
    for gamma in shown:
        rod = straight_rod(LENGTH, edges, material)
        rod.settle(gravity=(0.0, -gravity_for(gamma, LENGTH, material), 0.0))
        shapes[f"Γ = {gamma}"] = rod.positions[:, 0] / LENGTH, rod.positions[:, 1] / LENGTH
    lines = {f"Γ = {gamma}": elastica(gamma) for gamma in shown}
    gammas = np.array([*cantilever.DROP], float)
    drops = np.array([cantilever.tip(int(gamma), edges)[1] / LENGTH for gamma in gammas])
    between = np.geomspace(1.0, 500.0, 24)
    exact = np.array([-elastica(gamma)[1][-1] for gamma in between])
    return Answer(
        [
            Panel("x / L", "y / L", lines, shapes, equal=True),
            Panel("Γ", "drop of the tip / L", {"elastica": (between, exact)}, {"elastica": (gammas, drops)}, log=True),
        ],
        [
            (f"drop / L, Γ = {g:g}, {edges} edges", cantilever.DROP[int(g)], d)
            for g, d in zip(gammas, drops, strict=True)
        ],
    )


def twist() -> Answer:
    """A coil that is pulled along its axis, whose ends may turn: most of what it stores is twist."""
    edges_a_turn, loads = 12, (0.02, 0.05, 0.1, 0.2, 0.3)
    between = np.linspace(1e-4, 0.32, 40)
    exact = np.array([love.theory(float(load)) for load in between])
    got = np.array([love.rise(load, edges_a_turn, correct_resolution=True) for load in loads])
    # The radius of Love's helix follows from what turns at its ends, which is nothing.
    start = np.arctan2(love.PITCH, 2 * np.pi * love.RADIUS)
    sine, cosine = exact, np.sqrt(1.0 - exact**2)
    curvature, torsion = np.cos(start) ** 2, np.sin(start) * np.cos(start)
    turned = (love.RATIO * torsion * sine + curvature * cosine) / (love.RATIO * sine**2 * cosine + cosine**3)
    in_twist = love.RATIO * (sine * cosine * turned - torsion) ** 2
    in_bend = (cosine**2 * turned - curvature) ** 2
    return Answer(
        [
            Panel(
                "F R² / EI",
                "rise of the coil by its length",
                {f"Love, GJ / EI = {love.RATIO:.3g}": (between, exact)},
                {f"Love, GJ / EI = {love.RATIO:.3g}": (loads, got)},
            ),
            Panel(
                "F R² / EI",
                "part of its energy that is twist",
                {"Love": (between, in_twist / (in_twist + in_bend))},
                {},
            ),
        ],
        [
            (f"rise by length, FR²/EI = {load:g}, {edges_a_turn} vertices a turn", love.theory(load), rise)
            for load, rise in zip(loads, got, strict=True)
        ],
    )


def damping() -> Answer:
    """A plucked coil rings down, at 40 steps a period."""
    omega = plucked_coil.lowest_mode()[0]
    beta, steps, periods = 2 * 0.02 / omega, 40, 4
    exact, got, rows = {}, {}, []
    for integrator in ("backward_euler", "bdf2"):
        times, amplitudes = plucked_coil.ring(integrator, beta, steps, periods)
        z = plucked_coil.factor(integrator, beta, float(times[1]))
        decay = plucked_coil.decay(integrator, beta, steps)
        n = np.arange(len(times))
        name = f"`{integrator}`"
        exact[integrator] = omega * times / (2 * np.pi), abs(z) ** n
        got[integrator] = omega * times / (2 * np.pi), amplitudes
        rows.append((f"{name}: what a step leaves of the amplitude", abs(z), float(np.exp(-decay))))
    mu = plucked_coil.exponent(beta)
    t = np.linspace(0.0, periods * 2 * np.pi / omega, 400)
    true = np.exp(mu.real * t) * (np.cos(mu.imag * t) - mu.real / mu.imag * np.sin(mu.imag * t))
    exact["the coil itself"] = omega * t / (2 * np.pi), true
    falls, errors = {}, {}
    for integrator, order in (("backward_euler", 1), ("bdf2", 2)):
        counts = np.array([25, 50, 100, 200, 400])
        off = np.array([plucked_coil.error(integrator, beta, int(count)) for count in counts])
        falls[integrator], errors[integrator] = (counts, off[-1] * (counts[-1] / counts) ** order), (counts, off)
        rows.append((f"`{integrator}`: order at which the error falls", order, float(np.log2(off[-2] / off[-1]))))
    return Answer(
        [
            Panel("periods", "amplitude", exact, got),
            Panel("steps a period", "largest error in a period", falls, errors, log=True),
        ],
        rows,
    )


def hanging_coil() -> Answer:
    """Locks of all types that are plucked along and across, in steps of BDF-2; the words by theory are the lines."""
    rows = [(kind, *row) for kind in bounce.LOCKS for row in bounce.agreement(kind, "bdf2")]
    panels = []
    for word in ("bounce [Hz]", "settle [s]", "swing [Hz]"):
        expected = np.array([by_theory for _, name, by_theory, _ in rows if name == word])
        measured = np.array([got for _, name, _, got in rows if name == word])
        ends = np.array([0.9 * expected.min(), 1.1 * expected.max()])
        panels.append(
            Panel(
                f"{word}, by theory",
                "measured",
                {"theory": (ends, ends)},
                {"theory": (expected, measured)},
                log=True,
            )
        )
    return Answer(panels, [(f"{kind}: {name}", by_theory, got) for kind, name, by_theory, got in rows])


def outside() -> Answer:
    """A limp strand that hangs in a wind, and the frequencies at which one swings."""
    material = rod_material().model_copy(update={"bend_scale": 0.0, "drag": 2e-5})
    s = LENGTH * np.arange(26) / 25
    points = np.c_[0 * s, -s, 0 * s]
    weight = line_density(material) * hanging_chain.GRAVITY
    winds = np.array([0.5, 1.0, 2.0, 4.0])
    angles = []
    for wind in winds:
        rod = strand(points, material, 1)
        for _ in range(400):
            rod.step(points, 0.05, gravity=(0.0, -hanging_chain.GRAVITY, 0.0), wind=(float(wind), 0.0, 0.0))
        x, y, _ = rod.positions[-1] - rod.positions[0]
        angles.append(np.degrees(np.arctan2(x, -y)))
    between = np.linspace(0.0, 4.5, 50)
    leaning = np.degrees(np.arctan(material.drag * between / weight))
    zeros, edges = jn_zeros(0, 3), np.array([12, 25, 50, 100])
    swings = [zero / 2 * np.sqrt(hanging_chain.GRAVITY / hanging_chain.LENGTH) for zero in zeros]
    errors = {
        f"swing {k + 1}": (edges, [abs(hanging_chain.frequency(k, int(n)) / swings[k] - 1) for n in edges])
        for k in range(3)
    }
    falls = {name: (n, off[-1] * (n[-1] / n) ** 2) for name, (n, off) in errors.items()}
    return Answer(
        [
            Panel(
                "wind [m/s]",
                "leans by [°]",
                {"atan(drag v / w)": (between, leaning)},
                {"atan(drag v / w)": (winds, angles)},
            ),
            Panel("edges", "relative error of ω", falls, errors, log=True),
        ],
        [
            (f"leans by [°] at {wind:g} m/s", float(np.degrees(np.arctan(material.drag * wind / weight))), angle)
            for wind, angle in zip(winds, angles, strict=True)
        ]
        + [(f"ω of swing {k + 1} [1/s], 100 edges", swings[k], hanging_chain.frequency(k, 100)) for k in range(3)],
    )
