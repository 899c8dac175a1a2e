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
    double share = 0;                ///< of the run's simulated time, 0..1
    const RunData* done = nullptr;   ///< at the end of the run
    bool is_reused = false;
};

struct VerifyRequest {
    std::vector<std::string> names;   ///< empty: all
    Level level = Level::quick;
    std::filesystem::path out, decks, reference;   ///< reference: stored results of other programs, if there
    std::string program;                           ///< a fingerprint of the program
    std::vector<std::string> settings;             ///< key=value over every deck
    bool fresh = false;                            ///< do all runs again
    std::function<void(const VerifyProgress&)> report = {};
    std::function<bool()> interrupted = {};
};

/// The cases that a request is about, in the registry's order. @throws UsageError for an unknown name.
std::vector<std::string> names_of_verification(const VerifyRequest& request);

/// One report per case, in the registry's order. A run that diverges costs its figures their values, nothing else.
/// @throws UsageError for an unknown name, DeckError, GeometryError and FileError for the decks and the folder, Error
/// with ExitCode::interrupted if asked to stop.
std::vector<CaseReport> run_verification(const VerifyRequest& request);

/// docs/VERIFICATION.md: tables, times, pictures and the reference paper's tables, from the reports that lie beside it in `verification/`;
/// those in the folder `out` are put there first. `run`: the folder of a run that stands beside the paper's table VI, or empty: the last one.
/// @throws FileError.
void write_verification_report(const std::filesystem::path& out, const std::filesystem::path& document,
                               const std::filesystem::path& run);

}   // namespace patency
