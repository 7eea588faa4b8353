//! A run that is not what its label says.

use crate::hidden_tank::effect::{Hidden, Row};
use crate::hidden_tank::plan::Pass;

/// One run with another hull (kind 0), a speed in knots (1) or a reversed load cell (2); where
/// the campaign has no run for a kind, it is another hull. A size is a kind here.
pub(crate) const MISLABELLED: Row = Row {
    id: "run.mislabelled",
    symbols: &["kind [-]", "place [-]"],
    draw: |size, draw, _| {
        let kind = if size < 0.75 {
            1.0
        } else if size < 1.5 {
            0.0
        } else {
            2.0
        };
        vec![kind, draw.between(0.0, 1.0)]
    },
    hide: |values| Box::new(Mislabelled { kind: values[0] as usize, place: values[1] }),
};

struct Mislabelled {
    kind: usize,
    place: f64,
}

impl Hidden for Mislabelled {
    fn plan(&mut self, passes: &mut [Pass]) {
        let fits = |pass: &Pass| match self.kind {
            // In knots it must still be a speed that the carriage can do.
            1 => (0.1..1.0).contains(&pass.speed_m_s),
            2 => pass.is_forced(),
            _ => true,
        };
        let able: Vec<usize> =
            passes.iter().filter(|pass| fits(pass)).map(|pass| pass.index).collect();
        let kind = if able.is_empty() { 0 } else { self.kind };
        let able = if able.is_empty() { (0..passes.len()).collect() } else { able };
        let pass = &mut passes[able[(self.place * able.len() as f64) as usize]];
        match kind {
            1 => pass.speed_shown = 1.0 / 0.514_444,
            2 => pass.force_reversed = true,
            _ => pass.other_hull = true,
        }
    }
}
