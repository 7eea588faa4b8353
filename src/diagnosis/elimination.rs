//! Normal equations: a symmetric matrix of inner products, eliminated from its top left.

/// Inner products of columns, the record last.
#[derive(Debug, Clone)]
pub(super) struct Products {
    n: usize,
    entries: Vec<f64>,
}

/// Share of its own inner product below which nothing of a column is left but rounding.
const NOTHING_LEFT: f64 = 1e-11;

impl Products {
    /// `n` columns that are all nil.
    pub(super) fn zero(n: usize) -> Self {
        Self { n, entries: vec![0.0; n * n] }
    }

    /// Inner products of columns of one length.
    pub(super) fn of(columns: &[Vec<f64>]) -> Self {
        let mut products = Self::zero(columns.len());
        for (i, a) in columns.iter().enumerate() {
            for (j, b) in columns.iter().enumerate().skip(i) {
                let product = product(a, b);
                products.entries[i * products.n + j] = product;
                products.entries[j * products.n + i] = product;
            }
        }
        products
    }

    /// Number of columns.
    pub(super) fn n(&self) -> usize {
        self.n
    }

    /// Inner product of two columns.
    pub(super) fn at(&self, i: usize, j: usize) -> f64 {
        self.entries[i * self.n + j]
    }

    /// Adds to the inner product of two columns, in both orders.
    pub(super) fn add(&mut self, i: usize, j: usize, value: f64) {
        self.entries[i * self.n + j] += value;
        if i != j {
            self.entries[j * self.n + i] += value;
        }
    }

    /// Adds these products with a column of ours for each of theirs, or several with factors.
    pub(super) fn gather(&mut self, other: &Self, places: &[Vec<(usize, f64)>]) {
        for (i, rows) in places.iter().enumerate() {
            for (j, columns) in places.iter().enumerate() {
                let value = other.at(i, j);
                for (row, by) in rows {
                    for (column, times) in columns {
                        self.entries[row * self.n + column] += by * times * value;
                    }
                }
            }
        }
    }

    /// The products of some of the columns, in this order.
    pub(super) fn picked(&self, columns: &[usize]) -> Self {
        let mut picked = Self::zero(columns.len());
        for (i, &a) in columns.iter().enumerate() {
            for (j, &b) in columns.iter().enumerate() {
                picked.entries[i * picked.n + j] = self.at(a, b);
            }
        }
        picked
    }

    /// Eliminates the first `k` columns.
    pub(super) fn eliminate(mut self, k: usize) -> Eliminated {
        let n = self.n;
        let whole: Vec<f64> = (0..k).map(|i| self.at(i, i)).collect();
        let mut rows = Vec::with_capacity(k * n);
        let mut log_determinant = 0.0;
        for i in 0..k {
            let pivot = self.at(i, i);
            let alive = pivot > NOTHING_LEFT * whole[i] && pivot > 0.0;
            let row: Vec<f64> = if alive {
                log_determinant += pivot.ln();
                self.entries[i * n..(i + 1) * n].iter().map(|v| v / pivot).collect()
            } else {
                vec![0.0; n]
            };
            for a in i + 1..n {
                let by = self.at(a, i);
                if by != 0.0 && alive {
                    for b in i + 1..n {
                        self.entries[a * n + b] -= by * row[b];
                    }
                }
            }
            rows.extend(row);
        }
        let left: Vec<usize> = (k..n).collect();
        Eliminated { k, n, rows, rest: self.picked(&left), log_determinant }
    }
}

/// Inner product in four partial sums, which a processor adds side by side.
fn product(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; 4];
    let (fours, others) = (a.chunks_exact(4), b.chunks_exact(4));
    let rest: f64 = fours.remainder().iter().zip(others.remainder()).map(|(x, y)| x * y).sum();
    for (x, y) in fours.zip(others) {
        for i in 0..4 {
            sums[i] += x[i] * y[i];
        }
    }
    sums.iter().sum::<f64>() + rest
}

/// What is left after an elimination, and how to come back.
#[derive(Debug, Clone)]
pub(super) struct Eliminated {
    k: usize,
    n: usize,
    /// Row `i` holds the factors by which column `i` depends on those after it.
    rows: Vec<f64>,
    /// Products of the other columns less their projections on the eliminated ones.
    pub(super) rest: Products,
    /// Logarithm of the determinant of the eliminated block.
    pub(super) log_determinant: f64,
}

impl Eliminated {
    /// Coefficients of the eliminated columns when those after them, the record excepted, have
    /// the coefficients `others`.
    pub(super) fn back(&self, others: &[f64]) -> Vec<f64> {
        let n_others = self.n - self.k - 1;
        let mut x = vec![0.0; self.k];
        for i in (0..self.k).rev() {
            let row = &self.rows[i * self.n..(i + 1) * self.n];
            let mut value = row[self.n - 1];
            for j in 0..n_others {
                value -= row[self.k + j] * others.get(j).copied().unwrap_or(0.0);
            }
            for (j, x) in x.iter().enumerate().skip(i + 1) {
                value -= row[j] * x;
            }
            x[i] = value;
        }
        x
    }

    /// Covariance of the eliminated columns' coefficients, given those after them.
    pub(super) fn covariance(&self, pivots: &Products) -> Vec<Vec<f64>> {
        (0..self.k)
            .map(|column| {
                let mut products = pivots.picked(&(0..self.k).collect::<Vec<_>>());
                products = products.with_record(column);
                products.eliminate(self.k).back(&[])
            })
            .collect()
    }
}

impl Products {
    /// The same columns with a record whose product with column `one` is 1 and with others nil.
    fn with_record(&self, one: usize) -> Self {
        let mut grown = Self::zero(self.n + 1);
        for i in 0..self.n {
            for j in 0..self.n {
                grown.entries[i * grown.n + j] = self.at(i, j);
            }
        }
        grown.add(one, self.n, 1.0);
        grown
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn eliminated_columns_leave_what_they_cannot_explain_and_come_back() {
        let columns =
            vec![vec![1.0, 1.0, 1.0, 1.0], vec![0.0, 1.0, 2.0, 3.0], vec![1.0, 3.0, 5.0, 8.0]];
        let products = Products::of(&columns);
        let eliminated = products.clone().eliminate(2);
        let x = eliminated.back(&[]);
        // The straight line through 1, 3, 5, 8 is 0.8 + 2.3 t and leaves 0.3.
        assert!((x[0] - 0.8).abs() < 1e-12 && (x[1] - 2.3).abs() < 1e-12, "{x:?}");
        assert!((eliminated.rest.at(0, 0) - 0.3).abs() < 1e-12);
        let covariance = eliminated.covariance(&products);
        assert!((covariance[1][1] - 0.2).abs() < 1e-12, "{covariance:?}");
        assert!((eliminated.log_determinant - 20_f64.ln()).abs() < 1e-12);
    }
}
