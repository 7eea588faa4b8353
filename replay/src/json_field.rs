//! One number out of a JSON message, found by the path of its field.

use std::fmt;

use serde::de::{DeserializeSeed, Deserializer, IgnoredAny, MapAccess, SeqAccess, Visitor};

/// What stands at the end of a path.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Found {
    /// A number; JSON knows no others than finite ones.
    Number(f64),
    /// `null`, as many programs write a missing value.
    Null,
    /// Nothing: the message has no such field.
    Absent,
    /// Something else, in words.
    Other(&'static str),
}

/// The value at `path`: keys and array indices joined by points, such as `position.0`.
///
/// A key may itself contain points; the longest key that fits is taken.
///
/// # Errors
/// The message is not JSON.
pub(crate) fn number_at(message: &[u8], path: &str) -> Result<Found, serde_json::Error> {
    let mut reader = serde_json::Deserializer::from_slice(message);
    let found = Walk { path }.deserialize(&mut reader)?;
    reader.end()?;
    Ok(found)
}

/// Walks down a path, of which nothing is left at its end.
#[derive(Clone, Copy)]
struct Walk<'a> {
    path: &'a str,
}

impl Walk<'_> {
    fn leaf(self, found: Found) -> Found {
        if self.path.is_empty() { found } else { Found::Absent }
    }
}

/// What is left of `path` behind `key`, when the key lies on the path.
fn behind<'a>(path: &'a str, key: &str) -> Option<&'a str> {
    match path.strip_prefix(key)? {
        "" => Some(""),
        rest => rest.strip_prefix('.'),
    }
}

impl<'de> DeserializeSeed<'de> for Walk<'_> {
    type Value = Found;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<Found, D::Error> {
        deserializer.deserialize_any(self)
    }
}

impl<'de> Visitor<'de> for Walk<'_> {
    type Value = Found;

    fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("a JSON value")
    }

    fn visit_f64<E>(self, number: f64) -> Result<Found, E> {
        Ok(self.leaf(Found::Number(number)))
    }

    fn visit_i64<E>(self, number: i64) -> Result<Found, E> {
        Ok(self.leaf(Found::Number(number as f64)))
    }

    fn visit_u64<E>(self, number: u64) -> Result<Found, E> {
        Ok(self.leaf(Found::Number(number as f64)))
    }

    fn visit_unit<E>(self) -> Result<Found, E> {
        // A message without its inner object has no value either.
        Ok(Found::Null)
    }

    fn visit_bool<E>(self, _: bool) -> Result<Found, E> {
        Ok(self.leaf(Found::Other("true or false")))
    }

    fn visit_str<E>(self, _: &str) -> Result<Found, E> {
        Ok(self.leaf(Found::Other("text")))
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Found, A::Error> {
        let mut found = self.leaf(Found::Other("an object"));
        let mut left = usize::MAX;
        while let Some(rest) = map.next_key_seed(Key { path: self.path })? {
            match rest {
                Some(rest) if !self.path.is_empty() => {
                    let here = map.next_value_seed(Walk { path: rest })?;
                    if found == Found::Absent || rest.len() < left {
                        (found, left) = (here, rest.len());
                    }
                }
                _ => drop(map.next_value::<IgnoredAny>()?),
            }
        }
        Ok(found)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Found, A::Error> {
        let mut found = self.leaf(Found::Other("a list"));
        let (wanted, rest) = self.path.split_once('.').unwrap_or((self.path, ""));
        let wanted: Option<usize> = wanted.parse().ok();
        for index in 0.. {
            let here = if wanted == Some(index) {
                list.next_element_seed(Walk { path: rest })?
            } else {
                list.next_element::<IgnoredAny>()?.map(|_| found)
            };
            match here {
                Some(here) => found = here,
                None => break,
            }
        }
        Ok(found)
    }
}

/// Reads a key and says what of the path is left behind it, when it lies on the path.
struct Key<'a> {
    path: &'a str,
}

impl<'de, 'a> DeserializeSeed<'de> for Key<'a> {
    type Value = Option<&'a str>;

    fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<Self::Value, D::Error> {
        deserializer.deserialize_str(self)
    }
}

impl<'a> Visitor<'_> for Key<'a> {
    type Value = Option<&'a str>;

    fn expecting(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str("a key")
    }

    fn visit_str<E>(self, key: &str) -> Result<Self::Value, E> {
        Ok(behind(self.path, key))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn at(path: &str) -> Found {
        let message = br#"{"t":1,"angle":{"roll":-0.25,"name":"x","list":[1,{"y":3e2}]},
            "angle.pitch":7,"none":null,"flag":true}"#;
        number_at(message, path).expect("it is JSON")
    }

    #[test]
    fn a_path_leads_through_objects_and_lists_to_one_number() {
        assert_eq!(at("t"), Found::Number(1.0));
        assert_eq!(at("angle.roll"), Found::Number(-0.25));
        assert_eq!(at("angle.list.0"), Found::Number(1.0));
        assert_eq!(at("angle.list.1.y"), Found::Number(300.0));
        assert_eq!(at("angle.pitch"), Found::Number(7.0), "a key with a point in it");
    }

    #[test]
    fn what_is_no_number_is_told_apart() {
        assert_eq!(at("none"), Found::Null);
        assert_eq!(at("angle.yaw"), Found::Absent);
        assert_eq!(at("angle.list.2"), Found::Absent);
        assert_eq!(at("t.x"), Found::Absent);
        assert_eq!(at("angle"), Found::Other("an object"));
        assert_eq!(at("angle.list"), Found::Other("a list"));
        assert_eq!(at("angle.name"), Found::Other("text"));
        assert_eq!(at("flag"), Found::Other("true or false"));
        assert!(number_at(b"{\"t\":1}}", "t").is_err(), "trailing bytes");
        assert!(number_at(b"\xff", "t").is_err(), "no JSON");
    }
}
