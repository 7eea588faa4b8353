//! Marks on the plane: curves, bands, points, bars, stretches.

use plotters::element::DashedPathElement;
use plotters::prelude::*;

use super::frame::{Canvas, Drawn, Plane, UNITS};
use super::{Hue, Ink, Mark, Shape, thin};

/// A hole in a curve is this many times wider than the mean step.
const HOLE_STEPS: f64 = 20.0;

/// Opacity of a band; light enough to read the grid and the curves through it.
const BAND_OPACITY: f64 = 0.22;

/// Radius [px] of a point.
const RADIUS: f64 = 3.4;

/// The horizontal values that the axis must hold.
pub(super) fn xs(mark: &Mark) -> Vec<f64> {
    match mark {
        Mark::Line { x, .. }
        | Mark::Band { x, .. }
        | Mark::Points { x, .. }
        | Mark::ErrorBars { x, .. } => x.clone(),
        Mark::Stretch { from, to, .. } => vec![*from, *to],
        Mark::Level { .. } => Vec::new(),
    }
}

/// The vertical values that the axis must hold.
pub(super) fn ys(mark: &Mark) -> Vec<f64> {
    match mark {
        Mark::Line { y, .. } | Mark::Points { y, .. } => y.clone(),
        Mark::Band { lo, hi, .. } => [lo.as_slice(), hi].concat(),
        Mark::ErrorBars { y, lo, hi, .. } => [y.as_slice(), lo, hi].concat(),
        Mark::Stretch { .. } => Vec::new(),
        Mark::Level { y, .. } => vec![*y],
    }
}

/// Draws one mark.
pub(super) fn mark(canvas: &Canvas, plane: &Plane, mark: &Mark) -> Drawn {
    let (x_range, y_range) = (plane.get_x_range(), plane.get_y_range());
    let inside = |x: f64, y: f64| {
        let x = x.clamp(x_range.start, x_range.end);
        plane.map_coordinate(&(x, y.clamp(y_range.start, y_range.end)))
    };
    match mark {
        Mark::Line { x, y, ink } => {
            for piece in unbroken(x, y) {
                let points = thin::peaks(&piece.iter().map(|point| point.1).collect::<Vec<_>>());
                let points = points.into_iter().map(|k| inside(piece[k].0, piece[k].1)).collect();
                stroke(canvas, points, ink)?;
            }
            Ok(())
        }
        Mark::Band { x, lo, hi, ink } => {
            let band: Vec<_> = thin::envelope(x, lo, hi)
                .into_iter()
                .filter(|(x, lo, hi)| x.is_finite() && lo.is_finite() && hi.is_finite())
                .collect();
            let there = band.iter().map(|&(x, lo, _)| inside(x, lo));
            let back = band.iter().rev().map(|&(x, _, hi)| inside(x, hi));
            let outline: Vec<_> = there.chain(back).collect();
            canvas.draw(&Polygon::new(outline, rgb(ink.hue).mix(BAND_OPACITY)))
        }
        Mark::Points { x, y, ink } => {
            for k in thin::cloud(x.len().min(y.len())) {
                if x[k].is_finite() && y[k].is_finite() {
                    point(canvas, inside(x[k], y[k]), ink)?;
                }
            }
            Ok(())
        }
        Mark::ErrorBars { x, y, lo, hi, ink } => {
            for k in 0..x.len() {
                if [x[k], y[k], lo[k], hi[k]].iter().all(|value| value.is_finite()) {
                    let ends = vec![inside(x[k], lo[k]), inside(x[k], hi[k])];
                    stroke(canvas, ends, &Ink { dashed: false, ..ink.clone() })?;
                    point(canvas, inside(x[k], y[k]), ink)?;
                }
            }
            Ok(())
        }
        Mark::Stretch { from, to, ink } => {
            let corners = [inside(*from, y_range.start), inside(*to, y_range.end)];
            canvas.draw(&Rectangle::new(corners, rgb(ink.hue).mix(BAND_OPACITY).filled()))
        }
        Mark::Level { y, ink } => {
            let ends = vec![inside(x_range.start, *y), inside(x_range.end, *y)];
            stroke(canvas, ends, ink)
        }
    }
}

/// Draws the legend's picture of a mark, its left end at `(x, y)`.
pub(super) fn swatch(canvas: &Canvas, mark: &Mark, (x, y): (i32, i32), width: i32) -> Drawn {
    let centre = (x + width / 2, y);
    match mark {
        Mark::Line { ink, .. } | Mark::Level { ink, .. } => {
            stroke(canvas, vec![(x, y), (x + width, y)], ink)
        }
        Mark::Band { ink, .. } | Mark::Stretch { ink, .. } => {
            let corners = [(x, y - 6 * UNITS), (x + width, y + 6 * UNITS)];
            canvas.draw(&Rectangle::new(corners, rgb(ink.hue).mix(BAND_OPACITY).filled()))
        }
        Mark::Points { ink, .. } => point(canvas, centre, ink),
        Mark::ErrorBars { ink, .. } => {
            let ends = vec![(centre.0, y - 7 * UNITS), (centre.0, y + 7 * UNITS)];
            stroke(canvas, ends, &Ink { dashed: false, ..ink.clone() })?;
            point(canvas, centre, ink)
        }
    }
}

/// The finite points of a curve, cut at its holes.
fn unbroken(x: &[f64], y: &[f64]) -> Vec<Vec<(f64, f64)>> {
    let n = x.len().min(y.len());
    let span = if n > 1 { (x[n - 1] - x[0]).abs() } else { 0.0 };
    let hole = HOLE_STEPS * span / n.max(2) as f64;
    let mut pieces: Vec<Vec<(f64, f64)>> = vec![Vec::new()];
    for point in x.iter().copied().zip(y.iter().copied()) {
        let whole = point.0.is_finite() && point.1.is_finite();
        let Some(piece) = pieces.last_mut() else { break };
        let joined = piece.last().is_none_or(|last| (point.0 - last.0).abs() <= hole);
        if whole && joined {
            piece.push(point);
        } else if !piece.is_empty() {
            pieces.push(if whole { vec![point] } else { Vec::new() });
        } else if whole {
            piece.push(point);
        }
    }
    pieces
}

fn stroke(canvas: &Canvas, points: Vec<(i32, i32)>, ink: &Ink) -> Drawn {
    let style = rgb(ink.hue).stroke_width((ink.width_px * f64::from(UNITS)) as u32);
    if ink.dashed {
        let dash = (6 * UNITS, 4 * UNITS);
        canvas.draw(&DashedPathElement::new(points, dash.0, dash.1, style))
    } else {
        canvas.draw(&PathElement::new(points, style))
    }
}

fn point(canvas: &Canvas, (x, y): (i32, i32), ink: &Ink) -> Drawn {
    let color = rgb(ink.hue);
    let radius = (RADIUS * f64::from(UNITS)) as i32;
    let outline = color.stroke_width(UNITS as u32 * 14 / 10);
    match ink.shape {
        Shape::Circle => canvas.draw(&Circle::new((x, y), radius, color.filled())),
        Shape::OpenCircle => canvas.draw(&Circle::new((x, y), radius, outline)),
        Shape::Dot => canvas.draw(&Circle::new((x, y), radius / 2, color.mix(0.6).filled())),
        Shape::Triangle => {
            canvas.draw(&TriangleMarker::new((x, y), radius * 13 / 10, color.filled()))
        }
        Shape::Cross => canvas.draw(&Cross::new((x, y), radius, outline)),
        Shape::Square => {
            let half = radius * 9 / 10;
            let corners = [(x - half, y - half), (x + half, y + half)];
            canvas.draw(&Rectangle::new(corners, color.filled()))
        }
        Shape::Diamond => {
            let r = radius * 12 / 10;
            let corners = vec![(x, y - r), (x + r, y), (x, y + r), (x - r, y)];
            canvas.draw(&Polygon::new(corners, color.filled()))
        }
    }
}

fn rgb(hue: Hue) -> RGBColor {
    match hue {
        Hue::Black => RGBColor(0, 0, 0),
        Hue::Blue => RGBColor(0x00, 0x72, 0xB2),
        Hue::Vermillion => RGBColor(0xD5, 0x5E, 0x00),
        Hue::Green => RGBColor(0x00, 0x9E, 0x73),
        Hue::Purple => RGBColor(0xCC, 0x79, 0xA7),
        Hue::Orange => RGBColor(0xE6, 0x9F, 0x00),
        Hue::Sky => RGBColor(0x56, 0xB4, 0xE9),
        Hue::Grey => RGBColor(0x80, 0x80, 0x80),
    }
}
