//! Normal equations: a symmetric matrix of inner products, eliminated from its top left.

/// Inner products of columns, the record last.
#[derive(Debug, Clone)]
pub(in crate::diagnosis) struct Products {
    n: usize,
    entries: Vec<f64>,
}

/// A column of theirs goes to one of ours, times a factor; it may go to several.
#[derive(Debug, Clone, Copy)]
pub(in crate::diagnosis) struct Place {
    pub(super) theirs: usize,
    pub(super) ours: usize,
    pub(super) by: f64,
}

impl Place {
    /// Column `theirs` is our column `ours`.
    pub(super) fn new(theirs: usize, ours: usize) -> Self {
        Self { theirs, ours, by: 1.0 }
    }
}

/// Share of its own inner product below which nothing of a column is left but rounding.
const NOTHING_LEFT: f64 = 1e-11;

impl Products {
    /// `n` columns that are all nil.
    pub(in crate::diagnosis) fn zero(n: usize) -> Self {
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
    pub(in crate::diagnosis) fn n(&self) -> usize {
        self.n
    }

    /// Inner product of two columns.
    pub(in crate::diagnosis) fn at(&self, i: usize, j: usize) -> f64 {
        self.entries[i * self.n + j]
    }

    /// Adds to the inner product of two columns, in both orders.
    pub(in crate::diagnosis) fn add(&mut self, i: usize, j: usize, value: f64) {
        self.entries[i * self.n + j] += value;
        if i != j {
            self.entries[j * self.n + i] += value;
        }
    }

    /// Adds these products with a column of ours for each of theirs, or several with factors.
    pub(super) fn gather(&mut self, other: &Self, places: &[Place]) {
        for &Place { theirs: i, ours: row, by } in places {
            let (from, to) = (&other.entries[i * other.n..], row * self.n);
            for place in places {
                self.entries[to + place.ours] += by * place.by * from[place.theirs];
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
    pub(in crate::diagnosis) fn eliminate(mut self, k: usize) -> Eliminated {
        let n = self.n;
        let whole: Vec<f64> = (0..k).map(|i| self.at(i, i)).collect();
        let mut rows = Vec::with_capacity(k * n);
        let mut pivots = Vec::with_capacity(k);
        let mut log_determinant = 0.0;
        for (i, whole) in whole.into_iter().enumerate() {
            let pivot = self.at(i, i);
            let alive = pivot > NOTHING_LEFT * whole && pivot > 0.0;
            let row: Vec<f64> = if alive {
                log_determinant += pivot.ln();
                self.entries[i * n..(i + 1) * n].iter().map(|v| v / pivot).collect()
            } else {
                vec![0.0; n]
            };
            for a in i + 1..n {
                let by = self.at(a, i);
                if by != 0.0 && alive {
                    let entries = &mut self.entries[a * n + i + 1..(a + 1) * n];
                    for (entry, factor) in entries.iter_mut().zip(&row[i + 1..]) {
                        *entry -= by * factor;
                    }
                }
            }
            rows.extend(row);
            pivots.push(if alive { pivot } else { f64::INFINITY });
        }
        let left: Vec<usize> = (k..n).collect();
        Eliminated { k, n, rows, pivots, rest: self.picked(&left), log_determinant }
    }
}

/// Inner product in four partial sums, which a processor adds side by side.
pub(super) fn product(a: &[f64], b: &[f64]) -> f64 {
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
pub(in crate::diagnosis) struct Eliminated {
    k: usize,
    n: usize,
    /// Row `i` holds the factors by which column `i` depends on those after it.
    rows: Vec<f64>,
    /// What was left of each column itself; without end where nothing was.
    pivots: Vec<f64>,
    /// Products of the other columns less their projections on the eliminated ones.
    pub(in crate::diagnosis) rest: Products,
    /// Logarithm of the determinant of the eliminated block.
    pub(in crate::diagnosis) log_determinant: f64,
}

impl Eliminated {
    /// Coefficients of the eliminated columns when those after them, the record excepted, have
    /// the coefficients `others`.
    pub(in crate::diagnosis) fn back(&self, others: &[f64]) -> Vec<f64> {
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

    /// Lets the coefficients of the kept columns from `first` on count from where they were
    /// `moved_by` ago.
    pub(super) fn refer_back(&mut self, first: usize, moved_by: &[f64]) {
        let last = self.rest.n() - 1;
        let mut places: Vec<Place> = (0..=last).map(|i| Place::new(i, i)).collect();
        let moved = moved_by.iter().zip(first..);
        places.extend(moved.map(|(by, theirs)| Place { theirs, ours: last, by: *by }));
        let mut rest = Products::zero(last + 1);
        rest.gather(&self.rest, &places);
        self.rest = rest;
        for row in self.rows.chunks_exact_mut(self.n) {
            let moved = moved_by.iter().zip(&row[self.k + first..]);
            let by: f64 = moved.map(|(by, factor)| by * factor).sum();
            row[self.n - 1] += by;
        }
    }

    /// Covariance of the eliminated columns' coefficients, given those after them.
    pub(in crate::diagnosis) fn covariance(&self) -> Vec<Vec<f64>> {
        let of = |column: usize| {
            // The column that answers to `column` alone, forward and back through the factors.
            let mut x = vec![0.0; self.k];
            x[column] = 1.0;
            for i in column..self.k {
                let (by, row) = (x[i], &self.rows[i * self.n..]);
                (i + 1..self.k).for_each(|j| x[j] -= by * row[j]);
                x[i] = by / self.pivots[i];
            }
            for i in (0..self.k).rev() {
                let row = &self.rows[i * self.n..];
                x[i] -= (i + 1..self.k).map(|j| row[j] * x[j]).sum::<f64>();
            }
            x
        };
        (0..self.k).map(of).collect()
    }

    /// A side without its projections on the eliminated columns.
    pub(in crate::diagnosis) fn beside(&self, side: &Side) -> Side {
        let (mut with, mut among) = (side.with.clone(), side.among.clone());
        let (n, m) = (self.n, among.n);
        for i in (0..self.k).filter(|i| self.pivots[*i].is_finite()) {
            let row = &self.rows[i * n..(i + 1) * n];
            for c in 0..m {
                let by = with[c * n + i];
                for d in 0..m {
                    among.entries[c * m + d] -= by * with[d * n + i] / self.pivots[i];
                }
            }
            for c in 0..m {
                let with = &mut with[c * n..(c + 1) * n];
                let by = with[i];
                with.iter_mut().zip(row).skip(i + 1).for_each(|(w, factor)| *w -= by * factor);
            }
        }
        let kept = n - self.k;
        let with = with.chunks_exact(n).flat_map(|with| with[self.k..].iter().copied()).collect();
        Side { n: kept, with, among }
    }
}

/// Columns beside those of some products: inner products with these, and among themselves.
#[derive(Debug, Clone)]
pub(in crate::diagnosis) struct Side {
    n: usize,
    with: Vec<f64>,
    pub(in crate::diagnosis) among: Products,
}

impl Side {
    /// `m` columns that are all nil, beside `n`.
    pub(in crate::diagnosis) fn zero(m: usize, n: usize) -> Self {
        Self { n, with: vec![0.0; m * n], among: Products::zero(m) }
    }

    /// Inner products of columns with known ones and among themselves.
    pub(super) fn of(columns: &[Vec<f64>], known: &[Vec<f64>]) -> Self {
        let with = columns.iter().flat_map(|c| known.iter().map(|k| product(c, k))).collect();
        Self { n: known.len(), with, among: Products::of(columns) }
    }

    /// Inner product of one of the columns with a known one.
    pub(in crate::diagnosis) fn with(&self, column: usize, known: usize) -> f64 {
        self.with[column * self.n + known]
    }

    /// Adds to such a product.
    pub(super) fn add(&mut self, column: usize, known: usize, value: f64) {
        self.with[column * self.n + known] += value;
    }

    /// Adds a side whose columns are ours from `first` on, and whose known ones have places.
    pub(in crate::diagnosis) fn gather(&mut self, other: &Self, first: usize, places: &[Place]) {
        for c in 0..other.among.n {
            for place in places {
                self.add(first + c, place.ours, place.by * other.with(c, place.theirs));
            }
            for d in 0..other.among.n {
                let at = (first + c) * self.among.n + first + d;
                self.among.entries[at] += other.among.at(c, d);
            }
        }
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
        let covariance = eliminated.covariance();
        assert!((covariance[1][1] - 0.2).abs() < 1e-12, "{covariance:?}");
        assert!((eliminated.log_determinant - 20_f64.ln()).abs() < 1e-12);
    }

    #[test]
    fn columns_that_count_from_an_earlier_place_leave_and_give_the_same() {
        let columns =
            [vec![1.0, 1.0, 1.0, 1.0], vec![0.0, 1.0, 2.0, 3.0], vec![1.0, 3.0, 5.0, 8.0]];
        let here = Products::of(&columns).eliminate(1);
        let mut earlier = here.clone();
        earlier.refer_back(0, &[0.4]);
        // The slope of 2.3 is 2.7 from where it stood 0.4 ago; the other coefficient is the same.
        assert!((here.back(&[2.3])[0] - earlier.back(&[2.7])[0]).abs() < 1e-12);
        let steps = [here, earlier].map(|eliminated| eliminated.rest.eliminate(1));
        let [here, earlier] = &steps;
        assert!((earlier.back(&[])[0] - here.back(&[])[0] - 0.4).abs() < 1e-12);
        assert!((earlier.rest.at(0, 0) - here.rest.at(0, 0)).abs() < 1e-12);
    }

    #[test]
    fn a_side_is_eliminated_as_if_it_had_been_among_the_columns() {
        let column = |seed: u32| -> Vec<f64> {
            (0..9).map(|i| f64::from((seed * 7 + i * i * (3 + seed)) % 11)).collect()
        };
        let (known, more) = ([column(1), column(2), column(3)], [column(4), column(5)]);
        let all: Vec<Vec<f64>> = known.iter().chain(&more).cloned().collect();
        let whole = Products::of(&all).eliminate(2).rest;
        let side = Products::of(&known).eliminate(2).beside(&Side::of(&more, &known));
        for c in 0..2 {
            assert!((side.with(c, 0) - whole.at(0, 1 + c)).abs() < 1e-9);
            for d in 0..2 {
                assert!((side.among.at(c, d) - whole.at(1 + c, 1 + d)).abs() < 1e-9);
            }
        }
    }
}
