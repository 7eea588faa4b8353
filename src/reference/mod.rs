//! The paper's figures, computed again from its own tables: what is misprinted, what follows.
//!
//! Every number in [`errata`] comes out of a calculation made when it is called; what the paper
//! prints is quoted only where it is compared with.

mod carriage;
mod columns;
mod hyperpriors;
mod natural_frequency;
mod prior;
mod resolution;
mod sign;
mod speed_law;

pub use prior::{HyperpriorCheck, hyperprior_erratum};

/// One place where the paper, as printed, does not hold.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Erratum {
    /// What it is about.
    pub title: String,
    /// What the paper prints, with its place.
    pub printed: String,
    /// What the calculation gives, with its numbers and units.
    pub computed: String,
    /// How it was calculated.
    pub how: String,
}

/// Every erratum, computed from the paper's own numbers, in the order of its sections.
pub fn errata() -> Vec<Erratum> {
    vec![
        sign::erratum(),
        prior::rank_erratum(),
        prior::scale_erratum(),
        hyperprior_erratum(&hyperpriors::check()),
        natural_frequency::bin_erratum(),
        natural_frequency::inertia_erratum(),
        natural_frequency::loop_erratum(),
        columns::erratum(),
        speed_law::kappa_erratum(),
        speed_law::comparison_erratum(),
        resolution::erratum(),
        carriage::erratum(),
    ]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_erratum_says_what_is_printed_what_is_computed_and_how() {
        let errata = errata();
        for erratum in &errata {
            for text in [&erratum.title, &erratum.printed, &erratum.computed, &erratum.how] {
                assert!(!text.is_empty() && !text.contains("NaN"), "{erratum:?}");
            }
            assert!(erratum.computed.chars().any(|c| c.is_ascii_digit()), "{erratum:?}");
        }
        let mut titles: Vec<_> = errata.iter().map(|e| &e.title).collect();
        titles.dedup();
        assert_eq!(titles.len(), errata.len());
    }
}
