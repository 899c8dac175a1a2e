// SPDX-License-Identifier: Apache-2.0
// Where messages go. The library never prints: whoever calls it hands over a Log, and the app decides
// whether that is a file (io/log_file.h), a terminal or nothing.
#pragma once

#include <functional>
#include <string_view>

namespace patency {

enum class LogLevel { debug, info, warning, error };

/// Takes one message without a line end. Must be callable (not empty); `no_log` drops everything.
using Log = std::function<void(LogLevel, std::string_view)>;

inline void no_log(LogLevel, std::string_view) {}

}   // namespace patency
