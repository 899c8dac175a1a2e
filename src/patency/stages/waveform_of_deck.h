// SPDX-License-Identifier: Apache-2.0
// Waveforms as decks give them (a CSV file, a table, a Fourier series) to the law in time.
#pragma once

#include "patency/base/units.h"
#include "patency/config/case.h"
#include "patency/physics/open_ends/waveform.h"

namespace patency {

/// The waveform times `factor`. A table is linear in between and repeats with its own period, else the case's; without
/// either it is played once. A file has columns named with units, such as time_s and flow_mL_per_min, of which the
/// second must have `dimension`. Throws FileError, DeckError.
Waveform make_signal_waveform(const deck::Waveform& said, const deck::Case& config, Dimension dimension, double factor);

}   // namespace patency
