//! Whether the carriage could have made the printed forced run.

use super::Erratum;
use crate::hull::Water;
use crate::tank::paper;

/// The speed of the printed example [m/s] and the carriage's largest Froude number [-].
fn limits() -> (f64, f64) {
    let water = Water::default();
    let needed_m_s = paper::HULL.speed_m_s(paper::EXAMPLE_FROUDE, &water);
    (needed_m_s, paper::HULL.froude(paper::BASIN.carriage_max_speed_m_s, &water))
}

/// The forced run at a speed that the carriage does not have.
pub(super) fn erratum() -> Erratum {
    let (needed_m_s, froude_max) = limits();
    Erratum {
        title: "The forced run of Sec. 4.2 cannot have been towed".to_owned(),
        printed: format!("Sec. 4.2, Fig. 16: Fr = {:.1}", paper::EXAMPLE_FROUDE),
        computed: format!(
            "Fr {:.1} needs {needed_m_s:.2} m/s; the carriage does {:.1} m/s, which is Fr \
             {froude_max:.3}",
            paper::EXAMPLE_FROUDE,
            paper::BASIN.carriage_max_speed_m_s,
        ),
        how: format!(
            "V = Fr sqrt(g L) with L = {} m from Table 1, against the speed in Sec. 3",
            paper::HULL.length_pp_m
        ),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn froude_number_one_needs_more_than_twice_the_speed_of_the_carriage() {
        let (needed_m_s, froude_max) = limits();
        assert!((needed_m_s - 4.952).abs() < 5e-4, "{needed_m_s}");
        assert!((froude_max - 0.4039).abs() < 5e-5, "{froude_max}");
    }
}
