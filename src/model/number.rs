//! Numbers that an effect's equation is written in: plain ones, and ones that know their slopes.

use std::array;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// Slopes that a [`Sloped`] number carries.
pub const N_SLOPES: usize = 12;

/// What the slopes of an equation's inputs count from; the parameters come last.
pub mod slope {
    /// Roll.
    pub const ROLL: usize = 0;
    /// Roll rate.
    pub const RATE: usize = 1;
    /// Roll acceleration; of a reading, where no effect looks at both, the true moment.
    pub const ACCELERATION: usize = 2;
    /// Two states of an effect that remembers.
    pub const REMEMBERED: usize = 3;
    /// Natural frequency and linear damping of the base equation.
    pub const BASE: usize = 5;
    /// First parameter.
    pub const PARAMETER: usize = 7;
}

/// Most parameters of one set of an effect, strengths and shapes together.
pub const MOST_PARAMETERS: usize = N_SLOPES - slope::PARAMETER;

/// A number of an equation.
pub trait Number:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Div<Output = Self>
    + Neg<Output = Self>
    + Add<f64, Output = Self>
    + Sub<f64, Output = Self>
    + Mul<f64, Output = Self>
    + Div<f64, Output = Self>
    + From<f64>
{
    /// The number itself.
    fn value(self) -> f64;

    /// A function of the number, given its value and its derivative there.
    #[must_use]
    fn chain(self, value: f64, derivative: f64) -> Self;

    /// Whole power.
    #[must_use]
    fn powi(self, power: i32) -> Self {
        let x = self.value();
        let below = x.powi(power - 1);
        self.chain(below * x, f64::from(power) * below)
    }

    /// Power of a positive number.
    #[must_use]
    fn powf(self, power: Self) -> Self {
        let (x, p) = (self.value(), power.value());
        let value = x.powf(p);
        self.chain(value, p * value / x) + power.chain(0.0, value * x.ln())
    }

    /// Exponential.
    #[must_use]
    fn exp(self) -> Self {
        let value = self.value().exp();
        self.chain(value, value)
    }

    /// Sine and cosine.
    fn sin_cos(self) -> (Self, Self) {
        let (sin, cos) = self.value().sin_cos();
        (self.chain(sin, cos), self.chain(cos, -sin))
    }

    /// Hyperbolic tangent.
    #[must_use]
    fn tanh(self) -> Self {
        let value = self.value().tanh();
        self.chain(value, 1.0 - value * value)
    }

    /// Size.
    #[must_use]
    fn abs(self) -> Self {
        self.chain(self.value().abs(), self.value().signum())
    }

    /// The larger one.
    #[must_use]
    fn max(self, other: Self) -> Self {
        if self.value() < other.value() { other } else { self }
    }

    /// The smaller one.
    #[must_use]
    fn min(self, other: Self) -> Self {
        if self.value() > other.value() { other } else { self }
    }
}

impl Number for f64 {
    fn value(self) -> f64 {
        self
    }

    fn chain(self, value: f64, _: f64) -> Self {
        value
    }

    fn powf(self, power: Self) -> Self {
        f64::powf(self, power)
    }
}

/// A number with its slopes along some directions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sloped {
    /// The number itself.
    pub value: f64,
    /// Its slopes.
    pub slopes: [f64; N_SLOPES],
}

impl Sloped {
    /// An input: it changes with itself alone.
    pub fn input(value: f64, place: usize) -> Self {
        let mut slopes = [0.0; N_SLOPES];
        slopes[place] = 1.0;
        Self { value, slopes }
    }

    /// A function of two numbers, given its value and its derivatives there.
    fn combined(self, value: f64, of_self: f64, other: Self, of_other: f64) -> Self {
        let slopes = array::from_fn(|k| of_self * self.slopes[k] + of_other * other.slopes[k]);
        Self { value, slopes }
    }
}

impl From<f64> for Sloped {
    fn from(value: f64) -> Self {
        Self { value, slopes: [0.0; N_SLOPES] }
    }
}

impl Number for Sloped {
    fn value(self) -> f64 {
        self.value
    }

    fn chain(self, value: f64, derivative: f64) -> Self {
        Self { value, slopes: self.slopes.map(|s| derivative * s) }
    }
}

impl Add for Sloped {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        let slopes = array::from_fn(|k| self.slopes[k] + other.slopes[k]);
        Self { value: self.value + other.value, slopes }
    }
}

impl Sub for Sloped {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        let slopes = array::from_fn(|k| self.slopes[k] - other.slopes[k]);
        Self { value: self.value - other.value, slopes }
    }
}

impl Mul for Sloped {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        self.combined(self.value * other.value, other.value, other, self.value)
    }
}

impl Div for Sloped {
    type Output = Self;

    fn div(self, other: Self) -> Self {
        let (value, of_self) = (self.value / other.value, other.value.recip());
        self.combined(value, of_self, other, -value * of_self)
    }
}

impl Neg for Sloped {
    type Output = Self;

    fn neg(self) -> Self {
        self.chain(-self.value, -1.0)
    }
}

impl Add<f64> for Sloped {
    type Output = Self;

    fn add(self, other: f64) -> Self {
        Self { value: self.value + other, ..self }
    }
}

impl Sub<f64> for Sloped {
    type Output = Self;

    fn sub(self, other: f64) -> Self {
        Self { value: self.value - other, ..self }
    }
}

impl Mul<f64> for Sloped {
    type Output = Self;

    fn mul(self, other: f64) -> Self {
        self.chain(self.value * other, other)
    }
}

impl Div<f64> for Sloped {
    type Output = Self;

    fn div(self, other: f64) -> Self {
        self.chain(self.value / other, other.recip())
    }
}
