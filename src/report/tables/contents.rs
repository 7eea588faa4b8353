//! What stands in the tables: runs, equivalent damping, rejections, laws.

use super::{Cell, Table};
use crate::campaign::Campaign;
use crate::inverse::estimate::Estimate;
use crate::report::field_units::FieldUnits;
use crate::results::Results;

/// Every table but the moment histories.
pub(super) fn all(campaign: &Campaign, results: &Results) -> Vec<Table> {
    vec![
        runs(campaign, results),
        equivalent_damping(campaign, results),
        rejected(results),
        froude_law(results),
    ]
}

fn runs(campaign: &Campaign, results: &Results) -> Table {
    let mut headers = words(&[
        "id",
        "recording",
        "kind",
        "condition",
        "start [s]",
        "end [s]",
        "Fr [-]",
        "speed [m/s]",
    ]);
    for (name, unit) in [
        ("natural frequency", "rad/s"),
        ("b1", "1/s"),
        ("b3", "s"),
        ("b_eq at 5 deg", "1/s"),
        ("inertia used", "kg m2"),
        ("excitation frequency", "rad/s"),
        ("roll amplitude", "rad"),
        ("peak moment", "rad/s2"),
        ("work damping", "N m s"),
    ] {
        headers.extend(estimate_headers(name, unit));
    }
    headers.extend(words(&["b1 b3 correlation [-]", "resimulation rmse [deg]"]));
    let rows = results.runs.iter().map(|run| {
        let identification = &run.identification;
        let units = FieldUnits::new(campaign, run);
        let forced = identification.forced.as_ref();
        let mut row = vec![
            text(&run.id),
            text(&run.recording),
            text(run.run.kind.name()),
            text(&run.condition),
        ];
        row.extend([run.run.start_s, run.run.end_s, run.froude, run.speed_m_s].map(Cell::Number));
        for estimate in [
            Some(identification.natural_frequency_rad_s),
            Some(identification.damping.b1_per_s),
            Some(identification.damping.b3_s),
            units.at_comparison().map(|at| at.fitted_per_s),
            Some(units.inertia_kg_m2()),
            forced.map(|forced| forced.frequency_rad_s),
            forced.map(|forced| forced.roll_amplitude_rad),
            forced.map(|forced| forced.peak_moment_per_s2),
            forced.map(|forced| forced.work_damping_n_m_s),
        ] {
            row.extend(estimate_cells(estimate));
        }
        row.push(Cell::Number(identification.damping.correlation));
        row.push(Cell::Number(identification.resimulation.rmse_rad.to_degrees()));
        row
    });
    Table { name: "runs", headers, rows: rows.collect() }
}

fn equivalent_damping(campaign: &Campaign, results: &Results) -> Table {
    let mut headers = words(&["id", "condition", "Fr [-]", "amplitude [deg]", "extrapolated"]);
    for (name, unit) in [
        ("b_eq law", "1/s"),
        ("b_eq local", "1/s"),
        ("B_eq", "N m s"),
        ("B44hat", "-"),
        ("zeta", "-"),
        ("half-cycle decrement", "-"),
    ] {
        headers.extend(estimate_headers(name, unit));
    }
    let mut rows = Vec::new();
    for run in &results.runs {
        let units = FieldUnits::new(campaign, run);
        for at in &run.identification.equivalent_damping {
            let b = at.fitted_per_s;
            let mut row = vec![text(&run.id), text(&run.condition)];
            row.extend([run.froude, at.amplitude_deg].map(Cell::Number));
            row.push(Cell::Flag(at.extrapolated));
            for estimate in [
                Some(b),
                at.local_per_s,
                Some(units.moment(b)),
                Some(units.b44_hat(b)),
                Some(units.damping_ratio(b)),
                Some(units.half_cycle_decrement(b)),
            ] {
                row.extend(estimate_cells(estimate));
            }
            rows.push(row);
        }
    }
    Table { name: "equivalent_damping", headers, rows }
}

fn rejected(results: &Results) -> Table {
    let rows = results.rejected.iter().map(|stretch| {
        vec![
            text(&stretch.recording),
            Cell::Number(stretch.start_s),
            Cell::Number(stretch.end_s),
            text(&stretch.reason),
        ]
    });
    let headers = words(&["recording", "start [s]", "end [s]", "reason"]);
    Table { name: "rejected", headers, rows: rows.collect() }
}

fn froude_law(results: &Results) -> Table {
    let mut headers = words(&["condition"]);
    for (name, unit) in [("b0", "1/s"), ("kappa", "-"), ("b3", "s"), ("scatter of b1", "1/s")] {
        headers.extend(estimate_headers(name, unit));
    }
    let rows = results.froude_laws.iter().map(|law| {
        let mut row = vec![text(&law.condition)];
        for estimate in [law.b0_per_s, law.kappa, law.b3_s, law.scatter_per_s] {
            row.extend(estimate_cells(Some(estimate)));
        }
        row
    });
    Table { name: "froude_law", headers, rows: rows.collect() }
}

fn words(names: &[&str]) -> Vec<String> {
    names.iter().map(|&name| name.to_owned()).collect()
}

fn estimate_headers(name: &str, unit: &str) -> [String; 4] {
    ["mean", "sd", "lo95", "hi95"].map(|part| format!("{name} {part} [{unit}]"))
}

fn estimate_cells(estimate: Option<Estimate>) -> [Cell; 4] {
    let unknown = Estimate { mean: f64::NAN, sd: f64::NAN, lo95: f64::NAN, hi95: f64::NAN };
    let Estimate { mean, sd, lo95, hi95 } = estimate.unwrap_or(unknown);
    [mean, sd, lo95, hi95].map(Cell::Number)
}

fn text(text: &str) -> Cell {
    Cell::Text(text.to_owned())
}
