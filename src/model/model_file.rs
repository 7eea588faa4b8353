//! `model.toml`: the extended simulation model as other commands, and people, read it.

use std::fmt::Write;

use toml::{Table, Value};

use super::effects;

/// The law of one condition.
#[derive(Debug, Clone, PartialEq)]
pub struct ConditionModel {
    /// Name of the condition.
    pub name: String,
    /// Natural frequency [rad/s].
    pub natural_frequency_rad_s: f64,
    /// Linear damping at rest [1/s].
    pub b0_per_s: f64,
    /// Speed coefficient [-].
    pub kappa: f64,
    /// Cubic damping [s].
    pub b3_s: f64,
}

/// One effect with its sets of parameters: one for the campaign, or one a condition or run.
#[derive(Debug, Clone, PartialEq)]
pub struct EffectModel {
    /// Name of the contract.
    pub id: String,
    /// Strengths, then shapes, of every set.
    pub sets: Vec<Vec<f64>>,
}

/// The model of a campaign.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ModelFile {
    /// Laws.
    pub conditions: Vec<ConditionModel>,
    /// Effects beside them, in order of entry.
    pub effects: Vec<EffectModel>,
}

impl ModelFile {
    /// The file's text; numbers come back to the bit.
    pub fn to_toml(&self) -> String {
        let mut text = String::from(
            "# The simulation model as `rolltank diagnose --write-model` extended it.\n\
             # phi'' + b0 (1 + kappa Fr^2) phi' + b3 phi'^3 + w^2 phi = M/(I+dI) + effects\n",
        );
        for condition in &self.conditions {
            let ConditionModel { name, natural_frequency_rad_s, b0_per_s, kappa, b3_s } = condition;
            let name = Value::String(name.clone());
            // Writing to a string cannot fail.
            let _ = write!(
                text,
                "\n[[condition]]\nname = {name}\n\
                 natural_frequency_rad_s = {natural_frequency_rad_s:?}\n\
                 b0_per_s = {b0_per_s:?}\nkappa = {kappa:?}\nb3_s = {b3_s:?}\n"
            );
        }
        for effect in &self.effects {
            let known = effects::effect(&effect.id);
            let equation = known.map_or("", |known| known.equation);
            let _ = write!(text, "\n[[effect]]    # {equation}\nid = \"{}\"\n", effect.id);
            let symbols: Vec<String> = known.map_or(Vec::new(), |known| {
                (0..known.n_parameters())
                    .map(|k| format!("{} [{}]", known.parameter(k).symbol, known.parameter(k).unit))
                    .collect()
            });
            let _ = writeln!(text, "sets = [    # {}", symbols.join(", "));
            for set in &effect.sets {
                let _ = writeln!(text, "  {set:?},");
            }
            text.push_str("]\n");
        }
        text
    }

    /// Reads the text of a file.
    ///
    /// # Errors
    /// The mistake, as a sentence.
    pub fn from_toml(text: &str) -> Result<Self, String> {
        let table: Table = text.parse().map_err(|error| format!("model.toml: {error}"))?;
        let list = |key: &str| -> Vec<Table> {
            let items = table.get(key).and_then(Value::as_array);
            items.into_iter().flatten().filter_map(|item| item.as_table().cloned()).collect()
        };
        let number = |table: &Table, key: &str| {
            let value = table.get(key);
            let number = value.and_then(Value::as_float);
            number.ok_or_else(|| format!("model.toml: {key} is missing or no number"))
        };
        let text = |table: &Table, key: &str| {
            let value = table.get(key).and_then(Value::as_str);
            value.map(str::to_owned).ok_or_else(|| format!("model.toml: {key} is missing"))
        };
        let mut model = Self::default();
        for table in list("condition") {
            model.conditions.push(ConditionModel {
                name: text(&table, "name")?,
                natural_frequency_rad_s: number(&table, "natural_frequency_rad_s")?,
                b0_per_s: number(&table, "b0_per_s")?,
                kappa: number(&table, "kappa")?,
                b3_s: number(&table, "b3_s")?,
            });
        }
        for table in list("effect") {
            let id = text(&table, "id")?;
            let known = effects::effect(&id)
                .ok_or_else(|| format!("model.toml: no effect is called \"{id}\""))?;
            let sets: Vec<Vec<f64>> = table
                .get("sets")
                .and_then(Value::as_array)
                .into_iter()
                .flatten()
                .filter_map(Value::as_array)
                .map(|set| set.iter().filter_map(Value::as_float).collect())
                .collect();
            if sets.iter().any(|set| set.len() != known.n_parameters()) {
                let n = known.n_parameters();
                return Err(format!(
                    "model.toml: a set of {id} has {n} numbers; hint: `rolltank diagnose \
                     --write-model` writes the file as this program reads it"
                ));
            }
            model.effects.push(EffectModel { id, sets });
        }
        Ok(model)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_model_comes_back_to_the_bit_and_an_unknown_effect_is_refused() {
        let model = ModelFile {
            conditions: vec![ConditionModel {
                name: "bare \"hull\"".to_owned(),
                natural_frequency_rad_s: 6.905,
                b0_per_s: 0.1 + 0.2,
                kappa: 11.9,
                b3_s: 0.144,
            }],
            effects: vec![EffectModel {
                id: "tank.residual_wave".to_owned(),
                sets: vec![vec![1e-3, -2.0, 6.4, 0.01], vec![0.0, 1.0 / 3.0, 6.0, 0.0]],
            }],
        };
        let text = model.to_toml();
        assert_eq!(ModelFile::from_toml(&text), Ok(model));
        let unknown = text.replace("residual_wave", "residual_sorrow");
        assert!(ModelFile::from_toml(&unknown).unwrap_err().contains("residual_sorrow"));
    }
}
