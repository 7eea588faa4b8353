//! What the symbols and the conventions of the pages mean.

use maud::{Markup, html};

use super::document::{section, table, text_cell};

/// Symbol, meaning, unit.
type Symbol = (&'static str, &'static str, &'static str);

const SYMBOLS: &[Symbol] = &[
    (
        "φ, φ′, φ″",
        "roll angle, its rate, its acceleration; starboard down positive",
        "rad, rad/s, rad/s²",
    ),
    (
        "A",
        "roll amplitude: mean of the two peaks of a half cycle; A₁ in a forced run",
        "rad or deg",
    ),
    ("t", "time on the recording's own time base", "s"),
    ("I + ΔI", "moment of inertia in roll with the added inertia", "kg m²"),
    ("K", "restoring coefficient ρ g ∇ GM", "N m/rad"),
    ("B(φ′)", "roll damping moment", "N m"),
    (
        "M, M_{a}, ε",
        "exciting moment, its amplitude, the phase by which it leads the roll",
        "N m, N m, deg",
    ),
    ("b₁, b₃", "coefficients of B/(I+ΔI) = b₁ φ′ + b₃ φ′³", "1/s, s"),
    ("B₁, B₃", "the same times I+ΔI", "N m s, N m s³"),
    ("b_{eq}, B_{eq}", "equivalent linear damping: loses the same energy per cycle", "1/s, N m s"),
    ("B̂₄₄", "B_{eq} made non-dimensional", "–"),
    ("ζ", "ratio of b_{eq} to critical damping", "–"),
    ("Δφ/φ_{m}", "loss of amplitude per half cycle over the mean of its two peaks", "–"),
    ("U", "inferred moment per unit inertia, −B/(I+ΔI)", "rad/s²"),
    ("g", "observable of the inverse problem: the roll less its undamped motion, (2.4)", "rad"),
    ("ω_{n}", "small-angle natural frequency √(K/(I+ΔI))", "rad/s"),
    ("ω", "frequency of one half cycle, or of the excitation", "rad/s"),
    ("V, Fr", "carriage speed, Froude number V/√(g L_{pp})", "m/s, –"),
    ("b₀, κ", "coefficients of b₁(Fr) = b₀ (1 + κ Fr²)", "1/s, –"),
    ("s_{run}", "run-to-run standard deviation of b₁ about that law", "1/s"),
    (
        "L_{pp}, B, d, ∇, GM",
        "length between perpendiculars, beam, draft, displaced volume, metacentric height",
        "m, m, m, m³, m",
    ),
    ("ρ, g", "density of the water, gravity", "kg/m³, m/s²"),
    ("m", "mass of the model ρ ∇", "kg"),
    ("λ, σ", "smoothness of U, noise of the roll, as the paper's sampler draws them", "s⁴, rad"),
    ("a, c", "coefficients of extinction over half cycles; see the conventions", "–, 1/rad²"),
    ("p, q", "coefficients of extinction over full cycles; see the conventions", "–, 1/deg"),
    ("N", "Bertin's coefficient of extinction over half cycles", "1/deg"),
    ("u, U", "standard and expanded uncertainty", "as the value"),
    ("k₃", "cubic restoring: K (φ + k₃ φ³)", "1/rad²"),
    ("rmse", "root mean square of measured less resimulated roll", "deg"),
];

const CONVENTIONS: &[&str] = &[
    "Roll is positive starboard down; a positive exciting moment rolls the model to positive \
     roll. The damping moment opposes the rate, so U and φ′ have opposite signs.",
    "Equation of motion, per unit inertia: φ″ + B(φ′)/(I+ΔI) + ω_{n}² φ = M/(I+ΔI). All b are \
     per unit inertia I+ΔI; all B are moments, b times I+ΔI.",
    "I+ΔI is K/ω_{n}² in a decay and (K A₁ − M_{a} cos ε)/(ω² A₁), equation (4.5), in a forced \
     run. Hull particulars are taken as exact: an error of 2 % in GM is one of 2 % in every B \
     and in B̂₄₄, and none in b.",
    "Equivalent damping is by equal energy per cycle: b_{eq}(A) = b₁ + ¾ (ω A)² b₃. It is \
     the value to compare between runs; b₁ and b₃ alone trade against each other, and their \
     correlation is given.",
    "The law value comes from b₁ and b₃ of the whole run; the local value from the energy \
     balance of the half cycles near that amplitude, without a law.",
    "Non-dimensional: B̂₄₄ = B_{eq}/(ρ ∇ B²) √(B/(2g)), ITTC 7.5-02-07-04.5, with B the beam in \
     the second and third place.",
    "Damping ratio: ζ = b_{eq}/(2 ω_{n}).",
    "Half-cycle convention: Δφ/φ_{m} = π b_{eq}/(2 ω_{n}) per HALF cycle, from one peak to the \
     next on the other side; so Δφ = a φ_{m} + c φ_{m}³ with a = (π/2) b₁/ω_{n} and c = (3π/8) \
     ω_{n} b₃, φ in rad.",
    "Full-cycle convention (p–q of MARIN): from one peak to the next on the same side, twice \
     the half-cycle value, Δφ/φ_{m} = p + q φ_{m}. It is fitted to the half cycles on its own: \
     the fitted law has a cubic term where p–q has a quadratic one, so p is not 2a.",
    "Bertin's N, in 1/deg: Δφ = N φ_{m}² per HALF cycle, so N = π b_{eq}/(2 ω_{n} φ_{m}), which \
     depends on amplitude unless the damping is quadratic.",
    "Froude number is on L_{pp}: Fr = V/√(g L_{pp}), V the mean carriage speed over the run.",
    "Posterior means are printed with central 95 % credible intervals, mean [low, high], \
     rounded to two significant digits of the standard deviation.",
];

/// The conventions as a section.
pub(super) fn conventions() -> Markup {
    section(
        "conventions",
        "Conventions",
        &html! { ul { @for line in CONVENTIONS { li { (super::notation::html(line)) } } } },
    )
}

/// The table of symbols as a section.
pub(super) fn symbols() -> Markup {
    let rows: Vec<_> = SYMBOLS
        .iter()
        .map(|(symbol, meaning, unit)| {
            html! { (text_cell(symbol)) (text_cell(meaning)) (text_cell(unit)) }
        })
        .collect();
    let columns = [("Symbol", ""), ("Meaning", ""), ("Unit", "")];
    section("symbols", "Symbols", &table("symbol-table", "Symbols and units.", &columns, &rows))
}
