// SPDX-License-Identifier: Apache-2.0
// A stage as a person runs it: its log, its progress line, its interruption, a flow's table in the end.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "interruption.h"
#include "patency/base/errors.h"
#include "patency/base/log.h"
#include "patency/config/case.h"
#include "patency/io/output_folder.h"
#include "patency/io/progress.h"

namespace patency::app {

/// Messages to the folder's log.txt and to the terminal; goes on with the log of an interrupted run.
Log make_run_log(const OutputFolder& folder, bool goes_on);

/// Throws CheckpointError where a folder holds results of another deck, other inputs, another version or another command: they are
/// not removed unasked.
void expect_no_other_results(const OutputFolder& folder, const deck::Case& config);
/// The same for a command whose results do not say what they were made from: where it cannot go on with those in the folder, all but
/// those of a second, as estimates are, must stay.
void expect_no_results(const OutputFolder& folder, std::string_view advice = ", or --fresh to replace them");

/// On the terminal: one line that is rewritten, or lines now and then where there is none.
Progress make_progress();

/// The flow of a case into a folder. An interruption ends it with a checkpoint (130, 143); a flow that has not settled in its
/// duration is 6. What throws is in the log.
ExitCode run_flow_stage(const deck::Case& config, const OutputFolder& folder, const Interruption& interruption,
                        const Log& log);

/// The deployment of a case's stent into a folder; interruption and what throws as of a flow. One that there
/// are doubts about is 6.
ExitCode run_deploy_stage(const deck::Case& config, const OutputFolder& folder, const Interruption& interruption,
                          const Log& log);

/// Of the program that runs.
std::string binary_hash();

}   // namespace patency::app
