//! Reading `campaign.toml` to its end, so that every mistake in it is known at once.

use std::path::Path;
use std::string::FromUtf8Error;

use devices::Quantity;
use replay::Columns;

use super::mistake::Mistake;
use super::tree::{Section, Source};
use super::{
    Campaign, LIVE_FOLDER, Recording, columns, judged, live, particulars, plan, recordings,
};
use crate::judgement::Judgements;
use crate::model::model_file::ModelFile;

/// Name of the campaign file in its folder.
pub const FILE_NAME: &str = "campaign.toml";

/// Reads the campaign file of a folder and looks for the recordings it names.
///
/// # Errors
/// Every mistake in the file, in the order of its lines.
pub fn read(folder: &Path) -> Result<Campaign, Vec<Mistake>> {
    let path = folder.join(FILE_NAME);
    let bytes = std::fs::read(&path).map_err(|error| vec![unreadable(folder, &error)])?;
    let text = String::from_utf8(bytes).map_err(|error| vec![not_utf8(folder, &error)])?;
    let source = Source::new(path.display().to_string(), &text);
    let Some(tree) = source.parse() else { return Err(source.into_mistakes()) };
    let campaign = whole(&source, &source.root(tree.get_ref()), folder);
    match (campaign, source.into_mistakes()) {
        (Some(campaign), mistakes) if mistakes.is_empty() => Ok(campaign),
        (_, mistakes) => Err(mistakes),
    }
}

fn whole(source: &Source<'_>, root: &Section<'_>, folder: &Path) -> Option<Campaign> {
    let name = root.text("name").map(str::to_owned);
    let hull = root.required_section("hull").and_then(|section| particulars::hull(&section));
    let water = particulars::water(root.section("water").as_ref());
    let tank = particulars::tank(root.section("tank").as_ref(), hull.as_ref());
    let trueness = particulars::trueness(root.section("uncertainty").as_ref());
    let exciter =
        root.section("exciter").and_then(|section| particulars::exciter(&section, hull.as_ref()));
    let columns = root.section("columns").map(|section| columns::read(&section));
    let known = columns.clone().unwrap_or_default();
    let live = live::read(root, folder);
    let is_live = !live.setups.is_empty();
    let plan = plan::read(root, folder, hull.as_ref(), &water);
    let recordings = if root.holds("recording") {
        let named = |quantity: Quantity| root.holds_below("columns", quantity.name());
        let mut listed = recordings::read(root.sections("recording"), folder, &named);
        // What the instruments recorded meanwhile belongs to the day without being listed.
        let own = if is_live { found(source, folder, &folder.join(LIVE_FOLDER)) } else { vec![] };
        listed.extend(recordings::not_in(&listed, own));
        listed
    } else {
        root.leave("recording");
        let mut all = found(source, folder, folder);
        all.retain(|recording| recording.name != plan.file);
        // The daemon adds to these, and their runs are numbered behind those of all others.
        all.sort_by_key(recordings::is_live);
        all
    };
    if recordings.is_empty() && !is_live && !root.holds("recording") {
        let hint = "put the recordings (*.mcap, *.csv) beside campaign.toml, or describe the \
            instruments in [[device]]";
        source.add(None, "the folder holds no recording".to_owned(), Some(hint.to_owned()));
    }
    root.close();
    check_columns(root, columns.as_ref(), &recordings);
    check_exciter(root, &known);
    let model = model(source, folder);
    let judgements = judged::read(folder).unwrap_or_else(|mistakes| {
        for mistake in mistakes {
            root.add(mistake);
        }
        Judgements::default()
    });
    Some(Campaign {
        folder: folder.to_owned(),
        name: name.unwrap_or_else(|| folder_name(folder)),
        hull: hull?,
        water,
        tank,
        exciter,
        columns: known,
        recordings,
        model,
        judgements,
        live,
        plan,
        trueness,
    })
}

/// The extended model, where a diagnosis wrote one.
fn model(source: &Source<'_>, folder: &Path) -> Option<ModelFile> {
    let path = Campaign::model_path(folder);
    let text = match std::fs::read_to_string(&path) {
        Ok(text) => text,
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => return None,
        Err(error) => {
            source.add(None, format!("\"{}\": {error}", path.display()), None);
            return None;
        }
    };
    let model = ModelFile::from_toml(&text);
    let hint = "move it away, or write it anew with `rolltank diagnose --write-model`";
    model
        .map_err(|mistake| {
            source.add(None, format!("\"{}\": {mistake}", path.display()), Some(hint.to_owned()));
        })
        .ok()
}

/// Every recording in `below`, a folder of the campaign or its own; none when it is not there.
fn found(source: &Source<'_>, folder: &Path, below: &Path) -> Vec<Recording> {
    if !below.exists() {
        return Vec::new();
    }
    match replay::list_recordings(below) {
        Ok(paths) => {
            for (table, copy) in recordings::copies(&paths) {
                source.add(
                    None,
                    format!(
                        "\"{}\" and \"{}\" have one name, so that every run would count twice",
                        table.display(),
                        copy.display()
                    ),
                    Some("name the one to read in a [[recording]] table".to_owned()),
                );
            }
            recordings::found(folder, paths)
        }
        Err(error) => {
            source.add(None, format!("the folder cannot be searched: {error}"), None);
            Vec::new()
        }
    }
}

/// Tables of numbers say nothing about their channels; MCAP recordings of our own do.
fn check_columns(root: &Section<'_>, columns: Option<&Columns>, recordings: &[Recording]) {
    let table = recordings
        .iter()
        .flat_map(|recording| &recording.files)
        .find(|(_, path)| !recordings::is_self_describing(path));
    let Some((_, path)) = table else { return };
    match columns {
        None => root.mistake(
            "columns",
            format!("[columns] is missing, and \"{}\" needs it", path.display()),
            "add [columns] with `time = { column = \"t\", unit = \"s\" }` and \
             `roll = { column = \"roll\", unit = \"deg\" }`, each header as in the file",
        ),
        Some(columns) if columns.time.is_none() && columns.sample_rate_hz.is_none() => {
            let every_channel_has_its_own =
                columns.channels.iter().all(|channel| channel.time.is_some());
            if !every_channel_has_its_own && !root.holds_below("columns", "time") {
                root.mistake(
                    "columns",
                    format!("[columns] names no time, and \"{}\" needs it", path.display()),
                    "add `time = { column = \"t\", unit = \"s\" }`, or `sample_rate_hz = 100.0` \
                     for recordings without time stamps",
                );
            }
        }
        Some(_) => {}
    }
}

fn check_exciter(root: &Section<'_>, columns: &Columns) {
    let force = columns.channels.iter().any(|channel| channel.quantity == Quantity::Force);
    if force && !root.holds("exciter") {
        root.mistake_below(
            "columns",
            "force",
            "a force is recorded, but no [exciter] says how it becomes a moment".to_owned(),
            "add [exciter] with `moment_arm_m = ...`, or drop `force` from [columns] to use \
             the decays alone",
        );
    }
}

fn folder_name(folder: &Path) -> String {
    let resolved = folder.canonicalize();
    let folder = resolved.as_deref().unwrap_or(folder);
    folder.file_name().map_or_else(String::new, |name| name.to_string_lossy().into_owned())
}

fn unreadable(folder: &Path, error: &std::io::Error) -> Mistake {
    let hint = if folder.is_file() {
        "name the folder that holds campaign.toml, not a file".to_owned()
    } else if folder.is_dir() {
        "write a campaign.toml in that folder, or let `rolltank demo` make an example".to_owned()
    } else {
        format!("there is no folder \"{}\"", folder.display())
    };
    Mistake {
        file: folder.join(FILE_NAME).display().to_string(),
        line: None,
        message: format!("cannot be read: {}", error.to_string().to_lowercase()),
        hint: Some(hint),
    }
}

fn not_utf8(folder: &Path, error: &FromUtf8Error) -> Mistake {
    let before = &error.as_bytes()[..error.utf8_error().valid_up_to()];
    Mistake {
        file: folder.join(FILE_NAME).display().to_string(),
        line: Some(before.split(|byte| *byte == b'\n').count()),
        message: "a letter is not encoded in UTF-8".to_owned(),
        hint: Some("save the file as UTF-8, which an umlaut or a degree sign needs".to_owned()),
    }
}
