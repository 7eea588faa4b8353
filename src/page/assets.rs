//! The files of the page, part of the program: nothing is fetched from anywhere else.
//!
//! uPlot 1.6.32 draws the strips; its licence lies beside it and is served with it.

/// One file.
pub(super) struct Asset {
    /// Name below `/assets/`.
    pub(super) name: &'static str,
    /// What it is.
    pub(super) content_type: &'static str,
    /// Its text.
    pub(super) text: &'static str,
}

/// The page itself.
pub(super) const PAGE: &str = include_str!("assets/page.html");

const SCRIPT: &str = "text/javascript; charset=utf-8";
const STYLE: &str = "text/css; charset=utf-8";
const TEXT: &str = "text/plain; charset=utf-8";
const PICTURE: &str = "image/svg+xml";

/// Every file that the page asks for.
pub(super) const ASSETS: [Asset; 14] = [
    asset("uplot.js", SCRIPT, include_str!("assets/uplot/uPlot.iife.min.js")),
    asset("uplot.css", STYLE, include_str!("assets/uplot/uPlot.min.css")),
    asset("uplot-licence.txt", TEXT, include_str!("assets/uplot/LICENSE")),
    asset("report.css", STYLE, crate::report::STYLE),
    asset("page.css", STYLE, include_str!("assets/page.css")),
    asset("icon.svg", PICTURE, include_str!("assets/icon.svg")),
    asset("page.js", SCRIPT, include_str!("assets/page.js")),
    asset("stream.js", SCRIPT, include_str!("assets/stream.js")),
    asset("strips.js", SCRIPT, include_str!("assets/strips.js")),
    asset("state.js", SCRIPT, include_str!("assets/state.js")),
    asset("views.js", SCRIPT, include_str!("assets/views.js")),
    asset("actions.js", SCRIPT, include_str!("assets/actions.js")),
    asset("keys.js", SCRIPT, include_str!("assets/keys.js")),
    asset("theme.js", SCRIPT, include_str!("assets/theme.js")),
];

const fn asset(name: &'static str, content_type: &'static str, text: &'static str) -> Asset {
    Asset { name, content_type, text }
}
