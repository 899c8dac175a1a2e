// SPDX-License-Identifier: Apache-2.0
// The program's own CPU time.
#pragma once

#include <sys/resource.h>

namespace patency {

/// User and system time of all threads so far [s].
inline double cpu_seconds() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    const auto seconds = [](const timeval& t) { return double(t.tv_sec) + 1e-6 * double(t.tv_usec); };
    return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

}   // namespace patency
