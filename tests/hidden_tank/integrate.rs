//! One step of the implicit method of Gauss and Legendre with two stages, of order four.

/// Roll, roll rate, and what the hidden effects keep in mind.
pub(crate) type State = [f64; 10];

/// Stage coefficients `a` and abscissae `c` (Hairer, Norsett, Wanner 1993, Sec. II.7):
/// `a = [[1/4, 1/4 - r], [1/4 + r, 1/4]]`, `c = 1/2 -+ r`, `r = sqrt(3)/6`, weights one half.
const R: f64 = 0.288_675_134_594_812_9;

/// The state one step later; `rates(t, y)` is its time derivative.
///
/// The stages are found by fixed-point iteration, which converges for steps far shorter than the
/// fastest period; sixteen rounds bound the work where a switching effect keeps it from settling.
pub(crate) fn step(
    time_s: f64,
    step_s: f64,
    y: &State,
    n_states: usize,
    mut rates: impl FnMut(f64, &State) -> State,
) -> State {
    let times_s = [time_s + (0.5 - R) * step_s, time_s + (0.5 + R) * step_s];
    let first = rates(time_s + 0.5 * step_s, y);
    let mut k = [first, first];
    for _ in 0..16 {
        let mut change = 0.0_f64;
        for stage in 0..2 {
            let weights = if stage == 0 { [0.25, 0.25 - R] } else { [0.25 + R, 0.25] };
            let mut at = *y;
            for i in 0..n_states {
                at[i] += step_s * (weights[0] * k[0][i] + weights[1] * k[1][i]);
            }
            let new = rates(times_s[stage], &at);
            for i in 0..n_states {
                change = change.max((new[i] - k[stage][i]).abs());
            }
            k[stage] = new;
        }
        if change * step_s < 1e-13 {
            break;
        }
    }
    let mut next = *y;
    for i in 0..n_states {
        next[i] += 0.5 * step_s * (k[0][i] + k[1][i]);
    }
    next
}
