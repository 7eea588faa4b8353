//! The damping of one run in the units in which the field writes it.

use std::f64::consts::PI;

use crate::campaign::Campaign;
use crate::inverse::estimate::Estimate;
use crate::inverse::identification::{DampingFit, EquivalentDamping};
use crate::results::IdentifiedRun;
use crate::roll::damping::{critical_ratio, cubic_weight};

/// Turns coefficients per unit inertia into moments and ratios for one run.
#[derive(Debug, Clone, Copy)]
pub(crate) struct FieldUnits<'a> {
    campaign: &'a Campaign,
    run: &'a IdentifiedRun,
}

impl<'a> FieldUnits<'a> {
    /// The conversions of one run of a campaign.
    pub(crate) fn new(campaign: &'a Campaign, run: &'a IdentifiedRun) -> Self {
        Self { campaign, run }
    }

    /// Total inertia `I + dI` [kg m2]: from (4.5) in a forced run, else `K / w^2`.
    pub(crate) fn inertia_kg_m2(&self) -> Estimate {
        let identification = &self.run.identification;
        identification.inertia_kg_m2.unwrap_or_else(|| {
            let w = identification.natural_frequency_rad_s;
            let (hull, water) = (&self.campaign.hull, &self.campaign.water);
            let inertia = hull.inertia_kg_m2(water, w.mean);
            Estimate {
                mean: inertia,
                sd: 2.0 * inertia * w.sd / w.mean,
                // A higher frequency is a smaller inertia.
                lo95: hull.inertia_kg_m2(water, w.hi95),
                hi95: hull.inertia_kg_m2(water, w.lo95),
            }
        })
    }

    /// Inertia over mass times beam squared [-], the ordinate of Fig. 15.
    pub(crate) fn inertia_over_mass_beam_squared(&self) -> Estimate {
        let (hull, water) = (&self.campaign.hull, &self.campaign.water);
        let mass_kg = water.density_kg_m3 * hull.displacement_m3;
        self.inertia_kg_m2().scaled(1.0 / (mass_kg * hull.beam_m.powi(2)))
    }

    /// Damping moment coefficient `B = b (I + dI)`: [N m s] of `b` [1/s], [N m s3] of `b3` [s].
    pub(crate) fn moment(&self, per_inertia: Estimate) -> Estimate {
        product(per_inertia, self.inertia_kg_m2())
    }

    /// Equivalent damping of a forced run at its own amplitude, from the work per cycle [1/s].
    pub(crate) fn work_damping_per_s(&self) -> Option<Estimate> {
        let forced = self.run.identification.forced.as_ref()?;
        // The inertia is known a hundred times better than the work.
        Some(forced.work_damping_n_m_s.scaled(1.0 / self.inertia_kg_m2().mean))
    }

    /// `B44hat = B / (rho V B^2) sqrt(B / 2g)` [-] of `b` [1/s], ITTC 7.5-02-07-04.5.
    pub(crate) fn b44_hat(&self, per_inertia: Estimate) -> Estimate {
        self.moment(per_inertia).scaled(self.b44_hat_per_n_m_s())
    }

    /// `B44hat` [-] of one N m s.
    pub(crate) fn b44_hat_per_n_m_s(&self) -> f64 {
        self.campaign.hull.b44_hat(&self.campaign.water, 1.0)
    }

    /// Ratio to critical damping `zeta = b_eq / (2 w)` [-] of `b_eq` [1/s].
    pub(crate) fn damping_ratio(&self, per_inertia: Estimate) -> Estimate {
        let w = self.run.identification.natural_frequency_rad_s.mean;
        per_inertia.scaled(critical_ratio(1.0, w))
    }

    /// Relative decrement per half cycle `dphi / phi_m = pi b_eq / (2 w)` [-] of `b_eq` [1/s].
    pub(crate) fn half_cycle_decrement(&self, per_inertia: Estimate) -> Estimate {
        self.damping_ratio(per_inertia).scaled(PI)
    }

    /// Bertin's `N` [1/deg] of `b_eq` [1/s] at an amplitude: `dphi = N phi_m^2` per half cycle, so
    /// that `N = pi b_eq / (2 w phi_m)`.
    pub(crate) fn bertin_n_per_deg(&self, per_inertia: Estimate, amplitude_deg: f64) -> Estimate {
        self.half_cycle_decrement(per_inertia).scaled(1.0 / amplitude_deg)
    }

    /// Equivalent damping at the amplitude at which runs are compared, if the run gives one.
    pub(crate) fn at_comparison(&self) -> Option<&'a EquivalentDamping> {
        self.run.at_comparison()
    }
}

/// Mean and standard deviation [1/s] of `b_eq = b1 + 3/4 (w A)^2 b3`, equal energy per cycle.
pub(crate) fn fitted_equivalent_damping(
    fit: &DampingFit,
    frequency_rad_s: f64,
    amplitude_rad: f64,
) -> Estimate {
    fit.combination(1.0, cubic_weight(frequency_rad_s, amplitude_rad))
}

/// Mean and standard deviation [rad/s2] of `b1 phi' + b3 phi'^3`.
pub(crate) fn fitted_damping(fit: &DampingFit, roll_rate_rad_per_s: f64) -> Estimate {
    fit.combination(roll_rate_rad_per_s, roll_rate_rad_per_s.powi(3))
}

/// The product of two independent quantities; the interval keeps the skew of the first.
fn product(quantity: Estimate, factor: Estimate) -> Estimate {
    let scaled = quantity.scaled(factor.mean);
    let sd = scaled.sd.hypot(quantity.mean * factor.sd);
    let widening = if scaled.sd > 0.0 { sd / scaled.sd } else { 1.0 };
    Estimate {
        mean: scaled.mean,
        sd,
        lo95: scaled.mean - widening * (scaled.mean - scaled.lo95),
        hi95: scaled.mean + widening * (scaled.hi95 - scaled.mean),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn fit(correlation: f64) -> DampingFit {
        DampingFit {
            b1_per_s: Estimate::normal(0.38, 0.02),
            b3_s: Estimate::normal(0.14, 0.04),
            correlation,
        }
    }

    #[test]
    fn the_equivalent_damping_of_the_cubic_law_loses_the_same_energy_per_cycle() {
        let (w, amplitude, n) = (6.9_f64, 0.15, 1000);
        let step = 2.0 * PI / f64::from(n);
        // Work of b1 phi' + b3 phi'^3 on phi' over one cycle, by the rectangle rule, which is
        // exact to rounding for a trigonometric polynomial.
        let work: f64 = (0..n)
            .map(|k| w * amplitude * (step * f64::from(k)).sin())
            .map(|rate| (0.38 * rate + 0.14 * rate.powi(3)) * rate * step / w)
            .sum();
        let equivalent = work / (PI * w * amplitude * amplitude);
        let fitted = fitted_equivalent_damping(&fit(-0.8), w, amplitude);
        assert!((fitted.mean - equivalent).abs() < 1e-12);
    }

    #[test]
    fn coefficients_that_trade_against_each_other_leave_their_sum_well_known() {
        let apart = fitted_equivalent_damping(&fit(0.0), 6.9, 0.1);
        let traded = fitted_equivalent_damping(&fit(-0.9), 6.9, 0.1);
        assert!(traded.sd < apart.sd);
    }

    #[test]
    fn an_unsure_inertia_widens_the_moment() {
        let sharp = product(Estimate::normal(0.38, 0.01), Estimate::normal(1.7, 0.0));
        let wide = product(Estimate::normal(0.38, 0.01), Estimate::normal(1.7, 0.1));
        assert!((sharp.sd - 0.017).abs() < 1e-12);
        assert!(wide.lo95 < sharp.lo95 && wide.hi95 > sharp.hi95);
    }
}
