// SPDX-License-Identifier: Apache-2.0
// What can go wrong, and which exit code says so. The library throws; only the app exits.
#pragma once

#include <stdexcept>
#include <string>

namespace patency {

/// Exit codes of the program: a contract for scripts (docs/USER_GUIDE.md).
enum class ExitCode : int {
    ok = 0,
    usage = 2,
    deck = 3,
    geometry = 4,
    diverged = 5,
    bar_missed = 6,
    file_system = 7,
    checkpoint = 8,
    interrupted = 130,
    terminated = 143,
};

/// An error with a sentence for the reader and the exit code it ends the program with.
class Error : public std::runtime_error {
public:
    Error(ExitCode code, const std::string& sentence) : std::runtime_error(sentence), code_(code) {}
    ExitCode code() const { return code_; }

private:
    ExitCode code_;
};

struct UsageError : Error {
    explicit UsageError(const std::string& s) : Error(ExitCode::usage, s) {}
};
struct DeckError : Error {
    explicit DeckError(const std::string& s) : Error(ExitCode::deck, s) {}
};
struct GeometryError : Error {
    explicit GeometryError(const std::string& s) : Error(ExitCode::geometry, s) {}
};
/// The computation left the realm of numbers or of physics: what, where, when, with which values.
struct DivergedError : Error {
    explicit DivergedError(const std::string& s) : Error(ExitCode::diverged, s) {}
};
struct FileError : Error {
    explicit FileError(const std::string& s) : Error(ExitCode::file_system, s) {}
};
struct CheckpointError : Error {
    explicit CheckpointError(const std::string& s) : Error(ExitCode::checkpoint, s) {}
};

}   // namespace patency
