// SPDX-License-Identifier: Apache-2.0
// A stage of solids as a person runs it: its log, its progress line, its interruption.
#pragma once

#include "patency/base/errors.h"
#include "patency/config/case.h"
#include "patency/io/output_folder.h"

namespace patency::app {

/// Solids of a case into a folder, on from its checkpoint unless begun afresh. An interruption leaves one (130, 143). What
/// throws is in the log.
ExitCode run_solid_stage(const deck::Case& config, const OutputFolder& folder, std::string_view heading, bool fresh);

/// Prints what a deck of solids will cost: particles, stable step, steps.
void print_solid_plan(const deck::Case& config);

}   // namespace patency::app
