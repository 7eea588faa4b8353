//! What is told of a campaign: a verdict, causes in order of entry, and every effect's rank.

use super::growth::{Grown, grow};
use super::observation::Observation;
use super::solve::Layout;
use super::survey::Survey;
use crate::inverse::estimate::Estimate;
use crate::model::effects;

/// The verdict.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Verdict {
    /// Nothing is wrong.
    Adequate,
    /// The causes are known.
    Named,
    /// These runs cannot part some cause from others.
    Ambiguous,
    /// Structure is left that no effect explains.
    Unexplained,
}

/// One effect of the extended model.
#[derive(Debug, Clone, PartialEq)]
pub struct Cause {
    /// The effect.
    pub effect: &'static str,
    /// Its equation.
    pub equation: &'static str,
    /// Logarithm of the Bayes factor for adding it [-].
    pub log_bayes_factor: f64,
    /// Parameters: symbol, unit, estimate; the runs or conditions one after the other.
    pub parameters: Vec<(&'static str, &'static str, Estimate)>,
    /// Effects that these runs cannot part from it.
    pub equivalent_to: Vec<&'static str>,
}

/// What a campaign's runs say about the simulation model.
#[derive(Debug, Clone, PartialEq)]
pub struct Diagnosis {
    /// The verdict.
    pub verdict: Verdict,
    /// Causes in order of entry.
    pub causes: Vec<Cause>,
    /// Every effect with the logarithm of its Bayes factor against the base model, best first.
    pub ranking: Vec<(&'static str, f64)>,
}

/// Diagnoses the runs of a campaign; none without runs.
pub fn diagnose(runs: Vec<Observation>) -> Option<Diagnosis> {
    if runs.is_empty() {
        return None;
    }
    let survey = Survey::new(runs);
    let grown = grow(&survey);
    let causes = causes(&survey, &grown);
    let verdict = if causes.iter().any(|cause| !cause.equivalent_to.is_empty()) {
        Verdict::Ambiguous
    } else if !causes.is_empty() {
        Verdict::Named
    } else {
        Verdict::Adequate
    };
    Some(Diagnosis { verdict, causes, ranking: grown.ranking })
}

fn causes(survey: &Survey, grown: &Grown) -> Vec<Cause> {
    let fit = &grown.last.fit;
    let layout = Layout::new(survey, fit);
    let told = grown.entered.iter().enumerate().map(|(e, entered)| {
        let extension = &fit.extensions[e];
        let mut parameters = Vec::new();
        for (s, values) in extension.slots.iter().enumerate() {
            for (k, value) in values.iter().enumerate() {
                let column = layout.parameter(fit, e, s, k);
                let sd = grown.last.solution.covariance[column][column].max(0.0).sqrt();
                let parameter = extension.effect.parameter(k);
                parameters.push((parameter.symbol, parameter.unit, Estimate::normal(*value, sd)));
            }
        }
        let mut equivalent_to = entered.equivalent_to.clone();
        equivalent_to.extend(extension.effect.always_equivalent);
        let equation = effects::effect(entered.id).map_or("", |effect| effect.equation);
        Cause {
            effect: entered.id,
            equation,
            log_bayes_factor: entered.log_bayes_factor,
            parameters,
            equivalent_to,
        }
    });
    told.collect()
}
