// SPDX-License-Identifier: Apache-2.0
#include "interruption.h"

#include <atomic>
#include <csignal>
#include <system_error>

namespace patency::app {

namespace {

constexpr std::chrono::milliseconds between_looks{200};   // a folder on a network may take milliseconds to answer

std::atomic<int> caught_signal{0};
void note_signal(int signal) {
    caught_signal = signal;
    std::signal(signal, SIG_DFL);
}

}   // namespace

Interruption::Interruption() {
    std::signal(SIGINT, note_signal);
    std::signal(SIGTERM, note_signal);
}

Interruption::Interruption(const OutputFolder& folder) : Interruption() {
    stop_file_ = folder.file("stop");
    std::error_code error;
    std::filesystem::remove(stop_file_, error);
}

bool Interruption::is_wanted() const {
    if (caught_signal != 0 || is_file_seen_) return true;
    if (const auto now = std::chrono::steady_clock::now(); !stop_file_.empty() && now >= next_look_) {
        next_look_ = now + between_looks;
        std::error_code error;
        is_file_seen_ = std::filesystem::exists(stop_file_, error);
    }
    return is_file_seen_;
}

ExitCode Interruption::exit_code() const {
    return caught_signal == SIGTERM ? ExitCode::terminated : ExitCode::interrupted;
}

}   // namespace patency::app
