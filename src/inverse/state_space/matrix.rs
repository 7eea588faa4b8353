//! Small square matrices whose size is known to the compiler.

/// An `N` by `N` matrix, row by row.
pub type Matrix<const N: usize> = [[f64; N]; N];

/// The identity.
pub fn identity<const N: usize>() -> Matrix<N> {
    let mut a = [[0.0; N]; N];
    for (i, row) in a.iter_mut().enumerate() {
        row[i] = 1.0;
    }
    a
}

/// The product `A B`.
pub fn product<const N: usize>(a: &Matrix<N>, b: &Matrix<N>) -> Matrix<N> {
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

/// The product `A x`.
pub fn apply<const N: usize>(a: &Matrix<N>, x: &[f64; N]) -> [f64; N] {
    std::array::from_fn(|i| a[i].iter().zip(x).map(|(a, x)| a * x).sum())
}

/// The product `A' x`.
pub fn apply_transposed<const N: usize>(a: &Matrix<N>, x: &[f64; N]) -> [f64; N] {
    let mut y = [0.0; N];
    for (row, x) in a.iter().zip(x) {
        for (y, a) in y.iter_mut().zip(row) {
            *y += a * x;
        }
    }
    y
}

/// The product `A' B A` of a symmetric `B`.
pub fn congruence<const N: usize>(a: &Matrix<N>, b: &Matrix<N>) -> Matrix<N> {
    let ba = product(b, a);
    let mut c = [[0.0; N]; N];
    for i in 0..N {
        for j in 0..N {
            c[i][j] = (0..N).map(|k| a[k][i] * ba[k][j]).sum();
        }
    }
    c
}

/// The exponential of `A`, by its power series on a halved argument.
pub fn exponential<const N: usize>(a: &Matrix<N>) -> Matrix<N> {
    let norm = a.iter().map(|row| row.iter().map(|v| v.abs()).sum::<f64>()).fold(0.0, f64::max);
    let halvings = norm.log2().ceil().max(-1.0) as i32 + 1;
    let scale = 0.5_f64.powi(halvings);
    let scaled = a.map(|row| row.map(|v| v * scale));
    let mut term = identity::<N>();
    let mut sum = term;
    // Norm at most 1/2: the fifteenth term is below 2e-17.
    for n in 1..=15 {
        term = product(&term, &scaled).map(|row| row.map(|v| v / f64::from(n)));
        for (sum, term) in sum.iter_mut().flatten().zip(term.iter().flatten()) {
            *sum += term;
        }
    }
    for _ in 0..halvings {
        sum = product(&sum, &sum);
    }
    sum
}

/// The lower triangular `L` with `L L' = sum of c c'` over the columns, by Householder reflections.
///
/// The sum is never formed, so no digits are lost to squaring.
pub fn triangular_root<const N: usize>(columns: &mut [[f64; N]]) -> Matrix<N> {
    let mut root = [[0.0; N]; N];
    for pivot in 0..N.min(columns.len()) {
        // Reflect so that row `pivot` is zero in every column after the first `pivot + 1`.
        let norm = columns[pivot..].iter().map(|c| c[pivot] * c[pivot]).sum::<f64>().sqrt();
        if norm == 0.0 {
            continue;
        }
        let head = columns[pivot][pivot];
        let signed = if head > 0.0 { -norm } else { norm };
        // The reflector is v = row - signed e_1, and v'v / 2 = norm (norm + |head|).
        let half_square = norm * (norm + head.abs());
        for row in pivot + 1..N {
            let along = columns[pivot..].iter().map(|c| c[row] * c[pivot]).sum::<f64>()
                - signed * columns[pivot][row];
            let factor = along / half_square;
            columns[pivot][row] -= factor * (head - signed);
            for column in &mut columns[pivot + 1..] {
                column[row] -= factor * column[pivot];
            }
        }
        columns[pivot][pivot] = signed;
        for row in pivot..N {
            // The sign is free; a positive diagonal makes the root unique.
            root[row][pivot] = columns[pivot][row] * signed.signum();
        }
    }
    root
}

/// The lower triangular `L` with `L L' = A A' + B B'`, by Householder reflections of `[A B]`; `B`
/// is lower triangular.
///
/// What [`triangular_root`] does, for the one size that every step of the filter needs.
pub fn joined_root<const N: usize>(mut a: Matrix<N>, mut b: Matrix<N>) -> Matrix<N> {
    let mut root = [[0.0; N]; N];
    for pivot in 0..N {
        let (lead, tail) = (a[pivot], b[pivot]);
        // A step waits for these sums, so the two halves of each are summed side by side. No
        // reflection fills what is right of the diagonal of `B`.
        let sum = |a: &[f64; N], b: &[f64; N]| {
            let (mut of_a, mut of_b) = (0.0, 0.0);
            for j in pivot..N {
                of_a += a[j] * lead[j];
            }
            for j in 0..=pivot {
                of_b += b[j] * tail[j];
            }
            of_a + of_b
        };
        let square = sum(&lead, &tail);
        if square == 0.0 {
            continue;
        }
        let norm = square.sqrt();
        let signed = if lead[pivot] > 0.0 { -norm } else { norm };
        // The reflector is v = row - signed e_1, and v'v / 2 = norm (norm + |head|).
        let per_half_square = (square + norm * lead[pivot].abs()).recip();
        // The sign is free; a positive diagonal makes the root unique.
        let sign = signed.signum();
        root[pivot][pivot] = norm;
        for row in pivot + 1..N {
            let along = sum(&a[row], &b[row]) - signed * a[row][pivot];
            let factor = along * per_half_square;
            root[row][pivot] = sign * (a[row][pivot] - factor * (lead[pivot] - signed));
            for j in pivot + 1..N {
                a[row][j] -= factor * lead[j];
            }
            for j in 0..=pivot {
                b[row][j] -= factor * tail[j];
            }
        }
    }
    root
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_root_of_a_sum_of_columns_multiplies_back_to_it() {
        let columns = [[3.0, 1.0, -2.0], [0.5, 4.0, 1.0], [-1.0, 2.0, 0.1], [2.0, 2.0, 2.0]];
        let root = triangular_root(&mut columns.clone());
        for i in 0..3 {
            for j in 0..3 {
                let sum: f64 = columns.iter().map(|c| c[i] * c[j]).sum();
                let back: f64 = (0..3).map(|k| root[i][k] * root[j][k]).sum();
                assert!((sum - back).abs() < 1e-13, "{sum} {back}");
                assert!(j <= i || root[i][j] == 0.0);
            }
        }
    }

    #[test]
    fn the_joined_root_is_the_root_of_all_columns() {
        let a = [[3.0, 1.0, -2.0], [0.5, 4.0, 1.0], [-1.0, 2.0, 0.1]];
        let b = [[2.0, 0.0, 0.0], [0.3, 1.5, 0.0], [-0.7, 0.2, 0.0]];
        let column = |m: &Matrix<3>, j: usize| [m[0][j], m[1][j], m[2][j]];
        let mut columns = [0, 1, 2].map(|j| column(&a, j)).to_vec();
        columns.extend([0, 1, 2].map(|j| column(&b, j)));
        let (whole, joined) = (triangular_root(&mut columns), joined_root(a, b));
        for (x, y) in whole.iter().flatten().zip(joined.iter().flatten()) {
            assert!((x - y).abs() < 1e-14, "{x} {y}");
        }
        assert_eq!(joined_root([[0.0; 2]; 2], [[0.0; 2]; 2]), [[0.0; 2]; 2]);
    }

    #[test]
    fn the_exponential_of_a_rotation_turns_by_its_angle() {
        for angle in [0.0, 1e-9, 0.3, 2.0, 11.0_f64] {
            let turned = exponential(&[[0.0, angle], [-angle, 0.0]]);
            assert!((turned[0][0] - angle.cos()).abs() < 1e-13);
            assert!((turned[0][1] - angle.sin()).abs() < 1e-13);
        }
    }
}
