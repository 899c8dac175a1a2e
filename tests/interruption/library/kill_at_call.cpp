// SPDX-License-Identifier: Apache-2.0
// Loaded before a program (LD_PRELOAD), kills it as kill -9 would just before its Nth call that changes a file or a folder: N is
// PATENCY_KILL_AT. With PATENCY_COUNT_INTO=FILE it writes how many there were instead. So every state that a run can leave on the
// disk is reached by a number, and not by luck.
#include <dlfcn.h>
#include <sys/types.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>

namespace {

long calls = 0;

void count_call() {
    static const char* const wanted = std::getenv("PATENCY_KILL_AT");
    if (++calls == (wanted ? std::atol(wanted) : -1)) ::kill(::getpid(), SIGKILL);
}

struct Report {
    ~Report() {
        const char* const path = std::getenv("PATENCY_COUNT_INTO");
        if (!path) return;
        if (std::FILE* file = std::fopen(path, "w")) std::fprintf(file, "%ld\n", calls), std::fclose(file);
    }
} report;

template <class Function>
Function* next(const char* name) {
    return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

}   // namespace

extern "C" {

int fsync(int file) {
    count_call();
    return next<int(int)>("fsync")(file);
}
int rename(const char* from, const char* to) {
    count_call();
    return next<int(const char*, const char*)>("rename")(from, to);
}
int mkdir(const char* path, mode_t mode) {
    count_call();
    return next<int(const char*, mode_t)>("mkdir")(path, mode);
}
int ftruncate(int file, off_t length) {
    count_call();
    return next<int(int, off_t)>("ftruncate")(file, length);
}
int remove(const char* path) {
    count_call();
    return next<int(const char*)>("remove")(path);
}
int unlinkat(int folder, const char* path, int flags) {
    count_call();
    return next<int(int, const char*, int)>("unlinkat")(folder, path, flags);
}
int fflush(std::FILE* file) {   // of rows in tables
    if (file != stdout && file != stderr) count_call();
    return next<int(std::FILE*)>("fflush")(file);
}

}   // extern "C"
