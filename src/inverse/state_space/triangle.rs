//! A tall matrix reduced to its upper triangle as its rows arrive.

/// Rows that are reduced together: enough to share the square roots, few enough to stay in cache.
const N_TOGETHER: usize = 32;

/// The upper triangle `R` of a tall matrix `A`, so that `R'R = A'A`.
#[derive(Debug, Clone)]
pub struct Triangle {
    size: usize,
    /// Column by column: the triangle's column, then the waiting rows' part of it.
    columns: Vec<f64>,
    n_waiting: usize,
}

impl Triangle {
    /// The triangle of a matrix of `size` columns without rows.
    pub fn new(size: usize) -> Self {
        Self { size, columns: vec![0.0; size * (size + N_TOGETHER)], n_waiting: 0 }
    }

    /// Number of columns.
    pub fn size(&self) -> usize {
        self.size
    }

    /// Entry of row `i`, column `j`, once [`Triangle::settle`] has taken the last rows in.
    pub fn at(&self, i: usize, j: usize) -> f64 {
        debug_assert_eq!(self.n_waiting, 0, "rows are waiting");
        self.columns[j * self.stride() + i]
    }

    /// Adds a row; it waits until enough of them are there or [`Triangle::settle`] is called.
    pub fn push(&mut self, row: impl IntoIterator<Item = f64>) {
        let (stride, place) = (self.stride(), self.size + self.n_waiting);
        for (column, value) in self.columns.chunks_exact_mut(stride).zip(row) {
            column[place] = value;
        }
        self.n_waiting += 1;
        if self.n_waiting == N_TOGETHER {
            self.settle();
        }
    }

    /// Adds a row at once.
    pub fn add(&mut self, row: &[f64]) {
        self.push(row.iter().copied());
        self.settle();
    }

    /// Takes the waiting rows into the triangle by Householder reflections.
    pub fn settle(&mut self) {
        let (stride, size, waiting) = (self.stride(), self.size, self.n_waiting);
        if waiting == 0 {
            return;
        }
        for pivot in 0..size {
            let (done, rest) = self.columns.split_at_mut((pivot + 1) * stride);
            let column = &mut done[pivot * stride..];
            let tail = size..size + waiting;
            let head = column[pivot];
            let below = dot(&column[tail.clone()], &column[tail.clone()]);
            if below == 0.0 {
                continue;
            }
            let norm = (head * head + below).sqrt();
            let signed = if head > 0.0 { -norm } else { norm };
            // The reflector is (head - signed, tail), half its square norm (norm + |head|).
            let lead = head - signed;
            let half_square = norm * (norm + head.abs());
            for other in rest.chunks_exact_mut(stride) {
                let along = lead * other[pivot] + dot(&column[tail.clone()], &other[tail.clone()]);
                let factor = along / half_square;
                other[pivot] -= factor * lead;
                for (x, v) in other[tail.clone()].iter_mut().zip(&column[tail.clone()]) {
                    *x -= factor * v;
                }
            }
            column[pivot] = signed;
        }
        self.n_waiting = 0;
    }

    /// Columns of the inverse of the leading `count` by `count` triangle.
    pub fn inverse_columns(&self, count: usize) -> Vec<Vec<f64>> {
        let mut columns = vec![vec![0.0; count]; count];
        for (c, column) in columns.iter_mut().enumerate() {
            for i in (0..=c).rev() {
                let unit = f64::from(u8::from(i == c));
                let known: f64 = (i + 1..=c).map(|j| self.at(i, j) * column[j]).sum();
                column[i] = (unit - known) / self.at(i, i);
            }
        }
        columns
    }

    /// Weights that cancel column `record` best by the first `count` columns.
    pub fn explained_by(&self, count: usize, record: usize) -> Vec<f64> {
        let mut weights = vec![0.0; count];
        for i in (0..count).rev() {
            let known: f64 = (i + 1..count).map(|j| self.at(i, j) * weights[j]).sum();
            weights[i] = -(self.at(i, record) + known) / self.at(i, i);
        }
        weights
    }

    fn stride(&self) -> usize {
        self.size + N_TOGETHER
    }
}

/// The inner product, summed in four lanes that a processor can run side by side.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut lanes = [0.0; 4];
    let (a, b) = (a.chunks_exact(4), b.chunks_exact(4));
    let last: f64 = a.remainder().iter().zip(b.remainder()).map(|(a, b)| a * b).sum();
    for (a, b) in a.zip(b) {
        for ((lane, a), b) in lanes.iter_mut().zip(a).zip(b) {
            *lane += a * b;
        }
    }
    (lanes[0] + lanes[2]) + (lanes[1] + lanes[3]) + last
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_triangle_keeps_every_inner_product_of_the_columns() {
        let rows: Vec<[f64; 4]> = (0..77)
            .map(|i| {
                let t = f64::from(i) * 0.3;
                [t.sin(), (1.7 * t).cos(), 0.01 * t, (0.2 * t * t).sin()]
            })
            .collect();
        let mut triangle = Triangle::new(4);
        for row in &rows {
            triangle.push(*row);
        }
        triangle.settle();
        for i in 0..4 {
            for j in 0..4 {
                let direct: f64 = rows.iter().map(|r| r[i] * r[j]).sum();
                let kept: f64 = (0..=i.min(j)).map(|k| triangle.at(k, i) * triangle.at(k, j)).sum();
                assert!((direct - kept).abs() < 1e-12, "{i} {j}: {direct} {kept}");
            }
        }
    }
}
