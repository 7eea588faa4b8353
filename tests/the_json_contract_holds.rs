//! The JSON that other programs read: its keys, its schema, its bytes.

use rolltank::inverse::estimate::Estimate;
use rolltank::report::{IDENTIFICATION_SCHEMA, identification_json};
use rolltank::results::Results;
use serde::Serialize;
use serde_json::{Value, json};

use crate::{json_schema, synthetic_results};

fn parsed(results: &Results) -> Value {
    let campaign = synthetic_results::campaign("OE basin");
    serde_json::from_str(&identification_json(&campaign, results)).expect("JSON")
}

/// The value as this test reads it back: the same text gives the same number.
fn read_back(value: impl Serialize) -> Value {
    let text = serde_json::to_string(&value).expect("a value of the contract");
    serde_json::from_str(&text).expect("JSON")
}

#[test]
fn the_document_keeps_the_schema_that_is_shipped_with_it() {
    let schema: Value = serde_json::from_str(IDENTIFICATION_SCHEMA).unwrap();
    assert_eq!(
        json_schema::violations(&schema, &parsed(&synthetic_results::results())),
        Vec::<String>::new()
    );
    assert_eq!(
        json_schema::violations(&schema, &parsed(&Results::default())),
        Vec::<String>::new()
    );
}

#[test]
fn the_schema_knows_every_key_that_is_written() {
    let schema: Value = serde_json::from_str(IDENTIFICATION_SCHEMA).unwrap();
    let document = parsed(&synthetic_results::results());
    let known = |pointer: &str| schema.pointer(pointer).unwrap().as_object().unwrap().clone();
    for (written, properties) in [
        (&document, "/properties"),
        (&document["runs"][0], "/properties/runs/items/properties"),
        (&document["rejected"][0], "/properties/rejected/items/properties"),
        (&document["froude_law"][0], "/properties/froude_law/items/properties"),
    ] {
        let known = known(properties);
        for key in written.as_object().unwrap().keys() {
            assert!(known.contains_key(key), "{properties} lacks {key}");
        }
    }
}

#[test]
fn a_document_that_breaks_the_schema_is_noticed() {
    let schema: Value = serde_json::from_str(IDENTIFICATION_SCHEMA).unwrap();
    let mut document = parsed(&synthetic_results::results());
    document["runs"][0]["kind"] = json!("dance");
    document["runs"][1].as_object_mut().unwrap().remove("b3_s");
    document["runs"][2]["b1_per_s"]["mean"] = json!("0.38");
    assert_eq!(json_schema::violations(&schema, &document).len(), 3);
}

#[test]
fn the_keys_that_other_programs_rely_on_are_there_with_their_values() {
    let results = synthetic_results::results();
    let document = parsed(&results);
    assert_eq!(document["schema"], "rolltank.identification/1");
    for (run, written) in results.runs.iter().zip(document["runs"].as_array().unwrap()) {
        let identification = &run.identification;
        assert_eq!(written["id"], read_back(&run.id));
        assert_eq!(written["recording"], read_back(&run.recording));
        assert_eq!(written["condition"], read_back(&run.condition));
        assert_eq!(written["start_s"], read_back(run.run.start_s));
        assert_eq!(written["end_s"], read_back(run.run.end_s));
        assert_eq!(written["froude"], read_back(run.froude));
        assert_eq!(written["speed_m_s"], read_back(run.speed_m_s));
        let frequency = identification.natural_frequency_rad_s;
        assert_eq!(written["natural_frequency_rad_s"], read_back(frequency));
        assert_eq!(written["b1_per_s"], read_back(identification.damping.b1_per_s));
        assert_eq!(written["b3_s"], read_back(identification.damping.b3_s));
        assert_eq!(written["inertia_kg_m2"], read_back(identification.inertia_kg_m2));
        let at = identification.equivalent_damping[3];
        let written_at = &written["equivalent_damping_per_s"][3];
        assert_eq!(written_at["amplitude_deg"], read_back(at.amplitude_deg));
        assert_eq!(written_at["value"], read_back(at.fitted_per_s));
        let rmse_deg = identification.resimulation.rmse_rad.to_degrees();
        assert_eq!(written["resimulation_rmse_deg"], read_back(rmse_deg));
    }
    assert_eq!(document["rejected"].as_array().unwrap().len(), results.rejected.len());
    assert_eq!(document["froude_law"][1]["kappa"], read_back(results.froude_laws[1].kappa));
}

#[test]
fn the_same_results_give_the_same_bytes() {
    let campaign = synthetic_results::campaign("OE basin");
    let first = identification_json(&campaign, &synthetic_results::results());
    let second = identification_json(&campaign, &synthetic_results::results());
    assert!(first == second);
}

#[test]
fn a_number_that_is_not_known_is_null() {
    let mut results = synthetic_results::results();
    let unknown = Estimate { mean: f64::NAN, sd: f64::INFINITY, lo95: f64::NAN, hi95: f64::NAN };
    results.runs[0].identification.damping.b3_s = unknown;
    let document = parsed(&results);
    let written = &document["runs"][0]["b3_s"];
    assert!(written["mean"].is_null() && written["sd"].is_null());
    let schema: Value = serde_json::from_str(IDENTIFICATION_SCHEMA).unwrap();
    assert_eq!(json_schema::violations(&schema, &document), Vec::<String>::new());
}

#[test]
fn damping_is_written_in_the_units_of_the_field_too() {
    let results = synthetic_results::results();
    let document = parsed(&results);
    let run = &results.runs[0];
    let at = &document["runs"][0]["equivalent_damping_per_s"][3];
    let (b, w) = (
        run.identification.equivalent_damping[3].fitted_per_s.mean,
        run.identification.natural_frequency_rad_s.mean,
    );
    // K = rho g V GM of the paper's Table 1, worked by hand.
    let inertia = 1000.0 * 9.81 * 0.110 * 0.074 / (w * w);
    let b44_hat = b * inertia / (1000.0 * 0.110 * 0.387 * 0.387) * (0.387_f64 / 19.62).sqrt();
    for (key, expected) in [
        ("moment_n_m_s", b * inertia),
        ("b44_hat", b44_hat),
        ("damping_ratio", b / (2.0 * w)),
        ("half_cycle_decrement", std::f64::consts::PI * b / (2.0 * w)),
    ] {
        let written = at[key]["mean"].as_f64().unwrap();
        // Equal but for the order of the products.
        assert!((written / expected - 1.0).abs() < 1e-12, "{key}: {written}, not {expected}");
    }
}

#[test]
fn a_decay_tells_the_forms_of_its_law_and_a_forced_run_has_none() {
    let results = synthetic_results::results();
    let document = parsed(&results);
    for (run, written) in results.runs.iter().zip(document["runs"].as_array().unwrap()) {
        let Some(beliefs) = &run.identification.beliefs else {
            assert!(written["beliefs"].is_null() && written["damping_curve"] == json!([]));
            continue;
        };
        let form = &written["beliefs"]["forms"][0];
        assert_eq!(form["equation"], beliefs.forms[0].equation);
        assert_eq!(form["probability"], read_back(beliefs.forms[0].probability));
        let (symbol, unit, value) = beliefs.forms[0].coefficients[0];
        assert_eq!(form["coefficients"][0]["symbol"], symbol);
        assert_eq!(form["coefficients"][0]["unit"], unit);
        assert_eq!(form["coefficients"][0]["value"], read_back(value));
        let last = run.identification.damping_curve.last().expect("a decay has a curve");
        let written = written["damping_curve"].as_array().unwrap().last().unwrap();
        assert_eq!(written["value"], read_back(last.damping_per_s2));
    }
}
