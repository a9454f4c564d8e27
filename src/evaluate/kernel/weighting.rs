//! What is the same for all observations of an evaluation, as types, so that each has loops of its own.

use std::marker::PhantomData;

/// How observations are weighted, and by how many LEO clocks they are made.
pub(super) trait Weighting {
    /// Whether by the square of the sine of the elevation.
    const BY_SINE: bool;
    /// Whether LEO satellites have several clocks.
    const SEVERAL_CLOCKS: bool = false;
    /// PDOP up to which f32 is trusted however many satellites there are.
    const SINGLE_BELOW: f32;
    /// Condition of the sums up to which it is trusted above that.
    const SINGLE_CONDITION: f32;
}

/// All alike.
pub(super) struct UnitWeights;

/// sin² of the elevation.
pub(super) struct SineWeights;

impl Weighting for UnitWeights {
    const BY_SINE: bool = false;
    const SINGLE_BELOW: f32 = 2.0;
    const SINGLE_CONDITION: f32 = 64.0;
}

impl Weighting for SineWeights {
    const BY_SINE: bool = true;
    const SINGLE_BELOW: f32 = 0.0;
    /// Found by trial ([M-26](crate::models#m-26)): the error of PDOP is at most 1.7e-6 in 999 of 1000 skies.
    const SINGLE_CONDITION: f32 = 64.0;
}

/// The same weights where the LEO satellites have several clocks. A type of its own leaves the loops of one clock as they are.
pub(super) struct SeveralClocks<W>(PhantomData<W>);

impl<W: Weighting> Weighting for SeveralClocks<W> {
    const BY_SINE: bool = W::BY_SINE;
    const SEVERAL_CLOCKS: bool = true;
    const SINGLE_BELOW: f32 = W::SINGLE_BELOW;
    const SINGLE_CONDITION: f32 = W::SINGLE_CONDITION;
}
