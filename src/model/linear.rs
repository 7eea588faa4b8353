//! A driven linear system that changes in time, in steps: what small changes of a motion do.

/// A square matrix.
pub(super) type Matrix<const N: usize> = [[f64; N]; N];

/// One Runge-Kutta step of the fourth order of `s' = J(t) s + f(t)`, worked out once for every
/// forcing `f`.
#[derive(Debug, Clone)]
pub(super) struct Transition<const N: usize> {
    onward: Matrix<N>,
    of_start: Matrix<N>,
    of_middle: Matrix<N>,
    of_end: f64,
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
    /// From `J` at the start, in the middle and at the end of a step [s].
    pub(super) fn new(start: &Matrix<N>, middle: &Matrix<N>, end: &Matrix<N>, step_s: f64) -> Self {
        let (h, sixth) = (step_s, step_s / 6.0);
        // Slopes in the middle and at the end as functions of the state, and of the forcing at the
        // start (second, third, fourth) and in the middle.
        let second = product(middle, &shifted(1.0, 0.5 * h, start));
        let third = product(middle, &shifted(1.0, 0.5 * h, &second));
        let fourth = product(end, &shifted(1.0, h, &third));
        let second_of_start = shifted(0.0, 0.5 * h, middle);
        let third_of_start = product(middle, &shifted(0.0, 0.5 * h, &second_of_start));
        let fourth_of_start = product(end, &shifted(0.0, h, &third_of_start));
        let third_of_middle = shifted(1.0, 0.5 * h, middle);
        let fourth_of_middle = product(end, &shifted(0.0, h, &third_of_middle));
        let mean = |one: f64, two: &Matrix<N>, three: &Matrix<N>, four: &Matrix<N>| {
            let sum = plus(&plus(four, 2.0, three), 2.0, two);
            shifted(one, sixth, &sum)
        };
        let onward = plus(&mean(1.0, &second, &third, &fourth), sixth, start);
        let of_start = mean(sixth, &second_of_start, &third_of_start, &fourth_of_start);
        let nothing = [[0.0; N]; N];
        let of_middle = mean(2.0 * sixth, &nothing, &third_of_middle, &fourth_of_middle);
        Self { onward, of_start, of_middle, of_end: sixth }
    }

    /// The state a step later, given the forcing at the start, in the middle and at the end.
    pub(super) fn step(&self, state: &[f64; N], forcing: [&[f64; N]; 3]) -> [f64; N] {
        let mut next = [0.0; N];
        for (i, next) in next.iter_mut().enumerate() {
            let mut driven = self.of_end * forcing[2][i];
            for j in 0..N {
                driven += self.of_start[i][j] * forcing[0][j];
                driven += self.of_middle[i][j] * forcing[1][j];
            }
            *next = driven + (0..N).map(|j| self.onward[i][j] * state[j]).sum::<f64>();
        }
        next
    }
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

/// A state in the middle of a step, by the cubic through both ends.
pub(super) fn middle<const N: usize>(
    [start, end]: [&[f64; N]; 2],
    [from, to]: [&[f64; N]; 2],
    step_s: f64,
) -> [f64; N] {
    std::array::from_fn(|i| 0.5 * (start[i] + end[i]) + 0.125 * step_s * (from[i] - to[i]))
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
