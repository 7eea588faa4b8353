//! The page and its files, by their names in a table.

use axum::extract::Path;
use axum::http::{StatusCode, header};
use axum::response::{Html, IntoResponse, Response};

use crate::page::assets::{ASSETS, PAGE};

pub(super) async fn page() -> Html<&'static str> {
    Html(PAGE)
}

/// Browsers ask for it where a page names none, as those of the report do.
pub(super) async fn icon() -> Response {
    asset(Path("icon.svg".to_owned())).await
}

pub(super) async fn asset(Path(name): Path<String>) -> Response {
    match ASSETS.iter().find(|asset| asset.name == name) {
        Some(asset) => ([(header::CONTENT_TYPE, asset.content_type)], asset.text).into_response(),
        None => StatusCode::NOT_FOUND.into_response(),
    }
}
