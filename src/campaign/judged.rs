//! What people have judged, read with the campaign, its mistakes among the campaign's.

use std::path::Path;

use super::mistake::Mistake;
use crate::judgement::{self, JUDGEMENTS_FILE, Judgements};

/// The judgements of a campaign.
pub(super) fn read(folder: &Path) -> Result<Judgements, Vec<Mistake>> {
    let path = folder.join(JUDGEMENTS_FILE).display().to_string();
    let told = |line, message| Mistake {
        file: path.clone(),
        line,
        message,
        hint: Some("the live page writes it; mend or remove the line by hand".to_owned()),
    };
    let text = judgement::read(folder)
        .map_err(|error| vec![told(None, format!("cannot be read: {error}"))])?;
    Judgements::parse(&text).map_err(|bad| {
        bad.into_iter()
            .map(|bad| told(Some(bad.line), format!("is no judgement: {}", bad.message)))
            .collect()
    })
}
