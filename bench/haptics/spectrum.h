// Energy of a force at the frame rate: what a hand feels as buzzing.
#pragma once
#include "bench/haptics/session.h"

namespace pliant::bench::haptics {

/// Energy of felt - expected at `frequency` and its multiples below 300 Hz [N^2], by the discrete Fourier transform under
/// Hann's window, within half a bin and a bin to each side of them.
double energy_at_multiples(const ForceTrace& felt, const ForceTrace& expected, double frequency);

/// The largest change of the force from tick to tick [N].
double largest_jump(const ForceTrace& felt);

}  // namespace pliant::bench::haptics
