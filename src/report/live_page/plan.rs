//! The test plan with what is done of it.

use maud::{Markup, html};

use crate::report::campaign_page::{CampaignPage, plan_parts};

pub(super) fn part(page: &CampaignPage) -> Markup {
    plan_parts(page).unwrap_or_else(|| {
        html! {
            p.note {
                "There is no test plan: write [[plan]] tables in campaign.toml, or name a CSV file."
            }
        }
    })
}
