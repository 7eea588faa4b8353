//! The course that a rod imposes: a mean, three harmonics, a frequency.

/// Harmonics of the imposed course.
pub const N_HARMONICS: usize = 3;
/// Numbers of a course: mean, pairs of each harmonic, frequency.
pub const N_COURSE: usize = 2 + 2 * N_HARMONICS;

/// `phi = c0 + sum_h a_h cos(h w t) + b_h sin(h w t)`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Course {
    /// `c0`, then `a_h, b_h` with the fundamental first, then `w` [rad/s].
    pub numbers: [f64; N_COURSE],
}

impl Course {
    /// Frequency [rad/s].
    pub fn frequency_rad_s(&self) -> f64 {
        self.numbers[N_COURSE - 1]
    }

    /// Roll, rate and acceleration at a time [s].
    pub fn at(&self, time_s: f64) -> [f64; 3] {
        let w = self.frequency_rad_s();
        let (sin, cos) = (w * time_s).sin_cos();
        let (mut s, mut c) = (sin, cos);
        let mut motion = [self.numbers[0], 0.0, 0.0];
        for h in 0..N_HARMONICS {
            let hw = (h + 1) as f64 * w;
            let (a, b) = (self.numbers[1 + 2 * h], self.numbers[2 + 2 * h]);
            let value = a * c + b * s;
            motion[0] += value;
            motion[1] += hw * (b * c - a * s);
            motion[2] -= hw * hw * value;
            (s, c) = (s * cos + c * sin, c * cos - s * sin);
        }
        motion
    }

    /// Roll, rate and acceleration from what each number does to them: they are linear in all but
    /// the frequency.
    pub(super) fn motion(&self, changes: &[[f64; 3]; N_COURSE]) -> [f64; 3] {
        let mut motion = [0.0; 3];
        for (number, change) in self.numbers.iter().zip(&changes[..N_COURSE - 1]) {
            motion.iter_mut().zip(change).for_each(|(motion, change)| *motion += number * change);
        }
        motion
    }

    /// What each number does to roll, rate and acceleration at a time [s].
    pub(super) fn changes(&self, time_s: f64) -> [[f64; 3]; N_COURSE] {
        let w = self.frequency_rad_s();
        let (sin, cos) = (w * time_s).sin_cos();
        let (mut s, mut c) = (sin, cos);
        let mut changes = [[0.0; 3]; N_COURSE];
        changes[0][0] = 1.0;
        for h in 0..N_HARMONICS {
            let n = (h + 1) as f64;
            let hw = n * w;
            let (a, b) = (self.numbers[1 + 2 * h], self.numbers[2 + 2 * h]);
            let (value, slope) = (a * c + b * s, b * c - a * s);
            changes[1 + 2 * h] = [c, -hw * s, -hw * hw * c];
            changes[2 + 2 * h] = [s, hw * c, -hw * hw * s];
            let nt = n * time_s;
            let of_frequency = &mut changes[N_COURSE - 1];
            of_frequency[0] += nt * slope;
            of_frequency[1] += n * slope - hw * nt * value;
            of_frequency[2] -= 2.0 * hw * n * value + hw * hw * nt * slope;
            (s, c) = (s * cos + c * sin, c * cos - s * sin);
        }
        changes
    }
}
