//! A figure described by its data: panels over one horizontal axis, drawn as inline SVG.

mod axis;
mod draw;
mod frame;
mod ink;
mod thin;

pub(crate) use axis::{Axis, SecondScale};
pub(crate) use ink::{Hue, Ink, Shape};

use maud::{Markup, PreEscaped, html};

use super::notation;

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

    /// The same panel with a second scale on its right side, where its factor is known.
    #[must_use]
    pub(crate) fn second_scale(self, second: SecondScale) -> Self {
        let known = second.factor.is_finite() && second.factor > 0.0;
        Self { second: known.then_some(second), ..self }
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

    /// The figure as an SVG file that stands alone: its own size, a white ground, no style sheet.
    pub(crate) fn file(&self) -> Markup {
        let drawing = frame::drawing(self);
        let (width, height) = drawing.size_px;
        html! {
            svg xmlns="http://www.w3.org/2000/svg" width=(width) height=(height)
                viewBox=(drawing.view_box) stroke-linejoin="round" role="img" {
                title { (notation::plain(&self.title)) }
                desc { (self.description()) }
                rect width="100%" height="100%" fill="#ffffff" {}
                (PreEscaped(drawing.elements))
            }
        }
    }

    /// What a screen reader says: the axes and the names of the curves.
    fn description(&self) -> String {
        let axes: Vec<_> = self.panels.iter().map(|panel| panel.y.label()).collect();
        let labels: Vec<_> = self.legend().into_iter().filter_map(label_of).collect();
        let shown = match labels.as_slice() {
            [] => String::new(),
            labels => format!(" Shown: {}.", labels.join(", ")),
        };
        notation::plain(&format!("{} against {}.{shown}", axes.join(", "), self.x.label()))
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

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        /// Whatever identification hands over, a page is written, with every coordinate a number.
        #[test]
        fn any_numbers_draw_without_a_panic_and_without_a_stray_coordinate(
            x in proptest::collection::vec(proptest::num::f64::ANY, 0..9),
            y in proptest::collection::vec(proptest::num::f64::ANY, 0..9),
            lo in proptest::collection::vec(-1e3..1e3, 0..9),
        ) {
            let bars: Vec<_> = x.iter().zip(&y).map(|(&x, &y)| (x, y, y - 1.0, y + 1.0)).collect();
            let panel = Panel::new(Axis::new("y"))
                .second_scale(SecondScale { label: "z".to_owned(), factor: 2.0 })
                .line(&x, &y, Ink::new(Hue::Blue).dashed().named("line"))
                .line(&x, &lo, Ink::new(Hue::Blue))
                .band(&x, &lo, &y, Ink::new(Hue::Sky).named("band"))
                .points(&x, &lo, Ink::of_series(3))
                .error_bars(&bars, Ink::of_series(4))
                .stretch(-1.0, 1.0, Ink::new(Hue::Green));
            let figure = Figure::new("any", "Any", Axis::new("x")).panel(panel);
            let html = figure.markup().into_string();
            prop_assert!(!html.contains("NaN") && !html.contains(">inf"));
        }
    }

    #[test]
    fn a_label_from_a_file_is_escaped_in_the_drawing() {
        let panel = Panel::new(Axis::new("y")).line(
            &[0.0, 1.0],
            &[0.0, 1.0],
            Ink::new(Hue::Blue).named("<script>&\""),
        );
        let html = Figure::new("any", "Any", Axis::new("x")).panel(panel).markup().into_string();
        assert!(!html.contains("<script>") && html.contains("&lt;script&gt;"));
    }
}
