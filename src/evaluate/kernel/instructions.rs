//! One binary for all processors: the hot code is compiled for each instruction set, and the widest
//! one that the processor supports is selected at run time.

use multiversion::multiversion;
use multiversion::target::match_target;
use std::fmt;

/// The vector instructions that the kernel uses.
///
/// All give the same bits; [`InstructionSet::detect`] finds the fastest available one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum InstructionSet {
    /// AVX-512 of Ice Lake and later: sixteen points at once.
    Avx512,
    /// AVX2: eight points at once.
    Avx2,
    /// The baseline of the target, SSE2 on x86-64: four points at once.
    Baseline,
}

impl InstructionSet {
    /// Every instruction set, the widest first.
    pub const ALL: [Self; 3] = [Self::Avx512, Self::Avx2, Self::Baseline];

    /// Whether the processor has it.
    #[must_use]
    pub fn is_available(self) -> bool {
        match self {
            #[cfg(target_arch = "x86_64")]
            Self::Avx512 => {
                is_x86_feature_detected!("avx512bw")
                    && is_x86_feature_detected!("avx512dq")
                    && is_x86_feature_detected!("avx512vl")
                    && is_x86_feature_detected!("avx512vbmi2")
            }
            #[cfg(target_arch = "x86_64")]
            Self::Avx2 => is_x86_feature_detected!("avx2") && is_x86_feature_detected!("bmi2"),
            #[cfg(not(target_arch = "x86_64"))]
            Self::Avx512 | Self::Avx2 => false,
            Self::Baseline => true,
        }
    }

    /// The widest one that the processor supports.
    #[must_use]
    pub fn detect() -> Self {
        Self::ALL
            .into_iter()
            .find(|set| set.is_available())
            .unwrap_or(Self::Baseline)
    }

    /// Does a piece of work with these instructions, or with the baseline if they are missing.
    pub(super) fn run<W: Work>(self, work: W) -> W::Output {
        match self {
            Self::Avx512 => avx512(work),
            Self::Avx2 => avx2(work),
            Self::Baseline => baseline(work),
        }
    }
}

impl fmt::Display for InstructionSet {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.pad(match self {
            Self::Avx512 => "AVX-512",
            Self::Avx2 => "AVX2",
            Self::Baseline => "baseline",
        })
    }
}

/// Work whose `run` is inlined into the code for each instruction set; everything it calls must be
/// `#[inline(always)]` to be compiled for that set too.
pub(super) trait Work {
    type Output;

    fn run(self) -> Self::Output;
}

#[multiversion(targets("x86_64+avx512f+avx512bw+avx512dq+avx512vl+bmi1+bmi2+lzcnt"))]
fn avx512<W: Work>(work: W) -> W::Output {
    match_target! {
        "x86_64+avx512f+avx512bw+avx512dq+avx512vl+bmi1+bmi2+lzcnt" => work.run(),
        _ => baseline(work),
    }
}

#[multiversion(targets("x86_64+avx2+bmi1+bmi2+lzcnt"))]
fn avx2<W: Work>(work: W) -> W::Output {
    match_target! {
        "x86_64+avx2+bmi1+bmi2+lzcnt" => work.run(),
        _ => baseline(work),
    }
}

/// Apart from the two above, which would otherwise hold a copy of it each for processors without their instructions.
#[inline(never)]
fn baseline<W: Work>(work: W) -> W::Output {
    work.run()
}
