//! What the run says, in one line beneath its title.

use maud::{Markup, html};

use super::RunPage;
use crate::report::document::typeset;
use crate::report::notation;
use crate::report::number::{parts_within, significant};

/// Significant digits of each mean.
const N_DIGITS: i32 = 4;

pub(super) fn line(page: &RunPage) -> Markup {
    let (units, identification) = (page.field_units(), page.identification());
    let mut results = Vec::new();
    if let (Some(forced), Some(b)) = (&identification.forced, units.work_damping_per_s()) {
        let amplitude = significant(forced.roll_amplitude_rad.mean.to_degrees(), 3);
        results.push((format!("b_{{eq}}({amplitude}°)"), b, "1/s"));
    } else {
        let at_five = units.at_comparison().map(|at| at.fitted_per_s);
        results.extend(at_five.map(|b| ("b_{eq}(5°)".to_owned(), b, "1/s")));
        results.push(("b₁".to_owned(), identification.damping.b1_per_s, "1/s"));
        results.push(("b₃".to_owned(), identification.damping.b3_s, "s"));
    }
    html! {
        p.result {
            @for (index, (symbol, value, unit)) in results.iter().enumerate() {
                @let (mean, interval) = parts_within(value, N_DIGITS);
                @if index > 0 { " · " }
                (notation::html(symbol)) " = " b { (typeset(&mean)) } " "
                span.interval { (typeset(&interval)) } " " (unit)
            }
        }
    }
}
