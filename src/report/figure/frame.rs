//! The layout of a figure: panels, axes, ticks, labels, legend.

use plotters::coord::Shift;
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use super::{Axis, Figure, Mark, Panel, axis, draw, label_of, notation};

/// Drawing units in one pixel: the backend rounds to whole units, which would show as steps.
pub(super) const UNITS: i32 = 10;

const WIDTH: i32 = 720;
/// Room on the left for labels of an axis and its ticks that are not wide.
const LEFT: i32 = 66;
const RIGHT: i32 = 16;
const RIGHT_WITH_SCALE: i32 = 66;
const TOP: i32 = 8;
const BOTTOM: i32 = 42;
const GAP: i32 = 16;
const LEGEND_ROW: i32 = 19;
const SWATCH: i32 = 24;
const FONT_PX: f64 = 12.0;
const LETTER_PX: f64 = 0.56 * FONT_PX;
/// Width of a digit in the widest of the usual fonts, `DejaVu` Sans.
const DIGIT_PX: f64 = 0.65 * FONT_PX;
/// Between the lines of an upright label.
const UPRIGHT_ROW: i32 = 14;
/// Between tick labels and the frame.
const TO_TICK: i32 = 6;

pub(super) type Canvas<'a> = DrawingArea<SVGBackend<'a>, Shift>;
pub(super) type Plane<'a> =
    DrawingArea<SVGBackend<'a>, Cartesian2d<RangedCoordf64, RangedCoordf64>>;
pub(super) type Drawn = Result<(), DrawingAreaErrorKind<std::io::Error>>;

/// What goes between `<svg>` and `</svg>`.
pub(super) struct Drawing {
    pub(super) view_box: String,
    pub(super) size_px: (i32, i32),
    pub(super) elements: String,
}

/// A rectangle in pixels.
#[derive(Debug, Clone, Copy)]
struct Place {
    left: i32,
    top: i32,
    right: i32,
    bottom: i32,
}

/// Draws a figure.
pub(super) fn drawing(figure: &Figure) -> Drawing {
    let rows = legend_rows(figure);
    let top = TOP + LEGEND_ROW * rows.len() as i32;
    let panels: i32 = figure.panels.iter().map(|panel| panel.height_px + GAP).sum();
    let height = top + panels - GAP + BOTTOM;
    let mut text = String::new();
    {
        let size = ((WIDTH * UNITS) as u32, (height * UNITS) as u32);
        let canvas = SVGBackend::with_string(&mut text, size).into_drawing_area();
        draw_all(&canvas, figure, &rows, top).expect("a string takes every drawing");
    }
    let view_box = format!("0 0 {} {}", WIDTH * UNITS, height * UNITS);
    Drawing { view_box, size_px: (WIDTH, height), elements: notation::svg(inner(&text)) }
}

/// The drawing without the backend's own `<svg>` element, which names a name space by its address.
fn inner(text: &str) -> &str {
    let begin = text.find("<svg").and_then(|at| text[at..].find('>').map(|end| at + end + 1));
    let end = text.rfind("</svg>").unwrap_or(text.len());
    &text[begin.unwrap_or(0)..end]
}

fn draw_all(canvas: &Canvas, figure: &Figure, rows: &[Vec<&Mark>], top: i32) -> Drawn {
    let scaled = figure.panels.iter().any(|panel| panel.second.is_some());
    let right = WIDTH - if scaled { RIGHT_WITH_SCALE } else { RIGHT };
    let xs = figure.panels.iter().flat_map(|panel| &panel.marks).flat_map(draw::xs);
    let (x_lo, x_hi) = figure.x.range(xs);
    let left = figure.panels.iter().map(left_of).fold(LEFT, i32::max);
    let mut place = Place { left, top, right, bottom: top };
    for (index, panel) in figure.panels.iter().enumerate() {
        place.bottom = place.top + panel.height_px;
        let (y_lo, y_hi) = y_range(panel);
        let plane = canvas.apply_coord_spec(Cartesian2d::new(
            x_lo..x_hi,
            y_lo..y_hi,
            (place.left * UNITS..place.right * UNITS, place.bottom * UNITS..place.top * UNITS),
        ));
        let last = index + 1 == figure.panels.len();
        grid(canvas, &plane, place, last)?;
        for mark in &panel.marks {
            draw::mark(canvas, &plane, mark)?;
        }
        border(canvas, place)?;
        side_labels(canvas, &plane, panel, place)?;
        if last {
            text(canvas, figure.x.label(), middle(place), place.bottom + 24, HPos::Center)?;
        }
        place.top = place.bottom + GAP;
    }
    legend(canvas, rows)
}

fn y_range(panel: &Panel) -> (f64, f64) {
    panel.y.range(panel.marks.iter().flat_map(draw::ys))
}

/// Ticks of the vertical axis of a panel.
fn y_ticks(lo: f64, hi: f64, height_px: i32) -> Vec<(f64, String)> {
    axis::ticks(lo, hi, (height_px / 27).clamp(3, 9) as usize)
}

/// Where a panel begins, so that no tick label reaches the label of its axis.
fn left_of(panel: &Panel) -> i32 {
    let (lo, hi) = y_range(panel);
    let ticks = y_ticks(lo, hi, panel.height_px);
    let n_digits = ticks.iter().map(|(_, label)| label.chars().count()).max().unwrap_or(0);
    let n_rows = panel.y.label().lines().count() as i32;
    4 + UPRIGHT_ROW * n_rows + 2 + (n_digits as f64 * DIGIT_PX) as i32 + TO_TICK
}

fn middle(place: Place) -> i32 {
    i32::midpoint(place.left, place.right)
}

/// Grid lines with the tick labels of both axes; only the last panel labels the horizontal one.
fn grid(canvas: &Canvas, plane: &Plane, place: Place, last: bool) -> Drawn {
    let faint = RGBColor(225, 225, 225).stroke_width(UNITS as u32 * 8 / 10);
    let (x, y) = (plane.get_x_range(), plane.get_y_range());
    for (value, label) in axis::ticks(x.start, x.end, 9) {
        plane.draw(&PathElement::new(vec![(value, y.start), (value, y.end)], faint))?;
        if last {
            let at = plane.map_coordinate(&(value, y.start)).0;
            text(canvas, &label, at / UNITS, place.bottom + 6, HPos::Center)?;
        }
    }
    for (value, label) in y_ticks(y.start, y.end, place.bottom - place.top) {
        plane.draw(&PathElement::new(vec![(x.start, value), (x.end, value)], faint))?;
        let at = plane.map_coordinate(&(x.start, value)).1;
        text_at(canvas, &label, (place.left - TO_TICK, at / UNITS), HPos::Right, VPos::Center)?;
    }
    Ok(())
}

fn border(canvas: &Canvas, place: Place) -> Drawn {
    let Place { left, top, right, bottom } = place;
    let corners = [(left, top), (right, top), (right, bottom), (left, bottom), (left, top)];
    let outline: Vec<_> = corners.map(|(x, y)| (x * UNITS, y * UNITS)).to_vec();
    let style = RGBColor(90, 90, 90).stroke_width(UNITS as u32 * 9 / 10);
    canvas.draw(&PathElement::new(outline, style))
}

/// The label of the vertical axis, one line each, with the second scale on the right.
fn side_labels(canvas: &Canvas, plane: &Plane, panel: &Panel, place: Place) -> Drawn {
    upright(canvas, &panel.y, 4, place)?;
    let Some(second) = &panel.second else { return Ok(()) };
    let y = plane.get_y_range();
    for (value, label) in axis::ticks(y.start * second.factor, y.end * second.factor, 6) {
        let at = plane.map_coordinate(&(0.0, value / second.factor)).1 / UNITS;
        let dash = vec![(place.right * UNITS, at * UNITS), ((place.right + 4) * UNITS, at * UNITS)];
        canvas.draw(&PathElement::new(dash, BLACK.stroke_width(UNITS as u32)))?;
        text_at(canvas, &label, (place.right + 7, at), HPos::Left, VPos::Center)?;
    }
    upright(canvas, &Axis::new(&*second.label), WIDTH - 14, place)
}

fn upright(canvas: &Canvas, axis: &Axis, left: i32, place: Place) -> Drawn {
    let style = font().transform(FontTransform::Rotate270).into_text_style(canvas);
    let style = style.pos(Pos::new(HPos::Center, VPos::Top));
    let centre = i32::midpoint(place.top, place.bottom) * UNITS;
    for (row, line) in axis.label().lines().enumerate() {
        let at = ((left + UPRIGHT_ROW * row as i32) * UNITS, centre);
        canvas.draw(&Text::new(line.to_owned(), at, style.clone()))?;
    }
    Ok(())
}

fn font() -> FontDesc<'static> {
    // The backend divides by 1.24, the height of a text line in font sizes.
    ("sans-serif", FONT_PX * 1.24 * f64::from(UNITS)).into_font()
}

fn text(canvas: &Canvas, words: &str, x: i32, y: i32, side: HPos) -> Drawn {
    text_at(canvas, words, (x, y), side, VPos::Top)
}

fn text_at(canvas: &Canvas, words: &str, at: (i32, i32), side: HPos, height: VPos) -> Drawn {
    let style = font().into_text_style(canvas).pos(Pos::new(side, height));
    canvas.draw(&Text::new(words.to_owned(), (at.0 * UNITS, at.1 * UNITS), style))
}

/// Letters of a legend entry that fit beside its swatch, from the usual width of a letter.
const LETTERS_MAX: usize = ((WIDTH - LEFT - RIGHT - SWATCH) as f64 / LETTER_PX) as usize;

/// The label of a legend entry; a name from a campaign file may be longer than the figure is wide.
fn entry(mark: &Mark) -> String {
    let label = label_of(mark).unwrap_or_default();
    if label.chars().count() <= LETTERS_MAX {
        return label.to_owned();
    }
    label.chars().take(LETTERS_MAX - 1).chain(['\u{2026}']).collect()
}

/// Width [px] of one legend entry.
fn entry_width(mark: &Mark) -> i32 {
    let n_letters = notation::plain(&entry(mark)).chars().count();
    SWATCH + 6 + (n_letters as f64 * LETTER_PX) as i32 + 16
}

fn legend_rows(figure: &Figure) -> Vec<Vec<&Mark>> {
    let mut rows: Vec<Vec<&Mark>> = Vec::new();
    let mut used = i32::MAX;
    for mark in figure.legend() {
        let width = entry_width(mark);
        if used.saturating_add(width) > WIDTH - LEFT {
            rows.push(Vec::new());
            used = 0;
        }
        used += width;
        if let Some(row) = rows.last_mut() {
            row.push(mark);
        }
    }
    rows
}

fn legend(canvas: &Canvas, rows: &[Vec<&Mark>]) -> Drawn {
    for (row, marks) in rows.iter().enumerate() {
        let y = TOP + LEGEND_ROW * row as i32 + 5;
        let mut x = LEFT;
        for mark in marks {
            draw::swatch(canvas, mark, (x * UNITS, y * UNITS), SWATCH * UNITS)?;
            text_at(canvas, &entry(mark), (x + SWATCH + 5, y), HPos::Left, VPos::Center)?;
            x += entry_width(mark);
        }
    }
    Ok(())
}
