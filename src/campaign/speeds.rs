//! Declared speeds against what the carriage can do.

use super::{Campaign, FILE_NAME, Mistake};

impl Campaign {
    /// The declared speeds that the carriage cannot do, each with the arithmetic.
    ///
    /// They do not keep a campaign from being read: the recording stays, its runs are refused.
    pub fn unreachable_speeds(&self) -> Vec<Mistake> {
        let Some(limit_m_s) = self.tank.carriage_max_speed_m_s else { return Vec::new() };
        let froude = |speed_m_s| self.hull.froude(speed_m_s, &self.water);
        self.recordings
            .iter()
            .filter_map(|recording| Some((recording, recording.speed_m_s?)))
            .filter(|(_, speed_m_s)| *speed_m_s > limit_m_s)
            .map(|(recording, speed_m_s)| Mistake {
                file: self.folder.join(FILE_NAME).display().to_string(),
                line: recording.line,
                message: format!(
                    "recording \"{}\": Fr {:.2} needs {speed_m_s:.2} m/s, the carriage does \
                     {limit_m_s:.2} m/s (Fr {:.3})",
                    recording.name,
                    froude(speed_m_s),
                    froude(limit_m_s),
                ),
                hint: Some(
                    "mend `speed_m_s` of the recording or `carriage_max_speed_m_s` of [tank]"
                        .to_owned(),
                ),
            })
            .collect()
    }
}
