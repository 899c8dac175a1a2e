// SPDX-License-Identifier: Apache-2.0
#include "patency/stages/stopwatch.h"

#include <fmt/chrono.h>
#include <omp.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <ctime>
#include <nlohmann/json.hpp>

#include "patency/io/summary.h"

namespace patency {

double Stopwatch::cpu_now() {
    rusage used{};
    getrusage(RUSAGE_SELF, &used);
    const auto seconds = [](const timeval& t) { return double(t.tv_sec) + 1e-6 * double(t.tv_usec); };
    return seconds(used.ru_utime) + seconds(used.ru_stime);
}

void write_timing(const OutputFolder& folder, nlohmann::ordered_json times) {
    std::array<char, 256> machine{};
    gethostname(machine.data(), machine.size() - 1);
    times["threads"] = omp_get_max_threads();
    times["machine"] = machine.data();
    times["date"] = fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr)));
    write_summary(folder.file("timing.json"), times);
}

}   // namespace patency
