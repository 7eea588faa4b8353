//! The gates of all runs of one condition at one speed together.

mod frequency_ladder;
mod repeats;

use serde::Serialize;

use super::gate::Answer;
use crate::results::{IdentifiedRun, Results, by_speed};

/// Answers from the runs of one condition at one speed.
type CampaignGate = fn(&[&IdentifiedRun]) -> Option<Answer>;

/// Every gate; one that these runs have nothing to do with gives no answer.
const GATES: [CampaignGate; 2] = [repeats::answer, frequency_ladder::answer];

/// What the procedure says of the runs of one condition at one speed.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct CampaignAnswer {
    /// Loading or appendage condition.
    pub condition: String,
    /// Mean Froude number of the runs [-].
    pub froude: f64,
    /// The answer.
    #[serde(flatten)]
    pub answer: Answer,
}

/// What the procedure says of each condition at each speed.
pub fn of_campaign(results: &Results) -> Vec<CampaignAnswer> {
    let mut answers = Vec::new();
    for condition in results.conditions() {
        let runs = results.runs.iter().filter(|run| run.condition == condition).collect();
        for runs in by_speed(runs) {
            let froude = runs.iter().map(|run| run.froude).sum::<f64>() / runs.len() as f64;
            answers.extend(
                GATES.iter().filter_map(|answer| answer(&runs)).map(|answer| CampaignAnswer {
                    condition: condition.to_owned(),
                    froude,
                    answer,
                }),
            );
        }
    }
    answers
}
