//! Just enough of JSON Schema 2020-12 to hold a document to a shipped schema.

use serde_json::Value;

/// Keywords that only explain.
const NOTES: [&str; 5] = ["$schema", "$id", "$defs", "title", "description"];

/// Every place where `document` breaks `schema`, as `path: reason`.
pub(crate) fn violations(schema: &Value, document: &Value) -> Vec<String> {
    let mut found = Vec::new();
    check(schema, schema, document, "$", &mut found);
    found
}

/// What a keyword's rule must be for the schema to be one.
fn list(rule: &Value) -> &[Value] {
    rule.as_array().expect("this keyword takes a list")
}

fn word(rule: &Value) -> &str {
    rule.as_str().expect("this keyword takes a string")
}

fn check(root: &Value, schema: &Value, value: &Value, path: &str, found: &mut Vec<String>) {
    for (keyword, rule) in schema.as_object().expect("a schema is an object") {
        match keyword.as_str() {
            "$ref" => {
                let target = word(rule).strip_prefix('#').and_then(|pointer| root.pointer(pointer));
                check(root, target.expect("a place in this schema"), value, path, found);
            }
            "type" => {
                let alone = std::slice::from_ref(rule);
                let names = rule.as_array().map_or(alone, Vec::as_slice);
                if !names.iter().any(|name| is_a(value, word(name))) {
                    found.push(format!("{path}: {value} is not {rule}"));
                }
            }
            "const" if value != rule => found.push(format!("{path}: {value} is not {rule}")),
            "enum" if !list(rule).contains(value) => {
                found.push(format!("{path}: {value} is none of {rule}"));
            }
            "minimum" if value.as_f64() < rule.as_f64() => {
                found.push(format!("{path}: {value} is below {rule}"));
            }
            "required" => {
                for key in list(rule).iter().map(word) {
                    if value.is_object() && value.get(key).is_none() {
                        found.push(format!("{path}: {key} is missing"));
                    }
                }
            }
            "properties" => {
                for (key, schema) in rule.as_object().expect("this keyword takes an object") {
                    if let Some(value) = value.get(key) {
                        check(root, schema, value, &format!("{path}.{key}"), found);
                    }
                }
            }
            "items" => {
                for (index, value) in value.as_array().into_iter().flatten().enumerate() {
                    check(root, rule, value, &format!("{path}[{index}]"), found);
                }
            }
            "allOf" => {
                for schema in list(rule) {
                    check(root, schema, value, path, found);
                }
            }
            "anyOf" => {
                let fits = |schema| {
                    let mut inner = Vec::new();
                    check(root, schema, value, path, &mut inner);
                    inner.is_empty()
                };
                if !list(rule).iter().any(fits) {
                    found.push(format!("{path}: fits none of the alternatives"));
                }
            }
            "const" | "enum" | "minimum" => {}
            note => assert!(NOTES.contains(&note), "keyword {note} is not checked here"),
        }
    }
}

fn is_a(value: &Value, name: &str) -> bool {
    match name {
        "object" => value.is_object(),
        "array" => value.is_array(),
        "string" => value.is_string(),
        "boolean" => value.is_boolean(),
        "null" => value.is_null(),
        "number" => value.is_number(),
        "integer" => value.is_i64() || value.is_u64(),
        other => panic!("type {other} is not known"),
    }
}
