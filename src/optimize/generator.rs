//! The random numbers of every strategy: `ChaCha8` with the run's seed as its key
//! and the step's number as its stream.
//!
//! Each step draws from its own stream, so a checkpoint needs no generator
//! state. The few distributions needed are written here because those of a
//! general library may change their values between releases, while a seed must
//! mean the same run in every release unless stated otherwise.

use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

/// A deterministic generator, the same on every platform.
pub(crate) struct Generator(ChaCha8Rng);

impl Generator {
    /// The generator of one step of one run.
    pub(crate) fn new(seed: u64, stream: u64) -> Self {
        let mut key = [0; 32];
        key[..8].copy_from_slice(&seed.to_le_bytes());
        let mut generator = ChaCha8Rng::from_seed(key);
        generator.set_stream(stream);
        Self(generator)
    }

    /// Uniform in [0, 1), a multiple of 2^-53.
    pub(crate) fn unit(&mut self) -> f64 {
        const STEP: f64 = 1.0 / (1_u64 << 53) as f64;
        (self.0.next_u64() >> 11) as f64 * STEP
    }

    /// Uniform in [lo, hi).
    pub(crate) fn between(&mut self, lo: f64, hi: f64) -> f64 {
        lo + (hi - lo) * self.unit()
    }

    /// True with the given probability: never for 0, always for 1.
    pub(crate) fn chance(&mut self, probability: f64) -> bool {
        self.unit() < probability
    }

    /// Uniform among 0..count, 0 for an empty range.
    ///
    /// A multiplication and a shift; its bias of at most count/2^64 is far below
    /// what any run could notice.
    pub(crate) fn below(&mut self, count: usize) -> usize {
        let product = u128::from(self.0.next_u64()) * count as u128;
        (product >> 64) as usize
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn streams_and_seeds_differ_and_repeat() {
        let draw = |seed, stream| Generator::new(seed, stream).unit();
        assert_eq!(draw(1, 2), draw(1, 2));
        assert_ne!(draw(1, 2), draw(1, 3));
        assert_ne!(draw(1, 2), draw(2, 2));
    }

    #[test]
    fn uniform_draws_have_the_moments_of_a_uniform_law() {
        let mut generator = Generator::new(7, 0);
        let count = 100_000;
        let draws: Vec<f64> = (0..count).map(|_| generator.between(-1.0, 3.0)).collect();
        let mean = draws.iter().sum::<f64>() / f64::from(count);
        let variance = draws.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / f64::from(count);
        // Five standard errors: sd/sqrt(n) = 0.0037 of the mean, 0.0038 of the variance.
        assert!((mean - 1.0).abs() < 0.02, "{mean}");
        assert!((variance - 16.0 / 12.0).abs() < 0.02, "{variance}");
        assert!(draws.iter().all(|x| (-1.0..3.0).contains(x)));
    }

    #[test]
    fn every_index_comes_equally_often() {
        let mut generator = Generator::new(7, 1);
        let mut counts = [0_i32; 7];
        for _ in 0..70_000 {
            counts[generator.below(7)] += 1;
        }
        // Five standard deviations of a binomial count: 5 sqrt(70000/7 * 6/7) = 463.
        assert!(
            counts.iter().all(|c| (c - 10_000).abs() < 463),
            "{counts:?}"
        );
        assert_eq!(generator.below(0), 0);
        assert_eq!(generator.below(1), 0);
    }

    #[test]
    fn chance_is_exact_at_its_ends() {
        let mut generator = Generator::new(7, 2);
        assert!((0..1000).all(|_| generator.chance(1.0)));
        assert!(!(0..1000).any(|_| generator.chance(0.0)));
    }
}
