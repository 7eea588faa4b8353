//! How a mark is drawn: hue, shape, width, name in the legend.

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
    pub(super) hue: Hue,
    pub(super) shape: Shape,
    pub(super) dashed: bool,
    pub(super) width_px: f64,
    pub(super) label: Option<String>,
}

impl Ink {
    /// A solid line of 1.4 px, or filled circles.
    pub(crate) fn new(hue: Hue) -> Self {
        Self { hue, shape: Shape::Circle, dashed: false, width_px: 1.4, label: None }
    }

    /// The ink of the `index`-th of several series, distinct in colour and in shape.
    pub(crate) fn of_series(index: usize) -> Self {
        const HUES: [Hue; 7] = [
            Hue::Blue,
            Hue::Vermillion,
            Hue::Green,
            Hue::Purple,
            Hue::Orange,
            Hue::Sky,
            Hue::Black,
        ];
        const SHAPES: [Shape; 6] = [
            Shape::Circle,
            Shape::Square,
            Shape::Triangle,
            Shape::Diamond,
            Shape::Cross,
            Shape::OpenCircle,
        ];
        // Seven hues and six shapes meet again only after forty-two series.
        Self::new(HUES[index % HUES.len()]).shaped(SHAPES[index % SHAPES.len()])
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn series_remain_apart_in_hue_or_shape() {
        let inks: Vec<_> = (0..42).map(Ink::of_series).collect();
        for (index, ink) in inks.iter().enumerate() {
            assert!(!inks[..index].contains(ink), "series {index} repeats an earlier one");
        }
    }
}
