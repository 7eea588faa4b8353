//! Who is let in, and what every answer says to the browser.
//!
//! Three doors, each shut by itself: the name under which we are asked (a foreign name that leads
//! to this machine is refused), the page that asks (only our own may read or change anything), and
//! the token, where one is set.

use std::net::IpAddr;
use std::sync::Arc;

use axum::extract::{Request, State};
use axum::http::{HeaderMap, HeaderName, HeaderValue, Method, StatusCode, header};
use axum::middleware::Next;
use axum::response::{IntoResponse, Response};

/// Name of the cookie that carries the token of a page.
const COOKIE: &str = "rolltank";

/// What must be known to be let in; empty where everybody on this machine is.
#[derive(Debug, Clone)]
pub(super) struct Token {
    token: Option<Arc<str>>,
}

impl Token {
    pub(super) fn new(token: Option<&str>) -> Self {
        Self { token: token.map(Arc::from) }
    }

    /// Whether that is the token, or none is needed.
    pub(super) fn is(&self, given: &str) -> bool {
        self.token.as_deref().is_none_or(|token| is_same(given, token))
    }

    /// The cookie of a page that has told the token; no script can read it, no other site send it.
    pub(super) fn cookie(&self) -> String {
        let value = self.cookie_value().unwrap_or_default();
        format!("{COOKIE}={value}; HttpOnly; SameSite=Strict; Path=/; Max-Age=86400")
    }

    /// A token may hold what a cookie may not.
    fn cookie_value(&self) -> Option<String> {
        let token = self.token.as_deref()?;
        let digit = |nibble: u8| char::from_digit(u32::from(nibble), 16).unwrap_or_default();
        Some(token.bytes().flat_map(|byte| [digit(byte >> 4), digit(byte & 15)]).collect())
    }

    fn is_carried_by(&self, headers: &HeaderMap) -> bool {
        let text = |name| headers.get(name).and_then(|value: &HeaderValue| value.to_str().ok());
        let bearer = text(header::AUTHORIZATION).and_then(|value| value.strip_prefix("Bearer "));
        if bearer.is_some_and(|given| self.is(given)) {
            return true;
        }
        let Some(wanted) = self.cookie_value() else { return true };
        let cookies = text(header::COOKIE).unwrap_or_default();
        let mut pairs = cookies.split(';').filter_map(|pair| pair.trim().split_once('='));
        pairs.any(|(name, value)| name == COOKIE && is_same(value, &wanted))
    }
}

/// What is shown without a token: the page as everybody could build it, and the way in.
fn is_public(path: &str) -> bool {
    matches!(path, "/" | "/enter" | "/favicon.ico") || path.starts_with("/assets/")
}

pub(super) async fn admit(State(token): State<Token>, request: Request, next: Next) -> Response {
    let headers = request.headers();
    // A name that leads here by the will of another site is not ours.
    if token.token.is_none() && !is_this_machine(headers.get(header::HOST)) {
        let told = "ask for this machine by its address\n";
        return (StatusCode::MISDIRECTED_REQUEST, told).into_response();
    }
    if is_foreign(request.method(), headers) {
        return (StatusCode::FORBIDDEN, "another site may not ask\n").into_response();
    }
    if !is_public(request.uri().path()) && !token.is_carried_by(headers) {
        return (StatusCode::UNAUTHORIZED, "a token is needed\n").into_response();
    }
    next.run(request).await
}

/// Whether a page of another site asks; whoever merely follows a link to us does not.
fn is_foreign(method: &Method, headers: &HeaderMap) -> bool {
    let text = |name: &HeaderName| headers.get(name).and_then(|value| value.to_str().ok());
    if let Some(origin) = headers.get(header::ORIGIN) {
        let host = text(&header::HOST).unwrap_or_default();
        let own = [format!("http://{host}"), format!("https://{host}")];
        return !own.iter().any(|own| origin.as_bytes() == own.as_bytes());
    }
    let site = text(&HeaderName::from_static("sec-fetch-site"));
    let is_link = *method == Method::GET
        && text(&HeaderName::from_static("sec-fetch-mode")) == Some("navigate");
    !is_link && site.is_some_and(|site| site != "same-origin" && site != "none")
}

/// Whether a host is named as only this machine can be.
fn is_this_machine(host: Option<&HeaderValue>) -> bool {
    let Some(host) = host.and_then(|host| host.to_str().ok()) else { return false };
    let without_port = host.rsplit_once(':').map_or(host, |(name, _)| name);
    let loopback = |text: &str| text.trim_matches(['[', ']']).parse::<IpAddr>();
    [host, without_port]
        .into_iter()
        .any(|name| name == "localhost" || loopback(name).is_ok_and(|ip| ip.is_loopback()))
}

/// Compares in a time that tells nothing of where two texts differ.
fn is_same(given: &str, token: &str) -> bool {
    let differing = given.bytes().zip(token.bytes()).fold(0, |all, (a, b)| all | (a ^ b));
    given.len() == token.len() && differing == 0
}

/// What every answer says: only what we serve ourselves may run, nobody may frame, keep or guess.
const HEADERS: [(HeaderName, &str); 8] = [
    (
        header::CONTENT_SECURITY_POLICY,
        "default-src 'none'; script-src 'self'; style-src 'self'; img-src 'self'; \
         connect-src 'self'; base-uri 'none'; form-action 'self'; frame-ancestors 'none'",
    ),
    (header::X_CONTENT_TYPE_OPTIONS, "nosniff"),
    (header::X_FRAME_OPTIONS, "DENY"),
    (header::REFERRER_POLICY, "no-referrer"),
    (header::CACHE_CONTROL, "no-store"),
    (HeaderName::from_static("cross-origin-resource-policy"), "same-origin"),
    (HeaderName::from_static("cross-origin-opener-policy"), "same-origin"),
    (HeaderName::from_static("permissions-policy"), "camera=(), microphone=(), geolocation=()"),
];

pub(super) async fn with_headers(request: Request, next: Next) -> Response {
    let mut response = next.run(request).await;
    for (name, value) in HEADERS {
        response.headers_mut().insert(name, HeaderValue::from_static(value));
    }
    response
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_host_is_this_machine_only_by_its_loopback_address() {
        let is = |host: &'static str| is_this_machine(Some(&HeaderValue::from_static(host)));
        let ours = ["localhost", "localhost:8440", "127.0.0.1:8440", "127.0.0.1", "[::1]:8440"];
        assert!(ours.into_iter().all(is));
        let others = ["evil.example", "evil.example:8440", "127.0.0.1.evil.example", "10.0.0.1:80"];
        assert!(!others.into_iter().any(is) && !is_this_machine(None));
    }

    #[test]
    fn a_token_is_the_same_only_whole() {
        assert!(is_same("secret", "secret"));
        for other in ["", "secre", "secrets", "Secret"] {
            assert!(!is_same(other, "secret"), "{other}");
        }
    }

    #[test]
    fn only_our_own_page_and_programs_are_no_foreigners() {
        let foreign = |pairs: &[(&'static str, &'static str)]| {
            let mut headers = HeaderMap::new();
            headers.insert(header::HOST, HeaderValue::from_static("127.0.0.1:8440"));
            for (name, value) in pairs {
                headers.insert(*name, HeaderValue::from_static(value));
            }
            is_foreign(&Method::GET, &headers)
        };
        assert!(!foreign(&[]) && !foreign(&[("origin", "http://127.0.0.1:8440")]));
        assert!(!foreign(&[("sec-fetch-site", "same-origin")]));
        assert!(!foreign(&[("sec-fetch-site", "cross-site"), ("sec-fetch-mode", "navigate")]));
        for origin in ["http://evil.example", "null", "http://127.0.0.1:8441", ""] {
            assert!(foreign(&[("origin", origin)]), "{origin}");
        }
        assert!(foreign(&[("sec-fetch-site", "same-site"), ("sec-fetch-mode", "cors")]));
    }
}
