//! Keeps samples out that cannot be true, and says so.

use devices::{Quantity, Sample};

use super::Event;
use super::Rejection;

/// Why samples are passed over.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Fault {
    NotFinite,
    Backwards { after_s: f64 },
    OutOfRange { value: f64, limit: f64 },
}

/// Samples of one channel passed over one after the other.
#[derive(Debug, Clone, Copy)]
struct Spell {
    fault: Fault,
    quantity: Quantity,
    start_s: f64,
    end_s: f64,
    n: usize,
}

/// Samples that were not used; one spell per channel at a time.
#[derive(Debug, Clone, Default)]
pub(super) struct PassedOver {
    spells: Vec<Spell>,
}

/// Latest time stamp [s] whose rounding still parts samples at 5 kHz.
const TIME_MAX_S: f64 = 1e10;

/// Greatest magnitude of a quantity in its SI unit: half a turn, what no rod or carriage exceeds.
fn limit(quantity: Quantity) -> f64 {
    match quantity {
        Quantity::Roll => std::f64::consts::PI,
        Quantity::Force | Quantity::Moment => 1e7,
        Quantity::Speed => 100.0,
    }
}

impl PassedOver {
    /// Whether `sample` can be used after the channel's last one at `last_s`; the spell of those
    /// passed over before it is reported.
    pub(super) fn admits(
        &mut self,
        sample: &Sample,
        last_s: Option<f64>,
        events: &mut Vec<Event>,
    ) -> bool {
        let Sample { quantity, time_s, value } = *sample;
        let limit = limit(quantity);
        let fault = if !time_s.is_finite() || !value.is_finite() || time_s.abs() > TIME_MAX_S {
            Some(Fault::NotFinite)
        } else if let Some(after_s) = last_s.filter(|&last_s| time_s < last_s) {
            Some(Fault::Backwards { after_s })
        } else if value.abs() > limit {
            Some(Fault::OutOfRange { value, limit })
        } else {
            None
        };
        let at = self.spells.iter().position(|s| s.quantity == quantity);
        match (fault, at) {
            (None, None) => {}
            (None, Some(at)) => events.push(self.spells.remove(at).event()),
            (Some(_), Some(at)) => {
                let spell = &mut self.spells[at];
                spell.n += 1;
                if time_s.is_finite() {
                    spell.start_s = spell.start_s.min(time_s);
                    spell.end_s = spell.end_s.max(time_s);
                }
            }
            (Some(fault), None) => {
                let at_s = if time_s.is_finite() { time_s } else { last_s.unwrap_or(0.0) };
                let spell = Spell { fault, quantity, start_s: at_s, end_s: at_s, n: 1 };
                self.spells.push(spell);
            }
        }
        fault.is_none()
    }

    /// Reports what was passed over last.
    pub(super) fn flush(&mut self, events: &mut Vec<Event>) {
        events.extend(self.spells.drain(..).map(Spell::event));
    }
}

impl Spell {
    fn event(self) -> Event {
        let (name, unit, n) = (self.quantity.name(), self.quantity.unit(), self.n);
        let why = match self.fault {
            Fault::NotFinite => "no number, or a time stamp beyond any clock".to_owned(),
            Fault::Backwards { after_s } => format!(
                "time runs backwards from {after_s:.3} s to {:.3} s",
                self.start_s.min(after_s)
            ),
            Fault::OutOfRange { value, limit } => format!(
                "{name} of {} {unit} is beyond {limit:.2} {unit}; hint: check the unit of the \
                 channel",
                short(value)
            ),
        };
        Event::Rejected(Rejection {
            start_s: self.start_s,
            end_s: self.end_s,
            reason: format!("{n} samples of {name} passed over: {why}"),
        })
    }
}

/// A number whose digits stay few, however large it is.
fn short(value: f64) -> String {
    if value.abs() < 1e9 { format!("{value:.3}") } else { format!("{value:.3e}") }
}
