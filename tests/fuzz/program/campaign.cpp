// SPDX-License-Identifier: Apache-2.0
#include "tests/fuzz/program/campaign.h"

#include <fmt/format.h>
#include <omp.h>
#include <signal.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <fstream>
#include <new>
#include <thread>

#include "tests/fuzz/mutator.h"
#include "tests/io/scratch_folder.h"

namespace patency {

namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr int most_workers = 64, most_seeds = 64;
constexpr unsigned nothing = ~0u;
constexpr rlim_t most_memory =
    rlim_t(8) << 30;   // bytes of addresses: a file of some KB that asks for more is a finding

double seconds() { return std::chrono::duration<double>(Clock::now().time_since_epoch()).count(); }

/// Processor time that a process has used [s]; 0 of one that has ended.
double seconds_of(pid_t process) {
    clockid_t clock{};
    timespec time{};
    if (::clock_getcpuclockid(process, &clock) != 0 || ::clock_gettime(clock, &time) != 0) return 0;
    return double(time.tv_sec) + 1e-9 * double(time.tv_nsec);
}

/// What the processes share. The workers write it, and what one that crashed wrote last says at which file.
struct Shared {
    struct Worker {
        std::atomic<unsigned> number{nothing};   // of the file it is at
        std::atomic<double> since{0}, used{0};   // when it began there, and the processor time it had used [s]
        unsigned slowest = 0;
        double slowest_time = 0;
    };
    std::atomic<unsigned> taken{0};   // files, by all workers
    std::array<Worker, most_workers> workers{};
    std::array<std::array<std::atomic<unsigned>, endings>, most_seeds> of_seed{};
};

Shared& make_shared_memory() {
    void* memory = ::mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    if (memory == MAP_FAILED) throw std::bad_alloc();
    return *new (memory) Shared;
}

/// In memory where the system has a folder for that.
fs::path fastest_folder() {
    const fs::path in_memory = "/dev/shm";
    return fs::exists(in_memory) ? in_memory : fs::temp_directory_path();
}

class Run {
public:
    explicit Run(const Campaign& campaign)
        : c_(campaign),
          shared_(make_shared_memory()),
          scratch_(fastest_folder()),
          processes_(std::size_t(c_.at_once)) {}
    ~Run() { ::munmap(&shared_, sizeof(Shared)); }
    Run(const Run&) = delete;
    Run& operator=(const Run&) = delete;

    Tally go() {
        const double start = seconds();
        for (int w = 0; w < c_.at_once; ++w) launch(w);
        for (double told = start; running_ > 0;) {
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
            for (int w = 0; w < c_.at_once; ++w) look_at(w);
            constexpr double between_lines = 10;   // s
            if (seconds() - told < between_lines) continue;
            told = seconds();
            fmt::print("{:5.0f} s: {} of {} files\n", told - start, std::min(shared_.taken.load(), c_.count), c_.count);
            std::fflush(stdout);
        }
        Tally tally{.of_seed = std::vector<std::array<unsigned, endings>>(c_.seeds.size()), .time = seconds() - start};
        for (std::size_t s = 0; s < c_.seeds.size(); ++s)
            for (std::size_t e = 0; e < endings; ++e) tally.of_seed[s][e] = shared_.of_seed[s][e];
        for (const Shared::Worker& worker : shared_.workers)
            if (worker.slowest_time > tally.slowest_time)
                tally.slowest = worker.slowest, tally.slowest_time = worker.slowest_time;
        return tally;
    }

private:
    fs::path place_of(int w, unsigned number) const {
        return scratch_.path() / std::to_string(w) / c_.seeds[number % c_.seeds.size()].filename();
    }

    void launch(int w) {
        fs::create_directories(scratch_.path() / std::to_string(w));
        std::fflush(stdout);
        const pid_t child = ::fork();
        if (child < 0) throw std::runtime_error("no process to be had");
        if (child == 0) {
            work(w);
            std::fflush(stdout);
            ::_exit(0);
        }
        processes_[std::size_t(w)] = child;
        ++running_;
    }

    /// Of a worker: file after file.
    void work(int w) {
#ifndef __SANITIZE_ADDRESS__   // whose map of the memory takes terabytes of addresses
        const rlimit limit{most_memory, most_memory};
        ::setrlimit(RLIMIT_AS, &limit);
#endif
        const rlimit no_core{0, 0};
        ::setrlimit(RLIMIT_CORE, &no_core);
        omp_set_num_threads(1);   // the files are small, and the other workers want the other cores
        Shared::Worker& own = shared_.workers[std::size_t(w)];
        std::string sentence;
        for (unsigned k; (k = shared_.taken++) < c_.count;) {
            const unsigned number = c_.first + k;
            const double used = seconds_of(::getpid());
            own.since = seconds();
            own.used = used;
            own.number = number;
            const Ending ending = end_of(place_of(w, number), damaged(c_, number), sentence);
            own.number = nothing;
            if (const double time = seconds_of(::getpid()) - used; time > own.slowest_time)
                own.slowest = number, own.slowest_time = time;
            count(number, ending);
            if (ending == Ending::found) report(number, sentence);
        }
    }

    void count(unsigned number, Ending ending) { ++shared_.of_seed[number % c_.seeds.size()][std::size_t(ending)]; }

    void report(unsigned number, const std::string& what) {
        const fs::path& seed = c_.seeds[number % c_.seeds.size()];
        const fs::path kept = c_.keep / fmt::format("{}_{}", number, seed.filename().string());
        fs::create_directories(c_.keep);
        std::ofstream(kept, std::ios::binary) << damaged(c_, number);
        fmt::print("FOUND by file {}, kept as {}: {}\n", number, kept.string(), what);
        std::fflush(stdout);
    }

    /// It computes for too long, or waits for something that does not come.
    bool is_stuck(const Shared::Worker& worker, pid_t process) const {
        constexpr double longest_wait = 10;   // times the longest computation
        return worker.number != nothing &&
               (seconds_of(process) - worker.used > c_.longest || seconds() - worker.since > longest_wait * c_.longest);
    }

    /// Of the parent: has the worker ended, crashed, or been at one file for too long?
    void look_at(int w) {
        pid_t& process = processes_[std::size_t(w)];
        if (process == 0) return;
        Shared::Worker& worker = shared_.workers[std::size_t(w)];
        int status = 0;
        std::string what;
        if (::waitpid(process, &status, WNOHANG) == process) {
            if (WIFSIGNALED(status))
                what = fmt::format("a crash ({})", ::strsignal(WTERMSIG(status)));
            else if (WEXITSTATUS(status) != 0)
                what = fmt::format("the process ends with {}", WEXITSTATUS(status));
        } else if (is_stuck(worker, process)) {
            ::kill(process, SIGKILL);
            ::waitpid(process, &status, 0);
            what = fmt::format("no end after {:.0f} s", c_.longest);
        } else {
            return;
        }
        process = 0;
        --running_;
        if (what.empty()) return;
        const unsigned number = worker.number.exchange(nothing);
        if (number != nothing) {
            count(number, Ending::found);
            report(number, what);
        }
        launch(w);   // for the files that are left
    }

    const Campaign& c_;
    Shared& shared_;
    const ScratchFolder scratch_;
    std::vector<pid_t> processes_;   // 0 for one that has ended
    int running_ = 0;
};

}   // namespace

std::string damaged(const Campaign& campaign, unsigned number) {
    const std::size_t count = campaign.seeds.size();
    const fs::path& seed = campaign.seeds[number % count];
    std::size_t other = number / count % count;   // of the same kind, if there is another one
    for (std::size_t k = 0; k < count && campaign.seeds[other].extension() != seed.extension(); ++k)
        other = (other + 1) % count;
    return Mutator(number)(contents_of(seed), contents_of(campaign.seeds[other]));
}

Tally run_campaign(const Campaign& campaign) {
    if (campaign.seeds.empty() || campaign.seeds.size() > most_seeds || campaign.at_once < 1 ||
        campaign.at_once > most_workers)
        throw std::invalid_argument("1 to 64 seeds and 1 to 64 processes");
    return Run(campaign).go();
}

}   // namespace patency
