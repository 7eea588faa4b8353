//! The options that every identifying command shares.

use clap::{Args, ValueEnum};

use crate::inverse::identification::Method;

/// How runs are identified.
#[derive(Debug, Clone, Copy, Args)]
pub(super) struct Identifying {
    /// How the moment history of each run is inferred
    #[arg(long, value_enum, default_value_t = MethodName::Exact)]
    method: MethodName,
    /// Seed of everything random
    #[arg(long, default_value_t = 1)]
    seed: u64,
}

#[derive(Debug, Clone, Copy, ValueEnum)]
enum MethodName {
    /// The exact posterior with scale-free hyperpriors
    Exact,
    /// The paper's Gibbs and Metropolis-Hastings sampler with its printed hyperpriors
    PaperMcmc,
}

impl Identifying {
    pub(super) fn method(self) -> Method {
        match self.method {
            MethodName::Exact => Method::Exact,
            MethodName::PaperMcmc => Method::PaperMcmc,
        }
    }

    pub(super) fn seed(self) -> u64 {
        self.seed
    }
}
