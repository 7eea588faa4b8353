//! What each channel of each run still holds beside noise, with tests of its whiteness.

use maud::{Markup, html};

use super::DiagnosisPage;
use crate::diagnosis::Leftover;
use crate::report::document::{number_cell, section, table};
use crate::report::number::{fixed, significant};

pub(super) fn part(page: &DiagnosisPage) -> Option<Markup> {
    let told = page.diagnosis;
    let rows: Vec<Markup> =
        told.left_before.iter().zip(&told.left_after).map(|(b, a)| row(b, a)).collect();
    let columns = [
        ("Run", ""),
        ("Channel", ""),
        ("Share before", "%"),
        ("Share after", "%"),
        ("Band", "σ"),
        ("Whiteness", "σ"),
        ("Strongest at", "rad/s"),
        ("Most at", "s"),
        ("Structure", ""),
    ];
    let caption = "Share: power at the frequencies of roll above the noise, of the channel's \
                   variance. Band: by how many standard deviations that power exceeds the noise \
                   after the extension. Whiteness: Ljung-Box statistic of 20 lags of means of ten.";
    (!rows.is_empty())
        .then(|| section("left", "What is left", &table("left-table", caption, &columns, &rows)))
}

fn row(before: &Leftover, after: &Leftover) -> Markup {
    html! {
        td.name { (after.run) }
        td { (after.channel) }
        (number_cell(&significant(100.0 * before.share, 2)))
        (number_cell(&significant(100.0 * after.share, 2)))
        (number_cell(&fixed(after.band_z, 1)))
        (number_cell(&fixed(after.whiteness_z, 1)))
        (number_cell(&fixed(after.frequency_rad_s, 2)))
        (number_cell(&fixed(after.time_s, 1)))
        td { @if after.is_sure() { "sure" } @else { "none" } }
    }
}
