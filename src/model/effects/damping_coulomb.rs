//! Coulomb friction of the bearings, the same at every rate.

use crate::model::effect::{Acts, Effect, Instant, Law, Layer, Parameter, Scope, any_run, each};
use crate::model::number::Number;

/// The effect.
pub(super) const EFFECT: Effect = Effect {
    id: "damping.coulomb",
    layer: Layer::Damping,
    equation: "f tanh(phi'/ve), f = Mf/(I+dI)",
    strengths: &[Parameter::new("f", "rad/s2", 0.01, [0.0, 0.1])],
    shapes: &[Parameter::new("ve", "rad/s", 0.01, [0.002, 0.1])],
    nodes: |_| each(&[0.01, 0.04]),
    scope: Scope::Campaign,
    shows: any_run,
    acts: Acts::Moment(Law { plain: law, sloped: law }),
    always_equivalent: &[],
    reference: "Lelas & Pezer 2025; Pennestri et al. 2016",
};

fn law<N: Number>(i: &Instant<'_, N>, p: &[N]) -> N {
    -p[0] * (i.rate_rad_per_s / p[1]).tanh()
}
