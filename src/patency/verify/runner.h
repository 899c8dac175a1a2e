// SPDX-License-Identifier: Apache-2.0
// Runs verification cases: every run of a case's deck, then its figures, into OUT/NAME.json and OUT/NAME.timing.json.
// A run that was done by the same program from the same deck is not done again, so an interrupted verification goes on.
// Prints nothing.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "patency/verify/verify_case.h"

namespace patency {

/// What happens, for whoever shows it.
struct VerifyProgress {
    std::string case_name, run_name;
    double share = 0;                 ///< of the run's simulated time, 0..1
    const RunData* done = nullptr;    ///< at the end of the run
    bool is_reused = false;
};

struct VerifyRequest {
    std::vector<std::string> names;          ///< empty: all
    Level level = Level::quick;
    std::filesystem::path out, decks, reference;   ///< reference: stored results of other programs, if there
    std::string program;                     ///< a fingerprint of the program
    std::vector<std::string> settings;       ///< key=value over every deck
    bool fresh = false;                      ///< do all runs again
    std::function<void(const VerifyProgress&)> report = {};
    std::function<bool()> interrupted = {};
};

/// One report per case, in the registry's order. A run that diverges costs its figures their values, nothing else.
/// @throws UsageError for an unknown name, DeckError, GeometryError and FileError for the decks and the folder, Error
/// with ExitCode::interrupted if asked to stop.
std::vector<CaseReport> run_verification(const VerifyRequest& request);

/// docs/VERIFICATION.md from the reports in a folder: tables, times and pictures (copied beside it, into `verification/`), and
/// the reference paper's tables; `run`: the folder of a run that stands beside its table VI, or empty.
/// @throws FileError.
void write_verification_report(const std::filesystem::path& out, const std::filesystem::path& document, const std::filesystem::path& run);

}  // namespace patency
