//! The roll model before anything is hidden in it.
//!
//! `(I+dI) phi'' + B0 (1 + kappa Fr^2) phi' + B3 phi'^3 + K phi = M`, with the numbers of the
//! paper's model (Han and Kinoshita 2012, doi:10.1155/2012/769385, Table 2; speed law by least
//! squares with `B0` held at the row of Fr 0).

use super::draw::Draw;

/// Standard gravity of the campaign file [m/s2].
pub(crate) const GRAVITY_M_S2: f64 = 9.81;
/// Length between perpendiculars [m].
pub(crate) const LENGTH_PP_M: f64 = 2.5;
/// Beam [m].
pub(crate) const BEAM_M: f64 = 0.387;
/// Draft [m].
pub(crate) const DRAFT_M: f64 = 0.132;
/// Displaced volume [m3].
pub(crate) const DISPLACEMENT_M3: f64 = 0.110;
/// Metacentric height [m].
pub(crate) const GM_M: f64 = 0.074;
/// Lever between rod and roll axis [m].
pub(crate) const ARM_M: f64 = 0.43;

/// Coefficients of the equation of rolling, in SI units.
#[derive(Clone, Debug)]
pub(crate) struct Base {
    /// Roll inertia with added inertia [kg m2].
    pub(crate) inertia: f64,
    /// Restoring coefficient `K` [N m/rad].
    pub(crate) restoring: f64,
    /// Linear damping at rest [N m s].
    pub(crate) b0: f64,
    /// Growth of the linear damping with Froude number squared.
    pub(crate) kappa: f64,
    /// Cubic damping [N m s3].
    pub(crate) b3: f64,
}

impl Base {
    /// The naked hull, or the one with bilge keels.
    pub(crate) fn of_hull(with_bilge_keels: bool) -> Self {
        let restoring = 1000.0 * GRAVITY_M_S2 * DISPLACEMENT_M3 * GM_M;
        // Natural frequency [rad/s], linear [1/s] and cubic [s] damping by unit inertia, kappa.
        let (natural, linear, cubic, kappa): (f64, f64, f64, f64) = if with_bilge_keels {
            (6.136, 1.2408, 0.6682, 9.7)
        } else {
            (6.905, 0.3796, 0.1436, 11.1)
        };
        let inertia = restoring / natural.powi(2);
        Self { inertia, restoring, b0: linear * inertia, kappa, b3: cubic * inertia }
    }

    /// Another model like it: a tenth either way in the damping, a fiftieth in the inertia.
    pub(crate) fn drawn(mut self, draw: &mut Draw) -> Self {
        self.b0 *= draw.between(0.9, 1.1);
        self.b3 *= draw.between(0.9, 1.1);
        self.kappa *= draw.between(0.9, 1.1);
        self.inertia *= draw.between(0.98, 1.02);
        self
    }

    /// Natural frequency at small angles [rad/s].
    pub(crate) fn natural_rad_s(&self) -> f64 {
        (self.restoring / self.inertia).sqrt()
    }

    /// Linear damping at a Froude number [N m s].
    pub(crate) fn linear(&self, froude: f64) -> f64 {
        self.b0 * (1.0 + self.kappa * froude.powi(2))
    }
}

/// Froude number of a speed [m/s].
pub(crate) fn froude(speed_m_s: f64) -> f64 {
    speed_m_s / (GRAVITY_M_S2 * LENGTH_PP_M).sqrt()
}

/// Speed [m/s] of a Froude number.
pub(crate) fn speed_m_s(froude: f64) -> f64 {
    froude * (GRAVITY_M_S2 * LENGTH_PP_M).sqrt()
}
