//! A figure described by its data: panels over one horizontal axis, drawn as inline SVG.

mod axis;
mod draw;
mod frame;
mod thin;

pub(crate) use axis::{Axis, SecondScale};

use maud::{Markup, PreEscaped, html};

use super::notation;

/// Hues that remain apart for colour-blind readers (Okabe and Ito, 2008).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Hue {
    /// Black.
    Black,
    /// Blue.
    Blue,
    /// Vermillion.
    Vermillion,
    /// Bluish green.
    Green,
    /// Reddish purple.
    Purple,
    /// Orange.
    Orange,
    /// Sky blue.
    Sky,
    /// Neutral grey, for what is in the background.
    Grey,
}

/// How a point is marked, so that series remain apart in a black-and-white print.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Shape {
    /// Filled circle.
    Circle,
    /// Open circle.
    OpenCircle,
    /// Filled square.
    Square,
    /// Filled triangle.
    Triangle,
    /// Filled diamond.
    Diamond,
    /// Upright cross.
    Cross,
    /// A dot, for clouds of points.
    Dot,
}

/// How one mark is drawn and what the legend calls it.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Ink {
    hue: Hue,
    shape: Shape,
    dashed: bool,
    width_px: f64,
    label: Option<String>,
}

impl Ink {
    /// A solid line of 1.4 px, or filled circles.
    pub(crate) fn new(hue: Hue) -> Self {
        Self { hue, shape: Shape::Circle, dashed: false, width_px: 1.4, label: None }
    }

    /// The ink of the `index`-th of several series, distinct in colour and in shape.
    pub(crate) fn of_series(index: usize) -> Self {
        const SERIES: [(Hue, Shape); 7] = [
            (Hue::Blue, Shape::Circle),
            (Hue::Vermillion, Shape::Square),
            (Hue::Green, Shape::Triangle),
            (Hue::Purple, Shape::Diamond),
            (Hue::Orange, Shape::Cross),
            (Hue::Sky, Shape::OpenCircle),
            (Hue::Black, Shape::Dot),
        ];
        let (hue, shape) = SERIES[index % SERIES.len()];
        Self::new(hue).shaped(shape)
    }

    /// The same ink with an entry in the legend.
    #[must_use]
    pub(crate) fn named(self, label: impl Into<String>) -> Self {
        Self { label: Some(label.into()), ..self }
    }

    /// The same ink with another mark for points.
    #[must_use]
    pub(crate) fn shaped(self, shape: Shape) -> Self {
        Self { shape, ..self }
    }

    /// The same ink, dashed.
    #[must_use]
    pub(crate) fn dashed(self) -> Self {
        Self { dashed: true, ..self }
    }

    /// The same ink with another line width [px].
    #[must_use]
    pub(crate) fn wide(self, width_px: f64) -> Self {
        Self { width_px, ..self }
    }
}

/// One thing drawn in a panel, in the panel's own units.
#[derive(Debug, Clone, PartialEq)]
enum Mark {
    Line { x: Vec<f64>, y: Vec<f64>, ink: Ink },
    Band { x: Vec<f64>, lo: Vec<f64>, hi: Vec<f64>, ink: Ink },
    Points { x: Vec<f64>, y: Vec<f64>, ink: Ink },
    ErrorBars { x: Vec<f64>, y: Vec<f64>, lo: Vec<f64>, hi: Vec<f64>, ink: Ink },
    Stretch { from: f64, to: f64, ink: Ink },
    Level { y: f64, ink: Ink },
}

/// One pair of axes with what is drawn between them.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Panel {
    y: Axis,
    second: Option<SecondScale>,
    height_px: i32,
    marks: Vec<Mark>,
}

impl Panel {
    /// An empty panel with its vertical axis.
    pub(crate) fn new(y: Axis) -> Self {
        Self { y, second: None, height_px: 210, marks: Vec::new() }
    }

    /// The same panel with another height [px] between its axes.
    #[must_use]
    pub(crate) fn height(self, height_px: i32) -> Self {
        Self { height_px, ..self }
    }

    /// The same panel with a second scale on its right side.
    #[must_use]
    pub(crate) fn second_scale(self, second: SecondScale) -> Self {
        Self { second: Some(second), ..self }
    }

    /// Adds a curve; it is broken at holes in `x` much wider than its usual step.
    #[must_use]
    pub(crate) fn line(self, x: &[f64], y: &[f64], ink: Ink) -> Self {
        self.mark(Mark::Line { x: x.to_vec(), y: y.to_vec(), ink })
    }

    /// Adds the area between two curves.
    #[must_use]
    pub(crate) fn band(self, x: &[f64], lo: &[f64], hi: &[f64], ink: Ink) -> Self {
        self.mark(Mark::Band { x: x.to_vec(), lo: lo.to_vec(), hi: hi.to_vec(), ink })
    }

    /// Adds points.
    #[must_use]
    pub(crate) fn points(self, x: &[f64], y: &[f64], ink: Ink) -> Self {
        self.mark(Mark::Points { x: x.to_vec(), y: y.to_vec(), ink })
    }

    /// Adds points `(x, y, lo, hi)` with a bar from `lo` to `hi` each.
    #[must_use]
    pub(crate) fn error_bars(self, bars: &[(f64, f64, f64, f64)], ink: Ink) -> Self {
        self.mark(Mark::ErrorBars {
            x: bars.iter().map(|bar| bar.0).collect(),
            y: bars.iter().map(|bar| bar.1).collect(),
            lo: bars.iter().map(|bar| bar.2).collect(),
            hi: bars.iter().map(|bar| bar.3).collect(),
            ink,
        })
    }

    /// Marks a stretch of the horizontal axis.
    #[must_use]
    pub(crate) fn stretch(self, from: f64, to: f64, ink: Ink) -> Self {
        self.mark(Mark::Stretch { from, to, ink })
    }

    /// Adds a horizontal line.
    #[must_use]
    pub(crate) fn level(self, y: f64, ink: Ink) -> Self {
        self.mark(Mark::Level { y, ink })
    }

    fn mark(mut self, mark: Mark) -> Self {
        self.marks.push(mark);
        self
    }
}

/// Panels over one horizontal axis, with the words that belong to them.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Figure {
    id: String,
    title: String,
    caption: String,
    x: Axis,
    panels: Vec<Panel>,
}

impl Figure {
    /// A figure without panels; `id` is unique on its page.
    pub(crate) fn new(id: impl Into<String>, title: impl Into<String>, x: Axis) -> Self {
        let (id, title) = (id.into(), title.into());
        Self { id, title, caption: String::new(), x, panels: Vec::new() }
    }

    /// The same figure with the sentences that follow its title.
    #[must_use]
    pub(crate) fn caption(self, caption: impl Into<String>) -> Self {
        Self { caption: caption.into(), ..self }
    }

    /// Adds a panel below those already there.
    #[must_use]
    pub(crate) fn panel(mut self, panel: Panel) -> Self {
        self.panels.push(panel);
        self
    }

    /// The figure as HTML with its SVG inside.
    pub(crate) fn markup(&self) -> Markup {
        let drawing = frame::drawing(self);
        let (title_id, text_id) = (format!("{}-title", self.id), format!("{}-text", self.id));
        html! {
            figure id=(self.id) {
                svg viewBox=(drawing.view_box) role="img"
                    aria-labelledby={ (title_id) " " (text_id) } {
                    title id=(title_id) { (notation::plain(&self.title)) }
                    desc id=(text_id) { (self.description()) }
                    // The drawing's own texts were escaped when they were drawn.
                    (PreEscaped(drawing.elements))
                }
                figcaption {
                    b { (notation::html(&self.title)) "." }
                    @if !self.caption.is_empty() { " " (notation::html(&self.caption)) }
                }
            }
        }
    }

    /// What a screen reader says: the axes and the names of the curves.
    fn description(&self) -> String {
        let axes: Vec<_> = self.panels.iter().map(|panel| panel.y.label()).collect();
        let mut text = format!("{} against {}.", axes.join(", "), self.x.label());
        let labels: Vec<_> = self.legend().into_iter().filter_map(|mark| label_of(mark)).collect();
        if !labels.is_empty() {
            text.push_str(&format!(" Shown: {}.", labels.join(", ")));
        }
        notation::plain(&text)
    }

    /// The marks with a legend entry, each label once, in order of drawing.
    fn legend(&self) -> Vec<&Mark> {
        let mut legend: Vec<&Mark> = Vec::new();
        for mark in self.panels.iter().flat_map(|panel| &panel.marks) {
            let label = label_of(mark);
            if label.is_some() && !legend.iter().any(|known| label_of(known) == label) {
                legend.push(mark);
            }
        }
        legend
    }
}

fn label_of(mark: &Mark) -> Option<&str> {
    ink_of(mark).label.as_deref()
}

fn ink_of(mark: &Mark) -> &Ink {
    match mark {
        Mark::Line { ink, .. }
        | Mark::Band { ink, .. }
        | Mark::Points { ink, .. }
        | Mark::ErrorBars { ink, .. }
        | Mark::Stretch { ink, .. }
        | Mark::Level { ink, .. } => ink,
    }
}
