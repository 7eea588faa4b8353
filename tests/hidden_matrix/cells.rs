//! The cells of the matrix: which campaigns are drawn.

use crate::arguments::Arguments;
use crate::hidden_tank::campaign::Asked;
use crate::hidden_tank::draw::Draw;
use crate::hidden_tank::effects::{CATALOGUED, INVENTED};
use crate::hidden_tank::plan::RunSet;
use crate::hidden_tank::score::{COMPANIONS, UNTESTABLE, in_class};

/// Pairs of the whole matrix, and the seeds of clean campaigns by one seed of the others.
const PAIRS_BY_SEED: usize = 5;
const CLEAN_BY_SEED: u64 = 4;

/// Every campaign that the arguments ask for, seed by seed, so that a matrix that is stopped early
/// has seen all effects.
pub(crate) fn all(arguments: &Arguments) -> Vec<Asked> {
    let ids = |rows: &[&'static crate::hidden_tank::effect::Row]| {
        rows.iter().map(|row| vec![row.id.to_owned()]).collect::<Vec<_>>()
    };
    let mut cells = Vec::new();
    for seed in arguments.seeds.clone() {
        for name in &arguments.effects {
            let hidden = match name.as_str() {
                "catalogued" => ids(&CATALOGUED),
                "invented" => ids(&INVENTED),
                "clean" => {
                    cells.extend(clean(arguments, seed));
                    continue;
                }
                "pairs" => continue,
                // Two effects at once are joined by a plus.
                name => vec![name.split('+').map(str::to_owned).collect()],
            };
            for hidden in hidden {
                for set in &arguments.sets {
                    let sizes = arguments.sizes.iter();
                    cells.extend(
                        sizes.map(|size| asked(arguments, *set, hidden.clone(), *size, seed)),
                    );
                }
            }
        }
    }
    if arguments.effects.iter().any(|name| name == "pairs") {
        cells.extend(arguments.seeds.clone().flat_map(|seed| pairs(arguments, seed)));
    }
    cells
}

fn asked(arguments: &Arguments, set: RunSet, hidden: Vec<String>, size: f64, seed: u64) -> Asked {
    Asked { set, hidden, size, seed, scatter: arguments.scatter }
}

fn clean(arguments: &Arguments, seed: u64) -> Vec<Asked> {
    let seeds = seed * CLEAN_BY_SEED..(seed + 1) * CLEAN_BY_SEED;
    let of_seed = |seed: u64| {
        arguments.sets.iter().map(move |set| asked(arguments, *set, Vec::new(), 1.0, seed))
    };
    seeds.flat_map(of_seed).collect()
}

/// Pairs of testable effects of different classes, none brought along by the other, on the richer
/// run sets.
fn pairs(arguments: &Arguments, seed: u64) -> Vec<Asked> {
    let testable: Vec<&str> =
        CATALOGUED.iter().map(|row| row.id).filter(|id| !UNTESTABLE.contains(id)).collect();
    let mut draw = Draw::named(&format!("pairs of hidden effects, seed {seed}"));
    let mut all = Vec::new();
    while all.len() < PAIRS_BY_SEED {
        let set = [RunSet::Speeds, RunSet::Forced][draw.index(2)];
        let [one, other] = [(); 2].map(|()| testable[draw.index(testable.len())]);
        if one != other && !in_class(one, other, set) && !are_companions(one, other) {
            let own = seed * PAIRS_BY_SEED as u64 + all.len() as u64;
            all.push(asked(arguments, set, vec![one.into(), other.into()], 2.0, own));
        }
    }
    all
}

/// Whether one of two effects brings the other along, so that both are one.
fn are_companions(one: &str, other: &str) -> bool {
    COMPANIONS.iter().any(|pair| *pair == (one, other) || *pair == (other, one))
}
