//! The model, the water it floats in, and the numbers that follow from both.

/// Particulars of the model, model scale.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hull {
    /// Length between perpendiculars `L` [m].
    pub length_pp_m: f64,
    /// Beam `B` [m].
    pub beam_m: f64,
    /// Draft `d` [m].
    pub draft_m: f64,
    /// Displaced volume [m3].
    pub displacement_m3: f64,
    /// Transverse metacentric height `GM` [m].
    pub gm_m: f64,
}

/// The water in the tank.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Water {
    /// Density `rho` [kg/m3].
    pub density_kg_m3: f64,
    /// Gravity `g` [m/s2].
    pub gravity_m_s2: f64,
}

impl Default for Water {
    fn default() -> Self {
        Self { density_kg_m3: 1000.0, gravity_m_s2: 9.81 }
    }
}

impl Hull {
    /// Restoring coefficient `K = rho g V GM` [N m/rad] of (2.1) at small angles.
    pub fn restoring_n_m_per_rad(&self, water: &Water) -> f64 {
        water.density_kg_m3 * water.gravity_m_s2 * self.displacement_m3 * self.gm_m
    }

    /// Froude number `Fr = V / sqrt(g L)` [-] on the length between perpendiculars.
    pub fn froude(&self, speed_m_s: f64, water: &Water) -> f64 {
        speed_m_s / (water.gravity_m_s2 * self.length_pp_m).sqrt()
    }

    /// Carriage speed [m/s] at a Froude number [-].
    pub fn speed_m_s(&self, froude: f64, water: &Water) -> f64 {
        froude * (water.gravity_m_s2 * self.length_pp_m).sqrt()
    }

    /// Total inertia `I + dI = K / w^2` [kg m2] of a model whose natural frequency is `w` [rad/s].
    pub fn inertia_kg_m2(&self, water: &Water, natural_frequency_rad_s: f64) -> f64 {
        self.restoring_n_m_per_rad(water) / natural_frequency_rad_s.powi(2)
    }

    /// Non-dimensional equivalent damping `B44hat = B44 / (rho V B^2) sqrt(B / 2g)` [-] of
    /// `B44` [N m s], ITTC 7.5-02-07-04.5.
    pub fn b44_hat(&self, water: &Water, b44_n_m_s: f64) -> f64 {
        b44_n_m_s / (water.density_kg_m3 * self.displacement_m3 * self.beam_m.powi(2))
            * (self.beam_m / (2.0 * water.gravity_m_s2)).sqrt()
    }
}
