//! Runs grouped by a nominal value, such as the Froude number they were meant to have.

use crate::report::figure::{Axis, Figure, Ink, Panel};
use crate::report::notation;

/// A point `(x, y, lo, hi)` with its bar.
pub(super) type Point = (f64, f64, f64, f64);

/// The mean of a group's keys, with the group's points.
pub(super) type Group = (f64, Vec<Point>);

/// Groups `(key, point)` pairs: a key further than `apart` from the next smaller begins a group.
pub(super) fn by_value(mut points: Vec<(f64, Point)>, apart: f64) -> Vec<Group> {
    points.retain(|(key, _)| key.is_finite());
    points.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.0.total_cmp(&b.1.0)));
    let mut groups: Vec<(Vec<f64>, Vec<Point>)> = Vec::new();
    for (key, point) in points {
        match groups.last_mut() {
            Some((keys, group)) if keys.last().is_some_and(|last| key - last <= apart) => {
                keys.push(key);
                group.push(point);
            }
            _ => groups.push((vec![key], vec![point])),
        }
    }
    groups
        .into_iter()
        .map(|(keys, mut group)| {
            // Keys of one group differ by chance; the points are joined in the order of the axis.
            group.sort_by(|a, b| a.0.total_cmp(&b.0));
            (keys.iter().sum::<f64>() / keys.len() as f64, group)
        })
        .collect()
}

/// One figure with a series of joined error bars per group.
pub(super) fn figure(
    id: String,
    title: &str,
    axes: (Axis, Axis),
    groups: &[Group],
    label: impl Fn(f64) -> String,
) -> Figure {
    let (x, y) = axes;
    let mut panel = Panel::new(y).height(240);
    for (index, (key, points)) in groups.iter().enumerate() {
        let (xs, ys): (Vec<_>, Vec<_>) = points.iter().map(|point| (point.0, point.1)).unzip();
        panel = panel
            .line(&xs, &ys, Ink::of_series(index).wide(0.8))
            .error_bars(points, Ink::of_series(index).named(label(*key)));
    }
    Figure::new(id, notation::plain(title), x).panel(panel)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn speeds_that_differ_by_the_carriage_s_unsteadiness_are_one_group() {
        let point = (0.0, 0.0, 0.0, 0.0);
        let froude = [0.2003, 0.0, 0.1997, 0.3, f64::NAN];
        let groups = by_value(froude.map(|fr| (fr, point)).to_vec(), 0.01);
        let keys: Vec<_> = groups.iter().map(|group| (group.0 * 1e4).round()).collect();
        assert_eq!(keys, [0.0, 2000.0, 3000.0]);
    }

    #[test]
    fn points_of_a_group_are_joined_from_left_to_right() {
        let points = [(0.2003, 5.0), (0.1997, 7.0), (0.2, 6.0)];
        let points = points.map(|(froude, w)| (froude, (w, 0.0, 0.0, 0.0)));
        let groups = by_value(points.to_vec(), 0.01);
        let xs: Vec<_> = groups[0].1.iter().map(|point| point.0).collect();
        assert_eq!(xs, [5.0, 6.0, 7.0]);
    }
}
