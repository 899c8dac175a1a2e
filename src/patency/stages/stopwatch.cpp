// SPDX-License-Identifier: Apache-2.0
#include "patency/stages/stopwatch.h"

#include <sys/resource.h>
#include <unistd.h>

namespace patency {

double Stopwatch::cpu_now() {
    rusage used{};
    getrusage(RUSAGE_SELF, &used);
    const auto seconds = [](const timeval& t) { return double(t.tv_sec) + 1e-6 * double(t.tv_usec); };
    return seconds(used.ru_utime) + seconds(used.ru_stime);
}

std::string machine_name() {
    char name[256] = {};
    gethostname(name, sizeof name - 1);
    return name;
}

}   // namespace patency
