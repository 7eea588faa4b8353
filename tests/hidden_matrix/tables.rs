//! The page of tables: what was asked of the program, and what it answered.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use serde_json::Value;

use crate::count::{Count, lambda, lambda_beside, text};

/// Misfit from which an effect counts as detectable (EFFECTS.md, section 5; issue criterion).
const DETECTABLE: f64 = 50.0;

/// The page.
pub(crate) fn page(outcomes: &[Value]) -> String {
    let mut page = String::from(
        "# Hidden effects\n\n\
         A simulated towing tank (`tests/hidden_tank/`), with equations, integrator and \
         instruments of its own, hides\neffects in campaigns that `rolltank diagnose` is then \
         asked about. This page is written by\n\n```sh\n\
         cargo test --release --test hidden_matrix -- --all --threads 2\n```\n\n\
         `lambda` is what the best base model leaves of the effect, in squared standard \
         deviations of the noise; an\neffect is detectable where it exceeds 50. Sizes are by \
         the middle of the effect's range. *In class*: the answer\nnames an effect that these \
         runs cannot tell from the hidden one, and says so, or the hidden tank itself finds\nthat \
         it reproduces the hidden one to `lambda` below 12. *Wrong*: a name that is not there, \
         alone or beside the\nright one.\n\n",
    );
    let groups = Groups::of(outcomes);
    writeln!(page, "{} campaigns.\n", outcomes.len()).expect("text");
    headline(&mut page, &groups);
    by_effect(&mut page, &groups);
    confusion(&mut page, outcomes);
    by_size(&mut page, &groups);
    crate::figures::append(&mut page, outcomes);
    page
}

/// The outcomes by what they test.
struct Groups<'a> {
    clean: Vec<&'a Value>,
    invented: Vec<&'a Value>,
    pairs: Vec<&'a Value>,
    detectable: Vec<&'a Value>,
    faint: Vec<&'a Value>,
}

impl<'a> Groups<'a> {
    fn of(outcomes: &'a [Value]) -> Self {
        let mut groups = Self {
            clean: Vec::new(),
            invented: Vec::new(),
            pairs: Vec::new(),
            detectable: Vec::new(),
            faint: Vec::new(),
        };
        for outcome in outcomes {
            let hidden = crate::count::hidden(outcome);
            let seen = lambda(outcome) > DETECTABLE;
            let group = match hidden.as_slice() {
                [] => &mut groups.clean,
                [id] if id.starts_with("invented.") => &mut groups.invented,
                [_] if seen => &mut groups.detectable,
                [_] => &mut groups.faint,
                _ => &mut groups.pairs,
            };
            group.push(outcome);
        }
        groups
    }
}

/// What the matrix must show, and what it shows.
fn headline(page: &mut String, groups: &Groups) {
    page.push_str(
        "| asked | campaigns | named | in class | partly | with more | wrong name | adequate | \
         unexplained | failed | wanted |\n|---|---|---|---|---|---|---|---|---|---|---|\n",
    );
    let visible = |outcome: &&&Value| lambda(outcome) > DETECTABLE;
    let seen: Vec<&Value> = groups.invented.iter().filter(visible).copied().collect();
    let alone: Vec<&Value> = groups.pairs.iter().filter(visible).copied().collect();
    let is_left = |outcome: &&&Value| lambda_beside(outcome) > DETECTABLE;
    let pairs: Vec<&Value> = groups.pairs.iter().filter(is_left).copied().collect();
    let lines = [
        ("one effect, detectable", &groups.detectable, "named or in class 90 %, wrong 2 %"),
        ("one effect, below", &groups.faint, "wrong 5 %"),
        ("nothing hidden", &groups.clean, "adequate 95 %"),
        ("in no catalogue", &seen, "wrong 10 %"),
        ("two effects, each detectable alone", &alone, "-"),
        ("two effects, each detectable beside the other", &pairs, "both 80 %"),
    ];
    for (name, outcomes, wanted) in lines {
        let count = Count::of(outcomes);
        writeln!(page, "| {name} | {} | {} | {wanted} |", count.n, count.shares()).expect("text");
    }
    page.push('\n');
}

/// One line an effect, one column a run set.
fn by_effect(page: &mut String, groups: &Groups) {
    page.push_str(
        "## By effect and run set\n\nDetectable campaigns: named or in class / wrong / nothing \
         named, of all.\n\n\
         | effect | rest | speeds | forced | below `lambda` 50: wrong of all |\n\
         |---|---|---|---|---|\n",
    );
    let mut lines: BTreeMap<&str, [Vec<&Value>; 4]> = BTreeMap::new();
    let sets = ["rest", "speeds", "forced"];
    for outcome in &groups.detectable {
        let at = sets.iter().position(|set| *set == text(outcome, "set")).unwrap_or(0);
        lines.entry(crate::count::hidden(outcome)[0]).or_default()[at].push(outcome);
    }
    for outcome in &groups.faint {
        lines.entry(crate::count::hidden(outcome)[0]).or_default()[3].push(outcome);
    }
    for (effect, cells) in &lines {
        write!(page, "| `{effect}` |").expect("text");
        for cell in &cells[..3] {
            let count = Count::of(cell);
            if count.n == 0 {
                page.push_str(" |");
            } else {
                let (right, wrong) = (count.right(), count.wrong());
                let rest = count.n - right - wrong;
                write!(page, " {right} / {wrong} / {rest} of {} |", count.n).expect("text");
            }
        }
        let below = Count::of(&cells[3]);
        let told =
            if below.n == 0 { String::new() } else { format!("{} of {}", below.wrong(), below.n) };
        writeln!(page, " {told} |").expect("text");
    }
    page.push('\n');
}

/// How often which name was given for which effect.
fn confusion(page: &mut String, outcomes: &[Value]) {
    page.push_str(
        "## Names that were not there\n\n| hidden | named | campaigns | for example |\n\
         |---|---|---|---|\n",
    );
    let mut pairs: BTreeMap<(String, String), (usize, &str)> = BTreeMap::new();
    for outcome in outcomes.iter().filter(|outcome| crate::count::is_wrong(outcome)) {
        let hidden = crate::count::hidden(outcome).join("` + `");
        let hidden = if hidden.is_empty() { "nothing".to_owned() } else { format!("`{hidden}`") };
        let causes = outcome["causes"].as_array().into_iter().flatten();
        let causes: Vec<&str> = causes.filter_map(Value::as_str).collect();
        let entry = pairs.entry((hidden, causes.join("` + `")));
        entry.or_insert((0, text(outcome, "name"))).0 += 1;
    }
    let mut pairs: Vec<_> = pairs.into_iter().collect();
    pairs.sort_by_key(|(_, (n, _))| std::cmp::Reverse(*n));
    for ((hidden, named), (n, example)) in pairs {
        writeln!(page, "| {hidden} | `{named}` | {n} | {example} |").expect("text");
    }
    page.push('\n');
}

/// Detectable effects by size.
fn by_size(page: &mut String, groups: &Groups) {
    page.push_str(
        "## By size\n\n| size | set | campaigns | named | in class | partly | with more | wrong \
         name | adequate | unexplained | failed |\n|---|---|---|---|---|---|---|---|---|---|---|\n",
    );
    for size in [0.5, 1.0, 2.0] {
        for set in ["rest", "speeds", "forced"] {
            let here = |outcome: &&&Value| {
                outcome["size"].as_f64() == Some(size) && text(outcome, "set") == set
            };
            let cell: Vec<&Value> = groups.detectable.iter().filter(here).copied().collect();
            let count = Count::of(&cell);
            writeln!(page, "| {size} | {set} | {} | {} |", count.n, count.shares()).expect("text");
        }
    }
    page.push('\n');
}
