//! scratch
use rolltank::inverse::{decay_fit, half_cycles::*, moment_history::*, record::Record};
use rolltank::roll::equation::Decay;
use rolltank::run::Series;
fn main() {
    for (f, a, b) in [
        ("model_test_21338", 8.1, 190.0),
        ("model_test_21340", 23.13, 75.5),
        ("model_test_21338", 8.1, 70.0),
    ] {
        let text =
            std::fs::read_to_string(format!("/work/shared/measured/kvlcc2/{f}.csv")).unwrap();
        let mut s = Series::default();
        for l in text.lines().skip(1) {
            let c: Vec<f64> = l.split(',').map(|x| x.parse().unwrap()).collect();
            if c[0] >= a && c[0] <= b {
                s.time_s.push(c[0]);
                s.value.push(c[4]);
            }
        }
        let t0 = std::time::Instant::now();
        let r = Record::new(&s).unwrap();
        println!(
            "{f} n={} rough w {} step {}",
            r.time_s.len(),
            r.rough_frequency_rad_s,
            r.time_s[1]
        );
        let start = Decay {
            initial_roll_rad: r.roll_rad[0],
            initial_roll_rate_rad_per_s: 0.0,
            natural_frequency_rad_s: r.rough_frequency_rad_s,
            b1_per_s: 0.03,
            b3_s: 0.1,
            restoring_cubic_per_rad2: 0.0,
        };
        let p = decay_fit::fit(&r, start, 0.0).unwrap();
        println!("fit {:?}", t0.elapsed());
        println!("linear {:?}\ncubic {:?}", p.linear, p.cubic);
        for (n, i) in [("w", 2), ("b1", 3), ("b3", 4), ("k3", 5), ("off", 6)] {
            println!("{n} {:?}", rolltank::inverse::mixture::estimate(&p.unknown(i)));
        }
        let mut c = [0.0; 7];
        c[3] = 135.6;
        c[4] = 135.6 * 0.75 * (2.465f64 * 5f64.to_radians()).powi(2);
        println!("Beq5 {:?}", rolltank::inverse::mixture::estimate(&p.combination(&c)));
        for s in &p.solutions {
            println!(
                "  w {:.3} misfit {:.4} cubic {} noise {:.4} deg b1 {:.5} b3 {:.4}",
                s.weight,
                s.probability_of_misfit,
                s.cubic_restoring,
                s.noise_sd_rad.to_degrees(),
                s.mean[3],
                s.mean[4]
            );
        }
        let w = 2.4627;
        let tau = r.scaled_time(w);
        let t0 = std::time::Instant::now();
        let st = state_posterior(&tau, &r.roll_rad, 0.0);
        println!(
            "posterior {:?} order {} noise {} ev {} nodes {:?}",
            t0.elapsed(),
            st.order,
            st.states.noise_sd_rad.to_degrees(),
            st.states.log_evidence,
            st.states.nodes.iter().map(|n| (n.log_intensity, n.log_weight)).collect::<Vec<_>>()
        );
        let h = half_cycles(
            r.origin_s,
            &r.time_s,
            &st.states,
            &Restoring {
                natural_frequency_rad_s: p.cubic.0.natural_frequency_rad_s,
                cubic_per_rad2: p.cubic.0.restoring_cubic_per_rad2,
                zero_rad: p.cubic.1,
            },
        );
        for x in h.iter().step_by(4) {
            println!(
                "{:.2} A {:.3} w {:.4} Beq {:.3} ± {:.3}",
                x.time_s,
                x.amplitude_rad.to_degrees(),
                x.frequency_rad_s,
                x.equivalent_damping_per_s.mean * 135.6,
                x.equivalent_damping_per_s.sd * 135.6
            );
        }
        for a in [2.0f64, 3.0, 5.0, 8.0] {
            println!(
                "local {a}: {:?}",
                local_damping(&h, a.to_radians(), p.cubic.0.b3_s).map(|e| e.scaled(135.6))
            );
        }
    }
}
