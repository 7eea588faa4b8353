//! Declared speeds against what the carriage can do.

use super::{Campaign, FILE_NAME, Mistake};

impl Campaign {
    /// The declared speeds that the carriage cannot do, each with the arithmetic.
    ///
    /// They do not keep a campaign from being read: the recording stays, its runs are refused.
    pub fn unreachable_speeds(&self) -> Vec<Mistake> {
        let Some(limit_m_s) = self.tank.carriage_max_speed_m_s else { return Vec::new() };
        let froude = |speed_m_s| self.hull.froude(speed_m_s, &self.water);
        let too_fast = |what: String, speed_m_s: f64, file: &str, line: Option<usize>| {
            (speed_m_s > limit_m_s).then(|| Mistake {
                file: self.folder.join(file).display().to_string(),
                line,
                message: format!(
                    "{what}: Fr {:.2} needs {speed_m_s:.2} m/s, the carriage does \
                     {limit_m_s:.2} m/s (Fr {:.3})",
                    froude(speed_m_s),
                    froude(limit_m_s),
                ),
                hint: Some("mend the speed there or `carriage_max_speed_m_s` of [tank]".to_owned()),
            })
        };
        let recorded = self.recordings.iter().filter_map(|recording| {
            let what = format!("recording \"{}\"", recording.name);
            too_fast(what, recording.speed_m_s?, FILE_NAME, recording.line)
        });
        let planned = self.plan.rows.iter().filter_map(|row| {
            let speed_m_s = self.hull.speed_m_s(row.froude, &self.water);
            let what = format!("plan for \"{}\"", row.condition);
            too_fast(what, speed_m_s, &self.plan.file, row.line)
        });
        recorded.chain(planned).collect()
    }
}
