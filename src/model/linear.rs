//! A driven linear system that changes in time, in steps: what small changes of a motion do.

/// A square matrix.
pub(super) type Matrix<const N: usize> = [[f64; N]; N];

/// One step of `s' = J(t) s + f(t)`, worked out once for every forcing `f`: the exponential of the
/// mean `J`, and a forcing that is a parabola through its start, middle and end.
#[derive(Debug, Clone)]
pub(super) struct Transition<const N: usize> {
    onward: Matrix<N>,
    of: [Matrix<N>; 3],
}

/// Terms of the exponential's series: to 1e-5 at a radian and a half a step, and at three where
/// a state that remembers turns faster than the roll that it presses on.
const fn n_terms(n_states: usize) -> usize {
    if n_states > 2 { 10 } else { 6 }
}

fn product<const N: usize>(a: &Matrix<N>, b: &Matrix<N>) -> Matrix<N> {
    let mut c = [[0.0; N]; N];
    for i in 0..N {
        for k in 0..N {
            for j in 0..N {
                c[i][j] += a[i][k] * b[k][j];
            }
        }
    }
    c
}

/// `alpha 1 + beta A`.
fn shifted<const N: usize>(alpha: f64, beta: f64, a: &Matrix<N>) -> Matrix<N> {
    let mut b = a.map(|row| row.map(|v| beta * v));
    for (i, row) in b.iter_mut().enumerate() {
        row[i] += alpha;
    }
    b
}

/// Entry by entry, `a + beta b`.
fn plus<const N: usize>(a: &Matrix<N>, beta: f64, b: &Matrix<N>) -> Matrix<N> {
    std::array::from_fn(|i| std::array::from_fn(|j| a[i][j] + beta * b[i][j]))
}

/// A matrix times a vector.
pub(super) fn times<const N: usize>(a: &Matrix<N>, s: &[f64; N]) -> [f64; N] {
    a.map(|row| row.iter().zip(s).map(|(a, s)| a * s).sum())
}

impl<const N: usize> Transition<N> {
    /// From `J` at the start, in the middle and at the end of a step [s]: the Magnus expansion to
    /// the fourth order.
    pub(super) fn new(start: &Matrix<N>, middle: &Matrix<N>, end: &Matrix<N>, step_s: f64) -> Self {
        let sixth = step_s / 6.0;
        let mean = plus(&plus(start, 4.0, middle), 1.0, end);
        let turned = plus(&product(start, end), -1.0, &product(end, start));
        let whole = plus(&shifted(0.0, sixth, &mean), -step_s * step_s / 12.0, &turned);
        // `phi_m = sum A^k/(k + m)!`, from the third down to the exponential itself.
        let factorial = |n: usize| (1..=n).map(|k| k as f64).product::<f64>();
        let n_terms = n_terms(N);
        let mut third = shifted(factorial(n_terms + 3).recip(), 0.0, &whole);
        for k in (0..n_terms).rev() {
            third = shifted(factorial(k + 3).recip(), 1.0, &product(&whole, &third));
        }
        let second = shifted(0.5, 1.0, &product(&whole, &third));
        let first = shifted(1.0, 1.0, &product(&whole, &second));
        let onward = shifted(1.0, 1.0, &product(&whole, &first));
        let h = step_s;
        let of_start = plus(&plus(&first, -3.0, &second), 4.0, &third);
        let of_middle = plus(&shifted(0.0, 4.0, &second), -8.0, &third);
        let of_end = plus(&shifted(0.0, -1.0, &second), 4.0, &third);
        Self { onward, of: [of_start, of_middle, of_end].map(|of| shifted(0.0, h, &of)) }
    }

    /// The state a step later, given the forcing at the start, in the middle and at the end.
    pub(super) fn step(&self, state: &[f64; N], forcing: [&[f64; N]; 3]) -> [f64; N] {
        let parts = self.of.iter().zip(forcing).map(|(of, forcing)| times(of, forcing));
        parts
            .fold(times(&self.onward, state), |sum, part| std::array::from_fn(|i| sum[i] + part[i]))
    }
}

/// States of a system that does not change in time at every point, from those at the first.
pub(super) fn driven<const N: usize>(
    jacobian: &Matrix<N>,
    start: [f64; N],
    forcing: impl Fn(usize) -> [f64; N],
    n_points: usize,
    step_s: f64,
) -> Vec<[f64; N]> {
    let transition = Transition::new(jacobian, jacobian, jacobian, step_s);
    let forcing: Vec<[f64; N]> = (0..n_points).map(forcing).collect();
    let last = n_points - 1;
    let mut state = start;
    let mut states = Vec::with_capacity(n_points);
    states.push(state);
    for k in 0..last {
        let [a, b, c, d] = [k.saturating_sub(1), k, k + 1, (k + 2).min(last)];
        let middle = std::array::from_fn(|i| {
            let sides = forcing[a][i] + forcing[d][i];
            0.5625 * (forcing[b][i] + forcing[c][i]) - 0.0625 * sides
        });
        state = transition.step(&state, [&forcing[b], &middle, &forcing[c]]);
        states.push(state);
    }
    states
}

/// What lies between points at equal distances, by a parabola through the nearest three.
pub(super) fn between<const N: usize>(points: &[[f64; N]], place: f64) -> [f64; N] {
    let middle = (place.round().max(1.0) as usize).min(points.len() - 2);
    let x = place - middle as f64;
    let (a, b, c) = (&points[middle - 1], &points[middle], &points[middle + 1]);
    std::array::from_fn(|i| {
        b[i] + 0.5 * x * (c[i] - a[i]) + 0.5 * x * x * (a[i] - 2.0 * b[i] + c[i])
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_driven_oscillator_goes_where_its_formula_says() {
        // x'' = -x + t: from rest, x = t - sin t.
        let j = [[0.0, 1.0], [-1.0, 0.0]];
        let h = 0.05;
        let transition = Transition::new(&j, &j, &j, h);
        let mut state = [0.0, 0.0];
        for k in 0..60 {
            let t = h * f64::from(k);
            let forcing = [t, t + 0.5 * h, t + h].map(|t| [0.0, t]);
            state = transition.step(&state, [&forcing[0], &forcing[1], &forcing[2]]);
        }
        assert!((state[0] - (3.0 - 3_f64.sin())).abs() < 1e-6, "{state:?}");
        assert!((state[1] - (1.0 - 3_f64.cos())).abs() < 1e-6, "{state:?}");
    }
}
