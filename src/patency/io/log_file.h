// SPDX-License-Identifier: Apache-2.0
// The log of a run, OUT/log.txt: every message with date and level. What is worth a message, the
// stages decide.
#pragma once

#include <filesystem>

#include "patency/base/log.h"

namespace patency {

enum class LogMode { begin, append };

/// A Log that writes to the file and flushes every message; it may be called from several threads and
/// copied. Throws FileError when the file cannot be opened; a message that cannot be written later is
/// dropped, since the results' own files report a full disk.
Log make_file_log(const std::filesystem::path& path, LogMode mode);

/// A Log that hands each message to both.
Log make_tee_log(Log first, Log second);

}   // namespace patency
