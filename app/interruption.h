// SPDX-License-Identifier: Apache-2.0
// What ends a run before its end: SIGINT, SIGTERM, or a file called stop in its folder.
#pragma once

#include <chrono>
#include <filesystem>

#include "patency/base/errors.h"
#include "patency/io/output_folder.h"

namespace patency::app {

/// Listens from its making on. A second signal ends the program at once. The file OUT/stop is for those who cannot send
/// signals, as on a cluster; one that an earlier run obeyed is taken away.
class Interruption {
public:
    Interruption();                                      ///< signals alone
    explicit Interruption(const OutputFolder& folder);   ///< and the file

    /// Cheap enough to be asked after every step: the file is looked for a few times a second.
    bool is_wanted() const;
    /// 143 after SIGTERM, else 130.
    ExitCode exit_code() const;

private:
    std::filesystem::path stop_file_;
    mutable std::chrono::steady_clock::time_point next_look_{};
    mutable bool is_file_seen_ = false;
};

}   // namespace patency::app
